//! The bonds that lead back along those of a list, some of which other ranks have.

use crate::body::Body;
use crate::execute::lane::TILE;
use crate::family::horizon::HorizonList;
use bytemuck::{cast_slice, cast_slice_mut, pod_read_unaligned};
use peridyne_comm::Comm;
use std::sync::Arc;

/// What bonds of other ranks remember that lead back along own ones, behind what own bonds remember.
#[derive(Debug)]
pub struct Abroad {
    comm: Arc<Comm>,
    /// Of each rank: places of own bonds that it asks for, and how many of its bonds are asked for.
    traffic: Vec<(usize, Vec<u32>, usize)>,
    /// Place of the first one.
    first: usize,
}

/// Where number `n` of `count` of a bond is remembered, by its place.
fn at(place: usize, n: usize, count: usize) -> usize {
    (place / TILE * count + n) * TILE + place % TILE
}

impl Abroad {
    /// For so many bonds there must be room, in whole lines.
    pub fn workspace(&self) -> usize {
        let all: usize = self.traffic.iter().map(|(_, _, receive)| receive).sum();
        all.next_multiple_of(TILE)
    }

    /// What they remember now, `count` numbers each. All ranks come here at once.
    pub fn fill(&self, memory: &mut [f64], count: usize) {
        let packed = self.traffic.iter().map(|(_, own, _)| {
            let each = own.iter().map(|place| *place as usize);
            each.flat_map(|place| (0..count).map(move |n| at(place, n, count)))
                .map(|place| memory[place])
                .collect()
        });
        let packed: Vec<Vec<f64>> = packed.collect();
        let workspace = self.traffic.iter();
        let mut came: Vec<Vec<f64>> = workspace
            .map(|(_, _, receive)| vec![0.0; count * receive])
            .collect();
        let ranks = || self.traffic.iter().map(|(rank, _, _)| *rank);
        let send = ranks().zip(packed.iter().map(|x| cast_slice(x)));
        let send: Vec<(usize, &[u8])> = send.filter(|(_, x)| !x.is_empty()).collect();
        let receive = ranks().zip(came.iter_mut().map(|x| cast_slice_mut(x)));
        let mut receive: Vec<(usize, &mut [u8])> = receive.filter(|(_, x)| !x.is_empty()).collect();
        let done = self.comm.exchange(&send, &mut receive, || ());
        done.unwrap_or_else(|failure| self.comm.end(failure));
        let each = came.iter().flat_map(|x| x.chunks_exact(count));
        for (bond, numbers) in each.enumerate() {
            for (n, x) in numbers.iter().enumerate() {
                memory[at(self.first + bond, n, count)] = *x;
            }
        }
    }
}

/// Place of the bond that leads back, for every bond of a list; of one that another rank has, behind all own ones. All ranks come here at once.
pub fn ways_back<const D: usize>(list: &HorizonList, body: &Body<D>) -> (Vec<u32>, Option<Abroad>) {
    let mut place = vec![0u32; list.partner.len()];
    // rows, and one more
    let mut row_of = vec![0u32; body.len];
    for (row, &slot) in list.rows.iter().enumerate() {
        row_of[slot as usize] = row as u32 + 1;
    }
    let ids = body.subdomain().map(|of| of.of_slots());
    // what is asked of each rank, and for which bond here
    let mut asked: Vec<(usize, [u32; 2], usize)> = vec![];
    let owners = body.exchange.owners(body.len);
    for (row, &i) in list.rows.iter().enumerate() {
        for (line, j) in list.partners(row) {
            let own = line * TILE + row % TILE;
            match (row_of[j] as usize).checked_sub(1) {
                Some(other) => {
                    let back = list.partners(other).find(|(_, k)| *k == i as usize);
                    let (back, _) = back.expect("bonds of a list go both ways");
                    place[own] = (back * TILE + other % TILE) as u32;
                }
                None => {
                    let ids = ids.expect("a point of another rank");
                    asked.push((owners[j] as usize, [ids[j], ids[i as usize]], own));
                }
            }
        }
    }
    let Some(of) = body.subdomain() else {
        return (place, None);
    };
    asked.sort_by_key(|(rank, _, _)| *rank);
    let first = list.partner.len();
    for (n, (_, _, own)) in asked.iter().enumerate() {
        place[*own] = (first + n) as u32;
    }
    let comm = of.comm();
    let wishes = (0..comm.ranks()).map(|rank| {
        let of_rank = asked.iter().filter(|(of, _, _)| *of == rank);
        let ends: Vec<[u32; 2]> = of_rank.map(|(_, ends, _)| *ends).collect();
        cast_slice(&ends).to_vec()
    });
    let wishes: Vec<Vec<u8>> = wishes.collect();
    let receive: Vec<usize> = wishes.iter().map(|w| w.len() / 8).collect();
    let came = { comm.to_each(wishes) }.unwrap_or_else(|failure| comm.end(failure));
    let traffic = came.into_iter().zip(receive).enumerate();
    let traffic = traffic.map(|(rank, (bytes, receive))| {
        let own = bytes.chunks_exact(8).map(|ends| {
            let [own, other]: [u32; 2] = pod_read_unaligned(ends);
            let id = of.ids().binary_search(&own).expect("a point of this rank");
            let row = row_of[body.slots[id] as usize] as usize - 1;
            let back = list.partners(row).find(|(_, k)| of.of_slots()[*k] == other);
            let (line, _) = back.expect("bonds of a list go both ways");
            (line * TILE + row % TILE) as u32
        });
        (rank, own.collect(), receive)
    });
    let traffic = traffic.filter(|(_, own, receive): &(_, Vec<u32>, _)| own.len() + receive > 0);
    let abroad = Abroad {
        comm: comm.clone(),
        traffic: traffic.collect(),
        first,
    };
    (place, Some(abroad))
}
