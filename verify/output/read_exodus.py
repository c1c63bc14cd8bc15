"""Opens an Exodus file that peridyne wrote with readers of other people and compares it with the VTU and the history of the same run.

Usage: python read_exodus.py DIR      (DIR holds points.pvd, history.csv and one file *.e of the same frames)
Needs: pip install netCDF4 meshio pyvista numpy
"""

import csv
import pathlib
import sys

import meshio
import netCDF4
import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import vtkDataArray

SYMMETRIC = ["xx", "yy", "zz", "xy", "yz", "xz"]  # VTK's order
TENSOR = [a + b for a in "xyz" for b in "xyz"]


def names_of(data, name):
    return [str(n) for n in netCDF4.chartostring(data[name][:])]


def components(name, array):
    """The variables that an array of a VTU is: name and column."""
    name = {"displacement": "displ"}.get(name, name)
    if array.ndim == 1:
        return [(name, array)]
    suffixes = {3: "xyz", 6: SYMMETRIC, 9: TENSOR}[array.shape[1]]
    return [(f"{name}_{s}", array[:, k]) for k, s in enumerate(suffixes)]


def structure(data):
    n = len(data.dimensions["num_nodes"])
    assert data.data_model in ("NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"), data.data_model
    assert data.floating_point_word_size == 8
    points = []
    for k, block in enumerate(names_of(data, "eb_names"), 1):
        connect = data[f"connect{k}"]
        assert connect.elem_type == "SPHERE" and connect.shape[1] == 1
        radius, volume = data[f"attrib{k}"][:].T
        assert names_of(data, f"attrib_name{k}") == ["radius", "volume"]
        assert np.allclose(4 / 3 * np.pi * radius**3, volume, rtol=1e-14), f"{block}: radius and volume"
        points.extend(connect[:, 0])
    assert sorted(points) == list(range(1, n + 1)), "a point is not in one block"
    assert np.array_equal(data["elem_num_map"][:], points), "elements have other numbers than their points"
    assert np.array_equal(data["eb_prop1"][:], np.arange(1, len(data.dimensions["num_el_blk"]) + 1))
    if "ns_names" in data.variables:
        for k, name in enumerate(names_of(data, "ns_names"), 1):
            nodes = data[f"node_ns{k}"][:]
            assert nodes.min() >= 1 and nodes.max() <= n and len(set(nodes)) == len(nodes), name
    return n


def frames_as_vtu(folder, data):
    """Every number of every frame is that of the VTU."""
    names = names_of(data, "name_nod_var")
    series = pyvista.get_reader(folder / "points.pvd")
    times = [d.time for d in series.datasets]
    assert np.array_equal(data["time_whole"][:], times), "times of frames"
    compared = set()
    for frame, dataset in enumerate(series.datasets):
        mesh = pyvista.read(folder / dataset.path)
        reference = np.stack([data[f"coord{a}"][:] for a in "xyz"], axis=1)
        assert np.array_equal(reference + mesh["displacement"], mesh.points), "positions"
        for name in mesh.point_data:
            if name == "id":
                continue
            unit = mesh.GetPointData().GetArray(name).GetInformation().Get(vtkDataArray.UNITS_LABEL())
            for variable, column in components(name, np.asarray(mesh[name])):
                values = data[f"vals_nod_var{names.index(variable) + 1}"]
                assert np.array_equal(np.ma.getdata(values[frame]), column), f"{variable} of frame {frame}"
                assert getattr(values, "units", None) == unit, f"unit of {variable}"
                compared.add(variable)
    assert compared == set(names), f"variables that no VTU has: {set(names) - compared}"
    return len(times), len(names)


def globals_as_history(folder, data):
    names = names_of(data, "name_glo_var")
    values = np.ma.getdata(data["vals_glo_var"][:])
    with open(folder / "history.csv") as file:
        rows = list(csv.reader(file))
    header = [column.split(" [")[0].replace(" ", "_") for column in rows[0]]
    assert names == ["step", *header[2:]], f"{names} against {header}"
    lines = names_of(data, "info_records")
    units = [f"{name} [{column.split(' [')[1]}" for name, column in zip(header[2:], rows[0][2:]) if " [" in column]
    assert lines[len(lines) - len(units):] == units, f"lines of information: {lines}"
    history = {int(row[0]): [float(x) for x in row[2:]] for row in rows[1:]}
    compared = 0
    for frame in values:
        row = history.get(int(frame[0]))
        if row is not None:
            assert np.array_equal(frame[1:], row), f"row of step {frame[0]}"
            compared += 1
    assert compared > 0, "no frame has a row in the history"
    return compared


def as_vtk_reads(path, data):
    """VTK's reader of Exodus files, which ParaView has."""
    reader = pyvista.get_reader(path)
    times = data["time_whole"][:]
    assert np.allclose(reader.time_values, times, rtol=1e-15)
    reader.set_active_time_value(reader.time_values[-1])
    blocks = [b for b in reader.read()[0] if b is not None]
    assert sum(b.n_cells for b in blocks) == len(data.dimensions["num_nodes"])
    names = names_of(data, "name_nod_var")
    last = np.stack([data[f"vals_nod_var{names.index(f'displ_{a}') + 1}"][-1] for a in "xyz"], axis=1)
    start = 0
    for k, block in enumerate(blocks, 1):
        assert (block.celltypes == pyvista.CellType.VERTEX).all()
        own = data[f"connect{k}"][:, 0] - 1
        found = block.point_data[next(n for n in block.point_data if n.startswith("displ"))]
        wanted = {tuple(row) for row in np.ma.getdata(last[own])}
        assert {tuple(row) for row in np.asarray(found)} == wanted, f"displacements of block {k}"
        start += block.n_cells
    return sorted(blocks[0].point_data.keys())


def as_meshio_reads(path, data):
    mesh = meshio.read(path)
    assert len(mesh.points) == len(data.dimensions["num_nodes"])
    assert all(block.type == "vertex" for block in mesh.cells), [b.type for b in mesh.cells]
    assert np.array_equal(mesh.points, np.stack([data[f"coord{a}"][:] for a in "xyz"], axis=1))
    return len(mesh.cells)


def main():
    folder = pathlib.Path(sys.argv[1])
    (path,) = folder.glob("*.e")
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        points = structure(data)
        frames, variables = frames_as_vtu(folder, data)
        rows = globals_as_history(folder, data)
        print(f"{path}: {points} points, {frames} frames of {variables} variables equal the VTU bit for bit, {rows} rows the history")
        print(f"VTK reads {', '.join(as_vtk_reads(path, data))}; meshio {as_meshio_reads(path, data)} blocks of vertices")
    print("the file opens everywhere and holds what it should")


if __name__ == "__main__":
    main()
