//! Fig. 4: a short bar with half-weight ends.

use peridyne_theory::exact::{Q, q};
use peridyne_theory::homogenize::bar::Ends;

use super::pulled::{Pulled, caption};
use crate::{Context, Failure, Findings};

experiment!(
    Figure4,
    "figure-4",
    "Displacement of a bar with half-weight ends",
    ["../pulled.rs"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let pulled = Pulled::new(context, Ends::Half, &mut found)?;
    let [plain, homogenized] = pulled.bars.map(|b| b.f());
    found.text("homogenized", homogenized.to_string());
    found.number("uniform", pulled.off(1.0 / 17.0));
    found.text("end", plain.to_string());
    let s = pulled.bars[0].stiffness::<Q>();
    let (there, back) = (s.bond(0, 3), s.bond(3, 0));
    found.holds(
        "reaction",
        format!(
            "point 1 has volume ½ and feels {there} cA of point 4, which has volume 1 and feels {back} cA of point 1"
        ),
        &there * q(1, 2) != back,
    );
    caption(&mut found, Ends::Half, [3.0, 5.0])?;
    Ok(found)
}
