# SPDX-License-Identifier: BSD-3-Clause
"""Meshes distributed on MPI ranks against the same filters on one: random partitions, with and
without global ids and ghost cells, empty ranks, the boundary elsewhere than the mesh.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython distributed.py
The same file is the job that the ranks run: mpiexec -n N pvbatch distributed.py FOLDER
"""
import json
import os
import sys
import tempfile
import unittest

import numpy
from paraview import servermanager, simple
from paraview.simple import (Calculator, LoadPlugin, PassArrays, Transform,
                             XMLPartitionedUnstructuredGridReader, XMLUnstructuredGridReader)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import (vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader,
                                 vtkXMLUnstructuredGridWriter)

import ranks as ranks_of_mpi

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

BEND = ("coordsX*iHat + coordsY*jHat + coordsZ*kHat"
        " + 0.2*(sin(2*coordsY)*iHat + coordsX*coordsZ*jHat + cos(3*coordsX)*kHat)")
FOLD = "coordsX*iHat + (coordsY + 3*coordsX*coordsX)*jHat + coordsZ*(1 - 1.6*coordsX)*kHat"


def model(shape, sizes, seed):
    """A bent block with inner nodes at random: its points and cells."""
    rng = numpy.random.default_rng(seed)
    n = numpy.array(sizes)
    index = numpy.stack(numpy.meshgrid(*[numpy.arange(k + 1) for k in n], indexing="ij"), -1)
    u = index.reshape(-1, 3) / n
    inner = ((index.reshape(-1, 3) > 0) & (index.reshape(-1, 3) < n)).all(1)
    u[inner] += rng.uniform(-0.15, 0.15, (inner.sum(), 3)) / n
    radius, angle = 1 + u[:, 0], 1.5 * u[:, 1]
    points = numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle),
                          0.8 * u[:, 2] + 0.2 * u[:, 0]], 1)
    number = numpy.arange(len(u)).reshape(n + 1)
    corner = [number[i:n[0] + i, j:n[1] + j, k:n[2] + k].ravel()
              for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    hexes = numpy.stack(corner, 1)
    if shape == VTK_HEXAHEDRON:
        return points, hexes
    kuhn = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    return points, hexes[:, kuhn].reshape(-1, 4)


def grid_of(points, cells, shape, point_ids=None, cell_ids=None):
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=1))
    grid.SetPoints(places)
    grid.Allocate(len(cells))
    for cell in cells:
        grid.InsertNextCell(shape, len(cell), cell.tolist())
    for ids, data in ((point_ids, grid.GetPointData()), (cell_ids, grid.GetCellData())):
        if ids is not None:
            array = numpy_to_vtk(numpy.asarray(ids, dtype=numpy.int64), deep=1,
                                 array_type=vtkIdTypeArray().GetDataType())
            array.SetName("GlobalIds")
            data.SetGlobalIds(array)
    return grid


def write(grid, path):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.Write()


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def write_pieces(folder, name, points, cells, shape, owner, ranks, with_ids):
    """A file for each rank's cells, and the .pvtu over them."""
    lines = []
    for rank in range(ranks):
        ids = numpy.flatnonzero(owner == rank)
        used, local = numpy.unique(cells[ids], return_inverse=True)
        piece = grid_of(points[used], local.reshape(-1, cells.shape[1]), shape,
                        used if with_ids else None, ids if with_ids else None)
        write(piece, os.path.join(folder, f"{name}_{rank}.vtu"))
        lines.append(f'<Piece Source="{name}_{rank}.vtu"/>')
    ids = ('<PPointData GlobalIds="GlobalIds"><PDataArray type="Int64" IdType="1" '
           'Name="GlobalIds"/></PPointData><PCellData GlobalIds="GlobalIds"><PDataArray '
           'type="Int64" IdType="1" Name="GlobalIds"/></PCellData>') if with_ids else ""
    path = os.path.join(folder, name + ".pvtu")
    with open(path, "w", encoding="utf-8") as file:
        file.write('<VTKFile type="PUnstructuredGrid" version="1.0" header_type="UInt32">'
                   '<PUnstructuredGrid GhostLevel="0">' + ids +
                   '<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>' +
                   "".join(lines) + "</PUnstructuredGrid></VTKFile>")
    return path


def boundary_of(grid, case):
    extracted = ExtractMorphBoundary(Input=grid)
    if case.get("transform"):
        moved = Transform(Input=extracted)
        moved.Transform.Scale = [1.2, 0.9, 1.1]
        moved.Transform.Rotate = [10, 20, 30]
        moved.Transform.Translate = [0.1, -0.2, 0.3]
        return moved
    if case.get("by_position"):
        moves = Calculator(Input=extracted, ResultArrayName="Move",
                           Function="(" + case["motion"] + ") - coords")
        return PassArrays(Input=moves, PointDataArrays=["Move"])
    return Calculator(Input=extracted, CoordinateResults=1, Function=case["motion"])


def morph(grid, boundary, case):
    filter_ = globals()[case["method"]](Input=grid, Boundary=boundary)
    for name, value in case.get("options", {}).items():
        setattr(filter_, name, value)
    return filter_


def job(folder):
    """Runs the cases of FOLDER/cases.json; writes a file for each rank and case."""
    with open(os.path.join(folder, "cases.json"), encoding="utf-8") as file:
        cases = json.load(file)
    for case in cases:
        grid = XMLPartitionedUnstructuredGridReader(FileName=[case["file"]])
        if case.get("ghosts"):
            # ParaView 6.1 has another name for it.
            ghost_cells = getattr(simple, "GhostCellsGenerator", None) or simple.GhostCells
            grid = ghost_cells(Input=grid, BuildIfRequired=0,
                               MinimumNumberOfGhosts=case["ghosts"])
        source = grid
        if "elsewhere" in case:
            source = XMLPartitionedUnstructuredGridReader(FileName=[case["elsewhere"]])
        print("CASE", case["name"], flush=True)
        filter_ = morph(grid, boundary_of(source, case), case)
        filter_.UpdatePipeline()
        simple.SaveData(os.path.join(folder, case["name"] + ".pvtu"), proxy=filter_,
                        DataMode="Binary", FieldDataArrays=[])
        boundary = ExtractMorphBoundary(Input=grid)
        simple.SaveData(os.path.join(folder, case["name"] + "_boundary.pvtp"), proxy=boundary,
                        DataMode="Binary")
        quality = ScaledJacobian(Input=filter_)
        simple.SaveData(os.path.join(folder, case["name"] + "_quality.pvtu"), proxy=quality,
                        DataMode="Binary")
    print("DONE", flush=True)


def pieces(folder, name, ranks, kind="vtu"):
    """The files that the ranks wrote, in their order."""
    reader = {"vtu": vtkXMLUnstructuredGridReader, "vtp": vtkXMLPolyDataReader}[kind]
    result = []
    for rank in range(ranks):
        path = os.path.join(folder, name, f"{name}_{rank}.{kind}")
        if os.path.exists(path):
            one = reader()
            one.SetFileName(path)
            one.Update()
            result.append(one.GetOutput())
    return result


def array(data, name):
    return vtk_to_numpy(data.GetArray(name))


class Distributed(unittest.TestCase):
    """One run of mpiexec for all cases of a number of ranks."""
    RESULTS = ("MinScaledJacobian", "MeanScaledJacobian", "InvertedCells", "DegenerateCells",
               "WorstCellId", "MirroredBodies")

    def compare(self, folder, case, points, cells, shape, ranks):
        path = os.path.join(folder, case["name"] + "_whole.vtu")
        write(grid_of(points, cells, shape), path)
        grid = XMLUnstructuredGridReader(FileName=[path])
        serial = morph(grid, boundary_of(grid, case), case)
        expected = servermanager.Fetch(serial)
        positions = vtk_to_numpy(expected.GetPoints().GetData())
        size = numpy.linalg.norm(points.max(0) - points.min(0))
        tolerance = size * case.get("tolerance", 1e-8)
        seen = numpy.zeros(len(points), bool)
        measured = 0
        for piece in pieces(folder, case["name"], ranks):
            if piece.GetNumberOfPoints() == 0:
                continue
            moved = vtk_to_numpy(piece.GetPoints().GetData())
            rest = moved - array(piece.GetPointData(), "MorphDisplacement")
            if piece.GetPointData().GetGlobalIds() and not case.get("made_ids"):
                ids = vtk_to_numpy(piece.GetPointData().GetGlobalIds())
            else:
                ids = ((rest[:, None] - points[None])**2).sum(2).argmin(1)
            self.assertLess(numpy.abs(rest - points[ids]).max(), 1e-12, case["name"])
            self.assertLess(numpy.abs(moved - positions[ids]).max(), tolerance, case["name"])
            seen[ids] = True
            jacobian = array(piece.GetCellData(), "ScaledJacobian")
            measured += numpy.isfinite(jacobian).sum()
            for name in self.RESULTS:
                mine = array(piece.GetFieldData(), name)[0]
                whole = array(expected.GetFieldData(), name)[0]
                if name == "WorstCellId" and case.get("made_ids"):
                    continue
                self.assertAlmostEqual(mine, whole, delta=1e-8, msg=case["name"] + " " + name)
            status = piece.GetFieldData().GetAbstractArray("MorphStatus").GetValue(0)
            self.assertEqual(
                status, expected.GetFieldData().GetAbstractArray("MorphStatus").GetValue(0))
        self.assertTrue(seen.all(), case["name"])
        self.assertEqual(measured, len(cells), case["name"])
        self.compare_boundary(folder, case, grid, points, ranks)
        self.compare_quality(folder, case, servermanager.Fetch(ScaledJacobian(Input=serial)),
                             ranks)

    def compare_boundary(self, folder, case, grid, points, ranks):
        """Interfaces are no boundary, and ids are global."""
        whole = servermanager.Fetch(ExtractMorphBoundary(Input=grid))
        outer, polygons = set(), 0
        for piece in pieces(folder, case["name"] + "_boundary", ranks, "vtp"):
            polygons += piece.GetNumberOfCells()
            if piece.GetNumberOfPoints() == 0:
                continue
            ids = array(piece.GetPointData(), "MorphPointId")
            if not case.get("made_ids"):
                places = vtk_to_numpy(piece.GetPoints().GetData())
                self.assertLess(numpy.abs(places - points[ids]).max(), 1e-12, case["name"])
            outer.update(ids.tolist())
        self.assertEqual(polygons, whole.GetNumberOfCells(), case["name"])
        self.assertEqual(len(outer), whole.GetNumberOfPoints(), case["name"])

    def compare_quality(self, folder, case, expected, ranks):
        """Scaled Jacobian downstream has the numbers of the whole mesh on each rank."""
        for piece in pieces(folder, case["name"] + "_quality", ranks):
            if piece.GetNumberOfPoints() == 0:
                continue
            for name in self.RESULTS[:4]:
                self.assertAlmostEqual(
                    array(piece.GetFieldData(), name)[0],
                    array(expected.GetFieldData(), name)[0], delta=1e-8,
                    msg=case["name"] + " quality " + name)

    def run_cases(self, ranks, seed):
        print("ranks", ranks, "seed", seed)
        rng = numpy.random.default_rng(seed)
        hexes = model(VTK_HEXAHEDRON, (8, 6, 5), 1)
        tets = model(VTK_TETRA, (5, 4, 4), 2)
        solver = {"Tolerance": 1e-12}
        cases = [
            {"name": "random", "method": "MorphFEMWARP", "options": solver, "motion": BEND},
            {"name": "no_ids", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "made_ids": True},
            {"name": "ghosts", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "ghosts": 1},
            {"name": "two_layers", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "ghosts": 2, "shape": VTK_TETRA},
            {"name": "elsewhere", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "boundary_elsewhere": True},
            {"name": "by_position", "method": "MorphFEMWARP", "motion": BEND, "by_position": True,
             "options": {"Tolerance": 1e-12, "DisplacementArray": "Move"}},
            {"name": "mesh_on_one", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "boundary_elsewhere": True, "owner": 0},
            {"name": "folds", "method": "MorphFEMWARP", "options": solver, "motion": FOLD,
             "warns": True},
            {"name": "empty_rank", "method": "MorphFEMWARP", "options": solver, "motion": BEND,
             "shape": VTK_TETRA, "empty": True},
            {"name": "affine", "method": "MorphFEMWARP", "transform": True, "tolerance": 1e-10},
            {"name": "lbwarp", "method": "MorphLBWARP", "options": solver, "motion": BEND},
            {"name": "lbwarp_affine", "method": "MorphLBWARP", "transform": True,
             "tolerance": 1e-10, "shape": VTK_TETRA},
            {"name": "weighted", "method": "MorphWeightedResidual", "motion": BEND},
            {"name": "linear", "method": "MorphSimplexLinear", "motion": BEND},
            {"name": "radial", "method": "MorphRadialBasis", "motion": BEND},
            {"name": "natural", "method": "MorphSimplexNaturalNeighbor", "motion": BEND,
             "shape": VTK_TETRA},
        ]
        with tempfile.TemporaryDirectory() as folder:
            for case in cases:
                shape = case.get("shape", VTK_HEXAHEDRON)
                points, cells = hexes if shape == VTK_HEXAHEDRON else tets
                owner = rng.integers(0, ranks - 1 if case.get("empty") else ranks, len(cells))
                if "owner" in case:
                    owner[:] = case["owner"]
                if case.get("empty") and ranks > 2:
                    owner[owner == 1] = ranks - 1
                case["file"] = write_pieces(folder, case["name"], points, cells, shape, owner,
                                            ranks, not case.get("made_ids"))
                if case.get("boundary_elsewhere"):
                    case["elsewhere"] = write_pieces(
                        folder, case["name"] + "_source", points, cells, shape,
                        rng.integers(0, ranks, len(cells)), ranks, True)
            with open(os.path.join(folder, "cases.json"), "w", encoding="utf-8") as file:
                json.dump(cases, file)
            output = ranks_of_mpi.run(ranks, __file__, folder)
            self.assertNotIn("ERR|", output)
            self.assertIn("DONE", output)
            for case in cases:
                with self.subTest(case["name"]):
                    shape = case.get("shape", VTK_HEXAHEDRON)
                    points, cells = hexes if shape == VTK_HEXAHEDRON else tets
                    self.compare(folder, case, points, cells, shape, ranks)

    def test_two_ranks(self):
        self.run_cases(2, int(os.environ.get("MORPH_TEST_SEED", "3")))

    def test_three_ranks(self):
        self.run_cases(3, int(os.environ.get("MORPH_TEST_SEED", "4")))


if __name__ == "__main__":
    if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]):
        job(sys.argv[1])
    else:
        unittest.main()
