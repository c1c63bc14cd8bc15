//! Bodies that ranks will share of which no rank ever has all points.

use super::blocks::{of_points, shared_out};
use super::cloud::{CountedCloud, Moved};
use super::lattice::CountedLattice;
use super::several::of_each;
use crate::body::Body;
use crate::error::BuildError;
use crate::space::fill::Search;
use peridyne_comm::Comm;
use std::sync::Arc;

/// A body of the sites of a lattice in a region: all ranks know how many points each of its blocks has, and none has its points.
pub struct Counted<const D: usize>(Kind<D>);

enum Kind<const D: usize> {
    Lattice(CountedLattice<D>),
    Cloud(CountedCloud<D>),
}

impl<const D: usize> Counted<D> {
    /// On all sites that are found, as [`Body::on_lattice`] says. Each rank looks at a part of the cells. All ask at once.
    ///
    /// # Errors
    /// Of all ranks the same: there are no sites, or more than can be numbered; a period is shorter than a bond.
    pub fn lattice(
        comm: &Comm,
        search: Search,
        reach: (usize, [bool; D]),
        volume: f64,
    ) -> Result<Self, BuildError> {
        let counted = CountedLattice::new(comm, search, reach, volume)?;
        Ok(Counted(Kind::Lattice(counted)))
    }

    /// A cloud of these points, which the order of cells numbers, each somewhere beside its site.
    ///
    /// # Errors
    /// The same.
    pub fn cloud(
        comm: &Comm,
        search: Search,
        reach: (usize, [bool; D]),
        volume: f64,
        moved: Moved,
    ) -> Result<Self, BuildError> {
        let counted = CountedCloud::new(comm, search, reach, volume, moved)?;
        Ok(Counted(Kind::Cloud(counted)))
    }

    /// Typical distance of nearest points (length).
    pub fn spacing(&self) -> f64 {
        match &self.0 {
            Kind::Lattice(of) => of.spacing(),
            Kind::Cloud(of) => of.spacing(),
        }
    }

    /// Period per axis, if periodic.
    pub fn period(&self) -> [Option<f64>; D] {
        match &self.0 {
            Kind::Lattice(of) => of.period,
            Kind::Cloud(of) => of.period,
        }
    }

    /// This rank's part of each of several bodies, cut as [`Body::subdomain_of`] says by the blocks of all. All ask at once.
    pub fn parts(several: &[Self], comm: &Arc<Comm>, reach: f64) -> Vec<Body<D>> {
        let points = several.iter().map(|body| match &body.0 {
            Kind::Lattice(of) => of.points.clone(),
            Kind::Cloud(of) => of_points(of.points()),
        });
        let points: Vec<Vec<usize>> = points.collect();
        let blocks = shared_out(&points.concat(), comm);
        let own = of_each(points.iter().map(Vec::len), &blocks);
        let parts = several.iter().zip(own).map(|(body, own)| match &body.0 {
            Kind::Lattice(of) => of.part(&own, comm),
            Kind::Cloud(of) => of.part(&own, comm, reach),
        });
        parts.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Counted;
    use crate::body::{Body, Layout};
    use crate::samples::Random;
    use crate::space::Point;
    use crate::space::fill::{Search, fill};
    use crate::space::lattice::{Lattice, LatticeKind};
    use crate::space::region::Region;
    use peridyne_comm::on_threads;
    use std::sync::Arc;

    fn block(low: [f64; 3], size: [f64; 3]) -> Region {
        let hole = Region::Sphere {
            center: crate::array::from_fn(|a| low[a] + 0.3 * size[a]),
            radius: 1.0,
        };
        let high = crate::array::from_fn(|a| low[a] + size[a]);
        let block = Region::Block { low, high };
        Region::Difference(Box::new(block), vec![hole])
    }

    fn lattice(kind: LatticeKind, spacing: f64) -> Lattice {
        Lattice {
            kind,
            spacing,
            origin: [0.1, -0.3, 0.2],
        }
    }

    /// Somewhere near, wherever it is asked.
    fn moved<const D: usize>(id: usize, site: Point, by: f64) -> Point {
        let mut random = Random(17 + 31 * id as u64);
        crate::array::from_fn(|a| {
            let off = by * (2.0 * random.next() - 1.0);
            if a < D { site[a] + off } else { site[a] }
        })
    }

    /// What is where in a part of a body, and who has it.
    fn same<const D: usize>(a: &Body<D>, b: &Body<D>, name: &str) {
        let [of_a, of_b] = [a, b].map(|body| body.subdomain().unwrap());
        assert_eq!(of_a.ids(), of_b.ids(), "{name}");
        assert_eq!(of_a.of_slots(), of_b.of_slots(), "{name}");
        assert_eq!(of_a.points(), of_b.points(), "{name}");
        assert_eq!(of_a.own_slots(), of_b.own_slots(), "{name}");
        assert_eq!((&a.slots, a.len), (&b.slots, b.len), "{name}");
        assert_eq!((a.spacing, a.period), (b.spacing, b.period), "{name}");
        assert_eq!((&a.volume, &a.density), (&b.volume, &b.density), "{name}");
        assert_eq!((&a.mark, &a.horizon), (&b.mark, &b.horizon), "{name}");
        for slot in 0..a.len {
            let [x, y] = [a, b].map(|body| body.exchange.original(slot));
            assert_eq!(x, y, "{name} {slot}");
        }
        // what comes from whom
        let filled = [a, b].map(|body| {
            let mut column = vec![u32::MAX; body.len];
            for (id, slot) in body.slots.iter().enumerate() {
                column[*slot as usize] = body.id_of_all(id) as u32;
            }
            body.exchange.fill(&mut column);
            column
        });
        assert!(filled[0] == filled[1], "{name}");
        for slot in a
            .slots
            .iter()
            .copied()
            .map(|s| s as usize)
            .chain(a.exchange.copies())
        {
            assert_eq!(a.position(slot), b.position(slot), "{name}");
        }
        for slot in a.slots.iter().map(|s| *s as usize) {
            assert_eq!(a.order(slot), b.order(slot), "{name}");
        }
        match (&a.layout, &b.layout) {
            (Layout::Cloud(_), Layout::Cloud(_)) => {}
            (Layout::Grid(a), Layout::Grid(b)) => {
                let of =
                    |grid: &crate::body::Grid<D>| (grid.cells, grid.low, grid.first, grid.stride);
                assert_eq!(of(a), of(b), "{name}");
                assert_eq!((&a.present, &a.owned), (&b.present, &b.owned), "{name}");
            }
            (Layout::Several(a), Layout::Several(b)) => {
                assert_eq!(a.len(), b.len(), "{name}");
                for (n, (a, b)) in a.iter().zip(b).enumerate() {
                    assert_eq!(a.first, b.first, "{name}");
                    same(&a.body, &b.body, &format!("{name}, body {n}"));
                }
            }
            _ => panic!("{name}: they are stored otherwise"),
        }
    }

    fn clouds<const D: usize>(
        kind: LatticeKind,
        size: [f64; 3],
        by: f64,
        periodic: [bool; D],
        reaches: &[f64],
    ) {
        let (lattice, region) = (lattice(kind, 0.5), block([0.0; 3], size));
        let by = by * lattice.distance();
        let sites = fill(&lattice, &region).unwrap();
        let on = Body::on_lattice(lattice, &sites.quarters, 2, periodic, 0.25).unwrap();
        let places = { on.slots.iter().enumerate() }
            .map(|(id, s)| moved::<D>(id, on.position(*s as usize), by));
        let places: Vec<Point> = places.collect();
        let volume = vec![0.25; places.len()];
        let whole =
            Body::<D>::from_cloud(&places, &volume, &[], on.spacing(), on.period()).unwrap();
        for reach in reaches {
            for ranks in [1, 2, 3, 5, 8, 30] {
                on_threads(ranks, |comm| {
                    let comm = Arc::new(comm);
                    let cut = whole.subdomain_of(&comm, *reach);
                    let search = Search::new(&lattice, &region).unwrap();
                    let to = Box::new(move |id: usize, x: Point| moved::<D>(id, x, by));
                    let made = Counted::cloud(&comm, search, (2, periodic), 0.25, to).unwrap();
                    assert_eq!(
                        (made.spacing(), made.period()),
                        (whole.spacing, whole.period)
                    );
                    let made = Counted::parts(&[made], &comm, *reach).remove(0);
                    let name = format!("{kind:?} {by} {reach} rank {} of {ranks}", comm.rank());
                    same(&cut, &made, &name);
                });
            }
        }
    }

    #[test]
    fn clouds_on_sites_need_no_whole_body() {
        for by in [0.0, 0.49] {
            clouds(LatticeKind::Chain, [900.0, 0.0, 0.0], by, [false], &[1.6]);
            clouds(
                LatticeKind::Chain,
                [900.0, 0.0, 0.0],
                by,
                [true],
                &[0.0, 1.6, 500.0],
            );
            clouds(
                LatticeKind::Square,
                [30.0, 25.0, 0.0],
                by,
                [false, true],
                &[1.6],
            );
            clouds(
                LatticeKind::Triangular,
                [20.0, 30.0, 0.0],
                by,
                [true; 2],
                &[1.2, 7.0],
            );
            clouds(LatticeKind::Cubic, [7.0, 6.0, 9.0], by, [false; 3], &[1.6]);
            clouds(
                LatticeKind::Bcc,
                [6.0, 5.0, 8.0],
                by,
                [true, false, true],
                &[1.1],
            );
            clouds(LatticeKind::Diamond, [6.0, 6.0, 4.0], by, [true; 3], &[1.1]);
        }
    }

    #[test]
    fn several_bodies_need_no_whole_one() {
        let (reach, periodic, by) = (1.6, [true, false], 0.2);
        // the first and the last are lattices, the second is moved; the third is that on sites
        let of = [
            (LatticeKind::Square, 0.5, [0.0, 0.0], Some(0.25)),
            (LatticeKind::Square, 0.5, [0.0, 12.0], None),
            (LatticeKind::Triangular, 0.5, [0.0, 40.0], None),
            (LatticeKind::Square, 0.25, [0.0, 30.0], Some(0.0625)),
        ];
        let size = [20.0, 9.0, 0.0];
        let region = |n: usize| block([of[n].2[0], of[n].2[1], 0.0], size);
        let amount = |n: usize| if n == 1 { by } else { 0.0 };
        for several in [
            vec![0, 3],
            vec![0, 1, 3],
            vec![2, 1],
            vec![1, 0, 2, 3],
            vec![0, 0],
        ] {
            let body = |n: &usize| {
                let (kind, spacing, _, volume) = of[*n];
                let lattice = lattice(kind, spacing);
                let sites = fill(&lattice, &region(*n)).unwrap();
                let on = volume.unwrap_or(0.2);
                let on = Body::on_lattice(lattice, &sites.quarters, 3, periodic, on).unwrap();
                if volume.is_some() {
                    return on;
                }
                let places = { on.slots.iter().enumerate() }
                    .map(|(id, s)| moved::<2>(id, on.position(*s as usize), amount(*n)));
                let places: Vec<Point> = places.collect();
                let volume = vec![0.2; places.len()];
                Body::from_cloud(&places, &volume, &[], on.spacing(), on.period()).unwrap()
            };
            let whole = Body::<2>::several(several.iter().map(body).collect());
            for ranks in [1, 2, 3, 4, 5, 6, 7, 8] {
                on_threads(ranks, |comm| {
                    let comm = Arc::new(comm);
                    let counted = several.iter().map(|n| {
                        let (kind, spacing, _, volume) = of[*n];
                        let search = Search::new(&lattice(kind, spacing), &region(*n)).unwrap();
                        let by = amount(*n);
                        let way = Box::new(move |id: usize, x: Point| moved::<2>(id, x, by));
                        match volume {
                            Some(v) => Counted::lattice(&comm, search, (3, periodic), v),
                            None => Counted::cloud(&comm, search, (3, periodic), 0.2, way),
                        }
                        .unwrap()
                    });
                    let counted: Vec<_> = counted.collect();
                    let made = Body::several(Counted::parts(&counted, &comm, reach));
                    let name = format!("{several:?} rank {} of {ranks}", comm.rank());
                    same(&whole.subdomain_of(&comm, reach), &made, &name);
                    // and with points of the others beside them
                    let last = whole.points() as u32 - 1;
                    let beside: Vec<u32> = (0..=last).step_by(97).collect();
                    let cut = whole.subdomain_beside(&comm, reach, &beside);
                    same(&cut, &made.beside(&beside), &name);
                });
            }
        }
    }
}
