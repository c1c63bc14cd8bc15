//! Bonds that end, and begin again.

use crate::case::{Answer, Case, Deck, Keeps, SHARE, Stop, go, hold, wrong};

/// Directed bonds that break under a part of the load.
fn broken(case: &Case, deck: &Deck, part: f64) -> Result<u64, Stop> {
    let mut deck = deck.clone();
    deck.tables += &case.pull(part);
    let mut sim = deck.model()?;
    let jump = case.jump(&*sim);
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, jump])?;
    Ok(sim.broken())
}

fn of(case: &Case, fracture: String) -> Deck {
    Deck {
        fracture: Some(fracture),
        ..case.deck()
    }
}

fn by_stretch(case: &Case) -> Deck {
    of(case, format!("critical_stretch = {}", case.limit()))
}

/// A load past the limit breaks bonds, a fortieth of it none.
fn breaks(case: &Case, fracture: String) -> Answer {
    let deck = of(case, fracture);
    let (past, below) = (broken(case, &deck, 1.0)?, broken(case, &deck, 0.025)?);
    hold(past > 0 && below == 0, || {
        format!("{past} bonds broke past the limit, {below} far below it")
    })
}

pub fn stretch(case: &Case) -> Answer {
    breaks(case, format!("critical_stretch = {}", case.limit()))
}

/// `G = E s² δ` of the limit within a factor of two, or what the law has in its place.
fn toughness(case: &Case) -> f64 {
    let place = &case.law.place;
    case.law.toughness * place.young * case.limit() * case.limit() * place.near
}

pub fn energy(case: &Case) -> Answer {
    breaks(case, format!("energy = {:e}", toughness(case)))
}

pub fn bond_energy(case: &Case) -> Answer {
    let energy = toughness(case);
    breaks(
        case,
        format!("energy = {energy:e}, criterion = \"bond_energy\""),
    )
}

/// Below the yield stress of those that flow.
pub fn von_mises(case: &Case) -> Answer {
    let stress = 0.13 * case.law.place.young * case.law.strain;
    breaks(case, format!("von_mises = {stress:e}"))
}

pub fn plastic_strain(case: &Case) -> Answer {
    breaks(case, "plastic_strain = 0.005".into())
}

/// Fewer bonds break where a limit is raised.
fn fewer(case: &Case, tables: &str, weak: &Deck, strong: &Deck) -> Answer {
    let with = |deck: &Deck| Deck {
        tables: format!("{}{tables}", deck.tables),
        ..deck.clone()
    };
    // what refuses is the strong one
    let strong = broken(case, &with(strong), 1.0)?;
    let weak = broken(case, &with(weak), 1.0)?;
    hold(strong < weak, || {
        format!("{strong} bonds broke where they bear more, {weak} where not")
    })
}

/// 1 + ½ ln 20 times the stretch at the rate of the load.
pub fn rate(case: &Case) -> Answer {
    let (stretch, slow) = (case.limit(), 0.05 * case.rate());
    let strong = format!(
        "critical_stretch = {stretch}, rate = {{ coefficient = 0.5, reference = {slow:e} }}"
    );
    fewer(case, "", &by_stretch(case), &of(case, strong))
}

/// Compressed across, bonds bear half of that more: `s_00 − α s_min`. A pull along an axis of diamond stretches all four bonds of a point alike, so they
/// bear less there. `alpha` is of the matrix bonds of a lamina: its fibres lie across.
pub fn alpha(case: &Case) -> Answer {
    let strong = format!("critical_stretch = {}, alpha = 0.5", case.limit());
    let turned = |deck: Deck| Deck {
        material: deck
            .material
            .replace("fibre = [1, 0, 0]", "fibre = [0, 1, 0]"),
        ..deck
    };
    let (plain, strong) = (turned(by_stretch(case)), turned(of(case, strong)));
    if case.law.place.body.contains("diamond") {
        return fewer(case, "", &strong, &plain);
    }
    let push = format!(
        "[[initial]]\nvelocity = {{ y = \"{:e}*({} - y)\" }}\n",
        case.rate(),
        0.5 * case.law.place.width
    );
    fewer(case, &push, &plain, &strong)
}

pub fn toughness_of_places(case: &Case) -> Answer {
    let weak = by_stretch(case);
    let middle = 0.5 * case.law.place.length;
    let mut strong = weak.clone();
    strong.tables +=
        &format!("[[toughness]]\ncritical_stretch_factor = \"x < {middle} ? 2 : 1.5\"\n");
    fewer(case, "", &weak, &strong)
}

/// A cut through half of the body, whose bonds were there and are broken.
pub fn cut(case: &Case, part: f64) -> String {
    let place = &case.law.place;
    let x = 0.5 * place.length + 0.13 * place.near;
    let (low, high) = (-place.near, part * place.width + 0.3 * place.near);
    match place.dimension {
        2 => format!(
            "[[precrack]]\nkind = \"broken\"\nsegment = {{ from = [{x}, {low}], to = [{x}, {high}] }}\n"
        ),
        _ => format!(
            "[[precrack]]\nkind = \"broken\"\nsegment = {{ from = [{x}, {low}, 0], to = [{x}, {high}, 0] }}\n"
        ),
    }
}

/// It cuts bonds, and the body keeps what it must.
pub fn precrack(case: &Case) -> Answer {
    let mut deck = case.deck();
    deck.tables += &(cut(case, 0.5) + &case.pull(0.05));
    let mut sim = deck.model()?;
    hold(sim.info().cut > 0, || "no bond was cut".into())?;
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, 0.0])?;
    let damage: f64 = sim.scalars("damage").iter().sum();
    hold(damage > 0.0, || "cut bonds are no damage".into())
}

/// A cut through a body at rest is whole again.
pub fn healing(case: &Case) -> Answer {
    let mut deck = of(case, "critical_stretch = 0.5".into());
    deck.tables += &(cut(case, 1.5) + "[healing]\nbelow = 0.1\n");
    let mut sim = deck.model()?;
    let cut = sim.info().cut;
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, 0.0])?;
    let damage: f64 = sim.scalars("damage").iter().sum();
    hold(cut > 0 && damage == 0.0, || {
        format!("{cut} bonds were cut, and damage of {damage} is left")
    })
}

/// Two bonds are worn out in each of two increments.
pub fn fatigue(case: &Case) -> Answer {
    let mut deck = of(
        case,
        "critical_stretch = 0.5, fatigue = { nucleation = [1e3, 3] }".into(),
    );
    let pull = format!("{:e}", 0.002 * case.law.place.length);
    deck.tables += &case.grips("", &pull);
    deck.run = "[statics]\nmethod = \"newton\"\nincrements = 2\ncycles = { bonds = 2 }\n".into();
    let mut sim = deck.model()?;
    sim.start(true);
    for _ in 0..2 {
        sim.step().map_err(wrong)?;
    }
    crate::case::finite(&mut *sim)?;
    let (cycles, broken) = (sim.cycles(), sim.broken());
    hold(
        cycles.is_some_and(|n| n > 0.0 && n.is_finite()) && broken >= 4,
        || format!("{broken} bonds are worn out after {cycles:?} cycles"),
    )
}
