"""peridyne and ASE: its potentials as calculators, and any calculator as the finest level of a body of springs.

    from ase.build import bulk
    from peridyne.ase import Potential

    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * (2, 2, 2)
    atoms.calc = Potential({"stillinger_weber": {"file": "Si.sw"}})
    atoms.get_potential_energy()

Lengths are in Å, energies in eV, as ASE has them.
"""

import json
import tempfile
from pathlib import Path

import numpy as np
from ase import Atoms
from ase.calculators.calculator import Calculator, PropertyNotImplementedError, all_changes
from ase.io import write

from ._peridyne import Deck
from .crystal import VOIGT, Crystal, wavelengths

# a unified atomic mass unit in kg (CODATA 2018), and in eV ps²/Å², which is 1.602176634e-23 kg
AMU_KG = 1.66053906660e-27
AMU = AMU_KG / 1.602176634e-23


class NoBox(ValueError):
    """The cell is not a box along x, y and z."""


def _orthogonal(atoms):
    cell = atoms.cell.array
    if atoms.pbc.any() and np.abs(cell - np.diag(np.diag(cell))).max() > 1e-9 * np.abs(cell).max():
        raise NoBox("the cell is not a box along x, y and z: peridyne has periods along the axes; take a rectangular supercell")
    return np.diag(cell)


class Potential(Calculator):
    """A potential of peridyne.

    law: as `material.law` of a deck has it, or for several elements a dictionary of laws by symbol; files are relative to `folder`.
    keys: further tables of the deck, such as {"pair": [...]}.
    Energy [eV], forces [N, 3] (eV/Å), stress [6] (eV/Å³, xx yy zz yz xz xy), positive in tension. The periods of the cell lie along the axes.
    Raises peridyne.DeckError where law or atoms are wrong.
    """

    implemented_properties = ["energy", "free_energy", "forces", "stress"]
    ignored_changes = {"initial_magmoms", "initial_charges"}

    def __init__(self, law, *, folder=".", keys=None, threads=None, **more):
        super().__init__(**more)
        self._law, self._folder, self._keys, self._threads = law, Path(folder).resolve(), keys or {}, threads
        self._simulation = None

    def _materials(self, symbols, masses):
        kinds = list(dict.fromkeys(symbols))
        of = dict(zip(symbols, masses))
        by_symbol = set(self._law) >= set(kinds) and all(isinstance(v, dict) for v in self._law.values())
        laws = self._law if by_symbol else {kind: self._law for kind in kinds}
        return {kind: {"mass": float(of[kind]), "law": laws[kind]} for kind in kinds}

    def _build(self, atoms):
        sides = _orthogonal(atoms)
        symbols = atoms.get_chemical_symbols()
        materials = self._materials(symbols, atoms.get_masses())
        kinds = list(materials)
        plain = Atoms(symbols, atoms.positions, cell=np.diag(sides), pbc=True)
        if not atoms.pbc.all():
            # axes without periods have sides that hold all atoms
            free = ~atoms.pbc
            low, high = atoms.positions.min(axis=0), atoms.positions.max(axis=0)
            plain.positions[:, free] += (1.0 - low)[free]
            plain.set_cell(np.diag(np.where(free, high - low + 2.0, sides)))
            plain.pbc = atoms.pbc
        with tempfile.TemporaryDirectory(dir=self._folder) as folder:
            path = Path(folder) / "atoms.extxyz"
            write(path, plain, format="extxyz")
            deck = {
                "units": "metal",
                "body": {"file": f"{path.parent.name}/{path.name}"},
                "material": materials if len(kinds) > 1 else next(iter(materials.values())),
                "run": {"steps": 0, "time_step": 0.001},
                **self._keys,
            }
            self._simulation = Deck.from_dict(deck, folder=self._folder).simulation(threads=self._threads)
        # files have eight decimals, and atoms may lie in another period
        self._reference = self._simulation.column("reference") - (plain.positions - atoms.positions)
        self._volume = self._simulation.column("volume")

    def calculate(self, atoms=None, properties=("energy",), system_changes=all_changes):
        super().calculate(atoms, properties, system_changes)
        atoms = self.atoms
        if self._simulation is None or set(system_changes) - {"positions"}:
            self._build(atoms)
        self._simulation.set_column("displacement", atoms.positions - self._reference)
        energies = self._simulation.energies()
        energy = energies["strain"] + energies["contact"]
        forces = self._simulation.column("force_density") * self._volume[:, None]
        self.results = {"energy": energy, "free_energy": energy, "forces": forces}
        if atoms.pbc.all():
            xx, yy, zz, xy, xz, yz = self._simulation.virial()
            self.results["stress"] = -np.array([xx, yy, zz, yz, xz, xy]) / atoms.get_volume()


def _translations(atoms, sides, tolerance=1e-4):
    """Where each atom goes by the translations that bring the crystal onto itself, one row for each, the first of which moves none."""
    steps = np.rint(sides / tolerance).astype(int)

    def places(positions):
        # as whole numbers in the first period, from the first atom on; sites lie at simple fractions of a cell, and no such part is halfway to one
        return [tuple(x) for x in np.floor((positions - atoms.positions[0]) / sides % 1.0 * steps + 0.381966).astype(int) % steps]

    at = {(kind, place): n for n, (kind, place) in enumerate(zip(atoms.numbers, places(atoms.positions)))}
    found = []
    for n in np.flatnonzero(atoms.numbers == atoms.numbers[0]):
        moved = places(atoms.positions + atoms.positions[n] - atoms.positions[0])
        to = [at.get(one) for one in zip(atoms.numbers, moved)]
        if None not in to:
            found.append(to)
    return np.array(found)


def _sites(translations):
    """The number of each atom's site in the cell: who is a translation of whom."""
    site = np.unique(translations.min(axis=0), return_inverse=True)[1].ravel()
    # where translations are no group, by atoms that are a little off, every atom is a site of its own
    whole = len(site) == len(translations) * (site.max() + 1)
    return site if whole else np.arange(len(site))


def _springs(atoms, step, cutoff):
    """The linear body of a crystal, and its error card."""
    sides = _orthogonal(atoms)
    if not atoms.pbc.all():
        raise ValueError("linear_body takes crystals with three periods")
    if not (step > 0 and np.isfinite(step)):
        raise ValueError(f"step={step}: expected a positive length in Å")
    reach = 0.5 * sides.min() * (1.0 - 1e-9) if cutoff is None else cutoff
    if not 0.0 < reach <= 0.5 * sides.min():
        raise ValueError(f"cutoff={cutoff}: expected at most half the least period, {0.5 * sides.min():g} Å: bonds are to the nearest image")
    n = len(atoms)
    moved = atoms.copy()
    moved.calc = atoms.calc

    def column(i, a, step):
        pulls = []
        for way in (1.0, -1.0):
            moved.positions[i, a] = atoms.positions[i, a] + way * step
            pulls.append(moved.get_forces())
        moved.positions[i, a] = atoms.positions[i, a]
        if not np.isfinite(pulls).all():
            raise ValueError(f"{type(atoms.calc).__name__}: a force on an atom is not a finite number")
        return (pulls[1] - pulls[0]) / (2.0 * step)

    residual = float(np.abs(atoms.get_forces()).max())
    hessian = np.full((n, 3, n, 3), np.nan)
    translations = _translations(atoms, sides)
    for i in range(n):
        if not np.isnan(hessian[0, 0, i, 0]):
            continue
        own = np.stack([column(i, a, step) for a in range(3)], axis=-1)
        for to in translations:
            hessian[to, :, to[i], :] = own
    largest = float(np.abs(hessian).max())
    if not largest > 0.0:
        raise ValueError(f"{type(atoms.calc).__name__}: no force depends on the place of another atom")
    half = np.stack([column(0, a, 0.5 * step) for a in range(3)], axis=-1)
    anharmonicity = float(np.abs(half - hessian[:, :, 0, :]).max()) / largest
    flat = hessian.reshape(3 * n, 3 * n)
    asymmetry = float(np.abs(flat - flat.T).max()) / largest
    hessian = (0.5 * (flat + flat.T)).reshape(n, 3, n, 3)
    translation = float(np.abs(hessian.sum(axis=2)).max()) / largest
    apart = atoms.positions[None, :, :] - atoms.positions[:, None, :]
    apart -= sides * np.round(apart / sides)
    distance = np.linalg.norm(apart, axis=2)
    size = np.abs(hessian).max(axis=(1, 3))
    beyond = size[distance > reach]
    cut = float(beyond.max()) / largest if beyond.size else 0.0
    volume = np.full(n, atoms.get_volume() / n)
    start, partner, block = [0], [], []
    for i in range(n):
        bonds = np.flatnonzero((distance[i] <= reach) & (size[i] > 1e-12 * largest) & (np.arange(n) != i))
        partner.extend(bonds)
        block.extend(-hessian[i, :, j, :] / volume[i] for j in bonds)
        start.append(len(partner))
    body = Crystal(
        atoms.positions.copy(),
        volume,
        atoms.get_masses() * AMU / volume,
        sides.copy(),
        np.array(start),
        np.array(partner, dtype=int),
        np.array(block).reshape(-1, 3, 3),
        _sites(translations),
    )
    card = {"residual": residual, "anharmonicity": anharmonicity, "asymmetry": asymmetry, "cut": cut, "translation": translation}
    return body, card


def _title(atoms):
    return f"{atoms.get_chemical_formula(empirical=True)} by {type(atoms.calc).__name__}"


def linear_body(atoms, folder, *, step=0.01, cutoff=None, repeat=(1, 1, 1)):
    """The linear body of a crystal about its atoms of now, by their calculator: level 0 of `peridyne coarsen`.

    Forces under displacements of ±`step` (Å) of every atom along every axis, but for those that a translation of the crystal maps onto another, give the micromoduli, bond by bond; those of bonds longer than `cutoff` (Å; half the
    least period if it is left out) are left out, and each atom is held by what its bonds leave: a uniform translation needs no force. Writes
    linear_body.npz and level0.toml into the folder, of `repeat` periods of the atoms along each axis.

    Answers the error card, a dictionary: `residual` (largest force of the reference, eV/Å), `anharmonicity` (largest change of a micromodulus between the
    full step and half of it, over the largest micromodulus, of the first atom), `asymmetry` (largest difference of H and its transpose over the
    largest entry, before the mean of both is taken), `cut` (largest entry beyond the cutoff over the largest), `translation` (force of a
    uniform translation before it is taken away, over the largest entry).
    """
    repeat = _times(repeat)
    body, card = _springs(atoms, step, cutoff)
    body.repeated(repeat).write(folder, "level0.toml", _title(atoms))
    return card


def _times(repeat):
    times = np.asarray(repeat)
    if times.shape != (3,) or times.dtype.kind not in "iu" or (times < 1).any():
        raise ValueError(f"repeat={repeat!r}: expected three whole numbers of 1 or more")
    return times


def _strained_stiffness(atoms, body, *, strain=1e-3, force=1e-4):
    """Elastic constants [6, 6] (eV/Å³, Voigt's xx yy zz yz xz xy) of a crystal by the stresses of its calculator under strains of ±`strain`; sites relax by the stiffness of `body` until no force
    is above `force` (eV/Å). NaN in the columns of shears that the calculator cannot take (`Potential` takes boxes alone)."""
    c = np.empty((6, 6))
    for column, (a, b) in enumerate(VOIGT):
        stresses = []
        for way in (1.0, -1.0):
            turned = np.eye(3)
            turned[a, b] += 0.5 * way * strain
            turned[b, a] += 0.5 * way * strain
            moved = atoms.copy()
            moved.set_cell(atoms.cell.array @ turned, scale_atoms=True)
            moved.calc = atoms.calc
            try:
                _relax(moved, body, force)
            except NoBox:
                stresses.append(np.full(6, np.nan))
            else:
                stresses.append(moved.get_stress())
        c[:, column] = (stresses[0] - stresses[1]) / (2.0 * strain)
    # action is reaction, where both are known
    return np.where(np.isnan(c + c.T), c, 0.5 * (c + c.T))


def _relax(atoms, body, force):
    """Sites of a cell that is strained a little come to rest by Newton's method."""
    for _ in range(20):
        forces = atoms.get_forces()
        if np.abs(forces).max() <= force:
            return
        atoms.positions += body.answer(forces / body.volume[:, None])
    raise ValueError(f"{type(atoms.calc).__name__}: the sites of the cell do not come to rest under a small strain: relax the atoms first")


# eV/Å³ in GPa
GPA = 160.2176634
DIRECTIONS = {"x": (1, 0, 0), "xy": (1, 1, 0), "xyz": (1, 1, 1)}


# cells of a periodic block in which every bond of a solid has one nearest image: a gradient of bonds reaches two horizons of two spacings
BLOCK = 9


def _solid(body, stiffness, factor, title):
    """The deck of a solid with these constants (GPa) and as many points as the upscaled body has."""
    upper = [float(stiffness[i, j]) for i in range(6) for j in range(i, 6)]
    largest = max(map(abs, upper))
    spacing = factor * float(body.volume.mean()) ** (1 / 3)
    return Deck.from_dict(
        {
            "title": title,
            "units": "metal",
            "periodic": ["x", "y", "z"],
            "horizon": {"m_ratio": 2},
            "body": {"lattice": "cubic", "spacing": spacing, "cells": [BLOCK] * 3},
            "material": {
                "density": f"{float(body.density.mean()) / AMU * AMU_KG * 1e30!r} kg/m^3",
                # what rounding leaves of a symmetry is left out
                "law": {"anisotropic": {"stiffness": [f"{c!r} GPa" if abs(c) > 1e-6 * largest else 0.0 for c in upper], "gradient": "bond"}},
            },
            "run": {"steps": 0, "time_step": 0.001},
        }
    )


def _solid_card(deck, body, factor):
    """How far waves and constants of a solid are from those of a crystal."""
    plain = {"output.linear_body": True, "output.picture": False, "output.vtu": False, "output.report": False}
    with tempfile.TemporaryDirectory() as out:
        Deck.from_text(deck.text, set=plain).run(out)
        solid = Crystal.read(Path(out) / "linear_body.npz", np.zeros(BLOCK**3, dtype=int))
    return {"stiffness": (GPA * solid.stiffness()).tolist(), "waves": _waves(body, solid, 2.0 * factor * float(body.volume.mean()) ** (1 / 3))}


def _waves(fine, coarse, shortest):
    found = {name: wavelengths(fine, coarse, direction, shortest) for name, direction in DIRECTIONS.items()}
    return {name: {f"{100 * tolerance:g} %": length for tolerance, length in of.items()} for name, of in found.items()}


def upscale(atoms, folder, *, factor=2, step=0.01, cutoff=None, repeat=(1, 1, 1), solid=False):
    """Coarse peridynamic points for a crystal of any calculator, with an error card: what `peridyne upscale` does for the potentials that it knows.

    The forces of `linear_body` are bonds of the crystal. Points `factor` times as far apart have the same shells of neighbours: lengths are multiplied by the factor,
    energies by its cube, so mass density and elastic constants stay, and waves as long as many spacings do. (`peridyne upscale` of a potential keeps its energy under every strain;
    of a black box only what it is to second order is known, and the model is linear.)

    Writes into the folder `fine/level0.toml`, `h<factor>/coarse.toml`, each with a linear_body.npz of `repeat` periods along each axis, and `h<factor>/card.json`: the card, which is
    answered. It has what the card of `linear_body` has, and

    - `pressure` of the reference (GPa),
    - `stiffness` [6][6] of the coarse points and `stiffness_calculator` [6][6] of the calculator under finite strains (GPa, Voigt's xx yy zz yz xz xy; None where it takes no such
      strain), and `stiffness_error`, their largest difference over the largest constant; None where the calculator knows no stress,
    - `waves`: along x, xy and xyz of the cell the wavelengths (Å) below which a frequency of the coarse points is off by more than 1 % and 5 %; None: nowhere down to the shortest
      wave of the coarse points,
    - `unstable`: the largest part ω² of a wave that grows over the largest that does not, among these directions; 0 where none does,
    - `cost`: points times steps of the fine body over those of the coarse one,
    - `solid`, where it is asked for: `stiffness` [6][6] (GPa) and `waves`, as above, of `h<factor>/solid.toml`: a peridynamic solid for large motion and fracture, `anisotropic` with the
      elastic constants and the density of the crystal, on a cubic lattice of as many points; it keeps nothing of the shells, so waves part from those of the crystal sooner. It
      wants a crystal without pressure.
    """
    if isinstance(factor, bool) or not isinstance(factor, (int, np.integer)) or factor < 2:
        raise ValueError(f"factor={factor!r}: expected a whole number of 2 or more")
    repeat = _times(repeat)
    folder = Path(folder)
    body, card = _springs(atoms, step, cutoff)
    coarse = body.grown(factor)
    shortest = 2.0 * factor * np.linalg.norm(body.bond, axis=1).min()
    lowest, highest = 0.0, 0.0
    for direction in DIRECTIONS.values():
        unit = np.asarray(direction) / np.linalg.norm(direction)
        squares = np.concatenate([body.squares(k * unit) for k in np.linspace(0.0, factor * np.pi / shortest, 33)[1:]])
        lowest, highest = min(lowest, squares.min()), max(highest, squares.max())
    stiffness = GPA * coarse.stiffness()
    try:
        pressure = -GPA * float(atoms.get_stress()[:3].mean())
        theirs = GPA * _strained_stiffness(atoms, body)
    except PropertyNotImplementedError:
        pressure = theirs = None
    card |= {
        "factor": int(factor),
        "pressure": pressure,
        "stiffness": stiffness.tolist(),
        "stiffness_calculator": None if theirs is None else [[None if np.isnan(c) else c for c in row] for row in theirs.tolist()],
        "stiffness_error": None if theirs is None else float(np.nanmax(np.abs(stiffness - theirs)) / np.nanmax(np.abs(theirs))),
        "waves": _waves(body, coarse, shortest),
        "unstable": float(-lowest / highest) if lowest < -1e-9 * highest else 0.0,
        "cost": float(factor**4),
    }
    title = _title(atoms)
    coarser = folder / f"h{factor}"
    deck = _solid(body, stiffness, factor, f"{title}, a solid") if solid else None
    if deck:
        card["solid"] = _solid_card(deck, body, factor)
    body.repeated(repeat).write(folder / "fine", "level0.toml", title)
    coarse.repeated(repeat).write(coarser, "coarse.toml", f"{title}, upscaled {factor} times")
    if deck:
        (coarser / "solid.toml").write_text(deck.text)
    (coarser / "card.json").write_text(json.dumps(card, indent=1))
    return card
