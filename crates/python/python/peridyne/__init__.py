"""Molecular dynamics and peridynamics as one mechanics: points that talk to a family of points.

    import peridyne

    deck = peridyne.Deck.from_toml("crack.toml", set={"run.steps": 400})
    run = deck.run("out")
    print(run.record["broken_bonds"], run.history["kinetic energy"][-1])

`Deck` reads decks, `Deck.run` runs one and writes its results, which a `Run` knows; `Deck.simulation` gives a model to lead step by step, with its
columns as arrays of NumPy. `peridyne.ase` has calculators for ASE. The program itself is `python -m peridyne`.
"""

from ._peridyne import Deck, DeckError, Error, Every, RunError, Simulation, __version__, resume
from .bar import progress_bar
from .results import Run

__all__ = ["Deck", "DeckError", "Error", "Every", "Run", "RunError", "Simulation", "__version__", "progress_bar", "resume"]
