use super::*;
use crate::crystal::{LatticeSolid, Reach};
use crate::gradient::linear::LinearChain;
use peridyne::law::number::Number;
use peridyne::law::potential::Potential;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::solid::eam_like::Solid;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Horizon;
use std::f64::consts::PI;

fn crystals() -> Vec<Crystal<3>> {
    let mut all = vec![];
    for kind in [
        LatticeKind::Cubic,
        LatticeKind::Bcc,
        LatticeKind::Fcc,
        LatticeKind::Diamond,
    ] {
        let body = LatticeSolid::new(kind, 1.1, Horizon::Ratio(2));
        all.push(body.bond_based(2.0).unwrap());
        all.push(body.state_based(Solid::lps(3, 3.0, 1.0)).unwrap());
    }
    let lj = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    let reach = Reach::Shells(5);
    all.push(
        Crystal::of_potential(&lj, LatticeKind::Fcc, 1.5, 1.0, reach)
            .unwrap()
            .0,
    );
    all
}

#[test]
fn acoustic_sum_rule_symmetry_and_conjugation() {
    let k = [0.3, -1.1, 0.7];
    for crystal in crystals() {
        let squares = crystal.squares([0.0; 3]);
        let top = crystal.squares(k).last().copied().unwrap();
        for w in &squares[..3] {
            assert!(w.abs() < 1e-13 * top, "{w}");
        }
        let (there, back) = (
            crystal.dynamical_matrix(k),
            crystal.dynamical_matrix(k.map(|x| -x)),
        );
        for i in 0..there.size() {
            for j in 0..there.size() {
                assert!((there.get(i, j) - there.get(j, i).conj()).norm() < 1e-12 * top);
                assert!((there.get(i, j) - back.get(i, j).conj()).norm() < 1e-12 * top);
            }
        }
        // a reciprocal vector changes phases of sites, not frequencies
        let b = crystal.reciprocal();
        let shifted: [f64; 3] = std::array::from_fn(|a| k[a] + b[0][a] - 2.0 * b[2][a]);
        for (v, w) in crystal.squares(k).iter().zip(crystal.squares(shifted)) {
            assert!((v - w).abs() < 1e-11 * top);
        }
    }
}

#[test]
fn turning_crystal_and_wave_changes_nothing() {
    let (c, s) = (0.6, 0.8);
    let r = [[c, -s, 0.0], [s * c, c * c, -s], [s * s, c * s, c]];
    let k = [0.3, -1.1, 0.7];
    let turned: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| r[i][j] * k[j]).sum());
    for crystal in crystals() {
        let rotated = crystal.rotated(r);
        let top = crystal.squares(k).last().copied().unwrap();
        for (v, w) in crystal.squares(k).iter().zip(rotated.squares(turned)) {
            assert!((v - w).abs() < 1e-12 * top);
        }
        // and turning only the wave does
        let other = crystal.squares(turned);
        assert!((other[0] - crystal.squares(k)[0]).abs() > 1e-6 * top);
    }
}

#[test]
fn chains_are_the_finite_sums() {
    let body = LatticeSolid::new(LatticeKind::Chain, 0.5, Horizon::Ratio(7));
    let crystal = body.state_based::<1>(Solid::lps(1, 3.0, 1.0)).unwrap();
    let chain = LinearChain::of_crystal(&crystal).unwrap();
    for k in [0.1, 1.0, 4.5] {
        let mode = &crystal.modes([k])[0];
        assert!((mode.squared - chain.squared(k, 1.0)).abs() < 1e-12);
        let v = crystal.group_velocity([k], mode).unwrap()[0];
        assert!((v - chain.group_velocity(k, 1.0).unwrap()).abs() < 1e-12);
    }
}

#[test]
fn group_velocities_are_slopes() {
    let k = [0.4, 0.9, 0.2];
    let h = 1e-5;
    for crystal in crystals() {
        let modes = crystal.modes(k);
        let top = modes.last().unwrap().squared;
        for (n, mode) in modes.iter().enumerate() {
            let slope = crystal.slope(k, mode);
            for a in 0..3 {
                let at = |s: f64| {
                    let mut k = k;
                    k[a] += s * h;
                    crystal.squares(k)[n]
                };
                let difference = (at(1.0) - at(-1.0)) / (2.0 * h);
                assert!((slope[a] - difference).abs() < 1e-7 * top, "{n} {a}");
            }
        }
    }
}

#[test]
fn degenerate_branches_are_told_apart_by_slopes() {
    // along [100] both transverse branches have one slope; at the zone centre of the optical triplet as well
    let crystal = &crystals()[4];
    let k = [0.8, 0.0, 0.0];
    let along = crystal.slopes_along(k, [1.0, 0.0, 0.0]);
    let h = 1e-5;
    let (up, down) = (
        crystal.squares([0.8 + h, 0.0, 0.0]),
        crystal.squares([0.8 - h, 0.0, 0.0]),
    );
    for n in 0..3 {
        assert!((along[n][1] - (up[n] - down[n]) / (2.0 * h)).abs() < 1e-7 * up[2]);
    }
    // across, the degenerate pair splits: slopes ±s come from the block, not from the vectors that Jacobi chose
    let across = crystal.slopes_along(k, [0.0, 1.0, 0.0]);
    assert!((across[0][1] + across[1][1]).abs() < 1e-10);
}

#[test]
fn a_stretched_crystal_is_unstable() {
    let lj = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    let of = |a| {
        Crystal::<3>::of_potential(&lj, LatticeKind::Fcc, a, 1.0, Reach::Shells(3))
            .unwrap()
            .0
    };
    assert_eq!(of(1.55).instability(6), None);
    let found = of(1.95).instability(6).unwrap();
    assert!(found.part > 0.1 && found.squared < 0.0);
    assert!((found.growth * found.growth + found.squared).abs() < 1e-12);
    // simple cubic Lennard-Jones shears away
    let cubic = Crystal::<3>::of_potential(&lj, LatticeKind::Cubic, 1.08, 1.0, Reach::Shells(3));
    assert!(cubic.unwrap().0.instability(6).is_some());
}

#[test]
fn verlet_speeds_waves_up() {
    let dt = 0.1;
    assert_eq!(verlet_frequency(21.0, dt), None);
    assert!((verlet_frequency(20.0, dt).unwrap() - 10.0 * PI).abs() < 1e-12);
    // the recursion x⁺ − 2x + x⁻ = −ω²Δt² x has cos(ω_Δt Δt) = 1 − ω²Δt²/2
    let w = verlet_frequency(7.0, dt).unwrap();
    assert!(((w * dt).cos() - (1.0 - 0.5 * 0.49)).abs() < 1e-15);
}

/// `verify/phonons/phonons.py`: ASE's finite differences, good to 1e-5.
fn as_in(table: &str, crystal: &Crystal<3>, a: f64) {
    let mut rows = 0;
    for line in table.lines().filter(|l| !l.starts_with('#')) {
        let numbers: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let k = std::array::from_fn(|i| 2.0 * PI / a * numbers[i]);
        let squares = crystal.squares(k);
        let top = numbers[5].abs();
        for (found, expected) in squares.iter().zip(&numbers[3..]) {
            assert!((found - expected).abs() < 1e-5 * top, "{line}: {squares:?}");
        }
        rows += 1;
    }
    assert_eq!(rows, 10);
}

#[test]
fn phonons_of_a_pair_potential_are_those_of_ase() {
    let lj = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    let reach = Reach::Horizon(Horizon::Length(2.3));
    let (crystal, _) = Crystal::of_potential(&lj, LatticeKind::Fcc, 1.55, 1.0, reach).unwrap();
    let table = include_str!("../../../../verify/phonons/lj_fcc.csv");
    as_in(table, &crystal, 1.55);
}

#[test]
fn phonons_of_an_embedded_atom_potential_are_those_of_ase() {
    let (crystal, _) =
        Crystal::of_potential(&Metal, LatticeKind::Bcc, 1.1, 1.0, Reach::Cutoff).unwrap();
    let table = include_str!("../../../../verify/phonons/eam_bcc.csv");
    as_in(table, &crystal, 1.1);
}

/// f = e^{−βr}, F = −√ρ, φ = A e^{−αr}.
#[derive(Clone)]
struct Metal;
impl Potential for Metal {
    const EMBEDDED: bool = true;
    fn cutoff(&self) -> f64 {
        1.6
    }
    fn pair<N: Number>(&self, q: N) -> N {
        q.sqrt().times(-4.0).exp().times(3.0)
    }
    fn density<N: Number>(&self, q: N) -> N {
        q.sqrt().times(-1.7).exp()
    }
    fn embedding<N: Number>(&self, density: N) -> N {
        N::constant(0.0) - density.sqrt()
    }
}

/// The energy of a periodic box, atom by atom, is ½ω² in every mode that fits in.
#[test]
fn modes_have_the_energy_of_displaced_atoms() {
    for (kind, a) in [(LatticeKind::Bcc, 1.1), (LatticeKind::Diamond, 1.7)] {
        let mass = 1.3;
        let (crystal, reference) =
            Crystal::<3>::of_potential(&Metal, kind, a, mass, Reach::Cutoff).unwrap();
        let cells = 4;
        let side = a * cells as f64;
        let k = [2.0 * PI / side, -4.0 * PI / side, 2.0 * PI / side];
        let mut sites = vec![];
        for cell in 0..cells * cells * cells {
            let part = [cell % cells, cell / cells % cells, cell / cells / cells];
            for b in kind.basis() {
                let x: [f64; 3] = std::array::from_fn(|i| a * (part[i] as f64 + b[i] as f64 / 4.0));
                sites.push((x, usize::from(b[0] % 2 != 0)));
            }
        }
        let pairs: Vec<Vec<usize>> = sites
            .iter()
            .map(|(x, _)| {
                let near = |y: &[f64; 3]| {
                    let r = distance(*x, *y, side);
                    r > 0.0 && r <= 1.6
                };
                (0..sites.len()).filter(|j| near(&sites[*j].0)).collect()
            })
            .collect();
        let energy = |at: &[[f64; 3]]| -> f64 {
            pairs
                .iter()
                .enumerate()
                .map(|(i, near)| {
                    let (mut pair, mut rho) = (0.0, 0.0);
                    for j in near {
                        let q = distance(at[i], at[*j], side).powi(2);
                        pair += 0.5 * Metal.pair(q);
                        rho += Metal.density(q);
                    }
                    pair + Metal.embedding(rho)
                })
                .sum()
        };
        let n = sites.len() as f64;
        let rest = energy(&sites.iter().map(|s| s.0).collect::<Vec<_>>());
        assert!((rest / n - reference.energy).abs() < 1e-12);
        let modes = crystal.modes(k);
        for mode in &modes {
            let moved = |s: f64| -> f64 {
                let at: Vec<[f64; 3]> = sites
                    .iter()
                    .map(|(x, site)| {
                        let phase: f64 = (0..3).map(|i| k[i] * x[i]).sum();
                        let wave = Complex64::from_polar(s, phase);
                        std::array::from_fn(|i| x[i] + (mode.vector[site * 3 + i] * wave).re)
                    })
                    .collect();
                energy(&at)
            };
            let h = 1e-3;
            let second = (moved(h) - 2.0 * rest + moved(-h)) / (h * h);
            // Σ m |Re u|² of a unit vector: half of the cells, with √m taken out
            let expected = 0.5 * mass * mode.squared * n / crystal.basis.len() as f64;
            let top = 0.5 * mass * modes[modes.len() - 1].squared.abs() * n;
            assert!(
                (second - expected).abs() < 1e-4 * top,
                "{kind:?} {second} {expected}"
            );
        }
    }
}

fn distance(x: [f64; 3], y: [f64; 3], side: f64) -> f64 {
    (0..3)
        .map(|i| {
            let d = x[i] - y[i];
            (d - side * (d / side).round()).powi(2)
        })
        .sum::<f64>()
        .sqrt()
}
