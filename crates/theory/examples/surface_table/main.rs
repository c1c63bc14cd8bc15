//! What corrections of bonds near a surface are worth: displacement errors, frequencies and stable steps.
//!
//! `cargo run --release -p peridyne-theory --example surface_table`
//!
//! Plates of square cells of edge 1, bond-based (ν = ⅓ in the plane) and state-based (ν = 0.25), free, under the tractions of a classical solution.
//! With exact factors the body ends at its outermost points, else it is the cells of its points and ends half a spacing
//! outside; tractions act on the outermost points in either case. A hole has the radius of a circle of its area. Errors
//! are the largest displacement beside the classical one, over its largest, both without rigid motion.

mod classical;
mod plate;

use classical::Load;
use peridyne::spec::{LawSpec, Moduli, PmbStiffness, SurfaceMethod};
use plate::Plate;

const METHODS: [(&str, Option<SurfaceMethod>); 5] = [
    ("none", None),
    ("volume", Some(SurfaceMethod::Volume)),
    ("energy", Some(SurfaceMethod::Energy)),
    ("force", Some(SurfaceMethod::Force)),
    ("exact", Some(SurfaceMethod::Exact)),
];

fn percent(x: f64) -> String {
    if x < 1e-6 {
        format!("{x:.0e}")
    } else {
        format!("{:.2} %", 100.0 * x)
    }
}

const PMB: LawSpec = LawSpec::Pmb(PmbStiffness::Young(1.0));
const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 1.0,
    poisson: 0.25,
});

fn main() {
    for (name, law, m) in [
        ("bond-based", PMB, 2),
        ("bond-based", PMB, 3),
        ("state-based", LPS, 2),
        ("state-based", LPS, 3),
    ] {
        println!("\n## Plate of 31 x 21 points, {name}, horizon {m}\n");
        println!(
            "| method | uniaxial | biaxial | shear | bending | hole, 41² | hole, 81² | lowest frequency | stable step | factors |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|");
        let mut first = None;
        // published corrections are for bond-based laws
        let known = METHODS
            .iter()
            .filter(|(name, _)| law == PMB || ["none", "exact"].contains(name));
        for &(name, method) in known {
            let mut cells = vec![name.to_string()];
            let mut plate = Plate::new([31, 21], m, law.clone(), None, method);
            for load in [Load::Uniaxial, Load::Biaxial, Load::Shear, Load::Bending] {
                cells.push(percent(plate.error(load)));
            }
            for scale in [1, 2] {
                let n = 40 * scale + 1;
                let mut holed =
                    Plate::new([n, n], m, law.clone(), Some(6.2 * f64::from(scale)), method);
                let radius = holed.hole();
                cells.push(percent(holed.error(Load::Hole(radius))));
            }
            cells.push(percent(plate::frequency_error(60, m, law.clone(), method)));
            let step = plate.stable_step();
            let of = *first.get_or_insert(step);
            cells.push(format!("{:.3}", step / of));
            let (low, high) = plate.factors();
            cells.push(format!("{low:.2} to {high:.2}"));
            println!("| {} |", cells.join(" | "));
        }
    }
    println!("\n## Bending, plates of 1.5 : 1, horizon 3 spacings\n");
    println!("| points | none | volume | exact |");
    println!("|---|---|---|---|");
    for n in [13, 25, 49, 97] {
        let size = [n, 2 * (n - 1) / 3 + 1];
        let errors = [0, 1, 4].map(|k| {
            let mut plate = Plate::new(size, 3, PMB, None, METHODS[k].1);
            percent(plate.error(Load::Bending))
        });
        println!("| {} x {} | {} |", size[0], size[1], errors.join(" | "));
    }
}
