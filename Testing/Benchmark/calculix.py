# SPDX-License-Identifier: BSD-3-Clause
"""Linear elasticity by CalculiX on a mesh whose boundary is twisted. Cells are stiffer the smaller
they are: Young's modulus is that of the largest over the volume, in bins of a factor of two."""

import subprocess
import time

import numpy as np

from meshes import twisted

POISSON = 0.3
TYPES = {4: "C3D4", 8: "C3D8"}


def volumes(mesh):
    """About: of hexahedra, that of the parallelepiped at the mean edges."""
    x = mesh.points[mesh.cells]
    if mesh.cells.shape[1] == 4:
        return np.linalg.det(x[:, 1:] - x[:, :1]) / 6
    edges = [x[:, ends].mean(axis=1) - x[:, starts].mean(axis=1) for starts, ends in (
        ((0, 3, 4, 7), (1, 2, 5, 6)), ((0, 1, 4, 5), (3, 2, 7, 6)), ((0, 1, 2, 3), (4, 5, 6, 7)))]
    return np.linalg.det(np.stack(edges, axis=1))


def lines(values, file):
    np.savetxt(file, values, "%d", delimiter=", ")


def write_deck(mesh, path):
    bins = np.floor(np.log2(volumes(mesh))).astype(int)
    outer = np.unique(mesh.boundary_faces())
    motion = (twisted(mesh.points) - mesh.points)[outer]
    with open(path, "w", encoding="ascii") as file:
        file.write("*NODE, NSET=ALL\n")
        np.savetxt(file, np.column_stack([np.arange(1, len(mesh.points) + 1), mesh.points]),
                   "%d, %.12g, %.12g, %.12g")
        for number in np.unique(bins):
            cells = np.flatnonzero(bins == number)
            name = f"E{number - bins.min()}"
            file.write(f"*ELEMENT, TYPE={TYPES[mesh.cells.shape[1]]}, ELSET={name}\n")
            lines(np.column_stack([cells + 1, mesh.cells[cells] + 1]), file)
            file.write(f"*MATERIAL, NAME={name}\n*ELASTIC\n{2.0 ** (bins.max() - number)}, "
                       f"{POISSON}\n*SOLID SECTION, ELSET={name}, MATERIAL={name}\n")
        file.write("*STEP\n*STATIC\n*BOUNDARY\n")
        for d in range(3):
            np.savetxt(file, np.column_stack([outer + 1, motion[:, d]]), f"%d, {d + 1}, {d + 1}, "
                       "%.12g")
        file.write("*NODE PRINT, NSET=ALL\nU\n*END STEP\n")


def move(folder, mesh, threads, limit):
    """(seconds, moved points); None, None if it takes more than `limit` seconds."""
    write_deck(mesh, folder / "deck.inp")
    start = time.perf_counter()
    try:
        done = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, text=True,
                              timeout=limit, env={"OMP_NUM_THREADS": str(threads)}, check=False)
    except subprocess.TimeoutExpired:
        return None, None
    seconds = time.perf_counter() - start
    text = (folder / "deck.dat").read_text() if (folder / "deck.dat").exists() else ""
    rows = [line.split() for line in text.splitlines() if line.count(".") == 3]
    if len(rows) != len(mesh.points):
        raise RuntimeError(f"ccx wrote {len(rows)} displacements: {done.stdout[-1000:]}")
    found = np.array(rows, dtype=float)
    moved = mesh.points.copy()
    moved[found[:, 0].astype(int) - 1] += found[:, 1:]
    return seconds, moved
