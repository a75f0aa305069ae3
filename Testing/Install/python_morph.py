# SPDX-License-Identifier: BSD-3-Clause
"""meshmorphing.vtk.morph(): VTK's grids, subclasses of them, blocks, numpy arrays, and exceptions.

Run: PYTHONPATH=<folder of meshmorphing>:<VTK's> MESHMORPHING_MODELS=<small models>
         python3 python_morph.py
"""
import os
import unittest
import warnings

import meshmorphing.vtk as mm
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

MODEL = os.path.join(os.environ["MESHMORPHING_MODELS"], "bore_hex_small.vtu")
METHODS = ("FEMWARP", "LBWARP", "weighted residual", "Simplex-linear", "simplex_natural_neighbor",
           "radial basis", "Smoothing", "InversionFree")
SHEAR = numpy.array([[1, 0.2, 0], [0, 1.1, 0], [0.1, 0, 1]])


class Grid(vtkUnstructuredGrid):
    """As PyVista's UnstructuredGrid: a subclass that takes a grid."""

    def __init__(self, other=None):
        super().__init__()
        if other is not None:
            self.ShallowCopy(other)


def read():
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(MODEL)
    reader.Update()
    return reader.GetOutput()


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def boundary(grid):
    extract = mm.vtkExtractMorphBoundary()
    extract.SetInputData(grid)
    extract.Update()
    return extract.GetOutput()


def moved(data, to):
    copy = data.NewInstance()
    copy.DeepCopy(data)
    copy.GetPoints().SetData(numpy_to_vtk(to, deep=True))
    return copy


def halves(grid):
    """The first and the second half of the cells, as blocks."""
    blocks = vtkMultiBlockDataSet()
    middle = grid.GetNumberOfCells() // 2
    for i, cells in enumerate((range(middle), range(middle, grid.GetNumberOfCells()))):
        half, new, ids = vtkUnstructuredGrid(), {}, vtkIdList()
        places = vtkPoints()
        places.SetDataType(grid.GetPoints().GetDataType())
        half.SetPoints(places)
        half.Allocate(len(cells))
        for cell in cells:
            grid.GetCellPoints(cell, ids)
            for k in range(ids.GetNumberOfIds()):
                old = ids.GetId(k)
                if old not in new:
                    new[old] = places.InsertNextPoint(grid.GetPoint(old))
                ids.SetId(k, new[old])
            half.InsertNextCell(grid.GetCellType(cell), ids)
        blocks.SetBlock(i, half)
    return blocks


def sheared(blocks):
    copy = vtkMultiBlockDataSet()
    for i in range(blocks.GetNumberOfBlocks()):
        copy.SetBlock(i, moved(blocks.GetBlock(i), points(blocks.GetBlock(i)) @ SHEAR))
    return copy


def folded(x):
    """The outer wall in waves, through itself."""
    return x + numpy.outer(2 * numpy.sin(2 * x[:, 0]) * numpy.sin(x[:, 2]), [0, 1, 0])


class PythonMorph(unittest.TestCase):
    def setUp(self):
        self.grid = read()
        self.x = points(self.grid)
        self.boundary = boundary(self.grid)
        self.ids = vtk_to_numpy(self.boundary.GetPointData().GetArray("MorphPointId"))

    def test_it_is_the_filter(self):
        surface = moved(self.boundary, points(self.boundary) @ SHEAR)
        morph = mm.vtkFEMWarpMorph()
        morph.SetInputData(self.grid)
        morph.SetBoundaryData(surface)
        morph.Update()
        result = mm.morph(self.grid, surface)
        self.assertTrue(numpy.array_equal(points(result), points(morph.GetOutput())))
        quality = vtk_to_numpy(result.GetCellData().GetArray("ScaledJacobian"))
        self.assertEqual(quality.min(), morph.GetMinScaledJacobian())
        self.assertTrue(numpy.array_equal(points(self.grid), self.x), "the input is left alone")

    def test_every_method_reproduces_a_shear(self):
        for method in METHODS:
            with self.subTest(method=method):
                result = mm.morph(self.grid, self.x @ SHEAR, method)
                self.assertTrue(numpy.allclose(points(result)[self.ids], (self.x @ SHEAR)[self.ids],
                                               rtol=0, atol=1e-6))
                if method != "Smoothing":  # which moves nodes for their cells' sake
                    self.assertLess(abs(points(result) - self.x @ SHEAR).max(), 2e-2)

    def test_points_of_all_forms_give_one_mesh(self):
        to = self.x @ SHEAR
        whole = points(mm.morph(self.grid, to))
        inside = to.copy()
        inside[numpy.setdiff1d(numpy.arange(len(to)), self.ids)] = 1e6
        order = numpy.random.default_rng(3).permutation(len(self.ids))
        for name, result in {
                "points inside have no effect": mm.morph(self.grid, inside),
                "of the boundary": mm.morph(self.grid, to[self.ids]),
                "lists": mm.morph(self.grid, to[self.ids].tolist()),
                "with ids": mm.morph(self.grid, to[self.ids][order], ids=self.ids[order]),
                "a grid": mm.morph(self.grid, moved(self.grid, to)),
                "a boundary": mm.morph(self.grid, moved(self.boundary, to[self.ids]))
        }.items():
            with self.subTest(form=name):
                self.assertTrue(numpy.array_equal(points(result), whole))
        # Others stay.
        some = self.ids[:3]
        result = points(mm.morph(self.grid, self.x[some] + 1e-3, ids=some))
        rest = numpy.setdiff1d(self.ids, some)
        self.assertTrue(numpy.array_equal(result[rest], self.x[rest]))
        self.assertGreater(abs(result[some] - self.x[some]).min(), 9e-4)

    def test_blocks_come_back_as_blocks(self):
        blocks = halves(self.grid)
        extract = mm.vtkExtractMorphBoundary()
        extract.SetInputDataObject(blocks)
        extract.Update()
        surface = extract.GetOutput()
        for displaced in (moved(surface, points(surface) @ SHEAR), points(surface) @ SHEAR,
                          sheared(blocks)):
            result = mm.morph(blocks, displaced)
            self.assertIsInstance(result, vtkMultiBlockDataSet)
            self.assertEqual(result.GetNumberOfBlocks(), 2)
            for i in range(2):
                block = result.GetBlock(i)
                self.assertLess(abs(points(block) - points(blocks.GetBlock(i)) @ SHEAR).max(), 2e-2)
                self.assertTrue(block.GetCellData().HasArray("ScaledJacobian"))
        with self.assertRaisesRegex(ValueError, "5 displaced points for a mesh with"):
            mm.morph(blocks, self.x[:5])

    def test_a_subclass_comes_back(self):
        result = mm.morph(Grid(self.grid), self.x @ SHEAR)
        self.assertIs(type(result), Grid)
        self.assertEqual(result.GetNumberOfCells(), self.grid.GetNumberOfCells())
        self.assertIs(type(mm.morph(self.grid, self.x)), type(vtkUnstructuredGrid()))

    def test_inverted_cells_raise_unless_they_are_allowed(self):
        displaced = folded(self.x)
        with self.assertRaises(mm.MorphError) as caught:
            mm.morph(self.grid, displaced)
        error = caught.exception
        self.assertIsInstance(error, RuntimeError)
        self.assertEqual(error.status, "Inverted")
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            result = mm.morph(self.grid, displaced, allow_inverted=True)
        self.assertEqual([w.category for w in warned], [mm.MorphWarning])
        self.assertEqual(warned[0].filename, __file__)
        quality = vtk_to_numpy(result.GetCellData().GetArray("ScaledJacobian"))
        self.assertGreater(len(error.ids), 0)
        self.assertEqual(sorted(error.ids), sorted(numpy.flatnonzero(quality <= 0)))
        numpy.testing.assert_array_equal(points(error.grid), points(result))

    def test_options_are_those_of_the_filter(self):
        gentle = self.x + 0.25 * (folded(self.x) - self.x)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", mm.MorphWarning)
            plain = mm.morph(self.grid, gentle, allow_inverted=True)
            for option in ({"Validity": "None"}, {"Validity": "Report", "NumberOfThreads": 1},
                           {"ScaleFactor": 1.0}):
                same = mm.morph(self.grid, gentle, allow_inverted=True, **option)
                self.assertTrue(numpy.array_equal(points(same), points(plain)))
            half = mm.morph(self.grid, self.x @ SHEAR, ScaleFactor=0.5)
        expected = (self.x + self.x @ SHEAR) / 2
        self.assertLess(abs(points(half) - expected)[self.ids].max(), 1e-6)
        for error, options in ((TypeError, {"NoSuchThing": 1}), (ValueError, {"Validity": "Maybe"}),
                               (TypeError, {"Nothing": "text"})):
            with self.assertRaises(error):
                mm.morph(self.grid, self.x, **options)

    def test_a_failure_raises_with_the_filters_own_words(self):
        bad = self.x.copy()
        bad[self.ids[5]] = numpy.nan
        surface = moved(self.boundary, points(self.boundary))
        surface.GetPointData().GetArray("MorphPointId").SetValue(0, 10 ** 6)
        for displaced, text in ((bad, "not finite"), (surface, "ids outside the grid")):
            for allow in (False, True):
                with self.assertRaises(mm.MorphError) as caught:
                    mm.morph(self.grid, displaced, allow_inverted=allow)
                self.assertIn(text, str(caught.exception))
                self.assertNotIn("0x", str(caught.exception))
                self.assertEqual(caught.exception.status, "Failed")
                self.assertEqual(len(caught.exception.ids), 0)
                self.assertTrue(numpy.array_equal(points(caught.exception.grid), self.x))
        with self.assertRaises(mm.MorphError) as caught:
            mm.morph(self.grid, folded(self.x), Validity="Refuse")
        self.assertEqual(caught.exception.status, "Failed")

    def test_arguments_of_the_wrong_kind(self):
        for error, text, arguments, options in (
                (TypeError, "vtkUnstructuredGrid", (self.boundary, self.x), {}),
                (ValueError, "no method 'Laplace'", (self.grid, self.x, "Laplace"), {}),
                (ValueError, "(n, 3) is needed", (self.grid, self.x[:, :2]), {}),
                (ValueError, "7 displaced points", (self.grid, self.x[:7]), {}),
                (ValueError, "integers", (self.grid, self.x[:7]), {"ids": numpy.ones(7)}),
                (ValueError, "7 integers", (self.grid, self.x[:7]), {"ids": [1, 2]}),
                (TypeError, "numpy array", (self.grid, self.boundary), {"ids": [1, 2]})):
            with self.subTest(text=text), self.assertRaises(error) as caught:
                mm.morph(*arguments, **options)
            self.assertIn(text, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
