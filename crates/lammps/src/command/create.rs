//! `create_atoms`.

use super::Args;
use crate::atoms::Reference;
use crate::error::{Problem, Result};
use crate::park::Park;
use crate::region::Region;
use crate::session::Session;

/// Numbers that LAMMPS throws away before those of the first atom.
const WARM_UP: usize = 30;

/// `create_atoms ... random`.
struct Scatter {
    count: u64,
    seed: i64,
    /// Least distance from any other atom; 0: none.
    overlap: f64,
    /// Tries for each atom.
    tries: u64,
}

impl Session<'_> {
    pub(super) fn create_atoms(&mut self, args: &mut Args) -> Result<()> {
        let domain = *self.space.domain()?;
        let kind = args.count("an atom type", 1)? as usize;
        if kind > self.population.types {
            return Err(Problem::new(format!(
                "atom type {kind} is not between 1 and {}",
                self.population.types
            )));
        }
        let style = args.next("`box`, `region`, `single` or `random`")?;
        let mut region = None;
        let mut single = None;
        let mut random = None;
        match style.as_str() {
            "box" => {}
            "region" => {
                let word = args.next("a region ID")?;
                region = Some(self.region(word.as_str()).map_err(|p| p.or_at(word.span))?);
            }
            "single" => {
                let mut x = [0.0; 3];
                for x in &mut x {
                    *x = args.number("x y z")?;
                }
                single = Some(x);
            }
            "random" => {
                let count = args.count("the number of atoms", 0)?;
                if count > u64::from(u32::MAX) {
                    return Err(Problem::new("more than 4294967295 atoms"));
                }
                let seed = args.seed()?;
                if !args.eat("NULL") {
                    let word = args.next("a region ID or NULL")?;
                    region = Some(self.region(word.as_str()).map_err(|p| p.or_at(word.span))?);
                }
                random = Some((count, seed));
            }
            _ => {
                let known = ["box", "region", "single", "random"];
                return Err(args.unknown(style, "the style", known));
            }
        }
        let mut lattice_units = true;
        let (mut overlap, mut tries) = (0.0, 1000);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "units" => lattice_units = args.units()?,
                "overlap" if random.is_some() => overlap = args.positive("the least distance")?,
                "maxtry" if random.is_some() => tries = args.count("the number of tries", 1)?,
                _ => {
                    let known: &[&str] = match random {
                        Some(_) => &["units", "overlap", "maxtry"],
                        None => &["units"],
                    };
                    return Err(args.unknown(word, "the option", known.iter().copied()));
                }
            }
        }
        let new = if let Some(x) = single {
            let unit = self.space.length_unit(lattice_units)?;
            let x = x.map(|x| x * unit);
            Reference::Points(if domain.owns(x) { vec![x] } else { Vec::new() })
        } else if let Some((count, seed)) = random {
            // numbers of a length are in its units, as all are
            let unit = match overlap > 0.0 {
                true => self.space.length_unit(lattice_units)?,
                false => 1.0,
            };
            let scatter = Scatter {
                count,
                seed,
                overlap: unit * overlap,
                tries,
            };
            Reference::Points(self.scattered(&scatter, region.as_ref())?)
        } else {
            let lattice = self.space.lattice.filter(|l| l.sites).ok_or_else(|| {
                Problem::new("`create_atoms` needs a lattice")
                    .help("write `lattice sc CONSTANT` before")
            })?;
            let inside =
                |x: [f64; 3]| region.as_ref().is_none_or(|r| r.contains(x)) && domain.owns(x);
            // sites outside the region's own bounds need no test
            let (mut low, mut high) = (domain.low, domain.high);
            if let Some((a, b)) = region.as_ref().and_then(|r| r.bounds()) {
                for k in 0..3 {
                    (low[k], high[k]) = (low[k].max(a[k]), high[k].min(b[k]));
                }
            }
            let sites = lattice
                .sites_in(self.space.dimension, low, high, inside)
                .map_err(Problem::new)?;
            Reference::Sites {
                lattice: lattice.site_lattice(),
                sites,
            }
        };
        let made = new.len();
        let atoms = self.population.atoms()?;
        let was = atoms.len();
        if was + made > u32::MAX as usize {
            return Err(Problem::new("more than 4294967295 atoms"));
        }
        atoms.append(kind as u32, new);
        self.population.ids = atoms.ids.clone();
        self.console.print(&format!("Created {made} atoms"));
        self.console.print(&format!(
            "  using lattice units in orthogonal box = {}",
            domain.describe()
        ));
        if made == 0 {
            self.console
                .note("no atoms were created: no lattice site lies in the region and the box");
        }
        // groups made before do not hold the new atoms, as in LAMMPS
        Ok(())
    }

    /// Places drawn at random in the box and the region.
    fn scattered(&mut self, scatter: &Scatter, region: Option<&Region>) -> Result<Vec<[f64; 3]>> {
        let domain = *self.space.domain()?;
        let (mut low, mut high) = (domain.low, domain.high);
        if let Some((a, b)) = region.and_then(Region::bounds) {
            for k in 0..3 {
                (low[k], high[k]) = (low[k].max(a[k]), high[k].min(b[k]));
            }
        }
        if (0..3).any(|a| low[a] > high[a]) {
            return Err(Problem::new("the region lies outside the box"));
        }
        let middle = domain.low[2] + 0.5 * domain.edge(2);
        let mut park =
            Park::new(scatter.seed).ok_or_else(|| Problem::new("the seed must be positive"))?;
        park.skip(WARM_UP);
        let mut others = if scatter.overlap > 0.0 {
            self.positions()?
        } else {
            Vec::new()
        };
        let near = |x: [f64; 3], y: [f64; 3]| {
            let d = [0, 1, 2].map(|a| {
                let d = x[a] - y[a];
                let edge = domain.edge(a);
                if domain.periodic(a) {
                    d - edge * (d / edge).round()
                } else {
                    d
                }
            });
            d.iter().map(|d| d * d).sum::<f64>() < scatter.overlap * scatter.overlap
        };
        let mut made = Vec::new();
        for _ in 0..scatter.count {
            for _ in 0..scatter.tries {
                let mut x = [0, 1, 2].map(|a| low[a] + park.uniform() * (high[a] - low[a]));
                if self.space.dimension == 2 {
                    x[2] = middle;
                }
                let free = region.is_none_or(|r| r.contains(x))
                    && (scatter.overlap == 0.0 || !others.iter().any(|y| near(x, *y)));
                if free {
                    made.push(x);
                    if scatter.overlap > 0.0 {
                        others.push(x);
                    }
                    break;
                }
            }
        }
        let missing = scatter.count - made.len() as u64;
        if missing > 0 {
            self.console.note(&format!(
                "only {} of {} atoms found a place in {} tries each: ask for fewer, a smaller `overlap`, or more tries (maxtry N)",
                made.len(),
                scatter.count,
                scatter.tries
            ));
        }
        Ok(made)
    }
}
