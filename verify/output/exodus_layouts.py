"""Writes the Exodus files of `crates/io/tests/data/exodus`: one mesh as netCDF4, meshio and h5py write it.

A cube and, beside it along x, half a cube (a wedge); nodes 1 to 12, x from 0 to 2. `cubit_*.g` have the layout of Cubit and the
Exodus library: names, attributes, sets of nodes, sides and elements, results in frames; in HDF5 chunked, shuffled, compressed and with
64-bit numbers. `meshio*.e` are what `meshio.write` makes of it. `plain.g` is HDF5 without anything of netCDF, `absurd.g`
promises 2^40 nodes, `elsewhere.g` has its nodes in another file. All are packed by gzip.

Usage: python verify/output/exodus_layouts.py
Needs: pip install netCDF4 h5py meshio
"""

import gzip
from pathlib import Path

import h5py
import meshio
import netCDF4
import numpy as np

HERE = Path(__file__).resolve().parent.parent.parent / "crates/io/tests/data/exodus"
NODES = np.array([[n % 3, n // 3 % 2, n // 6] for n in range(12)], float)
CUBE, WEDGE = [1, 2, 5, 4, 7, 8, 11, 10], [2, 3, 6, 8, 9, 12]
FORMATS = ("NETCDF4", "NETCDF4_CLASSIC", "NETCDF3_64BIT_DATA", "NETCDF3_64BIT_OFFSET", "NETCDF3_CLASSIC")


def cubit(kind):
    """The layout of Cubit in a format of netCDF."""
    path = HERE / f"cubit_{kind.lower()}.g"
    whole = "i8" if kind in ("NETCDF4", "NETCDF3_64BIT_DATA") else "i4"
    packed = {"zlib": True, "shuffle": True, "complevel": 6} if kind.startswith("NETCDF4") else {}
    with netCDF4.Dataset(path, "w", format=kind) as data:
        data.setncatts({"api_version": np.float32(8.11), "version": np.float32(8.11), "floating_point_word_size": np.int32(8),
                        "file_size": np.int32(1), "maximum_name_length": np.int32(32), "int64_status": np.int32(0), "title": "cubit(mesh.g)"})
        for name, length in {"len_string": 33, "four": 4, "len_name": 33, "time_step": None, "num_dim": 3, "num_nodes": 12,
                             "num_elem": 2, "num_el_blk": 2, "num_node_sets": 2, "num_side_sets": 1, "num_elem_sets": 1, "num_qa_rec": 1,
                             "num_el_in_blk1": 1, "num_nod_per_el1": 8, "num_el_in_blk2": 1, "num_nod_per_el2": 6, "num_nod_ns1": 4,
                             "num_nod_ns2": 2, "num_side_ss1": 1, "num_ele_els1": 2, "num_nod_var": 1}.items():
            data.createDimension(name, length)

        def put(name, kind, dimensions, values, attributes={}):
            chunks = {"chunksizes": [min(5, len(data.dimensions[d])) or 1 for d in dimensions]} if packed else {}
            variable = data.createVariable(name, kind, dimensions, **packed, **chunks)
            variable.setncatts(attributes)
            variable[:] = values

        def names(name, dimensions, values):
            put(name, "S1", dimensions, netCDF4.stringtochar(np.array(values, "S33")))

        put("time_whole", "f8", ("time_step",), [0.0, 0.5])
        names("qa_records", ("num_qa_rec", "four", "len_string"), [["cubit", "16.10", "01/01/2024", "00:00:00"]])
        for prefix, dimension, ids, words in (("eb", "num_el_blk", [10, 20], ["steel", ""]), ("ns", "num_node_sets", [3, 7], ["left", ""]),
                                              ("ss", "num_side_sets", [4], [""]), ("els", "num_elem_sets", [5], ["both"])):
            put(f"{prefix}_status", "i4", (dimension,), [1] * len(ids))
            put(f"{prefix}_prop1", whole, (dimension,), ids, {"name": "ID"})
            names(f"{prefix}_names", (dimension, "len_name"), words)
        for axis, column in zip("xyz", NODES.T):
            put(f"coord{axis}", "f8", ("num_nodes",), column)
        put("connect1", whole, ("num_el_in_blk1", "num_nod_per_el1"), [CUBE], {"elem_type": "HEX8"})
        put("connect2", whole, ("num_el_in_blk2", "num_nod_per_el2"), [WEDGE], {"elem_type": "WEDGE6"})
        put("node_ns1", whole, ("num_nod_ns1",), [1, 4, 7, 10])
        put("node_ns2", whole, ("num_nod_ns2",), [9, 12])
        put("elem_ss1", whole, ("num_side_ss1",), [2])
        put("side_ss1", whole, ("num_side_ss1",), [2])
        put("elem_els1", whole, ("num_ele_els1",), [2, 1])
        names("name_nod_var", ("num_nod_var", "len_name"), ["temperature"])
        put("vals_nod_var1", "f8", ("time_step", "num_nodes"), np.arange(24.0).reshape(2, 12))


def of_meshio():
    """What meshio writes: one block of hexahedra and one of wedges, numbered from 0; sets of nodes."""
    cells = [("hexahedron", [np.array(CUBE) - 1]), ("wedge", [np.array(WEDGE) - 1])]
    sets = {"left": np.array([0, 3, 6, 9]), "right": np.array([2, 5, 8, 11])}
    for name, given in (("meshio.e", {"point_sets": sets}), ("meshio_without_sets.e", {"point_data": {"temperature": np.arange(12.0)}})):
        meshio.write(HERE / name, meshio.Mesh(NODES, cells, **given), file_format="exodus")


def plain():
    """HDF5 of another program."""
    with h5py.File(HERE / "plain.g", "w") as data:
        data["positions"] = NODES
        data.create_group("cells")["hexahedra"] = np.array([CUBE])


def hostile():
    """Nodes that are promised and not there, and nodes that another file should have."""
    with netCDF4.Dataset(HERE / "absurd.g", "w") as data:
        data.createDimension("num_nodes", 1 << 40)
        data.createVariable("coordx", "f8", ("num_nodes",), chunksizes=(1 << 20,))
    with h5py.File(HERE / "elsewhere.g", "w") as data:
        data.create_dataset("coordx", (12,), "f8", external=[("coordx.bin", 0, 96)])


if __name__ == "__main__":
    HERE.mkdir(parents=True, exist_ok=True)
    for kind in FORMATS:
        cubit(kind)
    of_meshio()
    plain()
    hostile()
    for path in sorted(HERE.iterdir()):
        if path.suffix != ".gz":
            print(path.name, path.stat().st_size)
            # HDF5 of so little is mostly room
            path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes(), mtime=0))
            path.unlink()
