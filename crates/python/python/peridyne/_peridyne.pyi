"""Types of what is written in Rust; shapes and units are in the docstrings (`help(peridyne.Simulation.column)`)."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .results import Run

__version__: str

class Error(Exception): ...

class DeckError(Error):
    message: str
    help: str | None
    file: str | None
    line: int | None

class RunError(Error):
    message: str
    step: int | None
    folder: str | None

class Every:
    """An observer at an interval of its own."""

    def __init__(self, interval: Interval, call: Callable[[Simulation], Any]) -> None: ...
    @property
    def interval(self) -> Interval: ...
    @property
    def call(self) -> Callable[[Simulation], Any]: ...

# steps; or a time, with its unit or as a float in that of the deck
Interval = int | float | str
# what answers True ends the run
Observe = Callable[["Simulation"], Any] | Every

class Deck:
    @staticmethod
    def from_toml(path: str | PathLike[str], *, set: Mapping[str, Any] | None = None) -> Deck: ...
    @staticmethod
    def from_text(text: str, *, folder: str | PathLike[str] | None = None, set: Mapping[str, Any] | None = None) -> Deck: ...
    @staticmethod
    def from_dict(deck: Mapping[str, Any], *, folder: str | PathLike[str] | None = None, set: Mapping[str, Any] | None = None) -> Deck: ...
    @property
    def text(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    def describe(self) -> str: ...
    def check(self, *, threads: int | None = None) -> dict[str, Any]: ...
    def simulation(self, *, threads: int | None = None) -> Simulation: ...
    def run(
        self,
        out: str | PathLike[str] | None = None,
        *,
        threads: int | None = None,
        progress: Callable[[int, int, float], Any] | None = None,
        observe: Observe | Sequence[Observe] | None = None,
        every: Interval | None = None,
        prepare: Callable[[Simulation], Any] | None = None,
        allow_outside: bool = False,
    ) -> Run: ...

class Simulation:
    @property
    def points(self) -> int: ...
    @property
    def dimension(self) -> int: ...
    @property
    def step_number(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def time_step(self) -> float: ...
    @property
    def broken_bonds(self) -> int: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    def step(self, n: int = 1) -> None: ...
    def column(self, name: str) -> npt.NDArray[Any]: ...
    def set_column(self, name: str, values: npt.ArrayLike) -> None: ...
    def add_force(
        self,
        call: Callable[[float, npt.NDArray[np.float64], npt.NDArray[np.float64]], npt.ArrayLike],
        *,
        set: str = "all",
        every: int = 1,
    ) -> None: ...
    def add_motion(
        self,
        call: Callable[[float, npt.NDArray[np.float64]], npt.ArrayLike],
        *,
        set: str = "all",
        axes: str | None = None,
        of: Literal["displacement", "velocity"] = "displacement",
    ) -> None: ...
    def describe(self, name: str) -> str: ...
    def members(self, set: str) -> npt.NDArray[np.uint32]: ...
    def probes(self) -> dict[str, float]: ...
    def energies(self) -> dict[str, float]: ...
    def virial(self) -> list[float]: ...
    def fragments(self) -> int: ...
    def state_hash(self) -> tuple[str, str | None]: ...

def resume(
    folder: str | PathLike[str],
    *,
    threads: int | None = None,
    progress: Callable[[int, int, float], Any] | None = None,
    observe: Observe | Sequence[Observe] | None = None,
    every: Interval | None = None,
    prepare: Callable[[Simulation], Any] | None = None,
    allow_outside: bool = False,
) -> Run: ...
def program(words: Sequence[str]) -> int: ...
