//! What acts on a body, each entry in its stage.

use super::context::{Context, Result};
use super::diffusion::Said;
use super::stage::{Staged, Stages, moves, of_time};
use super::{Files, diffusion, motion, rigid_body};
use crate::deck::document::{Document, StageName};
use peridyne::expression::Expression;
use peridyne::spec::{
    ConditionSpec, DiffusionCondition, InitialSpec, PrecrackSpec, RigidBodySpec, SetSpec,
};

/// Initial values of points, and those of what spreads.
pub(super) fn initial(
    context: &Context,
    document: &Document,
    sets: &mut Vec<SetSpec>,
) -> Result<(Vec<InitialSpec>, Vec<Said<(String, Expression)>>)> {
    let (mut initial, mut starts) = (Vec::new(), Vec::new());
    for (index, at) in document.initial.iter().enumerate() {
        let made = motion::initial(context, index, at, sets)?;
        diffusion::initial(context, &at.value, &made.set, &mut starts)?;
        initial.push(made);
    }
    Ok((initial, starts))
}

/// Conditions on points, and those of what spreads.
pub(super) fn conditions(
    context: &mut Context,
    document: &Document,
    stages: &Stages,
    sets: &mut Vec<SetSpec>,
) -> Result<(Staged<ConditionSpec>, Vec<Said<DiffusionCondition>>)> {
    let mut conditions = Staged::default();
    let mut exchanged = Vec::new();
    for (index, at) in document.boundary_condition.iter().enumerate() {
        let stage = stages.named(context, &at.value.stage)?;
        context.set_time(stages.time(stage));
        let already = exchanged.len();
        let made = motion::condition(context, index, at, sets, &mut exchanged)?;
        if let (Some(_), Some(spreads)) = (stage, exchanged.get(already)) {
            return Err(context.error_with(
                &spreads.span,
                "this entry names a stage, and diffusion goes on through both",
                "leave stage out of it; what moves or loads points in one stage is an entry of its own",
            ));
        }
        if stages.both && stage.is_none() && made.iter().any(of_time) {
            return Err(stages.whose(context, &at.span));
        }
        conditions.put(stage, stages.both, index, made);
    }
    Ok((conditions, exchanged))
}

pub(super) fn rigid_bodies(
    context: &mut Context,
    document: &Document,
    stages: &Stages,
    section: f64,
    files: &Files,
) -> Result<Staged<RigidBodySpec>> {
    let mut rigid_bodies = Staged::default();
    for (index, at) in document.rigid_body.iter().enumerate() {
        let stage = stages.named(context, &at.value.stage)?;
        context.set_time(stages.time(stage));
        let made = rigid_body::rigid_body(context, at, section, files)?;
        if stages.both && stage.is_none() && moves(&made) {
            return Err(stages.whose(context, &at.span));
        }
        rigid_bodies.put(stage, stages.both, index, vec![made]);
    }
    Ok(rigid_bodies)
}

/// Cracks of the body, and those that are cut when motion begins.
pub(super) fn precracks(
    context: &Context,
    document: &Document,
    stages: &Stages,
    files: &Files,
) -> Result<Staged<PrecrackSpec>> {
    let mut precracks = Staged::default();
    for (index, at) in document.precrack.iter().enumerate() {
        let late = stages.named(context, &at.value.stage)? == Some(StageName::Dynamics);
        let made = motion::precrack(context, at, late, files)?;
        let when = if late {
            StageName::Dynamics
        } else {
            StageName::Statics
        };
        precracks.put(Some(when), true, index, vec![made]);
    }
    Ok(precracks)
}
