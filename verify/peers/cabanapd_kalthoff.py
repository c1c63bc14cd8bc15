"""CabanaPD's regression test of the Kalthoff-Winkler plate, with both ways of letting bonds go.

Usage: python cabanapd_kalthoff.py PERIDYNE [DIR]

Points, constants, conditions and steps are those of CabanaPD (github.com/ORNL/CabanaPD, regression_test/inputs/kalthoff_winkler.json
and examples/mechanics/kalthoff_winkler.cpp): 75 x 151 x 7 cells, horizon 2 mm, PMB of constant influence and whole volumes. Its
regression_test/tstKalthoffWinkler.hpp stores the largest y of points with damage above 0.3 after 70 us: 0.0742 m, within a tenth of a
cell (0.00011 m). A bond of CabanaPD lets go in the evaluation in which it is too long; LAMMPS's pulls once more, which gives another
crack. Takes half a minute.
Needs: pip install numpy pyvista
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyvista

CELLS = (75, 151, 7)
SIZE = np.array([0.1, 0.2, 0.009])
BULK, ENERGY, HORIZON = 191e9, 42408.0, 0.002 + 1e-10
STORED = 7.42e-2
TOLERANCE = 1.1e-4

DECK = """
title = "CabanaPD's coarse Kalthoff-Winkler plate"
horizon = {horizon!r}
calibration = "continuum"
partial_volume_correction = false
contact = false
body = {{ file = "points.txt", spacing = {dx!r} }}
[sets]
struck.where = "x < {first!r} && y > -0.025 && y < 0.025"
held.where = "x < {first!r} && ((y >= 0.025 && y <= {rim!r}) || (y <= -0.025 && y >= -{rim!r}))"
[material]
density = 8000
law = {{ pmb = {{ bulk = {bulk!r} }} }}
fracture = {{ critical_stretch = {critical!r}, breakage = "{release}" }}
[[precrack]]
polygon = [[-0.05, 0.025, -0.0045], [0, 0.025, -0.0045], [0, 0.025, 0.0045], [-0.05, 0.025, 0.0045]]
[[precrack]]
polygon = [[-0.05, -0.025, -0.0045], [0, -0.025, -0.0045], [0, -0.025, 0.0045], [-0.05, -0.025, 0.0045]]
[[boundary_condition]]
set = "struck"
velocity = {{ x = "16", y = "0", z = "0" }}
[[boundary_condition]]
set = "held"
velocity = {{ x = "0", y = "0", z = "0" }}
[run]
steps = 700
time_step = 1e-7
[output]
every = 700
"""


def crack(peridyne, folder, release):
    """The largest y (m) of damaged points at the end."""
    step = SIZE / np.array(CELLS)
    axes = [-SIZE[a] / 2 + (np.arange(CELLS[a]) + 0.5) * step[a] for a in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    table = np.c_[points, np.full(len(points), step.prod())]
    np.savetxt(folder / "points.txt", table, fmt="%.17g")
    deck = folder / f"{release}.toml"
    deck.write_text(
        DECK.format(
            horizon=HORIZON,
            dx=float(step[0]),
            first=float(-0.05 + step[0]),
            rim=float(0.025 + 0.25 * step[0]),
            bulk=BULK,
            critical=(5 * ENERGY / (9 * BULK * HORIZON)) ** 0.5,
            release=release,
        )
    )
    out = folder / release
    subprocess.run([peridyne, "run", deck, "--out", out], check=True, capture_output=True)
    last = pyvista.read(sorted(out.glob("*.vtu"))[-1])
    reference = last.points - last["displacement"]
    return reference[last["damage"] > 0.3][:, 1].max()


def main():
    peridyne = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else scratch)
        folder.mkdir(parents=True, exist_ok=True)
        at_once, after = (crack(peridyne, folder, r) for r in ("before_force", "after_force"))
    print(f"at_once {at_once:.5f} m (CabanaPD stores {STORED}), after_force {after:.5f} m")
    if abs(at_once - STORED) > TOLERANCE:
        sys.exit("another crack than CabanaPD's")
    if abs(after - STORED) < 10 * TOLERANCE:
        sys.exit("both ways give one crack: the key does nothing")


main()
