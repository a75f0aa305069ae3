# SPDX-License-Identifier: BSD-3-Clause
"""morph(): a mesh and its displaced boundary in, the morphed mesh out, exceptions on failure."""
import re
import warnings

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkDataObjectTree, vtkPointSet, vtkPolyData, vtkUnstructuredGrid)

from . import vtkMeshMorphingFiltersMorphing as _filters

_METHODS = {
    "FEMWARP": _filters.vtkFEMWarpMorph,
    "InversionFree": _filters.vtkInversionFreeMorph,
    "LBWARP": _filters.vtkLBWarpMorph,
    "RadialBasis": _filters.vtkRadialBasisMorph,
    "SimplexLinear": _filters.vtkSimplexLinearMorph,
    "SimplexNaturalNeighbor": _filters.vtkSimplexNaturalNeighborMorph,
    "Smoothing": _filters.vtkSmoothingMorph,
    "WeightedResidual": _filters.vtkWeightedResidualMorph,
}
_VALID = ("Valid", "Repaired", "SubStepped", "Unmeasured")


class MorphError(RuntimeError):
    """A morph failed, or its result has inverted cells or a boundary that crosses itself.

    status: the filter's MorphStatus, such as "Failed", "Inverted", "CrossesItself" or "Partial".
    ids: numpy array of the ids of the inverted and collapsed cells; empty where there is no result.
    grid: the result, of the type that morph() returns; after a failure the undeformed mesh.
    """

    def __init__(self, message, status, ids, grid):
        super().__init__(message)
        self.status = status
        self.ids = ids
        self.grid = grid


class MorphWarning(UserWarning):
    """A warning of the filter that morphs."""


def _plain(name):
    return "".join(c for c in name if c.isalnum()).lower()


def _make(method):
    """The filter of a method, whose name may be written with any dashes, blanks and capitals."""
    for name, make in _METHODS.items():
        if _plain(name) == _plain(method):
            return make()
    raise ValueError(f"There is no method {method!r}; there are {', '.join(_METHODS)}.")


def _set(morph, name, value):
    """Sets a property of the filter; text is the name of one of its choices."""
    words = "".join(w[:1].upper() + w[1:] for w in re.split("[^A-Za-z0-9]+", str(value)))
    setter = f"Set{name}To{words}" if isinstance(value, str) else f"Set{name}"
    if isinstance(value, str) and not hasattr(morph, setter) and hasattr(morph, "Set" + name):
        choices = [s[len(f"Set{name}To"):] for s in dir(morph) if s.startswith(f"Set{name}To")]
        if choices:
            raise ValueError(f"{name} has no value {value!r}; there are {', '.join(choices)}.")
        setter = f"Set{name}"  # a text, such as the name of an array
    if not hasattr(morph, setter):
        raise TypeError(f"{morph.GetClassName()} has no property {name!r}: see its help().")
    if setter == f"Set{name}":
        getattr(morph, setter)(value)
    else:
        getattr(morph, setter)()


def _boundary(grid, displaced, ids):
    """The displaced boundary as a point set with MorphPointId where `ids` are known."""
    if isinstance(displaced, (vtkPointSet, vtkDataObjectTree)):
        if ids is not None:
            raise TypeError("ids belong to displaced points that are a numpy array: a vtkPointSet "
                            "has the point array MorphPointId, or the property BoundaryIdArray.")
        return displaced
    points = numpy.ascontiguousarray(displaced, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"The displaced points have the shape {points.shape}; (n, 3) is needed.")
    # Of composite data the merged mesh's points, whose number the boundary does not tell.
    whole = grid.GetNumberOfPoints() if isinstance(grid, vtkPointSet) else -1
    if ids is None and len(points) != whole:
        extract = _filters.vtkExtractMorphBoundary()
        extract.SetInputDataObject(grid)
        extract.Update()
        found = extract.GetOutput().GetPointData().GetArray("MorphPointId")
        count = found.GetNumberOfTuples() if found else 0
        if len(points) != count:
            raise ValueError(
                f"There are {len(points)} displaced points for a mesh with {count} on its boundary"
                + (f", of {whole} in all. Give all of either, in the order of their ids, or ids."
                   if whole >= 0 else ". Give all of these, in the order of their ids, or ids."))
        ids = vtk_to_numpy(found)
    boundary = vtkPolyData()
    places = vtkPoints()
    places.SetDataType(VTK_DOUBLE)
    places.SetData(numpy_to_vtk(points, deep=True))
    boundary.SetPoints(places)
    if ids is not None:
        numbers = numpy.asarray(ids)
        if numbers.shape != (len(points),) or not numpy.issubdtype(numbers.dtype, numpy.integer):
            raise ValueError(f"ids have the shape {numbers.shape} and type {numbers.dtype}; "
                             f"{len(points)} integers are needed.")
        array = numpy_to_vtkIdTypeArray(
            numpy.ascontiguousarray(numbers, dtype=numpy.int64), deep=True)
        array.SetName("MorphPointId")
        boundary.GetPointData().AddArray(array)
    return boundary


def _as(grid, output):
    """The output as an object of the grid's class, such as PyVista's UnstructuredGrid."""
    result = output.NewInstance()
    result.ShallowCopy(output)  # apart from the filter, which ends here
    # VTK 9.6 gives new objects a Python class of its own.
    return result if type(grid) in (type(output), type(result)) else type(grid)(result)


def morph(grid, displaced, method="FEMWARP", *, ids=None, allow_inverted=False, **options):
    """Moves the nodes of a volume mesh so that it fits its displaced boundary.

    grid: vtkUnstructuredGrid, or an object of a subclass such as PyVista's UnstructuredGrid; or
        composite data, vtkMultiBlockDataSet or vtkPartitionedDataSetCollection, whose blocks are
        one mesh. Its point ids are then those of vtkExtractMorphBoundary's MorphPointId.
    displaced: the displaced boundary, one of
        - a vtkPointSet with the point array MorphPointId, as vtkExtractMorphBoundary writes it, or
          a copy of the whole grid or composite data with its points moved;
        - an array of (n, 3) coordinates, in the unit of the grid: of all points of the grid (those
          inside have no effect), of its boundary in the order of their ids, or of `ids`.
    method: FEMWARP, LBWARP, WeightedResidual, SimplexLinear, SimplexNaturalNeighbor, RadialBasis,
        Smoothing or InversionFree.
    ids: n point ids of the grid, 0-based, for an array of displaced points. Other boundary nodes
        stay, unless FixUnnamedBoundary=False.
    allow_inverted: return a mesh with cells that the morph has inverted or collapsed, whose
        boundary crosses itself, or that came only part of the way, in place of raising MorphError.
    options: properties of the method's filter, by their VTK names: Validity="Repair",
        Tolerance=1e-8, NumberOfThreads=1. Text chooses a value by its name.

    Returns the morphed mesh, an object of the grid's class, with the cell array ScaledJacobian.
    Raises MorphError where the morph fails, inverts cells or crosses itself; TypeError and
    ValueError for arguments of the wrong kind. What the filter warns of is a MorphWarning.
    """
    if not isinstance(grid, (vtkUnstructuredGrid, vtkDataObjectTree)):
        raise TypeError(f"grid is a {type(grid).__name__}; a vtkUnstructuredGrid is needed, or "
                        "composite data.")
    filter_ = _make(method)
    for name, value in options.items():
        _set(filter_, name, value)
    messages = {"ErrorEvent": [], "WarningEvent": []}
    for event, texts in messages.items():
        def keep(_, __, text, texts=texts):
            # The first line names VTK's file and line, and ends in the object's address.
            texts.append(text.split("): ", 1)[-1].strip())
        keep.CallDataType = "string0"
        filter_.AddObserver(event, keep)
    filter_.SetInputDataObject(0, grid)
    filter_.SetBoundaryData(_boundary(grid, displaced, ids))
    filter_.Update()

    status = filter_.GetMorphStatus()
    result = _as(grid, filter_.GetOutputDataObject(0))
    cells = filter_.GetOutput(1).GetCellData().GetArray("MorphCellId")
    bad = vtk_to_numpy(cells).copy() if cells else numpy.empty(0, dtype=numpy.int64)
    errors, warned = messages["ErrorEvent"], messages["WarningEvent"]
    has_result = status not in ("Failed", "Cancelled", "None")
    if not has_result or not (allow_inverted or status in _VALID):
        text = " ".join(errors or warned) or f"{len(bad)} cells are inverted or collapsed."
        raise MorphError(text, status, bad, result)
    for text in errors + warned:
        warnings.warn(text, MorphWarning, stacklevel=2)
    return result
