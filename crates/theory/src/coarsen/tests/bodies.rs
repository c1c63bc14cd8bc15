//! Bodies for tests: points of a square or cubic lattice with central bonds.

use peridyne::statics::LinearBody;

/// Points of a lattice of unit spacing within `size`, bonds `k(i, j) ξ⊗ξ/|ξ|³` shorter than `reach` (open), volumes 1.
pub fn lattice<const D: usize>(
    size: [usize; D],
    reach: f64,
    periodic: bool,
    k: impl Fn([f64; D], [f64; D]) -> f64,
) -> LinearBody<D> {
    let n: usize = size.iter().product();
    let point = |mut i: usize| -> [f64; D] {
        std::array::from_fn(|a| {
            let x = i % size[a];
            i /= size[a];
            x as f64
        })
    };
    let mut body = LinearBody {
        position: (0..n).map(point).collect(),
        volume: vec![1.0; n],
        density: vec![1.0; n],
        period: std::array::from_fn(|a| periodic.then_some(size[a] as f64)),
        start: vec![0],
        partner: vec![],
        block: vec![],
    };
    let r = reach.ceil() as i64;
    for i in 0..n {
        let mut row = vec![];
        for o in 0..(2 * r + 1).pow(D as u32) {
            let mut rest = o;
            let mut j = 0;
            let mut stride = 1;
            let mut xi = [0.0; D];
            let mut inside = true;
            for a in 0..D {
                let d = rest % (2 * r + 1) - r;
                rest /= 2 * r + 1;
                let mut to = body.position[i][a] as i64 + d;
                if periodic {
                    to = to.rem_euclid(size[a] as i64);
                }
                inside &= (0..size[a] as i64).contains(&to);
                xi[a] = d as f64;
                j += to.max(0) as usize * stride;
                stride *= size[a];
            }
            let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !inside || length == 0.0 || length >= reach {
                continue;
            }
            let c = k(body.position[i], body.position[j]) / length.powi(3);
            row.push((j as u32, std::array::from_fn(|a| std::array::from_fn(|b| c * xi[a] * xi[b]))));
        }
        row.sort_by_key(|r: &(u32, _)| r.0);
        for (j, c) in row {
            body.partner.push(j);
            body.block.push(c);
        }
        body.start.push(body.partner.len());
    }
    body
}
