use super::*;

fn check<const D: usize>(n: usize, length: f64, periodic: bool) {
    let mut x = vec![];
    let mut seed = 1u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    for _ in 0..n {
        x.push(std::array::from_fn(|a| {
            if a < D { length * random() } else { 0.0 }
        }));
    }
    let period = [periodic.then_some(length); D];
    let body = Body::<D>::from_cloud(&x, &vec![1.0; n], &[], 0.1 * length, period).unwrap();
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
                c[s as usize] += (random() - 0.5) * 0.04 * length * round as f64;
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
