//! Fig. 3: the initial radial displacement.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::measure::largest;
use crate::profile::{pulse, rise};
use crate::seleson2014::plate::{Plate, Step};
use crate::{Context, Failure, Findings};

experiment!(
    Figure3,
    "figure-3",
    "Initial radial displacement of the plate",
    ["../plate.rs", "../figure-4/plate.toml"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let plate = Plate::new(context, 2, Step::Hundred);
    let mut sim = plate.model(false)?;
    sim.start(false);
    let (x, u): (Vec<f64>, Vec<f64>) = (sim.vectors("reference").iter())
        .zip(sim.displacements())
        .filter(|(x, _)| x[1].abs() < 0.5 * plate.spacing() && x[0] >= 0.0)
        .map(|(x, u)| (x[0], u[0]))
        .unzip();
    let path = context.out.join("profile.csv");
    Table::new()
        .column("r", "m", x.clone())
        .column("radial displacement", "m", u.clone())
        .save(&path)?;
    let mut found = Findings::new();
    found.file(path);
    let r: Vec<f64> = (0..=500).map(|k| 0.001 * f64::from(k)).collect();
    let p: Vec<f64> = r.iter().map(|r| pulse(*r, 0.0, 0.2, 1e-4)).collect();
    let plot = Plot::new("Initial radial displacement")
        .x("r", "m")
        .y("u_r", "m")
        .line("p(r)", &r, &p)
        .points("points of h = 2a on the x axis", &x, &u);
    found.picture(plot.save(&context.out, "profile")?);
    found.number("middle", pulse(0.0, 0.0, 0.2, 1e-4));
    // rise is s¹¹ times what is not 0 there
    found.number("order", (rise(2e-4) / rise(1e-4)).log2());
    let points = x.iter().zip(&u).filter(|(x, _)| **x > 0.0);
    let worst = largest(points.map(|(x, u)| (u - pulse(*x, 0.0, 0.2, 1e-4)).abs()));
    found.number("points", worst);
    Ok(found)
}
