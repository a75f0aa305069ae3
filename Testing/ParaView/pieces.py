# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on files of VTK: they are written again with moved points, and with their cells and
arrays as they were. The morph of the pieces of a .pvtu or .vtm is that of the mesh in one piece.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython pieces.py
"""
import os
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet
from vtkmodules.vtkFiltersCore import vtkExtractCells
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader, vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import (
    vtkXMLGenericDataObjectReader, vtkXMLMultiBlockDataReader, vtkXMLMultiBlockDataWriter,
    vtkXMLUnstructuredGridWriter)

LIB = next(f for f in Path(os.environ["MESHMORPHING_PLUGIN"]).parents if f.name == "lib")
PROGRAM = LIB.parent / "bin/morph-mesh"
MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/canister_hex_small.vtu"
MOVE = ("--move", "Surface 0", "--radius", "0.1", "--method", "FEMWARP")


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, **options)


def read(path):
    reader = (vtkGenericDataObjectReader() if Path(path).suffix == ".vtk"
              else vtkXMLGenericDataObjectReader())
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def cells_of(grid, ids):
    extract = vtkExtractCells()
    chosen = vtkIdList()
    for i in ids:
        chosen.InsertNextId(int(i))
    extract.SetInputData(grid)
    extract.SetCellList(chosen)
    extract.Update()
    return extract.GetOutput()


def arrays(data):
    """Names, types, roles and bytes of all arrays, and the cells."""
    found = []
    for attributes in (data.GetPointData(), data.GetCellData(), data.GetFieldData()):
        for i in range(attributes.GetNumberOfArrays()):
            array = attributes.GetAbstractArray(i)
            values = ([array.GetValue(k) for k in range(array.GetNumberOfValues())]
                      if array.IsA("vtkStringArray") else vtk_to_numpy(array).tobytes())
            role = -1 if attributes.IsA("vtkFieldData") and not attributes.IsA(
                "vtkDataSetAttributes") else attributes.IsArrayAnAttribute(i)
            found.append((array.GetName(), array.GetDataType(), array.GetNumberOfComponents(),
                          [array.GetComponentName(k)
                           for k in range(array.GetNumberOfComponents())], role, values))
    cells = data.GetPolys() if data.IsA("vtkPolyData") else data.GetCells()
    types = [data.GetCellType(i) for i in range(data.GetNumberOfCells())]
    return found, types, vtk_to_numpy(cells.GetConnectivityArray()).tolist()


class Pieces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.whole = read(MESH)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        out = Path(folder.name) / "whole.vtu"
        result = run(*MOVE, MESH, out)
        assert result.returncode == 0, result.stderr
        moved = points(read(out))
        cls.moved = {tuple(a): b for a, b in zip(points(cls.whole), moved)}

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def parts(self, ghosts):
        """Three parts of the mesh with arrays; `ghosts`: and the cells of others at their nodes."""
        count = self.whole.GetNumberOfCells()
        nodes = vtk_to_numpy(self.whole.GetCells().GetConnectivityArray()).reshape(count, 8)
        owner = np.arange(count) * 3 // count
        for part in range(3):
            own = owner == part
            used = np.zeros(self.whole.GetNumberOfPoints(), bool)
            used[nodes[own].ravel()] = True
            ids = np.flatnonzero(used[nodes].any(1) if ghosts else own)
            grid = cells_of(self.whole, ids)
            for attributes, name, values in (
                    (grid.GetPointData(), "temperature", points(grid)[:, 2].astype("f4")),
                    (grid.GetCellData(), "part", np.full(len(ids), part, "i4"))):
                array = numpy_to_vtk(values, deep=True)
                array.SetName(name)
                attributes.AddArray(array)
            if ghosts:
                array = numpy_to_vtk((~own[ids]).astype("u1"), deep=True)
                array.SetName("vtkGhostType")
                grid.GetCellData().AddArray(array)
            text = vtkStringArray()
            text.SetName("note")
            text.InsertNextValue(f"part {part}")
            grid.GetFieldData().AddArray(text)
            yield grid

    def write_pvtu(self, ghosts=False):
        path = self.folder / "in" / "part.pvtu"
        (path.parent / "pieces").mkdir(parents=True)
        sources = []
        for i, grid in enumerate(self.parts(ghosts)):
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetDataModeToBinary()
            sources.append(f"pieces/part_{i}.vtu")
            writer.SetFileName(str(path.parent / sources[-1]))
            writer.SetInputData(grid)
            writer.Write()
        ghost = '<PDataArray type="UInt8" Name="vtkGhostType"/>' if ghosts else ""
        path.write_text(
            '<?xml version="1.0"?>\n<VTKFile type="PUnstructuredGrid" version="0.1">\n'
            f'<PUnstructuredGrid GhostLevel="{int(ghosts)}">\n<!-- mine -->\n'
            '<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>\n'
            '<PPointData><PDataArray type="Float32" Name="temperature"/></PPointData>\n'
            f'<PCellData><PDataArray type="Int32" Name="part"/>{ghost}</PCellData>\n'
            + "".join(f'<Piece Source="{s}"/>\n' for s in sources)
            + "</PUnstructuredGrid>\n</VTKFile>\n")
        return path, sources

    def write_vtm(self, *others):
        """Blocks in a block, a surface, and `others`."""
        blocks, inner = vtkMultiBlockDataSet(), vtkMultiBlockDataSet()
        for i, grid in enumerate(self.parts(False)):
            inner.SetBlock(i, grid)
        surface = vtkDataSetSurfaceFilter()
        surface.SetInputData(self.whole)
        surface.Update()
        for i, block in enumerate((inner, surface.GetOutput(), *others)):
            blocks.SetBlock(i, block)
        blocks.GetMetaData(1).Set(blocks.NAME(), "skin")
        path = self.folder / "in" / "part.vtm"
        path.parent.mkdir()
        writer = vtkXMLMultiBlockDataWriter()
        writer.SetDataModeToBinary()
        writer.SetFileName(str(path))
        writer.SetInputData(blocks)
        writer.Write()
        sources = (path.parent / "part").iterdir()
        return path, sorted(str(p.relative_to(path.parent)) for p in sources)

    def files(self, folder):
        return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*")
                if p.is_file()}

    def morph(self, path, out, *arguments):
        result = run(*(arguments or MOVE), path, out)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def compare(self, old, new):
        """A piece: its points are those of the mesh in one piece, and all else is the same."""
        old, new = read(old), read(new)
        self.assertEqual(arrays(old), arrays(new))
        exact = np.array([self.moved[tuple(x)] for x in points(old)])
        np.testing.assert_allclose(points(new), exact, rtol=0, atol=1e-9)
        return abs(points(new) - points(old)).max()

    def test_pieces_of_a_parallel_file(self):
        for ghosts in (False, True):
            with self.subTest(ghosts=ghosts), tempfile.TemporaryDirectory() as name:
                self.folder = Path(name)
                path, sources = self.write_pvtu(ghosts)
                before = self.files(path.parent)
                there = self.folder / "there"
                there.mkdir()
                self.morph(path, there / "part.pvtu")
                self.assertEqual((there / "part.pvtu").read_bytes(), path.read_bytes())
                self.assertGreater(max(self.compare(path.parent / s, there / s)
                                       for s in sources), 0.09)
                # In the same folder by another name: the pieces have that name, too.
                self.morph(path, path.with_name("wide.pvtu"))
                after = self.files(path.parent)
                self.assertEqual(before, {k: after[k] for k in before})
                new = [s.replace("part_", "wide_") for s in sources]
                self.assertEqual(set(after) - set(before), {"wide.pvtu", *new})
                self.assertEqual(after["wide.pvtu"],
                                 before["part.pvtu"].replace(b"part_", b"wide_"))
                for s, n in zip(sources, new):
                    self.assertEqual(after[n], (there / s).read_bytes())
                # The output may be the original.
                self.morph(path, path)
                for s in sources:
                    self.assertEqual((path.parent / s).read_bytes(), (there / s).read_bytes())

    def test_blocks(self):
        path, sources = self.write_vtm()
        self.assertEqual(len(sources), 4)
        self.morph(path, path.with_name("wide.vtm"))
        for source in sources:
            self.compare(path.parent / source, path.parent / source.replace("part", "wide"))
        reader = vtkXMLMultiBlockDataReader()
        reader.SetFileName(str(path.with_name("wide.vtm")))
        reader.Update()
        blocks = reader.GetOutput()
        self.assertEqual(blocks.GetMetaData(1).Get(blocks.NAME()), "skin")
        self.assertEqual(blocks.GetNumberOfPoints(),
                         sum(read(path.parent / s).GetNumberOfPoints() for s in sources))

    def rich_grid(self):
        """The mesh with arrays of each type of number, and of text."""
        grid = self.whole.NewInstance()
        grid.DeepCopy(self.whole)
        random = np.random.default_rng(24)
        for attributes, count in ((grid.GetPointData(), grid.GetNumberOfPoints()),
                                  (grid.GetCellData(), grid.GetNumberOfCells()),
                                  (grid.GetFieldData(), 5)):
            for number, kind in enumerate(("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4",
                                           "f8")):
                components = 1 + number % 4
                values = random.integers(0, 127, (count, components)).astype(kind)
                if kind[0] == "f":
                    values = random.standard_normal((count, components)).astype(kind)
                    values[:3, 0] = 1.5e30, -0.0, 2.5e-30  # VTK's text holds no infinity
                array = numpy_to_vtk(values, deep=True)
                array.SetName(f"array {kind}")
                attributes.AddArray(array)
        for name, attributes, count in (("notes", grid.GetFieldData(), 3),
                                        ("marks", grid.GetCellData(), grid.GetNumberOfCells())):
            text = vtkStringArray()
            text.SetName(name)
            for i in range(count):
                text.InsertNextValue(f"text {i % 7}")
            attributes.AddArray(text)
        grid.GetPointData().SetActiveScalars("array f8")
        grid.GetPointData().SetActiveVectors("array i2")
        grid.GetCellData().SetActiveScalars("array u1")
        return grid

    def test_a_grid_keeps_its_arrays(self):
        """Files of VTK: .vtu in each mode, .vtk as text and binary."""
        grid = self.rich_grid()
        for extension, Writer, modes in (
                (".vtu", vtkXMLUnstructuredGridWriter, ("SetDataModeToAscii",
                                                        "SetDataModeToBinary")),
                (".vtk", vtkUnstructuredGridWriter, ("SetFileTypeToASCII", "SetFileTypeToBinary"))):
            for mode in modes:
                with self.subTest(extension=extension, mode=mode):
                    path, out = (self.folder / (name + extension) for name in ("grid", "out"))
                    writer = Writer()
                    writer.SetFileName(str(path))
                    writer.SetInputData(grid)
                    getattr(writer, mode)()
                    writer.Write()
                    self.assertGreater(len(arrays(read(path))[0]), 30)
                    self.morph(path, out)
                    before, after = read(path), read(out)
                    self.assertEqual(arrays(before), arrays(after))
                    self.assertEqual(points(before).dtype, points(after).dtype)
                    self.assertGreater(abs(points(before) - points(after)).max(), 0.09)
                    if "Binary" in mode:  # text rounds the points that are morphed
                        self.compare(path, out)
                    # The output may be the original.
                    self.morph(path, path)
                    self.assertEqual(arrays(read(path)), arrays(before))
                    np.testing.assert_array_equal(points(read(path)), points(after))

    def test_single_precision_stays(self):
        path, sources = self.write_pvtu()
        for source in sources:
            grid = read(path.parent / source)
            grid.GetPoints().SetData(numpy_to_vtk(points(grid).astype("f4"), deep=True))
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetDataModeToBinary()
            writer.SetFileName(str(path.parent / source))
            writer.SetInputData(grid)
            writer.Write()
        old = [points(read(path.parent / s)) for s in sources]
        self.morph(path, path)
        for source, before in zip(sources, old):
            after = points(read(path.parent / source))
            self.assertEqual(after.dtype, np.float32)
            self.assertGreater(abs(after - before).max(), 0.09)

    def test_a_limit_on_the_size_of_files_leaves_all_old_files(self):
        for write in (self.write_pvtu, self.write_vtm):
            with self.subTest(write=write.__name__), tempfile.TemporaryDirectory() as name:
                self.folder = Path(name)
                path, sources = write()
                before = self.files(path.parent)
                largest = max(len(before[s]) for s in sources)
                for limit in (0, largest // 2, largest - 100):
                    result = run(*MOVE, path, path, preexec_fn=lambda limit=limit:
                                 resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                    self.assertEqual(result.returncode, 1)
                    self.assertRegex(result.stderr, "^morph-mesh: Cannot write .*File too large")
                    self.assertEqual(self.files(path.parent), before)

    def refuse(self, message, *arguments):
        before = self.files(self.folder)
        result = run(*arguments)
        self.assertEqual((result.returncode, result.stderr.count("\n")), (1, 1), result.stderr)
        self.assertRegex(result.stderr, message)
        self.assertEqual(self.files(self.folder), before)

    def test_what_is_refused(self):
        path, sources = self.write_pvtu()
        self.refuse("is .pvtu too", *MOVE, path, self.folder / "out.vtm")
        text = path.read_text()
        (path.parent / "pieces" / "x.vtu").write_bytes((path.parent / sources[0]).read_bytes())
        for change, message in (
                (text.replace("part_0", "x"), "names the piece pieces/x.vtu, which would be over"),
                (text.replace("pieces/part_0", "../x"), "names the piece ../x.vtu, which is not"),
                (text.replace("part_0", "none"), "none.vtu: there is no such file"),
                (text.replace("part_0.vtu", "a.pvtu"), "a list of pieces again"),
                ("<VTKFile></VTKFile>", "names no piece"), ("nothing", "names no piece")):
            with self.subTest(message=message):
                path.write_text(change)
                self.refuse(message, *MOVE, path, path.with_name("wide.pvtu"))

    def test_a_block_that_is_an_image_is_refused(self):
        image = vtkImageData()
        image.SetDimensions(2, 2, 2)
        image.SetOrigin(100, 0, 0)
        path, _ = self.write_vtm(image)
        csv = self.folder / "nodes.csv"
        csv.write_text("id,dx,dy,dz\n0,0,0,0.01\n")
        self.refuse("vtkImageData, whose points cannot be moved", "--displacements", csv, path,
                    self.folder / "out.vtm")


if __name__ == "__main__":
    unittest.main()
