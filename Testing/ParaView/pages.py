# SPDX-License-Identifier: BSD-3-Clause
"""The Python examples of the pages in Documentation, run as they stand on the small bore as
part.vtu: each ends with a valid mesh. Those of HowTo make the pictures they show. (README.md's is
in readme.py, that of Install.md, for plain VTK, in Testing/Install.)

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython pages.py
"""
import os
import re
import shutil
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
#: Pages for the Python of plain VTK, and those with a test of their own below.
ELSEWHERE = ("Install.md", "SolverFiles.md", "CompareMorphMethods.md", "MorphMesh.md")
DONE = ("Valid", "Repaired", "SubStepped", "Unmeasured")


def morphs(names):
    """The filters among a script's variables that morph."""
    return {name: value for name, value in names.items()
            if isinstance(value, servermanager.SourceProxy) and hasattr(value, "MorphStatus")}


class Pages(unittest.TestCase):
    """A test for each page, made below."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        self.addCleanup(simple.ResetSession)
        os.chdir(folder.name)
        shutil.copy(BORE, "part.vtu")
        Path("doe.csv").write_text("wide,long\n0,0.5\n0.25,1\n", encoding="utf-8")

    def names(self):
        """What the pages take as known: the mesh, displaced boundaries, and the filters."""
        names = {name: value for name, value in globals().items()
                 if isinstance(value, type(MorphMesh)) and not name.startswith("_")}
        names.update({name: getattr(simple, name) for name in dir(simple)
                      if not name.startswith("_")})
        part = simple.XMLUnstructuredGridReader(FileName=["part.vtu"])
        part.UpdatePipeline()
        boundary = ExtractMorphBoundary(Input=part)
        target = simple.Calculator(Input=boundary, CoordinateResults=1,
                                   Function="coords*1.02 + 0.1*iHat")
        simple.SaveData("part.stl", proxy=target)
        simple.SaveData("part.ex2", proxy=part)

        def displaced(function):
            return simple.Calculator(Input=boundary, CoordinateResults=1, Function=function)

        names.update(part=part, mesh=part, moved=displaced("coords + 0.05*coordsX*jHat"),
                     shift=displaced("coords + 0.2*iHat"))
        for name, motion in (("wide", {"Motion": "Along Normals", "Distance": -0.2}),
                             ("long", {"Motion": "Vector", "Vector": [0, 0, 0.5]})):
            names[name] = BoundaryDisplacement(Input=part, **motion)
        return names

    def run_page(self, page):
        names = self.names()
        for number, block in enumerate(PAGES[page], 1):
            block = re.sub('"build/.*?/MeshMorphing.so"', repr(PLUGIN), block)
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
        number = re.compile(r"(MinScaledJacobian|InvertedCells|MeanScaledJacobian)")
        found = 0
        for name, blocks in examples.items():
            for block in blocks:
                first = number.search(block)
                if first:
                    found += 1
                    self.assertIn("MorphStatus", block[:first.start()], name)
        self.assertGreater(found, 4)

    def test_compare_morph_methods(self):
        self.run_page("CompareMorphMethods.md")
        self.assertIn("FEMWARP", Path("ranking.csv").read_text(encoding="utf-8"))

    def test_fit_to_surface(self):
        names = self.run_page("MorphMesh.md")
        self.assertLess(names["fit"].MaxTargetDistance, 1e-5)
        self.assertGreater(names["fit"].MaxTargetDistanceBefore, 0.1)


class Gallery(unittest.TestCase):
    def test_each_picture_has_its_script(self):
        """The script is there, and knows the options and the page that the command gives."""
        text = (ROOT / "Documentation/Gallery.md").read_text(encoding="utf-8")
        sections = re.split(r"^## ", text, flags=re.MULTILINE)[1:]
        self.assertGreaterEqual(len(sections), 8)
        for section in sections:
            with self.subTest(section=section.splitlines()[0]):
                for link in re.findall(r"\]\(([^)#:]+)\)", section):
                    self.assertTrue((ROOT / "Documentation" / link).exists(), link)
                self.assertEqual(len(re.findall(r"!\[.+\]\(", section)), 1)
                scripts = re.findall(r"Utilities/[\w.]+", section)
                self.assertEqual(len(scripts), 1)
                source = (ROOT / scripts[0]).read_text(encoding="utf-8")
                # demo.sh passes its options on.
                source += (ROOT / "Utilities/demo.py").read_text(encoding="utf-8")
                for option in re.findall(r"^    .* (--[a-z-]+)", section.partition(scripts[0])[2],
                                         re.MULTILINE):
                    self.assertIn(option, source)
                for page in re.findall(r"--page (\w+)", section):
                    self.assertIn(page, howto_pictures.pages())


class HowTos(unittest.TestCase):
    """The pages of HowTo, each run as it stands: it raises where a mesh is not valid."""

    def test_pages(self):
        for page in howto_pictures.pages():
            with self.subTest(page=page), tempfile.TemporaryDirectory() as folder:
                absent = howto_pictures.missing(page, PLUGIN)
                if absent:
                    self.skipTest(f"{page}.md: there is no {', '.join(absent)}")
                path = howto_pictures.run(page, PLUGIN, folder)
                made = image(path)
                kept = image(ROOT / "Documentation/images" / Path(path).name)
                self.assertEqual(made.shape, kept.shape)
                # As the page shows it, but for fonts and the colours of this ParaView.
                self.assertLess(abs(made - kept).mean(), 20)

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
