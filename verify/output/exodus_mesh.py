"""Writes decks/good/exodus_plate.g, a plate of hexahedra in two blocks, with the netCDF library.

Usage: python exodus_mesh.py OUT.g
Needs: pip install netCDF4 numpy
"""

import itertools
import sys

import netCDF4
import numpy as np

CELLS = (16, 6, 2)  # of 5 mm; lengths in mm


def node(x, y, z):
    return 1 + x + (CELLS[0] + 1) * (y + (CELLS[1] + 1) * z)


def corners(x, y, z):
    ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    return [node(x + a, y + b, z + c) for c in (0, 1) for a, b in ring]


def main():
    data = netCDF4.Dataset(sys.argv[1], "w", format="NETCDF3_64BIT_OFFSET")
    data.setncatts({"api_version": np.float32(5.26), "version": np.float32(5.26), "title": "a plate in two blocks"})
    data.setncatts({"floating_point_word_size": np.int32(8), "file_size": np.int32(1)})
    grid = list(itertools.product(*(range(n + 1) for n in reversed(CELLS))))
    place = 5.0 * np.array([p[::-1] for p in grid])
    halves = [[(x, y, z) for z, y, x in itertools.product(*(range(n) for n in reversed(CELLS))) if (x < 8) == left] for left in (True, False)]
    elements = halves[0] + halves[1]
    sets = {"left": [1 + i for i, p in enumerate(place) if p[0] == 0.0]}
    sides = {"right": [1 + i for i, (x, _, _) in enumerate(elements) if x == CELLS[0] - 1]}
    for name, length in {"len_name": 33, "time_step": None, "num_dim": 3, "num_nodes": len(place), "num_elem": len(elements),
                         "num_el_blk": 2, "num_node_sets": 1, "num_side_sets": 1}.items():
        data.createDimension(name, length)

    def put(name, kind, dimensions, values):
        variable = data.createVariable(name, kind, dimensions)
        variable[:] = values
        return variable

    def names(name, dimension, values):
        put(name, "S1", (dimension, "len_name"), netCDF4.stringtochar(np.array(values, "S33")))

    for k, (axis, column) in enumerate(zip("xyz", place.T)):
        put(f"coord{axis}", "f8", ("num_nodes",), column)
    names("eb_names", "num_el_blk", ["glass", "steel"])
    put("eb_prop1", "i4", ("num_el_blk",), [10, 20]).setncattr("name", "ID")
    for k, cells in enumerate(halves, 1):
        data.createDimension(f"num_el_in_blk{k}", len(cells))
        data.createDimension(f"num_nod_per_el{k}", 8)
        connect = put(f"connect{k}", "i4", (f"num_el_in_blk{k}", f"num_nod_per_el{k}"), [corners(*c) for c in cells])
        connect.elem_type = "HEX8"
    names("ns_names", "num_node_sets", list(sets))
    put("ns_prop1", "i4", ("num_node_sets",), [1]).setncattr("name", "ID")
    data.createDimension("num_nod_ns1", len(sets["left"]))
    put("node_ns1", "i4", ("num_nod_ns1",), sets["left"])
    names("ss_names", "num_side_sets", list(sides))
    put("ss_prop1", "i4", ("num_side_sets",), [1]).setncattr("name", "ID")
    data.createDimension("num_side_ss1", len(sides["right"]))
    put("elem_ss1", "i4", ("num_side_ss1",), sides["right"])
    put("side_ss1", "i4", ("num_side_ss1",), [2] * len(sides["right"]))
    data.close()


if __name__ == "__main__":
    main()
