//! A body: a lattice in a region, or the points of a file.

use super::Files;
use super::context::{Context, Result};
use super::points;
use super::region::region;
use super::section::section;
use crate::deck::document::{Body, Document, LatticeName, SurfaceName};
use crate::deck::units::{Dim, UnitSystem};
use crate::deck::value::{At, Or};
use crate::read::{AtomsFile, Cells};
use peridyne::quantity;
use peridyne::run::Registry;
use peridyne::space::lattice::{Ends, Lattice, LatticeKind};
use peridyne::space::region::Region;
use peridyne::spec::{BodySpec, Cloud, Perturbation};

const INF: f64 = f64::INFINITY;
/// A body that is longer than this (m) is likely one in millimetres.
const LONG: f64 = 1.0;

impl From<LatticeName> for LatticeKind {
    fn from(name: LatticeName) -> Self {
        match name {
            LatticeName::Chain => LatticeKind::Chain,
            LatticeName::Square => LatticeKind::Square,
            LatticeName::Triangular => LatticeKind::Triangular,
            LatticeName::Cubic => LatticeKind::Cubic,
            LatticeName::Bcc => LatticeKind::Bcc,
            LatticeName::Fcc => LatticeKind::Fcc,
            LatticeName::Diamond => LatticeKind::Diamond,
        }
    }
}

/// Reads the body and settles the dimension of `context`.
pub(super) fn body(
    context: &mut Context,
    document: &Document,
    body: &At<Body>,
    files: &Files,
) -> Result<BodySpec> {
    let written = &body.value;
    let given = [
        ("lattice", written.lattice.is_some()),
        ("file", written.file.is_some()),
    ];
    let mut cells = Cells::default();
    let (spec, natural) = match context.one_of(&body.span, "the body", &given)? {
        0 => (
            None,
            written
                .lattice
                .as_ref()
                .map(|l| LatticeKind::from(l.value).dimension()),
        ),
        _ => {
            let points = files.read(context, written)?;
            context.atoms = points.atoms;
            context.micromoduli = points.micromoduli;
            context.ends = points.ends;
            cells = points.cells;
            let notes = points.notes.into_iter();
            let name = written.file.as_ref().map_or("", |f| &f.value);
            context.notes.extend(notes.map(|n| format!("{name}: {n}")));
            (Some(points.cloud), points.dimension)
        }
    };
    let given_dimension = document.dimension.as_ref();
    context.dimension = dimension(context, given_dimension, natural, written.lattice.is_some())?;
    if let (Some(_), Some(unit)) = (&written.lattice, &written.file_unit) {
        return Err(context.error(
            &unit.span,
            "file_unit belongs to a file; a lattice has its spacing",
        ));
    }
    if let (Some(_), Some(step)) = (&written.lattice, &written.file_step) {
        return Err(context.error(&step.span, "file_step belongs to a file with frames"));
    }
    match (&written.lattice, spec) {
        (Some(kind), _) => {
            let filling = Filling::of(document, written);
            lattice(context, body, LatticeKind::from(kind.value), &filling)
        }
        (None, Some(cloud)) => points_of_file(context, document, written, natural, cloud, cells),
        (None, None) => Err(context.error(&body.span, "the body needs one of lattice, file")),
    }
}

/// The points of a file as a body of the deck, in its units.
fn points_of_file(
    context: &mut Context,
    document: &Document,
    written: &Body,
    natural: Option<usize>,
    mut cloud: Cloud,
    mut cells: Cells,
) -> Result<BodySpec> {
    refuse_keys_of_lattices(context, written)?;
    if let Some(file) = &written.file {
        points::lie_flat(context, &cloud, file)?;
    }
    if let Some(spacing) = &written.spacing {
        cloud.spacing = Some(context.value(spacing)?);
    }
    if context.micromoduli.is_some()
        && let Some(unit) = &written.file_unit
    {
        return Err(context.error(
            &unit.span,
            "a linear body is in the units of its deck: file_unit cannot change its micromoduli",
        ));
    }
    let density = match context.micromoduli {
        Some(_) => 1.0,
        None => context.units.plain_factor(Dim::DENSITY),
    };
    cloud.density.iter_mut().for_each(|d| *d *= density);
    if let Some(unit) = &written.file_unit {
        let unit = context.value(unit)?;
        scale(context, &mut cloud, &mut cells, unit, natural);
    }
    // cells of a plane mesh have areas, and edges lengths: the thickness makes more of them
    if natural == Some(2) && context.micromoduli.is_none() && context.atoms.is_none() {
        let thickness = section(context, document)?;
        cloud.volume.iter_mut().for_each(|v| *v *= thickness);
        for (_, areas) in &mut cloud.faces {
            *areas = areas.iter().map(|a| a * thickness).collect();
        }
    }
    context.notes.extend(in_metres(context, written, &cloud));
    if natural.is_none()
        && context.atoms.is_none()
        && let Some(file) = &written.file
        && let Some(lint) = points::odd_volumes(context, document, &cloud, file)?
    {
        context.lints.push(lint);
    }
    if let (Some(atoms), Some(file)) = (&context.atoms, &written.file) {
        atoms_fit(context, atoms, file)?;
    }
    if let Some(atoms) = &mut context.atoms {
        in_units(context.units, atoms, &mut cloud);
    }
    context.cells.append(cells);
    Ok(BodySpec::Cloud(cloud))
}

fn refuse_keys_of_lattices(context: &Context, written: &Body) -> Result<()> {
    if let Some(lost) = written
        .origin
        .as_ref()
        .map(|o| &o.span)
        .or(written.region.as_ref().map(|r| &r.span))
    {
        return Err(context.error(
            lost,
            "origin and region belong to a lattice; a file brings its points",
        ));
    }
    if let Some(perturb) = &written.perturb {
        return Err(context.error(&perturb.amplitude.span, "only a lattice can be perturbed"));
    }
    Ok(())
}

/// Lengths of a file in `unit`.
fn scale(
    context: &mut Context,
    cloud: &mut Cloud,
    cells: &mut Cells,
    unit: f64,
    natural: Option<usize>,
) {
    // areas of a 2-D mesh, volumes otherwise
    let power = if natural == Some(2) { 2 } else { 3 };
    cloud.position.iter_mut().flatten().for_each(|c| *c *= unit);
    let ends = context.ends.iter_mut().flatten().flatten();
    ends.for_each(|c| *c *= unit);
    cells.scale(unit);
    cloud
        .volume
        .iter_mut()
        .for_each(|v| *v *= quantity::power(unit, power));
    for (_, areas) in &mut cloud.faces {
        *areas = areas
            .iter()
            .map(|a| a * quantity::power(unit, power - 1))
            .collect();
    }
    if let Some(atoms) = &mut context.atoms {
        atoms.corner = atoms.corner.map(|c| c * unit);
        atoms.cell = atoms.cell.map(|c| c * unit);
    }
}

/// Masses and velocities of atoms in the units of the deck.
fn in_units(units: UnitSystem, atoms: &mut AtomsFile, cloud: &mut Cloud) {
    let mass = units.plain_factor(Dim::MASS);
    for species in &mut atoms.species {
        species.mass = species.mass.map(|m| m * mass);
    }
    if atoms.from_momenta {
        let unit = units.ase_velocity();
        cloud.velocity.iter_mut().flatten().for_each(|v| *v *= unit);
    }
}

/// A remark where a body is so long that it is likely in millimetres.
fn in_metres(context: &Context, written: &Body, cloud: &Cloud) -> Option<String> {
    let longest = extents(cloud).into_iter().fold(0.0, f64::max);
    if context.units == UnitSystem::Si
        && written.file_unit.is_none()
        && context.atoms.is_none()
        && context.micromoduli.is_none()
        && longest > LONG
        && let Some(file) = &written.file
    {
        let text = format!(
            "lengths of {} are taken as metres, which makes a body of {}: file_unit = \"1 mm\" says otherwise",
            file.value,
            context.units.show(longest, Dim::LENGTH),
        );
        let remark = context.source.remark(&file.span, &text);
        return Some(remark);
    }
    None
}

/// How far points reach along each axis.
fn extents(cloud: &Cloud) -> [f64; 3] {
    std::array::from_fn(|a| {
        let all = cloud.position.iter().map(|x| x[a]);
        let ends = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        ends.1 - ends.0
    })
}

/// A file of atoms in other units, or of isotopes, would be another body than it says.
fn atoms_fit(context: &Context, atoms: &AtomsFile, file: &At<String>) -> Result<()> {
    let own = context.units.name();
    if let Some(units) = { atoms.units.as_deref() }.filter(|u| *u != own)
        && context.units != UnitSystem::None
    {
        return Err(context.error_with(
            &file.span,
            format!(
                "{} says that it is in {units} units, and those here are {own}",
                file.value
            ),
            match ["si", "metal", "lj"].contains(&units) {
                true => format!("write units = {units:?}, or a file in {own} units"),
                false => format!("write the file anew in {own} units"),
            },
        ));
    }
    match &atoms.isotopes {
        Some(name) => Err(context.error_with(
            &file.span,
            format!("atoms of {name} have different masses, and a material has one"),
            "give isotopes names of their own in the file, and a [material.NAME] each",
        )),
        None => Ok(()),
    }
}

fn dimension(
    context: &Context,
    given: Option<&At<usize>>,
    natural: Option<usize>,
    lattice: bool,
) -> Result<usize> {
    match (given, natural) {
        (None, natural) => Ok(natural.unwrap_or(3)),
        (Some(given), _) if !(1..=3).contains(&given.value) => Err(context.error(
            &given.span,
            format!("the dimension is 1, 2 or 3, not {}", given.value),
        )),
        (Some(given), Some(natural)) if given.value != natural => {
            let what = if lattice { "lattice" } else { "mesh" };
            Err(context.error(
                &given.span,
                format!("the {what} is {natural}-D, not {}-D", given.value),
            ))
        }
        (Some(given), _) => Ok(given.value),
    }
}

/// Where the points of a lattice without an origin lie.
pub(super) struct Filling {
    /// What ends where the region does; `None`: atoms, of which the first site is at 0, as in scripts.
    ends: Option<Ends>,
    periodic: [bool; 3],
}

impl Filling {
    pub fn of(document: &Document, body: &Body) -> Filling {
        let registry = Registry::standard();
        let mut materials = document.material.values();
        let atoms = materials.any(|m| registry.is_potential(&m.value.law.value.name));
        let surface = body.surface.as_ref().or(document.surface.as_ref());
        let exact = surface.is_some_and(|s| s.value == SurfaceName::Exact);
        let periodic = document.periodic.as_ref().map(|p| match &p.value {
            Or::Bare(axes) => {
                std::array::from_fn(|a| axes.iter().any(|axis| axis.value as usize == a))
            }
            Or::Table(p) => [p.x.is_some(), p.y.is_some(), p.z.is_some()],
        });
        Filling {
            ends: match (atoms, exact) {
                (true, _) => None,
                (false, true) => Some(Ends::Points),
                (false, false) => Some(Ends::Cells),
            },
            periodic: periodic.unwrap_or_default(),
        }
    }

    /// Of a region. A period begins at its lower end.
    fn origin(&self, kind: LatticeKind, spacing: f64, region: &Region) -> [f64; 3] {
        let Some(ends) = self.ends else {
            return [0.0; 3];
        };
        let (low, mut high) = region.bounds();
        for a in (0..3).filter(|a| self.periodic[*a]) {
            high[a] = low[a] + spacing * kind.edges()[a];
        }
        let of = |ends| Lattice::filling(kind, spacing, [low, high], ends);
        let (outer, whole) = (of(ends), of(Ends::Cells));
        // sites of a cell that no layers fill stand where they stood: at 0, as those of atoms
        let filled = |a: usize| {
            let layer = spacing * kind.edges()[a] / f64::from(kind.planes(a));
            let layers = (high[a] - low[a]) / layer;
            kind.basis().len() == 1 || (layers - layers.round()).abs() < 1e-6
        };
        // a period has no ends
        std::array::from_fn(|a| match self.periodic[a] {
            true => whole[a],
            false if filled(a) => outer[a],
            false => 0.0,
        })
    }
}

fn lattice(
    context: &Context,
    body: &At<Body>,
    kind: LatticeKind,
    filling: &Filling,
) -> Result<BodySpec> {
    let written = &body.value;
    let missing = |key: &str, example: &str| {
        context.error_with(
            &body.span,
            format!("a lattice body needs `{key}`"),
            format!("add {key} = {example}"),
        )
    };
    let spacing = written
        .spacing
        .as_ref()
        .ok_or_else(|| missing("spacing", "\"0.5 mm\""))?;
    let spacing = context.value(spacing)?;
    let given = { written.origin.as_ref() }
        .map(|o| context.finite_vector(o))
        .transpose()?;
    let (region, origin) = match (&written.region, &written.cells) {
        (Some(shape), None) => {
            let region = region(context, shape)?;
            let origin = given.unwrap_or_else(|| filling.origin(kind, spacing, &region));
            (region, origin)
        }
        (None, Some(cells)) => {
            let origin = given.unwrap_or_default();
            let region = whole_cells(context, cells, kind, spacing, origin)?;
            (region, origin)
        }
        (None, None) => return Err(missing("region", "{ block = { low = .., high = .. } }")),
        (Some(_), Some(cells)) => {
            return Err(context.error(&cells.span, "give one of region and cells"));
        }
    };
    let perturb = match &written.perturb {
        None => None,
        Some(perturb) => {
            let amplitude = context.value(&perturb.amplitude)?;
            let half = 0.5 * spacing * kind.nearest();
            if !(0.0..half).contains(&amplitude) {
                let message = format!(
                    "the amplitude must lie between 0 and half the distance of points, {}",
                    context.units.write(half, Dim::LENGTH)
                );
                return Err(context.error(&perturb.amplitude.span, message));
            }
            Some(Perturbation {
                amplitude,
                seed: perturb.seed,
            })
        }
    };
    Ok(BodySpec::Lattice {
        kind,
        spacing,
        origin,
        region,
        perturb,
    })
}

/// The block of so many cells along each axis; its upper faces lie just below the next cells.
fn whole_cells(
    context: &Context,
    cells: &At<Vec<At<u32>>>,
    kind: LatticeKind,
    spacing: f64,
    origin: [f64; 3],
) -> Result<Region> {
    let d = context.dimension;
    if cells.value.len() != d {
        let message = format!("{} numbers of cells in {d}-D", cells.value.len());
        let example = ["cells = [100]", "cells = [20, 20]", "cells = [20, 20, 20]"][d - 1];
        return Err(context.error_with(&cells.span, message, format!("write {example}")));
    }
    let (mut low, mut high) = ([-INF; 3], [INF; 3]);
    for (a, n) in cells.value.iter().enumerate() {
        if n.value == 0 {
            return Err(context.error(&n.span, "no cells, no body"));
        }
        let edge = spacing * kind.edges()[a];
        low[a] = origin[a] - edge / 8.0;
        high[a] = origin[a] + edge * (f64::from(n.value) - 0.125);
    }
    Ok(Region::Block { low, high })
}
