//! Ranks on threads: what is sent is what arrives, in order, whoever is late.

use peridyne_comm::{Comm, Failure, on_threads};
use std::time::Duration;

/// Ranks of every test.
const RANKS: [usize; 7] = [1, 2, 3, 4, 5, 7, 8];

/// Bytes that say from whom, to whom and which message they are; from nothing to some hundreds.
fn message(from: usize, to: usize, which: usize) -> Vec<u8> {
    let bytes = (from * 31 + to * 17 + which * 101) % 300;
    (0..bytes)
        .map(|n| (n * 7 + from * 3 + to * 5 + which) as u8)
        .collect()
}

#[test]
fn what_is_sent_arrives_in_the_order_of_both_lists() {
    for ranks in RANKS {
        on_threads(ranks, |comm| {
            let own = comm.rank();
            for round in 0..20 {
                // two messages to everybody, oneself too
                let sent: Vec<(usize, Vec<u8>)> = (0..2 * ranks)
                    .map(|n| (n % ranks, message(own, n % ranks, round * 2 + n / ranks)))
                    .collect();
                let mut got: Vec<(usize, Vec<u8>)> = (0..2 * ranks)
                    .rev()
                    .map(|n| n % ranks)
                    .map(|from| (from, vec![]))
                    .collect();
                // the first of a rank is its first message, however ranks follow in the list
                let mut which = vec![0; ranks];
                for (from, into) in &mut got {
                    into.resize(message(*from, own, round * 2 + which[*from]).len(), 0);
                    which[*from] += 1;
                }
                if (own + round) % 3 == 0 {
                    std::thread::sleep(Duration::from_micros(50));
                }
                let send: Vec<(usize, &[u8])> =
                    sent.iter().map(|(to, bytes)| (*to, &bytes[..])).collect();
                let mut receive: Vec<(usize, &mut [u8])> = { got.iter_mut() }
                    .map(|(from, into)| (*from, &mut into[..]))
                    .collect();
                let done = comm.exchange(&send, &mut receive, || round).unwrap();
                assert_eq!(done, round);
                let mut which = vec![0; ranks];
                for (from, bytes) in &got {
                    assert_eq!(*bytes, message(*from, own, round * 2 + which[*from]));
                    which[*from] += 1;
                }
            }
        });
    }
}

#[test]
fn all_know_what_each_had_in_the_order_of_ranks() {
    for ranks in RANKS {
        let wanted: Vec<Vec<u8>> = (0..ranks).map(|rank| message(rank, 0, 3)).collect();
        for got in on_threads(ranks, |comm| comm.all(&message(comm.rank(), 0, 3)).unwrap()) {
            assert_eq!(got, wanted, "{ranks}");
        }
    }
}

#[test]
fn the_first_has_what_each_sent_and_each_what_the_first_has_for_it() {
    // nothing is a message, too
    let of = |rank: usize, round: usize| match (rank + round) % 3 {
        0 => vec![],
        _ => message(rank, 0, round),
    };
    for ranks in RANKS {
        let wanted: Vec<Vec<u8>> = (0..ranks).map(|rank| of(rank, 1)).collect();
        for (rank, (all, own)) in on_threads(ranks, |comm| {
            let all = comm.first(of(comm.rank(), 1)).unwrap();
            let for_each = (0..ranks)
                .filter(|_| comm.rank() == 0)
                .map(|rank| of(rank, 2));
            let own = comm.of_first(for_each.collect()).unwrap();
            (all, own)
        })
        .into_iter()
        .enumerate()
        {
            assert_eq!(all, (rank == 0).then(|| wanted.clone()), "{ranks}");
            assert_eq!(own, of(rank, 2), "{ranks}");
        }
    }
}

#[test]
fn each_has_what_every_other_one_had_for_it() {
    let of = |from: usize, to: usize| match (from + 2 * to) % 3 {
        0 => vec![],
        _ => message(from, to, 1),
    };
    for ranks in RANKS {
        let had = on_threads(ranks, |comm| {
            let own = (0..ranks).map(|to| of(comm.rank(), to));
            comm.to_each(own.collect()).unwrap()
        });
        for (to, all) in had.into_iter().enumerate() {
            let wanted: Vec<Vec<u8>> = (0..ranks).map(|from| of(from, to)).collect();
            assert_eq!(all, wanted, "{ranks}");
        }
    }
}

#[test]
fn nobody_waits_for_a_rank_that_has_ended() {
    let ends = on_threads(3, |comm| match comm.rank() {
        1 => Ok(()),
        _ => comm.barrier(),
    });
    assert_eq!(ends[1], Ok(()));
    // one of them waits for rank 1, and the other for it or for the one that gave up
    for rank in [0, 2] {
        assert!(
            matches!(ends[rank], Err(Failure::Ended { .. })),
            "{:?}",
            ends[rank]
        );
    }
    assert!(ends.contains(&Err(Failure::Ended { rank: 1 })));
}

#[test]
fn messages_of_another_length_and_ranks_that_are_not_there_are_told() {
    for ends in on_threads(2, |comm| {
        let other = 1 - comm.rank();
        let mut short = [0; 2];
        comm.exchange(&[(other, &[1, 2, 3])], &mut [(other, &mut short)], || ())
    }) {
        let (sent, expected) = (3, 2);
        assert!(
            matches!(ends, Err(Failure::Length { sent: s, expected: e, .. }) if (s, e) == (sent, expected))
        );
    }
    let alone = Comm::alone();
    let none = alone.exchange(&[(1, &[])], &mut [], || ()).unwrap_err();
    assert_eq!(none.to_string(), "there is no rank 1: there are 1, from 0");
    let mut into = [0; 1];
    let nothing = alone
        .exchange(&[], &mut [(0, &mut into)], || ())
        .unwrap_err();
    assert_eq!(
        nothing.to_string(),
        "rank 0 sent 0 bytes where 1 are expected"
    );
}
