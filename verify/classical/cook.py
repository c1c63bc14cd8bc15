"""Cook's membrane of a nearly incompressible rubber by finite elements, the answer that correspondence is measured by.

Usage: python cook.py [ELEMENTS ...]

Corners (0, 0), (48, 44), (48, 60), (0, 44), clamped at x = 0, a dead load of 100 along y spread over x = 48; plane strain of unit
thickness, psi = mu/2 (I1 - 3) - mu ln J + lambda/2 ln^2 J with E = 240.565 and nu = 0.49. Nine-node elements with nine points of
integration, smaller towards the clamp, whose corners are singular; ten increments of Newton's method. Prints the rise of the corner
(48, 60) and of the middle (48, 52) of the loaded side: the latter 7.0219, 7.0246, 7.0251 with 16, 32, 48 elements along each side.
Needs: pip install numpy scipy; two minutes.
"""

import sys

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

YOUNG, POISSON, LOAD = 240.565, 0.49, 100.0
MU = YOUNG / 2 / (1 + POISSON)
LAMBDA = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)


def shapes(x, y):
    """Values and slopes of the nine functions, x fastest."""
    line = lambda t: (np.array([t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2]), np.array([t - 0.5, -2 * t, t + 0.5]))
    (a, da), (b, db) = line(x), line(y)
    return np.outer(b, a).ravel(), np.stack([np.outer(b, da).ravel(), np.outer(db, a).ravel()], 1)


def rise(n, increments=10):
    side = 2 * n + 1
    even = np.linspace(0, 1, n + 1)
    across = np.where(even < 0.5, 0.5 * (2 * even) ** 2, 1 - 0.5 * (2 - 2 * even) ** 2)
    middles = lambda v: np.sort(np.concatenate([v, (v[1:] + v[:-1]) / 2]))
    s, t = np.meshgrid(middles(even**2), middles(across))
    place = np.stack([48 * s, 44 * s + t * (44 - 28 * s)], -1).reshape(-1, 2)
    node = lambda i, j: j * side + i
    elements = np.array(
        [[node(2 * a + i, 2 * b + j) for j in range(3) for i in range(3)] for b in range(n) for a in range(n)]
    )
    g = np.sqrt(0.6)
    rule = [(-g, 5 / 9), (0, 8 / 9), (g, 5 / 9)]
    corners = place[elements]
    points = []
    for y, wy in rule:
        for x, wx in rule:
            _, slopes = shapes(x, y)
            jacobian = np.einsum("eai,aj->eij", corners, slopes)
            gradients = np.einsum("aj,eji->eai", slopes, np.linalg.inv(jacobian))
            points.append((gradients, np.linalg.det(jacobian) * wx * wy))
    held = np.array([2 * node(0, j) + k for j in range(side) for k in (0, 1)])
    free = np.setdiff1d(np.arange(2 * side * side), held)
    load = np.zeros(2 * side * side)
    for b, length in enumerate(np.diff(across)):
        for j, w in zip(range(3), (1 / 6, 4 / 6, 1 / 6)):
            load[2 * node(side - 1, 2 * b + j) + 1] += LOAD * length * w
    dofs = np.stack([2 * elements, 2 * elements + 1], -1).reshape(len(elements), -1)
    rows, columns = np.repeat(dofs, 18, 1).ravel(), np.tile(dofs, (1, 18)).ravel()
    one = np.eye(2)
    u = np.zeros_like(load)
    for k in range(1, increments + 1):
        for _ in range(30):
            stiffness = np.zeros((len(elements), 18, 18))
            force = np.zeros((len(elements), 18))
            own = u[dofs].reshape(-1, 9, 2)
            for gradients, weight in points:
                f = one + np.einsum("eai,eaj->eij", own, gradients)
                inverse, ln = np.linalg.inv(f), np.log(np.linalg.det(f))
                back = np.swapaxes(inverse, 1, 2)
                stress = MU * (f - back) + LAMBDA * ln[:, None, None] * back
                force += np.einsum("eij,eaj,e->eai", stress, gradients, weight).reshape(-1, 18)
                moduli = (
                    MU * np.einsum("ik,jl->ijkl", one, one)[None]
                    + (MU - LAMBDA * ln)[:, None, None, None, None] * np.einsum("eli,ejk->eijkl", inverse, inverse)
                    + LAMBDA * np.einsum("eij,ekl->eijkl", back, back)
                )
                part = np.einsum("eaj,eijkl,ebl,e->eaibk", gradients, moduli, gradients, weight)
                stiffness += part.reshape(-1, 18, 18)
            rest = load * k / increments
            np.subtract.at(rest, dofs.ravel(), force.ravel())
            if np.linalg.norm(rest[free]) < 1e-9 * LOAD:
                break
            matrix = sparse.csc_matrix((stiffness.ravel(), (rows, columns)), shape=(len(u), len(u)))
            u[free] += spsolve(matrix[free][:, free], rest[free])
    return [u[2 * node(side - 1, j) + 1] for j in (side - 1, (side - 1) // 2)]


if __name__ == "__main__":
    for n in [int(a) for a in sys.argv[1:]] or [8, 16, 32]:
        print(n, *rise(n), flush=True)
