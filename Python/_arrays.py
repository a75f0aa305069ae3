# SPDX-License-Identifier: BSD-3-Clause
"""Meshes, methods and quality as arrays, over the extension module _core."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _core

Floats = NDArray[numpy.float64]
Ids = NDArray[numpy.int64]

#: VTK's numbers of meshio's cell types.
_TYPES = {
    "vertex": 1, "line": 3, "triangle": 5, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13,
    "pyramid": 14, "line3": 21, "triangle6": 22, "quad8": 23, "tetra10": 24, "hexahedron20": 25,
    "wedge15": 26, "pyramid13": 27, "quad9": 28, "hexahedron27": 29, "quad6": 30, "wedge12": 31,
    "wedge18": 32, "hexahedron24": 33, "triangle7": 34}
_POLYHEDRON = 42


class MorphError(RuntimeError):
    """A mesh has inverted cells that cannot be repaired, or whose repair was not asked for.

    points: (n, 3), the mesh that has them. cells: their ids, ascending.
    """

    def __init__(self, message: str, points: Floats, cells: Ids) -> None:
        super().__init__(message)
        self.points = points
        self.cells = cells

    def __reduce__(self) -> tuple[type, tuple[str, Floats, Ids]]:
        return type(self), (str(self), self.points, self.cells)  # from another process


class MorphWarning(UserWarning):
    """What is odd about a mesh, a motion or a result."""


class Boundary(NamedTuple):
    """The outer faces of a mesh: face i has the corners connectivity[offsets[i]:offsets[i + 1]].

    Of a plane mesh or a shell its edges take the part of faces.
    """

    offsets: Ids  #: (faces + 1,)
    connectivity: Ids  #: node ids, outward by the right-hand rule
    cells: Ids  #: (faces,), the cell behind each face
    nodes: Ids  #: all nodes of these faces, those between corners too, ascending


class Surface(NamedTuple):
    """A part of the boundary between edges at which it turns."""

    name: str  #: "Surface 3", as the filters call it with the same angles
    id: int
    faces: Ids  #: numbers of faces in Mesh.boundary, ascending
    nodes: Ids  #: node ids, those on its edges too, ascending
    area: float  #: in the unit of the points, squared; of edges their length


class Quality(NamedTuple):
    """The scaled Jacobian of a mesh: 1 for the ideal cell, 0 or less for an inverted one."""

    scaled_jacobian: Floats  #: (cells,), NaN for cells of a lower dimension than others
    minimum: float
    mean: float
    inverted: int  #: the number of cells of 0 or less, without the degenerate ones
    degenerate: int  #: the number of cells with a corner whose edges have no length
    worst_cell: int  #: the lowest id of the cells at the minimum


def set_threads(count: int) -> None:
    """Computes in so many threads; 0, the default, stands for all cores."""
    if count < 0:
        raise ValueError(f"set_threads got {count}; 0 or more is needed.")
    _core.set_threads(count)


def _whole(values: ArrayLike, what: str) -> NDArray[Any]:
    """As an array. NumPy would drop what is imaginary or masked."""
    array = numpy.asanyarray(values)
    if numpy.iscomplexobj(array) or numpy.ma.is_masked(array):
        raise ValueError(f"{what} has complex or masked values; plain numbers are needed.")
    return numpy.asarray(array)


def _shaped(values: ArrayLike, what: str, rows: Union[int, str]) -> Floats:
    """The same array if it is float64 and contiguous, else a copy."""
    array = numpy.ascontiguousarray(_whole(values, what), dtype=numpy.float64)
    if array.ndim != 2 or array.shape[1] != 3 or rows not in ("n", len(array)):
        raise ValueError(f"{what} has the shape {array.shape}; ({rows}, 3) is needed.")
    return array


def _points(values: ArrayLike, what: str, rest: Floats, nodes: Optional[Ids] = None) -> Floats:
    """As _shaped(). `rest`: the mesh's points; those that are not finite are of no cell, and may
    be anything. `nodes`: the ids of the rows, None: of all."""
    array = _shaped(values, what, len(rest) if nodes is None else len(nodes))
    if abs(array).max(initial=0) <= 1e50:
        return array
    wrong = ~(abs(array) <= 1e50).all(axis=1)  # so that NaN is wrong, too
    if nodes is None:
        wrong &= numpy.isfinite(rest).all(axis=1)
    _refuse(numpy.flatnonzero(wrong) if nodes is None else nodes[wrong], what)
    return array


def _refuse(wrong: Ids, what: str) -> None:
    if wrong.size:
        raise ValueError(f"{what} has NaN, infinity or numbers beyond 1e50 at nodes "
                         f"{_listed(wrong)}. Use another unit, or correct it.")


def _ids(values: ArrayLike, what: str) -> Ids:
    array = _whole(values, what)
    if array.ndim != 1 or not (numpy.issubdtype(array.dtype, numpy.integer) or array.size == 0):
        raise ValueError(f"{what} has the shape {array.shape} and type {array.dtype}; "
                         "whole numbers (n,) are needed.")
    return numpy.ascontiguousarray(array, dtype=numpy.int64)


def _type_number(name: str, nodes: int) -> int:
    number = _TYPES.get(name)
    if number is None or nodes != _core.number_of_nodes(number):
        raise ValueError(f"Cells of the type {name} with {nodes} nodes are not known; there are "
                         f"{', '.join(_TYPES)}.")
    return number


def _is_block(part: Any) -> bool:
    """Whether it is a block of meshio, or a pair of type and array."""
    return hasattr(part, "type") or (
        isinstance(part, (list, tuple)) and len(part) == 2 and isinstance(part[0], str))


class _Cells(NamedTuple):
    """Cells as VTK has them; of polyhedra, faces has that of each: its size, then its nodes."""

    offsets: Ids
    connectivity: Ids
    types: Ids
    face_offsets: Ids = numpy.empty(0, int)
    faces: Ids = numpy.empty(0, int)


def _joined(sizes: Sequence[Any], ids: Sequence[Any], types: Sequence[Any],
            faces: Sequence[Any]) -> _Cells:
    """Of arrays, one after the other. `faces`: a row for each cell, or none at all."""
    def row(parts: Sequence[Any]) -> Ids:
        return numpy.concatenate([numpy.empty(0, int), *parts]).astype(numpy.int64)

    def offsets(lengths: Ids) -> Ids:
        return numpy.concatenate([[0], lengths]).cumsum().astype(numpy.int64)

    of_faces = (offsets(numpy.array([len(f) for f in faces])), row(faces)) if faces else ()
    return _Cells(offsets(row(sizes)), row(ids), row(types), *of_faces)


def _polyhedron(cell: int, faces: Sequence[Any]) -> tuple[Ids, Ids]:
    """The nodes of a polyhedron, and its faces in one row."""
    if not all(numpy.ndim(face) == 1 and len(face) for face in faces) or not len(faces):
        raise ValueError(f"The polyhedron {cell} is no list of faces, of which each is a list of "
                         "nodes.")
    rows = [_ids(face, f"A face of the polyhedron {cell}") for face in faces]
    stream = numpy.concatenate([numpy.insert(face, 0, len(face)) for face in rows])
    return numpy.unique(numpy.concatenate(rows)), stream


def _from_blocks(blocks: Sequence[Any]) -> _Cells:
    sizes, ids, types, faces = [], [], [], []
    has_polyhedra = False
    for block in blocks:
        if not _is_block(block):
            raise ValueError("cells has a block that is no pair of type and array, such as "
                             '("hexahedron", array (cells, 8)).')
        name, data = (block.type, block.data) if hasattr(block, "type") else block
        if name.startswith("polyhedron"):
            has_polyhedra = True
            for cell in data:
                nodes, stream = _polyhedron(len(faces), cell)
                ids.append(nodes)
                sizes.append([len(nodes)])
                faces.append(stream)
            types.append(numpy.full(len(data), _POLYHEDRON))
            continue
        data = _whole(data, f"The block {name}")
        if data.ndim != 2:
            raise ValueError(f"The cells of type {name} have the shape {data.shape}; (cells, nodes "
                             "of a cell) is needed. Polygons are not taken.")
        ids.append(_ids(data.ravel(), f"The block {name}"))
        sizes.append(numpy.full(len(data), data.shape[1]))
        types.append(numpy.full(len(data), _type_number(name, data.shape[1])))
        faces.extend([()] * len(data))
    return _joined(sizes, ids, types, faces if has_polyhedra else ())


def _from_flat(cells: Ids, types: Ids) -> _Cells:
    """VTK's cells in one row: n, n ids, n, n ids, ..., of a polyhedron its stream of faces."""
    row, place, starts = cells.tolist(), 0, []
    for cell in range(len(types)):
        if place >= len(row) or row[place] < 0:
            raise ValueError(
                f"cells ends, or has a negative length, at cell {cell} of {len(types)}.")
        starts.append(place + 1)
        place += row[place] + 1
    if place != len(row):
        raise ValueError(f"cells has {len(row)} numbers; {len(types)} cells have {place}.")
    ends = [start - 1 for start in starts[1:]] + [place] * bool(starts)
    if not (types == _POLYHEDRON).any():
        offsets = numpy.array([0, *ends]) - numpy.arange(len(types) + 1)
        return _Cells(offsets, numpy.delete(cells, numpy.array(starts, int) - 1), types)
    ids, faces = [], []
    for cell, (start, end) in enumerate(zip(starts, ends)):
        nodes, stream = cells[start:end], ()
        if types[cell] == _POLYHEDRON:
            nodes, stream = _polyhedron(cell, _split(cell, nodes.tolist()))
        ids.append(nodes)
        faces.append(stream)
    return _joined([[len(nodes)] for nodes in ids], ids, [types], faces)


def _split(cell: int, stream: Sequence[int]) -> list[Sequence[int]]:
    """The faces of the stream: their number, then the size and nodes of each."""
    faces, place = [], 1
    for _ in range(stream[0] if stream else 0):
        size = stream[place] if place < len(stream) else 0
        faces.append(stream[place + 1:place + 1 + size])
        place += size + 1
    if place != len(stream):
        raise ValueError(f"The polyhedron {cell} is no stream of faces: their number, then the "
                         "size and the nodes of each.")
    return faces


class Mesh(_core.Mesh):
    """An undeformed mesh, which is copied once: 24 bytes a node, and 8 a node of each cell.

    points: (n, 3), coordinates in any unit of length. Points of no cell may be NaN, and stay.
    cells: tetrahedra, hexahedra, wedges and pyramids, linear or quadratic, and polyhedra, among
        others that move with them; or triangles and quadrilaterals alone, linear or quadratic: a
        plane mesh or a shell, whose edges are its boundary; one of
        - meshio's blocks: [("hexahedron", array (cells, 8)), ...], or meshio.Mesh.cells; of
          polyhedra a list of faces for each, of which each is a list of nodes;
        - (offsets, connectivity, celltypes): cell i has the type celltypes[i], VTK's number, and
          the nodes connectivity[offsets[i]:offsets[i + 1]];
        - with celltypes, VTK's and PyVista's cells in one row: n, n ids, n, n ids, ..., where a
          polyhedron has the stream of its faces: their number, then the size and nodes of each.
    celltypes: VTK's numbers of the types, (cells,), for that last form.

    points, of the mesh, is a view of its coordinates, which cannot be written. Raises ValueError
    for cells with coordinates that are not finite, ids that do not exist, unknown types, and a mesh
    of lines alone; it names the ids. Warns of what is odd about it. Cost: that of quality(), and a
    sort of all faces.
    """

    def __init__(self, points: ArrayLike,
                 cells: Union[Sequence[Any], ArrayLike],
                 celltypes: Optional[ArrayLike] = None) -> None:
        coordinates = _shaped(points, "points", "n")
        far = numpy.isfinite(coordinates) & (abs(coordinates) > 1e50)  # the core finds NaN
        _refuse(numpy.flatnonzero(far.any(axis=1)), "points")
        if celltypes is not None:
            types = _ids(celltypes, "celltypes")
            found = _from_flat(_ids(cells, "cells"), types)
        elif not isinstance(cells, (list, tuple)):
            raise ValueError("cells in one row need celltypes, VTK's numbers of their types; else "
                             "blocks, or offsets, connectivity and celltypes, are needed.")
        elif len(cells) == 3 and not any(map(_is_block, cells)):
            found = _Cells(*(_ids(part, name) for part, name in
                             zip(cells, ("offsets", "connectivity", "celltypes"))))
        else:
            found = _from_blocks(cells)
        types = found.types
        if types.size and not (0 <= types.min() and types.max() < 256):
            raise ValueError("celltypes has numbers beyond 0 to 255.")
        polyhedra = numpy.flatnonzero(types == _POLYHEDRON)
        if polyhedra.size and not found.face_offsets.size:
            raise ValueError(f"The faces of polyhedra are missing: cells {_listed(polyhedra)}. "
                             "Give blocks, or cells in one row.")
        self.types = types.astype(numpy.uint8)
        self.types.flags.writeable = False
        super().__init__(coordinates, self.types, *found[:2], *found[3:])

    @property
    def boundary(self) -> Boundary:
        """The outer faces: those that one cell alone has."""
        return Boundary(*self._boundary())

    def surfaces(self, feature_angle: float = 25, corner_angle: float = 45) -> list[Surface]:
        """The surfaces of the boundary, by their lowest face.

        feature_angle: degrees, from 0 to 180; faces that turn by more are on different surfaces.
        corner_angle: the same for curves between surfaces, which have a vertex there.
        Cost: a sort of the boundary's edges.
        """
        return [Surface(f"Surface {id_}", id_, faces, nodes, area) for id_, faces, nodes, area in
                self._surfaces(feature_angle, corner_angle)]

    def __repr__(self) -> str:
        return f"<Mesh of {len(self.points)} nodes and {len(self.types)} cells>"


def _require(value: Any, kind: type, what: str) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"{what} is a {type(value).__name__}; a {kind.__name__} is needed.")


class Prepared:
    """A method prepared for a mesh and the nodes that move it, by Method.prepare().

    nodes: their ids, in the order in which they were given. Threads may use one object at once.
    """

    def __init__(self, core: _core.Prepared, mesh: Mesh) -> None:
        self._core, self._mesh = core, mesh

    @property
    def nodes(self) -> Ids:
        return self._core.nodes

    def evaluate(self, displacements: Optional[ArrayLike] = None, *,
                 targets: Optional[ArrayLike] = None) -> Floats:
        """The points of the moved mesh, (n, 3).

        displacements: of the nodes, (nodes, 3), from the undeformed mesh; or
        targets: where the nodes go, (nodes, 3). They go there exactly.

        Cells may be inverted: see quality() and repair(). Cost: 9 to 13 iterations of a solver for
        FEMWARP, a pass over the weights for the meshless methods.
        """
        if (displacements is None) == (targets is None):
            raise TypeError("evaluate() needs either displacements or targets.")
        is_relative = targets is None
        nodes = self.nodes
        values = _points(displacements if is_relative else targets,
                         "displacements" if is_relative else "targets", self._mesh.points, nodes)
        return self._core._evaluate(values, is_relative)

    def adjoint(self, gradient: ArrayLike) -> Floats:
        """The transpose of evaluate(): derivatives with respect to the displacements, (nodes, 3).

        gradient: derivatives of an objective with respect to the points of the moved mesh, (n, 3).
        Raises ValueError for Smoothing and InversionFree, which are not linear. Cost: that of
        evaluate().
        """
        rest = self._mesh.points
        values = _points(gradient, "gradient", rest)
        return self._core._adjoint(numpy.where(numpy.isfinite(rest), values, 0))


class Method:
    """A method with its options, which are keywords and attributes."""

    _OPTIONS: dict[str, Any] = {}

    def __init__(self, **options: Any) -> None:
        for name, value in options.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._OPTIONS:
            raise TypeError(f"{type(self).__name__} has no option {name}; there are "
                            f"{', '.join(self._OPTIONS) or 'none'}.")
        kind, low, high = self._OPTIONS[name]
        if kind == "choice":
            plain = {_plain(choice): choice for choice in low}
            if _plain(str(value)) not in plain:
                raise ValueError(f"{name} has no value {value!r}; there are {', '.join(low)}.")
            value = plain[_plain(str(value))]
        elif kind == "array":
            value = None if value is None else numpy.array(value, dtype=numpy.float64).ravel()
        else:
            number = float(value)
            is_whole = kind == "integer"
            if not low <= number <= high or number != value or (is_whole and number % 1):
                raise ValueError(f"{name} is {value}; a {'whole ' if is_whole else ''}"
                                 f"number from {low:.10g} to {high:.10g} is needed.")
            value = int(number) if is_whole else number
        object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._OPTIONS)
        return f"{type(self).__name__}({given})"

    def prepare(self, mesh: Mesh, nodes: ArrayLike, *,
                fix_unnamed_boundary: bool = True) -> Prepared:
        """Does all work that depends on the undeformed mesh and on which nodes move it.

        nodes: ids of nodes whose motion will be given, (nodes,), each once, in any order.
        fix_unnamed_boundary: other nodes of the boundary stay. A node between two corners follows
            if one of them is named. Off: they move like the nodes inside.

        Raises ValueError for ids that do not exist or occur twice, and RuntimeError for nodes that
        do not determine a motion, such as none on one of several bodies.
        """
        _require(mesh, Mesh, "mesh")
        options = {name: [_plain(choice) for choice in low].index(_plain(getattr(self, name)))
                   if kind == "choice" else getattr(self, name)
                   for name, (kind, low, _) in self._OPTIONS.items()}
        return Prepared(_core.Prepared(mesh, type(self).__name__, options, _ids(nodes, "nodes"),
                                       fix_unnamed_boundary), mesh)


def _plain(name: str) -> str:
    return "".join(c for c in name if c.isalnum()).lower()


def quality(mesh: Mesh, points: Optional[ArrayLike] = None) -> Quality:
    """The scaled Jacobian of each cell, at the mesh's own points or at others, (n, 3).

    A body whose cells are all in the mirrored order counts as valid. Cost: 0.1 microseconds a cell,
    5 for a quadratic one.
    """
    _require(mesh, Mesh, "mesh")
    return Quality(*mesh._quality(
        mesh.points if points is None else _points(points, "points", mesh.points)))


def repair(mesh: Mesh, points: ArrayLike, nodes: ArrayLike, *,
           fix_unnamed_boundary: bool = True) -> Floats:
    """The points without inverted cells, (n, 3): those near such cells move, or all where needed.

    points: of the moved mesh, (n, 3). nodes, and the rest of the boundary with
    fix_unnamed_boundary: they stay at these points. Cells that were inverted in the undeformed mesh
    do not count unless they became worse. Raises MorphError where some stay inverted, with the best
    points found and the ids. Cost: that of quality() if none is inverted; at most some minutes a
    million cells.
    """
    _require(mesh, Mesh, "mesh")
    start = _points(points, "points", mesh.points)
    repaired, inverted, determined = mesh._repair(start, _ids(nodes, "nodes"),
                                                  fix_unnamed_boundary)
    if len(inverted) == 0:
        return repaired
    if len(determined):
        reason = (f"The boundary itself inverts {len(determined)} cells, which no node inside can "
                  f"mend: cells {_listed(determined)}. Move it less there.")
    else:
        reason = (f"{len(inverted)} cells stay inverted: cells {_listed(inverted)}. Move the "
                  "boundary less, or in steps of which each starts from the mesh before.")
    raise MorphError(reason, repaired, inverted)


def _listed(ids: Ids) -> str:
    return ", ".join(map(str, ids[:10])) + (f", ... ({len(ids)} in all)" if len(ids) > 10 else "")


def morph(mesh: Mesh, nodes: ArrayLike, displacements: Optional[ArrayLike] = None, *,
          targets: Optional[ArrayLike] = None, method: Optional[Method] = None,
          repair: bool = True, fix_unnamed_boundary: bool = True) -> Floats:
    """The points of the mesh, (n, 3), after its nodes have moved: prepare(), evaluate(), repair().

    nodes, displacements, targets, fix_unnamed_boundary: as in Method.prepare() and
        Prepared.evaluate().
    method: with its options; None: FEMWARP().
    repair: repairs inverted cells. Off: raises MorphError if there are some.
    """
    from ._methods import FEMWARP
    method = FEMWARP() if method is None else method
    _require(method, Method, "method")
    prepared = method.prepare(mesh, nodes, fix_unnamed_boundary=fix_unnamed_boundary)
    moved = prepared.evaluate(displacements, targets=targets)
    if repair:
        return _repair(mesh, moved, prepared.nodes, fix_unnamed_boundary=fix_unnamed_boundary)
    cells = mesh._inverted(moved)
    if len(cells):
        raise MorphError(f"{len(cells)} cells are inverted: cells {_listed(cells)}. Call with "
                         "repair=True, or move the boundary less.", moved, cells)
    return moved


_repair = repair
