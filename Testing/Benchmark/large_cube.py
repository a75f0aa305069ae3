#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a cube of N x N x N hexahedra and its twisted boundary, for meshes of 10^7 nodes, and
measures morph-mesh on it.

OUTPUT.vtu is the mesh, OUTPUT_boundary.vtp its outer nodes turned about the z axis by up to 90
degrees, with the array MorphPointId. Both are raw appended data, written plane by plane, so that
the script needs little memory. With --measure, results/whole-program.csv gets the whole program's
seconds and the peak of its memory:

  python3 large_cube.py 215 /tmp/cube --measure build/paraview/bin/morph-mesh"""

import argparse
import csv
import json
import resource
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "Utilities"))
from study_pieces import ORIGIN, origin  # noqa: E402  (needs the path above)

TABLE = HERE / "results/whole-program.csv"


def plane_of_points(n, k):
    """The points of plane k, of a cube of side 1, #points x 3."""
    y, x = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n, indexing="ij")
    return np.column_stack([x.ravel(), y.ravel(), np.full(x.size, k / n)])


def plane_of_cells(n, k):
    """The corners of the cells between planes k and k + 1, #cells x 8."""
    row, plane = n + 1, (n + 1) ** 2
    j, i = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    first = (i + row * j + plane * k).ravel()
    corners = [0, 1, row + 1, row, plane, plane + 1, plane + row + 1, plane + row]
    return np.column_stack([first + corner for corner in corners])


def twisted(points):
    angle = np.pi / 2 * points[:, 2]
    x, y = points[:, 0] - 0.5, points[:, 1] - 0.5
    return np.column_stack([0.5 + x * np.cos(angle) - y * np.sin(angle),
                            0.5 + x * np.sin(angle) + y * np.cos(angle), points[:, 2]])


def boundary(n):
    """The ids of the outer nodes and their places."""
    ids, places = [], []
    for k in range(n + 1):
        points = plane_of_points(n, k)
        outer = np.full(len(points), k in (0, n))
        for axis in (0, 1):
            outer |= (points[:, axis] == 0) | (points[:, axis] == 1)
        ids.append(np.flatnonzero(outer) + k * len(points))
        places.append(points[outer])
    return np.concatenate(ids), np.concatenate(places)


def write(path, kind, piece, arrays):
    """`piece`: the attributes of the piece; `arrays`: (element around it, type, name, components,
    bytes, parts), where parts() yields numpy arrays of these bytes in all."""
    offset, groups = 0, {}
    for group, data_type, name, components, size, _ in arrays:
        groups.setdefault(group, []).append(
            f'<DataArray type="{data_type}" Name="{name}" NumberOfComponents="{components}"'
            f' format="appended" offset="{offset}"/>')
        offset += 8 + size
    body = "".join(f"<{group}>{''.join(lines)}</{group}>" for group, lines in groups.items())
    with open(path, "wb") as file:
        file.write(f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"'
                   f' header_type="UInt64"><{kind}><Piece {piece}>{body}</Piece></{kind}>'
                   '<AppendedData encoding="raw">_'.encode())
        for *_, size, parts in arrays:
            file.write(struct.pack("<Q", size))
            start = file.tell()
            for part in parts():
                file.write(np.ascontiguousarray(part).tobytes())
            assert file.tell() - start == size, path
        file.write(b"</AppendedData></VTKFile>\n")


def measure(program, cube):
    """The row of a run on the files CUBE.vtu and CUBE_boundary.vtp."""
    start = time.perf_counter()
    subprocess.run([program, "--report", f"{cube}.json", f"{cube}.vtu", f"{cube}_boundary.vtp",
                    f"{cube}_moved.vtu"], check=True)
    seconds = time.perf_counter() - start
    report = json.loads(Path(f"{cube}.json").read_text(encoding="utf-8"))
    return {"nodes": report["nodes"], "method": "FEMWARP", "seconds": f"{seconds:.0f}",
            "prepare_s": f"{report['seconds to prepare']:.0f}",
            "evaluate_s": f"{report['seconds to evaluate']:.0f}",
            "memory_GB": f"{resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6:.1f}",
            **dict(zip(ORIGIN, origin()))}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("side", type=int, metavar="N", help="cells a side, up to 1289")
    parser.add_argument("output", metavar="OUTPUT", help="of the files, without extension")
    parser.add_argument("--measure", metavar="PROGRAM", help="morph-mesh")
    arguments = parser.parse_args()
    n = arguments.side
    if not 1 <= n <= 1289:  # nodes are numbered with 32 bits in the file
        parser.error("N is from 1 to 1289.")
    points, cells = (n + 1) ** 3, n ** 3
    write(f"{arguments.output}.vtu", "UnstructuredGrid",
          f'NumberOfPoints="{points}" NumberOfCells="{cells}"', [
              ("Points", "Float64", "Points", 3, 24 * points,
               lambda: (plane_of_points(n, k) for k in range(n + 1))),
              ("Cells", "Int32", "connectivity", 1, 32 * cells,
               lambda: (plane_of_cells(n, k).astype("<i4") for k in range(n))),
              ("Cells", "Int64", "offsets", 1, 8 * cells,
               lambda: (8 * (np.arange(n * n, dtype="<i8") + 1 + k * n * n) for k in range(n))),
              ("Cells", "UInt8", "types", 1, cells,
               lambda: (np.full(n * n, 12, np.uint8) for _ in range(n)))])
    ids, places = boundary(n)
    write(f"{arguments.output}_boundary.vtp", "PolyData", f'NumberOfPoints="{len(ids)}"', [
        ("PointData", "Int64", "MorphPointId", 1, 8 * len(ids), lambda: [ids.astype("<i8")]),
        ("Points", "Float64", "Points", 3, 24 * len(ids), lambda: [twisted(places)])])
    print(f"{points:,} nodes, {cells:,} hexahedra, {len(ids):,} outer nodes")
    if arguments.measure:
        row = measure(arguments.measure, arguments.output)
        with open(TABLE, "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, list(row), lineterminator="\n")
            table.writeheader()
            table.writerow(row)


if __name__ == "__main__":
    main()
