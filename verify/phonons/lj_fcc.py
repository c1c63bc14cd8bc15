"""Phonons of a Lennard-Jones fcc crystal by ASE (finite differences of its own forces).

Writes lj_fcc.csv: wave vector in units of 2 pi / a, then omega^2 of the three branches. eps = sigma = mass = 1, a = 1.55,
cut-off 2.3 (between shells, unshifted), primitive cell in a 8x8x8 supercell, displacements of 1e-4.

    python lj_fcc.py > lj_fcc.csv        # needs ase and numpy
"""

import tempfile

import numpy as np
from ase import Atoms, units
from ase.calculators.lj import LennardJones
from ase.phonons import Phonons

A = 1.55
CUTOFF = 2.3
POINTS = [
    (0.1, 0, 0), (0.5, 0, 0), (1, 0, 0), (1, 0.5, 0), (0.75, 0.75, 0), (0.3, 0.3, 0),
    (0.25, 0.25, 0.25), (0.5, 0.5, 0.5), (0.13, 0.37, 0.71), (0.9, -0.2, 0.45),
]

h = A / 2
cell = np.array([[0, h, h], [h, 0, h], [h, h, 0]])
atoms = Atoms("Ar", cell=cell, positions=[[0, 0, 0]], pbc=True, masses=[1.0])
calculator = LennardJones(sigma=1.0, epsilon=1.0, rc=CUTOFF, smooth=False)

with tempfile.TemporaryDirectory() as folder:
    phonons = Phonons(atoms, calculator, supercell=(8, 8, 8), delta=1e-4, name=folder + "/lj")
    phonons.run()
    phonons.read(method="standard", acoustic=True, symmetrize=3)
    # wave vectors in units of the reciprocal vectors of the primitive cell
    waves = [np.array(p) / A @ cell.T for p in POINTS]
    energies = phonons.band_structure(np.array(waves))

# hbar omega in eV with masses in u and energies in eV; back to eps = sigma = m = 1
unit = units._hbar * 1e10 / np.sqrt(units._e * units._amu)
print("# kx,ky,kz (2 pi/a),omega^2 of three branches (eps/(m sigma^2))")
for p, e in zip(POINTS, energies):
    squares = np.sign(e) * (e / unit) ** 2
    print(",".join(f"{x:g}" for x in p) + "," + ",".join(f"{s:.9g}" for s in sorted(squares)))
