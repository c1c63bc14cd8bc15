use super::super::*;
use super::bodies::lattice;

#[test]
fn probe() {
    // 1-D tent
    let n = 401;
    let tent = lattice([n], 10.0, false, |x, y| { let d = (x[0] - y[0]).abs(); (1.0 - d / 10.0) * d });
    let stiff: f64 = (1..10).map(|j| (1.0 - j as f64 / 10.0) * (j * j) as f64).sum();
    let keep = Selection::every(4).choose(&tent).unwrap();
    for scheme in [Scheme::Rows, Scheme::Energy] {
        for r in [10.0, 16.0, 20.0, 24.0, 30.0, 40.0, 60.0, 80.0] {
            let o = Options { scheme, radius: Radius::Fixed(r), ..Options::default() };
            let t = std::time::Instant::now();
            match coarsen(&tent, &keep, &o) {
                Ok((c, rep)) => {
                    let mid = c.points() / 2;
                    let (p, b) = c.row(mid);
                    let m: f64 = p.iter().zip(b).map(|(j, b)| 0.5 * b[0][0] * c.xi(mid, *j as usize)[0].powi(2)).sum();
                    println!("{scheme:?} r {r} mod {:.6} asym {:.1e} solved {} its {} range {} def {} {:?}", m / stiff, rep.asymmetry, rep.work.solved, rep.work.products, rep.range, rep.definite, t.elapsed());
                }
                Err(e) => println!("{scheme:?} r {r} {e}"),
            }
        }
    }
    for k in [2u32, 3] {
        let body = lattice([60,60], 3.01, true, |_, _| 1.0);
        println!("{:?}", coarsen(&body, &Selection::every(k).choose(&body).unwrap(), &Options { scheme: Scheme::Rows, ..Options::default() }).unwrap().1);
        let a0 = check::affine(&body);
        let keep = Selection::every(k).choose(&body).unwrap();
        for scheme in [Scheme::Rows, Scheme::Energy] {
            for h in [2.0,3.0,4.0,8.0] {
                let r = (h * f64::from(k)).max(3.0);
                let o = Options { scheme, radius: Radius::Fixed(r), ..Options::default() };
                let t = std::time::Instant::now();
                match coarsen(&body, &keep, &o) {
                    Ok((c, rep)) => {
                        let a = check::affine(&c);
                        println!("2D k {k} {scheme:?} r {h}h mod {:.6} {:.6} asym {:.1e} rot {:.1e} solved {} its {} range {} def {} {:?}", a[0] / a0[0], a[5]/a0[5], rep.asymmetry, rep.soundness.rotation, rep.work.solved, rep.work.products, rep.range, rep.definite, t.elapsed());
                    }
                    Err(e) => println!("{scheme:?} r {h}h {e}"),
                }
            }
        }
    }
}
