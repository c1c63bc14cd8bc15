//! The findings as JSON.

use super::advice::advice;
use super::continuum::{Found, Seen};
use super::{Findings, directions, mean};
use crate::failure::json_text;
use peridyne_io::deck::each_once;
use peridyne_theory::patch_test::Class;
use peridyne_theory::voigt::{Stiffness, components};
use serde_json::{Value, json};

pub fn write(found: &Findings) -> String {
    json_text(&of(found))
}

pub fn of(found: &Findings) -> Value {
    let info = &found.info;
    let materials = found.materials.iter().enumerate().map(|(n, m)| {
        let classes = found.patch.iter().flat_map(|p| &p.classes);
        json!({
            "name": m.name,
            "density": m.density,
            "asked": m.nominal.map(|a| json!({
                "young": a.young, "poisson": a.poisson, "bulk": a.bulk(), "shear": a.shear(),
            })),
            "whole": found.patch.as_ref().and_then(|p| p.whole(n)).map(|w| along(&w)),
            "asked_along_axes": directions::nominal_along(found, m),
            "places": classes.filter(|c| c.material == n).map(|c| class(found, c)).collect::<Vec<_>>(),
            "pressure_wave": m.pressure_wave,
            "shear_wave": m.shear_wave,
            "critical_stretch": m.fracture.map(|f| f.0),
            "fracture_energy": m.fracture.and_then(|f| f.1),
            "micromodulus": info.micromodulus.get(n),
        })
    });
    let of_deck = { found.warnings.iter() }.map(|w| json!({"what": w, "fix": null}));
    let warnings = { advice(found).into_iter() }.map(|a| json!({"what": a.what, "fix": a.fix}));
    json!({
        "title": found.spec.title,
        "units": found.units.name(),
        "dimension": info.dimension,
        "particles": info.points,
        "spacing": info.spacing,
        "horizon": info.horizon,
        "low": found.low[..info.dimension],
        "high": found.high[..info.dimension],
        "extent": (0..info.dimension).map(|a| found.extent(a)).collect::<Vec<_>>(),
        "loads": info.loads.iter().map(|l| json!({
            "what": l.what, "set": l.set, "area": l.area, "force": l.force.map(|f| f[..info.dimension].to_vec()), "power": l.power,
        })).collect::<Vec<_>>(),
        "not_tried": found.untried,
        "mass": info.mass,
        "volume": info.volume,
        "bonds": each_once(info.directed_bonds),
        "family": {
            "kind": info.family_kind, "min": info.family.0, "mean": info.family.1, "max": info.family.2,
            "full_volume": found.patch.as_ref().map(|p| p.full),
        },
        "bond_forces": info.sweeps.iter().map(|s| s.as_ref().map(|s| json!({
            "laws": s.laws, "fused": s.fused, "reasons": s.needs,
        }))).collect::<Vec<_>>(),
        "near_horizon": info.near_horizon,
        "cut_by_precracks": info.cut,
        "materials": materials.collect::<Vec<_>>(),
        "fields": found.fields.iter().map(fields).collect::<Vec<_>>(),
        "steps": found.steps,
        "increments_before": found.increments,
        "time_step": found.spec.run.schedule.statics().is_none().then_some(info.time_step),
        "integrator": info.stepper.name(),
        "stable_step": info.stable_step,
        "spreads": info.diffusions.iter().map(|t| json!({
            "quantity": t.quantity.name(), "diffusivity": t.diffusivity, "stable_step": t.stable_step, "over_the_body": t.spread,
        })).collect::<Vec<_>>(),
        "contact_step": info.contact_step.is_finite().then_some(info.contact_step),
        "contact_stiffness": info.contact_stiffness,
        "bodies": info.bodies.iter().map(|(name, points)| json!({"name": name, "points": points})).collect::<Vec<_>>(),
        "gaps": info.gaps.iter().map(|g| json!({
            "bodies": g.bodies.map(|b| info.bodies[b].0.as_str()), "distance": g.distance, "contact": g.contact,
        })).collect::<Vec<_>>(),
        "memory_bytes": info.bytes,
        "threads": found.threads,
        "simd": info.simd,
        "seconds_per_step": found.trial.seconds_per_step,
        "seconds_per_increment_before": found.trial.seconds_per_increment,
        "seconds": found.trial.seconds_per_step.map(|s| found.load() + s * found.steps as f64),
        "warnings": of_deck.chain(warnings).collect::<Vec<_>>(),
    })
}

fn fields(one: &Found) -> Value {
    let (mut quantities, mut seconds, mut why) = (vec![], None, None);
    match &one.seen {
        Some(Seen::Made {
            made, seconds: s, ..
        }) => {
            quantities = made.iter().map(|q| q.symbol()).collect();
            seconds = Some(s);
        }
        Some(Seen::Nothing(message)) => why = Some(message),
        None => {}
    }
    json!({
        "name": one.asked.name,
        "kernel": one.asked.shape.name(),
        "formula": one.asked.shape.formula(),
        "width": one.asked.width,
        "points": one.asked.place.points(),
        "frames": one.frames,
        "quantities": quantities,
        "why_not": why,
        "seconds_per_frame": seconds,
        "bytes": one.bytes,
    })
}

fn class(found: &Findings, c: &Class) -> Value {
    let d = found.info.dimension;
    // all null where long waves say nothing
    let stiffness = c.stiffness.as_ref();
    let solid = stiffness.map(|s| mean(found, s));
    let anisotropy = stiffness.and_then(Stiffness::anisotropy);
    let n = components(d);
    json!({
        "place": c.place.name(d),
        "points": c.points,
        "family": c.family,
        "part_of_full": c.part,
        "long_waves": c.long_waves,
        "young": solid.map(|s| s.young),
        "poisson": solid.map(|s| s.poisson),
        "bulk": solid.map(|s| s.bulk()),
        "shear": solid.map(|s| s.shear()),
        "zener": anisotropy.map(|a| a.zener),
        "universal_anisotropy": anisotropy.and_then(|a| a.universal),
        "young_along": stiffness.and_then(Stiffness::young_along),
        "along_axes": stiffness.map(along),
        "stiffness": stiffness.map(|s| s.c[..n].iter().map(|r| &r[..n]).collect::<Vec<_>>()),
    })
}

/// Moduli along the axes, sides free; `null` where there are none.
fn along(stiffness: &Stiffness) -> Value {
    match stiffness.directional() {
        Some(m) => json!({"young": m.young, "poisson": m.poisson, "shear": m.shear}),
        None => Value::Null,
    }
}
