//! What fixes do at the end of a step: `fix momentum`, `print`, `ave/time`.

use super::FixKind;
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::host::Quantity;
use crate::script::Script;
use crate::session::Session;
use crate::text::Text;

impl Script<'_> {
    /// Runs what fixes do at the end of a step, or (`at_start`) at the start of a run.
    ///
    /// # Errors
    /// A value cannot be computed or written.
    pub fn end_of_step(&mut self, at_start: bool) -> Result<()> {
        for k in 0..self.session.fixes.all.len() {
            let fix = self.session.fixes.all[k].clone();
            let step = self.session.progress.step;
            match &fix.kind {
                FixKind::Momentum {
                    every,
                    linear,
                    angular,
                    rescale,
                } if !at_start && step.is_multiple_of(*every) => {
                    let members = fix.members.clone();
                    self.session.calm(&members, *linear, *angular, *rescale)?;
                }
                FixKind::Print {
                    every,
                    text,
                    screen,
                    file,
                } if step.is_multiple_of(*every) => {
                    let mut line = Text::default();
                    line.push_str(text, 0);
                    let line = self.substitute(&line).map_err(|mut p| {
                        // the text stands where the fix was made
                        p.place = Default::default();
                        p.message = format!("{} (in the text of fix `{}`)", p.message, fix.id);
                        p
                    })?;
                    if *screen {
                        self.session.console.print(line.as_str());
                    }
                    if let Some(file) = file {
                        file.borrow_mut().line(line.as_str())?;
                    }
                }
                FixKind::Average(average) => {
                    let average = average.clone();
                    self.session.sample(&average)?;
                }
                FixKind::Momentum { .. }
                | FixKind::Print { .. }
                | FixKind::Nve
                | FixKind::Indent { .. }
                | FixKind::SetForce { .. }
                | FixKind::AddForce { .. }
                | FixKind::Viscous(_)
                | FixKind::Enforce2d
                | FixKind::Move { .. }
                | FixKind::Reflect(_) => {}
            }
        }
        Ok(())
    }
}

impl Session<'_> {
    /// Takes the motion of the group as a whole away; `rescale`: and gives its energy back to the rest.
    fn calm(
        &mut self,
        members: &Members,
        linear: [bool; 3],
        angular: bool,
        rescale: bool,
    ) -> Result<()> {
        let before = self.rigid(members)?;
        if before.mass == 0.0 {
            return Ok(());
        }
        self.take_motion(members, linear, angular)?;
        if rescale {
            let after = self.rigid(members)?.square;
            if after <= 0.0 {
                return Err(Problem::new(
                    "`fix momentum ... rescale` leaves nothing that moves",
                ));
            }
            let factor = (before.square / after).sqrt();
            for a in 0..3 {
                let mut v = self.population.raw(Quantity::Velocity(a))?;
                for i in (0..v.len()).filter(|i| members.contains(*i)) {
                    v[i] *= factor;
                }
                self.population
                    .store
                    .particles_mut()
                    .write(Quantity::Velocity(a), 0, &v)?;
            }
        }
        Ok(())
    }
}
