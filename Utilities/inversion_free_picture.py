#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of the inversion-free method: the small canister's hexahedra where FEMWARP inverts
cells, by FEMWARP and by the inversion-free morph. It shows two layers at two thirds of its height,
and above them the inverted cells alone.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        pvpython --force-offscreen-rendering Utilities/inversion_free_picture.py

Writes inversion-free.png into Documentation/images, or the directory given. Needs the plugin and
ImageMagick; not Gmsh."""

import sys
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from demo_picture import Panel, save_picture  # noqa: E402  (needs the path above)
from inversion_free_table import CANISTER_OFFSET, Case, morphed, number  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from picture_arguments import fewer_colors, parse, picture_parser  # noqa: E402

CASE = Case("canister", "hex", True, 1.2)


def shown(mesh, grid):
    """Ids of the cells of two layers at two thirds of the height, and of the inverted ones above:
    those lie inside others, and a cut alone would hide them."""
    z = mesh.points[mesh.cells].mean(axis=1)[:, 2]
    height = (z - mesh.points[:, 2].min()) / np.ptp(mesh.points[:, 2])
    slab = (height > 2 / 3 - 1 / 8) & (height < 2 / 3)
    inverted = vtk_to_numpy(grid.GetCellData().GetArray("ScaledJacobian")) <= 0
    return np.flatnonzero(slab | ((height > 2 / 3) & inverted))


def panel(title, mesh, grid):
    count = int(number(grid, "InvertedCells"))
    note = (f"{count:,} of {grid.GetNumberOfCells():,} cells inverted\n"
            f"min {number(grid, 'MinScaledJacobian'):.3f}, "
            f"mean {number(grid, 'MeanScaledJacobian'):.3f}")
    return Panel(title, note, grid, shown(mesh, grid))


def main():
    parser = picture_parser(__doc__)
    add_plugin(parser)
    arguments = parse(parser)
    load_plugin(arguments.plugin)
    path = arguments.output / "inversion-free.png"
    mesh = CASE.mesh()
    silent = {"Validity": "None"}  # the picture shows the inverted cells
    save_picture(
        path,
        f"The canister's hole moves by {CANISTER_OFFSET * CASE.t:.2f} of the radius "
        "(two layers, and the inverted cells above them)",
        [panel("Before", mesh, morphed("MorphFEMWARP", mesh, 0)),
         panel("FEMWARP", mesh, morphed("MorphFEMWARP", mesh, CASE.t, **silent)),
         panel("Inversion-free", mesh, morphed("MorphInversionFree", mesh, CASE.t))],
        tilt=55)
    fewer_colors(path)
    print(f"Written {path}")


if __name__ == "__main__":
    main()
