//! Terms between particles that are bonded whatever moves: bonds in halves at their two ends, angles at their vertex, dihedrals and impropers at their second
//! particle. Between particles that are a few bonds apart only a part of the pair potential is left.

use crate::FieldsError;
use crate::frame::Frame;
use crate::kernel::dot;
use peridyne::law::bonded::{PARTS, special_pairs};
use peridyne::law::terms::{Near, Sites, Term};
use peridyne::spec::BondedSpec;

/// A term of a centre: its form, its particles in the order of the form, the place of the centre among them.
#[derive(Debug, Clone, Copy)]
struct Own {
    form: u32,
    count: usize,
    points: [u32; 4],
    centre: usize,
}

/// Topology of a frame.
#[derive(Debug, Clone)]
pub struct Molecules {
    spec: BondedSpec,
    particles: usize,
    terms: Vec<Vec<Own>>,
    /// The other one, and what is left of the pair potential less 1.
    special: Vec<Vec<(u32, f64)>>,
}

impl Molecules {
    /// Of so many particles.
    ///
    /// # Errors
    /// A particle that there is not.
    pub fn new(spec: BondedSpec, particles: usize) -> Result<Molecules, FieldsError> {
        let mut terms = vec![vec![]; particles];
        for term in &spec.terms {
            let count = spec.forms[term.form as usize].particles();
            let own = &term.points[..count];
            if let Some(p) = own.iter().find(|p| **p as usize >= particles) {
                return Err(FieldsError(format!(
                    "a bonded term has particle {}, the frame has {particles}",
                    p + 1
                )));
            }
            let centres: &[usize] = if count == 2 { &[0, 1] } else { &[1] };
            for &centre in centres {
                terms[own[centre] as usize].push(Own {
                    form: term.form,
                    count,
                    points: term.points,
                    centre,
                });
            }
        }
        let mut special = vec![vec![]; particles];
        for ([a, b], apart) in special_pairs(&spec) {
            let left = spec.special[apart - 1] - 1.0;
            if left != 0.0 {
                special[a as usize].push((b, left));
                special[b as usize].push((a, left));
            }
        }
        Ok(Molecules {
            spec,
            particles,
            terms,
            special,
        })
    }

    /// Parts that are told apart: impropers only where there are some.
    pub(crate) fn parts(&self) -> &'static [&'static str] {
        let forms = self.spec.forms.iter().map(|f| f.part());
        &PARTS[..=forms.max().unwrap_or(0).max(2)]
    }

    /// Can they go with a potential and a frame?
    ///
    /// # Errors
    /// Another number of particles, or a potential of which no part can be taken away pair by pair.
    pub(crate) fn check(&self, particles: usize, sites: &dyn Sites) -> Result<(), FieldsError> {
        if self.particles != particles {
            return Err(FieldsError(format!(
                "the molecules have {} particles, the frame {particles}",
                self.particles
            )));
        }
        let of_pairs = sites.parts().iter().all(|p| p == "pair");
        if !of_pairs && self.special.iter().any(|s| !s.is_empty()) {
            return Err(FieldsError(
                "between bonded particles only a potential of pairs can be left out in part".into(),
            ));
        }
        Ok(())
    }

    /// Distance from a centre to the farthest particle of its terms (length).
    pub(crate) fn longest(&self, frame: &Frame) -> f64 {
        let mut most = 0.0f64;
        let mut partners = vec![];
        for centre in 0..self.particles as u32 {
            self.partners(centre, &mut partners);
            for p in &partners {
                let [a, b] = [centre, *p].map(|i| frame.position[i as usize]);
                let (_, y) = frame.cell.nearest(a, b);
                most = most.max(dot(y, y));
            }
        }
        most.sqrt() * (1.0 + 1e-9)
    }

    /// All particles that the terms of a centre have besides it.
    pub(crate) fn partners(&self, centre: u32, out: &mut Vec<u32>) {
        out.clear();
        for own in &self.terms[centre as usize] {
            out.extend(own.points[..own.count].iter().filter(|p| **p != centre));
        }
        out.extend(self.special[centre as usize].iter().map(|s| s.0));
        out.sort_unstable();
        out.dedup();
    }

    /// The terms of a centre. `at` gives the place of a partner and its position from the centre, `first` is the place of the parts of
    /// bonded terms among those of the potential.
    pub(crate) fn terms(
        &self,
        (centre, kind): (u32, u32),
        kinds: &[u32],
        at: &dyn Fn(u32) -> (u32, [f64; 3]),
        (sites, first): (&dyn Sites, usize),
        visit: &mut dyn FnMut(&Term),
    ) {
        let mut term = Term::default();
        for own in &self.terms[centre as usize] {
            let form = &self.spec.forms[own.form as usize];
            let places: Vec<(u32, [f64; 3])> = own.points[..own.count]
                .iter()
                .map(|p| if *p == centre { (0, [0.0; 3]) } else { at(*p) })
                .collect();
            let xi: Vec<f64> = form
                .pairs()
                .iter()
                .map(|(a, b)| {
                    let (a, b) = (places[*a].1, places[*b].1);
                    (0..3).map(|c| 0.5 * (a[c] - b[c]).powi(2)).sum()
                })
                .collect();
            let found = form.pulls(&xi);
            let part = if own.count == 2 { 0.5 } else { 1.0 };
            term.begin(first + form.part());
            term.energy = part * found.energy;
            let others = (0..own.count).filter(|n| *n != own.centre);
            term.particles.extend(others.map(|n| places[n].0));
            for ((a, b), g) in form.pairs().iter().zip(found.pulls) {
                let [a, b] = [places[*a].0, places[*b].0];
                term.pulls.push((a.min(b), a.max(b), part * g));
            }
            visit(&term);
        }
        for (other, left) in &self.special[centre as usize] {
            let (place, y) = at(*other);
            let near = Near {
                kind: kinds[*other as usize],
                y,
            };
            sites.terms(kind, &[near], &mut |pair| {
                term.clone_from(pair);
                term.energy *= left;
                term.particles.iter_mut().skip(1).for_each(|p| *p = place);
                for pull in &mut term.pulls {
                    *pull = (0, place, pull.2 * left);
                }
                visit(&term);
            });
        }
    }
}
