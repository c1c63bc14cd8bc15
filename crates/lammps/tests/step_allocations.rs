//! A step of a script allocates nothing, whatever its fixes compute.

use peridyne_lammps::host::Console;
use peridyne_lammps::model::ModelHost;
use peridyne_lammps::{Options, run_text};
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

/// Counts at the end of each step.
struct Steps(Vec<u64>);

impl Console for Steps {
    fn print(&mut self, _: &str) {}
    fn note(&mut self, _: &str) {}
    fn progress(&mut self, _: u64, _: u64) {
        self.0.push(COUNT.load(Ordering::Relaxed));
    }
}

const SCRIPT: &str = "units si
boundary s s s
atom_style peri
atom_modify map array
lattice sc 0.0005
region box block -1 11 -1 5 -1 11
region plate block 0 10 0 3 0 10
create_box 1 box
create_atoms 1 region plate
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0015001 0.002 0.25
set group all density 2200
set group all volume 1.25e-10
region left block INF 1 INF INF INF INF
group left region left
group free subtract all left
fix move all nve
variable y0 equal 0.0040
variable speed index -100
variable wave internal 0.5
variable y equal \"v_y0 + step*dt*v_speed + 1e-6*sin(v_wave*step) + 0*swiggle(v_y0,1e-6,1e-3)\"
variable r equal ramp(0.0024,v_r1)
variable r1 string 0.0026
fix ball all indent 1e17 sphere 0.0025 v_y 0.0025 v_r units box
variable push equal 1e9*vdisplace(0,1)+f_ball[2]*0
fix load free addforce v_push 0 0
fix hold left setforce 0 NULL 0
timestep 1e-7
thermo 1000
run 200
";

#[test]
fn steps_with_moving_fixes_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let counts = pool.install(|| {
        let mut steps = Steps(Vec::with_capacity(200));
        let options = Options::default();
        let ran = run_text(
            "in",
            SCRIPT,
            &options,
            &mut ModelHost::default(),
            &mut steps,
        );
        if let Err(e) = ran {
            panic!("{e} {:?}", e.help);
        }
        steps.0
    });
    assert_eq!(counts.len(), 200);
    let each: Vec<u64> = counts.windows(2).map(|w| w[1] - w[0]).collect();
    // the last step prints; contact and rigid_body look around now and then, into lists that grow for a while
    let loud = each[1..each.len() - 1].iter().filter(|n| **n > 0).count();
    assert!(loud <= 15, "{each:?}");
}
