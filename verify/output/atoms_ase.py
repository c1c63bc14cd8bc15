"""Writes atoms with ASE and reads atoms that peridyne wrote, with ASE.

Usage: python atoms_ase.py write DIR    (makes ase.xyz and ase.data)
       python atoms_ase.py read DIR     (checks peridyne.xyz, peridyne.data, peridyne.lammpstrj against ase.xyz)
Between the two: PERIDYNE_ASE=DIR cargo test -p peridyne-io --test atoms_ase
       python atoms_ase.py run XYZ DUMP TEMPERATURE (output.trajectory and output.dump of one deck in metal units hold one system,
                                        whose temperature ASE finds to be the last one of history.csv)
Needs: pip install ase numpy
"""

import pathlib
import sys

import ase.io
import ase.units
import numpy as np
from ase.build import bulk
from ase.calculators.singlepoint import SinglePointCalculator


def sample():
    atoms = bulk("Cu", "fcc", a=3.615, cubic=True).repeat((3, 2, 2))
    atoms.symbols[::5] = "Ni"
    random = np.random.default_rng(1)
    atoms.positions += random.normal(scale=0.05, size=atoms.positions.shape)
    atoms.set_velocities(random.normal(size=atoms.positions.shape))
    forces = random.normal(size=atoms.positions.shape)
    atoms.calc = SinglePointCalculator(atoms, forces=forces, energies=random.normal(size=len(atoms)), energy=-1.0)
    atoms.set_masses(atoms.get_masses())
    atoms.pbc = [True, True, False]
    return atoms


def write(directory):
    atoms = sample()
    ase.io.write(directory / "ase.xyz", [atoms, atoms], format="extxyz")
    ase.io.write(directory / "ase.data", atoms, format="lammps-data", atom_style="atomic", masses=True, velocities=True,
                 specorder=["Cu", "Ni"], units="metal")


def close(name, a, b, tolerance):
    error = np.abs(np.asarray(a) - np.asarray(b)).max()
    assert error <= tolerance, f"{name}: {error} > {tolerance}"
    print(f"{name}: largest difference {error:.2g}")


def read(directory):
    atoms = ase.io.read(directory / "ase.xyz", index=-1)
    frames = ase.io.read(directory / "peridyne.xyz", index=":")
    assert len(frames) == 2
    mine = frames[-1]
    assert list(mine.symbols) == list(atoms.symbols) and list(mine.pbc) == list(atoms.pbc)
    close("extxyz positions", mine.positions, atoms.positions, 0.0)
    close("extxyz cell", mine.cell, atoms.cell, 0.0)
    close("extxyz masses", mine.get_masses(), atoms.get_masses(), 0.0)
    close("extxyz velocities", mine.arrays["velo"], atoms.get_velocities(), 1e-14)
    # the column momenta is what ASE takes velocities from
    close("extxyz momenta", mine.get_velocities(), atoms.get_velocities(), 1e-14)
    close("extxyz forces", mine.get_forces(apply_constraint=False), atoms.get_forces(apply_constraint=False), 0.0)
    data = ase.io.read(directory / "peridyne.data", format="lammps-data", atom_style="atomic", sort_by_id=True)
    close("data positions", data.positions, atoms.positions, 1e-14)
    # ASE converts masses from g/mol with its own constants
    close("data masses", data.get_masses(), atoms.get_masses(), 1e-6)
    dump = ase.io.read(directory / "peridyne.lammpstrj", format="lammps-dump-text", index=-1)
    order = np.argsort(dump.arrays["id"]) if "id" in dump.arrays else slice(None)
    close("dump positions", dump.positions[order], atoms.positions, 1e-14)
    close("dump forces", dump.get_forces(apply_constraint=False)[order], atoms.get_forces(apply_constraint=False), 0.0)


def run(trajectory, dumped, temperature):
    frame = ase.io.read(trajectory, index=-1)
    dump = ase.io.read(dumped, format="lammps-dump-text", index=-1, units="metal")
    order = np.argsort(dump.arrays["id"]) if "id" in dump.arrays else slice(None)
    # a selection of atoms has no calculator
    forces, dump = dump.get_forces()[order], dump[order]
    assert list(frame.pbc) == list(dump.pbc)
    close("cell", frame.cell, dump.cell, 1e-12)
    # positions may lie in other periodic images
    moved = frame.get_scaled_positions(wrap=False) - dump.get_scaled_positions(wrap=False)
    shift = moved - np.rint(moved - moved[0]) - moved[0]
    close("positions", shift, np.zeros_like(shift), 1e-12)
    close("forces", frame.get_forces(), forces, 1e-12)
    close("velocities", frame.get_velocities(), dump.get_velocities(), 1e-7)
    # D N - D degrees of freedom
    degrees = 3 * len(frame) - 3
    found = 2 * frame.get_kinetic_energy() / (degrees * ase.units.kB)
    close("temperature", found, float(temperature), 1e-6 * float(temperature))


if __name__ == "__main__":
    if sys.argv[1] == "run":
        run(*sys.argv[2:5])
    else:
        {"write": write, "read": read}[sys.argv[1]](pathlib.Path(sys.argv[2]))
