# SPDX-License-Identifier: BSD-3-Clause
"""The same morph on a mesh from files of several formats, and its result saved to several: nodes,
ids, arrays and sets survive.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython file_formats.py
"""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import ensight
from versions import blocks_for_exodus, number_points

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
BENT = "coords+0.9*coordsX*sin(coordsZ/1.5)*jHat"
# Debian's expat cannot read the appended data of the default.
ASCII = {"DataMode": "Ascii"}

# A cube with a name for its volume and for two of its faces, of edges that Gmsh meshes, too.
CUBE = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 2, 2};
Physical Surface("left") = {1};
Physical Surface("right") = {2};
Physical Volume("body") = {1};
Mesh.MeshSizeMax = 0.7;
Mesh.SaveAll = 1;
"""


def fetched(proxy):
    proxy.UpdatePipeline()
    # ParaView 5.11 fetches nothing of a collection of partitioned data sets.
    data = proxy.SMProxy.GetClientSideObject().GetOutputDataObject(0)
    return data if data.IsA("vtkDataObjectTree") else servermanager.Fetch(proxy)


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def values(attributes, name):
    return vtk_to_numpy(attributes.GetArray(name))


def opened(path):
    """A file with every array."""
    reader = simple.OpenDataFile(path)
    for name in ("CellArrayStatus", "PointArrayStatus"):
        if name in reader.ListProperties():
            setattr(reader, name, reader.GetProperty(name).GetAvailable())
    reader.UpdatePipeline()
    return reader


def grids(data):
    """The grids of a file: it, or its blocks."""
    if not data.IsA("vtkDataObjectTree"):
        return [data]
    found = []
    item = data.NewIterator()
    item.InitTraversal()
    while not item.IsDoneWithTraversal():
        found.append(item.GetCurrentDataObject())
        item.GoToNextItem()
    return found


def names(data):
    """The names of a file's blocks, in order."""
    if not data.IsA("vtkDataObjectTree"):
        return []
    item = data.NewTreeIterator()
    item.VisitOnlyLeavesOff()
    item.InitTraversal()
    found = []
    while not item.IsDoneWithTraversal():
        if item.HasCurrentMetaData() and item.GetCurrentMetaData().Has(data.NAME()):
            found.append(item.GetCurrentMetaData().Get(data.NAME()))
        item.GoToNextItem()
    return found


def together(data, attributes, name):
    """An array of all grids, one after another."""
    return np.concatenate([values(getattr(grid, attributes)(), name) for grid in grids(data)])


def bent(grid, coincident="Merge"):
    grid.UpdatePipeline()
    boundary = simple.Calculator(
        Input=ExtractMorphBoundary(Input=grid, CoincidentPoints=coincident), CoordinateResults=1,
        Function=BENT)
    return MorphFEMWARP(Input=grid, Boundary=boundary, CoincidentPoints=coincident)


class FileFormats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        part = simple.OpenDataFile(str(MESH))
        ids = number_points(Input=part, PointIdsArrayName="Node", CellIdsArrayName="Element")
        cls.part = ids
        cls.morph = bent(ids)
        cls.moved = points(fetched(cls.morph))
        cls.vectors = values(fetched(cls.morph).GetPointData(), "FinalDisplacement")
        cells = ids.GetDataInformation().GetNumberOfCells()
        # Two blocks, each with nodes of its own between them.
        cls.blocks = blocks_for_exodus(simple.GroupDatasets(Input=[
            simple.Threshold(Input=ids, Scalars=["CELLS", "Element"], LowerThreshold=first,
                             UpperThreshold=last)
            for first, last in ((0, cells // 2 - 1), (cells // 2, cells))]))

    def path(self, name):
        return str(Path(self.folder.name, name))

    def assertIsMoved(self, data, cells=None):
        """Checks a morph of the mesh, or its surface, from a file.

        Its nodes come in any order, told apart by the array Node. Blocks have nodes of their
        own."""
        self.assertEqual(sum(grid.GetNumberOfCells() for grid in grids(data)),
                         cells or self.part.GetDataInformation().GetNumberOfCells())
        node = together(data, "GetPointData", "Node").astype(int)
        self.assertEqual(sorted(set(node)), list(range(len(self.moved))))
        moved = np.concatenate([points(grid) for grid in grids(data)])
        np.testing.assert_allclose(moved, self.moved[node], rtol=0, atol=1e-5)
        first = {n: x for n, x in zip(node[::-1], moved[::-1])}
        np.testing.assert_array_equal(moved, [first[n] for n in node])  # no interface is torn
        np.testing.assert_allclose(together(data, "GetPointData", "FinalDisplacement"),
                                   self.vectors[node], rtol=0, atol=1e-6)

    def test_read(self):
        for name, source, options in (("part.vtu", self.part, ASCII), ("part.vtk", self.part, {}),
                                      ("part.e", self.part, {}), ("blocks.e", self.blocks, {}),
                                      ("blocks.ex2", self.blocks, {}),
                                      ("part.cgns", self.part, {}),
                                      ("zones.cgns", self.blocks, {}),
                                      ("parts.case", self.blocks, {})):
            with self.subTest(file=name):
                if name.endswith(".case"):
                    halves = dict(zip(("lower half", "upper half"), grids(fetched(source))))
                    ensight.write(self.path(name), halves, ["Node", "FinalDisplacement"],
                                  ["Element"])
                else:
                    simple.SaveData(self.path(name), proxy=source, **options)
                file = opened(self.path(name))
                # These blocks are one body, and the file numbers the nodes of each apart.
                morph = bent(file, "Merge by position" if source is self.blocks else "Merge")
                data, before = fetched(morph), fetched(file)
                self.assertEqual(data.GetClassName(), before.GetClassName())
                self.assertEqual(names(data), names(before))
                self.assertEqual(len(grids(data)), 2 if source is self.blocks else 1)
                if name.endswith(".case"):
                    self.assertEqual(names(data), list(halves))
                self.assertIsMoved(data)
                element = together(data, "GetCellData", "Element").astype(int)
                self.assertEqual(sorted(element), list(range(len(element))))
                self.assertEqual(morph.UnmatchedPoints, 0)
                self.assertAlmostEqual(morph.MinScaledJacobian, self.morph.MinScaledJacobian,
                                       delta=1e-5)

    def test_gmsh(self):
        """Gmsh's files hold edges and faces beside the volume cells, and for each the number of
        its geometry."""
        Path(self.path("cube.geo")).write_text(CUBE, encoding="utf-8")
        subprocess.run([shutil.which("gmsh"), "-3", self.path("cube.geo"), "-format", "vtk",
                        "-o", self.path("cube.vtk")], check=True, capture_output=True, timeout=60)
        grid = simple.OpenDataFile(self.path("cube.vtk"))
        before = fetched(grid)
        data = fetched(bent(grid))
        self.assertEqual(data.GetNumberOfCells(), before.GetNumberOfCells())
        kinds = {data.GetCellType(i) for i in range(data.GetNumberOfCells())}
        self.assertEqual(kinds & {3, 5, 10}, {3, 5, 10})  # edges, triangles, tetrahedra
        quality = values(data.GetCellData(), "ScaledJacobian")
        for i in range(data.GetNumberOfCells()):
            self.assertEqual(np.isnan(quality[i]), data.GetCellType(i) != 10)
        for i in range(before.GetCellData().GetNumberOfArrays()):
            name = before.GetCellData().GetArrayName(i)
            np.testing.assert_array_equal(values(data.GetCellData(), name),
                                          values(before.GetCellData(), name))
        rest = points(before)
        outside = ((rest == 0) | (rest == 2)).any(axis=1)
        expected = rest + np.outer(0.9 * rest[:, 0] * np.sin(rest[:, 2] / 1.5), [0, 1, 0])
        np.testing.assert_allclose(points(data)[outside], expected[outside], atol=1e-6)

    def test_save(self):
        for name, options in (("moved.vtu", ASCII), ("moved.vtk", {}), ("moved.e", {}),
                              ("moved.cgns", {})):
            with self.subTest(file=name):
                simple.SaveData(self.path(name), proxy=self.morph, **options)
                data = fetched(opened(self.path(name)))
                self.assertIsMoved(data)
                quality = together(data, "GetCellData", "ScaledJacobian")
                self.assertAlmostEqual(quality.min(), self.morph.MinScaledJacobian, delta=1e-12)

    def test_blocks_through_morph_mesh(self):
        """Blocks from an Exodus file, moved by Morph Mesh and saved to another."""
        simple.SaveData(self.path("bore.e"), proxy=self.blocks)
        file = opened(self.path("bore.e"))
        file.UpdatePipeline()
        low, high = np.reshape(fetched(self.part).GetBounds(), (3, 2)).T
        region = {"Position": list(low - 1), "Length": [high[0] - low[0] + 2, high[1] - low[1] + 2,
                                                        1 + 0.01 * (high[2] - low[2])]}
        options = {"Moving": "Region", "Displacement": "Vector", "Vector": [0, 0.1, -0.1]}
        whole = MorphMesh(Input=self.part, **options)
        morph = MorphMesh(Input=file, CoincidentPoints="Merge by position", **options)
        for one in (whole, morph):
            one.Region.Position, one.Region.Length = region["Position"], region["Length"]
        expected, data = fetched(whole), fetched(morph)
        morph.UpdatePropertyInformation()
        self.assertEqual(morph.MorphStatus, "Valid")
        self.assertGreater(np.abs(points(expected) - points(fetched(self.part))).max(), 0.05)
        self.assertEqual(names(data), names(fetched(file)))
        simple.SaveData(self.path("bore_moved.e"), proxy=morph)
        saved = fetched(opened(self.path("bore_moved.e")))
        self.assertEqual(len(grids(saved)), 2)
        for result in (data, saved):
            node = together(result, "GetPointData", "Node").astype(int)
            moved = np.concatenate([points(grid) for grid in grids(result)])
            np.testing.assert_allclose(moved, points(expected)[node], rtol=0, atol=1e-5)
        quality = together(saved, "GetCellData", "ScaledJacobian")
        self.assertAlmostEqual(quality.min(), morph.MinScaledJacobian, delta=1e-12)

    def test_save_surface(self):
        surface = simple.ExtractSurface(Input=self.morph)
        simple.SaveData(self.path("moved.stl"), proxy=surface)
        read = simple.OpenDataFile(self.path("moved.stl"))
        faces = fetched(surface)
        data = fetched(read)
        self.assertEqual(data.GetNumberOfCells(), 2 * faces.GetNumberOfCells())
        np.testing.assert_allclose(data.GetBounds(), faces.GetBounds(), atol=1e-5)
        nodes = {tuple(np.round(p, 4)) for p in points(faces)}
        self.assertTrue({tuple(np.round(p, 4)) for p in points(data)} <= nodes)


if __name__ == "__main__":
    unittest.main()
