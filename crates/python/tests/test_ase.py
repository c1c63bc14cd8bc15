"""Potentials as calculators of ASE, and calculators of ASE as level 0."""

import json
from pathlib import Path

import numpy as np
import peridyne
import pytest
from ase.build import bulk
from ase.calculators.emt import EMT
from ase.calculators.lj import LennardJones
from peridyne.ase import Potential, linear_body

DECKS = Path(__file__).resolve().parents[3] / "decks/good"
SW = {"stillinger_weber": {"file": "Si.sw"}}
LJ = {"lennard_jones": {"epsilon": 0.0103, "sigma": 3.4, "cutoff": 8.5, "end": "shifted"}}


def shaken(atoms, size=0.05):
    atoms.positions += size * np.random.default_rng(3).normal(size=atoms.positions.shape)
    return atoms


def test_lennard_jones_is_that_of_ase():
    for pbc in [True, False]:
        ours = shaken(bulk("Ar", "fcc", a=5.26, cubic=True) * 4)
        ours.pbc = pbc
        theirs = ours.copy()
        ours.calc = Potential(LJ)
        theirs.calc = LennardJones(epsilon=0.0103, sigma=3.4, rc=8.5)
        # both shift the energy to 0 at the cutoff
        assert ours.get_potential_energy() == pytest.approx(theirs.get_potential_energy(), rel=1e-10)
        assert ours.get_forces() == pytest.approx(theirs.get_forces(), abs=1e-12)
        if pbc:
            assert ours.get_stress() == pytest.approx(theirs.get_stress(), abs=1e-12)


def test_forces_and_stress_are_slopes_of_the_energy():
    atoms = shaken(bulk("Si", "diamond", a=5.431, cubic=True) * 3)
    atoms.calc = Potential(SW, folder=DECKS)
    forces = atoms.get_forces()
    for i, a in [(0, 0), (7, 1), (100, 2)]:
        energies = []
        for way in [1e-4, -1e-4]:
            moved = atoms.copy()
            moved.positions[i, a] += way
            moved.calc = atoms.calc
            energies.append(moved.get_potential_energy())
        assert forces[i, a] == pytest.approx((energies[1] - energies[0]) / 2e-4, rel=1e-6, abs=1e-6)
    stress = atoms.get_stress()
    energies = []
    for way in [1e-5, -1e-5]:
        strained = atoms.copy()
        strained.set_cell(atoms.cell * np.array([1.0 + way, 1.0, 1.0])[None, :], scale_atoms=True)
        strained.calc = Potential(SW, folder=DECKS)
        energies.append(strained.get_potential_energy())
    assert stress[0] == pytest.approx((energies[0] - energies[1]) / 2e-5 / atoms.get_volume(), rel=1e-5)


def test_motion_by_ase_keeps_its_energy():
    from ase import units
    from ase.md.velocitydistribution import MaxwellBoltzmannDistribution
    from ase.md.verlet import VelocityVerlet

    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * 3
    atoms.calc = Potential(SW, folder=DECKS)
    MaxwellBoltzmannDistribution(atoms, temperature_K=300, rng=np.random.default_rng(1))
    before = atoms.get_total_energy()
    VelocityVerlet(atoms, 1.0 * units.fs).run(50)
    assert atoms.get_total_energy() == pytest.approx(before, abs=2e-4 * len(atoms))
    assert atoms.get_kinetic_energy() < 0.9 * 1.5 * len(atoms) * units.kB * 300


def test_several_elements():
    tersoff = lambda element: {"tersoff": {"file": "SiC.tersoff", "element": element}}
    atoms = bulk("SiC", "zincblende", a=4.321, cubic=True) * 3
    atoms.calc = Potential({"Si": tersoff("Si"), "C": tersoff("C")}, folder=DECKS)
    # of SiC.tersoff at this constant, as LAMMPS has it: verify/lammps
    energy = atoms.get_potential_energy() / len(atoms)
    assert -7.0 < energy < -6.0
    assert np.abs(atoms.get_forces()).max() < 1e-10


def test_mistakes():
    atoms = bulk("Si", "diamond", a=5.431)
    atoms.calc = Potential(SW, folder=DECKS)
    with pytest.raises(ValueError, match="not a box along x, y and z"):
        atoms.get_potential_energy()
    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * 3
    atoms.calc = Potential({"stillinger_webber": {"file": "Si.sw"}}, folder=DECKS)
    with pytest.raises(peridyne.DeckError, match="stillinger_weber"):
        atoms.get_potential_energy()


def test_a_calculator_of_ase_is_level_0(tmp_path):
    atoms = bulk("Cu", "fcc", a=3.61, cubic=True) * 4
    atoms.calc = EMT()
    card = linear_body(atoms, tmp_path)
    assert card["residual"] < 1e-10 and card["asymmetry"] < 1e-6 and card["translation"] < 1e-6
    body = np.load(tmp_path / "linear_body.npz")
    # the stiffness of the body under a strain along x is EMT's, as atoms of an fcc crystal stay on its lattice
    sides = body["period"]
    i, j = np.repeat(np.arange(len(atoms)), np.diff(body["start"])), body["partner"]
    xi = body["position"][j] - body["position"][i]
    xi -= sides * np.round(xi / sides)
    # twice the energy of the bonds under a strain along x, over the volume
    c11 = 0.5 * (body["volume"][i] * xi[:, 0] * body["block"][:, 0, 0] * xi[:, 0]).sum() / atoms.get_volume()
    stresses = []
    for way in [1e-4, -1e-4]:
        strained = atoms.copy()
        strained.set_cell(atoms.cell * np.array([1.0 + way, 1.0, 1.0])[None, :], scale_atoms=True)
        strained.calc = EMT()
        stresses.append(strained.get_stress()[0])
    slope = (stresses[0] - stresses[1]) / 2e-4
    # the reference is free of stress but for EMT's lattice constant
    assert c11 == pytest.approx(slope, rel=0.02)
    deck = peridyne.Deck.from_toml(tmp_path / "level0.toml")
    sim = deck.simulation(threads=1)
    u = 1e-3 * np.random.default_rng(5).normal(size=(len(atoms), 3))
    sim.set_column("displacement", u)
    moved = atoms.copy()
    moved.positions += u
    moved.calc = EMT()
    forces = sim.column("force_density") * sim.column("volume")[:, None]
    assert forces == pytest.approx(moved.get_forces(), abs=5e-3)
    assert np.abs(moved.get_forces()).max() > 0.01
