"""Linear bodies of crystals: waves, elastic constants, and the bodies themselves as files."""

import json
from pathlib import Path

import numpy as np

# places of Voigt's notation: xx yy zz yz xz xy
VOIGT = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]


class Crystal:
    """A linear body whose points repeat: force density `L_i = Σ_j C_ij (u_j − u_i)`.

    position [N, 3], volume [N], density [N], period [3]; bonds of point i are start[i]:start[i + 1] of partner and block [B, 3, 3]; site [N] is the number of each
    point's site in the cell.
    """

    def __init__(self, position, volume, density, period, start, partner, block, site):
        self.position, self.volume, self.density, self.period = position, volume, density, period
        self.start, self.partner, self.block, self.site = start, partner, block, site
        self.whose = np.repeat(np.arange(len(position)), np.diff(start))
        apart = position[partner] - position[self.whose]
        # the nearest image, and how many periods away it is
        self.image = -np.rint(apart / period).astype(int)
        self.bond = apart + self.image * period

    @classmethod
    def read(cls, path, site):
        """The body of a file (`linear_body.npz`)."""
        keys = ["position", "volume", "density", "period", "start", "partner", "block"]
        with np.load(path) as file:
            return cls(*(file[key] for key in keys), site)

    def _own(self, k):
        """What the force densities of a wave are, `[s, 3, s, 3]` with the sign of a stiffness: one point stands for each site."""
        count = self.site.max() + 1
        of = np.zeros((count, 3, count, 3), dtype=complex)
        for s in range(count):
            i = int(np.flatnonzero(self.site == s)[0])
            bonds = slice(self.start[i], self.start[i + 1])
            block, to = self.block[bonds], self.site[self.partner[bonds]]
            of[s, :, s, :] += block.sum(axis=0)
            turned = np.exp(1j * self.bond[bonds] @ k)[:, None, None] * block
            np.subtract.at(of.transpose(2, 0, 1, 3)[:, s], to, turned)
        return of

    def squares(self, k):
        """ω² of the waves with wave vector k [3] (1 / length), ascending (1 / time²): one for each site and axis."""
        of = self._own(np.asarray(k, dtype=float))
        count = len(of)
        first = [int(np.flatnonzero(self.site == s)[0]) for s in range(count)]
        root = np.repeat(np.sqrt(self.density[first]), 3)
        of = of.reshape(3 * count, 3 * count) / np.outer(root, root)
        return np.linalg.eigvalsh(0.5 * (of + of.conj().T))

    def _long(self, k):
        """Stiffness of a long wave per length², its sites relaxed, `[3, 3]`."""
        small = 1e-3 / np.linalg.norm(self.bond, axis=1).max()
        of = self._own(small * np.asarray(k))
        count = len(of)
        of = of.reshape(3 * count, 3 * count)
        together = np.kron(np.ones((count, 1)), np.eye(3)) / np.sqrt(count)
        stiff = together.T @ of @ together
        if count > 1:
            apart = np.linalg.qr(np.hstack([together, np.eye(3 * count)]))[0][:, 3 : 3 * count]
            mixed = apart.conj().T @ of @ together
            stiff = stiff - mixed.conj().T @ np.linalg.solve(apart.conj().T @ of @ apart, mixed)
        return stiff.real / small**2

    def stiffness(self):
        """Elastic constants [6, 6] (energy / volume) in Voigt's notation (xx yy zz yz xz xy), sites relaxed: what long waves say (Born & Huang 1954, section 27)."""
        waves = np.zeros((3, 3, 3, 3))
        unit = np.eye(3)
        for g in range(3):
            waves[:, :, g, g] = self._long(unit[g])
        for g, h in [(0, 1), (0, 2), (1, 2)]:
            both = 0.5 * (self._long(unit[g] + unit[h]) - waves[:, :, g, g] - waves[:, :, h, h])
            waves[:, :, g, h] = waves[:, :, h, g] = both
        c = np.empty((6, 6))
        for row, (a, g) in enumerate(VOIGT):
            for column, (b, h) in enumerate(VOIGT):
                c[row, column] = waves[a, b, g, h] + waves[b, g, a, h] - waves[b, h, a, g]
        return 0.5 * (c + c.T)

    def answer(self, force):
        """Displacements [N, 3] in which force densities [N, 3] that are alike in all cells are at rest."""
        of = self._own(np.zeros(3)).real
        count = len(of)
        of = of.reshape(3 * count, 3 * count)
        of = 0.5 * (of + of.T)
        mean = np.stack([force[self.site == s].mean(axis=0) for s in range(count)])
        # all together they may be anywhere
        return (np.linalg.pinv(of, rcond=1e-6, hermitian=True) @ mean.ravel()).reshape(count, 3)[self.site]

    def grown(self, factor):
        """The body of points `factor` times as far apart: mass density and elastic constants stay, and at k / factor waves have 1 / factor of the frequencies at k."""
        volume = factor**3 * self.volume
        return Crystal(
            factor * self.position, volume, self.density, factor * self.period, self.start, self.partner, self.block / factor**2, self.site
        )

    def repeated(self, times):
        """`times` [3] periods of it as one body."""
        times = np.asarray(times)
        cells = np.stack(np.unravel_index(np.arange(times.prod()), times), axis=-1)
        n, many = len(self.position), len(cells)
        to = np.ravel_multi_index(np.moveaxis((cells[:, None, :] + self.image) % times, -1, 0), times)
        starts = np.arange(many)[:, None] * self.start[-1] + self.start[None, :-1]
        return Crystal(
            (cells[:, None, :] * self.period + self.position).reshape(-1, 3),
            np.tile(self.volume, many),
            np.tile(self.density, many),
            self.period * times,
            np.append(starts.ravel(), many * self.start[-1]),
            (n * to + self.partner).ravel(),
            np.tile(self.block, (many, 1, 1)),
            np.tile(self.site, many),
        )

    def write(self, folder, name, title):
        """linear_body.npz and the deck `name` into a folder, which is made."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        # partners of a point ascend
        order = np.lexsort((self.partner, self.whose))
        np.savez(
            folder / "linear_body.npz",
            position=self.position,
            volume=self.volume,
            density=self.density,
            period=self.period,
            start=np.asarray(self.start, dtype=np.int64),
            partner=np.asarray(self.partner, dtype=np.int32)[order],
            block=self.block[order],
            asymmetry=np.array([0.0]),
        )
        x, y, z = (float(side) for side in self.period)
        text = f"""# {title}
title = {json.dumps(title, ensure_ascii=False)}
units = "metal"
body = {{ file = "linear_body.npz" }}
periodic = {{ x = {x!r}, y = {y!r}, z = {z!r} }}
material = {{ law = "micromoduli" }}
run = {{ steps = 0 }}
"""
        (folder / name).write_text(text)


def wavelengths(fine, coarse, direction, shortest, tolerances=(0.01, 0.05), count=400):
    """The wavelength below which frequencies of the acoustic branches differ by more than each tolerance, from long waves down to the length `shortest`; None: nowhere."""
    unit = np.asarray(direction) / np.linalg.norm(direction)
    waves = 2.0 * np.pi / shortest * np.arange(1, count + 1) / count
    apart = []
    for k in waves:
        # a wave that grows has no frequency
        a, b = (np.sqrt(np.where(s > 0.0, s, np.nan)) for s in (body.squares(k * unit)[:3] for body in (fine, coarse)))
        apart.append(np.nan_to_num(np.abs(a - b) / np.maximum(a, b), nan=np.inf).max())
    found = {}
    for tolerance in tolerances:
        first = np.flatnonzero(np.array(apart) > tolerance)
        found[tolerance] = float(2.0 * np.pi / waves[first[0]]) if len(first) else None
    return found
