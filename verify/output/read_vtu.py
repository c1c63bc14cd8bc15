"""Opens what peridyne wrote with VTK's own readers and checks it.

Usage: python read_vtu.py DIR      (DIR holds points.pvd and perhaps bonds.pvd)
Needs: pip install pyvista numpy
"""

import pathlib
import sys

import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import vtkDataArray

VECTORS = {"displacement", "velocity"}
UNITS = {"displacement": "m", "velocity": "m/s", "damage": None, "energy_density": "Pa", "volume": "m^3", "id": None}  # of SI


def check_points(path, time):
    mesh = pyvista.read(path)
    n = mesh.n_points
    assert mesh.n_cells == n, f"{path}: {mesh.n_cells} cells for {n} points"
    assert (mesh.celltypes == pyvista.CellType.VERTEX).all(), f"{path}: not all cells are vertices"
    assert mesh.field_data["TimeValue"][0] == time, f"{path}: time {mesh.field_data['TimeValue'][0]}, listed {time}"
    check_arrays(path, mesh)
    assert np.array_equal(mesh["id"], np.arange(1, n + 1)), f"{path}: id is not 1, 2, ..."
    damage = mesh["damage"]
    assert damage.min() >= 0.0 and damage.max() <= 1.0, f"{path}: damage leaves [0, 1]"
    return mesh


def check_bonds(path, time):
    mesh = pyvista.read(path)
    assert (mesh.celltypes == pyvista.CellType.LINE).all(), f"{path}: not all cells are lines"
    assert mesh.field_data["TimeValue"][0] == time
    check_arrays(path, mesh)
    ends = mesh.cell_connectivity.reshape(-1, 2)
    assert (ends[:, 0] < ends[:, 1]).all() and ends.max() < mesh.n_points, f"{path}: ends of bonds"
    return mesh


def check_arrays(path, mesh):
    for name in mesh.point_data:
        shape = (mesh.n_points, 3) if name in VECTORS else (mesh.n_points,)
        assert mesh[name].shape == shape, f"{path}: {name} is {mesh[name].shape}"
    for name in UNITS.keys() & set(mesh.point_data):
        said = mesh.GetPointData().GetArray(name).GetInformation().Get(vtkDataArray.UNITS_LABEL())
        assert said == UNITS[name], f"{path}: the unit of {name} is {said}"
    assert (mesh["volume"] > 0.0).all(), f"{path}: a point has no volume"
    assert np.isfinite(mesh.points).all(), f"{path}: positions that are not finite"


def check_series(pvd, check):
    reader = pyvista.get_reader(pvd)
    reference = None
    for data in reader.datasets:
        mesh = check(pvd.parent / data.path, data.time)
        start = mesh.points - mesh["displacement"]
        reference = start if reference is None else reference
        assert np.allclose(start, reference, rtol=0, atol=1e-9 * np.ptp(reference)), "the reference moved"
        print(f"{data.path}: t = {data.time:g}, {mesh.n_points} points, {mesh.n_cells} cells, "
              f"{', '.join(mesh.point_data)}")


def main():
    directory = pathlib.Path(sys.argv[1])
    check_series(directory / "points.pvd", check_points)
    if (directory / "bonds.pvd").exists():
        check_series(directory / "bonds.pvd", check_bonds)
    print("all files open and hold what they should")


if __name__ == "__main__":
    main()
