# SPDX-License-Identifier: BSD-3-Clause
"""Writes hexahedra as EnSight Gold in ASCII: ParaView's own writer takes one grid, not blocks."""
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy


def lines(values):
    """One value a line; more digits than the format's twelve characters are read, too."""
    return [f"{value:.9g}" for value in np.asarray(values).ravel(order="F")]


def write(path, parts, nodal, per_cell):
    """A case of several parts. `parts`: a grid for each name; `nodal` and `per_cell`: names of
    arrays, which become variables."""
    path = Path(path)
    case = ["FORMAT", "type: ensight gold", "GEOMETRY", f"model: {path.stem}.geo", "VARIABLE"]
    geometry = ["hexahedra", "in ASCII", "node id off", "element id off"]
    variables = {name: [name] for name in (*nodal, *per_cell)}
    for number, (part, grid) in enumerate(parts.items(), 1):
        count = grid.GetNumberOfPoints()
        cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8) + 1
        geometry += ["part", f"{number:10d}", part, "coordinates", f"{count:10d}",
                     *lines(vtk_to_numpy(grid.GetPoints().GetData())), "hexa8",
                     f"{len(cells):10d}", *("".join(f"{i:10d}" for i in cell) for cell in cells)]
        for names, data, kind in ((nodal, grid.GetPointData(), "coordinates"),
                                  (per_cell, grid.GetCellData(), "hexa8")):
            for name in names:
                variables[name] += ["part", f"{number:10d}", kind,
                                    *lines(vtk_to_numpy(data.GetArray(name)))]
    for name, text in variables.items():
        data = (grid.GetPointData() if name in nodal else grid.GetCellData()).GetArray(name)
        kind = "vector" if data.GetNumberOfComponents() == 3 else "scalar"
        case.append(f"{kind} per {'node' if name in nodal else 'element'}: {name} "
                    f"{path.stem}.{name}")
        path.with_suffix(f".{name}").write_text("\n".join(text) + "\n", encoding="utf-8")
    path.with_suffix(".geo").write_text("\n".join(geometry) + "\n", encoding="utf-8")
    path.write_text("\n".join(case) + "\n", encoding="utf-8")
