"""What a run wrote."""

import csv
import html
import json
import warnings
from pathlib import Path

import numpy as np


#: Columns that had another name in version 0.1.
RENAMED = {
    "released energy": "energy dissipated by bond breakage",
    "energy made by breaking": "energy created by bond breakage",
    "work of conditions": "work of boundary conditions",
    "work of indenters": "work of rigid bodies",
    "energy residual": "energy balance error",
}


class Columns(dict):
    """Columns by name; names of version 0.1 are taken with a warning."""

    def __missing__(self, name):
        if name == "broken_directed_bonds" and "broken_bonds" in self:
            warnings.warn("the column 'broken_directed_bonds' is 'broken_bonds' now, each bond once", DeprecationWarning, stacklevel=2)
            return self["broken_bonds"] * 2
        new = RENAMED.get(name)
        if new is None or new not in self:
            raise KeyError(name)
        warnings.warn(f"the column {name!r} is called {new!r} now", DeprecationWarning, stacklevel=2)
        return self[new]


class Run:
    """The results of a run, in their folder. Shown as its report in a notebook."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "run.json").is_file():
            raise FileNotFoundError(f"{self.folder}: no run.json: this is no folder of results")

    def __repr__(self):
        return f"<peridyne.Run in {str(self.folder)!r}: {self.record['status']}>"

    @property
    def record(self):
        """What the run says of itself (`run.json`): status, steps, energies, hashes, warnings, versions."""
        return json.loads((self.folder / "run.json").read_text())

    def _history(self):
        with open(self.folder / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
        titles = [title.partition(" [") for title in rows[0]]
        names = [name for name, _, _ in titles]
        units = [unit.removesuffix("]") for _, _, unit in titles]
        number = lambda text: float(text) if text else np.nan
        table = np.array([[number(x) for x in row] for row in rows[1:]]).reshape(-1, len(names))
        return names, units, table

    @property
    def history(self):
        """`history.csv`: an array over rows by the name of its column, without the unit."""
        names, _, table = self._history()
        return Columns({name: table[:, n] for n, name in enumerate(names)})

    @property
    def units(self):
        """The unit of each column of the history; "" where it has none."""
        names, units, _ = self._history()
        return Columns(zip(names, units))

    @property
    def frames(self):
        """Files of the frames (VTU, for pyvista, meshio or ParaView), in their order."""
        return sorted(self.folder.glob("points_*.vtu"))

    @property
    def pictures(self):
        """Files of the pictures."""
        return sorted(self.folder.glob("*.png"))

    def _repr_html_(self):
        report = self.folder / "report.html"
        if not report.is_file():
            return f"<pre>{html.escape(repr(self))}</pre>"
        page = html.escape(report.read_text(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 700px; border: 0"></iframe>'
