#!/usr/bin/env python3
"""Equilibrium of linear bodies beside SciPy, on the same matrix.

Needs `numpy` and `scipy` and a release build (`cargo build --release`). Each body is held on one side and pulled by a
weight so small that the tangent of the last state is that of the reference. peridyne writes its linear body (`output.linear_body`), SciPy makes the matrix from it and solves the same equations:
SuperLU, and conjugate gradients with the same preconditioner (blocks of the diagonal) to the same residual. Compared is
the work of the weight, of which round-off and residuals leave 1e-9.

    python3 benches/statics_against_scipy.py [--markdown] [--small]
"""
import argparse, csv, json, pathlib, subprocess, tempfile, time
import numpy as np, scipy.sparse as sp, scipy.sparse.linalg as spla

ROOT = pathlib.Path(__file__).resolve().parent.parent
DECK = """
horizon = {{ m_ratio = 3 }}
{plane}
body = {{ lattice = "{lattice}", spacing = "1 mm", region = {{ block = {{ low = {low}, high = {high} }} }} }}
material = {{ density = "7850 kg/m^3", law = {{ {law} }} }}
contact = false
statics = {{ method = "linear", solver = "{solver}" }}
output = {{ picture = false, vtu = false, linear_body = {linear} }}
[sets.wall]
where = "x < 0.0025"
[[boundary_condition]]
set = "wall"
displacement = {hold}
[[boundary_condition]]
body_force = {{ x = 0.077 }}
"""
LPS, PMB = 'lps = { young = "200 GPa", poisson = 0.3 }', 'pmb = { young = "200 GPa" }'
# name, law, points per axis, solvers
CASES = [
    ("plate 150 x 150, LPS", LPS, [150, 150], ["direct", "cg"]),
    ("block 30 x 30 x 30, PMB", PMB, [30] * 3, ["cg"]),
    ("block 24 x 24 x 24, LPS", LPS, [24] * 3, ["cg"]),
]
SMALL = [
    ("plate 40 x 40, LPS", LPS, [40, 40], ["direct", "cg"]),
    ("block 9 x 9 x 9, LPS", LPS, [9] * 3, ["direct", "cg"]),
]


def peridyne(law, size, solver, linear, out):
    d = len(size)
    deck = DECK.format(
        plane='plane = "stress"\nthickness = "1 mm"' if d == 2 else "",
        lattice=["chain", "square", "cubic"][d - 1],
        low=[0] * d,
        high=[f"{n - 1} mm" for n in size],
        law=law,
        solver=solver,
        linear=str(linear).lower(),
        hold="{ " + ", ".join(f"{a} = 0" for a in "xyz"[:d]) + " }",
    )
    file = out / "deck.toml"
    file.write_text(deck)
    program = ROOT / "target/release/peridyne"
    subprocess.run([program, "run", file, "--out", out], check=True, capture_output=True)
    run = json.loads((out / "run.json").read_text())
    rows = list(csv.reader(open(out / "history.csv")))
    iterations = float(rows[-1][rows[0].index("iterations")])
    return run["seconds_stepping"], run["energy"]["work_boundary_conditions"], iterations, run["peak_memory_bytes"]


def matrix(archive):
    """Stiffness (force / length) on the free components, loads, and the blocks of the diagonal inverted."""
    x, v, start, partner = (archive[k] for k in ["position", "volume", "start", "partner"])
    n, d = x.shape
    row = np.repeat(np.arange(n), np.diff(start))
    block = archive["block"] * v[row][:, None, None]
    own = np.zeros((n, d, d))
    np.add.at(own, row, block)
    a = sp.bsr_matrix((-block, partner, start), shape=(n * d, n * d))
    a = a + sp.bsr_matrix((own, np.arange(n), np.arange(n + 1)))
    free = np.repeat(x[:, 0] >= 0.0025, d)
    load = np.zeros((n, d))
    load[:, 0] = 0.077 * v
    a = a.tocsr()[free][:, free]
    inverse = sp.bsr_matrix((np.linalg.inv(own), np.arange(n), np.arange(n + 1))).tocsr()[free][:, free]
    return a, load.ravel()[free], inverse


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--small", action="store_true")
    arguments = parser.parse_args()
    head = ["case", "unknowns", "solver", "SciPy s", "peridyne s", "iterations", "matrix MB", "peridyne peak MB", "work differs by"]
    line = "| " + " | ".join(["{}"] * len(head)) + " |" if arguments.markdown else "  ".join(["{:>20}"] * len(head))
    print(line.format(*head))
    if arguments.markdown:
        print("|---" * len(head) + "|")
    for name, law, size, solvers in SMALL if arguments.small else CASES:
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            peridyne(law, size, solvers[0], True, out)
            a, b, inverse = matrix(np.load(out / "linear_body.npz"))
            for solver in solvers:
                seconds, energy, iterations, peak = peridyne(law, size, solver, False, out)
                began = time.perf_counter()
                if solver == "direct":
                    u, taken = spla.spsolve(a.tocsc(), b), 1
                else:
                    steps = []
                    u, failed = spla.cg(a, b, rtol=1e-10, M=inverse, maxiter=100000, callback=steps.append)
                    assert failed == 0
                    taken = len(steps)
                took = time.perf_counter() - began
                theirs = 0.5 * b @ u
                print(line.format(
                    name, len(b), solver, f"{took:.2f}", f"{seconds:.2f}", f"{taken}, {iterations:.0f}",
                    f"{a.data.nbytes * 1.5 / 1e6:.0f}", f"{peak / 1e6:.0f}", f"{abs(theirs / energy - 1):.1e}"), flush=True)
                assert abs(theirs / energy - 1) < 1e-8, (theirs, energy)


if __name__ == "__main__":
    main()
