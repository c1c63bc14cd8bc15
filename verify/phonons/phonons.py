"""Phonons of two crystals by ASE (finite differences of its own forces), written to lj_fcc.csv and eam_bcc.csv.

Each line: wave vector in units of 2 pi / a, then omega^2 of the three branches, in units where masses are 1.

lj_fcc: Lennard-Jones with eps = sigma = 1, a = 1.55, cut-off 2.3 (between shells, unshifted).
eam_bcc: f = exp(-1.7 r), F = -sqrt(rho), phi = 3 exp(-4 r), a = 1.1, cut-off 1.6 (between shells, not smoothed).

    python phonons.py        # needs ase and numpy
"""

import tempfile

import numpy as np
from ase import Atoms, units
from ase.calculators.eam import EAM
from ase.calculators.lj import LennardJones
from ase.phonons import Phonons

POINTS = [
    (0.1, 0, 0), (0.5, 0, 0), (1, 0, 0), (1, 0.5, 0), (0.75, 0.75, 0), (0.3, 0.3, 0),
    (0.25, 0.25, 0.25), (0.5, 0.5, 0.5), (0.13, 0.37, 0.71), (0.9, -0.2, 0.45),
]
# hbar omega in eV with masses in u and energies in eV, as an omega of unit mass and energy
UNIT = units._hbar * 1e10 / np.sqrt(units._e * units._amu)


def squares(calculator, cell, a):
    atoms = Atoms("Ar", cell=np.array(cell) * a / 2, positions=[[0, 0, 0]], pbc=True, masses=[1.0])
    with tempfile.TemporaryDirectory() as folder:
        phonons = Phonons(atoms, calculator, supercell=(10, 10, 10), delta=1e-4, name=folder + "/p")
        phonons.run()
        phonons.read(method="standard", acoustic=True, symmetrize=3)
        # wave vectors in units of the reciprocal vectors of the primitive cell
        waves = [np.array(p) / a @ atoms.cell.array.T for p in POINTS]
        energies = phonons.band_structure(np.array(waves))
    return np.sort(np.sign(energies) * (energies / UNIT) ** 2)


def write(name, rows):
    with open(name, "w") as file:
        file.write("# kx,ky,kz (2 pi/a),omega^2 of three branches (energy/(mass length^2))\n")
        for p, row in zip(POINTS, rows):
            file.write(",".join([f"{x:g}" for x in p] + [f"{s:.9g}" for s in row]) + "\n")


def embedded():
    exp, sqrt = np.exp, np.sqrt
    inside = 1.6
    cut = lambda f: lambda r: np.where(np.asarray(r) <= inside, f(np.asarray(r)), 0.0)
    return EAM(
        form="alloy",
        elements=["Ar"],
        embedded_energy=np.array([lambda rho: -sqrt(rho)]),
        d_embedded_energy=np.array([lambda rho: -0.5 / sqrt(rho)]),
        electron_density=np.array([cut(lambda r: exp(-1.7 * r))]),
        d_electron_density=np.array([cut(lambda r: -1.7 * exp(-1.7 * r))]),
        phi=np.array([[cut(lambda r: 3 * exp(-4 * r))]]),
        d_phi=np.array([[cut(lambda r: -12 * exp(-4 * r))]]),
        cutoff=inside,
        skin=0.1,
    )


FCC = [[0, 1, 1], [1, 0, 1], [1, 1, 0]]
BCC = [[-1, 1, 1], [1, -1, 1], [1, 1, -1]]
write("lj_fcc.csv", squares(LennardJones(sigma=1.0, epsilon=1.0, rc=2.3, smooth=False), FCC, 1.55))
write("eam_bcc.csv", squares(embedded(), BCC, 1.1))
