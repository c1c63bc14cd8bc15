"""peridyne and ASE: its potentials as calculators, and any calculator as the finest level of a body of springs.

    from ase.build import bulk
    from peridyne.ase import Potential

    atoms = bulk("Si", "diamond", a=5.431, cubic=True) * (2, 2, 2)
    atoms.calc = Potential({"stillinger_weber": {"file": "Si.sw"}})
    atoms.get_potential_energy()

Lengths are in Å, energies in eV, as ASE has them.
"""

import tempfile
from pathlib import Path

import numpy as np
from ase import Atoms
from ase.calculators.calculator import Calculator, all_changes
from ase.io import write

from ._peridyne import Deck

# eV ps²/Å² in a unified atomic mass unit: CODATA 2018, 1.66053906660e-27 kg over 1.602176634e-23 kg
AMU = 1.66053906660e-27 / 1.602176634e-23


def _orthogonal(atoms):
    cell = atoms.cell.array
    if atoms.pbc.any() and np.abs(cell - np.diag(np.diag(cell))).max() > 1e-9 * np.abs(cell).max():
        raise ValueError("the cell is not a box along x, y and z: peridyne has periods along the axes; take a rectangular supercell")
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
        # as whole numbers in the first period
        return [tuple(x) for x in np.floor(positions / sides % 1.0 * steps + 0.5).astype(int) % steps]

    at = {(kind, place): n for n, (kind, place) in enumerate(zip(atoms.numbers, places(atoms.positions)))}
    found = []
    for n in np.flatnonzero(atoms.numbers == atoms.numbers[0]):
        moved = places(atoms.positions + atoms.positions[n] - atoms.positions[0])
        to = [at.get(one) for one in zip(atoms.numbers, moved)]
        if None not in to:
            found.append(to)
    return np.array(found)


def linear_body(atoms, folder, *, step=0.01, cutoff=None):
    """The linear body of a crystal about its atoms of now, by their calculator: level 0 of `peridyne coarsen`.

    Forces under displacements of ±`step` (Å) of every atom along every axis, but for those that a translation of the crystal maps onto another, give the micromoduli, bond by bond; those of bonds longer than `cutoff` (Å; half the
    least period if it is left out) are left out, and each atom is held by what its bonds leave: a uniform translation needs no force. Writes
    linear_body.npz and level0.toml into the folder.

    Answers the error card, a dictionary: `residual` (largest force of the reference, eV/Å), `anharmonicity` (largest change of a micromodulus between the
    full step and half of it, over the largest micromodulus, of the first atom), `asymmetry` (largest difference of H and its transpose over the
    largest entry, before the mean of both is taken), `cut` (largest entry beyond the cutoff over the largest), `translation` (force of a
    uniform translation before it is taken away, over the largest entry).
    """
    sides = _orthogonal(atoms)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if not atoms.pbc.all():
        raise ValueError("linear_body takes crystals with three periods")
    if step <= 0:
        raise ValueError(f"step={step}: expected a positive length in Å")
    n = len(atoms)
    moved = atoms.copy()
    moved.calc = atoms.calc

    def column(i, a, step):
        pulls = []
        for way in (1.0, -1.0):
            moved.positions[i, a] = atoms.positions[i, a] + way * step
            pulls.append(moved.get_forces())
        moved.positions[i, a] = atoms.positions[i, a]
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
    half = np.stack([column(0, a, 0.5 * step) for a in range(3)], axis=-1)
    anharmonicity = float(np.abs(half - hessian[:, :, 0, :]).max()) / largest
    flat = hessian.reshape(3 * n, 3 * n)
    asymmetry = float(np.abs(flat - flat.T).max()) / largest
    hessian = (0.5 * (flat + flat.T)).reshape(n, 3, n, 3)
    translation = float(np.abs(hessian.sum(axis=2)).max()) / largest
    apart = atoms.positions[None, :, :] - atoms.positions[:, None, :]
    apart -= sides * np.round(apart / sides)
    distance = np.linalg.norm(apart, axis=2)
    reach = 0.5 * sides.min() * (1.0 - 1e-9) if cutoff is None else cutoff
    if reach > 0.5 * sides.min():
        raise ValueError(f"cutoff={cutoff}: expected at most half the least period, {0.5 * sides.min():g} Å: bonds are to the nearest image")
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
    np.savez(
        folder / "linear_body.npz",
        position=atoms.positions,
        volume=volume,
        density=atoms.get_masses() * AMU / volume,
        period=sides,
        start=np.array(start, dtype=np.int64),
        partner=np.array(partner, dtype=np.int32),
        block=np.array(block).reshape(-1, 3, 3),
        asymmetry=np.array([0.0]),
    )
    deck = f"""# The linear body of {atoms.get_chemical_formula()} by {type(atoms.calc).__name__} (ASE)
title = "{atoms.get_chemical_formula()}"
units = "metal"
body = {{ file = "linear_body.npz" }}
periodic = {{ x = {float(sides[0])!r}, y = {float(sides[1])!r}, z = {float(sides[2])!r} }}
material = {{ law = "micromoduli" }}
run = {{ steps = 0 }}
"""
    (folder / "level0.toml").write_text(deck)
    card = {"residual": residual, "anharmonicity": anharmonicity, "asymmetry": asymmetry, "cut": cut, "translation": translation}
    return card
