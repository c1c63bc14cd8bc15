//! (4.0.6), (4.0.8), (4.0.9), (4.0.10), (4.0.72), (4.0.93): the balance laws, and what is wrong in their terms as printed.

use std::sync::Arc;

use peridyne::law::terms::Sites;
use peridyne::spec::{BondedSpec, BondedTerm, Form};
use peridyne_fields::molecules::Molecules;
use peridyne_fields::residuals::{RIGHT, Residual, Residuals, Signs, of};
use peridyne_fields::specimen::Random;
use peridyne_fields::{Cell, Frame, Method, Partition, Quantity, Shape, Targets, evaluate};

use super::particles::{
    DIAMOND, FCC, Vector, crystal, failed, lennard_jones, less, method, plus, silicon, size,
    square_root, times,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Balance,
    "balance",
    "Balance of mass, momentum and energy of particles",
    ["../particles.rs"]
);

/// Particles, what they say to each other, and how fields are made of them.
struct Case {
    name: &'static str,
    frame: Frame,
    sites: Box<dyn Sites>,
    method: Method,
}

fn smooth() -> Result<Method, Failure> {
    method(Shape::Polynomial(5), 1.6)
}

fn cases() -> Result<Vec<Case>, Failure> {
    let of = |name, frame, sites| -> Result<Case, Failure> {
        Ok(Case {
            name,
            frame,
            sites,
            method: smooth()?,
        })
    };
    let mut all = vec![
        of("pairs", crystal(&FCC, 3, 1.6, 0.08)?, lennard_jones()?)?,
        of(
            "embedded",
            crystal(&FCC, 3, 1.6, 0.08)?,
            Box::new(square_root()),
        )?,
        of("triplets", crystal(&DIAMOND, 2, 2.59, 0.08)?, silicon()?)?,
        of("torsion", molecule()?, lennard_jones()?)?,
    ];
    all[3].method.molecules = Some(Arc::new(Molecules::new(bonded(), 5).map_err(failed)?));
    Ok(all)
}

/// Five atoms in a bent chain.
fn molecule() -> Result<Frame, Failure> {
    let mut random = Random(7);
    Ok(Frame {
        cell: Cell::free(3.0),
        position: vec![
            [-1.4, 0.9, 0.3],
            [-0.6, 0.2, 0.0],
            [0.4, 0.3, -0.3],
            [0.9, -0.5, 0.2],
            [1.8, -0.4, 0.7],
        ],
        velocity: Some((0..5).map(|_| plus(random.vector(), [0.3; 3])).collect()),
        mass: vec![1.0, 0.8, 1.1, 0.9, 1.2],
        kind: vec![0; 5],
        time: None,
    })
}

/// What holds it together, with nothing left of the pairs that are bonded.
fn bonded() -> BondedSpec {
    let forms = vec![
        Form::HarmonicBond {
            stiffness: 30.0,
            length: 1.0,
        },
        Form::HarmonicAngle {
            stiffness: 6.0,
            angle: 1.9,
        },
        Form::Dihedral {
            powers: vec![1.0, 0.7, -0.4, 0.9],
        },
    ];
    let chain = [0u32, 1, 2, 3, 4];
    let mut terms = vec![];
    for (form, count) in [(0, 2), (1, 3), (2, 4)] {
        for of in chain.windows(count) {
            let mut points = [0; 4];
            points[..count].copy_from_slice(of);
            terms.push(BondedTerm { form, points });
        }
    }
    BondedSpec {
        forms,
        terms,
        special: [0.0, 0.0, 0.5],
    }
}

impl Case {
    fn points(&self) -> Vec<Vector> {
        let mut random = Random(11);
        let centre = match self.frame.cell.periodic[0] {
            true => self.frame.cell.at([0.5; 3]),
            false => [0.0; 3],
        };
        (0..8)
            .map(|_| plus(centre, times(0.8, random.vector())))
            .collect()
    }

    fn residuals(&self, step: f64, method: &Method, signs: Signs) -> Result<Residuals, Failure> {
        let points = self.points();
        let found = of(
            &self.frame,
            None,
            &*self.sites,
            method,
            &points,
            step,
            signs,
        );
        found.map_err(failed)
    }
}

fn order(near: Residual, far: Residual) -> f64 {
    (far.value / near.value).log2()
}

fn laws(r: &Residuals) -> [Residual; 3] {
    [r.mass, r.momentum, r.energy]
}

fn run(_: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let all = cases()?;
    let mut sizes = vec![];
    for case in &all {
        let [far, near] = [0.04, 0.02].map(|h| case.residuals(h, &case.method, RIGHT));
        let [far, near] = [laws(&far?), laws(&near?)];
        let orders: Vec<f64> = near.iter().zip(far).map(|(n, f)| order(*n, f)).collect();
        let off = largest(orders.iter().map(|o| (o - 2.0).abs()));
        found.number(&format!("order-{}", case.name), off);
        for (law, r) in ["mass", "momentum", "energy"].iter().zip(near) {
            found.measured(
                &format!("{}: {law}, left over what cancels", case.name),
                r.relative(),
                "",
            );
            sizes.push((r.value / r.expected - 1.0).abs());
        }
    }
    found.number("expected", largest(sizes));
    internal(&mut found, &all)?;
    heat(&mut found, &all[2])?;
    sign(&mut found, &all[0])?;
    place(&mut found, &all[0])?;
    apart(&mut found, &all[1])?;
    Ok(found)
}

/// Residuals that stay when the steps shrink to a half: the order, and what is left over what should be.
fn stays(near: Residual, far: Residual) -> bool {
    order(near, far) < 1.0 && near.value > 5.0 * near.expected
}

fn heat(found: &mut Findings, silicon: &Case) -> Result<(), Failure> {
    let equal = Method {
        partition: Partition::Equal,
        ..silicon.method.clone()
    };
    let printed = Signs {
        heat_churning: 0.0,
        ..RIGHT
    };
    let of = |signs| -> Result<[Residual; 2], Failure> {
        let near = silicon.residuals(0.02, &equal, signs)?;
        Ok([near.energy, silicon.residuals(0.04, &equal, signs)?.energy])
    };
    let ([near, far], [short, shorter]) = (of(RIGHT)?, of(printed)?);
    found.holds(
        "4.0.140",
        format!(
            "with q_C order {:.2}; without it {:.1e} of what cancels stays, order {:.2}",
            order(near, far),
            short.relative(),
            order(short, shorter)
        ),
        (order(near, far) - 2.0).abs() < 0.1 && stays(short, shorter),
    );
    Ok(())
}

fn sign(found: &mut Findings, pairs: &Case) -> Result<(), Failure> {
    let other = Signs {
        stress: -1.0,
        ..RIGHT
    };
    let mut seen = vec![];
    for signs in [RIGHT, other] {
        let near = pairs.residuals(0.02, &pairs.method, signs)?.momentum;
        let far = pairs.residuals(0.04, &pairs.method, signs)?.momentum;
        seen.push((order(near, far), near.relative(), stays(near, far)));
    }
    found.holds(
        "4.0.84",
        format!(
            "order {:.2} with the first; with the other {:.2} of what cancels stays",
            seen[0].0, seen[1].1
        ),
        (seen[0].0 - 2.0).abs() < 0.1 && seen[1].2,
    );
    Ok(())
}

/// Of all kinds of potential.
fn internal(found: &mut Findings, all: &[Case]) -> Result<(), Failure> {
    let mut off = vec![];
    for case in all {
        let of = |h| -> Result<Residual, Failure> {
            Ok(case.residuals(h, &case.method, RIGHT)?.internal_energy)
        };
        let (far, near) = (of(0.04)?, of(0.02)?);
        off.push((order(near, far) - 2.0).abs());
        let what = format!("{}: internal energy, left over what cancels", case.name);
        found.measured(&what, near.relative(), "");
    }
    found.number("4.0.10", largest(off));
    Ok(())
}

/// The material coordinate y, and the angular momentum ρ y × v.
fn place(found: &mut Findings, pairs: &Case) -> Result<(), Failure> {
    let printed = Signs {
        coordinate: -1.0,
        ..RIGHT
    };
    let material = Signs {
        torque: 0.0,
        ..RIGHT
    };
    type Law = fn(&Residuals) -> Residual;
    let laws: [(&str, &str, Signs, Law); 2] = [
        ("4.0.72", "with the sign as printed", printed, |r| {
            r.coordinate
        }),
        ("4.0.93", "with y taken for material", material, |r| {
            r.angular_momentum
        }),
    ];
    for (key, words, signs, law) in laws {
        let of = |signs| -> Result<[Residual; 2], Failure> {
            let [near, far] = [0.02, 0.04].map(|h| pairs.residuals(h, &pairs.method, signs));
            Ok([law(&near?), law(&far?)])
        };
        let ([near, far], [short, shorter]) = (of(RIGHT)?, of(signs)?);
        found.holds(
            key,
            format!(
                "order {:.2}; {words} {:.1e} of what cancels stays, order {:.2}",
                order(near, far),
                short.relative(),
                order(short, shorter)
            ),
            (order(near, far) - 2.0).abs() < 0.1 && stays(short, shorter),
        );
    }
    Ok(())
}

/// Momentum about the mean velocity, by hand from the fields.
fn apart(found: &mut Findings, case: &Case) -> Result<(), Failure> {
    let points = case.points();
    let targets = Targets::Points(points.clone());
    let fields = evaluate(&case.frame, &*case.sites, &targets, &case.method).map_err(failed)?;
    let velocity = fields.get(Quantity::Velocity).unwrap_or_default();
    let kernel = &case.method.kernel;
    let period = case.frame.cell.edges[0][0];
    let mut worst = vec![];
    for (x, v) in points.iter().zip(velocity.chunks_exact(3)) {
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        let moving = case.frame.velocity.iter().flatten();
        for ((y, w), m) in case.frame.position.iter().zip(moving).zip(&case.frame.mass) {
            let d = less(*x, *y).map(|d| d - (d / period).round() * period);
            let u = less(*w, [v[0], v[1], v[2]]);
            let part = m * kernel.value(d);
            sum = plus(sum, times(part, u));
            whole += part * size(&u);
        }
        worst.push(size(&sum) / whole);
    }
    found.number("4.0.69", largest(worst));
    Ok(())
}
