//! The same bits: on any number of threads, and of a run that goes on elsewhere.

use crate::sample::*;
use peridyne::spec::*;

/// Enough points for several pieces of work.
fn block(method: DiffusionMethod, stepper: Stepper) -> Spec {
    let mut heat = heat(method);
    heat.initial = vec![("all".into(), text("1 + sin(7*x + 3*y) * cos(11*z)"))];
    let law = Exchange::Radiation {
        coefficient: text("0.1"),
        ambient: text("2"),
    };
    heat.conditions = vec![
        on("low", DiffusionKind::Exchange { law, area: None }),
        on("high", DiffusionKind::Value(text("1 + t*y"))),
    ];
    let mut species = DiffusionSpec {
        quantity: Quantity::Species,
        ..heat.clone()
    };
    species.conditions.truncate(1);
    let mut spec = still(3, cells(3, 0.1, [0.0; 3], [3.0, 1.4, 1.2]), 2, 1e-3, heat);
    spec.interactions.diffusions.push(species);
    spec.run.schedule.stepper = stepper;
    spec.sets = vec![beyond("low", 0.1, -1.0), beyond("high", 2.8, 1.0)];
    spec
}

const METHODS: [DiffusionMethod; 3] = [EXPLICIT, CRANK_NICOLSON, STEADY];

#[test]
fn threads_do_not_show() {
    for method in METHODS {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let mut sim = built(&block(method, Stepper::Still));
                run(&mut *sim, 5);
                let mut bits: Vec<u64> =
                    temperature(&mut *sim).iter().map(|t| t.to_bits()).collect();
                let accounts = sim.diffusions();
                bits.extend(accounts.iter().map(|(_, a)| a.residual().to_bits()));
                bits
            })
        };
        assert!(on(1) == on(4) && on(3) == on(2), "{method:?}");
    }
}

#[test]
fn a_run_that_goes_on_elsewhere_has_the_same_bits() {
    for method in METHODS {
        for stepper in [Stepper::Still, Stepper::Verlet] {
            let spec = block(method, stepper);
            let mut whole = built(&spec);
            run(&mut *whole, 4);
            let mut part = peridyne::run::build(&spec, peridyne::run::Options::default()).unwrap();
            for name in ["temperature", "concentration"] {
                let declared = whole.columns();
                let column = declared.iter().find(|c| c.name == name).unwrap();
                assert_eq!(column.life, peridyne::columns::Life::Persistent);
                let values = scalars(&mut *whole, name);
                assert!(part.set_column(name, &values));
                assert!(!part.set_column(name, &values[1..]));
            }
            part.set_time(whole.step_number(), whole.time());
            part.start(true);
            run(&mut *whole, 4);
            run(&mut *part, 4);
            for name in ["temperature", "concentration"] {
                let [a, b] = [&mut whole, &mut part].map(|s| scalars(&mut **s, name));
                assert!(a == b, "{method:?}, {stepper:?}, {name}");
            }
        }
    }
}
