//! What bodies are made of, and how they meet.

use crate::case::{
    Answer, Case, Deck, Keeps, SHARE, Stop, apart, go, hold, largest, momentum, stirred,
};

/// Forces of a deck under displacements without order.
fn forces(case: &Case, deck: &Deck) -> Result<Vec<[f64; 3]>, Stop> {
    let place = &case.law.place;
    let mut sim = deck.model()?;
    let u = stirred(&mut *sim, place.dimension, 1e-3 * place.near);
    Ok(sim.forces_under(&u))
}

fn moves(case: &Case, deck: &Deck) -> Answer {
    let mut deck = deck.clone();
    deck.tables += &case.pull(0.05);
    let mut sim = deck.model()?;
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, 0.0])
}

/// Twice as stiff bonds have twice the force.
pub fn bond_factor(case: &Case) -> Answer {
    let mut deck = case.deck();
    deck.tables += "[[bond_stiffness]]\nfactor = 2\n";
    let doubled = forces(case, &deck)?;
    let off = apart(&forces(case, &case.deck())?, 2.0, &doubled);
    hold(off < 1e-12, || {
        format!("forces are off by {off:e} of their double")
    })?;
    moves(case, &deck)
}

/// A uniform strain has forces at the outermost points alone; without the factors others have some, too.
pub fn exact_surface(case: &Case) -> Answer {
    let mut deck = case.deck();
    let inside = |deck: &Deck| -> Result<f64, Stop> {
        let mut sim = deck.model()?;
        let x = sim.vectors("reference");
        let u: Vec<[f64; 3]> = x.iter().map(|x| [1e-8 * x[0], 0.0, 0.0]).collect();
        let f = sim.forces_under(&u);
        let d = case.law.place.dimension;
        let end = |a: usize, sign: f64| x.iter().fold(f64::MIN, |m, x| m.max(sign * x[a]));
        let near = 0.1 * case.law.place.near;
        let outer =
            |x: &[f64; 3]| (0..d).any(|a| [-1.0, 1.0].iter().any(|s| end(a, *s) - s * x[a] < near));
        let within: Vec<[f64; 3]> = { f.iter().zip(&x) }
            .filter(|(_, x)| !outer(x))
            .map(|(f, _)| *f)
            .collect();
        Ok(largest(&within) / largest(&f))
    };
    let plain = inside(&deck)?;
    deck.top += "surface = \"exact\"\n";
    let exact = inside(&deck)?;
    hold(exact < 1e-6 && plain > 1e-3, || {
        format!("forces inside are {exact:e} of the largest, {plain:e} without")
    })?;
    moves(case, &deck)
}

/// Two materials of the same law pull at each other as one does; that of the right half is twice as dense.
pub fn two_materials(case: &Case) -> Answer {
    let place = &case.law.place;
    let mut deck = case.deck();
    let middle = 0.5 * place.length + 0.1 * place.near;
    let heavy = place.density.replace("= ", "= \"2*") + "\"";
    deck.material.clear();
    let fracture = deck.fracture();
    let law = case.law();
    deck.tables += &format!(
        "[sets.a]\nwhere = \"x < {middle}\"\n[sets.b]\nwhere = \"x > {middle}\"\n\
         [material]\na = {{ {}, {law}{fracture} }}\nb = {{ {heavy}, {law}{fracture} }}\n",
        place.density
    );
    if case.family == "reference" {
        deck.tables += &format!("[[pair]]\nbetween = [\"a\", \"b\"]\n{law}\n");
    }
    let both = forces(case, &deck)?;
    let off = apart(&forces(case, &case.deck())?, 1.0, &both);
    hold(off < 1e-11, || {
        format!("forces are {off:e} away from those of one material")
    })?;
    moves(case, &deck)
}

/// The body, and the same again behind a gap along x.
fn twice(case: &Case, gap: f64, velocity: f64) -> Deck {
    let place = &case.law.place;
    let mut deck = case.deck();
    let body = std::mem::take(&mut deck.body);
    let at = place.length + gap * place.near;
    let origin = ["", ", 0", ", 0, 0"][place.dimension - 1];
    let piece =
        |name: &str, x: f64| format!("{{ name = \"{name}\", {body}, origin = [{x}{origin}] }}");
    deck.top += &format!("body = [{}, {}]\n", piece("a", 0.0), piece("b", at));
    let speed = velocity * place.near / place.time;
    deck.tables += &format!("[[initial]]\nset = \"b\"\nvelocity = {{ x = {speed:e} }}\n");
    deck
}

/// What the second body does to the first: the sign of its momentum.
fn meets(case: &Case, deck: &Deck, sign: f64, time: f64) -> Answer {
    let mut sim = deck.model()?;
    go(&mut *sim, time, Keeps::Momentum, [SHARE, 0.0])?;
    let first = sim.members("a").unwrap_or_default();
    let (p, size) = momentum(&mut *sim, Some(&first));
    hold(sign * p[0] > 1e-3 * size && size > 0.0, || {
        format!(
            "the first of {} points has momentum {:e} of {size:e}",
            case.law.name, p[0]
        )
    })
}

/// The second comes at a tenth of the speed of waves.
pub fn contact(case: &Case) -> Answer {
    let mut deck = twice(case, 1.5, -0.1);
    deck.top += "contact = true\n";
    meets(case, &deck, -1.0, 2.0 * case.time())
}

/// The second goes away, bonded to the first.
pub fn interface(case: &Case) -> Answer {
    let mut deck = twice(case, 1.0, 0.001);
    deck.tables += &format!(
        "[[interface]]\nbodies = [\"a\", \"b\"]\nlaw = {{ pmb = {{ young = {} }} }}\n",
        case.law.place.young
    );
    meets(case, &deck, 1.0, case.time())
}

/// Horizons of points from two thirds of that of the body on are another body, which keeps what it must.
pub fn variable_horizon(case: &Case) -> Answer {
    let mut deck = case.deck();
    deck.top += "calibration = \"continuum\"\n";
    let plain = deck.clone();
    let place = &case.law.place;
    deck.top += &format!(
        "variable_horizon = \"{0}*(1.4 + 0.6*x/{1})\"\n",
        place.near, place.length
    );
    let own = forces(case, &deck)?;
    let off = apart(&forces(case, &plain)?, 1.0, &own);
    hold(off > 1e-3, || format!("forces differ by {off:e} alone"))?;
    moves(case, &deck)
}

/// An influence function that is not the same from both ends.
pub fn directed(case: &Case) -> Answer {
    let mut deck = case.deck();
    deck.top += "influence = \"exp(-(r/delta)^2)*(1 + 0.5*xi_x/r)\"\n";
    let own = forces(case, &deck)?;
    let off = apart(&forces(case, &case.deck())?, 1.0, &own);
    hold(off > 1e-3, || format!("forces differ by {off:e} alone"))?;
    moves(case, &deck)
}

/// Every point of a periodic lattice has the same family; a standing wave keeps what it must.
pub fn periodic(case: &Case) -> Answer {
    let place = &case.law.place;
    let mut deck = case.deck();
    let axes = ["", "[\"x\", \"y\"]", "[\"x\", \"y\", \"z\"]"][place.dimension - 1];
    deck.top += &format!("periodic = {axes}\n");
    let wave = 2.0 * std::f64::consts::PI / period(place.body, place.length);
    let speed = 0.05 * case.rate() / wave;
    deck.tables += &format!("[[initial]]\nvelocity = {{ x = \"{speed:e}*sin({wave}*x)\" }}\n");
    let mut sim = deck.model()?;
    let (least, _, most) = sim.info().family;
    hold(least == most && least > 0, || {
        format!("families have {least} to {most} points")
    })?;
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, 0.0])
}

/// Cells along x, as the body says, times the spacing.
fn period(body: &str, otherwise: f64) -> f64 {
    let number = |after: &str| -> Option<f64> {
        let rest = body.split(after).nth(1)?;
        let end = rest.find([',', ']']).unwrap_or(rest.len());
        rest[..end].trim().parse().ok()
    };
    match (number("spacing = "), number("cells = [")) {
        (Some(spacing), Some(cells)) => spacing * cells,
        _ => otherwise,
    }
}
