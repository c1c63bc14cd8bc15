"""Count broken bonds in the dumps of `in.impact`."""
import os
import re
import zlib

import numpy as np

SPACING, HORIZON = 0.0005, 0.0015001


def frames(path):
    """Yield `(step, rows)` of a text dump; rows is an array `[N, columns]`."""
    with open(path) as file:
        while file.readline():
            step = int(file.readline())
            file.readline()
            count = int(file.readline())
            for _ in range(5):
                file.readline()
            yield step, np.loadtxt(file, max_rows=count, ndmin=2)


def family_sizes(position):
    """Number of partners with r² <= δ² of every site of a simple cubic lattice.

    The sites are found by integers, the distance is taken between the positions themselves, so that the
    count is LAMMPS's own even where round-off would decide.
    """
    site = np.rint(position / SPACING).astype(int)
    reach = int(np.ceil(HORIZON / SPACING))
    low = site.min(axis=0) - reach
    shape = site.max(axis=0) + reach + 1 - low
    index = np.full(shape, -1)
    index[tuple((site - low).T)] = np.arange(len(site))
    size = np.zeros(len(site), dtype=int)
    steps = range(-reach, reach + 1)
    for offset in ((i, j, k) for i in steps for j in steps for k in steps):
        if offset == (0, 0, 0):
            continue
        partner = index[tuple((site - low + offset).T)]
        d = position - position[partner]
        size += (partner >= 0) & (np.einsum("ij,ij->i", d, d) <= HORIZON * HORIZON)
    return size


def thermo(text):
    """The rows `step: (pe, ke)` of LAMMPS's thermo output, as printed."""
    rows = {}
    for line in text.splitlines():
        word = line.split()
        if len(word) == 3 and re.fullmatch(r"\d+", word[0]):
            rows[int(word[0])] = (word[1], word[2])
    return rows


def write(out, folder, text, version, variables):
    """Write the table of one impact."""
    (_, sites), = [f for f in frames(os.path.join(folder, "sites.dump")) if f[0] == 0]
    size = family_sizes(sites[:, 1:4])
    bonds = int(re.search(r"total # of bonds = (\d+)", text).group(1))
    if size.sum() != bonds:
        raise SystemExit(f"counted {size.sum()} directed bonds, LAMMPS built {bonds}")
    energy = thermo(text)
    rows = []
    for step, damage in frames(os.path.join(folder, "damage.dump")):
        count = damage[:, 1] * size
        broken = np.rint(count).astype(int)
        if abs(count - broken).max() > 1e-6:
            raise SystemExit(f"step {step}: damage times family size is not a whole number")
        rows.append(f"{step},{broken.sum()},{(broken > 0).sum()},{energy[step][0]},{energy[step][1]}")
    crc = zlib.crc32(broken.astype("<u2").tobytes())
    histogram = " ".join(f"{k}:{n}" for k, n in enumerate(np.bincount(broken)) if n)
    with open(out, "w") as file:
        file.write(
            f"# LAMMPS {version}; in.impact, "
            + ", ".join(f"{k} = {v}" for k, v in variables.items())
            + f"\n# {len(size)} particles, {bonds} directed bonds\n"
            "# broken: directed broken bonds; damaged: particles with at least one; pe, ke: LAMMPS's sums of densities\n"
            f"# final broken bonds per particle, count:particles: {histogram}\n"
            f"# final crc32 of broken bonds per particle, by id, as little-endian u16: {crc:08x}\n"
            "step,broken,damaged,pe,ke\n" + "\n".join(rows) + "\n"
        )
