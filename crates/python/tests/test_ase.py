"""Potentials as calculators of ASE, and calculators of ASE as level 0."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import peridyne
import pytest
from ase.build import bulk
from ase.calculators.calculator import Calculator
from ase.calculators.emt import EMT
from ase.calculators.lj import LennardJones
from peridyne.ase import GPA, Potential, _sites, _translations, linear_body, upscale

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


def copper():
    atoms = bulk("Cu", "fcc", a=3.61, cubic=True) * 4
    atoms.calc = EMT()
    return atoms


def test_a_crystal_of_a_calculator_is_upscaled(tmp_path):
    atoms = copper()
    card = upscale(atoms, tmp_path, factor=2, solid=True)
    assert json.loads((tmp_path / "h2/card.json").read_text()) == card
    # elastic constants are EMT's, and those of a cubic crystal
    c = np.array(card["stiffness"])
    assert card["stiffness_error"] < 1e-3 and 150 < c[0, 0] < 170 and 80 < c[3, 3] < 90
    assert np.array(card["stiffness_calculator"]) == pytest.approx(c, abs=0.1)
    assert card["unstable"] == 0 and card["cost"] == 16
    # the body that was written runs, and is softer by the factor: forces of the same strain
    fine = peridyne.Deck.from_toml(tmp_path / "fine/level0.toml").simulation(threads=1)
    coarse = peridyne.Deck.from_toml(tmp_path / "h2/coarse.toml").simulation(threads=1)
    assert fine.points == coarse.points == 256
    assert coarse.column("volume") == pytest.approx(8 * fine.column("volume"))
    # energy density of one wave, as long as both periods
    energies = []
    for sim in [fine, coarse]:
        x = sim.column("reference")
        side = 4 * 3.61 if sim is fine else 8 * 3.61
        u = 1e-3 * side * np.sin(2 * np.pi * x[:, :1] / side) * np.array([1.0, 0.5, 0.25])
        sim.set_column("displacement", u)
        energies.append(sim.energies()["strain"] / sim.column("volume").sum())
    assert energies[0] == pytest.approx(energies[1], rel=1e-9) and energies[0] > 0
    # a solid with these constants, whose waves part sooner
    assert np.array(card["solid"]["stiffness"]) == pytest.approx(c, abs=1e-3)
    for name, found in card["solid"]["waves"].items():
        assert found["1 %"] > 1.5 * card["waves"][name]["1 %"]
    solid = peridyne.Deck.from_toml(tmp_path / "h2/solid.toml").simulation(threads=1)
    density = atoms.get_masses().sum() / atoms.get_volume()
    assert solid.column("density")[0] / coarse.column("density")[0] == pytest.approx(1.0, rel=1e-9) and density == pytest.approx(5.40, abs=0.01)


def test_its_waves_are_those_of_ase(tmp_path):
    from ase.phonons import Phonons
    from ase import units
    from peridyne.ase import _springs

    body, _ = _springs(copper(), 0.01, None)
    primitive = bulk("Cu", "fcc", a=3.61)
    phonons = Phonons(primitive, EMT(), supercell=(5, 5, 5), delta=0.01, name=str(tmp_path / "phonons"))
    phonons.run()
    phonons.read(acoustic=True)
    # eV of ħω for waves along x, y and xyz
    for k in [[0.5, 0, 0], [0, 1.2, 0], [0.6, 0.6, 0.6], [0.3, 0.9, 0.1]]:
        reduced = primitive.cell.array @ np.array(k) / (2 * np.pi)
        theirs = phonons.band_structure([reduced], verbose=False)[0]
        ours = units._hbar * 1e12 * np.sqrt(body.squares(k)) / units._e
        assert ours == pytest.approx(theirs, rel=2e-3)


def test_what_is_known_of_a_potential_is_found_through_its_forces(tmp_path):
    # the program upscales the same crystal by its potential
    done = subprocess.run(
        [sys.executable, "-m", "peridyne", "upscale", "--potential", "stillinger_weber=" + str(DECKS / "Si.sw"), "--element", "Si"]
        + ["--lattice", "diamond", "--spacing", "5.431", "--mass", "28.085", "--factor", "2", "--out", str(tmp_path / "known")],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    known = json.loads((tmp_path / "known/h2/card.json").read_text())
    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * 3
    atoms.calc = Potential(SW, folder=DECKS)
    card = upscale(atoms, tmp_path / "box", factor=2)
    # two sites in a cell, which relax
    theirs = GPA * np.array(known["coarse"]["stiffness"])
    ours = np.array(card["stiffness"])
    for i, j in [(0, 0), (0, 1), (3, 3)]:
        assert ours[i, j] == pytest.approx(theirs[i, j], rel=5e-4)
    # a potential of ours takes no sheared cell
    c = card["stiffness_calculator"]
    assert c[3] == [c[3][0], c[3][1], c[3][2], None, None, None] and card["stiffness_error"] < 1e-3
    # both look at steps of wavelengths
    told = {"x": (36.89, 18.63), "xy": (57.01, 25.42), "xyz": (55.33, 26.13)}
    for name, found in card["waves"].items():
        assert tuple(found.values()) == pytest.approx(told[name], rel=0.02), (name, done.stdout)


@pytest.mark.parametrize("moved", [0.0, 0.123456, 1e-9])
def test_cells_of_a_crystal_are_found(moved):
    # a quarter of this cell is halfway between two tenths of a thousandth of Å
    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * 3
    atoms.positions += moved
    translations = _translations(atoms, np.diag(atoms.cell.array))
    assert len(translations) == 108
    site = _sites(translations)
    assert sorted(np.bincount(site)) == [108, 108]
    # one atom that is off leaves no translation but the first
    atoms.positions[5] += 0.01
    translations = _translations(atoms, np.diag(atoms.cell.array))
    assert len(translations) == 1 and len(set(_sites(translations))) == 216


def test_no_stress_leaves_the_comparison_out(tmp_path):
    class Springs(Calculator):
        implemented_properties = ["energy", "forces"]

        def calculate(self, atoms, properties, changes):
            super().calculate(atoms, properties, changes)
            inner = EMT()
            self.results = {"energy": inner.get_potential_energy(atoms), "forces": inner.get_forces(atoms)}

    atoms = copper()
    atoms.calc = Springs()
    card = upscale(atoms, tmp_path, factor=3, repeat=(2, 1, 1))
    assert card["stiffness_calculator"] is None and card["stiffness_error"] is None and card["pressure"] is None
    assert peridyne.Deck.from_toml(tmp_path / "h3/coarse.toml").simulation(threads=1).points == 512


def test_a_body_of_several_periods_is_the_same_crystal(tmp_path):
    atoms = copper()
    linear_body(atoms, tmp_path / "one")
    linear_body(atoms, tmp_path / "many", repeat=(3, 1, 2))
    one, many = (peridyne.Deck.from_toml(tmp_path / name / "level0.toml").simulation(threads=1) for name in ["one", "many"])
    assert many.points == 6 * one.points
    densities = []
    for sim, sides in [(one, [1, 1, 1]), (many, [3, 1, 2])]:
        x = sim.column("reference")
        u = 1e-2 * np.sin(2 * np.pi * x @ np.array([1.0, 2.0, 1.0]) / 14.44)[:, None] * np.array([1.0, 0.5, 0.25])
        sim.set_column("displacement", u)
        densities.append(sim.energies()["strain"] / sim.column("volume").sum())
    assert densities[0] == pytest.approx(densities[1], rel=1e-12)


def test_wrong_things_to_upscale(tmp_path):
    for more, words in [
        ({"factor": 1}, "factor=1: expected a whole number of 2 or more"),
        ({"factor": 2.5}, "factor=2.5"),
        ({"step": 0.0}, "step=0.0: expected a positive length"),
        ({"step": np.nan}, "step=nan"),
        ({"cutoff": -1.0}, "cutoff=-1.0"),
        ({"cutoff": 9.0}, "cutoff=9.0: expected at most half the least period, 7.22"),
        ({"repeat": (1, 0, 1)}, "repeat=.*three whole numbers of 1 or more"),
        ({"repeat": 2}, "repeat=2"),
    ]:
        with pytest.raises(ValueError, match=words):
            upscale(copper(), tmp_path / "out", **more)
    atoms = copper()
    atoms.pbc = False
    with pytest.raises(ValueError, match="three periods"):
        upscale(atoms, tmp_path / "out")

    class Nothing(Calculator):
        implemented_properties = ["energy", "forces"]
        value = 0.0

        def calculate(self, atoms, properties, changes):
            super().calculate(atoms, properties, changes)
            self.results = {"energy": 0.0, "forces": np.full((len(atoms), 3), self.value)}

    atoms = copper()
    atoms.calc = Nothing()
    with pytest.raises(ValueError, match="Nothing: no force depends"):
        upscale(atoms, tmp_path / "out")
    atoms.calc = Nothing()
    atoms.calc.value = np.nan
    with pytest.raises(ValueError, match="Nothing: a force on an atom is not a finite number"):
        upscale(atoms, tmp_path / "out")
    assert not (tmp_path / "out").exists()
