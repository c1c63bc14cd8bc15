use super::*;
use crate::samples::Random;

/// So many atoms anywhere in a box.
fn gas<const D: usize>(n: usize, length: f64, periodic: bool, random: &mut Random) -> Body<D> {
    let mut x = vec![];
    for _ in 0..n {
        x.push(std::array::from_fn(|a| match a < D {
            true => 0.5 * length * (1.0 + random.next()),
            false => 0.0,
        }));
    }
    let period = [periodic.then_some(length); D];
    Body::<D>::from_cloud(&x, &vec![1.0; n], &[], 0.1 * length, period).unwrap()
}

fn check<const D: usize>(n: usize, length: f64, periodic: bool) {
    let mut random = Random(1);
    let body = gas::<D>(n, length, periodic, &mut random);
    let mut u = body.at_rest();
    let (cutoff, skin) = (0.21 * length, 0.05 * length);
    let mut list = NearList::new(&body, cutoff, skin);
    for round in 0..4 {
        list.update(&body, &u, Simd::detect());
        let mut found = vec![];
        for b in 0..list.blocks() {
            for (t, lines) in list.tiles(b) {
                for line in lines {
                    for (l, &slot) in list.slots(t).iter().enumerate() {
                        let (p, q) = (
                            list.positions()[t * TILE + l],
                            list.positions()[line[l] as usize],
                        );
                        let r2: f64 = (0..D).map(|a| (p[a] - q[a]).powi(2)).sum();
                        if r2 < cutoff * cutoff {
                            found.push((slot as usize, list.original(line[l] as usize).unwrap()));
                        }
                    }
                }
            }
        }
        found.sort_unstable();
        let mut exact = vec![];
        for i in &body.slots {
            for j in &body.slots {
                let (i, j) = (*i as usize, *j as usize);
                let (p, q) = (body.position(i), body.position(j));
                let r2: f64 = (0..D)
                    .map(|a| {
                        let mut d = p[a] + u[a][i] - q[a] - u[a][j];
                        if periodic {
                            d -= length * (d / length).round();
                        }
                        d * d
                    })
                    .sum();
                if i != j && r2 < cutoff * cutoff {
                    exact.push((i, j));
                }
            }
        }
        exact.sort_unstable();
        assert!(
            found == exact,
            "{D}-D, periodic {periodic}, round {round}: {} pairs, not {}",
            found.len(),
            exact.len()
        );
        for c in &mut u {
            for &s in &body.slots {
                c[s as usize] += 0.02 * length * round as f64 * random.next();
            }
        }
    }
    assert!(list.builds() > 1);
}

#[test]
fn the_list_is_that_of_all_pairs() {
    for periodic in [false, true] {
        check::<1>(40, 7.0, periodic);
        check::<2>(150, 3.0, periodic);
        check::<3>(300, 5.0, periodic);
    }
}

/// Everything that a list holds after being made, moved and made again.
fn trace(threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut random = Random(2);
        // many more atoms, and ghosts, than a thread takes at a time
        let body = gas::<3>(20_000, 20.0, true, &mut random);
        let mut u = body.at_rest();
        let mut list = NearList::new(&body, 1.5, 0.2);
        let mut bits = vec![];
        for (length, anew) in [(0.0, true), (0.05, false), (3.0, true)] {
            for c in &mut u {
                for &s in &body.slots {
                    c[s as usize] += length * random.next();
                }
            }
            assert_eq!(list.update(&body, &u, Simd::detect()), anew);
            assert!(list.ghosts.len() > 8000);
            assert!(list.positions_at(&u, Simd::detect()).as_deref() == Some(list.positions()));
            bits.extend(list.positions().iter().flatten().map(|x| x.to_bits()));
            for (t, lines) in (0..list.blocks()).flat_map(|b| list.tiles(b)) {
                bits.extend(list.slots(t).iter().map(|s| u64::from(*s)));
                bits.extend(lines.iter().flatten().map(|j| u64::from(*j)));
            }
        }
        bits
    })
}

#[test]
fn the_number_of_threads_does_not_show() {
    let one = trace(1);
    assert!(trace(2) == one && trace(5) == one);
}
