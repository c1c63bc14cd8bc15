//! Influence functions that are expressions, from decks to forces.

use peridyne::run::{Options, Simulation, build};
use peridyne::spec::{AnyLinearBody, LinearBody};
use peridyne_io::deck::Deck;
use peridyne_theory::coarsen::{
    Options as CoarsenOptions, Radius, Scheme, Selection, Volume, coarsen,
};
use std::path::Path;

fn made(text: &str, with: &[(String, String)]) -> Box<dyn Simulation> {
    let deck = Deck::parse(text, "deck.toml", with).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(&deck.spec, options).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn good(name: &str) -> Box<dyn Simulation> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name);
    made(&std::fs::read_to_string(path).unwrap(), &[])
}

/// A periodic square lattice of `N × N` points, its bonds, and displacements without order.
struct Lattice {
    bonds: Vec<Vec<(usize, [f64; 2])>>,
    u: Vec<[f64; 3]>,
}

const N: i64 = 9;
const H: f64 = 0.1;
const VOLUME: f64 = H * H;
const M: i64 = 3;

impl Lattice {
    fn new() -> Lattice {
        let id = |x: i64, y: i64| (y.rem_euclid(N) * N + x.rem_euclid(N)) as usize;
        let near = (-M..=M).flat_map(|j| (-M..=M).map(move |i| (i, j)));
        let near: Vec<_> = near
            .filter(|(i, j)| (1..=M * M).contains(&(i * i + j * j)))
            .collect();
        let all = (0..N * N).map(|k| {
            let of =
                |&(i, j): &(i64, i64)| (id(k % N + i, k / N + j), [H * i as f64, H * j as f64]);
            near.iter().map(of).collect()
        });
        let u = (0..N * N).map(|k| {
            let part = |step: f64| 0.02 * H * (((k + 1) as f64 * step).fract() - 0.5);
            [
                part(0.618_033_988_749_895),
                part(0.414_213_562_373_095),
                0.0,
            ]
        });
        Lattice {
            bonds: all.collect(),
            u: u.collect(),
        }
    }

    fn lengths(&self, i: usize, j: usize, xi: [f64; 2]) -> ([f64; 2], f64, f64) {
        let y: [f64; 2] = std::array::from_fn(|a| xi[a] + self.u[j][a] - self.u[i][a]);
        (y, xi[0].hypot(xi[1]), y[0].hypot(y[1]))
    }

    fn sum(&self, i: usize, f: impl Fn([f64; 2], f64, f64) -> f64) -> f64 {
        let each = self.bonds[i].iter().map(|(j, xi)| {
            let (_, r0, r) = self.lengths(i, *j, *xi);
            f(*xi, r0, r)
        });
        VOLUME * each.sum::<f64>()
    }

    /// `Σ_j f(i, j, ξ, |ξ|, |ξ+η|) V (ξ+η)/|ξ+η|`
    fn forces(&self, f: impl Fn(usize, usize, [f64; 2], f64, f64) -> f64) -> Vec<[f64; 3]> {
        let at = |i: usize| {
            let mut all = [0.0; 3];
            for (j, xi) in &self.bonds[i] {
                let (y, r0, r) = self.lengths(i, *j, *xi);
                let t = f(i, *j, *xi, r0, r) * VOLUME / r;
                all[0] += t * y[0];
                all[1] += t * y[1];
            }
            all
        };
        (0..self.u.len()).map(at).collect()
    }
}

fn deck(law: &str, influence: &str, family: &str) -> String {
    format!(
        "units = \"none\"\nhorizon = {{ m_ratio = {M} }}\ninfluence = \"{influence}\"\npartial_volume_correction = false\n\
         periodic = [\"x\", \"y\"]\nfamily = \"{family}\"\n\
         [body]\nlattice = \"square\"\nspacing = {H}\norigin = [0, 0]\n\
         cells = [{N}, {N}]\n\
         [material]\ndensity = 1\nlaw = {law}\n[run]\nsteps = 1\ntime_step = 1e-3\n"
    )
}

fn largest(a: &[[f64; 3]]) -> f64 {
    a.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let each = a.as_flattened().iter().zip(b.as_flattened());
    each.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / largest(b)
}

/// seleson2014 (4.10) for every p, written out, against the deck's `eam_like` with `influence = "r^-p"`, on a lattice and in a list.
#[test]
fn embedded_atoms_upscale_with_any_power() {
    let lattice = Lattice::new();
    let (k, c) = (3.0, 1.2);
    for p in [0, 1, 2, 3] {
        let reference = {
            let each = lattice.bonds[0].iter();
            VOLUME
                * each
                    .map(|(_, xi)| xi[0].hypot(xi[1]).powi(2 - p))
                    .sum::<f64>()
        };
        let excess: Vec<f64> = (0..lattice.u.len())
            .map(|i| lattice.sum(i, |_, r0, r| r / r0.powi(p - 1)) / reference - 1.0)
            .collect();
        let exact = lattice.forces(|i, j, _, r0, r| {
            c / reference * (excess[i] + excess[j]) / r0.powi(p - 1)
                + k / reference * (r - r0) / r0.powi(p)
        });
        let law = format!("{{ eam_like = {{ pair = {k}, volume = {} }} }}", c / 3.0);
        for family in ["stencil", "list"] {
            let found = made(&deck(&law, &format!("r^-{p}"), family), &[]).forces_under(&lattice.u);
            let off = apart(&found, &exact);
            assert!(off < 1e-12, "p = {p}, {family}: {off:e}");
        }
    }
}

/// An influence function that is not the same from both ends: `T_i⟨ξ⟩ − T_j⟨−ξ⟩` with ω(ξ) at i and ω(−ξ) at j, written out for lps in
/// plane stress; bonds of pmb have the mean of both. Nothing is gained or lost in all.
#[test]
fn ends_weigh_a_bond_by_their_own_direction() {
    let lattice = Lattice::new();
    let delta = M as f64 * H;
    let text = "exp(-(r/delta)^2)*(1 + 0.8*xi_x/r - 0.1*xi_y/r)";
    let omega = |xi: [f64; 2], r: f64| {
        (-(r / delta).powi(2)).exp() * (1.0 + 0.8 * xi[0] / r - 0.1 * xi[1] / r)
    };
    let (young, poisson) = (2.0, 0.2);
    let shear = young / (2.0 * (1.0 + poisson));
    let lame = young * poisson / (1.0 - poisson * poisson);
    let (kappa, beta) = (lame - shear, 8.0 * shear);
    let m = lattice.sum(0, |xi, r0, _| omega(xi, r0) * r0 * r0);
    let theta: Vec<f64> = (0..lattice.u.len())
        .map(|i| 2.0 / m * lattice.sum(i, |xi, r0, r| omega(xi, r0) * r0 * (r - r0)))
        .collect();
    let state = |theta: f64, omega: f64, r0: f64, r: f64| {
        omega * (2.0 * kappa * theta / m * r0 + beta / m * (r - r0))
    };
    let solid = lattice.forces(|i, j, xi, r0, r| {
        let back = [-xi[0], -xi[1]];
        state(theta[i], omega(xi, r0), r0, r) + state(theta[j], omega(back, r0), r0, r)
    });
    // of plane stress c = 12 E/(8 … ): G = c M1/(2 D (D + 2)), E = 8 G/3
    let first = lattice.sum(0, |xi, r0, _| omega(xi, r0) * r0);
    let c = 16.0 * 0.375 * young / first;
    let pairs = lattice.forces(|_, _, xi, r0, r| {
        c * 0.5 * (omega(xi, r0) + omega([-xi[0], -xi[1]], r0)) * (r - r0) / r0
    });
    let lps = format!("{{ lps = {{ young = {young}, poisson = {poisson} }} }}");
    let pmb = format!("{{ pmb = {{ young = {young} }} }}");
    let alike = "exp(-(r/delta)^2)";
    for (law, exact) in [(lps, solid), (pmb, pairs)] {
        let mean = made(&deck(&law, alike, "stencil"), &[]).forces_under(&lattice.u);
        for family in ["stencil", "list"] {
            let found = made(&deck(&law, text, family), &[]).forces_under(&lattice.u);
            let off = apart(&found, &exact);
            assert!(off < 1e-12, "{law} {family}: {off:e}");
            let [x, y] = [0, 1].map(|a| found.iter().map(|f| f[a]).sum::<f64>());
            assert!(
                x.hypot(y) < 1e-13 * largest(&found),
                "{law} {family}: {x:e} {y:e}"
            );
            // what would hide a direction that is forgotten
            if law.contains("lps") {
                let off = apart(&found, &mean);
                assert!(off > 1e-6, "{law} {family}: {off:e}");
            } else {
                assert!(apart(&found, &mean) < 1e-12, "{law} {family}");
            }
        }
    }
}

fn bar(name: &str) -> LinearBody<1> {
    let AnyLinearBody::One(body) = good(name).linear_body() else {
        panic!("a bar has one dimension")
    };
    body
}

const V: f64 = 0.005;

/// Silling 2010, example 1: C0 of the deck is the tent, and C1 and C2 of it, with balls of 40 v and 80 v, are those of figures 3 and 4
/// of the reproduction: 1.8638 at 4 v, 2.0289 at 8 v, and a modulus of 0.99164 (a fraction, see there).
#[test]
fn a_tent_is_coarsened_as_in_the_paper() {
    let fine = bar("tent_bar.toml");
    assert_eq!(fine.points(), 200);
    for i in 0..200 {
        for j in 0..200 {
            let n = (j as f64 - i as f64).abs();
            let exact = if i == j {
                0.0
            } else {
                (1.0 - n / 10.0).max(0.0)
            };
            let found = fine.micromodulus(i, j).map_or(0.0, |c| c[0][0]) / V;
            if i != j {
                assert!((found - exact).abs() < 1e-13, "{i} {j}: {found} {exact}");
            }
        }
    }
    let modulus = |body: &LinearBody<1>, stands: f64| {
        let i = body.points() / 2;
        let (partners, blocks) = body.row(i);
        let each = partners.iter().zip(blocks);
        let of = each.map(|(j, c)| c[0][0] * body.xi(i, *j as usize)[0].powi(2));
        0.5 * of.sum::<f64>() / stands
    };
    let next = |body: &LinearBody<1>, every: u32, radius: f64| {
        let keep = Selection::every(every).choose(body).unwrap();
        let options = CoarsenOptions {
            scheme: Scheme::Rows,
            radius: Radius::Fixed(radius * V),
            volume: Volume::Kept,
            symmetrise: false,
            ..CoarsenOptions::default()
        };
        coarsen(body, &keep, &options).unwrap().0
    };
    let one = next(&fine, 4, 40.0);
    let two = next(&one, 2, 80.0);
    let peak = |body: &LinearBody<1>| {
        let i = body.points() / 2;
        body.micromodulus(i, i + 1).unwrap()[0][0] / V
    };
    assert!((peak(&one) - 1.8638).abs() < 5e-5, "{}", peak(&one));
    assert!((peak(&two) - 2.0289).abs() < 5e-5, "{}", peak(&two));
    let ratio = modulus(&one, 4.0) / modulus(&fine, 1.0);
    assert!((ratio - 0.991_644_137_922_069).abs() < 1e-12, "{ratio}");
}

/// Example 2: 10 between points of hard stripes, 1 of all other bonds.
#[test]
fn stripes_are_as_stiff_as_their_softer_end() {
    let body = bar("striped_bar.toml");
    let hard = |i: usize| (i / 10).is_multiple_of(2);
    let mut bonds = 0;
    for i in 0..body.points() {
        for j in (0..body.points()).filter(|j| *j != i) {
            let exact = match (i.abs_diff(j) < 10, hard(i) && hard(j)) {
                (true, true) => 10.0,
                (true, false) => 1.0,
                (false, _) => 0.0,
            };
            let found = body.micromodulus(i, j).map_or(0.0, |c| c[0][0]) / V;
            assert!((found - exact).abs() < 1e-11, "{i} {j}: {found}");
            bonds += usize::from(exact > 1.0);
        }
    }
    // 90 within each stripe, 50 to the next hard one but none nearer than eleven: those of one stripe alone
    assert_eq!(bonds, 10 * 90);
}
