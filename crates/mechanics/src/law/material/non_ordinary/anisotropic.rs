//! Anisotropic elasticity, `S = C : E` of Green's strain, `P = F S`: orthotropic solids by their engineering constants, any other by its
//! stiffness, with axes of their own, the same everywhere or of each place.
//!
//! Voigt's order is 11, 22, 33, 23, 13, 12, with shears `2E₂₃, 2E₁₃, 2E₁₂` (Ting 1996, section 2.3; Jones 1999, sections 2.2 to 2.6).
//! In the plane the third axis is across: plane strain leaves out what is across, plane stress is condensed,
//! `Q = C_pp − C_pa C_aa⁻¹ C_ap`.

use super::direction::{Axes, FIBRE, NORMAL};
use super::stiffness::{
    self, ACROSS, PAIRS, PLANE, Stiffness, in_plane, mean, orthotropic, symmetric, turned,
};
use super::{Classical, Stressed, Unseen};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{Bounds, Descriptor, Given, Key, Need, Registered, Value};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::Number;
use crate::space::Point;
use crate::spec::{LawSpec, Parameters, Plane};

/// See the module.
#[derive(Debug, Clone)]
pub struct Anisotropic {
    /// Per material, about the axes of the body, of those whose axes are the same everywhere; else zeros.
    materials: Vec<[f64; 21]>,
    /// Mean shear modulus of each.
    shear: Vec<f64>,
    /// About its own axes, and these.
    solids: Vec<(Stiffness, Axes)>,
    plane: Plane,
}

impl<const D: usize> Classical<D> for Anisotropic {
    type Constants<N: Number> = [N; 21];
    type Past<N: Number> = [N; 0];
    const PLACED: bool = true;

    fn constants(&self, material: usize, _: f64) -> [f64; 21] {
        self.materials[material]
    }

    fn varies(&self) -> bool {
        self.solids.iter().any(|(_, axes)| axes.varies())
    }

    fn constants_at(&self, material: usize, place: &Point) -> Result<[f64; 21], String> {
        let (own, axes) = &self.solids[material];
        upper(own, &axes.at(place)?, (D, self.plane))
    }

    fn places(&self) -> Vec<Declaration> {
        let axis = |name, doc| {
            Declaration::of_points(name, Shape::Vector, Dimension::NUMBER, doc).derived()
        };
        let mut all = vec![axis(
            FIBRE.name,
            "Axis 1 of the material in the reference, of length one.",
        )];
        if D == 3 {
            all.push(axis(
                NORMAL.name,
                "Axis 3 of the material in the reference, of length one.",
            ));
        }
        all
    }

    /// Axis 1, and axis 3 in space.
    fn at_place(&self, material: usize, place: &Point) -> Vec<f64> {
        let axes = self.solids[material].1.at(place);
        let [first, _, third] = axes.unwrap_or([[f64::NAN; 3]; 3]);
        match D {
            3 => [first, third].concat(),
            _ => first[..D].to_vec(),
        }
    }

    fn shear(&self, material: usize) -> f64 {
        self.shear[material]
    }

    #[inline(always)]
    fn stress<N: Number>(
        &self,
        c: &[N; 21],
        past: &[N; 0],
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, [N; 0], D> {
        let (half, zero) = (N::constant(0.5), N::constant(0.0));
        // 2E = H + Hᵀ + HᵀH
        let mut twice = tensor::transposed_product(h, h);
        let mut f = *h;
        for r in 0..D {
            for s in 0..D {
                twice[r][s] = twice[r][s] + h[r][s] + h[s][r];
            }
            f[r][r] = f[r][r] + N::constant(1.0);
        }
        // of the plane 11, 22, 12
        let count = if D == 2 { 3 } else { 6 };
        let place = |n: usize| PAIRS[if D == 2 { PLANE[n] } else { n }];
        let mut e = [zero; 6];
        for (n, e) in e.iter_mut().enumerate().take(count) {
            let [r, s] = place(n);
            *e = if r == s {
                half * twice[r][s]
            } else {
                twice[r][s]
            };
        }
        let (mut voigt, mut at) = ([zero; 6], 0);
        for r in 0..count {
            for s in r..count {
                voigt[r] = c[at].fma(e[s], voigt[r]);
                if s > r {
                    voigt[s] = c[at].fma(e[r], voigt[s]);
                }
                at += 1;
            }
        }
        let (mut stress, mut energy) = (tensor::zero::<N, D>(), zero);
        if D == 2 {
            // E₃₃ and what it does
            let across = unseen.across * half.fma(unseen.across, N::constant(1.0));
            let mut own = c[ACROSS_FIRST + 3] * across;
            for n in 0..count {
                let coupled = c[ACROSS_FIRST + n];
                own = coupled.fma(e[n], own);
                voigt[n] = coupled.fma(across, voigt[n]);
            }
            energy = own * across;
        }
        for n in 0..count {
            let [r, s] = place(n);
            stress[r][s] = voigt[n];
            stress[s][r] = voigt[n];
            energy = voigt[n].fma(e[n], energy);
        }
        Stressed {
            stress: tensor::product(&f, &stress),
            across: N::constant(0.0),
            energy: half * energy,
            past: *past,
        }
    }
}

/// About the axes of the solid.
fn written(parameters: &Parameters) -> Result<Stiffness, String> {
    let three = |key: &str| match parameters.list(key) {
        Some(list) => Ok([list[0], list[1], list[2]]),
        None => Err(format!(
            "with `young` = [E1, E2, E3] go `poisson` = [ν12, ν13, ν23] and `shear` = [G12, G13, G23]; `{key}` is missing"
        )),
    };
    match parameters.list("stiffness") {
        Some(list) => {
            for key in ["poisson", "shear"] {
                if parameters.list(key).is_some() {
                    return Err(format!(
                        "`{key}` goes with `young`; `stiffness` says it all"
                    ));
                }
            }
            let c = symmetric(list);
            if !stiffness::is_positive(&c) {
                return Err("the stiffness is not positive definite: no stable solid has it. It is the upper triangle, C11 to C16, C22 to C26, … C66, in the order 11, 22, 33, 23, 13, 12".into());
            }
            Ok(c)
        }
        None => orthotropic(three("young")?, three("poisson")?, three("shear")?),
    }
}

/// Where in plane strain stiffnesses of 33 begin, with 11, 22, 12 and with itself.
const ACROSS_FIRST: usize = 6;

/// The upper triangle about the axes of the body, line by line; in the plane that of 11, 22, 12 first, then those of 33.
fn upper(
    own: &Stiffness,
    axes: &[Point; 3],
    (d, plane): (usize, Plane),
) -> Result<[f64; 21], String> {
    let c = turned(own, axes);
    let coupled = ACROSS[1..]
        .iter()
        .flat_map(|a| [0, 1, 2, 5].map(|p| c[*a][p].abs()));
    if d == 2 && coupled.fold(0.0, f64::max) > 1e-9 * c[0][0] {
        return Err("in the plane the third axis of a material is across: `fibre` lies in the plane and `normal` is [0, 0, 1], and no stiffness couples it to shear across".into());
    }
    let mut upper = [0.0; 21];
    let mut at = upper.iter_mut();
    let mut next = |x: f64| {
        if let Some(place) = at.next() {
            *place = x;
        }
    };
    if d == 2 {
        let q = in_plane(&c, plane);
        (0..3).for_each(|r| (r..3).for_each(|s| next(q[r][s])));
        if plane == Plane::Strain {
            [0, 1, 5, 2].into_iter().for_each(|r| next(c[2][r]));
        }
    } else {
        (0..6).for_each(|r| (r..6).for_each(|s| next(c[r][s])));
    }
    Ok(upper)
}

const fn list(
    name: &'static str,
    (count, dimension, bounds): (usize, Dimension, Bounds),
    need: Need,
    doc: &'static str,
) -> Key {
    Key {
        name,
        value: Value::List(count, dimension, bounds),
        need,
        doc,
    }
}

/// Three of them.
const MODULI: (usize, Dimension, Bounds) = (3, Dimension::PRESSURE, Bounds::POSITIVE);
const NUMBERS: (usize, Dimension, Bounds) = (3, Dimension::NUMBER, Bounds::ANY);

impl Registered for Anisotropic {
    const ISOTROPIC: bool = false;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            "anisotropic",
            "Non-ordinary: S = C : E of Green's strain, orthotropic by engineering constants or with any stiffness, about axes of its own. For plies a material each; fibres that bend follow expressions of the place.",
        )
        .source("Ting 1996; Jones 1999; Silling et al. 2007")
        .example("{ young = [\"140 GPa\", \"10 GPa\", \"10 GPa\"], poisson = [0.3, 0.3, 0.4], shear = [\"5 GPa\", \"5 GPa\", \"3.5 GPa\"], fibre = [1, 1, 0] }")
        .keys(&[
            list("young", MODULI, Need::OneOf, "Young's moduli E1, E2, E3 along the axes of an orthotropic solid."),
            list("poisson", NUMBERS, Need::Optional, "ν12, ν13, ν23: contraction along the second axis under a stress along the first; with young."),
            list("shear", MODULI, Need::Optional, "Shear moduli G12, G13, G23; with young."),
            list("stiffness", (21, Dimension::PRESSURE, Bounds::ANY), Need::OneOf, "Upper triangle of the stiffness, C11 to C16, C22 to C26, … C66, in the order 11, 22, 33, 23, 13, 12."),
            FIBRE,
            NORMAL,
        ])
    }

    /// The isotropic solid of Voigt's mean.
    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        let own = written(parameters)?;
        Axes::written(parameters).everywhere()?;
        Ok(LawSpec::Lps(mean(&own)))
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let mut law = Anisotropic {
            materials: vec![],
            shear: vec![],
            solids: vec![],
            plane,
        };
        for (n, m) in materials.iter().enumerate() {
            let wrong = |message: String| (n, message);
            let own = written(m.parameters).map_err(wrong)?;
            let axes = Axes::written(m.parameters);
            law.materials.push(match axes.everywhere().map_err(wrong)? {
                Some(axes) => upper(&own, &axes, (d, plane)).map_err(wrong)?,
                None => [0.0; 21],
            });
            law.shear.push(mean(&own).shear());
            law.solids.push((own, axes));
        }
        Ok(law)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tried::{self, SEEN, is_slope};
    use super::*;
    use crate::law::material::non_ordinary::correspondence::{Correspondence, Stress};
    use crate::spec::Moduli;
    use crate::spec::Parameter;

    const H: [[f64; 3]; 3] = [[0.11, -0.07, 0.3], [0.2, -0.05, 0.1], [-0.15, 0.02, 0.08]];

    fn ply(fibre: [f64; 3], normal: [f64; 3]) -> Parameters {
        let list = |x: &[f64]| Parameter::List(x.to_vec());
        Parameters::default()
            .with("young", list(&[140.0, 10.0, 8.0]))
            .with("poisson", list(&[0.3, 0.25, 0.4]))
            .with("shear", list(&[5.0, 4.0, 3.5]))
            .with("fibre", list(&fibre))
            .with("normal", list(&normal))
    }

    fn made(d: usize, plane: Plane, parameters: &Parameters) -> Result<Anisotropic, String> {
        tried::made(d, plane, parameters)
    }

    /// Second Piola–Kirchhoff stress at small strains, over them.
    fn small<const D: usize>(law: &Anisotropic, strain: [[f64; D]; D]) -> [[f64; D]; D] {
        let tiny = 1e-9;
        let h = strain.map(|row| row.map(|x| tiny * x));
        let p = law.stress(&law.materials[0], &[], &h, &SEEN).stress;
        p.map(|row| row.map(|x| x / tiny))
    }

    #[test]
    fn stress_is_the_slope_of_energy() {
        let law = made(3, Plane::Strain, &ply([1.0, 2.0, -0.5], [0.3, 0.0, 1.0])).unwrap();
        let energy = |h: &[[f64; 3]; 3]| law.stress(&law.materials[0], &[], h, &SEEN).energy;
        let p = law.stress(&law.materials[0], &[], &H, &SEEN).stress;
        is_slope(&H, (&p, 1e-8), energy);
    }

    /// With the constants of an isotropic solid it is Saint Venant and Kirchhoff's, about any axes, in space and in both planes.
    #[test]
    fn an_isotropic_one_is_saint_venant_and_kirchhoffs() {
        let (e, nu) = (3.0, 0.3);
        let moduli = Moduli {
            young: e,
            poisson: nu,
        };
        let list = |x: f64| Parameter::List(vec![x; 3]);
        let isotropic = |fibre: [f64; 3]| {
            Parameters::default()
                .with("young", list(e))
                .with("poisson", list(nu))
                .with("shear", list(moduli.shear()))
                .with("fibre", Parameter::List(fibre.to_vec()))
        };
        let plain = |plane_stress| Correspondence {
            stress: Stress::Linear,
            plane_stress,
            materials: vec![],
        };
        let c = [moduli.lame(), moduli.shear(), 0.0];
        let space = made(3, Plane::Strain, &isotropic([1.0, 2.0, 0.5])).unwrap();
        let ours = space.stress(&space.materials[0], &[], &H, &SEEN);
        let theirs = plain(false).stress(&c, &[], &H, &SEEN);
        let apart = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
        apart(ours.energy, theirs.energy);
        (0..9).for_each(|n| apart(ours.stress[n / 3][n % 3], theirs.stress[n / 3][n % 3]));
        let h = [[0.11, -0.07], [0.2, -0.05]];
        for plane in [Plane::Strain, Plane::Stress] {
            let law = made(2, plane, &isotropic([1.0, 2.0, 0.0])).unwrap();
            let ours = law.stress(&law.materials[0], &[], &h, &SEEN);
            let theirs = plain(plane == Plane::Stress).stress(&c, &[], &h, &SEEN);
            apart(ours.energy, theirs.energy);
            (0..4).for_each(|n| apart(ours.stress[n / 2][n % 2], theirs.stress[n / 2][n % 2]));
        }
    }

    /// A ply's stiffness in its plane, and off its axes: Jones (2.67) and (2.85), with m, n the cosine and sine of the fibre's angle.
    #[test]
    fn a_ply_off_its_axes_is_that_of_the_book() {
        let (e1, e2, nu12, g12) = (140.0, 10.0, 0.3, 5.0);
        let rest = 1.0 - nu12 * nu12 * e2 / e1;
        let [q11, q22, q12, q66] = [e1 / rest, e2 / rest, nu12 * e2 / rest, g12];
        for angle in [0.0f64, 0.4, -1.1] {
            let (n, m) = angle.sin_cos();
            let law = made(2, Plane::Stress, &ply([m, n, 0.0], [0.0, 0.0, 1.0])).unwrap();
            let [m2, n2] = [m * m, n * n];
            let bar11 = q11 * m2 * m2 + 2.0 * (q12 + 2.0 * q66) * n2 * m2 + q22 * n2 * n2;
            let bar12 = (q11 + q22 - 4.0 * q66) * n2 * m2 + q12 * (n2 * n2 + m2 * m2);
            let bar16 = (q11 - q12 - 2.0 * q66) * n * m2 * m + (q12 - q22 + 2.0 * q66) * n2 * n * m;
            let bar66 = (q11 + q22 - 2.0 * q12 - 2.0 * q66) * n2 * m2 + q66 * (n2 * n2 + m2 * m2);
            let along = small(&law, [[1.0, 0.0], [0.0, 0.0]]);
            let shear = small(&law, [[0.0, 0.5], [0.5, 0.0]]);
            for (found, expected) in [
                (along[0][0], bar11),
                (along[1][1], bar12),
                (along[0][1], bar16),
                (shear[0][0], bar16),
                (shear[0][1], bar66),
            ] {
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{angle}: {found} {expected}"
                );
            }
        }
    }

    /// A bar pulled along an axis has that Young's modulus and those contractions, as the keys say them.
    #[test]
    fn engineering_constants_are_those_of_bars() {
        let (young, poisson) = ([140.0, 10.0, 8.0], [0.3, 0.25, 0.4]);
        let law = made(3, Plane::Strain, &ply([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])).unwrap();
        let [n12, n13, n23] = poisson;
        let [e1, e2, _] = young;
        let bars = [
            [1.0, -n12, -n13],
            [-n12 * e2 / e1, 1.0, -n23],
            [-n13 * young[2] / e1, -n23 * young[2] / e2, 1.0],
        ];
        for (axis, strains) in bars.into_iter().enumerate() {
            let mut strain = [[0.0; 3]; 3];
            (0..3).for_each(|k| strain[k][k] = strains[k]);
            let stress = small(&law, strain);
            for k in 0..3 {
                let expected = if k == axis { young[axis] } else { 0.0 };
                assert!(
                    (stress[k][k] - expected).abs() < 1e-5,
                    "{axis}{k}: {stress:?}"
                );
            }
        }
        let shear = small(&law, [[0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0; 3]]);
        assert!((shear[0][1] - 5.0).abs() < 1e-6);
    }

    #[test]
    fn what_no_solid_can_be_is_refused() {
        let told = |p: &Parameters| made(3, Plane::Strain, p).unwrap_err();
        let list = |x: &[f64]| Parameter::List(x.to_vec());
        let good = || ply([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let wide = good().with("poisson", list(&[4.0, 0.25, 0.4]));
        assert!(
            told(&wide).contains("ν12 is 4, expected below √(E1/E2)"),
            "{}",
            told(&wide)
        );
        let together = good().with("poisson", list(&[3.0, 3.0, 0.8]));
        assert!(
            told(&together).contains("expected above 0"),
            "{}",
            told(&together)
        );
        let parallel = ply([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]);
        assert!(told(&parallel).contains("are parallel"));
        let mut upper = vec![0.0; 21];
        [0, 6, 11, 15, 18, 20].iter().for_each(|n| upper[*n] = 1.0);
        let cube = Parameters::default().with("stiffness", list(&upper));
        assert!(made(3, Plane::Strain, &cube).is_ok());
        upper[1] = 1.5;
        let soft = Parameters::default().with("stiffness", list(&upper));
        assert!(told(&soft).contains("not positive definite"));
        let both = cube.with("shear", list(&[1.0; 3]));
        assert!(told(&both).contains("`stiffness` says it all"));
        let tilted = ply([1.0, 0.0, 0.5], [0.0, 0.0, 1.0]);
        let plane = made(2, Plane::Stress, &tilted).unwrap_err();
        assert!(plane.contains("`fibre` lies in the plane"), "{plane}");
    }

    /// Voigt's mean of a stiffness does not see how it is turned.
    #[test]
    fn the_mean_is_that_of_all_directions() {
        let own = orthotropic([140.0, 10.0, 8.0], [0.3, 0.25, 0.4], [5.0, 4.0, 3.5]).unwrap();
        let axes = Axes::written(&ply([1.0, 2.0, -0.5], [0.3, 0.0, 1.0]));
        let axes = axes.at(&[0.0; 3]).unwrap();
        let [a, b] = [mean(&own), mean(&turned(&own, &axes))];
        assert!((a.young / b.young - 1.0).abs() < 1e-14, "{a:?} {b:?}");
        assert!((a.poisson / b.poisson - 1.0).abs() < 1e-13, "{a:?} {b:?}");
    }
}
