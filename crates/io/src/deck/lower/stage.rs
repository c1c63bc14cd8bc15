//! Decks of two stages: which one an entry belongs to, and what t is there.

use super::context::{Context, Result};
use crate::deck::document::{Document, StageName};
use crate::deck::error::DeckError;
use crate::deck::units::Dim;
use crate::deck::value::At;
use peridyne::expression::Expression;
use peridyne::spec::{ConditionKind, ConditionSpec, RigidBodyMotion, RigidBodySpec};
use std::ops::Range;

/// What a deck does, and what t is.
pub(super) struct Stages {
    /// Statics, then motion.
    pub both: bool,
    /// Of statics: a number without a duration.
    statics: Dim,
}

impl Stages {
    pub fn of(document: &Document) -> Self {
        let statics = document.statics.as_ref();
        Stages {
            both: statics.is_some() && document.run.is_some(),
            statics: match statics {
                Some(statics) if statics.value.duration.is_none() => Dim::NUMBER,
                Some(_) | None => Dim::TIME,
            },
        }
    }

    /// What t is in a stage; of a deck of two that of motion, unless one is named.
    pub fn time(&self, stage: Option<StageName>) -> Dim {
        match (self.both, stage) {
            (false, _) | (true, Some(StageName::Statics)) => self.statics,
            (true, Some(StageName::Dynamics) | None) => Dim::TIME,
        }
    }

    /// The stage that an entry names.
    pub fn named(
        &self,
        context: &Context,
        written: &Option<At<StageName>>,
    ) -> Result<Option<StageName>> {
        match written {
            Some(stage) if !self.both => Err(context.error_with(
                &stage.span,
                "stage belongs to a deck of two stages, and this one has either [statics] or [run]",
                "leave stage out, or write both tables",
            )),
            written => Ok(written.as_ref().map(|s| s.value)),
        }
    }

    /// An entry that names no stage and depends on t.
    pub fn whose(&self, context: &Context, span: &Range<usize>) -> DeckError {
        context.error_with(
            span,
            "t begins at 0 in statics and again in motion: which of both is meant here?",
            "write stage = \"statics\" or stage = \"dynamics\"; what changes in both is two entries",
        )
    }
}

fn depends(written: &[Option<Expression>; 3]) -> bool {
    written.iter().flatten().any(Expression::depends_on_time)
}

/// Does it change with t?
pub(super) fn of_time(condition: &ConditionSpec) -> bool {
    match &condition.kind {
        ConditionKind::Displacement(e)
        | ConditionKind::Velocity(e)
        | ConditionKind::BodyForce(e)
        | ConditionKind::SetForce(e) => depends(e),
        ConditionKind::Traction { value, .. } => depends(value),
        ConditionKind::Damping(e) => e.depends_on_time(),
        ConditionKind::Force(_) => false,
    }
}

/// Is it elsewhere later?
pub(super) fn moves(rigid_body: &RigidBodySpec) -> bool {
    match &rigid_body.motion {
        RigidBodyMotion::Kinematic(center) => {
            let turns = rigid_body.turn.iter().map(|t| &t.angle);
            center.iter().chain(turns).any(Expression::depends_on_time)
        }
        RigidBodyMotion::Free(_) => true,
    }
}

/// Entries of the spec by stages, and which of the deck each comes from.
pub(super) struct Staged<T> {
    /// Of statics before motion.
    pub before: Vec<T>,
    /// Of motion, or of the only stage.
    pub then: Vec<T>,
    /// Of both in turn.
    pub entries: [Vec<usize>; 2],
}

impl<T> Default for Staged<T> {
    fn default() -> Self {
        Staged {
            before: vec![],
            then: vec![],
            entries: [vec![], vec![]],
        }
    }
}

impl<T: Clone> Staged<T> {
    /// What entry `index` of the deck says.
    pub fn put(&mut self, stage: Option<StageName>, both: bool, index: usize, made: Vec<T>) {
        if both && stage != Some(StageName::Dynamics) {
            self.before.extend(made.iter().cloned());
        }
        if !both || stage != Some(StageName::Statics) {
            self.then.extend(made);
        }
        self.entries[0].resize(self.before.len(), index);
        self.entries[1].resize(self.then.len(), index);
    }
}

/// Which entries of the deck those of the spec come from.
#[derive(Debug, Clone, Default)]
pub(in crate::deck) struct Entries {
    pub conditions: [Vec<usize>; 2],
    pub rigid_bodies: [Vec<usize>; 2],
    /// Of the body, and those that are cut when motion begins.
    pub precracks: [Vec<usize>; 2],
}

impl Entries {
    /// The path of the spec as one of the deck's entries: `preload.conditions[0]` is a condition like others.
    pub fn path(&self, path: &str) -> Option<String> {
        let (before, rest) = match path.strip_prefix("preload.") {
            Some(rest) => (true, rest),
            None => (false, path),
        };
        let lists = [
            (
                "conditions[",
                "conditions",
                &self.conditions[usize::from(!before)],
            ),
            (
                "rigid_bodies[",
                "rigid_bodies",
                &self.rigid_bodies[usize::from(!before)],
            ),
            ("precracks[", "precracks", &self.precracks[0]),
            ("cuts[", "precracks", &self.precracks[1]),
        ];
        for (prefix, name, entries) in lists {
            if let Some((number, rest)) = rest.strip_prefix(prefix).and_then(|r| r.split_once(']'))
            {
                let entry = entries.get(number.parse::<usize>().ok()?)?;
                return Some(format!("{name}[{entry}]{rest}"));
            }
        }
        before.then(|| match rest {
            "duration" => "statics.duration".to_string(),
            _ => rest.to_string(),
        })
    }
}
