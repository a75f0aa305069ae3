# SPDX-License-Identifier: BSD-3-Clause
"""The Python examples of the pages in Documentation, run as they stand on the small bore as
part.vtu: each ends with a valid mesh, and so do the commands of morph-mesh. Those of HowTo print
what the pages say, and make the pictures they show. (README.md's is in readme.py, those for plain
VTK are in Testing/Install.)

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython pages.py
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Utilities"))
import howto_pictures  # noqa: E402  (needs the path above)

BORE = ROOT / "Data/Models/small/bore_hex_small.vtu"
PAGES = {page.name: re.findall(r"^```py(?:thon)?\n(.*?)^```", page.read_text(encoding="utf-8"),
                               re.MULTILINE | re.DOTALL)
         for page in (ROOT / "Documentation").glob("*.md")}
#: Pages with a test of their own below.
ELSEWHERE = ("SolverFiles.md",)
DONE = ("Valid", "Repaired", "SubStepped", "Unmeasured")


def morphs(names):
    """The filters among a script's variables that morph."""
    return {name: value for name, value in names.items()
            if isinstance(value, servermanager.SourceProxy) and hasattr(value, "MorphStatus")}


class InFolder(unittest.TestCase):
    """In a folder that has the bore as part.vtu."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        self.addCleanup(simple.ResetSession)
        os.chdir(folder.name)
        shutil.copy(BORE, "part.vtu")

    def names(self):
        """What the pages take as known: the functions of paraview.simple and of the plugin."""
        names = {name: value for name, value in globals().items()
                 if isinstance(value, type(MorphMesh)) and not name.startswith("_")}
        names.update({name: getattr(simple, name) for name in dir(simple)
                      if not name.startswith("_")})
        return names


class Pages(InFolder):
    """A test for each page, made below."""

    def run_page(self, page):
        names = self.names()
        for number, block in enumerate(PAGES[page], 1):
            with self.subTest(block=number):
                exec(compile(block, f"{page}, example {number}", "exec"), names)
                for name, proxy in morphs(names).items():
                    proxy.UpdatePipeline()
                    self.assertIn(proxy.MorphStatus, DONE, name)
                    if proxy.MorphStatus != "Unmeasured":
                        self.assertEqual(proxy.InvertedCells, 0, name)
        return names

    def test_every_loop_looks_at_the_status_first(self):
        """Where an example reads a number of quality, it has read MorphStatus before."""
        examples = dict(PAGES)
        for path in [ROOT / "README.md", *(ROOT / "Examples").glob("*.py")]:
            examples[path.name] = [path.read_text(encoding="utf-8")]
        for path in howto_pictures.PAGES.glob("*.md"):
            # A page is one script.
            examples[path.name] = ["\n".join(code for _, code in
                                             howto_pictures.BLOCK.findall(
                                                 path.read_text(encoding="utf-8")))]
        number = re.compile(r"(MinScaledJacobian|InvertedCells|MeanScaledJacobian)")
        found = 0
        for name, blocks in examples.items():
            for block in blocks:
                first = number.search(block)
                if first:
                    found += 1
                    self.assertIn("MorphStatus", block[:first.start()], name)
        self.assertGreater(found, 12)


def commands_of(page):
    """The commands of morph-mesh among a page's indented lines."""
    text = (ROOT / "Documentation" / page).read_text(encoding="utf-8")
    outside = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    lines = [line[4:] for block in re.findall(r"(?<=\n\n)(?: {4}.*\n)+", outside)
             for line in block.splitlines()]
    return [line for line in lines if line.startswith("morph-mesh ")]


class SolverFilesAndCommands(InFolder):
    """On the small bore as part.vtu, and as a part of Abaqus, wing.inp."""

    def status_of(self, code):
        names = self.names()
        exec(compile(code, "example", "exec"), names)
        found = morphs(names)
        self.assertGreater(len(found), 0)
        for name, proxy in found.items():
            proxy.UpdatePipeline()
            self.assertIn(proxy.MorphStatus, DONE, name)
            self.assertEqual(proxy.InvertedCells, 0, name)

    def test_solver_file(self):
        self.write_wing()
        code = PAGES["SolverFiles.md"][0]
        self.assertIn("SolverFileReader", code)
        # No writer of ParaView names a set of Exodus II.
        self.status_of(code.replace("wing.exo", "wing.inp").replace(
            "wing-moved.exo", "wing-moved.inp").replace('"wall"', '"Wall"'))
        self.assertTrue(Path("wing-moved.inp").exists())

    def read_part(self):
        """Points, nodes of cells from 1 on, and which points are on top."""
        grid = servermanager.Fetch(simple.OpenDataFile("part.vtu"))
        points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
        cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8) + 1
        return points, cells, points[:, 2] > points[:, 2].max() - 1e-6

    def write_flow(self):
        """The part as a mesh of Gmsh, flow.msh, whose upper faces are named."""
        points, cells, top = self.read_part()
        sides = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
        faces = [cell[list(side)] for cell in cells for side in sides
                 if top[cell[list(side)] - 1].all()]
        elements = [*((3, 1, face) for face in faces), *((5, 2, cell) for cell in cells)]
        rows = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "wall"',
                '3 2 "flow"', "$EndPhysicalNames", "$Nodes", len(points),
                *(f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist(), 1)),
                "$EndNodes", "$Elements", len(elements),
                *(" ".join(map(str, (i, kind, 2, group, group, *nodes)))
                  for i, (kind, group, nodes) in enumerate(elements, 1)), "$EndElements"]
        Path("flow.msh").write_text("\n".join(map(str, rows)) + "\n", encoding="utf-8")

    def write_wing(self):
        points, cells, top = self.read_part()
        rows = ["*NODE", *(f"{i}, {x!r}, {y!r}, {z!r}"
                           for i, (x, y, z) in enumerate(points.tolist(), 1)),
                "*ELEMENT, TYPE=C3D8, ELSET=Body",
                *(", ".join(map(str, (i, *cell))) for i, cell in enumerate(cells.tolist(), 1)),
                "*NSET, NSET=Wall", *(f"{i + 1}," for i in top.nonzero()[0])]
        Path("wing.inp").write_text("\n".join(rows) + "\n", encoding="utf-8")

    def test_commands(self):
        """Those of morph-mesh but for those on a case of OpenFOAM, which openfoam_cases.py runs."""
        self.write_wing()
        self.write_flow()
        part = simple.OpenDataFile("part.vtu")
        simple.SaveData("fem.vtu", proxy=simple.Calculator(
            Input=part, ResultArrayName="U", Function="0.01*coordsZ*kHat"), DataMode="Ascii")
        boundary = ExtractMorphBoundary(Input=part)

        def displaced(function):
            return simple.Calculator(Input=boundary, CoordinateResults=1, Function=function)

        simple.SaveData("part.stl", proxy=displaced("coords*1.02 + 0.1*iHat"))
        simple.SaveData("moved.vtp", proxy=displaced("coords + 0.05*coordsX*jHat"),
                        DataMode="Ascii")
        lid = simple.Threshold(Input=BoundaryDisplacement(Input=part),
                               Scalars=["CELLS", "GeometryId"], LowerThreshold=3, UpperThreshold=3)
        simple.SaveData("lid.stl", proxy=simple.ExtractSurface(Input=simple.Calculator(
            Input=lid, CoordinateResults=1, Function="coords*1.02 + 0.1*kHat")))
        Path("nodes.csv").write_text("id,dx,dy,dz\n0,0.01,0,0\n", encoding="utf-8")
        commands = [line for page in ("CommandLine.md", "SolverFiles.md")
                    for line in commands_of(page)
                    if not re.search(r"\bcase\b", line)]
        self.assertGreaterEqual(len(commands), 10)
        environment = howto_pictures.environment(PLUGIN)
        for line in commands:
            with self.subTest(command=line):
                # The shell ends a line at its comment.
                done = subprocess.run(["bash", "-c", line], env=environment,
                                      capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                if not re.search(" (list|extract) ", line):
                    self.assertRegex(done.stdout, r"(?m)^inverted cells( +0)+$")


    def test_what_a_command_prints(self):
        shutil.copy(BORE.with_name("canister_hex_small.vtu"), "canister.vtu")
        page = (ROOT / "Documentation/CommandLine.md").read_text(encoding="utf-8")
        said = re.search(r"`(--move [^`]*)`\s+prints this, .*?:\n\n((?: {4}.*\n)+)", page)
        done = subprocess.run(["bash", "-c", f"morph-mesh {said[1]} canister.vtu wider.vtu"],
                              env=howto_pictures.environment(PLUGIN),
                              capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.endswith("wider.vtu: Valid\n"), done.stdout)
        self.assertTrue(done.stdout.startswith(re.sub(r"^ {4}", "", said[2], flags=re.MULTILINE)),
                        done.stdout)


class ProjectCommands(unittest.TestCase):
    """Commands of Install.md and Study.md, in a folder that looks like the project's."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "build").mkdir()
        (self.folder / "build/paraview").symlink_to(howto_pictures.build_folder(PLUGIN))
        (self.folder / "Utilities").symlink_to(ROOT / "Utilities")

    def run_line(self, page, start, then=""):
        """Runs the line of the page that begins so, and more."""
        text = (ROOT / "Documentation" / page).read_text(encoding="utf-8")
        line = re.search(rf"^ {{4}}({re.escape(start)}.*)$", text, re.MULTILINE)[1]
        done = subprocess.run(["bash", "-ec", f"{line}\n{then}"], cwd=self.folder,
                              env={**os.environ, "HOME": str(self.folder)}, capture_output=True,
                              text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_paraview_loads_the_plugin_by_its_folder(self):
        Path(self.folder, "task.py").write_text(
            "from paraview.simple import *\nprint(MorphMesh.__name__)\n", encoding="utf-8")
        self.assertEqual(self.run_line("Install.md", "export PV_PLUGIN_PATH", "pvpython task.py"),
                         "MorphMesh\n")

    def test_the_plugin_is_installed_alone(self):
        self.run_line("Install.md", "cmake --install build/paraview --component plugin")
        found = [path.name for path in (self.folder / ".local").rglob("*.*")
                 if path.suffix in (".so", ".h")]
        self.assertEqual(found, ["MeshMorphing.so"])

    def test_the_study_s_report(self):
        shutil.copytree(ROOT / "Documentation/Study", self.folder / "study-output")
        self.run_line("Study.md", "pvpython Utilities/study.py --report")
        self.assertEqual((self.folder / "study-output/Results.md").read_text(encoding="utf-8"),
                         (ROOT / "Documentation/Study/Results.md").read_text(encoding="utf-8"))


class HowTos(unittest.TestCase):
    """The pages of HowTo, each run as it stands: it raises if a mesh is not valid."""

    def test_pages(self):
        for page in howto_pictures.pages():
            with self.subTest(page=page), tempfile.TemporaryDirectory() as folder:
                absent = howto_pictures.missing(page, PLUGIN)
                if absent:
                    self.skipTest(f"{page}.md: there is no {', '.join(absent)}")
                paths, printed = howto_pictures.run(page, PLUGIN, folder)
                self.assertGreater(len(paths), 0)
                self.assertGreater(len(howto_pictures.expected(page)), 0)
                for pattern in howto_pictures.expected(page):
                    self.assertRegex(" ".join(printed.split()), pattern)
                for path in paths:
                    made = image(path)
                    kept = image(ROOT / "Documentation/images" / Path(path).name)
                    self.assertEqual(made.shape, kept.shape, path)
                    # As the page shows it, but for fonts and the colors of this ParaView.
                    self.assertLess(abs(made - kept).mean(), 20, path)

    def test_cxx_is_that_of_the_example(self):
        """Each C++ block is a part of OwnMethod.cxx, which another test compiles and runs."""
        source = (ROOT / "Examples/OwnMethod.cxx").read_text(encoding="utf-8")
        page = (ROOT / "Documentation/HowTo/WriteYourOwnMethod.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```c\+\+\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        self.assertGreaterEqual(len(blocks), 2)
        for block in blocks:
            self.assertIn(block, source)


def image(path):
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    width, height, _ = data.GetDimensions()
    values = vtk_to_numpy(data.GetPointData().GetScalars()).reshape(height, width, -1)
    return values[:, :, :3].astype(float)


def add(page):
    def test(self):
        names = self.run_page(page)
        self.assertTrue(any(isinstance(value, servermanager.SourceProxy)
                            for value in names.values()))
    setattr(Pages, "test_" + re.sub(r"\W", "_", page[:-3]).lower(), test)


for example in sorted(PAGES):
    if PAGES[example] and example not in ELSEWHERE:
        add(example)

if __name__ == "__main__":
    unittest.main()
