#!/usr/bin/env python3
"""Fields of `peridyne fields` against sums over all images, atom by atom and pair by pair, that know nothing of this repository.

usage: verify/fields/brute_force.py target/release/peridyne

Lennard-Jones in a tilted periodic box that is smaller than twice the cut-off, all smooth localization functions. The bond function is
integrated by Gauss's rule on 400 pieces, forces and stress are written for pairs by hand. Prints the largest difference of each
quantity over its largest value; fails above 1e-9."""

import json
import os
import subprocess
import sys
import tempfile

import numpy as np

PROGRAM = os.path.abspath(sys.argv[1])
rng = np.random.default_rng(5)


def kernels(name, s):
    """phi of the distance, normalised by numbers."""
    if name == "polynomial":
        shape, end = lambda r: np.clip(1 - (r / s) ** 2, 0, None) ** 3, s
    elif name == "bspline":
        def shape(r):
            q = 2 * r / s
            return np.clip(2 - q, 0, None) ** 3 - 4 * np.clip(1 - q, 0, None) ** 3
        end = s
    elif name == "quartic":
        def shape(r):
            q = 2.5 * r / s
            return (np.clip(2.5 - q, 0, None) ** 4 - 5 * np.clip(1.5 - q, 0, None) ** 4
                    + 10 * np.clip(0.5 - q, 0, None) ** 4)
        end = s
    else:
        shape, end = lambda r: np.exp(-0.5 * (r / s) ** 2), 10 * s
    x, w = np.polynomial.legendre.leggauss(20)
    total = 0.0
    pieces = 1000
    for k in range(pieces):
        r = end * (k + 0.5 * (x + 1)) / pieces
        total += np.sum(w * 4 * np.pi * r**2 * shape(r)) * 0.5 * end / pieces
    return (lambda r: shape(r) / total), (8 * s if name == "gaussian" else end)


def segment(phi, d, bond):
    """Mean of phi over x_k + l bond; d from x_k to the point."""
    x, w = np.polynomial.legendre.leggauss(5)
    pieces = 400
    l = ((np.arange(pieces)[:, None] + 0.5 * (x + 1)) / pieces).ravel()
    weight = np.tile(0.5 * w / pieces, pieces)
    at = d[None, :] - l[:, None] * bond[None, :]
    return np.sum(weight * phi(np.linalg.norm(at, axis=1)))


def brute(points, cell, x, v, m, phi, end, cut, pair):
    """Every quantity at the points. `pair(r)` gives value and slope."""
    n = len(x)
    reach = cut + end
    count = [int(np.ceil(2 * reach / h)) + 1 for h in heights(cell)]
    shifts = np.array([[a, b, c] for a in range(-count[0], count[0] + 1)
                       for b in range(-count[1], count[1] + 1) for c in range(-count[2], count[2] + 1)]) @ cell
    energy = np.zeros(n)
    for i in range(n):
        for s in shifts:
            r = np.linalg.norm(x + s - x[i], axis=1)
            near = (r < cut) & (r > 1e-9)
            energy[i] += 0.5 * sum(pair(q)[0] for q in r[near])
    result = []
    for p in points:
        out = {}
        d = p - (x[None] + shifts[:, None])
        w = phi(np.linalg.norm(d, axis=2)).sum(axis=0)
        out["rho"] = np.sum(m * w)
        out["p"] = (m * w) @ v
        out["v"] = out["p"] / out["rho"]
        u = v - out["v"]
        own = 0.5 * m * np.sum(v**2, axis=1) + energy
        out["e"] = np.sum(own * w)
        out["T"] = np.sum(m * np.sum(u**2, axis=1) * w) / (3 * np.sum(w))
        out["sK"] = -np.einsum("j,ja,jb->ab", m * w, u, u)
        inner = 0.5 * m * np.sum(u**2, axis=1) + energy
        out["qK"] = (inner * w) @ u
        stress, heat, back = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
        for j in range(n):
            for s in shifts:
                # j is here, k the image at s, both moved by all images
                for k in range(n):
                    bond = x[j] - (x[k] + s)
                    r = np.linalg.norm(bond)
                    if not 1e-9 < r < cut:
                        continue
                    beta = 0.0
                    for t in shifts:
                        to = p - (x[k] + s + t)
                        if np.linalg.norm(to) < end + r:
                            beta += segment(phi, to, bond)
                    if beta == 0.0:
                        continue
                    # dU/dr of the pair, and of U^(j) with x_k: -slope_j bond / r
                    whole = pair(r)[1]
                    part = 0.5 * whole
                    stress += 0.5 * whole / r * np.outer(bond, bond) * beta
                    back += np.outer(bond, -part / r * bond) * beta
                    heat += bond * (u[k] @ (-part / r * bond)) * beta
        out["sU"], out["s"] = stress, stress + out["sK"]
        out["z"] = stress + back
        out["qU"], out["qC"] = heat, (stress + back) @ out["v"]
        result.append(out)
    return result


def heights(cell):
    volume = abs(np.linalg.det(cell))
    return [volume / np.linalg.norm(np.cross(cell[(a + 1) % 3], cell[(a + 2) % 3])) for a in range(3)]


def main():
    cell = np.array([[2.9, 0, 0], [0.5, 2.7, 0], [-0.4, 0.3, 3.1]])
    grid = np.array([[i, j, k] for i in range(2) for j in range(2) for k in range(2)]) / 2 + 0.2
    x = (grid + rng.uniform(-0.04, 0.04, grid.shape)) @ cell
    n = len(x)
    v = rng.normal(size=(n, 3)) + [0.5, -0.3, 0.8]
    m = np.full(n, 1.7)
    points = rng.uniform(-1, 4, (2, 3))
    cut = 2.0

    def lj(r):
        return (4 * (r**-12 - r**-6), 4 * (-12 * r**-13 + 6 * r**-7))

    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        frames = os.path.join(folder, "a.extxyz")
        lattice = " ".join(repr(float(c)) for c in cell.ravel())
        with open(frames, "w") as file:
            print(n, file=file)
            print(f'Lattice="{lattice}" Properties=species:S:1:pos:R:3:velo:R:3 pbc="T T T"', file=file)
            for a, b in zip(x, v):
                print("Ar", *(repr(float(c)) for c in [*a, *b]), file=file)
        with open(os.path.join(folder, "points.txt"), "w") as file:
            for p in points:
                print(*(repr(float(c)) for c in p), file=file)
        for kernel, width in [("polynomial", 1.6), ("bspline", 1.9), ("quartic", 1.7), ("gaussian", 0.35)]:
            out = os.path.join(folder, kernel)
            subprocess.run([PROGRAM, "fields", "--frames", frames, "--potential", "lj", "--with", "epsilon=1", "--with",
                            "sigma=1", "--with", f"cutoff={cut}", "--units", "lj", "--mass", "Ar=1.7", "--kernel", kernel,
                            "--width", str(width), "--points", os.path.join(folder, "points.txt"), "--out", out], check=True)
            found = np.load(os.path.join(out, "fields.npz"))
            phi, end = kernels(kernel, width)
            expected = brute(points, cell, x, v, m, phi, end, cut, lj)
            for name in expected[0]:
                own = np.array([e[name] for e in expected])
                size = max(1e-3, np.abs(own).max())
                off = np.abs(found[name] - own).max() / size
                worst = max(worst, off)
                print(f"{kernel:12} {name:4} {off:.1e}")
            about = json.load(open(os.path.join(out, "fields.json")))
            print(kernel, "residuals", {k: about["residuals"][k] for k in ("mass", "momentum_extrapolated", "energy_extrapolated")})
    print(f"largest difference {worst:.1e}")
    return int(worst > 1e-9)


if __name__ == "__main__":
    sys.exit(main())
