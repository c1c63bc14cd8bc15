#!/usr/bin/env python3
"""Numbers of the worked examples of docs/fields.md, from what the decks of docs/fields wrote.

usage: verify/fields/worked_examples.py OUT_OF_ARGON_SHOCK OUT_OF_SILICON_BAR

The shock: momentum that its front takes up, rho_0 U u, against the mean of -sigma_xx between piston and front. Silicon: the first harmonic
of the heat flux over that of the temperature gradient. Fails where the two of the shock differ by more than 3 %, or heat flows up the
gradient.

Needs: pip install numpy"""

import sys

import numpy as np

shock, silicon = (np.load(f"{folder}/fields/fields.npz") for folder in sys.argv[1:3])

# constants of argon_shock.toml: A, A/ps, ps, g/mol
EDGE, CELLS, SPEED, TIME, MASS = 5.4, 120, 4.0, 24.0, 39.948
# g/mol (A/ps)^2 in eV
TO_EV = 1.036427e-4
stress, velocity = shock["s"].reshape(-1, 9)[:, 0], shock["v"].reshape(-1, 3)[:, 0]
x = (np.arange(len(stress)) + 0.5) * CELLS * EDGE / len(stress)
front = x[np.where((x > 300) & (velocity < SPEED / 2))[0][0]]
# the face of the piston begins after two cells
fast = (front - 2 * EDGE) / TIME
asked = 4 * MASS / EDGE**3 * TO_EV * fast * SPEED
piston = 2 * EDGE + SPEED * TIME
found = -stress[(x > piston + 20) & (x < front - 20)].mean()
print(f"argon: front at {front:.1f} A, U = {fast:.2f} A/ps, rho_0 U u = {asked:.5f} eV/A^3, mean of -sigma_xx = {found:.5f}")

LENGTH = 24 * 5.431
temperature = silicon["T"].ravel()
flux = sum(silicon[q].reshape(-1, 3)[:, 0] for q in ("qK", "qU", "qC"))
phase = 2 * np.pi * (np.arange(len(flux)) + 0.5) / len(flux)
first = 2 * (temperature * np.cos(phase)).mean() * 2 * np.pi / LENGTH
# dT/dx = -first sin, q = -k dT/dx
conducts = 2 * (flux * np.sin(phase)).mean() / first * 1.602176634e-19 / 1e-10 / 1e-12
print(f"silicon: flux over gradient {conducts:.2f} W/(m K), mean temperature {temperature.mean():.0f} K")
sys.exit(0 if abs(found / asked - 1) < 0.03 and conducts > 0 else 1)
