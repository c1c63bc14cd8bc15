//! What the bonds of a body are and remember: which are whole, what they break by, and the numbers that their law has of them and of their points.

use super::family::{Family, Moved};
use super::law::LawProperties;
use super::records::Pack;
use super::repulsion::Pushed;
use super::store::Store;
use super::view::{BLOCK, BondView};
use crate::body::{Body, Column, Field, FieldView, Identity, Subdomain, field};
use crate::execute::blocks::{PerBlock, Seen, Shared, Which, run_blocks, run_which_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::{Kernel, Simd};
use crate::interaction::criterion::{Criteria, Measure};
use crate::interaction::{BlockTally, Repulsion, Tally, Toughness};
use crate::space::Point;

/// All bonds of a body, of any law. A bond is a bit of `byte(group, k)`, eight points of a group side by side.
pub struct BondState<const D: usize, F> {
    pub body: Identity,
    pub law: LawProperties<D>,
    pub family: F,
    pub kind: &'static str,
    /// Bits of whole bonds, and of those that damage counts; empty: all that the family ever had ([`BondState::is_counted`]).
    pub alive: Vec<u8>,
    pub counted: Vec<u8>,
    pub directed: u64,
    pub near_horizon: u64,
    /// Material per slot; empty: one.
    pub material: Vec<u8>,
    /// Constants of every point of a law that [varies](crate::law::material::Material::varies); else empty.
    pub placed: Store,
    pub form: Store,
    pub point: Store,
    pub past: Store,
    pub memory: Vec<f64>,
    /// One per material.
    pub toughness: Vec<Toughness>,
    pub criteria: Criteria,
    pub repulsion: Option<Repulsion>,
    /// Critical `e` per slot, or critical work, now and next; empty: nothing breaks.
    pub critical: Column,
    pub next: Column,
    /// Damage per slot of a law that fails by it ([`LawProperties::failure`]), or a measure over its limit; empty: none does.
    pub damage: Column,
    /// Work done on each directed bond (energy / volume²), and where the step began; empty: nobody asks.
    pub work: Vec<f64>,
    pub before: Option<Before<D>>,
    /// What is left of the life of each directed bond; empty: there is no fatigue.
    pub life: Vec<f64>,
    /// Strain by temperature or swelling per slot; empty: none.
    pub expansion: Column,
    /// What is left of each slot's energy and force states; empty: of laws whose forms are of whole families, or nothing breaks.
    pub integrity: Column,
    /// Is any of them below 1?
    pub degraded: bool,
    /// How stiff damaged points are beside the body as it was prepared: per slot, then and now, and the most; empty: they are no stiffer.
    pub stiffness: [Vec<f64>; 2],
    pub stiffened: f64,
    /// In plane strain, per material: ν and 2G of the linear isotropic solid of its moduli, if it is isotropic; else empty.
    pub held: Vec<Option<[f64; 2]>>,
    /// Bits of bonds that break in a sweep, and of points that lose bonds, by group.
    pub breaks: Vec<u8>,
    pub damaged: Vec<u8>,
    /// Length of the step that equilibrium is sought for; 0: memory stands still.
    pub step: f64,
    pub prepared: bool,
    pub workspace: Workspace,
    pub blocks: Blocks,
}

/// A whole bond of a point: its place among the bonds of its group, ξ, ω and `ν V`.
pub type WholeBond<const D: usize> = (usize, [f64; D], f64, f64);

/// What sweeps run on, with room for what each block of groups reports.
pub struct Blocks {
    pub simd: Simd,
    tallies: PerBlock<BlockTally>,
    sums: PerBlock<[f64; 2]>,
}

impl Blocks {
    fn of<const D: usize>(blocks: usize, simd: Simd, body: &Body<D>) -> Blocks {
        Blocks {
            simd,
            tallies: PerBlock::new(blocks, BlockTally::default()),
            sums: PerBlock::sums(blocks).among(body.subdomain().map(Subdomain::comm)),
        }
    }

    pub fn run<K: Kernel<Out = ()>>(&self, kernel: &K) {
        self.run_of(kernel, Which::All);
    }

    pub fn run_of<K: Kernel<Out = ()>>(&self, kernel: &K, which: Which<'_>) {
        run_which_blocks(self.simd, kernel, which, self.sums.blocks());
    }

    /// Of this rank's groups, and the lowest critical `e` of any point from now on.
    pub fn tally<K: Kernel<Out = BlockTally>>(&self, kernel: &K) -> (Tally, f64) {
        self.tally_of(kernel, Which::All)
    }

    /// The same of blocks that are run now, and of all others that were run last.
    pub fn tally_of<K: Kernel<Out = BlockTally>>(
        &self,
        kernel: &K,
        which: Which<'_>,
    ) -> (Tally, f64) {
        let (mut total, mut least) = (Tally::default(), f64::INFINITY);
        self.tallies.for_each(self.simd, kernel, which, |tally| {
            total += tally;
            least = least.min(tally.least_critical);
        });
        (total, least)
    }

    pub fn sum<K: Kernel<Out = [f64; 2]>>(&self, kernel: &K) -> [f64; 2] {
        self.sums.sum(self.simd, kernel)
    }

    /// The largest first number of all blocks.
    pub fn most<K: Kernel<Out = [f64; 2]>>(&self, kernel: &K) -> f64 {
        let most = |total: &mut [f64; 2], of: [f64; 2]| total[0] = total[0].max(of[0]);
        self.sums.fold(self.simd, kernel, most)[0]
    }
}

/// What sweeps fill anew, kept so that a step allocates nothing.
#[derive(Debug, Default)]
pub struct Workspace {
    /// Displacements `[slots][4]`, where the family gathers.
    pub records: Vec<f64>,
    /// `[materials][numbers]` for a step of some length.
    pub constants: Vec<f64>,
    /// The same for a step of no length.
    pub still: Vec<f64>,
}

/// The end of the step before, from which the work of a step is counted.
pub struct Before<const D: usize> {
    pub u: Field<D>,
    pub records: Vec<f64>,
    pub expansion: Column,
}

impl<const D: usize> Before<D> {
    pub fn zeros(slots: usize, records: usize) -> Self {
        Before {
            u: crate::body::zeros(slots),
            records: vec![0.0; records],
            expansion: Column::default(),
        }
    }
}

/// Everything that bonds are made of, beside their law.
pub struct BondParts<'a, const D: usize, F> {
    pub body: &'a Body<D>,
    pub family: F,
    pub kind: &'static str,
    pub near_horizon: u64,
    /// One per material.
    pub toughness: Vec<Toughness>,
    pub criteria: Criteria,
    pub repulsion: Option<Repulsion>,
    /// In plane strain ν and 2G of each material that is isotropic; else empty.
    pub held: Vec<Option<[f64; 2]>>,
    pub simd: Simd,
}

/// Bits of all bonds of a family, and how many there are.
pub(super) fn all_whole<const D: usize, F: Family<D>>(family: &F) -> (Vec<u8>, u64) {
    let mut alive = vec![0u8; family.bytes_of_bits()];
    let mut directed = 0;
    for (group, l, _) in family.points() {
        for k in (0..family.bonds(group)).filter(|k| family.is_bond(group, *k, l)) {
            alive[family.byte(group, k)] |= 1 << l;
            directed += 1;
        }
    }
    (alive, directed)
}

/// Constants of every point, as `of` a material and a place says them.
///
/// # Errors
/// The slot whose place has none, and why; `None`: one of another rank. All ranks come here at once.
pub fn placed<const D: usize, F: Family<D>>(
    family: &F,
    body: &Body<D>,
    count: usize,
    of: &dyn Fn(usize, &Point, &mut [f64]) -> Result<(), String>,
) -> Result<Store, Option<(usize, String)>> {
    let mut all = Store::zeros(family.layout(count));
    let (mut numbers, mut wrong) = (vec![0.0; count], None);
    for &s in &body.slots {
        let slot = s as usize;
        let (material, place) = (body.material_of(slot), body.position(slot));
        if let Err(why) = of(material, &place, &mut numbers) {
            wrong = Some((slot, why));
            break;
        }
        for (n, x) in numbers.iter().enumerate() {
            all.set(n, slot, *x);
        }
    }
    if body.exchange.any(wrong.is_some()) {
        return Err(wrong);
    }
    all.fill(&body.exchange);
    Ok(all)
}

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// All bonds whole; `placed`: constants of every point, where those of materials do not say it all.
    pub fn new(parts: BondParts<D, F>, law: LawProperties<D>, placed: Store) -> Self {
        let BondParts {
            body,
            family,
            kind,
            near_horizon,
            toughness,
            criteria,
            repulsion,
            held,
            simd,
        } = parts;
        let (alive, directed) = all_whole(&family);
        let measured = matches!(
            criteria.measure,
            Measure::VonMises(_) | Measure::PlasticStrain(_)
        );
        let fails = measured || law.failure.is_some();
        let works = matches!(criteria.measure, Measure::Work(_));
        let fatigues = !criteria.fatigue.is_empty();
        let breaks = fails || works || fatigues || toughness.iter().any(|t| t.s00.is_finite());
        // fused sweeps look at broken bonds that repel, too, and tear what they find themselves
        let criticals = breaks || law.fused && repulsion.is_some();
        let found = breaks && !law.fused;
        // of a rank without bonds, too: by what there is one knows what bonds have
        let workspace = family.memory().max(TILE);
        let bonds = |is: bool, x: f64| vec![x; if is { workspace } else { 0 }];
        let column = |is: bool, x: f64| match is {
            true => Column::new(body.len, x, field::line(3)),
            false => Column::default(),
        };
        let critical = || {
            let mut critical = column(criticals, f64::INFINITY);
            if let Measure::Work(limit) = &criteria.measure {
                for (slot, x) in critical.iter_mut().enumerate() {
                    *x = limit[body.material_of(slot)];
                }
            }
            critical
        };
        let several = toughness.len() > 1;
        let store = |numbers| Store::zeros(family.layout(numbers));
        let gathers = family.layout(1).records;
        let records = if gathers { 4 * body.len } else { 0 };
        BondState {
            body: body.identity,
            counted: if law.fused { vec![] } else { alive.clone() },
            alive,
            directed,
            near_horizon,
            material: match several {
                true => (0..body.len).map(|s| body.material_of(s) as u8).collect(),
                false => vec![],
            },
            placed,
            form: store(law.form),
            point: store(law.point),
            past: store(law.past),
            memory: vec![0.0; workspace * law.memory],
            critical: critical(),
            next: critical(),
            damage: column(fails, 0.0),
            work: bonds(works, 0.0),
            before: works.then(|| Before::zeros(body.len, records)),
            life: bonds(fatigues, 1.0),
            expansion: Column::default(),
            integrity: column(breaks && law.form_of_whole, 1.0),
            degraded: false,
            stiffness: [const { vec![] }; 2],
            stiffened: 1.0,
            held,
            breaks: vec![0; if found { family.bytes_of_bits() } else { 0 }],
            damaged: vec![0; if found { family.groups() } else { 0 }],
            step: 0.0,
            prepared: false,
            workspace: Workspace {
                records: vec![0.0; records],
                ..Workspace::default()
            },
            blocks: Blocks::of(family.blocks(), simd, body),
            law,
            family,
            kind,
            toughness,
            criteria,
            repulsion,
        }
    }

    /// What pushes pairs apart that are too close.
    pub fn pushed<'a>(&'a self, body: &'a Body<D>) -> Option<Pushed<'a, D>> {
        let repulsion = self.repulsion.as_ref()?;
        Some(Pushed { repulsion, body })
    }

    /// As sweeps see them.
    pub fn view<'a>(&'a self, u: FieldView<'a, D>, workspace: &'a Workspace) -> BondView<'a, D, F> {
        BondView {
            family: &self.family,
            moved: Moved {
                columns: u,
                records: &workspace.records,
            },
            alive: Seen(self.alive.as_ptr()),
            constants: &workspace.constants,
            material: &self.material,
            placed: self.placed.view(),
            alike: self.material.is_empty() && self.placed.data.is_empty(),
            form: self.form.view(),
            point: self.point.view(),
            past: self.past.view(),
            memory: Seen(self.memory.as_ptr()),
            expansion: &self.expansion,
            held: !self.held.is_empty(),
            integrity: if self.degraded { &self.integrity } else { &[] },
        }
    }

    /// Displacements as gathers want them, where the family gathers; fused sweeps want the critical `e`, too.
    pub fn pack(&self, u: FieldView<D>, records: &mut [f64]) {
        if records.is_empty() {
            return;
        }
        let critical: &[f64] = &self.critical;
        let slots = records.len() / 4;
        let kernel = Pack {
            u,
            slots,
            fourth: if self.law.fused { critical } else { &[] },
            records: Shared(records.as_mut_ptr()),
        };
        // copies have no groups
        run_blocks(self.blocks.simd, &kernel, slots.div_ceil(BLOCK * TILE));
    }

    /// The room with these displacements; give it back. Of a law that panicked nobody did: it is as large as ever all the same.
    pub fn take_workspace(&mut self, u: FieldView<D>) -> Workspace {
        let mut workspace = std::mem::take(&mut self.workspace);
        let layout = self.family.layout(4);
        let records = if layout.records { layout.len() } else { 0 };
        workspace.records.resize(records, 0.0);
        self.pack(u, &mut workspace.records);
        workspace
    }

    /// What is left of a slot's energy and force states.
    pub fn integrity_at(&self, slot: usize) -> f64 {
        self.integrity.get(slot).copied().unwrap_or(1.0)
    }

    /// Number of the material of a slot in what is per material.
    pub fn material_at(&self, slot: usize) -> usize {
        self.material.get(slot).map_or(0, |m| *m as usize)
    }

    /// `½ E ε²` of a section that is held against the strain ε is `G/(1 + ν)` times the square of what bonds expand by: energy that laws without
    /// a section leave out. Per material; empty: the law has it, or nothing is held.
    pub fn held_energies(&self) -> Vec<f64> {
        let of = |held: &Option<[f64; 2]>| {
            held.map_or(0.0, |[poisson, twice_shear]| {
                0.5 * twice_shear / (1.0 + poisson)
            })
        };
        match self.law.section || self.expansion.is_empty() {
            true => vec![],
            false => self.held.iter().map(of).collect(),
        }
    }

    /// Of a material in plane strain: ν, and `E` per strain by temperature or swelling, which of laws without a section is (1 + ν) times as large.
    pub fn elastic_across(&self, material: usize) -> [f64; 2] {
        let [poisson, twice_shear] = self.held[material].unwrap_or_default();
        let grown = if self.law.section { 1.0 + poisson } else { 1.0 };
        [poisson, grown * twice_shear]
    }

    /// [`expand`](crate::interaction::Interaction::expand)
    pub fn expand(&mut self, strain: &[f64]) -> bool {
        if self.expansion.is_empty() {
            self.expansion = Column::new(strain.len(), 0.0, field::line(4));
        }
        self.expansion.copy_from_slice(strain);
        if !self.law.section && !self.held.is_empty() {
            for i in 0..strain.len() {
                let Some([poisson, _]) = self.held[self.material_at(i)] else {
                    return false;
                };
                self.expansion[i] *= 1.0 + poisson;
            }
        }
        true
    }

    pub fn bytes(&self) -> usize {
        self.family.bytes()
            + self.alive.len()
            + self.counted.len()
            + self.breaks.len()
            + self.damaged.len()
            + self.material.len()
            + self.placed.bytes()
            + self.form.bytes()
            + self.point.bytes()
            + self.past.bytes()
            + 8 * (self.memory.len() + self.workspace.records.len())
            + 8 * (self.critical.len() + self.next.len())
            + 8 * (self.damage.len() + self.expansion.len())
            + 8 * (self.work.len() + self.life.len())
            + 8 * (self.integrity.len() + self.stiffness.iter().map(Vec::len).sum::<usize>())
    }
}
