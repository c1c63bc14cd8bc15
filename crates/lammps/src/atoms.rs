//! Atoms before the first `run`: compact, because an engine will take them over.

use super::quantity::{HostError, Particles, Quantity};

/// One value for all atoms, or one each.
#[derive(Debug, Clone, PartialEq)]
pub enum Column<T> {
    Uniform(T),
    Each(Vec<T>),
}

impl<T: Copy + PartialEq> Column<T> {
    pub fn get(&self, i: usize) -> T {
        match self {
            Column::Uniform(v) => *v,
            Column::Each(v) => v[i],
        }
    }

    /// As a list for `n` atoms.
    pub fn each(&mut self, n: usize) -> &mut Vec<T> {
        if let Column::Uniform(v) = self {
            *self = Column::Each(vec![*v; n]);
        }
        match self {
            Column::Each(v) => v,
            Column::Uniform(_) => unreachable!("made a list above"),
        }
    }

    /// The atoms at these places, in this order.
    pub fn pick(&mut self, places: &[usize]) {
        if let Column::Each(v) = self {
            *v = places.iter().map(|i| v[*i]).collect();
        }
    }

    /// Makes room for atoms `old..new`.
    fn extend(&mut self, old: usize, new: usize, value: T) {
        match self {
            Column::Uniform(v) if *v == value || old == 0 => *v = value,
            _ => self.each(old).resize(new, value),
        }
    }
}

/// A cubic lattice: site `(i, j, k)` lies at `spacing · i + offset`, evaluated like that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiteLattice {
    pub spacing: f64,
    pub offset: [f64; 3],
}

impl SiteLattice {
    pub fn position(&self, site: [i32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|a| f64::from(site[a]) * self.spacing + self.offset[a])
    }
}

/// Reference positions.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    Sites {
        lattice: SiteLattice,
        sites: Vec<[i32; 3]>,
    },
    Points(Vec<[f64; 3]>),
}

impl Reference {
    pub fn len(&self) -> usize {
        match self {
            Reference::Sites { sites, .. } => sites.len(),
            Reference::Points(p) => p.len(),
        }
    }
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    pub fn get(&self, i: usize) -> [f64; 3] {
        match self {
            Reference::Sites { lattice, sites } => lattice.position(sites[i]),
            Reference::Points(p) => p[i],
        }
    }
}

/// Atom ids, ascending.
#[derive(Debug, Clone, PartialEq)]
pub enum Ids {
    /// 1 to this number.
    Count(usize),
    List(Vec<u32>),
}

impl Ids {
    pub fn get(&self, i: usize) -> u64 {
        match self {
            Ids::Count(_) => i as u64 + 1,
            Ids::List(v) => u64::from(v[i]),
        }
    }
    /// Those at these places, which ascend.
    pub fn only(&self, places: &[usize]) -> Ids {
        if places
            .iter()
            .enumerate()
            .all(|(k, p)| self.get(*p) == k as u64 + 1)
        {
            return Ids::Count(places.len());
        }
        Ids::List(places.iter().map(|p| self.get(*p) as u32).collect())
    }
    /// Index of an id.
    pub fn find(&self, id: u64) -> Option<usize> {
        match self {
            Ids::Count(n) => (1..=*n as u64).contains(&id).then(|| id as usize - 1),
            Ids::List(v) => u32::try_from(id)
                .ok()
                .and_then(|id| v.binary_search(&id).ok()),
        }
    }
}

/// All atoms, in order of id.
#[derive(Debug, Clone, PartialEq)]
pub struct Atoms {
    pub ids: Ids,
    pub types: Column<u32>,
    /// Where the atoms were created (LAMMPS's `x0`).
    pub reference: Reference,
    /// Current positions, if `set`, `read_dump` moved atoms after their creation.
    pub moved: Option<Vec<[f64; 3]>>,
    pub velocity: Column<[f64; 3]>,
    pub density: Column<f64>,
    pub volume: Column<f64>,
}

impl Default for Atoms {
    fn default() -> Self {
        Atoms {
            ids: Ids::Count(0),
            types: Column::Uniform(1),
            reference: Reference::Points(Vec::new()),
            moved: None,
            velocity: Column::Uniform([0.0; 3]),
            density: Column::Uniform(1.0),
            volume: Column::Uniform(1.0),
        }
    }
}

impl Atoms {
    pub fn len(&self) -> usize {
        self.reference.len()
    }
    pub fn is_empty(&self) -> bool {
        self.reference.is_empty()
    }

    /// Current position of atom `i` (from 0).
    pub fn position(&self, i: usize) -> [f64; 3] {
        match &self.moved {
            Some(p) => p[i],
            None => self.reference.get(i),
        }
    }

    /// The atoms at these places, in this order, with these ids.
    pub fn pick(&mut self, places: &[usize], ids: Ids) {
        self.ids = ids;
        self.types.pick(places);
        self.velocity.pick(places);
        self.density.pick(places);
        self.volume.pick(places);
        match &mut self.reference {
            Reference::Sites { sites, .. } => *sites = places.iter().map(|i| sites[*i]).collect(),
            Reference::Points(p) => *p = places.iter().map(|i| p[*i]).collect(),
        }
        if let Some(p) = &mut self.moved {
            *p = places.iter().map(|i| p[*i]).collect();
        }
    }

    /// Appends atoms of one type at rest, with density and volume 1.
    pub fn append(&mut self, kind: u32, new: Reference) {
        let old = self.len();
        let total = old + new.len();
        self.types.extend(old, total, kind);
        self.velocity.extend(old, total, [0.0; 3]);
        self.density.extend(old, total, 1.0);
        self.volume.extend(old, total, 1.0);
        if let Some(moved) = &mut self.moved {
            moved.extend((0..new.len()).map(|i| new.get(i)));
        }
        self.ids = match std::mem::replace(&mut self.ids, Ids::Count(0)) {
            Ids::Count(n) => Ids::Count(n + new.len()),
            Ids::List(mut v) => {
                let last = v.last().copied().unwrap_or(0);
                v.extend((1..=new.len() as u32).map(|k| last + k));
                Ids::List(v)
            }
        };
        let place = std::mem::replace(&mut self.reference, Reference::Points(Vec::new()));
        self.reference = match (place, new) {
            (place, new) if place.is_empty() => new,
            (
                Reference::Sites { lattice, mut sites },
                Reference::Sites {
                    lattice: other,
                    sites: more,
                },
            ) if lattice == other => {
                sites.extend(more);
                Reference::Sites { lattice, sites }
            }
            (place, new) => {
                let mut points: Vec<[f64; 3]> = (0..place.len()).map(|i| place.get(i)).collect();
                points.extend((0..new.len()).map(|i| new.get(i)));
                Reference::Points(points)
            }
        };
    }
}

impl Particles for Atoms {
    fn count(&self) -> usize {
        self.len()
    }

    fn read(&self, quantity: Quantity, first: usize, out: &mut [f64]) -> Result<(), HostError> {
        for (k, slot) in out.iter_mut().enumerate() {
            let i = first + k;
            *slot = match quantity {
                Quantity::Type => f64::from(self.types.get(i)),
                Quantity::Density => self.density.get(i),
                Quantity::Volume => self.volume.get(i),
                Quantity::Position(a) => self.position(i)[a],
                Quantity::Reference(a) => self.reference.get(i)[a],
                Quantity::Velocity(a) => self.velocity.get(i)[a],
                Quantity::Force(_) => 0.0,
                Quantity::Damage
                | Quantity::Dilatation
                | Quantity::CriticalStretch
                | Quantity::Energy
                | Quantity::Virial(_) => {
                    return Err(HostError::new("bonds do not exist before the first `run`")
                        .help("write `run 0` first"));
                }
            };
        }
        Ok(())
    }

    fn fill(&mut self, quantity: Quantity, value: f64) -> Result<(), HostError> {
        match quantity {
            Quantity::Density => self.density = Column::Uniform(value),
            Quantity::Volume => self.volume = Column::Uniform(value),
            Quantity::Type => self.types = Column::Uniform(value as u32),
            _ => return super::quantity::fill_in_blocks(self, quantity, value),
        }
        Ok(())
    }

    fn write(&mut self, quantity: Quantity, first: usize, values: &[f64]) -> Result<(), HostError> {
        let n = self.len();
        let range = first..first + values.len();
        let scalar = |slots: &mut [f64]| slots.copy_from_slice(values);
        match quantity {
            Quantity::Density
                if (0..values.len()).any(|k| self.density.get(first + k) != values[k]) =>
            {
                scalar(&mut self.density.each(n)[range]);
            }
            Quantity::Volume
                if (0..values.len()).any(|k| self.volume.get(first + k) != values[k]) =>
            {
                scalar(&mut self.volume.each(n)[range]);
            }
            Quantity::Density | Quantity::Volume => {}
            Quantity::Type => {
                for (slot, v) in self.types.each(n)[range].iter_mut().zip(values) {
                    *slot = *v as u32;
                }
            }
            Quantity::Position(a) => {
                if self.moved.is_none() {
                    if (0..values.len()).all(|k| self.reference.get(first + k)[a] == values[k]) {
                        return Ok(());
                    }
                    self.moved = Some((0..n).map(|i| self.reference.get(i)).collect());
                }
                for (slot, v) in self.moved.iter_mut().flatten().skip(first).zip(values) {
                    slot[a] = *v;
                }
            }
            Quantity::Velocity(a) => {
                if (0..values.len()).any(|k| self.velocity.get(first + k)[a] != values[k]) {
                    for (slot, v) in self.velocity.each(n)[range].iter_mut().zip(values) {
                        slot[a] = *v;
                    }
                }
            }
            _ => return Err(HostError::new("this quantity cannot be set")),
        }
        Ok(())
    }
}

/// A group of atoms.
#[derive(Debug, Clone, PartialEq)]
pub enum Members {
    All,
    /// One bit per atom.
    Some(Vec<u64>),
}

impl Members {
    /// Of `n` atoms, those for which `is_member` holds.
    pub fn collect(n: usize, mut is_member: impl FnMut(usize) -> bool) -> Members {
        let mut bits = vec![0u64; n.div_ceil(64)];
        for i in (0..n).filter(|&i| is_member(i)) {
            bits[i / 64] |= 1 << (i % 64);
        }
        Members::Some(bits)
    }
    /// Only the atoms at these places are left, in this order.
    pub fn only(&self, places: &[usize]) -> Members {
        match self {
            Members::All => Members::All,
            Members::Some(_) => Members::collect(places.len(), |k| self.contains(places[k])),
        }
    }
    /// Does atom `i` (from 0) belong to it?
    pub fn contains(&self, i: usize) -> bool {
        match self {
            Members::All => true,
            Members::Some(bits) => bits.get(i / 64).is_some_and(|b| b >> (i % 64) & 1 == 1),
        }
    }
    /// Number of members among `n` atoms.
    pub fn count(&self, n: usize) -> usize {
        match self {
            Members::All => n,
            Members::Some(bits) => bits.iter().map(|b| b.count_ones() as usize).sum(),
        }
    }
}
