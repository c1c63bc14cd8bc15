use super::*;
use crate::body::view;
use crate::samples::Random;
use std::collections::HashSet;

/// So many atoms anywhere in a box.
fn gas<const D: usize>(n: usize, length: f64, periodic: bool, random: &mut Random) -> Body<D> {
    let mut x = vec![];
    for _ in 0..n {
        x.push(crate::array::from_fn(|a| match a < D {
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
        list.update(&body, view(&u), Simd::detect());
        let mut found = vec![];
        for b in 0..list.blocks() {
            for tile in list.tiles_of_kinds(b) {
                let t = tile.number;
                for line in tile.lines() {
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

/// Materials of the points, as they come.
fn mix<const D: usize>(body: &mut Body<D>, kinds: usize, random: &mut Random) {
    if kinds > 1 {
        let points = body.points();
        let kind = |_| ((0.5 + 0.5 * random.next()) * kinds as f64) as u8;
        body.give_materials((0..points).map(kind).collect::<Vec<_>>().into_iter());
    }
}

/// Of up to three kinds: two that do not see each other, one that sees its own nearby only.
fn reaches(kinds: usize) -> Reaches {
    Reaches::new(kinds, |i, j| match (i.min(j), i.max(j)) {
        (0, 2) => 0.0,
        (1, 1) => 0.9,
        _ => 1.5,
    })
}

/// Everything that a list holds after being made, moved and made again.
fn trace(threads: usize, kinds: usize, lines: Lines) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut random = Random(2);
        // many more atoms, and images, than a thread takes at a time
        let mut body = gas::<3>(20_000, 20.0, true, &mut random);
        mix(&mut body, kinds, &mut random);
        let mut u = body.at_rest();
        let mut list = NearList::of_kinds(&body, reaches(kinds), 0.2, lines);
        let mut bits = vec![];
        for (length, anew) in [(0.0, true), (0.05, false), (3.0, true)] {
            for c in &mut u {
                for &s in &body.slots {
                    c[s as usize] += length * random.next();
                }
            }
            assert_eq!(list.update(&body, view(&u), Simd::detect()), anew);
            assert!(list.images.len() > 8000);
            assert!(
                list.positions_at(view(&u), Simd::detect()).as_deref() == Some(list.positions())
            );
            bits.extend(list.positions().iter().flatten().map(|x| x.to_bits()));
            for tile in (0..list.blocks()).flat_map(|b| list.tiles_of_kinds(b)) {
                bits.extend(list.slots(tile.number).iter().map(|s| u64::from(*s)));
                bits.extend(tile.lines().iter().flatten().map(|j| u64::from(*j)));
            }
        }
        bits
    })
}

#[test]
fn the_number_of_threads_does_not_show() {
    for (kinds, lines) in [(1, Lines::ByKind), (3, Lines::ByKind), (3, Lines::Mixed)] {
        let one = trace(1, kinds, lines);
        assert!(trace(2, kinds, lines) == one && trace(5, kinds, lines) == one);
    }
}

#[test]
fn lists_of_kinds_are_those_of_all_their_pairs() {
    for lines in [Lines::ByKind, Lines::Mixed] {
        of_kinds(lines);
    }
}

fn of_kinds(lines: Lines) {
    let mut random = Random(3);
    let length = 6.0;
    let mut body = gas::<3>(700, length, true, &mut random);
    mix(&mut body, 3, &mut random);
    let mut u = body.at_rest();
    let reaches = reaches(3);
    let mut list = NearList::of_kinds(&body, reaches.clone(), 0.3, lines);
    for round in 0..3 {
        list.update(&body, view(&u), Simd::detect());
        let mut found = vec![];
        for tile in (0..list.blocks()).flat_map(|b| list.tiles_of_kinds(b)) {
            for (l, &slot) in list.slots(tile.number).iter().enumerate() {
                let own = body.material_of(slot as usize);
                assert_eq!(list.kind(tile.number * TILE + l), own);
                let all: Vec<(usize, &[[u32; TILE]])> = match lines {
                    Lines::ByKind => (0..3).map(|k| (k, tile.of_kind(k))).collect(),
                    Lines::Mixed => vec![(3, tile.lines())],
                };
                assert!(lines == Lines::Mixed || own == tile.kind);
                for (group, line) in { all.iter() }.flat_map(|(g, of)| of.iter().map(|l| (*g, l))) {
                    let Some(j) = list.original(line[l] as usize) else {
                        continue;
                    };
                    let kind = body.material_of(j);
                    assert_eq!(list.kind(line[l] as usize), kind);
                    let x = list.positions()[tile.number * TILE + l];
                    let y = list.positions()[line[l] as usize];
                    match lines {
                        Lines::ByKind => assert_eq!(kind, group),
                        Lines::Mixed => assert_eq!([x[3], y[3]], [own as f64, kind as f64]),
                    }
                    let r2: f64 = (0..3).map(|a| (x[a] - y[a]).powi(2)).sum();
                    let reach = reaches.between(own as u8, kind as u8);
                    // who is listed is in reach of it with the margin, as far as it moved
                    assert!(reach > 0.0 && r2 < (reach + 0.3 + 0.3).powi(2));
                    if r2 < reach.powi(2) {
                        found.push((slot as usize, j));
                    }
                }
            }
        }
        found.sort_unstable();
        let mut exact = vec![];
        for &i in &body.slots {
            for &j in &body.slots {
                let (i, j) = (i as usize, j as usize);
                let (p, q) = (body.position(i), body.position(j));
                let d = |a: usize| {
                    let d = p[a] + u[a][i] - q[a] - u[a][j];
                    d - length * (d / length).round()
                };
                let r2: f64 = (0..3).map(|a| d(a).powi(2)).sum();
                let kinds = [i, j].map(|s| body.material_of(s) as u8);
                if i != j && r2 < reaches.between(kinds[0], kinds[1]).powi(2) {
                    exact.push((i, j));
                }
            }
        }
        exact.sort_unstable();
        assert!(
            found == exact,
            "round {round}: {} pairs, not {}",
            found.len(),
            exact.len()
        );
        for c in &mut u {
            for &s in &body.slots {
                c[s as usize] += 0.1 * round as f64 * random.next();
            }
        }
    }
}

/// Everything that kernels read of a list.
fn seen<const D: usize>(list: &NearList<D>) -> Vec<u64> {
    let mut bits: Vec<u64> = { list.positions().iter().flatten() }
        .map(|x| x.to_bits())
        .collect();
    for tile in (0..list.blocks()).flat_map(|b| list.tiles_of_kinds(b)) {
        bits.push(tile.kind as u64);
        bits.extend(list.slots(tile.number).iter().map(|s| u64::from(*s)));
        for kind in 0..list.groups() {
            let lines = tile.of_kind(kind);
            bits.push(lines.len() as u64);
            bits.extend(lines.iter().flatten().map(|n| u64::from(*n)));
        }
    }
    let all = list.first_image() + list.images.len();
    bits.extend((0..all).map(|n| list.original(n).map_or(u64::MAX, |s| s as u64)));
    bits
}

/// Atoms go this far, each somewhere else.
fn wander<const D: usize>(body: &Body<D>, u: &mut crate::body::Field<D>, far: f64, seed: u64) {
    let mut random = Random(seed);
    for &s in &body.slots {
        u.iter_mut()
            .for_each(|c| c[s as usize] += far * random.next());
    }
}

#[test]
fn neighbours_come_by_cells_and_ids() {
    let (n, length) = (300, 5.0);
    let body = gas::<3>(n, length, true, &mut Random(4));
    let (cutoff, skin) = (0.21 * length, 0.05 * length);
    let mut list = NearList::new(&body, cutoff, skin);
    let mut u = body.at_rest();
    list.update(&body, view(&u), Simd::detect());
    wander(&body, &mut u, 0.3 * length, 5);
    assert!(list.update(&body, view(&u), Simd::detect()));
    // the cells of a box with its margin: 11 along each axis are no more than four for each atom, and a thousand
    let reach = cutoff + skin;
    let span = (length + reach) + reach;
    let count = (span / reach * 2.0).floor();
    assert!(count.powi(3) < (4 * n + 1000) as f64);
    let cell = |x: &[f64; 4]| -> [i64; 3] {
        let at = |a: usize| ((x[a] + reach) * (count / span)).floor() as i64;
        [at(2), at(1), at(0)]
    };
    let ids = body.ids_by_slot();
    let at = list.positions();
    let mut visited = 0;
    for tile in (0..list.blocks()).flat_map(|b| list.tiles_of_kinds(b)) {
        for l in 0..list.slots(tile.number).len() {
            let lines = tile.lines().iter().map(|line| line[l] as usize);
            let keys = lines.filter_map(|other| {
                let home = list.home(other)?;
                let id = ids[list.original(other)?];
                Some((cell(&at[other]), home != other, cell(&at[home]), id))
            });
            let keys: Vec<_> = keys.collect();
            assert!(keys.is_sorted_by(|a, b| a < b), "{keys:?}");
            visited += keys.len();
        }
    }
    assert!(visited > 10 * n, "{visited} neighbours");
    // lists of before do not show
    let mut other = NearList::new(&body, cutoff, skin);
    other.update(&body, view(&u), Simd::detect());
    assert!(seen(&other) == seen(&list));
}

/// What a list writes down.
fn saved<const D: usize>(list: &mut NearList<D>, body: &Body<D>) -> Vec<u8> {
    let mut bytes = vec![];
    let mut archive = Archive::save(&mut bytes);
    list.archive(body, Simd::detect(), &mut archive);
    archive.done().unwrap();
    bytes
}

#[test]
fn a_list_is_made_again_of_where_atoms_were() {
    for (kinds, lines) in [(1, Lines::ByKind), (3, Lines::ByKind), (3, Lines::Mixed)] {
        let mut random = Random(6);
        let mut body = gas::<3>(700, 6.0, true, &mut random);
        mix(&mut body, kinds, &mut random);
        let new = || NearList::of_kinds(&body, reaches(kinds), 0.3, lines);
        let (mut list, mut other) = (new(), new());
        let mut u = body.at_rest();
        other.update(&body, view(&u), Simd::detect());
        list.update(&body, view(&u), Simd::detect());
        wander(&body, &mut u, 2.0, 7);
        assert!(list.update(&body, view(&u), Simd::detect()));
        // and so far that it still holds: half the margin
        wander(&body, &mut u, 0.08, 8);
        assert!(!list.update(&body, view(&u), Simd::detect()));
        list.positions_mut()[3][3] = 0.25;
        list.copy_fourth();
        let bytes = saved(&mut list, &body);
        let mut from = &*bytes;
        let mut archive = Archive::load(&mut from);
        other.archive(&body, Simd::detect(), &mut archive);
        archive.done().unwrap();
        assert!(from.is_empty() && seen(&other) == seen(&list));
        // it goes on as the other does
        for (far, anew) in [(0.0, false), (0.4, true)] {
            wander(&body, &mut u, far, 9);
            for list in [&mut list, &mut other] {
                assert_eq!(list.update(&body, view(&u), Simd::detect()), anew);
            }
            assert!(seen(&other) == seen(&list));
        }
    }
}

#[test]
fn a_list_that_is_held_stays() {
    let body = gas::<3>(300, 6.0, true, &mut Random(10));
    let mut list = NearList::of_reference(&body, reaches(1), Lines::ByKind);
    list.update(&body, view(&body.at_rest()), Simd::detect());
    let lines = |list: &NearList<3>| -> Vec<_> {
        let tiles = (0..list.blocks()).flat_map(|b| list.tiles(b));
        tiles.map(|(_, lines)| lines.to_vec()).collect()
    };
    let before = lines(&list);
    let mut u = body.at_rest();
    wander(&body, &mut u, 3.0, 11);
    assert!(!list.update(&body, view(&u), Simd::detect()));
    assert!(lines(&list) == before && list.builds() == 1);
}

/// By id of each atom that is here, or whose list is: ids and places of its neighbours, in their order, as bits.
type Met = Vec<(u32, Vec<(u32, [u64; 3])>)>;

/// Those of atoms that are here, and those of others.
fn met<const D: usize>(
    body: &Body<D>,
    moves: &[Vec<[f64; D]>],
    (kinds, lines, wide): (usize, Lines, bool),
) -> [Met; 2] {
    let list = NearList::of_kinds(body, reaches(kinds), 0.2, lines);
    let mut list = if wide { list.wide() } else { list };
    let ids = body.ids_of_all();
    let mut u = body.at_rest();
    let mut all = [vec![], vec![]];
    let mut wide_ones: Met = vec![];
    for (n, moved) in moves.iter().enumerate() {
        body.set_vectors(&mut u, |_, slot| moved[ids[slot] as usize]);
        assert_eq!(list.update(body, view(&u), Simd::detect()), n != 1);
        assert!(list.positions_at(view(&u), Simd::detect()).as_deref() == Some(list.positions()));
        // who copies an atom has its fourth number
        let own = list.by_slot();
        let fourth = |id: u32| f64::from(7 * id + n as u32);
        let mut records = list.positions().to_vec();
        for (slot, own) in own.iter().enumerate().filter(|(_, own)| **own != NOBODY) {
            records[*own as usize][3] = fourth(ids[slot]);
        }
        list.fill(&mut records);
        let id = body.id_of();
        for tile in (0..list.blocks()).flat_map(|b| list.tiles_of_kinds(b)) {
            for l in 0..list.lanes(tile.number) {
                let atom = tile.number * TILE + l;
                let near = tile.lines().iter().map(|line| line[l] as usize);
                let near = near.filter_map(|other| {
                    let of = id(list.original(other)?);
                    assert_eq!(records[other][3], fourth(of));
                    let at = list.positions()[other];
                    assert!(records[other][..3] == at[..3]);
                    Some((of, [0, 1, 2].map(|a| at[a].to_bits())))
                });
                let is_own = l < list.slots(tile.number).len();
                let atom = id(list.original(atom).unwrap());
                let row = (atom, near.collect());
                if is_own { &mut all[0] } else { &mut wide_ones }.push(row);
            }
        }
        // lists of others are whole where own atoms are near
        let begun = all[0].iter().rposition(|(id, _)| *id == u32::MAX);
        let rows = &all[0][begun.map_or(0, |n| n + 1)..];
        let near: HashSet<u32> = rows
            .iter()
            .flat_map(|(_, near)| near)
            .map(|n| n.0)
            .collect();
        let others = std::mem::take(&mut wide_ones);
        all[1].extend(others.into_iter().filter(|(id, _)| near.contains(id)));
        all[0].push((u32::MAX, vec![]));
    }
    all
}

fn check_ranks<const D: usize>(periodic: bool, kinds: usize, lines: Lines, wide: bool) {
    let mut random = Random(12);
    let mut body = gas::<D>(1100, 11.0, periodic, &mut random);
    mix(&mut body, kinds, &mut random);
    let mut moves = vec![vec![[0.0; D]; body.points()]];
    // so far that the list holds, and anywhere
    for far in [0.04, 9.0] {
        let last = moves[moves.len() - 1].clone();
        let step = |x: [f64; D]| x.map(|x| x + far * random.next());
        moves.push(last.into_iter().map(step).collect());
    }
    let how = (kinds, lines, wide);
    let [one, _] = met(&body, &moves, how);
    let one: Vec<_> = one
        .split(|(id, _)| *id == u32::MAX)
        .map(<[_]>::to_vec)
        .collect();
    for ranks in [2, 5] {
        let parts = peridyne_comm::on_threads(ranks, |comm| {
            let part = body.subdomain_of(&std::sync::Arc::new(comm), 0.0);
            met(&part, &moves, how)
        });
        let mut all = vec![vec![]; one.len()];
        let mut others = 0;
        for [own, wide] in parts {
            let rounds = own.split(|(id, _)| *id == u32::MAX);
            all.iter_mut()
                .zip(rounds)
                .for_each(|(all, own)| all.extend_from_slice(own));
            others += wide.len();
            // theirs are the same lists, at some time
            assert!(
                wide.iter()
                    .all(|row| one.iter().any(|all| all.contains(row)))
            );
        }
        assert_eq!(others > 0, wide);
        for (all, one) in all.iter_mut().zip(&one) {
            let mut one = one.clone();
            all.sort_unstable();
            one.sort_unstable();
            assert!(
                *all == one,
                "{D}-D, {kinds} kinds, {lines:?}, {ranks} ranks"
            );
        }
    }
}

#[test]
fn atoms_have_the_same_neighbours_in_the_same_order_whoever_has_them() {
    for periodic in [false, true] {
        check_ranks::<1>(periodic, 1, Lines::ByKind, true);
        for wide in [false, true] {
            check_ranks::<2>(periodic, 3, Lines::ByKind, wide);
            check_ranks::<3>(periodic, 1, Lines::ByKind, wide);
        }
        check_ranks::<3>(periodic, 3, Lines::ByKind, false);
        check_ranks::<3>(periodic, 3, Lines::Mixed, false);
    }
}
