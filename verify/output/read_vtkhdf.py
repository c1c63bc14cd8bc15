"""Opens a VTKHDF file that peridyne wrote with readers of other people and compares it with the VTU frames of the same run, bit for bit.

Usage: python read_vtkhdf.py DIR      (DIR holds points.pvd and one file *.vtkhdf of the same frames)
Needs: pip install h5py pyvista numpy
"""

import pathlib
import sys

import h5py
import numpy as np
import pyvista
import vtk


def same(a, b):
    """The same kind, shape and bits; what is not a number, too."""
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.shape == b.shape and a.dtype.kind == b.dtype.kind and a.dtype.itemsize == b.dtype.itemsize and a.tobytes() == b.tobytes()


def frames_of(folder):
    """Times and grids of the series."""
    series = pyvista.get_reader(folder / "points.pvd")
    return [(d.time, pyvista.read(folder / d.path)) for d in series.datasets]


def structure(file, frames):
    """What the format asks for, read by the HDF5 library."""
    grid = file["VTKHDF"]
    kind = grid.attrs.get_id("Type")
    assert kind.dtype.kind == "S" and kind.get_type().get_cset() == h5py.h5t.CSET_ASCII, "Type is fixed ASCII"
    assert grid.attrs["Type"] == b"UnstructuredGrid"
    assert list(grid.attrs["Version"]) == [2, 6] and grid.attrs["Version"].dtype == np.int64
    steps = grid["Steps"]
    assert steps.attrs["NSteps"] == len(frames), f"{steps.attrs['NSteps']} steps, {len(frames)} frames"
    assert same(steps["Values"][:], np.array([time for time, _ in frames]))
    fields = [name for name in frames[0][1].point_data]
    assert sorted(grid["PointData"]) == sorted(steps["PointDataOffsets"]) == sorted(fields)
    data = grid["PointData"]
    for name, attribute in (("damage", b"Scalars"), ("displacement", b"Vectors")):
        assert name not in data or data[name].attrs["Attribute"] == attribute
    one = [1] * len(frames)
    assert list(steps["NumberOfParts"][:]) == one and set(steps["PartOffsets"][:]) <= {0}
    assert steps["FieldDataSizes/step"].shape == (len(frames), 2) and set(steps["FieldDataSizes/step"][:].ravel()) == {1}
    for k, (_, mesh) in enumerate(frames):
        n = mesh.n_points
        at = steps["PointOffsets"][k]
        assert same(grid["Points"][at : at + n], mesh.points), f"positions of frame {k}"
        assert list(grid["NumberOfPoints"][:]) == [n] == list(grid["NumberOfCells"][:]) == list(grid["NumberOfConnectivityIds"][:])
        for name in fields:
            at = steps["PointDataOffsets"][name][k]
            assert same(data[name][at : at + n], mesh.point_data[name]), f"{name} of frame {k}"
        step = file["VTKHDF/FieldData/step"][steps["FieldDataOffsets/step"][k]]
        assert step == mesh.field_data["step"][0], f"number of the step of frame {k}"
    return fields


def as_vtk_reads(path, frames):
    """VTK's reader, which ParaView has."""
    reader = vtk.vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    key = vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    times = reader.GetOutputInformation(0).Get(key) or ()
    assert len(frames) == 1 or same(np.array(times), np.array([time for time, _ in frames])), times
    # backwards, so that nothing is what was read before
    for k in reversed(range(len(frames))):
        reader.SetStep(k)
        reader.Update()
        mesh, (_, wanted) = pyvista.wrap(reader.GetOutput()), frames[k]
        assert isinstance(mesh, pyvista.UnstructuredGrid)
        assert same(mesh.points, wanted.points), f"positions of frame {k}"
        assert same(mesh.cells, wanted.cells) and same(mesh.celltypes, wanted.celltypes)
        assert sorted(mesh.point_data) == sorted(wanted.point_data)
        for name in wanted.point_data:
            assert same(mesh.point_data[name], wanted.point_data[name]), f"{name} of frame {k}"
        assert mesh.field_data["step"][0] == wanted.field_data["step"][0]
        for active in ("active_scalars_name", "active_vectors_name"):
            assert getattr(mesh, active) == getattr(wanted, active), f"{active}: {getattr(mesh, active)}"


def as_pyvista_reads(path, frames):
    """pyvista's own door to it; its reader is told the frame as VTK's is."""
    reader = pyvista.get_reader(path)
    for k in (len(frames) - 1, 0):
        reader.reader.SetStep(k)
        mesh, wanted = reader.read(), frames[k][1]
        assert same(mesh.points, wanted.points), f"positions of frame {k}"
        assert all(same(mesh[name], wanted[name]) for name in wanted.point_data)
    assert same(pyvista.read(path).points, frames[0][1].points), "the first frame is what is read"


def main():
    folder = pathlib.Path(sys.argv[1])
    (path,) = folder.glob("*.vtkhdf")
    frames = frames_of(folder)
    with h5py.File(path) as file:
        fields = structure(file, frames)
    as_vtk_reads(path, frames)
    as_pyvista_reads(path, frames)
    series = sum(frame.stat().st_size for frame in folder.glob("points_*.vtu"))
    print(f"{path}: {frames[0][1].n_points} points, {len(frames)} frames of {len(fields)} fields equal the VTU bit for bit by h5py, VTK and pyvista")
    print(f"{path.stat().st_size} bytes, {path.stat().st_size / series:.3f} of the series of VTU ({series})")


if __name__ == "__main__":
    main()
