use super::*;
use crate::crystal::Crystal;
use crate::exact::{Q, q};
use crate::gradient::comparison::compare;
use peridyne::law::potential::buckingham::Buckingham;
use peridyne::law::potential::cut::Cut;
use peridyne::law::potential::cut::Ends;
use peridyne::law::potential::mei::{EamForm, Mei};
use peridyne::law::potential::morse::Morse;
use peridyne::law::potential::tabulated::Tabulated;
use peridyne::spec::{End, TableSpec};

/// A chain at a stretch whose law is a sum of powers: the polynomials in y″, y‴, … with the power of y′ put in.
fn at_stretch(e: &Expansion<Q>, stretch: &Q) -> Expansion<Q> {
    let put = |p: &JetPolynomial<Q>| {
        p.terms().fold(JetPolynomial::zero(), |sum, (m, c)| {
            let powers: Vec<i32> = (1..=m.highest()).map(|k| m.power(k)).collect();
            let c = c.clone() * stretch.to(powers[0]);
            sum.add(&JetPolynomial::term(c, &[&[0], &powers[1..]].concat()))
        })
    };
    Expansion {
        orders: e.orders.iter().map(put).collect(),
    }
}

#[test]
fn power_laws_are_met_as_fractions() {
    let lj = PowerLawChain::lennard_jones(q(1, 72), q(2, 5), q(3, 2), 4);
    let odd = PowerLawChain {
        amplitudes: vec![(-2, q(1, 2)), (1, q(-3, 1)), (9, q(1, 5))],
        spacing: q(2, 1),
        neighbours: 3,
    };
    for chain in [lj, odd] {
        for stretch in [q(1, 1), q(9, 10), q(13, 8)] {
            let found = expansion(&chain, &stretch, 4).unwrap();
            assert_eq!(found, at_stretch(&chain.expansion(4), &stretch));
        }
    }
}

#[test]
fn lines_stay_lines_at_every_stretch() {
    let weights = [q(1, 1), q(1, 2), q(1, 3)];
    let chains = [
        LinearChain::springs(q(5, 3), q(2, 7), 5),
        LinearChain::structured_eam(q(3, 1), q(7, 2), 1, q(1, 3), 4),
        LinearChain::structured_eam(q(3, 1), q(7, 2), 2, q(1, 3), 2),
        LinearChain::bond_based(q(2, 1), &weights, q(1, 4)),
        LinearChain::state_based([q(3, 1), q(2, 5), q(3, 2)], &weights, q(1, 4)),
    ];
    for chain in chains {
        for stretch in [q(1, 1), q(7, 5)] {
            let found = expansion(&chain, &stretch, 3).unwrap();
            assert_eq!(found, chain.expansion(3));
        }
    }
}

#[test]
fn one_resolution_of_lennard_jones_is_its_upscaling_at_every_stretch() {
    let [e, s6] = PowerLawChain::upscaled_parameters(q(1, 72), q(1, 2), q(1, 1), 4);
    let fine = PowerLawChain::lennard_jones(q(1, 72), q(1, 2), q(1, 1), 4);
    let at = |h: i64, n: usize, stretch: &Q| {
        let chain = PowerLawChain::lennard_jones_upscaled(e.clone(), s6.clone(), q(h, 1), n);
        compare(
            &expansion(&fine, stretch, 3).unwrap(),
            &expansion(&chain, stretch, 3).unwrap(),
            0.0,
        )
        .equal_to_order()
    };
    for stretch in [q(1, 1), q(11, 10)] {
        assert_eq!(at(1, 4, &stretch), 6);
        assert_eq!(at(2, 2, &stretch), 2);
    }
}

/// Force density of the points themselves at x = 0.
fn points(chain: &impl Chain<f64>, neighbours: i32, y: impl Fn(f64) -> f64) -> f64 {
    let a = chain.spacing();
    let place = |i: i32| y(f64::from(i) * a);
    let bond = |i: i32, k: i32| {
        let (j, r) = (i.abs_diff(k) as usize, (place(k) - place(i)).abs());
        (j, r)
    };
    let others = |i: i32| (i - neighbours..=i + neighbours).filter(move |k| *k != i);
    let slope = |i: i32| {
        let rho = others(i).map(|k| {
            let (j, r) = bond(i, k);
            chain.density(j, &r, 1)[0]
        });
        chain.embedding(&rho.sum(), 2)[1]
    };
    let force = others(0).map(|k| {
        let (j, r) = bond(0, k);
        let tension = chain.pair(j, &r, 2)[1] + (slope(0) + slope(k)) * chain.density(j, &r, 2)[1];
        tension * f64::from(k.signum())
    });
    force.sum::<f64>() / a
}

/// On waves of growing length, from these on, the points leave the equation of 1, 2, … terms with the power of the next.
fn meets_the_points(name: &str, chain: &impl Chain<f64>, stretch: f64, lengths: &[f64]) {
    let neighbours = chain.neighbours(&stretch).unwrap();
    // y = stretch x + 0.05 L sin(x/L + 0.7), at x = 0
    let jet = |length: f64| -> Vec<f64> {
        let (c, s) = (0.7f64.cos(), 0.7f64.sin());
        let wave = |k: i32| 0.05 * length.powi(1 - k) * [s, c, -s, -c][(k % 4) as usize];
        (1..=2 * lengths.len() as i32 + 1).map(wave).collect()
    };
    for (terms, long) in (1..).zip(lengths) {
        let error = |length: f64| {
            let mut jet = jet(length);
            jet[0] += stretch;
            let equation = expansion(chain, &jet[0], terms).unwrap();
            let y = |x: f64| stretch * x + 0.05 * length * (x / length + 0.7).sin();
            let exact = points(chain, neighbours as i32, y);
            ((equation.at(&jet) - exact).abs(), exact.abs())
        };
        let (near, far) = (error(*long), error(1.5 * long));
        let order = (near.0 / far.0).ln() / 1.5f64.ln();
        let expected = (2 * terms + 1) as f64;
        assert!(
            (order - expected).abs() < 0.25,
            "{name}, {terms} terms: {order}, {:e} of {:e}",
            near.0,
            near.1
        );
    }
}

fn mei(distance: f64) -> Mei {
    Mei::new(EamForm {
        cohesive: 3.54,
        pair: 0.1287,
        alpha: 5.0857,
        beta: 5.8509,
        gamma: 8.0,
        lambda: 5.7874,
        density: [0.64085, -6.83764, 26.75616, -47.16495, 36.18925, -8.60834],
        density_scale: 1.0 / 12.0,
        pair_length: 2.0,
        density_length: 1.0,
        near: 1.75,
        cutoff: 1.95,
        shells: vec![(2.0, 1.0)],
        nearest: distance,
        shell_scale: 1.0,
    })
}

#[test]
fn equations_meet_the_points_to_the_next_order() {
    let horizon = |m| Reach::Horizon(peridyne::spec::Horizon::Ratio(m));
    let morse = Morse {
        depth: 0.7,
        alpha: 1.3,
        distance: 1.1,
    };
    let chain = PotentialChain::new(Cut::new(morse, Ends::NONE), 1.0, horizon(3));
    meets_the_points("Morse", &chain.unwrap(), 1.05, &[12.0; 4]);
    let buckingham = Buckingham {
        strength: 400.0,
        range: 0.2,
        dispersion: 2.0,
    };
    let whole = Cut::new(buckingham, Ends::NONE);
    let chain = PotentialChain::new(whole, 1.0, horizon(2)).unwrap();
    meets_the_points("Buckingham", &chain, 1.1, &[12.0; 3]);
    let chain = PotentialChain::new(mei(1.0), 1.0, Reach::Cutoff).unwrap();
    meets_the_points("embedded atoms", &chain, 1.0, &[30.0, 24.0, 12.0]);
    // a smooth end that acts on the second neighbours
    let smooth = Cut::new(
        morse,
        Ends {
            cutoff: 3.5,
            end: End::Smooth(1.2),
        },
    );
    let chain = PotentialChain::new(smooth, 1.0, Reach::Cutoff).unwrap();
    meets_the_points("smooth Morse", &chain, 1.0, &[60.0; 2]);
    // within one piece of each table
    let table = |step: f64, f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..12).map(|m| f(step * f64::from(m))).collect()
    };
    let eam = Tabulated::new(&TableSpec {
        density_step: 0.25,
        embedding: table(0.25, &|rho| -1.3 * rho.sqrt()),
        step: 0.25,
        density: table(0.25, &|r| (-1.2 * r).exp()),
        pair: table(0.25, &|r| 3.0 * r * (-4.0 * r).exp()),
        cutoff: 2.3,
        element: "X".into(),
        partners: vec![],
    });
    let chain = PotentialChain::new(eam, 1.0, Reach::Cutoff).unwrap();
    meets_the_points("a table", &chain, 1.05, &[30.0, 20.0, 12.0]);
}

#[test]
fn small_strains_of_an_unstretched_chain_are_linear() {
    let horizon = Reach::Horizon(peridyne::spec::Horizon::Ratio(3));
    let morse = Morse {
        depth: 0.7,
        alpha: 1.3,
        distance: 1.1,
    };
    fn check(potential: impl Potential, spacing: f64, reach: Reach) {
        let (crystal, _) =
            Crystal::<1>::of_potential(&potential, LatticeKind::Chain, spacing, 1.0, reach)
                .unwrap();
        let linear = LinearChain::of_crystal(&crystal).unwrap().coefficients(4);
        let chain = PotentialChain::new(potential, spacing, reach).unwrap();
        let nonlinear = expansion(&chain, &1.0, 4).unwrap();
        for (p, c) in linear.iter().enumerate() {
            let mut powers = vec![0; 2 * p + 2];
            powers[2 * p + 1] = 1;
            let found = nonlinear.orders[p].coefficient(&powers);
            assert!((found / c - 1.0).abs() < 1e-11, "{p}: {found} {c}");
        }
    }
    check(Cut::new(morse, Ends::NONE), 1.2, horizon);
    check(mei(1.0), 1.02, Reach::Cutoff);
    // powers of metres leave the range of numbers, sums in units of the spacing do not
    check(mei(2.5e-10), 2.5e-10, Reach::Cutoff);
}

#[test]
fn states_without_an_equation_say_why() {
    let chain = PotentialChain::new(mei(1.0), 1.0, Reach::Cutoff).unwrap();
    let why = |stretch, terms| expansion(&chain, &stretch, terms).unwrap_err();
    assert!(matches!(why(2.5, 1), CrystalError::NoNeighbours { .. }));
    assert!(matches!(why(-1.0, 1), CrystalError::NotPositive { .. }));
    let mut spec = mei(1.0).spec().clone();
    spec.density = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let negative = PotentialChain::new(Mei::new(spec), 1.0, Reach::Cutoff).unwrap();
    assert!(matches!(
        expansion(&negative, &1.0, 1),
        Err(CrystalError::Density { .. })
    ));
    let many = CrystalError::TooManyTerms {
        requested: MOST_TERMS + 1,
        most: MOST_TERMS,
    };
    assert_eq!(why(1.0, MOST_TERMS + 1), many);
    let endless = PotentialChain::new(
        Cut::new(
            Buckingham {
                strength: 1.0,
                range: 1.0,
                dispersion: 0.0,
            },
            Ends::NONE,
        ),
        1.0,
        Reach::Cutoff,
    );
    assert_eq!(endless.unwrap_err(), CrystalError::NoCutoff);
}
