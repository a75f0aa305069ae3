# SPDX-License-Identifier: BSD-3-Clause
"""What a user may connect by mistake: each time one message that says what to do, the undeformed
mesh or an empty result, and then a right input works.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython wrong_inputs.py
"""
import os
import re
import unittest

from paraview import servermanager, simple
from paraview.simple import (AppendDatasets, Clip, Cone, ExtractSurface, GroupDatasets, LoadPlugin,
                             Plane, Sphere, Transform, Wavelet)
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())


def hexes(cells):
    return AppendDatasets(Input=[Wavelet(WholeExtent=[0, cells] * 3)])


def messages_of(action):
    """The messages of `action`: VTK's executive adds none."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        action()
    finally:
        vtkOutputWindow.SetInstance(before)
    found = re.split(r"^(?:ERROR|Warning): ", window.GetOutput(), flags=re.MULTILINE)[1:]
    return found


class WrongInputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.grid = hexes(4)
        cls.boundary = ExtractMorphBoundary(Input=cls.grid)

    def assertMessage(self, proxy, *parts, undeformed=0):
        """`undeformed`: the number of points of the mesh that a morph filter gives back."""
        texts = messages_of(proxy.UpdatePipeline)
        self.assertEqual(len(texts), 1, texts)
        for part in parts:
            self.assertIn(part, texts[0])
        for port in range(proxy.SMProxy.GetNumberOfOutputPorts()):
            information = proxy.GetDataInformation(port)
            if port == 2:  # the undeformed boundary
                self.assertLessEqual(information.GetNumberOfPoints(), undeformed)
                self.assertIsNone(information.GetCellDataInformation()
                                  .GetArrayInformation("ScaledJacobian"))
            else:
                self.assertEqual(information.GetNumberOfPoints(), undeformed if port == 0 else 0)

    def assertRefused(self, parts, **inputs):
        """By a morph filter, which works as soon as its inputs are right."""
        morph = MorphFEMWARP(**inputs)
        mesh = servermanager.Fetch(inputs["Input"])
        isGrid = mesh.IsA("vtkUnstructuredGrid")
        self.assertMessage(morph, *parts, undeformed=mesh.GetNumberOfPoints() if isGrid else 0)
        status = servermanager.Fetch(morph).GetFieldData().GetAbstractArray("MorphStatus")
        self.assertEqual(status.GetValue(0), "Failed")
        self.assertEqual((morph.InvertedCells, morph.MinScaledJacobian), (-1, -1))
        morph.Input, morph.Boundary = self.grid, self.boundary
        for array in ("DisplacementArray", "BoundaryIdArray"):
            setattr(morph, array, "None")
        self.assertEqual(messages_of(morph.UpdatePipeline), [])
        self.assertEqual(morph.GetDataInformation().GetNumberOfCells(), 4 ** 3)

    def test_no_boundary(self):
        parts = ("Boundary: nothing is connected", "Extract Morph Boundary",
                 "Boundary Displacement", "Change Input")
        self.assertRefused(parts, Input=self.grid)
        self.assertMessage(CompareMorphMethods(Input=self.grid), *parts)
        self.assertMessage(MorphBoundary(Input=self.grid), *parts)

    def test_no_source(self):
        """A macro or script with nothing selected."""
        simple.SetActiveSource(None)
        for make in (BoundaryDisplacement, MorphMesh, FittoSurface, MorphShapes, MorphFEMWARP,
                     MorphBoundary, ExtractMorphBoundary, ClassifyBoundary, ScaledJacobian,
                     CompareMorphMethods, MorphAdjoint):
            with self.subTest(make.__name__):
                proxy = make()
                self.assertFalse(proxy.Input)
                simple.Delete(proxy)

    def test_boundary_of_another_mesh(self):
        self.assertRefused(["outside the grid's 0 to 124", "Make the boundary from this grid"],
                           Input=self.grid, Boundary=ExtractMorphBoundary(Input=hexes(5)))
        self.assertRefused(["stale", "Extract Morph Boundary"], Input=self.grid,
                           Boundary=ExtractMorphBoundary(Input=hexes(3)))

    def test_surfaces_that_do_not_know_their_nodes(self):
        parts = "Nothing says which nodes", "Make the boundary with Extract Morph Boundary"
        for surface in (ExtractSurface(Input=self.grid), Sphere(), Clip(Input=self.boundary)):
            self.assertRefused(parts, Input=self.grid, Boundary=surface)

    def test_inputs_of_other_types(self):
        self.assertRefused(["The input is a vtkPolyData", "Append Datasets"], Input=Line(),
                           Boundary=self.boundary)
        self.assertRefused(["has a polygon, cell 0"], Input=Cone(), Boundary=self.boundary)
        self.assertRefused(["The input is a vtkImageData", "Append Datasets"], Input=Wavelet(),
                           Boundary=self.boundary)
        self.assertRefused(["The boundary is a vtkImageData", "polygonal data"], Input=self.grid,
                           Boundary=Wavelet())
        self.assertMessage(MorphBoundary(Input=self.grid, Boundary=self.boundary,
                                         Target=GroupDatasets(Input=[Sphere()])),
                           "The target is composite data", "Merge Blocks")

    def test_meshes_without_volume_cells(self):
        line = AppendDatasets(Input=[Line()])
        parts = "None of the input's 1 cells is a volume cell", "poly-line"
        self.assertRefused(parts, Input=line, Boundary=Plane())
        self.assertMessage(ExtractMorphBoundary(Input=line), *parts)

    def test_inputs_the_wrong_way_round(self):
        parts = "Input and Boundary are swapped", "volume mesh as Input"
        self.assertRefused(parts, Input=self.boundary, Boundary=self.grid)
        self.assertRefused(parts, Input=AppendDatasets(Input=[self.boundary]),
                           Boundary=Transform(Input=self.grid))

    def test_missing_arrays(self):
        for name in ("DisplacementArray", "BoundaryIdArray"):
            self.assertRefused([f"`{name}` names 'Wind'", "MorphPointId"], Input=self.grid,
                               Boundary=self.boundary, **{name: "Wind"})
        self.assertRefused(["'RTData' has 1 components"], Input=self.grid, Boundary=self.boundary,
                           DisplacementArray="RTData")

    def test_nothing_is_said_of_arrays_before_there_is_a_boundary(self):
        """ParaView 5.11 asks the offered arrays for their place in the input, and reports where it
        finds none."""
        def panel(proxy):
            for name in ("DisplacementArray", "BoundaryIdArray"):
                domain = proxy.SMProxy.GetProperty(name).FindDomain("vtkSMArrayListDomain")
                for i in range(domain.GetNumberOfStrings()):
                    domain.GetFieldAssociation(i)
        for create in (MorphFEMWARP, CompareMorphMethods, MorphBoundary):
            proxy = create(Input=self.grid)
            self.assertEqual(messages_of(lambda: panel(proxy)), [])
            self.assertEqual(proxy.DisplacementArray, "None")
            proxy.Boundary = self.boundary
            self.boundary.UpdatePipeline()
            self.assertIn("MorphPointId", proxy.GetProperty("BoundaryIdArray").GetAvailable())
            self.assertEqual(proxy.DisplacementArray, "None")
            self.assertEqual(messages_of(lambda: panel(proxy)), [])



if __name__ == "__main__":
    unittest.main()
