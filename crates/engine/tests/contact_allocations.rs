//! Contact allocates nothing in a steady state, rebuilding its list or not.

use peridyne::body::{Body, Field, zeros};
use peridyne::interaction::Repulsion;
use peridyne::interaction::contact::Contact;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

struct Counting;
static COUNT: AtomicU64 = AtomicU64::new(0);

// SAFETY: hands everything on to the system's allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn steps_and_rebuilds_allocate_nothing() {
    let points: Vec<[f64; 3]> = (0..2000)
        .map(|k| [k % 10, k / 10 % 10, k / 100].map(f64::from))
        .map(|x| [x[0], x[1], if x[2] < 10.0 { x[2] } else { x[2] + 4.0 }])
        .collect();
    let body = Body::<3>::from_cloud(&points, &[1.0; 2000], &[], 1.0, [None; 3]).unwrap();
    let rule = Repulsion::uniform(1.0, 0.9, 1.35);
    let in_family = |i: usize, j: usize| {
        let (p, q) = (body.position(i), body.position(j));
        (0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>() <= 4.0
    };
    // the upper block goes up and down
    let mut u = body.at_rest();
    let place = |u: &mut Field<3>, step: usize| {
        for &s in body.slots() {
            if body.position(s as usize)[2] > 11.0 {
                u[2][s as usize] = -4.2 + (step as f64 * 0.1).sin();
            }
        }
    };
    let mut contact = Contact::new(rule, &body, 2.0, &[]);
    let mut f = zeros::<3>(body.len());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let mut cycle = |count: usize| {
            let before = (COUNT.load(Ordering::Relaxed), contact.builds());
            let mut touched = 0;
            for step in 0..count {
                place(&mut u, step);
                // the derivative of the sine is at most 1
                contact.moved(0.1);
                contact.add_forces(&body, &u, &mut f, &in_family);
                touched += contact.pairs_in_contact(&u);
            }
            assert!(touched > 0);
            (
                COUNT.load(Ordering::Relaxed) - before.0,
                contact.builds() - before.1,
            )
        };
        cycle(126);
        let (allocations, builds) = cycle(126);
        assert!(builds > 5, "{builds} builds");
        assert_eq!(allocations, 0);
    });
}
