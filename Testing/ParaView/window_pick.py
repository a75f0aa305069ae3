# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces that are picked in the view: select cells, press *Add selected surfaces*, and the names
are ticked. In ParaView's window the morphed mesh has the numbers of pvpython, and clicks are
counted as in window_tasks.py. A script finds the same names by the properties that the button sets.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_pick.py
"""
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

from versions import BOX_FIELDS
from window_events import PANEL, field
from window_morph_mesh import text
from window_tasks import Tasks

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
UP = "0.2"
NUMBERS = ("MinScaledJacobian", "MeanScaledJacobian", "InvertedCells", "WorstCellId",
           "LargestValidStep")
BOX = f"Transform/ProxySelectionWidget/frame/ChosenProxyWidget/InteractiveBox/{BOX_FIELDS}"


def cells(ids):
    """A selection of these cells, as ParaView's window makes it."""
    return simple.IDSelectionSource(FieldType="CELL", IDs=[v for i in ids for v in (0, int(i))])


def points(ids):
    return simple.IDSelectionSource(FieldType="POINT", IDs=[v for i in ids for v in (0, int(i))])


def names(morph, selection, port=-1, picked="PickedSurfaces"):
    """The names that the filter finds for a selection."""
    morph.PickPort = port
    morph.Pick = selection
    morph.UpdateVTKObjects()
    morph.SMProxy.UpdatePropertyInformation(morph.SMProxy.GetProperty(picked))
    pairs = morph.SMProxy.GetProperty(picked)
    values = [pairs.GetElement(i) for i in range(pairs.GetNumberOfElements())]
    return [name for name, found in zip(values[::2], values[1::2]) if int(found)]


class Pick(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.part = simple.OpenDataFile(str(MESH))
        cls.faces = MorphMesh(Input=cls.part)  # nothing is ticked: the boundary
        cls.faces.UpdatePipeline()
        grid = servermanager.Fetch(cls.faces)
        cls.ids = vtk_to_numpy(grid.GetCellData().GetArray("SurfaceId"))
        cls.nodes = [[grid.GetCell(i).GetPointId(k)
                      for k in range(grid.GetCell(i).GetNumberOfPoints())]
                     for i in range(grid.GetNumberOfCells())]
        x = vtk_to_numpy(grid.GetPoints().GetData())
        cls.centers = np.array([x[nodes].mean(axis=0) for nodes in cls.nodes])
        top = cls.centers[:, 2] > cls.centers[:, 2].max() - 1e-6
        assert len(set(cls.ids[top])) == 1
        #: what a user sees who looks along -z, as ParaView's camera does at first
        cls.top = f"Surface {cls.ids[top][0]}"
        mesh = servermanager.Fetch(cls.part)
        found = {}
        for c in range(mesh.GetNumberOfCells()):
            for node in range(mesh.GetCell(c).GetNumberOfPoints()):
                found.setdefault(mesh.GetCell(c).GetPointId(node), set()).add(c)
        #: the cell of each face
        cls.owner = [set.intersection(*(found[n] for n in nodes)).pop() for nodes in cls.nodes]

    def test_faces_of_the_boundary(self):
        for surface in sorted(set(self.ids)):
            with self.subTest(surface=surface):
                faces = np.flatnonzero(self.ids == surface)
                self.assertEqual(names(self.faces, cells(faces), 0), [f"Surface {surface}"])
                one = names(self.faces, cells(faces[:1]), 0)
                self.assertEqual(one, [f"Surface {surface}"])

    def test_cells_of_the_mesh(self):
        """All cells at a surface: those at its edges lie on others too, which are not meant."""
        for surface in sorted(set(self.ids)):
            with self.subTest(surface=surface):
                ids = {self.owner[f] for f in np.flatnonzero(self.ids == surface)}
                self.assertEqual(names(self.faces, cells(sorted(ids))), [f"Surface {surface}"])

    def test_cells_of_two_surfaces_and_none(self):
        two = sorted(set(self.ids))[:2]
        ids = {self.owner[f] for f in np.flatnonzero(np.isin(self.ids, two))}
        self.assertEqual(names(self.faces, cells(sorted(ids))), [f"Surface {s}" for s in two])
        inside = set(range(self.part.GetDataInformation().GetNumberOfCells())) - set(self.owner)
        self.assertEqual(names(self.faces, cells(sorted(inside)[:1])), [])

    def test_points(self):
        for surface in sorted(set(self.ids)):
            with self.subTest(surface=surface):
                ids = {n for f in np.flatnonzero(self.ids == surface) for n in self.nodes[f]}
                self.assertEqual(names(self.faces, points(sorted(ids))), [f"Surface {surface}"])

    def test_a_morphed_mesh_and_its_surface(self):
        morph = MorphMesh(Input=self.part, Surfaces=[self.top], Displacement="Vector",
                          Vector=[0, 0, float(UP)])
        morph.UpdatePipeline()
        face = int(np.flatnonzero(self.ids == int(self.top.split()[1]))[0])
        self.assertEqual(names(morph, cells([self.owner[face]])), names(
            morph, cells([self.owner[face]]), 0))
        surface = servermanager.Fetch(morph, idx=2)
        ids = vtk_to_numpy(surface.GetPointData().GetArray("MorphPointId"))
        number = next(c for c in range(surface.GetNumberOfCells())
                      if {int(ids[surface.GetCell(c).GetPointId(k)]) for k in range(4)}
                      == set(self.nodes[face]))
        self.assertEqual(names(morph, cells([number]), 2), [self.top])
        self.assertEqual(morph.MorphStatus, "Valid")

    def test_boundary_displacement(self):
        move = BoundaryDisplacement(Input=self.part, Moving="Nothing")
        move.UpdatePipeline()
        faces = np.flatnonzero(self.ids == self.ids[0])
        expected = [f"Surface {self.ids[0]}"]
        self.assertEqual(names(move, cells(faces), 0, "PickedSurfaces"), expected)
        ids = sorted({self.owner[f] for f in faces})
        self.assertEqual(names(move, cells(ids), -1, "PickedSurfaces"), expected)

    def test_in_the_window(self):
        morph = MorphMesh(Input=self.part, Surfaces=[self.top])
        morph.Transform.Translate = [0, 0, float(UP)]
        morph.UpdatePipeline()
        self.assertEqual(morph.MorphStatus, "Valid")
        with tempfile.TemporaryDirectory() as name:
            events = Tasks()
            events.load_plugin(PLUGIN)
            events.open(str(MESH))
            events.task("tick what is selected in the view, and move it")
            events.filter("MorphMesh")
            events.press("SurfaceTable/AddSelected")  # nothing is selected: a hint
            # The ring at the end of the bore; the bore itself is not in this rectangle.
            events.select_cells((0.47, 0.23), (0.53, 0.28))
            events.press("SurfaceTable/AddSelected")
            events.expect(PANEL + "SurfaceTable/Message", f"Moves: {self.top}")
            events.type(BOX + "translateZ", UP)
            events.apply()
            events.done()
            for number in NUMBERS:
                value = getattr(morph, number)
                events.expect(field(number, value), text(value))
            code, messages = events.play(Path(name))
            self.assertEqual(code, 0, messages)
            self.assertNotIn("ERR|", messages)
            self.assertNotIn("rror:", messages)
            # One of them is the button that had nothing to add.
            self.assertEqual(list(events.counted.values()), [9])


if __name__ == "__main__":
    unittest.main()
