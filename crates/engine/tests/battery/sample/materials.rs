//! What samples are made of.

use peridyne::expression::Expression;
use peridyne::spec::*;

/// What a body is made of: its materials (the second on the upper half along x) and its influence function.
#[derive(Debug, Clone)]
pub struct Material {
    pub name: &'static str,
    pub laws: Vec<LawSpec>,
    pub influence: Influence,
    /// Where it can be: dimension and plane state.
    pub lives: fn(usize, Plane) -> bool,
    /// Of materials that cannot be without.
    pub fracture: Option<f64>,
    /// Is its energy a potential? Laws of rates have the work that was done.
    pub potential: bool,
}

impl Material {
    /// Has it the constants of an isotropic solid?
    pub fn is_isotropic(&self) -> bool {
        let plies = |law: &LawSpec| matches!(law, LawSpec::Named(law) if ["anisotropic", "lamina", "embedded_solid"].contains(&law.name.as_str()));
        !self.laws.iter().any(plies) && !self.influence.is_directed()
    }
}

/// The table of materials: a line here buys all batteries.
pub fn materials() -> Vec<Material> {
    let one = |name, law, influence| Material {
        name,
        laws: vec![law],
        influence,
        lives: |_, _| true,
        fracture: None,
        potential: true,
    };
    let two = |name, a, b, influence| Material {
        name,
        laws: vec![a, b],
        influence,
        lives: |_, _| true,
        fracture: None,
        potential: true,
    };
    let elastic =
        |young: f64, poisson: f64| Parameters::numbers(&[("young", young), ("poisson", poisson)]);
    let plastic = |yield_stress: f64, hardening: f64| {
        let more = elastic(3.0, 0.3)
            .with("yield_stress", Parameter::Number(yield_stress))
            .with("hardening", Parameter::Number(hardening));
        LawSpec::named("elastic_plastic", more)
    };
    let relaxing = |part: f64| {
        let rows = vec![vec![part, 0.7], vec![0.2, 3.0]];
        LawSpec::named(
            "viscoelastic",
            elastic(3.0, 0.2).with("branches", Parameter::Rows(rows)),
        )
    };
    let correspondence = |young, stress: &str| {
        LawSpec::named(
            "correspondence",
            elastic(young, 0.3).with("stress", Parameter::Word(stress.into())),
        )
    };
    let flowing = |yield_stress: f64, hardening: f64, friction: f64| {
        let more = elastic(3.0, 0.3)
            .with("yield_stress", Parameter::Number(yield_stress))
            .with("hardening", Parameter::Number(hardening))
            .with("friction", Parameter::Number(friction))
            .with("dilatancy", Parameter::Number(0.5 * friction));
        LawSpec::named("hypoelastic_plastic", more)
    };
    let shocked = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            let parameters = &mut law.parameters;
            parameters.set("equation_of_state", Parameter::Word("mie_gruneisen".into()));
            // 2s − Γ/2 = 1: at rest pressure has no corner in its curvature either, which tangents by differences would see
            parameters.set("hugoniot_slope", Parameter::Number(1.0));
            parameters.set("gruneisen", Parameter::Number(2.0));
            LawSpec::Named(law)
        }
        law => law,
    };
    let of_energy = |text: &str| {
        let energy = Expression::of(&["I1", "I2", "J"], text, &[]).unwrap();
        LawSpec::named(
            "hyperelastic",
            Parameters::default().with("energy", Parameter::Formula(energy)),
        )
    };
    let of_bonds = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            law.parameters
                .set("gradient", Parameter::Word("bond".into()));
            LawSpec::Named(law)
        }
        law => law,
    };
    let ply = |young: f64, fibre: [f64; 3]| {
        let list = |x: [f64; 3]| Parameter::List(x.to_vec());
        let all = Parameters::default()
            .with("young", list([young, 0.3 * young, 0.2 * young]))
            .with("poisson", list([0.3, 0.25, 0.4]))
            .with("shear", list([0.2 * young, 0.15 * young, 0.1 * young]))
            .with("fibre", list(fibre));
        LawSpec::named("anisotropic", all)
    };
    let bent = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            let fibre = ["1", "sin(3*x) + y", "0"].map(super::e);
            law.parameters.set("fibre", Parameter::Direction(fibre));
            LawSpec::Named(law)
        }
        law => law,
    };
    let lamina = |young: [f64; 2], fibre: [f64; 3]| {
        let all = Parameters::default()
            .with("young", Parameter::List(young.to_vec()))
            .with("fibre", Parameter::List(fibre.to_vec()))
            .with("fibre_critical_stretch", Parameter::Number(0.09));
        LawSpec::named("lamina", all)
    };
    let softening = |young: f64| {
        let all = Parameters::numbers(&[("young", young), ("onset", 0.1)]);
        LawSpec::named("softening", all)
    };
    let stiffening = |young: f64, cubic: f64| {
        let all = Parameters::numbers(&[("young", young), ("cubic", cubic)]);
        LawSpec::named("stiffening", all)
    };
    let lps = |young, poisson| LawSpec::Lps(Moduli { young, poisson });
    let young = |e| LawSpec::Pmb(PmbStiffness::Young(e));
    // x stands for ϑ/ϑ₀
    let embedded = |energy: &str, pair: f64| {
        let of = |variables, text: &str| {
            Parameter::Formula(Expression::of(variables, text, &[("k", pair)]).unwrap())
        };
        let energy = energy.replace('x', "(theta/theta0)");
        let all = Parameters::numbers(&[("bulk", 1.0)])
            .with("energy", of(&["theta", "theta0"], &energy))
            .with("weight", of(&["r", "r0", "omega", "delta"], "omega*r0*r"))
            .with(
                "pair",
                of(
                    &["r", "r0", "omega", "delta", "theta0"],
                    "k*omega*(r - r0)^2*(1 - (r - r0)/delta)/theta0",
                ),
            );
        LawSpec::named("embedded_solid", all)
    };
    let written = |text: &str| Influence::Formula(Formula::parse(text, &[]).unwrap());
    vec![
        one("pmb", young(3.0), Influence::Constant),
        one(
            "pmb conical",
            LawSpec::Pmb(PmbStiffness::Bulk(2.0)),
            Influence::Linear,
        ),
        two("pmb mixed", young(3.0), young(1.0), Influence::Gaussian),
        one("lps", lps(3.0, 0.2), Influence::Inverse),
        one("lps auxetic", lps(3.0, -0.2), Influence::Constant),
        two(
            "lps directed",
            lps(3.0, 0.2),
            lps(1.0, 0.4),
            written("exp(-(r/delta)^2)*(1 + 0.6*xi_x/r)"),
        ),
        one(
            "pmb written",
            young(3.0),
            written("r*(1 - 0.5*r/delta)*(2 + xi_x/r)"),
        ),
        two(
            "lps mixed",
            lps(3.0, 0.2),
            lps(1.0, 0.4),
            Influence::Gaussian,
        ),
        one(
            "lps as typed",
            LawSpec::Lps3d {
                bulk: 2.0,
                shear: 1.0,
            },
            Influence::Inverse,
        ),
        one(
            "eam-like",
            LawSpec::EamLike {
                pair: 20.0,
                volume: 1.0,
            },
            Influence::CubicSpline,
        ),
        two(
            "embedded",
            embedded("2*(x - 1)^2 + (x - 1)^3", 20.0),
            embedded("ln(x) + 1/x", 10.0),
            Influence::Inverse,
        ),
        one("elastic-plastic", plastic(0.2, 0.3), Influence::Inverse),
        two(
            "plastic mixed",
            plastic(0.3, 0.0),
            plastic(0.2, 1.0),
            Influence::Gaussian,
        ),
        Material {
            lives: |d, _| d > 1,
            ..two(
                "position-aware",
                LawSpec::named("pals", elastic(3.0, 0.2)),
                LawSpec::named("pals", elastic(1.0, 0.4)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..one(
                "bond rotation",
                LawSpec::named("bond_rotation", elastic(3.0, 0.1)),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "bond rotation mixed",
                LawSpec::named("bond_rotation", elastic(3.0, 0.2)),
                LawSpec::named("bond_rotation", elastic(1.0, -0.3)),
                Influence::Linear,
            )
        },
        one("viscoelastic", relaxing(0.5), Influence::Linear),
        two(
            "viscoelastic mixed",
            relaxing(0.5),
            relaxing(0.1),
            Influence::Inverse,
        ),
        Material {
            lives: |d, _| d > 1,
            ..one(
                "correspondence",
                correspondence(3.0, "linear"),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "neo-hookean mixed",
                correspondence(3.0, "neo_hookean"),
                correspondence(1.0, "neo_hookean"),
                Influence::Linear,
            )
        },
        Material {
            lives: |d, _| d > 1,
            potential: false,
            ..one(
                "hypoelastic",
                LawSpec::named("hypoelastic", elastic(3.0, 0.3)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "mooney-rivlin mixed",
                correspondence(3.0, "mooney_rivlin"),
                correspondence(1.0, "mooney_rivlin"),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "of written energies",
                of_energy("0.6*(I1*J^(-2/3) - 3) + 0.2*(I1*J^(-2/3) - 3)^2 + 1.2*(J - 1)^2"),
                of_energy("0.2*(I1 - 3 - 2*ln(J)) + 0.1*(I2 - 3 - 4*ln(J)) + 0.3*ln(J)^2"),
                Influence::Linear,
            )
        },
        Material {
            lives: |d, _| d > 1,
            potential: false,
            ..two(
                "metal and soil",
                flowing(0.06, 0.3, 0.0),
                flowing(0.08, 0.1, 0.3),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            potential: false,
            ..one(
                "metal under impact",
                shocked(flowing(0.06, 0.3, 0.0)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "bonds of rubber",
                of_bonds(correspondence(3.0, "neo_hookean")),
                of_bonds(correspondence(1.0, "neo_hookean")),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            potential: false,
            ..one(
                "bonds of metal",
                of_bonds(flowing(0.06, 0.3, 0.0)),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "plies",
                ply(3.0, [1.0, 2.0, 0.0]),
                ply(2.0, [2.0, -1.0, 0.0]),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "wound",
                bent(of_bonds(ply(3.0, [1.0, 0.0, 0.0]))),
                of_bonds(ply(2.0, [2.0, -1.0, 0.0])),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..one(
                "bonds of a ply",
                of_bonds(ply(3.0, [1.0, 2.0, 0.0])),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Stress),
            fracture: Some(3.0),
            ..one(
                "lamina",
                lamina([3.0, 0.6], [1.0, 0.0, 0.0]),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Stress),
            fracture: Some(3.0),
            ..two(
                "laminae",
                lamina([3.0, 0.6], [0.0, -1.0, 0.0]),
                lamina([2.0, 1.0], [2.0, 0.0, 0.0]),
                Influence::Gaussian,
            )
        },
        Material {
            fracture: Some(3.0),
            ..one("softening", softening(3.0), Influence::Constant)
        },
        one(
            "thermoelastic",
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 3.0)])),
            Influence::Constant,
        ),
        two(
            "thermoelastic mixed",
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 3.0)])),
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 1.0)])),
            Influence::Gaussian,
        ),
        two(
            "thermoelastic solids",
            LawSpec::named("thermoelastic_solid", elastic(3.0, 0.2)),
            LawSpec::named("thermoelastic_solid", elastic(1.0, 0.4)),
            Influence::Inverse,
        ),
        two(
            "a user's, mixed",
            stiffening(3.0, 4.0),
            stiffening(1.0, 0.0),
            Influence::Inverse,
        ),
        Material {
            fracture: Some(3.0),
            ..two(
                "softening mixed",
                softening(3.0),
                softening(1.0),
                Influence::Gaussian,
            )
        },
    ]
}
