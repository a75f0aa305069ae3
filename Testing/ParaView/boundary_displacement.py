# SPDX-License-Identifier: BSD-3-Clause
"""Boundary Displacement as a user works with it: selections of each kind, the list of patches, the
box, and a morph after it.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython boundary_displacement.py
"""
import os
import tempfile
import unittest

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

CELLS = 6


def points(proxy):
    proxy.UpdatePipeline()
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPoints().GetData()).astype(float)


def array(proxy, name):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPointData().GetArray(name))


def number(proxy, name):
    """What the panel shows after Apply."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    return getattr(proxy, name)


class BoundaryDisplacementTests(unittest.TestCase):
    def setUp(self):
        wavelet = simple.Wavelet(WholeExtent=[0, CELLS, 0, CELLS, 0, CELLS])
        self.mesh = simple.AppendDatasets(Input=[wavelet])
        self.rest = points(self.mesh)
        self.displacement = BoundaryDisplacement(Input=self.mesh)
        self.addCleanup(self.clear)

    def clear(self):
        simple.ClearSelection(self.mesh)
        for view in simple.GetRenderViews():
            simple.Delete(view)

    def top_surface(self):
        """The name of the surface at the top, as the result shows it."""
        output = servermanager.Fetch(BoundaryDisplacement(Input=self.mesh))
        ids = vtk_to_numpy(output.GetCellData().GetArray("GeometryId"))
        for cell, number_ in enumerate(ids):
            bounds = output.GetCell(cell).GetBounds()
            if bounds[4] == CELLS:
                return f"Surface {number_}"
        return self.fail("no surface is at the top")

    def assert_moves(self, where):
        """Exactly the boundary nodes move whose undeformed points satisfy the function `where`."""
        self.displacement.UpdatePipeline()
        role = array(self.displacement, "Role")
        rest = array(self.displacement, "RestPosition")[:, :3]
        np.testing.assert_array_equal(role == 1, where(rest))
        self.assertEqual(number(self.displacement, "MovingPoints"), where(rest).sum())

    def select(self, field, query):
        simple.Show(self.mesh, simple.CreateRenderView())
        simple.QuerySelect(QueryString=query, FieldType=field, Source=self.mesh)
        self.displacement.Moving = "Selection"
        self.displacement.Selection = self.mesh.GetSelectionInput(0)

    def test_handles_and_lattices(self):
        shift = np.array([0.5, 0.25, -1])
        self.displacement.Displacement = "Handles"
        self.displacement.Handles = [1, 1, 1, *shift, 0]  # one handle translates everything
        rest = array(self.displacement, "RestPosition")[:, :3]
        np.testing.assert_allclose(points(self.displacement), rest + shift, atol=1e-12)
        self.displacement.Handles = [0, 0, 0, *shift, 2, 6, 6, 6, 0, 0, 1, 2.5]
        moved = points(self.displacement) - rest
        np.testing.assert_allclose(moved[(rest == 0).all(axis=1)], [shift], atol=1e-6)
        self.assertTrue((moved[rest.sum(axis=1) == 9] == 0).all())

        # Picked points of the view: a corner is a handle, with the vector of the panel.
        self.displacement.Handles = []
        self.select("POINT", "id == 0")
        self.displacement.Moving = "Everything"
        self.displacement.SelectedHandles, self.displacement.HandleRadius = 1, 2
        self.displacement.Vector = [0, 0, 0.5]
        moved = points(self.displacement) - rest
        self.assertAlmostEqual(moved[:, 2].max(), 0.5)
        np.testing.assert_array_equal((moved != 0).any(axis=1), np.linalg.norm(rest, axis=1) < 2)

        file = os.path.join(self.enterContext(tempfile.TemporaryDirectory()), "lattice.csv")
        with open(file, "w", encoding="utf-8") as lattice:
            lattice.write("i,j,k,dx,dy,dz\n1,1,2,0.5,0.25,-1\n")
        table = simple.CSVReader(FileName=[file])
        self.displacement.Displacement, self.displacement.ControlPoints = "Lattice", table
        moved = points(self.displacement) - rest
        x, y, z = (rest / CELLS).T
        weight = 2 * x * (1 - x) * 2 * y * (1 - y) * z ** 2  # Bernstein, degree 2
        np.testing.assert_allclose(moved, weight[:, None] * shift, atol=1e-6)

    def test_control_points_are_shapes(self):
        def lattice(*displacements):
            return BoundaryDisplacement(Input=self.mesh, Displacement="Lattice",
                                        LatticeSize=[2, 3, 4],
                                        LatticeBasis="B-spline", OutputPointsPrecision="Double",
                                        LatticeDisplacements=[x for row in displacements
                                                              for x in row])
        chosen = [(0, 1, 2, 1, 0, 0), (1, 2, 3, 0, 1, 0), (1, 0, 0, 0, 0, 1)]
        weights = [0.3, -0.5, 0.25]
        shapes = MorphShapes(Input=self.mesh, Shapes=[lattice(one) for one in chosen],
                             ShapeNames=["a", "b", "c"], Weights=weights,
                             OutputPointsPrecision="Double")
        whole = lattice(*([*one[:3], *(w * x for x in one[3:])]
                          for one, w in zip(chosen, weights)))
        morph = MorphFEMWARP(Input=self.mesh, Boundary=whole, OutputPointsPrecision="Double")
        np.testing.assert_allclose(points(shapes), points(morph), atol=1e-6)
        self.assertGreater(np.abs(points(shapes) - self.rest).max(), 0.05)

    def test_patches_are_listed_before_the_first_apply(self):
        available = self.displacement.GetProperty("Surfaces").GetAvailable()
        self.assertEqual(available[:6], [f"Surface {i}" for i in range(6)])
        self.assertEqual(len(available), 6 + 12)
        self.assertEqual(list(self.displacement.Surfaces), [])
        self.assertEqual(list(self.displacement.FixedSurfaces), [])
        self.displacement.FeatureAngle = 180
        number(self.displacement, "MovingPoints")
        self.assertEqual(self.displacement.GetProperty("Surfaces").GetAvailable(), ["Surface 0"])

    def test_a_patch_by_the_box_and_the_volume_follows(self):
        move = self.displacement
        move.Moving = "Surfaces"
        move.Surfaces = [self.top_surface()]
        move.Transform.Translate = [1, 0, 2]
        move.Transform.Scale = [1, 1, 1.5]
        self.assert_moves(lambda x: x[:, 2] == CELLS)
        morph = MorphFEMWARP(Input=self.mesh, Boundary=move)
        moved = points(morph)
        # The whole mesh follows as the sides do: linear in the height.
        expected = self.rest + np.outer(self.rest[:, 2] / CELLS, [1, 0, 0.5 * CELLS + 2])
        np.testing.assert_allclose(moved, expected, atol=2e-5)
        self.assertEqual(number(morph, "InvertedCells"), 0)
        self.assertEqual(morph.UnmatchedPoints, 0)
        self.assertEqual(morph.PrescribedPoints, (CELLS + 1) ** 3 - (CELLS - 1) ** 3)

    def test_inside_a_cylinder(self):
        """Its axis is unbounded: it goes through the top and the bottom."""
        self.displacement.Moving = "Region"
        self.displacement.Region = "Cylinder"
        self.displacement.Region.Center = [3, 3, 0]
        self.displacement.Region.Axis = [0, 0, 1]
        self.displacement.Region.Radius = 1.5
        self.displacement.Displacement, self.displacement.Vector = "Vector", [0, 0, 0.1]
        self.assert_moves(lambda x: (x[:, 0] - 3) ** 2 + (x[:, 1] - 3) ** 2 <= 1.5 ** 2)
        self.assertEqual(number(self.displacement, "MovingPoints"), 2 * 9)

    def test_a_rotation_about_the_center_of_what_moves(self):
        """By a script alone: a transform, or numbers; a point of the user's, or the origin."""
        for about, center, motion in (
                ([3, 3, 6], {}, {"TransformAboutCenter": 1}),
                ([1, 2, 3], {"AutoCenter": 0, "Center": [1, 2, 3]}, {"TransformAboutCenter": 1}),
                ([0, 0, 0], {}, {}),
                ([3, 3, 6], {}, {"Displacement": "Translate, rotate, scale",
                                 "Rotation": [0, 0, 30], "Translation": [0, 0, 1]})):
            morph = MorphMesh(Input=self.mesh, Surfaces=[self.top_surface()], Surroundings="Stay",
                              Validity="None", **center, **motion)
            morph.Transform.Rotate = [0, 0, 30]
            morph.Transform.Translate = [0, 0, 1]
            top = self.rest[:, 2] == CELLS
            d = self.rest[top] - about
            cos, sin = np.cos(np.pi / 6), np.sin(np.pi / 6)
            turned = np.stack([cos * d[:, 0] - sin * d[:, 1], sin * d[:, 0] + cos * d[:, 1],
                               d[:, 2] + 1], 1) + about
            np.testing.assert_allclose(points(morph)[top], turned, atol=2e-6)

    def test_dragging_the_box_repeats_nothing(self):
        move = self.displacement
        move.Moving = "Surfaces"
        move.Surfaces = [self.top_surface()]
        morph = MorphFEMWARP(Input=self.mesh, Boundary=move)
        for step in range(1, 5):
            move.Transform.Rotate = [0, 0, 5 * step]
            move.Transform.Translate = [0, 0.1 * step, 0.2 * step]
            morph.UpdatePipeline()
            c, s = np.cos(np.radians(5 * step)), np.sin(np.radians(5 * step))
            top = self.rest[:, 2] == CELLS
            turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            expected = self.rest[top] @ turn.T + [0, 0.1 * step, 0.2 * step]
            np.testing.assert_allclose(points(morph)[top], expected, atol=1e-5)
            if step == 1:
                before = number(move, "PrepareCount")
        self.assertEqual(number(move, "ClassifyCount"), 1)
        self.assertEqual(number(move, "PrepareCount"), before)
        self.assertEqual(number(morph, "PrepareCount"), 1)

    def test_a_selection_by_find_data(self):
        """Points and cells of the mesh itself, by a query, which plain VTK does not know."""
        move = self.displacement
        move.Displacement, move.Vector, move.Surroundings = "Vector", [0, 0, 1], "Stay"
        self.select("POINT", f"id >= {(CELLS + 1) ** 2 * CELLS}")
        self.assert_moves(lambda x: x[:, 2] == CELLS)
        moved = points(MorphFEMWARP(Input=self.mesh, Boundary=move))
        top = self.rest[:, 2] == CELLS
        np.testing.assert_allclose(moved[top], self.rest[top] + [0, 0, 1], atol=1e-6)
        self.select("CELL", f"id >= {CELLS ** 3 - CELLS}")
        self.assert_moves(lambda x: (x[:, 2] >= CELLS - 1) & (x[:, 1] >= CELLS - 1))

    def test_a_selection_by_the_mouse(self):
        move = self.displacement
        move.Moving, move.Surroundings = "Selection", "Stay"
        view = simple.CreateRenderView()
        view.ViewSize = [400, 400]
        simple.Show(self.mesh, view).SetRepresentationType("Surface")
        middle = CELLS / 2
        view.CameraPosition = [middle, middle, 10 * CELLS]
        view.CameraFocalPoint = [middle, middle, middle]
        view.CameraViewUp = [0, 1, 0]
        view.CameraParallelProjection = 1
        view.CameraParallelScale = CELLS
        simple.Render(view)
        simple.SelectSurfacePoints(Rectangle=[0, 0, 400, 400], View=view)
        move.Selection = self.mesh.GetSelectionInput(0)
        self.assert_moves(lambda x: x[:, 2] == CELLS)
        simple.SelectPointsThrough(Rectangle=[0, 0, 400, 230], View=view)
        move.Selection = self.mesh.GetSelectionInput(0)
        self.assert_moves(lambda x: x[:, 1] <= middle)

    def test_a_new_filter_of_a_script_takes_no_selection(self):
        """The window's panel takes the active one, as that of Morph Mesh does."""
        self.select("POINT", "id >= 10")
        other = BoundaryDisplacement(Input=self.mesh)
        self.assertEqual(other.Moving, "Everything")
        self.assertIsNone(other.Selection)

    def test_inside_a_region(self):
        move = self.displacement
        move.Moving, move.Surroundings = "Region", "Stay"
        # The box arrives round the mesh.
        self.assert_moves(lambda x: x[:, 0] >= 0)
        move.Region.Position = [-1, -1, CELLS - 0.5]
        move.Region.Length = [CELLS + 2, CELLS + 2, 1]
        self.assert_moves(lambda x: x[:, 2] == CELLS)
        move.Region = "Sphere"
        move.Region.Center = [0, 0, 0]
        move.Region.Radius = 2.1
        self.assert_moves(lambda x: np.linalg.norm(x, axis=1) <= 2.1)
        move.Region = "Plane"
        move.Region.Origin = [0, 0, CELLS - 1.5]
        move.Region.Normal = [0, 0, -1]
        self.assert_moves(lambda x: x[:, 2] >= CELLS - 1)

    def test_an_array_a_held_patch_and_two_parts(self):
        shift = simple.Calculator(Input=self.mesh, Function="0.25*coordsX*kHat",
                                  ResultArrayName="Shift")
        shift.UpdatePipeline()
        first = BoundaryDisplacement(Input=shift, Moving="Surfaces", Displacement="Array")
        self.assertIn("Shift", first.GetProperty("DisplacementArray").GetAvailable())
        first.DisplacementArray = "Shift"
        top = self.top_surface()
        first.Surfaces = [top]
        others = [f"Surface {i}" for i in range(6) if f"Surface {i}" != top]
        first.FixedSurfaces = others
        moved = points(first)
        rest = array(first, "RestPosition")[:, :3]
        is_top = rest[:, 2] == CELLS
        np.testing.assert_allclose(moved[is_top, 2], CELLS + 0.25 * rest[is_top, 0], atol=1e-6)
        np.testing.assert_array_equal(moved[~is_top], rest[~is_top])

        second = BoundaryDisplacement(Input=first, Moving="Surfaces", Displacement="Along normals",
                                      Distance=0.5, Surroundings="Stay")
        bottom = next(name for name in others if self.bounds_of(first, name)[5] == 0)
        second.Surfaces = [bottom]
        both = points(second)
        np.testing.assert_allclose(both[rest[:, 2] == 0, 2], -0.5, atol=1e-6)
        np.testing.assert_array_equal(both[rest[:, 2] > 0], moved[rest[:, 2] > 0])
        volume = MorphFEMWARP(Input=shift, Boundary=second)
        self.assertEqual(number(volume, "InvertedCells"), 0)

    def bounds_of(self, proxy, name):
        """Of the rest positions of a surface's faces."""
        output = servermanager.Fetch(proxy)
        ids = vtk_to_numpy(output.GetCellData().GetArray("GeometryId"))
        cells = [output.GetCell(int(c)) for c in np.flatnonzero(ids == int(name.split()[1]))]
        nodes = {cell.GetPointId(k) for cell in cells for k in range(cell.GetNumberOfPoints())}
        rest = array(proxy, "RestPosition")[sorted(nodes), :3]
        return np.ravel(np.column_stack([rest.min(axis=0), rest.max(axis=0)]))

    def test_the_scale_factor_and_fading(self):
        move = self.displacement
        move.Moving = "Surfaces"
        move.Surfaces = [self.top_surface()]
        move.Displacement, move.Vector, move.Surroundings = "Vector", [0, 0, 1], "Fade"
        move.FalloffRadius = 2.5 / (CELLS * np.sqrt(3))
        move.ScaleFactor = 0.5
        moved, rest = points(move), array(move, "RestPosition")[:, :3]
        t = np.minimum((CELLS - rest[:, 2]) / 2.5, 1)
        faded = 0.5 * (1 - t) ** 4 * (4 * t + 1)
        np.testing.assert_allclose(moved[:, 2] - rest[:, 2], faded, atol=1e-6)
        np.testing.assert_allclose(array(move, "BoundaryDisplacement"), moved - rest, atol=1e-6)

    def test_colored_by_role(self):
        self.displacement.UpdatePipeline()
        display = simple.Show(self.displacement, simple.CreateRenderView())
        self.assertEqual(list(display.ColorArrayName), ["CELLS", "Role"])

    def test_every_role_has_a_name_and_a_color(self):
        move = self.displacement
        move.Moving, move.Surfaces = "Surfaces", [self.top_surface()]
        move.Displacement, move.Vector, move.Surroundings = "Vector", [0, 0, 1], "Stay"
        move.FreeSurfaces = [name for name in move.GetProperty("FreeSurfaces").Available
                            if name != self.top_surface()][:1]
        move.UpdatePipeline()
        simple.Show(move, simple.CreateRenderView())
        table = simple.GetColorTransferFunction("Role")
        names = dict(zip(table.Annotations[::2], table.Annotations[1::2]))
        self.assertEqual([names[str(role)] for role in range(7)],
                         ["Stays", "Moves", "Held", "Follows", "Free", "Zone", "Layer"])
        self.assertEqual(len(table.IndexedColors), 3 * len(names))
        grid = servermanager.Fetch(move)
        roles = {int(r) for r in vtk_to_numpy(grid.GetCellData().GetArray("Role"))}
        self.assertIn(4, roles)
        self.assertLessEqual({str(r) for r in roles}, set(names))

    def test_fit_to_surface(self):
        """The face at the end of z goes onto a square of its size, 0.5 beyond it."""
        high = CELLS + 0.5
        plane = simple.Plane(Origin=[0, 0, high], Point1=[CELLS, 0, high],
                             Point2=[0, CELLS, high])
        by_name = MorphMesh(Input=self.mesh, Displacement="Target", Target=plane,
                            Surfaces=["Surface 5"])
        by_place = FittoSurface(Input=self.mesh, Target=plane, Surfaces=["Surface 5"])
        for fit in (by_name, by_place):
            self.assertEqual(number(fit, "MorphStatus"), "Valid")
            self.assertAlmostEqual(fit.MaxTargetDistanceBefore, 0.5)
            self.assertAlmostEqual(fit.MeanTargetDistanceBefore, 0.5)
            self.assertLess(fit.MaxTargetDistance, 1e-6)
            moved, top = points(fit), self.rest[:, 2] == CELLS
            np.testing.assert_allclose(moved[top], self.rest[top] + [0, 0, 0.5], atol=1e-6)
            np.testing.assert_allclose(array(fit, "TargetDistanceBefore")[top], 0.5, atol=1e-6)
        np.testing.assert_array_equal(points(by_name), points(by_place))


class ZoneTests(unittest.TestCase):
    """Frozen and rigid zones, layers and stiffness, as a script sets them."""

    def setUp(self):
        wavelet = simple.Wavelet(WholeExtent=[0, CELLS, 0, CELLS, 0, CELLS])
        mesh = simple.AppendDatasets(Input=[wavelet])
        self.mesh = simple.Calculator(Input=mesh, ResultArrayName="middle",
                                      Function="abs(coordsX-3)<1.5 & abs(coordsY-3)<1.5"
                                               " & abs(coordsZ-3)<1.5")
        self.rest = points(self.mesh)
        self.middle = np.all(np.abs(self.rest - 3) < 1.5, axis=1)
        self.morph = MorphMesh(Input=self.mesh, Moving="Region",
                               Displacement="Translate, rotate, scale",
                               Rotation=[0, 0, 20], Translation=[0, 0, 1])
        self.morph.Region = "Box"
        self.morph.Region.Position = [-1, -1, CELLS - 0.5]
        self.morph.Region.Length = [CELLS + 2, CELLS + 2, 1]

    def test_zones(self):
        free = points(self.morph)
        self.assertGreater(np.abs(free - self.rest)[self.middle].max(), 0.1)
        self.morph.FixedZones = ["middle"]
        frozen = points(self.morph)
        np.testing.assert_array_equal(frozen[self.middle], self.rest[self.middle])
        self.morph.FixedZones = []
        self.morph.RigidZones = ["middle"]
        rigid = points(self.morph)
        distance = lambda x: np.linalg.norm(x[self.middle][:, None] - x[self.middle][None], axis=2)
        np.testing.assert_allclose(distance(rigid), distance(self.rest), atol=1e-5)
        self.morph.RigidZones = []
        np.testing.assert_array_equal(points(self.morph), free)

    def test_region(self):
        self.morph.ZoneRegionType = "Frozen"
        self.morph.ZoneRegion = "Box"
        self.morph.ZoneRegion.Position = [1.5, 1.5, 1.5]
        self.morph.ZoneRegion.Length = [3, 3, 3]
        np.testing.assert_array_equal(points(self.morph)[self.middle], self.rest[self.middle])

    def test_layers(self):
        self.morph.KeepLayers = 2
        moved = points(self.morph)
        top, below = (np.flatnonzero(np.abs(self.rest[:, 2] - z) < 1e-6)
                      for z in (CELLS, CELLS - 2))
        inner = lambda ids: ids[np.all(np.abs(self.rest[ids, :2] - 3) < 2.5, axis=1)]
        lines = moved[inner(top)] - moved[inner(below)]
        np.testing.assert_allclose(lines, np.tile([0, 0, 2], (len(lines), 1)), atol=1e-5)

    def test_stiffness(self):
        uniform = points(self.morph)
        self.morph.Stiffness = "Wall distance"
        stiff = points(self.morph)
        self.assertGreater(np.abs(stiff - uniform).max(), 1e-3)
        boundary = BoundaryDisplacement(Input=self.mesh)
        method = MorphFEMWARP(Input=self.mesh, Boundary=boundary, Stiffness="Inverse volume")
        self.assertEqual(method.Stiffness, "Inverse volume")
        np.testing.assert_array_equal(points(method), self.rest)


if __name__ == "__main__":
    unittest.main()
