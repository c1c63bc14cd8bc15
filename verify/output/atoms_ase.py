"""Writes atoms with ASE and reads atoms that peridyne wrote, with ASE.

Usage: python atoms_ase.py write DIR    (makes ase.xyz and ase.data)
       python atoms_ase.py read DIR     (checks peridyne.xyz, peridyne.data, peridyne.lammpstrj against ase.xyz)
Between the two: PERIDYNE_ASE=DIR cargo test -p peridyne-io --test atoms_ase
Needs: pip install ase numpy
"""

import pathlib
import sys

import ase.io
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
    close("extxyz forces", mine.get_forces(apply_constraint=False), atoms.get_forces(apply_constraint=False), 0.0)
    data = ase.io.read(directory / "peridyne.data", format="lammps-data", atom_style="atomic", sort_by_id=True)
    close("data positions", data.positions, atoms.positions, 1e-14)
    # ASE converts masses from g/mol with its own constants
    close("data masses", data.get_masses(), atoms.get_masses(), 1e-6)
    dump = ase.io.read(directory / "peridyne.lammpstrj", format="lammps-dump-text", index=-1)
    order = np.argsort(dump.arrays["id"]) if "id" in dump.arrays else slice(None)
    close("dump positions", dump.positions[order], atoms.positions, 1e-14)
    close("dump forces", dump.get_forces(apply_constraint=False)[order], atoms.get_forces(apply_constraint=False), 0.0)


if __name__ == "__main__":
    {"write": write, "read": read}[sys.argv[1]](pathlib.Path(sys.argv[2]))
