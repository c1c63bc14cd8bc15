//! Watches the energy balance of a run: a residual that jumps is said when it does.

use peridyne::error::RunError;
use peridyne::message;
use peridyne::observe::Ledger;
use peridyne::quantity::{Dimension, Message, rounded};
use peridyne::run::Info;
use peridyne::state::{Archive, Owner};

/// Growth of the residual from one row to the next that is a jump.
const JUMP: f64 = 16.0;
/// Residuals below this part of the energy are the error of the time step.
const SMALL: f64 = 1e-4;
/// Growth, from one row to the next, of the energy that a body was given: while it is more, loading only begins, and the error
/// of the time step is large beside so little energy. A step that is too long grows without being given anything.
const BEGINS: f64 = 2.0;

/// Energy out of nothing, as a part of the energy, that no run goes on with.
const LOST: f64 = 0.5;

/// Energy that breaking made, as a part of the energy, that is said.
const MADE: f64 = 0.01;
/// Residual of equilibria, as a part of the work, that is said: forces are off by more than that.
const OFF: f64 = 0.02;

/// What the last row of the history had.
#[derive(Debug, Default)]
pub struct BalanceWatch {
    /// The first row misses nothing by definition: what the first steps miss is no jump.
    begun: bool,
    last: Option<(u64, f64, f64)>,
    /// Energy that the body was given.
    given: f64,
    /// Is it much more than in the row before?
    begins: bool,
    /// The most of it so far.
    most: f64,
    /// The most energy so far.
    scale: f64,
    /// Is there too much out of nothing in the last row, and in that before?
    lost: bool,
    gone: bool,
    /// Was it said that breaking makes energy, or that equilibria are off?
    told: bool,
}

impl Owner for BalanceWatch {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let mut last = self.last.map(|(step, was, contact)| (step, (was, contact)));
        archive.one("last", &mut last);
        self.last = last.map(|(step, (was, contact))| (step, was, contact));
        for (name, x) in [
            ("given", &mut self.given),
            ("most", &mut self.most),
            ("scale", &mut self.scale),
        ] {
            archive.one(name, x);
        }
        for (name, x) in [
            ("begun", &mut self.begun),
            ("lost", &mut self.lost),
            ("gone", &mut self.gone),
            ("told", &mut self.told),
        ] {
            archive.one(name, x);
        }
    }
}

impl BalanceWatch {
    /// Two rows in turn, while the body was given little, have half of its energy out of nothing: why such a run is at its end.
    pub fn gone(&self, step: u64, ledger: &Ledger, info: &Info) -> Option<RunError> {
        if !(self.gone && info.conserves) {
            return None;
        }
        let before = self.most;
        if ledger.made > ledger.residual() {
            return Some(RunError::Made {
                step,
                given: before,
                made: ledger.made,
            });
        }
        Some(RunError::Unstable {
            step,
            before,
            after: before + ledger.residual(),
            time_step: info.time_step,
            contact: (ledger.contact > SMALL * self.scale).then_some(info.contact_step),
        })
    }

    /// Of the row of an equilibrium that was just [taken](BalanceWatch::row): what to warn of, once.
    pub fn equilibrium(&mut self, step: u64, ledger: &Ledger) -> Option<Message> {
        // of bodies that are loaded: where an equilibrium is sought from a start far from any, no work says how far it is off
        let work = ledger.work_boundary_conditions.abs() + ledger.work_rigid_bodies.abs();
        let off = ledger.residual().abs() / self.scale;
        let loaded = !self.begins && 2.0 * work > self.scale;
        if !(loaded && off > OFF) || std::mem::replace(&mut self.told, true) {
            return None;
        }
        Some(message![
            format!("step {step}: the energy balance error is "),
            Dimension::ENERGY.of(ledger.residual()),
            format!(
                " ({} % of the energy): these are no close equilibria, and reactions are off by more; take a smaller tolerance, or more increments of load",
                rounded(100.0 * off, 3)
            ),
        ])
    }

    /// A row: what to warn of, if its residual is 16 times that of the row before.
    /// `statics`: steps are increments of load.
    pub fn row(&mut self, step: u64, ledger: &Ledger, statics: bool) -> Option<Message> {
        let residual = ledger.residual();
        let work = ledger.work_boundary_conditions.abs() + ledger.work_rigid_bodies.abs();
        let given = work + ledger.initial.abs();
        let begins = given > BEGINS * std::mem::replace(&mut self.given, given);
        self.begins = begins;
        self.most = self.most.max(given);
        let lost = !begins && residual + ledger.made > LOST * self.most;
        self.gone = std::mem::replace(&mut self.lost, lost) && lost;
        let held = ledger.held() - ledger.dissipated;
        self.scale = self.scale.max(given).max(held.min(10.0 * self.scale));
        if !std::mem::replace(&mut self.begun, true) {
            return None;
        }
        if ledger.made > MADE * self.scale && !std::mem::replace(&mut self.told, true) {
            return Some(message![
                format!("step {step}: breaking has made "),
                Dimension::ENERGY.of(ledger.made),
                format!(
                    " of energy so far ({} % of the energy): points hold more without the bonds that broke than with them; the history says how it grows",
                    rounded(100.0 * ledger.made / self.scale, 3)
                ),
            ]);
        }
        let before = self.last.replace((step, residual, ledger.contact));
        let (then, was, contact) = before?;
        if begins || self.scale == 0.0 {
            return None;
        }
        let least = was.abs().max(SMALL * self.scale);
        if !(residual.abs() > JUMP * least) {
            return None;
        }
        let energy = |e: f64| Dimension::ENERGY.of(e);
        let percent = 100.0 * residual.abs() / self.scale;
        let cause = if ledger.contact.max(contact) > SMALL * self.scale {
            message![
                "; contact held ",
                energy(contact),
                " then and holds ",
                energy(ledger.contact),
                match statics {
                    true => " now: it may be too stiff for these increments of load",
                    false => " now: it may be too stiff for this step",
                },
            ]
        } else if statics {
            ": the increments of load may be too large, or the tolerance of their equilibria".into()
        } else {
            ": the step may be too long".into()
        };
        Some(message![
            format!("step {step}: the energy balance error is "),
            energy(residual),
            format!(
                " ({} % of the energy), at step {then} it was ",
                rounded(percent, 3)
            ),
            energy(was),
            cause,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ledger(kinetic: f64, contact: f64) -> Ledger {
        Ledger {
            kinetic,
            contact,
            initial: 1.0,
            ..Ledger::default()
        }
    }

    #[test]
    fn a_jump_is_told_once_and_a_drift_is_not() {
        let mut watch = BalanceWatch::default();
        for (step, kinetic) in [
            (0, 1.0),
            (10, 1.00001),
            (20, 1.0001),
            (30, 1.0015),
            (40, 1.01),
        ] {
            assert_eq!(
                watch.row(step, &ledger(kinetic, 0.0), false),
                None,
                "{step}"
            );
        }
        let told = watch.row(50, &ledger(0.9, 0.3), false).unwrap();
        assert!(
            told.starts_with("step 50: the energy balance error is 0.2 (16.7 %"),
            "{told}"
        );
        assert!(
            told.contains("contact held 0 then and holds 0.3 now"),
            "{told}"
        );
        assert_eq!(watch.row(60, &ledger(0.9, 0.35), false), None);
    }

    #[test]
    fn the_beginning_of_a_load_is_no_jump_and_a_step_too_long_under_load_is() {
        let under = |work: f64, off: f64| Ledger {
            kinetic: work + off,
            work_boundary_conditions: work,
            ..Ledger::default()
        };
        let mut watch = BalanceWatch::default();
        for (step, work, off) in [
            (0, 0.0, 0.0),
            (4, 0.0, 0.0),
            (5, 0.0, 1e-15),
            (10, 1e-9, 1e-11),
            (20, 1e-6, 1e-9),
            (30, 1.0, 0.01),
            (40, 3.0, 0.015),
            (50, 5.0, 0.016),
        ] {
            assert_eq!(watch.row(step, &under(work, off), false), None, "{step}");
        }
        let told = watch.row(60, &under(6.0, 0.5), false).unwrap();
        assert!(told.contains("the step may be too long"), "{told}");
        // increments of load have no step
        let told = watch.row(70, &under(6.0, 9.0), true).unwrap();
        assert!(told.contains("the increments of load may be"), "{told}");
        assert!(!told.contains("the step may"), "{told}");
    }

    #[test]
    fn equilibria_that_are_not_close_are_told_once() {
        let at = |step: u64, off: f64| Ledger {
            strain: 1.0 + 0.1 * step as f64 + off,
            work_boundary_conditions: 1.0 + 0.1 * step as f64,
            ..Ledger::default()
        };
        let rows = [0.0, 0.005, -0.01, -0.03, -0.05, -0.05];
        for statics in [true, false] {
            let mut watch = BalanceWatch::default();
            let each = (0u64..).zip(rows);
            let told = each.filter_map(|(step, off)| {
                let row = watch.row(step, &at(step, off), statics);
                row.or_else(|| statics.then(|| watch.equilibrium(step, &at(step, off)))?)
            });
            let told: Vec<String> = told.map(|m| m.to_string()).collect();
            match statics {
                true => assert!(
                    told.len() == 1 && told[0].contains("no close equilibria"),
                    "{told:?}"
                ),
                false => assert!(told.is_empty(), "{told:?}"),
            }
        }
    }

    /// Energy that grows out of nothing ends a run in the second row, that which a load brings or friction takes does not.
    #[test]
    fn energy_out_of_nothing_ends_a_run() {
        let mut watch = BalanceWatch::default();
        let mut of = |rows: &[(f64, f64)]| {
            let rows = rows.iter().enumerate();
            rows.map(|(n, (kinetic, work))| {
                let mut ledger = ledger(*kinetic, 0.0);
                ledger.work_boundary_conditions = *work;
                watch.row(n as u64, &ledger, false);
                watch.gone
            })
            .collect::<Vec<_>>()
        };
        let rows = [
            (1.0, 0.0),
            (1.3, 0.0),
            (1.7, 0.0),
            (1.4, 0.0),
            (1.6, 0.0),
            (1.7, 0.0),
        ];
        assert_eq!(of(&rows), [false, false, false, false, false, true]);
        assert_eq!(
            of(&[(1.0, 0.0), (4.0, 3.0), (9.0, 8.0), (9.1, 8.0)]),
            [false; 4]
        );
        assert_eq!(of(&[(1.0, 0.0), (0.1, 0.0), (0.1, 0.0)]), [false; 3]);
    }

    /// What breaking makes is out of nothing, too, though it has its account.
    #[test]
    fn energy_that_breaking_makes_ends_a_run() {
        let mut watch = BalanceWatch::default();
        let of = |made: f64| Ledger {
            made,
            ..ledger(1.0 + made, 0.0)
        };
        let gone = [0.0, 0.4, 0.6, 0.7].map(|made| {
            watch.row(1, &of(made), false);
            watch.gone
        });
        assert_eq!(gone, [false, false, false, true]);
        assert!(of(0.7).residual().abs() < 1e-15);
    }
}
