# SPDX-License-Identifier: BSD-3-Clause
"""The rows of freeze.py: {name: (kind, function)}. The function makes a filter's proxy; it returns
(proxy,), (proxy, output port) or (proxy, output port, time)."""

from functools import lru_cache
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON, VTK_POLYHEDRON, VTK_PYRAMID, VTK_QUADRATIC_HEXAHEDRON, VTK_QUADRATIC_TETRA,
    VTK_TETRA, VTK_WEDGE, vtkMultiBlockDataSet, vtkPolyData, vtkUnstructuredGrid)
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from demo_picture import producer

ROOT = Path(__file__).resolve().parents[2]
SMALL = ROOT / "Data" / "Models" / "small"
OTHERS = ROOT.parent / "shared" / "meshes"

MODELS = [f"{model}_{kind}" for model in ("bore", "pipe", "canister", "courier")
          for kind in ("hex", "tet")]
OTHER_MESHES = {"cub_fru": "cub_fru.vtk", "tire": "tire.vtk", "tangled": "hex_5_tangled.vtk",
                "untangle": "par_untangle_original_hex_mesh.1.0.vtk",
                "mixed": "mixed-hex-pyr-tet.vtk"}

SOLVE = {"Tolerance": 1e-13}
LINEAR = {
    "FEMWARP": ("MorphFEMWARP", SOLVE),
    "LBWARP": ("MorphLBWARP", {**SOLVE, "OutsideHull": "Relax"}),
    "WeightedResidual": ("MorphWeightedResidual", {}),
    "SimplexLinear": ("MorphSimplexLinear", {}),
    "NaturalNeighbor": ("MorphSimplexNaturalNeighbor", {}),
    "RadialBasis": ("MorphRadialBasis", {}),
}
SEARCHES = {"Smoothing": ("MorphSmoothing", {}), "InversionFree": ("MorphInversionFree", {})}


def is_on_missing_mesh(name):
    mesh = name.split("/")[1]
    return mesh in OTHER_MESHES and not (OTHERS / OTHER_MESHES[mesh]).exists()


# Meshes.

@lru_cache(maxsize=None)
def grid(name):
    """A vtkUnstructuredGrid: a file's, or with a prefix other cells made of it."""
    if name in OTHER_MESHES:
        reader = vtkUnstructuredGridReader()
        reader.SetFileName(str(OTHERS / OTHER_MESHES[name]))
    elif name.startswith("polyhedra_"):
        return as_polyhedra(grid(name[len("polyhedra_"):]))
    elif name.startswith("pairs_"):
        return as_pairs(grid(name[len("pairs_"):]))
    elif name.startswith("quadratic_"):
        return as_quadratic(grid(name[len("quadratic_"):]))
    else:
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(SMALL / f"{name}_small.vtu"))
    reader.Update()
    return reader.GetOutput()


FACES = {
    VTK_TETRA: ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
    VTK_HEXAHEDRON: ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1),
                     (4, 5, 6, 7)),
    VTK_WEDGE: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    VTK_PYRAMID: ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
}
EDGES = {
    VTK_TETRA: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    VTK_HEXAHEDRON: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                     (2, 6), (3, 7)),
}
QUADRATIC = {VTK_TETRA: VTK_QUADRATIC_TETRA, VTK_HEXAHEDRON: VTK_QUADRATIC_HEXAHEDRON}


def cells_of(mesh):
    """(type, node ids) of each cell."""
    ids = vtkIdList()
    for cell in range(mesh.GetNumberOfCells()):
        mesh.GetCellPoints(cell, ids)
        yield mesh.GetCellType(cell), [ids.GetId(i) for i in range(ids.GetNumberOfIds())]


def faces_of(mesh):
    return [[tuple(nodes[corner] for corner in face) for face in FACES[kind]]
            for kind, nodes in cells_of(mesh)]


def polyhedral_grid(mesh, cells):
    """The points of `mesh`, with its arrays, and a polyhedron of each list of faces."""
    result = vtkUnstructuredGrid()
    result.SetPoints(mesh.GetPoints())
    result.GetPointData().ShallowCopy(mesh.GetPointData())
    result.Allocate(len(cells))
    for faces in cells:
        stream = vtkIdList()
        stream.InsertNextId(len(faces))
        for face in faces:
            for number in (len(face), *face):
                stream.InsertNextId(number)
        result.InsertNextCell(VTK_POLYHEDRON, stream)
    return result


def as_polyhedra(mesh):
    """The same cells, as polyhedra."""
    return polyhedral_grid(mesh, faces_of(mesh))


def as_pairs(mesh):
    """Neighboring cells two by two as one polyhedron, in the order of the cells."""
    cells, first_cell, partner = faces_of(mesh), {}, {}
    for cell, faces in enumerate(cells):
        for face in faces:
            other = first_cell.setdefault(frozenset(face), cell)
            if other != cell and other not in partner and cell not in partner:
                partner[cell], partner[other] = other, cell
    joined = []
    for cell, faces in enumerate(cells):
        other = partner.get(cell, cell)
        if other > cell:
            both = {frozenset(face) for face in faces} & {frozenset(face) for face in cells[other]}
            faces = [face for face in faces + cells[other] if frozenset(face) not in both]
        if other >= cell:
            joined.append(faces)
    return polyhedral_grid(mesh, joined)


def as_quadratic(mesh):
    """The same cells with nodes in the middle of their edges."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    middle, cells = {}, []
    for kind, nodes in cells_of(mesh):
        ends = (tuple(sorted((nodes[a], nodes[b]))) for a, b in EDGES[kind])
        cells.append((QUADRATIC[kind],
                      nodes + [middle.setdefault(edge, len(points) + len(middle))
                               for edge in ends]))
    ends = np.array(list(middle))
    result = vtkUnstructuredGrid()
    result.SetPoints(vtk_points(np.concatenate([points, points[ends].mean(axis=1)])))
    for kind, nodes in cells:
        result.InsertNextCell(kind, len(nodes), nodes)
    return result


def vtk_points(positions):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=float), deep=True))
    return points


def with_array(data, name, values, cells=False):
    result = data.NewInstance()
    result.ShallowCopy(data)
    wrapped = WrapDataObject(result)
    (wrapped.CellData if cells else wrapped.PointData).append(np.ascontiguousarray(values), name)
    return result


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def size_of(points):
    return np.linalg.norm(np.ptp(points, axis=0))


# Motions of all points; they take and return (n, 3).

def bent(points):
    """A smooth bend by a twentieth of the size."""
    low, size = points.min(axis=0), size_of(points)
    x, y, z = (2 * np.pi * (points - low) / size).T
    return points + 0.05 * size * np.column_stack([np.sin(y), np.sin(z), np.sin(x)])


def moved_boundary(mesh, move=None, part=1.0):
    """The boundary of the proxy `mesh`, as a proxy: at `move` of its points, or, without it, at the
    final shape of the model, or part of the way there."""
    extract = simple.ExtractMorphBoundary(Input=mesh)
    extract.UpdatePipeline()
    surface = extract.GetClientSideObject().GetOutputDataObject(0)
    points = points_of(surface)
    if move is None:
        whole = mesh.GetClientSideObject().GetOutputDataObject(0).GetPointData()
        ids = vtk_to_numpy(surface.GetPointData().GetArray("MorphPointId"))
        points = points + part * vtk_to_numpy(whole.GetArray("FinalDisplacement"))[ids]
    else:
        points = move(points)
    result = vtkPolyData()
    result.ShallowCopy(surface)
    result.SetPoints(vtk_points(points))
    return producer(result)


def morph(method, mesh, move=None, part=1.0, at=None, **options):
    """A row's function: a morph filter on the mesh of that name."""
    filter_name, always = {**LINEAR, **SEARCHES}[method]

    def make():
        rest = producer(grid(mesh)) if isinstance(mesh, str) else mesh()
        return (getattr(simple, filter_name)(
            Input=rest, Boundary=moved_boundary(rest, move, part),
            OutputPointsPrecision="Double", **{**always, **options}), 0, at)
    return make


def method_rows():
    for mesh in MODELS:
        few = mesh not in ("bore_hex", "pipe_tet", "canister_tet", "courier_hex")
        for method in ("FEMWARP", "RadialBasis") if few else LINEAR:
            yield f"{method}/{mesh}", "exact", morph(method, mesh)
        for method in ("InversionFree",) if few else SEARCHES:
            yield f"{method}/{mesh}", "search", morph(method, mesh)
    for mesh in ("cub_fru", "tire"):
        for method in ("FEMWARP", "LBWARP", "SimplexLinear", "RadialBasis"):
            yield f"{method}/{mesh}", "exact", morph(method, mesh, bent)
    for mesh in ("tangled", "untangle", "mixed"):
        same = lambda points: points  # noqa: E731
        for method in ("FEMWARP", "RadialBasis"):
            yield f"{method}/{mesh}", "exact", morph(method, mesh, bent)
        for method in SEARCHES:
            yield f"{method}/{mesh}", "search", morph(method, mesh, same)


def option_rows():
    """Options of the morph filters, most of them on FEMWARP."""
    for name, options in {
        "scale": {"ScaleFactor": 0.5},
        "free_rest": {"FixUnnamedBoundary": 0},
        "inverse_volume": {"Stiffness": "Inverse volume"},
        "exponent": {"Stiffness": "Inverse volume", "StiffnessExponent": 0.5},
        "wall_distance": {"Stiffness": "Wall distance"},
        "certify": {"Certify": 1},
        "surface_quality": {"Quality": "Surface"},
        "feature_lines": {"FeatureLines": 1},
        "steps": {"NumberOfSteps": 4, "at": 0.5},
        "relative_steps": {"NumberOfSteps": 4, "Stepping": "Relative", "at": 1.0},
    }.items():
        yield f"FEMWARP.{name}/bore_hex", "exact", morph("FEMWARP", "bore_hex", **options)
    yield ("FEMWARP.inverse_volume/pipe_tet", "exact",
           morph("FEMWARP", "pipe_tet", Stiffness="Inverse volume"))
    yield "FEMWARP.one_thread/bore_hex", "exact", morph("FEMWARP", "bore_hex", NumberOfThreads=1)
    yield ("RadialBasis.thin_plate/pipe_hex", "exact",
           morph("RadialBasis", "pipe_hex", Kernel="Thin plate"))
    yield ("RadialBasis.wendland/pipe_hex", "exact",
           morph("RadialBasis", "pipe_hex", Kernel="Wendland C2", SupportRadius=0.5))
    yield ("RadialBasis.centers/pipe_tet", "exact",
           morph("RadialBasis", "pipe_tet", NumberOfCenters=100))
    yield ("WeightedResidual.neighbors/pipe_hex", "exact",
           morph("WeightedResidual", "pipe_hex", NumberOfNeighbors=20))
    yield ("LBWARP.inside/bore_hex", "exact", morph("LBWARP", "bore_hex", part=0.25))
    for name, options in {
        "sub_step": {"Validity": "Sub step"}, "repair": {"Validity": "Repair"},
        "refuse": {"Validity": "Refuse"}, "post_smooth": {"PostSmooth": 1},
    }.items():
        yield f"FEMWARP.{name}/canister_hex", "search", morph("FEMWARP", "canister_hex", **options)
        yield f"FEMWARP.{name}/canister_tet", "search", morph("FEMWARP", "canister_tet", **options)
    for effort in ("Quick", "Thorough"):
        yield (f"InversionFree.{effort.lower()}/pipe_hex", "search",
               morph("InversionFree", "pipe_hex", Effort=effort))
    for name, options in {
        "condition": {"Objective": "Condition number"}, "ratio": {"Objective": "Mean ratio"},
        "initial": {"TargetShape": "Initial"},
    }.items():
        yield f"Smoothing.{name}/pipe_tet", "search", morph("Smoothing", "pipe_tet", **options)


# What moves the boundary.

def morph_mesh(mesh, changes=None, proxy="MorphMesh", **options):
    def make():
        rest = producer(grid(mesh)) if isinstance(mesh, str) else mesh()
        made = getattr(simple, proxy)(Input=rest, OutputPointsPrecision="Double", **options)
        if changes:
            changes(made)
        return (made,)
    return make


def box(proxy):
    proxy.Region = "Box"
    proxy.Region.Position, proxy.Region.Length = [-9, -9, 0.5], [18, 18, 9]


def turned(proxy):
    proxy.Transform.Rotate, proxy.Transform.Scale = [0, 0, 20], [1.1, 1, 0.95]


MOTIONS = {
    "transform": ({}, turned),
    "vector": ({"Vector": [0.05, 0.02, 0.1]}, None),
    "normals": ({"How": "Along normals", "Distance": 0.03}, None),
    "array": ({"How": "Array", "DisplacementArray": "FinalDisplacement",
               "ScaleFactor": 0.5}, None),
    "numbers": ({"How": "Translate, rotate, scale", "Translation": [0, 0, 0.1],
                 "Rotation": [5, 0, 20], "Scale": [1.1, 1, 1]}, None),
    "radius": ({"How": "Radius", "RadiusChange": 0.1}, None),
    "handles": ({"How": "Handles", "Handles": [0, 0, 2, 0.1, 0, 0, 0.8, 0, 0, 0, 0, 0.1, 0, 1]},
                None),
    "free_handles": ({"How": "Handles", "Handles": [1, 0, 0, 0.1, 0, 0, 0, -1, 0, 0, 0, 0.1, 0, 0,
                                                    0, 1, 0, 0, 0, 0.1, 0, 0, 0, 2, 0, 0, 0, 0]},
                     None),
    "lattice": ({"How": "Lattice", "LatticeDisplacements": [1, 1, 2, 0.2, 0.1, 0]}, None),
    "b_splines": ({"How": "Lattice", "LatticeBasis": "B-spline", "LatticeSize": [4, 4, 5],
                   "LatticeDisplacements": [1, 1, 3, 0.2, 0.1, 0]}, None),
}
AROUND = {
    "stay": {"Surroundings": "Stay"},
    "fade": {"Surroundings": "Fade", "FalloffRadius": 0.6},
    "everywhere": {"Surroundings": "Follow everywhere"},
    "smoothing": {"SurfaceMethod": "Smoothing"},
    "mesh_smoothing": {"SurfaceMethod": "Mesh smoothing"},
}


def motion(options, default="Vector"):
    """The options with How under the name of the filter's property."""
    options = dict(options)
    options["Displacement"] = options.pop("How", default)
    return options


def boundary_rows():
    chosen = {"Moving": "Surfaces", "Surfaces": ["Surface 0"]}
    for name, (options, changes) in MOTIONS.items():
        default = "Transform" if changes else "Vector"
        yield (f"BoundaryDisplacement.{name}/canister_hex", "solved", morph_mesh(
            "canister_hex", changes, "BoundaryDisplacement",
            **motion({**chosen, **options}, default)))
        yield (f"MorphMesh.{name}/canister_hex", "solved", morph_mesh(
            "canister_hex", changes, Surfaces=["Surface 0"],
            **motion(options, default)))
    bulge = {"Displacement": "Translate, rotate, scale", "Translation": [0, 0.05, 0.1],
             "Rotation": [0, 0, 10]}
    for mesh in ("canister_tet", "pipe_hex"):
        for name, options in AROUND.items():
            yield (f"MorphMesh.{name}/{mesh}", "solved",
                   morph_mesh(mesh, Surfaces=["Surface 0"], **bulge, **options))
    for name, options in {
        "fixed": {"FixedSurfaces": ["Surface 1"]},
        "sliding": {"SlidingSurfaces": ["Surface 2"]},
        "slide_rounds": {"SlidingSurfaces": ["Surface 2"], "SlideRounds": 3},
        "free": {"FreeSurfaces": ["Surface 2"]},
        "layers": {"KeepLayers": 2},
        "soft_wall": {"Stiffness": "Wall distance", "KeepLayers": 1},
        "angles": {"UseGeometryArrays": 0, "FeatureAngle": 40},
        "steps": {"NumberOfSteps": 3},
    }.items():
        yield (f"MorphMesh.{name}/canister_hex", "solved",
               morph_mesh("canister_hex", Surfaces=["Surface 0"], **{**bulge, **options}))
    yield "MorphMesh.nothing/bore_hex", "solved", morph_mesh("bore_hex")
    yield ("MorphMesh.region/canister_hex", "solved",
           morph_mesh("canister_hex", box, Moving="Region", **bulge))
    for method in ("LBWARP", "Weighted residual", "Simplex-linear", "Simplex-natural neighbor",
                   "Radial basis"):
        yield (f"MorphMesh.{method}/pipe_hex", "solved",
               morph_mesh("pipe_hex", Surfaces=["Surface 0"], Method=method, **bulge))
    for method in ("Smoothing", "Inversion-free"):
        yield (f"MorphMesh.{method}/pipe_hex", "search",
               morph_mesh("pipe_hex", Surfaces=["Surface 0"], Method=method, **bulge))
    far = {"Displacement": "Vector", "Vector": [0, 0, 0.8]}
    for validity in ("Report", "Sub step", "Repair", "Refuse"):
        yield (f"MorphMesh.{validity}/canister_hex", "search",
               morph_mesh("canister_hex", Surfaces=["Surface 1"], Validity=validity, **far))


def zone_mesh():
    """The canister with a zone of nodes and a zone of cells."""
    mesh = grid("canister_hex")
    points = points_of(mesh)
    upper = points[:, 2] > np.quantile(points[:, 2], 0.7)
    mesh = with_array(mesh, "upper", (upper & (points[:, 0] > 0)).astype(float))
    corner = np.array([points[nodes].mean(axis=0) for _, nodes in cells_of(mesh)])
    left = (corner[:, 0] < -0.3).astype(float)
    mesh = with_array(mesh, "left", left, cells=True)
    return producer(with_array(mesh, "stiff", 1 + 9 * left, cells=True))


def zone_rows():
    bulge = {"Surfaces": ["Surface 0"], "Displacement": "Translate, rotate, scale",
             "Translation": [0, 0.01, 0.02], "Rotation": [0, 0, 5]}
    for name, options in {
        "frozen": {"FixedZones": ["upper"]}, "rigid": {"RigidZones": ["upper"]},
        "frozen_cells": {"FixedZones": ["left"]}, "soft": {"SoftZones": ["left"]},
        "both": {"FixedZones": ["left"], "RigidZones": ["upper"]},
        "stiff_array": {"Stiffness": "Uniform", "StiffnessArray": "stiff"},
    }.items():
        yield (f"MorphMesh.zones_{name}/canister_hex", "solved",
               morph_mesh(zone_mesh, **{**bulge, **options}))


def given_curves(mesh, options):
    def make():
        rest = producer(grid(mesh))
        return (simple.MorphBoundary(Input=rest, Boundary=moved_boundary(rest, part=0.4),
                                     OutputPointsPrecision="Double", **options),)
    return make


def morph_boundary_rows():
    for mesh in ("pipe_tet", "canister_hex", "courier_tet"):
        for method in ("Weighted residual", "Smoothing", "Mesh smoothing"):
            kind = "search" if method == "Mesh smoothing" else "exact"
            yield (f"MorphBoundary.{method}/{mesh}", kind,
                   given_curves(mesh, {"SurfaceMethod": method}))
    for name, options in {
        "vertices": {"PrescribedDimension": "Vertices"},
        "surfaces": {"PrescribedDimension": "Vertices, curves and surfaces"},
        "rigid": {"UnattachedMotion": "Follow rigidly"},
        "neighbors": {"NumberOfNeighbors": 5},
        "angles": {"UseGeometryArrays": 0, "FeatureAngle": 40},
    }.items():
        yield f"MorphBoundary.{name}/courier_hex", "exact", given_curves("courier_hex", options)


def fitted(mesh, part, **options):
    def make():
        rest = producer(grid(mesh))
        target = simple.ExtractSurface(Input=moved_boundary(rest, part=part))
        return (simple.FittoSurface(Input=rest, Target=simple.Triangulate(Input=target),
                                    OutputPointsPrecision="Double", **options),)
    return make


def fit_rows():
    for mesh in ("canister_hex", "canister_tet", "pipe_hex", "pipe_tet"):
        yield f"Fit/{mesh}", "solved", fitted(mesh, 0.1)
    for name, options in {"aligned": {"AlignTarget": 1}, "one_surface": {"Surfaces": ["Surface 0"]},
                          "reach": {"TargetReach": 0.02}, "angle": {"TargetAngle": 20}}.items():
        yield f"Fit.{name}/canister_tet", "solved", fitted("canister_tet", 0.1, **options)


def shapes(mesh, **options):
    def make():
        rest = producer(grid(mesh))
        two = [moved_boundary(rest), moved_boundary(rest, bent)]
        return (simple.MorphShapes(Input=rest, Shapes=two, ShapeNames=["final", "bent"],
                                   OutputPointsPrecision="Double", **{**SOLVE, **options}),)
    return make


def shape_rows():
    for name, options in {
        "two": {"Weights": [0.5, 0.25]}, "back": {"Weights": [-0.25, 0.5]},
        "one": {"Weights": [0, 1], "FindValidRanges": 0},
        "LBWARP": {"Weights": [0.5, 0.25], "Method": "LBWARP"},
        "radial": {"Weights": [0.5, 0.25], "Method": "Radial basis"},
        "surface": {"Weights": [0.5, 0.25], "Quality": "Surface"},
    }.items():
        yield f"MorphShapes.{name}/bore_hex", "exact", shapes("bore_hex", **options)
    yield "MorphShapes.two/courier_tet", "exact", shapes("courier_tet", Weights=[0.5, 0.25])


def adjoint(mesh, method):
    def make():
        proxy = morph(method, mesh)()[0]
        proxy.UpdatePipeline()
        data = proxy.GetClientSideObject().GetOutputDataObject(0)
        objective = producer(with_array(data, "dJdx", np.sin(points_of(data))))
        return (simple.MorphAdjoint(Input=proxy.Input, Boundary=proxy.Boundary, Gradient=objective,
                                    GradientArray="dJdx", Morph=proxy),)
    return make


def boundary_only(mesh, name, port=0, **options):
    return lambda: (getattr(simple, name)(Input=producer(grid(mesh)), **options), port)


def other_filter_rows():
    for method in ("FEMWARP", "LBWARP", "RadialBasis"):
        yield f"Adjoint.{method}/bore_tet", "exact", adjoint("bore_tet", method)
    for mesh in ("bore_hex", "courier_tet", "mixed", "quadratic_pipe_hex"):
        yield f"Extract/{mesh}", "exact", boundary_only(mesh, "ExtractMorphBoundary")
    for mesh in ("canister_hex", "courier_tet", "cub_fru", "tire", "mixed"):
        yield f"Classify/{mesh}", "exact", boundary_only(
            mesh, "ClassifyBoundary", 1, UseGeometryArrays=0, FeatureAngle=40)
    for mesh in ("courier_hex", "pipe_tet", *OTHER_MESHES, "polyhedra_mixed", "pairs_bore_hex",
                 "quadratic_pipe_hex"):
        yield f"ScaledJacobian/{mesh}", "exact", boundary_only(mesh, "ScaledJacobian")
    yield "ScaledJacobian.certify/untangle", "exact", boundary_only(
        "untangle", "ScaledJacobian", Certify=1)
    yield "ScaledJacobian.certify/quadratic_bore_tet", "exact", boundary_only(
        "quadratic_bore_tet", "ScaledJacobian", Certify=1)

    def compare():
        rest = producer(grid("bore_hex"))
        return (simple.CompareMorphMethods(Input=rest, Boundary=moved_boundary(rest),
                                           NumberOfSteps=2, Smoothing=0, InversionFree=0),)
    yield "Compare/bore_hex", "exact", compare


def cell_kind_rows():
    for mesh in ("polyhedra_bore_hex", "pairs_pipe_hex"):
        for method in LINEAR:
            yield f"{method}/{mesh}", "exact", morph(method, mesh)
        for method in SEARCHES:
            yield f"{method}/{mesh}", "search", morph(method, mesh)
        yield f"MorphMesh/{mesh}", "solved", morph_mesh(
            mesh, Surfaces=["Surface 0"], Displacement="Vector", Vector=[0, 0.05, 0.1])
    yield "FEMWARP/polyhedra_mixed", "exact", morph("FEMWARP", "polyhedra_mixed", bent)
    for mesh in ("polyhedra_canister_tet", "polyhedra_canister_hex"):
        yield (f"FEMWARP.repair/{mesh}", "search",
               morph("FEMWARP", mesh, part=0.8, Validity="Repair"))
    for mesh in ("quadratic_bore_tet", "quadratic_pipe_hex"):
        for method in LINEAR:
            yield f"{method}/{mesh}", "exact", morph(method, mesh, bent)
        for method in SEARCHES:
            yield f"{method}/{mesh}", "search", morph(method, mesh, bent)


def two_blocks():
    """The bore in two blocks, with a block of faces beside them."""
    mesh = grid("bore_hex")
    centers = np.array([points_of(mesh)[nodes].mean(axis=0) for _, nodes in cells_of(mesh)])
    blocks = vtkMultiBlockDataSet()
    for block, side in enumerate((centers[:, 0] > 0, centers[:, 0] <= 0)):
        part = producer(with_array(mesh, "side", side.astype(float), cells=True))
        half = simple.Threshold(Input=part, Scalars=["CELLS", "side"], LowerThreshold=0.5,
                                UpperThreshold=1.5)
        half.UpdatePipeline()
        blocks.SetBlock(block, half.GetClientSideObject().GetOutputDataObject(0))
    outer = simple.ExtractMorphBoundary(Input=producer(mesh))
    outer.UpdatePipeline()
    blocks.SetBlock(2, outer.GetClientSideObject().GetOutputDataObject(0))
    return producer(blocks)


def composite_rows():
    for method in ("FEMWARP", "SimplexLinear", "RadialBasis"):
        yield f"{method}.blocks/bore_hex", "exact", morph(method, two_blocks, bent)
    yield "InversionFree.blocks/bore_hex", "search", morph("InversionFree", two_blocks, bent)
    for name in ("Merge", "Merge by position", "Keep apart"):
        yield (f"MorphMesh.blocks_{name}/bore_hex", "solved", morph_mesh(
            two_blocks, Moving="Everything", Displacement="Translate, rotate, scale",
            Rotation=[0, 0, 10], Scale=[1.2, 1, 1], CoincidentPoints=name))
    yield "ScaledJacobian.blocks/bore_hex", "exact", lambda: (
        simple.ScaledJacobian(Input=two_blocks()),)


def all_rows():
    found = {}
    for rows in (method_rows, option_rows, boundary_rows, zone_rows, morph_boundary_rows, fit_rows,
                 shape_rows, other_filter_rows, cell_kind_rows, composite_rows):
        for name, kind, make in rows():
            assert name not in found, name
            if not any(part in name for part in missing()):
                found[name] = (kind, make)
    return found


@lru_cache(maxsize=None)
def missing():
    return [f"/{prefix}{name}" for name, file in OTHER_MESHES.items()
            if not (OTHERS / file).exists() for prefix in ("", "polyhedra_")]
