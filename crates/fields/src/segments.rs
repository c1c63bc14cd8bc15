//! The bonds about one place, side by side, and β of them at the eight points of a brick; lengths and names as in `segment`.

use crate::gauss;
use crate::kernel::{Kernel, Shape};
use crate::patch::{EIGHT, Lanes};
use crate::polynomial::polynomial;
use crate::scalars::Scalars;
use crate::segment::{Segment, View};
use crate::spline::spline;

/// The bonds about one place.
#[derive(Default)]
pub(crate) struct Segments {
    all: Vec<Segment>,
    /// The same as columns of eight: u, e, L, e·u.
    columns: Vec<[Lanes; 8]>,
    /// What β of a brick is to be multiplied with, for each.
    pub factor: Vec<f64>,
    /// As they came: from the place to k, and to j from there.
    raw: Vec<[[f64; 3]; 2]>,
    /// Of each, whether a plane parts it from a box: above 0.
    beyond: Vec<Lanes>,
    over: f64,
    /// Do all begin at the place?
    here: bool,
    /// Is any done point by point?
    scalar: bool,
}

impl Segments {
    pub fn begin(&mut self, kernel: &Kernel) {
        self.all.clear();
        self.columns.clear();
        self.factor.clear();
        self.raw.clear();
        self.over = 1.0 / kernel.radius();
        self.here = true;
        self.scalar = false;
    }

    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// 1 over the unit of length.
    pub fn over(&self) -> f64 {
        self.over
    }

    /// A bond from k, as seen from the place, to j.
    pub fn add(&mut self, kernel: &Kernel, from: [f64; 3], bond: [f64; 3]) {
        let own = Segment::new(from, bond, self.over);
        let scalar = Scalars(kernel).wanted(own.length);
        self.scalar |= scalar;
        let factor = match scalar {
            true => 1.0,
            false => kernel.norm / own.length,
        };
        let ([u, v, w], [a, b, c]) = (own.along, own.begin);
        let all = [u, v, w, a, b, c, own.length, own.start];
        let n = self.all.len() % EIGHT;
        if n == 0 {
            self.columns.push([Lanes::ZERO; 8]);
        }
        if let Some(columns) = self.columns.last_mut() {
            columns
                .iter_mut()
                .zip(all)
                .for_each(|(column, x)| column[n] = x);
        }
        self.here &= own.is_here();
        self.all.push(own);
        self.factor.push(factor);
        self.raw.push([from, bond]);
    }

    /// Those that come nearer to a box than the radius of φ, or nearly: its centre as seen from the place, and half its edges. A plane
    /// across the way from the nearest point of a bond to the centre parts them if anything of that kind does.
    #[inline(always)]
    pub fn near(&mut self, centre: [f64; 3], half: [f64; 3], out: &mut Vec<u32>) {
        let over = self.over;
        let [x, y, z] = [centre[0] * over, centre[1] * over, centre[2] * over];
        let [p, q, r] = [half[0] * over, half[1] * over, half[2] * over];
        let all = p.mul_add(p, q.mul_add(q, r * r)).sqrt();
        let count = self.all.len();
        // all of them reach what is near the place where they begin
        if self.here && x.mul_add(x, y.mul_add(y, z * z)) < (1.0 - all) * (1.0 - all) && all < 1.0 {
            out.clear();
            out.extend(0..count as u32);
            return;
        }
        self.beyond.clear();
        for eight in &self.columns {
            let [u, v, w, a, b, c, length, start] = eight;
            let mut beyond = Lanes::ZERO;
            for n in 0..EIGHT {
                let foot = x.mul_add(u[n], y.mul_add(v[n], z.mul_add(w[n], -start[n])));
                let low = if foot > 0.0 { foot } else { 0.0 };
                let at = if low < length[n] { low } else { length[n] };
                let dx = (-at).mul_add(u[n], x - a[n]);
                let dy = (-at).mul_add(v[n], y - b[n]);
                let dz = (-at).mul_add(w[n], z - c[n]);
                let square = dx.mul_add(dx, dy.mul_add(dy, dz * dz));
                let wide = p.mul_add(dx.abs(), q.mul_add(dy.abs(), r * dz.abs()));
                let gap = square - wide;
                let gap = if gap > 0.0 { gap } else { 0.0 };
                // a little more, so that round-off loses nothing
                beyond[n] = gap.mul_add(gap, -(1.0 + 1e-9) * square);
            }
            self.beyond.push(beyond);
        }
        out.resize(EIGHT * self.beyond.len() + 1, 0);
        let mut kept = 0;
        for (first, beyond) in self.beyond.iter().enumerate() {
            for n in 0..EIGHT {
                out[kept] = (EIGHT * first + n) as u32;
                kept += usize::from(beyond[n] <= 0.0);
            }
        }
        // what fills up the last eight comes last
        while kept > 0 && out[kept - 1] as usize >= count {
            kept -= 1;
        }
        out.truncate(kept);
    }

    /// β of some of them at the points of a brick, over `factor`.
    #[inline(always)]
    pub fn beta(&self, kernel: &Kernel, view: &View, list: &[u32], out: &mut [Lanes]) {
        let all = &self.all;
        match kernel.shape() {
            Shape::Polynomial(n) => polynomial(n, all, view, list, out),
            Shape::CubicSpline => spline::<3>(kernel, all, view, list, out),
            Shape::QuarticSpline => spline::<4>(kernel, all, view, list, out),
            Shape::Gaussian => gauss::bonds(all, view, list, out),
            Shape::Cell => {}
        }
        if !self.scalar {
            return;
        }
        let scalars = Scalars(kernel);
        for (n, out) in list.iter().zip(out) {
            let n = *n as usize;
            if scalars.wanted(all[n].length) {
                scalars.beta(view, self.over, self.raw[n], out);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bonds seen from any place, side by side, are what they are one by one; and none that counts is passed over.
    #[test]
    fn side_by_side_is_one_by_one() {
        let mut seed = 11u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        for shape in (0..=Shape::SMOOTHEST).map(Shape::Polynomial).chain([
            Shape::CubicSpline,
            Shape::QuarticSpline,
            Shape::Gaussian,
            Shape::Cell,
        ]) {
            let width = if shape == Shape::Gaussian { 0.3 } else { 1.1 };
            for extents in [[None; 3], [None, Some(2.0), None]] {
                let kernel = Kernel::averaged(shape, width, extents).unwrap();
                let peak = kernel.value([0.0; 3]);
                let mut counted = 0;
                for round in 0..40 {
                    let mut segments = Segments::default();
                    segments.begin(&kernel);
                    for n in 0..11 {
                        let size = [0.02, 0.4, 1.5][n % 3];
                        let bond = [random(), random(), random()].map(|c| size * c);
                        let from = match (round % 3, n % 2) {
                            (0, _) | (1, 0) => [0.0; 3],
                            (1, _) => bond.map(|c| -c),
                            _ => [random(), random(), random()],
                        };
                        segments.add(&kernel, kernel.project(from), kernel.project(bond));
                    }
                    let middle = [random(), random(), random()].map(|c| 2.0 * c);
                    let half = [0.3, 0.2, 0.1];
                    let mut x = [Lanes::ZERO; 3];
                    for a in 0..3 {
                        for k in 0..EIGHT {
                            x[a][k] = kernel.counts[a] * (middle[a] + half[a] * random());
                        }
                    }
                    let mut list = vec![];
                    segments.near(kernel.project(middle), kernel.project(half), &mut list);
                    let view = View::new(&x, [0.0; 3], segments.over());
                    let mut beta = vec![Lanes::ZERO; list.len()];
                    segments.beta(&kernel, &view, &list, &mut beta);
                    for n in 0..segments.len() {
                        let [from, bond] = segments.raw[n];
                        let place = list.iter().position(|m| *m as usize == n);
                        for k in 0..EIGHT {
                            let d = std::array::from_fn(|a| x[a][k] - from[a]);
                            let one = kernel.bond(d, bond);
                            let found = place.map_or(0.0, |p| segments.factor[n] * beta[p][k]);
                            counted += usize::from(one > 1e-3 * peak);
                            let error = (found - one).abs() / peak;
                            assert!(error < 1e-11, "{shape:?} {from:?} {bond:?}: {error:e}");
                        }
                    }
                }
                assert!(counted > 50, "{shape:?}: {counted}");
            }
        }
    }
}
