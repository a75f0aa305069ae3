# SPDX-License-Identifier: BSD-3-Clause
"""Solvers' own files in ParaView: opened, morphed by the names that they have, and saved again with
nothing but their coordinates changed.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython solver_files.py
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "Programs"))
import exodus_models
import gmsh_models
import solver_models as models

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

SHIFT = np.array([0.05, 0.02, -0.03])
WRITERS = {".inp": (models.abaqus, "Wall"), ".bdf": (models.nastran, "PID 2"),
           ".dat": (models.nastran, "PID 2"), ".su2": (models.su2, "wall"),
           ".msh": (gmsh_models.gmsh, "wall")}


def fetched(proxy):
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy)


def possible_readers(path):
    """The names of the readers that File > Open asks for."""
    factory = servermanager.vtkSMProxyManager.GetProxyManager().GetReaderFactory()
    found = factory.GetReaders(str(path), servermanager.ActiveConnection.Session)
    strings = [found.GetString(i) for i in range(found.GetLength())]
    return strings[1::3]


class SolverFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(simple.ResetSession)
        self.folder = Path(folder.name)

    def write(self, extension):
        write, wall = WRITERS[extension]
        model, rng = models.random_model(f"paraview {extension}")
        pieces = write(model, rng)
        path = self.folder / ("model" + extension)
        path.write_bytes(models.text_of(pieces))
        return model, pieces, path, wall

    def exodus(self, nodal=("displ_x", "displ_y", "displ_z")):
        if not shutil.which("ncgen"):
            return None
        model, _ = models.random_model("paraview open")
        cdl, path = self.folder / "model.cdl", self.folder / "model.exo"
        cdl.write_text(exodus_models.exodus(model, nodal=nodal))
        subprocess.run(["ncgen", "-o", path, cdl], check=True, timeout=60)
        return path

    def cgns(self):
        bore = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
        path = self.folder / "part.cgns"
        simple.SaveData(str(path), proxy=simple.OpenDataFile(str(bore)))
        return path

    def foam(self, name="case"):
        model, rng = models.random_model("paraview foam", kind="hexahedra")
        case = self.folder / name
        models.OpenFoam(model, rng).write(case)
        (case / "system").mkdir()
        (case / "system/controlDict").write_text(
            models.foam_header("dictionary", "controlDict") + "startTime 0; endTime 1; deltaT 1;\n")
        marker = case / (name + ".foam")
        marker.write_text("")
        return marker

    def test_a_case_of_openfoam_is_saved_by_its_marker(self):
        original = self.foam()
        copy = self.folder / "copy"
        shutil.copytree(original.parent, copy)
        (copy / "case.foam").unlink()
        reader = SolverFileReader(FileName=str(original))
        morph = MorphMesh(Input=reader, Moving="Surfaces", Surfaces=["wall"],
                          Displacement="Vector", Vector=list(SHIFT), Validity="Report")
        moved = vtk_to_numpy(fetched(morph).GetPoints().GetData())
        before = {p: p.read_bytes() for p in original.parent.rglob("*") if p.is_file()}
        simple.SaveData(str(copy / "copy.foam"), proxy=morph)
        read = fetched(SolverFileReader(FileName=str(copy)))
        np.testing.assert_array_equal(vtk_to_numpy(read.GetPoints().GetData()), moved)
        for path, content in before.items():
            self.assertEqual(path.read_bytes(), content)
            twin = copy / path.relative_to(original.parent)
            if path.name not in ("points", "case.foam"):
                self.assertEqual(twin.read_bytes(), content)

    def test_file_open_offers_the_reader(self):
        for extension in WRITERS:
            with self.subTest(extension=extension):
                path = self.write(extension)[2]
                readers = possible_readers(path)
                self.assertIn("SolverFileReader", readers)
                # ParaView has other readers of these extensions: it asks.
                if extension in (".inp", ".dat"):
                    self.assertGreater(len(readers), 1)
        for case in (self.exodus(), self.cgns(), self.foam()):
            if case:
                with self.subTest(path=case.name):
                    # They open as without the plugin, and no dialog asks for a reader.
                    self.assertNotIn("SolverFileReader", possible_readers(case))
                    self.assertNotEqual(simple.OpenDataFile(str(case)).GetXMLName(),
                                        "SolverFileReader")
        avs = self.folder / "avs.inp"
        avs.write_text("# AVS\n1 0 0 0 0\n1 0 0 0\n")
        self.assertNotIn("SolverFileReader", possible_readers(avs))

    def test_numbers_and_names(self):
        for extension in WRITERS:
            with self.subTest(extension=extension):
                model, _, path, wall = self.write(extension)
                data = fetched(SolverFileReader(FileName=str(path)))
                numbers = vtk_to_numpy(data.GetPointData().GetArray("NodeNumber"))
                expected = (range(len(model.order)) if extension == ".su2" else
                            [model.numbers[n] for n in model.order])
                self.assertEqual(list(numbers), list(expected))
                names = data.GetFieldData().GetAbstractArray("SurfaceNames")
                self.assertIn(wall, [names.GetValue(i) for i in range(names.GetNumberOfValues())])
                file = data.GetFieldData().GetAbstractArray("SolverFile")
                self.assertEqual(file.GetValue(0), str(path))

    def test_a_morph_is_saved_into_a_copy(self):
        """By the original that the mesh knows, and by one that is given."""
        for extension in WRITERS:
            with self.subTest(extension=extension):
                _, pieces, path, wall = self.write(extension)
                reader = SolverFileReader(FileName=str(path))
                reader.UpdatePipeline()
                morph = MorphMesh(Input=reader, Moving="Surfaces", Surfaces=[wall],
                                  Displacement="Vector", Vector=list(SHIFT), Validity="Report")
                data = fetched(morph)
                out, again = self.folder / ("out" + extension), self.folder / ("o" + extension)
                simple.SaveData(str(out), proxy=morph)
                self.compare(data, pieces, path, out, 1e-6 if "PID" in wall else 1e-14)
                other = self.folder / ("other" + extension)
                shutil.copy(path, other)
                path.unlink()
                simple.SaveData(str(again), proxy=morph, OriginalFileName=str(other))
                self.assertEqual(again.read_bytes(), out.read_bytes())

    def test_sets_as_blocks(self):
        """They move with the mesh, and are saved as the one grid is, but for the order of sums."""
        for extension in WRITERS:
            with self.subTest(extension=extension):
                _, _, path, wall = self.write(extension)
                out = []
                for as_blocks in (0, 1):
                    reader = SolverFileReader(FileName=str(path), SetsAsBlocks=as_blocks)
                    reader.UpdatePipeline()
                    data = reader.GetClientSideObject().GetOutputDataObject(0)
                    morph = MorphMesh(Input=reader, Moving="Surfaces", Surfaces=[wall],
                                      Displacement="Vector", Vector=list(SHIFT), Validity="Report")
                    if as_blocks:
                        names = [data.GetMetaData(i).Get(vtkCompositeDataSet.NAME())
                                 for i in range(data.GetNumberOfPartitionedDataSets())]
                        self.assertEqual(names[0], "Mesh")
                        self.assertEqual(sorted(names[1:]), sorted(surfaces))
                        morph.UpdatePipeline()
                        moved = morph.GetClientSideObject().GetOutputDataObject(0)
                        block = moved.GetPartition(names.index(wall), 0)
                        before = data.GetPartition(names.index(wall), 0)
                        np.testing.assert_allclose(
                            vtk_to_numpy(block.GetPoints().GetData()),
                            vtk_to_numpy(before.GetPoints().GetData()) + SHIFT, atol=1e-14)
                    else:
                        array = data.GetFieldData().GetAbstractArray("SurfaceNames")
                        surfaces = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
                    copy = self.folder / (f"blocks{as_blocks}" + extension)
                    simple.SaveData(str(copy), proxy=morph)
                    self.assertNotEqual(copy.read_bytes(), path.read_bytes())
                    read = fetched(SolverFileReader(FileName=str(copy)))
                    out.append(vtk_to_numpy(read.GetPoints().GetData()))
                np.testing.assert_allclose(*out, rtol=0, atol=1e-6 if "PID" in wall else 1e-12)

    def compare(self, data, pieces, path, out, rounding):
        found = models.coordinates_in(pieces, out.read_bytes())  # nothing else differs
        old = models.coordinates_in(pieces, path.read_bytes())
        read = fetched(SolverFileReader(FileName=str(out)))
        self.assertEqual(read.GetNumberOfCells(), data.GetNumberOfCells())
        points = [vtk_to_numpy(d.GetPoints().GetData()) for d in (read, data)]
        np.testing.assert_allclose(*points, rtol=0, atol=rounding)
        moved = [k for k in old if models.value(old[k]) != models.value(found[k])]
        self.assertGreater(len(moved), len(old) // 4)

    def test_a_mesh_without_node_numbers_is_not_written(self):
        path = self.write(".su2")[2]
        sphere = simple.Sphere()
        sphere.UpdatePipeline()
        simple.SaveData(str(self.folder / "out.su2"), proxy=sphere, OriginalFileName=str(path))
        self.assertFalse((self.folder / "out.su2").exists())

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_exodus_at_its_own_coordinates(self):
        """The file has displacements, which ParaView's own reader adds."""
        path = self.exodus()
        model, _ = models.random_model("paraview open")
        reader = SolverFileReader(FileName=str(path))
        points = vtk_to_numpy(fetched(reader).GetPoints().GetData())
        np.testing.assert_array_equal(points, [model.points[n] for n in model.order])
        morph = MorphMesh(Input=reader, Moving="Surfaces", Surfaces=["wall"],
                          Displacement="Vector", Vector=list(SHIFT), Validity="Report")
        # Save Data may take ParaView's own writer of Exodus files.
        servermanager.writers.SolverFileWriter(
            Input=morph, FileName=str(self.folder / "out.exo")).UpdatePipeline()
        out = fetched(SolverFileReader(FileName=str(self.folder / "out.exo")))
        np.testing.assert_array_equal(vtk_to_numpy(out.GetPoints().GetData()),
                                      vtk_to_numpy(fetched(morph).GetPoints().GetData()))
        if shutil.which("ncdump"):
            texts = [re.sub(r"\n coord[xyz] =[^;]*;", "", subprocess.run(
                ["ncdump", file], capture_output=True, text=True, check=True).stdout).partition(
                    "{")[2] for file in (path, self.folder / "out.exo")]
            self.assertEqual(*texts)

    def write_copy(self, proxy, name, original):
        """Writes a copy through the writer's proxy; returns the errors' text and the file."""
        errors = []

        @calldata_type(VTK_STRING)
        def keep(*details):
            errors.append(details[-1])
        writer = servermanager.writers.SolverFileWriter(
            Input=proxy, FileName=str(self.folder / name), OriginalFileName=str(original))
        writer.GetClientSideObject().AddObserver("ErrorEvent", keep)
        writer.UpdatePipeline()
        return "\n".join(errors), self.folder / name

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_exodus_by_readers_that_add_displacements(self):
        """ParaView's two readers, before and after a morph: a copy gets the file's own coordinates
        and the morph, or nothing; or the displacements alone."""
        path = self.exodus()
        model, _ = models.random_model("paraview open")
        own = np.array([model.points[n] for n in model.order])
        displacements = 1e-3 * np.arange(1, 4) + 1e-5 * np.arange(len(own))[:, None]
        for Reader, rounding in ((simple.IOSSReader, 1e-14), (simple.ExodusIIReader, 1e-6)):
            for shift in (SHIFT, 0 * SHIFT):
                for applied in (1, 0):
                    with self.subTest(reader=Reader.__name__, shift=shift, applied=applied):
                        reader = Reader(FileName=[str(path)])
                        reader.ApplyDisplacements = applied
                        morph = MorphMesh(Input=reader, Moving="Everything", Displacement="Vector",
                                          Vector=list(shift), CoincidentPoints="Merge by position",
                                          Validity="Report") if shift.any() else reader
                        morph.UpdatePipeline(0.0)
                        error, out = self.write_copy(morph, "out.exo", path)
                        if applied and shift.any():
                            self.assertRegex(error, "nodes were not at the file's own .*: [0-9].*"
                                             "The displacements 'displ_' .*Apply Displacements")
                            self.assertFalse(out.exists())
                            continue
                        self.assertEqual(error, "")
                        read = fetched(SolverFileReader(FileName=str(out)))
                        np.testing.assert_allclose(vtk_to_numpy(read.GetPoints().GetData()),
                                                   own + shift + applied * displacements, rtol=0,
                                                   atol=rounding)
                        out.unlink()

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_exodus_with_scalars_whose_names_begin_as_displacements(self):
        """No reader adds them, so a mesh that moved twice is written."""
        path = self.exodus(("distance", "dissipation", "disorder"))
        model, _ = models.random_model("paraview open")
        moved = simple.IOSSReader(FileName=[str(path)])
        for _ in range(2):
            moved = MorphMesh(Input=moved, Moving="Everything", Displacement="Vector",
                              Vector=list(SHIFT), CoincidentPoints="Merge by position")
        moved.UpdatePipeline(0.0)
        error, out = self.write_copy(moved, "out.exo", path)
        self.assertEqual(error, "")
        read = fetched(SolverFileReader(FileName=str(out)))
        np.testing.assert_allclose(vtk_to_numpy(read.GetPoints().GetData()),
                                   [model.points[n] + 2 * SHIFT for n in model.order],
                                   rtol=0, atol=1e-14)

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_each_kind_of_name_moves_its_nodes(self):
        """By Boundary Displacement and by Morph Mesh, which offer the file's names."""
        files = {extension: self.write(extension) for extension in (".inp", ".su2", ".msh")}
        exodus = self.exodus()
        model, rng = models.random_model("paraview foam", kind="hexahedra")
        models.OpenFoam(model, rng).write(self.folder / "case")
        of_exodus = models.random_model("paraview open")[0]
        for kind, model, path, name, faces in (
                ("side set", of_exodus, exodus, "wall", of_exodus.wall),
                ("node set", of_exodus, exodus, "wall nodes", of_exodus.wall),
                ("patch", model, self.folder / "case", "inlet", model.inlet),
                *((kind, files[extension][0], files[extension][2], name,
                   getattr(files[extension][0], name.lower())) for kind, extension, name in (
                       ("*SURFACE", ".inp", "Inlet"), ("*NSET", ".inp", "Wall"),
                       ("physical group", ".msh", "outlet"), ("marker", ".su2", "outlet")))):
            with self.subTest(kind=kind, name=name):
                reader = SolverFileReader(FileName=str(path))
                reader.UpdatePipeline()
                rest = vtk_to_numpy(fetched(reader).GetPoints().GetData())
                nodes = {n for _, _, corners in faces for n in corners}
                of_set = np.array([n in nodes for n in model.order])
                boundary = BoundaryDisplacement(Input=reader, Moving="Surfaces", Surfaces=[name],
                                                Displacement="Vector", Vector=list(SHIFT))
                boundary.UpdatePipeline()
                self.assertIn(name, boundary.GetProperty("Surfaces").GetAvailable())
                moved = fetched(boundary)
                ids = vtk_to_numpy(moved.GetPointData().GetArray("MorphPointId"))
                shift = vtk_to_numpy(moved.GetPoints().GetData()) - rest[ids]
                moving = vtk_to_numpy(moved.GetPointData().GetArray("Role")) == 1
                self.assertEqual(set(ids[moving]), set(np.flatnonzero(of_set)))
                np.testing.assert_allclose(shift[of_set[ids]], np.tile(SHIFT, (sum(of_set), 1)),
                                           rtol=0, atol=1e-14)
                morph = MorphMesh(Input=reader, Moving="Surfaces", Surfaces=[name],
                                  Displacement="Vector", Vector=list(SHIFT), Validity="Report")
                shift = vtk_to_numpy(fetched(morph).GetPoints().GetData()) - rest
                np.testing.assert_allclose(shift[of_set], np.tile(SHIFT, (sum(of_set), 1)),
                                           rtol=0, atol=1e-14)
                self.assertEqual((abs(shift[~of_set]).max(1) == 0).any(), True)

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_the_example_of_the_page(self):
        page = Path(__file__).resolve().parents[2] / "Documentation/SolverFiles.md"
        example = re.search(r"^```py\n(from paraview.*?wing = .*?)^```", page.read_text(),
                            re.M | re.S)
        (self.folder / "model.cdl").write_text(
            exodus_models.exodus(models.random_model("paraview page")[0]))
        subprocess.run(["ncgen", "-o", "wing.exo", "model.cdl"], cwd=self.folder, check=True)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        names = {"SaveData": simple.SaveData, **globals()}
        exec(example[1], names)  # pylint: disable=exec-used
        moved = fetched(SolverFileReader(FileName="wing-moved.exo"))
        self.assertEqual(moved.GetPoints().GetData().GetTuple(0),
                         fetched(names["moved"]).GetPoints().GetData().GetTuple(0))

    def test_cgns_that_paraview_has_written(self):
        bore = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
        part = simple.OpenDataFile(str(bore))
        path, out = str(self.folder / "part.cgns"), str(self.folder / "out.cgns")
        simple.SaveData(path, proxy=part)
        reader = SolverFileReader(FileName=path)
        read = fetched(reader)
        if read.GetNumberOfPoints() == 0:
            self.skipTest("the plugin was built without CGNS")
        self.assertEqual(read.GetNumberOfCells(), fetched(part).GetNumberOfCells())
        morph = MorphMesh(Input=reader, Moving="Everything", Displacement="Vector",
                          Vector=[0.5, 0, 0])
        simple.SaveData(out, proxy=morph)
        # In single precision, as ParaView writes it.
        for name in (path, out):
            again = fetched(SolverFileReader(FileName=name)).GetPoints().GetData()
            moved = [0.5 if name == out else 0, 0, 0]
            np.testing.assert_allclose(vtk_to_numpy(again),
                                       vtk_to_numpy(read.GetPoints().GetData()) + moved,
                                       rtol=0, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
