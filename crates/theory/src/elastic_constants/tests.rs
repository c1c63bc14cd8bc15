use super::*;
use crate::crystal::{LatticeSolid, Reach, dimer};
use peridyne::law::number::Number;
use peridyne::law::potential::Potential;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::solid::eam_like::Solid;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{Calibration, Horizon, LawSpec, PmbStiffness};

/// f = e^{−βr}, F = −√ρ, φ = A e^{−αr}.
#[derive(Clone)]
struct Metal;
impl Potential for Metal {
    const EMBEDDED: bool = true;
    fn cutoff(&self) -> f64 {
        f64::INFINITY
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

const LJ: LennardJones = LennardJones {
    epsilon: 1.0,
    sigma: 1.0,
};

fn of(p: &impl Potential, kind: LatticeKind, a: f64, shells: u32) -> Crystal<3> {
    Crystal::of_potential(p, kind, a, 1.3, Reach::Shells(shells))
        .unwrap()
        .0
}

/// Sound from the elastic constants is the slope of the dispersion, whatever the stress.
fn sound_is_the_slope(crystal: &Crystal<3>) {
    for n in [
        [1.0, 0.0, 0.0],
        [0.6, 0.8, 0.0],
        [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0],
    ] {
        let sound = crystal.sound(n).unwrap();
        let k = 1e-3;
        let squares = crystal.squares(n.map(|x| x * k));
        for (v, w) in sound.iter().zip(&squares) {
            let scale = sound[2].abs();
            assert!((w / (k * k) - v).abs() < 1e-5 * scale, "{n:?}: {w} {v}");
        }
    }
}

#[test]
fn long_waves_travel_with_the_elastic_constants() {
    for a in [1.4, 1.5536, 1.65] {
        sound_is_the_slope(&of(&LJ, LatticeKind::Fcc, a, 5));
        sound_is_the_slope(&of(&Metal, LatticeKind::Fcc, a, 3));
    }
    sound_is_the_slope(&of(&Metal, LatticeKind::Bcc, 1.3, 3));
    let body = LatticeSolid::new(LatticeKind::Diamond, 1.0, Horizon::Ratio(1));
    sound_is_the_slope(&body.bond_based(1.0).unwrap());
    sound_is_the_slope(&body.state_based(Solid::lps(3, 4.0, 1.0)).unwrap());
    let mut cubic = body;
    cubic.kind = LatticeKind::Cubic;
    cubic.horizon = Horizon::Ratio(3);
    sound_is_the_slope(&cubic.state_based(Solid::lps(3, 4.0, 1.0)).unwrap());
}

#[test]
fn sites_of_a_chain_with_two_atoms_relax() {
    let crystal = dimer();
    assert!(crystal.residual() < 1e-15);
    let sound = crystal.sound([1.0]).unwrap()[0];
    let k = 1e-3;
    assert!((crystal.squares([k])[0] / (k * k) / sound - 1.0).abs() < 1e-6);
    let rigid = crystal.rigid_elastic_constants().c[0][0];
    assert!(crystal.elastic_constants().unwrap().c[0][0] < 0.99 * rigid);
}

#[test]
fn sites_of_diamond_relax() {
    let body = LatticeSolid::new(LatticeKind::Diamond, 1.0, Horizon::Ratio(1));
    let crystal = body.bond_based::<3>(1.0).unwrap();
    let rigid = crystal.rigid_elastic_constants().cubic(1e-12).unwrap();
    let free = crystal.elastic_constants().unwrap().cubic(1e-12).unwrap();
    assert!((free.c11 - rigid.c11).abs() < 1e-12 * rigid.c11);
    assert!(free.c44 < 0.999 * rigid.c44);
    assert!(rigid.cauchy().abs() < 1e-12 * rigid.c11 && free.cauchy() > 0.0);
}

#[test]
fn constants_are_second_derivatives_of_the_energy() {
    // isotropic strain: V d²E/dV² from finite differences of the energy per atom, at pressure
    let a = 1.48;
    let energy = |a: f64| {
        let reach = Reach::Shells(4);
        Crystal::<3>::of_potential(&Metal, LatticeKind::Fcc, a, 1.0, reach)
            .unwrap()
            .1
    };
    let v = |a: f64| a * a * a / 4.0;
    let h = 1e-4;
    let slope = (energy(a + h).pressure - energy(a - h).pressure) / (v(a + h) - v(a - h));
    let bulk = -v(a) * slope;
    let b = of(&Metal, LatticeKind::Fcc, a, 4).stress_strain().unwrap();
    let cubic = b.cubic(1e-12).unwrap();
    assert!(
        (cubic.bulk(3) / bulk - 1.0).abs() < 1e-6,
        "{} {bulk}",
        cubic.bulk(3)
    );
    let c = of(&Metal, LatticeKind::Fcc, a, 4)
        .elastic_constants()
        .unwrap()
        .cubic(1e-12)
        .unwrap();
    let p = energy(a).pressure;
    assert!(p.abs() > 0.01);
    let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-12 * c.c11.abs(), "{x} {y}");
    close(cubic.c11, c.c11 - p);
    close(cubic.c12, c.c12 + p);
    close(cubic.c44, c.c44 - p);
}

#[test]
fn pair_laws_obey_cauchy_and_embedding_breaks_it() {
    let pair = of(&LJ, LatticeKind::Fcc, 1.5, 5)
        .elastic_constants()
        .unwrap();
    assert!(pair.cubic(1e-12).unwrap().cauchy().abs() < 1e-11 * pair.c[0][0]);
    let metal = of(&Metal, LatticeKind::Fcc, 1.5, 3)
        .elastic_constants()
        .unwrap();
    assert!(metal.cubic(1e-12).unwrap().cauchy() > 0.01 * metal.c[0][0]);
}

#[test]
fn peridynamic_lattices_tend_to_their_continuum() {
    // the mean over directions of a calibrated lattice is the continuum, its anisotropy goes
    let moduli = Moduli {
        young: 2.5,
        poisson: 0.25,
    };
    let law = LawSpec::Pmb(PmbStiffness::Young(2.5));
    let limit = continuum(3, Plane::Strain, moduli).voigt();
    let mut zener = vec![];
    for m in [1, 3, 10] {
        let body = LatticeSolid::new(LatticeKind::Cubic, 1.0, Horizon::Ratio(m));
        let c: Crystal<3> = body
            .of_law(&law, Plane::Strain, Calibration::Discrete)
            .unwrap();
        let c = c.elastic_constants().unwrap();
        let mean = c.voigt();
        assert!((mean.bulk / limit.bulk - 1.0).abs() < 1e-12);
        assert!((mean.shear / limit.shear - 1.0).abs() < 1e-12);
        zener.push(c.cubic(1e-10).unwrap().zener());
    }
    // nearest neighbours alone do not resist shear
    assert_eq!(zener[0], 0.0);
    assert!((zener[1] - 1.0).abs() < 0.25, "{zener:?}");
    assert!((zener[2] - 1.0).abs() < 0.02, "{zener:?}");
    // LPS has its bulk modulus on any lattice, and any Poisson ratio
    for poisson in [0.1, 0.4] {
        let moduli = Moduli {
            young: 2.0,
            poisson,
        };
        let body = LatticeSolid::new(LatticeKind::Fcc, 1.0, Horizon::Ratio(2));
        let c: Crystal<3> = body
            .of_law(&LawSpec::Lps(moduli), Plane::Strain, Calibration::Discrete)
            .unwrap();
        let c = c.elastic_constants().unwrap();
        assert!((c.voigt().bulk / moduli.bulk() - 1.0).abs() < 1e-12);
        assert!((c.voigt().shear / moduli.shear() - 1.0).abs() < 1e-12);
    }
    let bar = LatticeSolid::new(LatticeKind::Chain, 0.1, Horizon::Ratio(4));
    let law = LawSpec::Pmb(PmbStiffness::Young(7.0));
    let c: Crystal<1> = bar
        .of_law(&law, Plane::Stress, Calibration::Discrete)
        .unwrap();
    assert!((c.elastic_constants().unwrap().c[0][0] - 7.0).abs() < 1e-13);
    // the continuum's constant is 1 + 1/m too stiff on a chain
    let c: Crystal<1> = bar
        .of_law(&law, Plane::Stress, Calibration::Continuum)
        .unwrap();
    assert!((c.elastic_constants().unwrap().c[0][0] - 7.0 * 1.25).abs() < 1e-12);
}

#[test]
fn turned_crystals_have_turned_constants() {
    let crystal = of(&Metal, LatticeKind::Fcc, 1.5, 3);
    let (c, s) = (0.6, 0.8);
    let turned = crystal.rotated([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
    let (a, b) = (
        crystal.elastic_constants().unwrap(),
        turned.elastic_constants().unwrap(),
    );
    assert!(b.cubic(1e-3).is_none());
    let close = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-12;
    assert!(close(a.voigt().bulk, b.voigt().bulk));
    // c'11 = c11 − 2 (c11 − c12 − 2 c44) c²s²
    let k = a.cubic(1e-12).unwrap();
    let expected = k.c11 - 2.0 * (k.c11 - k.c12 - 2.0 * k.c44) * c * c * s * s;
    assert!(close(b.c[0][0], expected));
}
