"""Cracks of a quenched edge by finite elements: what `papers/gallery/quench` is measured by.

Usage: python quench.py [ELEMENTS BETWEEN TWO CRACKS]

Alumina as in the deck there (E = 370 GPa, nu = 1/3, G = 24.32 J/m2, alpha = 7.5e-6 / K, 3980 kg/m3, 880 J/kg/K, 31 W/m/K), plane stress, 280 K above water
that takes 65 kW/m2/K. Cold goes in as into a half space (Carslaw & Jaeger, Conduction of heat in solids, 2nd edition, 2.7), and does not
notice cracks that stand upright. Equal cracks, p apart, are as long as the energy that is released by all of them together says: it falls
to G there. They stay equal while that costs less than one that grows as its neighbour shrinks: the second variation of the elastic
energy, with crack tips as variables, against alternate ones (Nemat-Nasser, Keer & Parihar 1978; Bazant & Ohtsubo 1977). It vanishes at a
length a(p): of cracks longer than a(p) no row has the spacing p, every second crack stays behind. So at a depth a the spacing lies between p(a) and 2 p(a).
Bilinear elements between a crack and the next, nodes of ligaments held at both sides; prints p, the time, a(p), and a(p)/p;
then of some spacings the length of equal cracks after 0.1 s. Needs: pip install numpy scipy; 32 elements a minute.
"""

import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from scipy.special import erfc, erfcx

YOUNG, POISSON, TOUGHNESS, EXPANSION = 370e9, 1 / 3, 24.32, 7.5e-6
DENSITY, CAPACITY, CONDUCTIVITY, EXCHANGE = 3980.0, 880.0, 31.0, 65e3
HOTTER, DEPTH = 280.0, 10e-3
DIFFUSIVITY = CONDUCTIVITY / (DENSITY * CAPACITY)


def drop(y, t):
    """How much colder it is at the depth y after t (K)."""
    r = np.sqrt(DIFFUSIVITY * t)
    z, b = y / (2 * r), EXCHANGE * r / CONDUCTIVITY
    return HOTTER * (erfc(z) - np.exp(-z * z) * erfcx(z + b))


class Cell:
    """Half of a crack at x = 0 and half of the next at x = p, down to DEPTH."""

    def __init__(self, p, across):
        self.h = p / across
        y = list(np.arange(round(min(0.6 * DEPTH, 2.2 * p) / self.h) + 1) * self.h)
        self.longest, step = len(y) - 3, self.h
        while y[-1] < DEPTH:
            step *= 1.08
            y.append(y[-1] + step)
        x, y = np.linspace(0, p, across + 1), np.array(y)
        nodes = np.arange(len(x) * len(y)).reshape(len(x), len(y))
        self.sides, self.size = (nodes[0], nodes[-1]), 2 * nodes.size
        corners = np.stack([nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]], -1).reshape(-1, 4)
        self.dofs = np.stack([2 * corners, 2 * corners + 1], 2).reshape(-1, 8)
        i, j = np.divmod(np.arange(len(corners)), len(y) - 1)
        hx, hy, middle = x[i + 1] - x[i], y[j + 1] - y[j], (y[j] + y[j + 1]) / 2
        self.moduli = YOUNG / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
        self.points, stiffness = [], 0
        for a in (-1, 1) / np.sqrt(3):
            for b in (-1, 1) / np.sqrt(3):
                slope = np.array([[b - 1, 1 - b, 1 + b, -1 - b], [a - 1, -1 - a, 1 + a, 1 - a]]) / 4
                gradient = np.zeros((len(i), 3, 8))
                gradient[:, 0, 0::2] = gradient[:, 2, 1::2] = slope[0] * 2 / hx[:, None]
                gradient[:, 1, 1::2] = gradient[:, 2, 0::2] = slope[1] * 2 / hy[:, None]
                weight = hx * hy / 4
                stiffness = stiffness + np.einsum("eki,kl,elj,e->eij", gradient, self.moduli, gradient, weight)
                self.points.append((gradient, weight, middle + b * hy / 2))
        at = np.repeat(self.dofs, 8, 1).ravel(), np.tile(self.dofs, 8).ravel()
        self.stiffness = coo_matrix((stiffness.ravel(), at), (self.size, self.size)).tocsc()

    def load(self, t):
        """Forces of the cold, and the energy with all held."""
        force, held = np.zeros(self.size), 0.0
        for gradient, weight, y in self.points:
            strain = -EXPANSION * drop(y, t)[:, None] * [1, 1, 0]
            stress = strain @ self.moduli
            np.add.at(force, self.dofs, np.einsum("eki,ek,e->ei", gradient, stress, weight))
            held += 0.5 * np.sum(np.sum(strain * stress, 1) * weight)
        return force, held

    def energies(self, left, right, loads):
        """With so many free nodes of each crack, for each load."""
        held = [2 * self.sides[0][left:], 2 * self.sides[1][right:], 2 * self.sides[0][-1:] + 1]
        free = np.setdiff1d(np.arange(self.size), np.concatenate(held))
        solve = splu(self.stiffness[free][:, free]).solve
        return np.array([held - 0.5 * force[free] @ solve(force[free]) for force, held in loads])

    def equal(self, times):
        """For each time the length of equal cracks, and the second variation against alternate ones."""
        loads = [self.load(t) for t in times]
        count = np.arange(1, self.longest)
        same = np.array([self.energies(k, k, loads) for k in count])
        other = np.array([self.energies(k + 1, k - 1, loads) for k in count])
        released = (same[:-2] - same[2:]) / (2 * self.h)
        second, length = (other - same)[1:-1], count[1:-1] * self.h
        for q, t in enumerate(times):
            g = released[:, q]
            last = np.where((g[:-1] >= TOUGHNESS) & (g[1:] < TOUGHNESS))[0]
            if len(last):
                k = last[-1]
                w = (g[k] - TOUGHNESS) / (g[k] - g[k + 1])
                yield t, length[k] + w * self.h, (1 - w) * second[k, q] + w * second[k + 1, q]


def main():
    across = int(sys.argv[1]) if len(sys.argv) > 1 else 32
    print(f"# {across} elements between two cracks\n# p [mm]   t [s]     a [mm]  a/p")
    for p in (1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3):
        before = None
        for t, a, second in Cell(p, across).equal(np.geomspace(5e-3, 0.5, 40)):
            if before and before[2] > 0 >= second:
                w = before[2] / (before[2] - second)
                t, a = (old + w * (new - old) for old, new in zip(before, (t, a)))
                print(f"{1e3 * p:8.2f}  {t:8.4f}  {1e3 * a:8.3f}  {a / p:.3f}")
                break
            before = t, a, second
    print("# p [mm]   length of equal cracks after 0.1 s [mm]")
    for p in (2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3):
        for _, a, _ in Cell(p, across).equal([0.1]):
            print(f"{1e3 * p:8.2f}  {1e3 * a:8.3f}")


if __name__ == "__main__":
    main()
