# SPDX-License-Identifier: BSD-3-Clause
"""A model of solver_models as pieces of VTK, without VTK: .pvtu and .vtm, text."""

TYPES = {"hexahedron": 12, "wedge": 13, "tetra": 10}
ARRAY = '<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">{}</DataArray>\n'


def array(kind, name, values, components=1):
    return ARRAY.format(kind, name, components, " ".join(map(repr, values)))


def grid(model, cells):
    """A .vtu of these cells and their nodes."""
    used = sorted({node for _, nodes in cells for node in nodes})
    rank = {node: i for i, node in enumerate(used)}
    ends = []
    for _, nodes in cells:
        ends.append((ends[-1] if ends else 0) + len(nodes))
    return ('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n'
            f'<UnstructuredGrid><Piece NumberOfPoints="{len(used)}" '
            f'NumberOfCells="{len(cells)}">\n<Points>\n'
            + array("Float64", "Points", [x for n in used for x in model.points[n]], 3)
            + "</Points>\n<Cells>\n"
            + array("Int64", "connectivity", [rank[n] for _, nodes in cells for n in nodes])
            + array("Int64", "offsets", ends)
            + array("UInt8", "types", [TYPES[what] for what, _ in cells])
            + "</Cells>\n</Piece></UnstructuredGrid>\n</VTKFile>\n")


def write(model, path, blocks=None):
    """`path`, a .pvtu or a .vtm, and two pieces beside it; returns their names. `blocks`: two
    names, for a .vtm."""
    half = len(model.cells) // 2
    names = [f"{path.stem}_{i}.vtu" for i in range(2)]
    for name, cells in zip(names, (model.cells[:half], model.cells[half:])):
        path.with_name(name).write_text(grid(model, cells))
    if path.suffix == ".pvtu":
        kind, lines = "PUnstructuredGrid", [
            '<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>']
        lines += [f'<Piece Source="{name}"/>' for name in names]
    else:
        kind, lines = "vtkMultiBlockDataSet", [
            f'<DataSet index="{i}" file="{name}"' + (f' name="{blocks[i]}"/>' if blocks else "/>")
            for i, name in enumerate(names)]
    path.write_text("\n".join([f'<VTKFile type="{kind}" version="1.0">', f"<{kind}>", *lines,
                               f"</{kind}>", "</VTKFile>", ""]))
    return names
