# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on cases of OpenFOAM with several meshes, which OpenFOAM's own programs make: regions,
and the pieces of a decomposed case, collated or not. All are morphed as one mesh.

Run: MORPH_MESH=<path of morph-mesh> python3 openfoam_cases.py
"""
import filecmp
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import solver_files
from solver_files import run

BLOCKS = """
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 .5) (1 0 .5) (1 1 .5) (0 1 .5) (0 0 1) (1 0 1)
(1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) solid (5 5 4) simpleGrading (1 1 1)
hex (4 5 6 7 8 9 10 11) fluid (5 5 4) simpleGrading (1 1 1));
boundary (bottom { type wall; faces ((0 3 2 1)); } top { type wall; faces ((8 9 10 11)); }
sides { type patch; faces ((0 1 5 4) (1 2 6 5) (2 3 7 6) (3 0 4 7) (4 5 9 8) (5 6 10 9) (6 7 11 10)
(7 4 8 11)); });
"""
SYSTEM = {
    "controlDict": "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; "
                   "writeControl timeStep; writeInterval 1; writeFormat %s; writePrecision 12;",
    "fvSchemes": "gradSchemes {} divSchemes {} laplacianSchemes {}", "fvSolution": "",
    "decomposeParDict": "numberOfSubdomains 4; method simple; "
                        "simpleCoeffs { n (2 2 1); delta 0.001; }"}
SIDES = BLOCKS[BLOCKS.index("sides {"):]
# Left and right are images of each other, of which no file but that of the patches knows.
CYCLIC = BLOCKS.replace(SIDES, """
left { type cyclic; neighbourPatch right; faces ((3 0 4 7) (7 4 8 11)); }
right { type cyclic; neighbourPatch left; faces ((1 2 6 5) (5 6 10 9)); }
sides { type patch; faces ((0 1 5 4) (2 3 7 6) (4 5 9 8) (6 7 11 10)); });
""")
# One cell thick: front and back are one patch.
FLAT = BLOCKS.replace("(5 5 4)", "(5 1 4)").replace(SIDES, """
frontAndBack { type empty; faces ((0 1 5 4) (2 3 7 6) (4 5 9 8) (6 7 11 10)); }
sides { type patch; faces ((3 0 4 7) (7 4 8 11) (1 2 6 5) (5 6 10 9)); });
""")
# Left is a plane of symmetry, of which the file of the patches knows.
SYMMETRIC = (
    CYCLIC.replace("left { type cyclic; neighbourPatch right;", "left { type symmetryPlane;")
    .replace("right { type cyclic; neighbourPatch left;", "right { type patch;"))
TOP = ("--move", "top", "--translate", "0,0,0.2", "--quiet")


def openfoam(program, case, *options):
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}  # where Debian has it
    done = subprocess.run([program, "-case", case, *options], capture_output=True, text=True,
                          timeout=120, env=environment)
    return done.stdout + done.stderr


def differing(one, other):
    """The files of two folders that are not the same, by their paths."""
    files = lambda folder: {p.relative_to(folder) for p in folder.rglob("*") if p.is_file()}
    return {str(p) for p in files(one) | files(other)
            if not filecmp.cmp(one / p, other / p, shallow=False)}


@unittest.skipUnless(shutil.which("blockMesh"), "OpenFOAM is not installed (openfoam)")
class Cases(solver_files.SolverFiles):
    def setUp(self):
        super().setUp()
        self.case, self.out = self.folder / "case", self.folder / "out"

    def make(self, program, *options, form="ascii", blocks=BLOCKS):
        shutil.rmtree(self.case, ignore_errors=True)
        (self.case / "system").mkdir(parents=True)
        for name, text in {**SYSTEM, "blockMeshDict": blocks}.items():
            header = "FoamFile { version 2.0; format ascii; class dictionary; object %s; }\n" % name
            (self.case / "system" / name).write_text(header + text.replace("%s", form))
        openfoam("blockMesh", self.case)
        said = openfoam(program, self.case, *options)
        self.assertNotIn("FATAL", said)
        shutil.rmtree(self.case / "constant" / "polyMesh")

    def copy(self):
        shutil.rmtree(self.out, ignore_errors=True)
        shutil.copytree(self.case, self.out)

    def morph(self, *words):
        done = run(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def points(self, case):
        text = (case / "constant" / "polyMesh" / "points").read_text()
        return [tuple(map(float, row.split()))
                for row in re.findall(r"\(([-+.\de]+ [-+.\de]+ [-+.\de]+)\)", text)]

    def check_images(self, blocks, axis, *options):
        """Nodes at 0 along the axis, and those at 1 behind them, move alike."""
        self.make("checkMesh", blocks=blocks)
        openfoam("blockMesh", self.case)
        self.copy()
        self.morph(*options, "--quiet", self.case, self.out)
        before, after, largest = self.points(self.case), self.points(self.out), 0
        numbers = {tuple(round(x, 6) for x in place): i for i, place in enumerate(before)}
        for place, i in numbers.items():
            if place[axis] == 0:
                image = numbers[tuple(1 if k == axis else x for k, x in enumerate(place))]
                for k in range(3):
                    step = after[i][k] - before[i][k]
                    largest = max(largest, abs(step))
                    self.assertAlmostEqual(step, after[image][k] - before[image][k], delta=1e-10)
        self.assertGreater(largest, 0.05)
        self.assertIn("Mesh OK", openfoam("checkMesh", self.out, "-constant"))

    def test_cyclic_patches_stay_images(self):
        """A handle beside one of them moves both."""
        handle = self.folder / "handle.csv"
        handle.write_text("x,y,z,dx,dy,dz,radius\n0,.5,1,0.02,0,0.2,.5\n")
        self.check_images(CYCLIC, 0, "--move", "top", "--handles", handle)

    def test_planes_of_symmetry_stay_planes(self):
        """A handle beside one moves nodes along it alone."""
        handle = self.folder / "handle.csv"
        handle.write_text("x,y,z,dx,dy,dz,radius\n.25,.5,1,0.1,0,0.2,.6\n")
        self.make("checkMesh", blocks=SYMMETRIC)
        openfoam("blockMesh", self.case)
        self.copy()
        before = self.points(self.case)
        self.morph("--move", "top", "--handles", handle, "--quiet", self.case, self.out)
        after = self.points(self.out)
        sides = [i for i, x in enumerate(before) if x[0] == 0]
        self.assertEqual([after[i][0] for i in sides], [0] * len(sides))
        self.assertGreater(max(abs(after[i][2] - before[i][2]) for i in sides), 0.02)

    def test_front_and_back_of_a_plane_case_stay_images(self):
        for method in ("WeightedResidual", "Smoothing", "MeshSmoothing"):
            with self.subTest(method=method):
                self.check_images(FLAT, 1, "--move", "top", "--rotate", "y,12",
                                  "--surface-method", method)

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (gmsh)")
    def test_a_case_that_a_converter_of_openfoam_wrote(self):
        box, mesh = self.folder / "box.geo", self.folder / "box.msh"
        box.write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n'
                       'Physical Volume("body") = {1}; Physical Surface("lid") = {6};\n')
        subprocess.run(["gmsh", "-3", box, "-format", "msh22", "-o", mesh], check=True,
                       capture_output=True, timeout=120)
        for form in ("ascii", "binary"):
            with self.subTest(form=form):
                self.make("checkMesh", form=form)
                openfoam("gmshToFoam", self.case, mesh)
                self.copy()
                self.morph("--move", "lid", "--translate", "0,0,0", "--quiet", self.case, self.out)
                self.assertEqual(differing(self.case, self.out), set())
                self.morph("--move", "lid", *TOP[2:], self.case, self.out)
                self.assertEqual(differing(self.case, self.out), {"constant/polyMesh/points"})
                self.assertIn("(1 1 1.2)", openfoam("checkMesh", self.out, "-constant"))

    def test_pieces_of_a_decomposed_case_are_one_mesh(self):
        """OpenFOAM joins what is written, and finds the whole box higher."""
        for form, handler in (("ascii", "uncollated"), ("binary", "uncollated"),
                              ("ascii", "collated"), ("binary", "collated")):
            with self.subTest(form=form, handler=handler):
                self.make("decomposePar", "-fileHandler", handler, form=form)
                listed = run("list", self.case).stdout
                for name, faces in (("top", 25), ("sides", 160), ("solid", 105)):
                    self.assertRegex(listed, f"(?m)^{name} +{faces} ")
                self.assertEqual(len(re.findall("(?m)^Surface", listed)), 6)  # and no cut
                self.copy()
                self.morph("--move", "top", "--translate", "0,0,0", "--quiet", self.case, self.out)
                self.assertEqual(differing(self.case, self.out), set())
                self.morph(*TOP, self.case, self.out)
                changed = differing(self.case, self.out)
                self.assertEqual({p.rsplit("/", 1)[1] for p in changed}, {"points"})
                self.assertEqual(len(changed), 1 if handler == "collated" else 4)
                openfoam("reconstructParMesh", self.out, "-constant", "-fileHandler", handler)
                said = openfoam("checkMesh", self.out, "-constant")
                self.assertIn("Mesh OK", said)
                self.assertIn("bounding box (0 0 0) (1 1 1.2)", said)

    def test_a_time_of_a_decomposed_case(self):
        self.make("decomposePar")
        self.morph(*TOP, self.case, self.case / "0.5")
        times = sorted(str(p.relative_to(self.case))
                       for p in self.case.rglob("0.5/polyMesh/points"))
        self.assertEqual(times, [f"processor{i}/0.5/polyMesh/points" for i in range(4)])

    def test_nodes_have_the_numbers_of_the_whole_case(self):
        self.make("decomposePar")
        self.copy()
        table = self.folder / "table.csv"
        table.write_text("id,dx,dy,dz\n323,0,0,0.125\n")  # the last corner
        self.morph("--displacements", table, "--quiet", self.case, self.out)
        changed = "processor3/constant/polyMesh/points"
        self.assertIn(changed, differing(self.case, self.out))
        self.assertIn("(1 1 1.125)", (self.out / changed).read_text())

    def test_nodes_at_one_position_are_one_without_addressing(self):
        self.make("decomposePar")
        for file in self.case.rglob("pointProcAddressing"):
            file.unlink()
        self.copy()
        self.morph(*TOP, self.case, self.out)
        openfoam("reconstructParMesh", self.out, "-constant")
        self.assertIn("Mesh OK", openfoam("checkMesh", self.out, "-constant"))

    def test_pieces_that_do_not_fit_are_refused(self):
        self.make("decomposePar")
        self.refuse("piece of a decomposed case .*Give the folder of the case", "list",
                    self.case / "processor1")
        self.refuse("there is no mesh in it as in .*case", *TOP, self.case, self.out)
        shutil.rmtree(self.case / "processor2")
        self.refuse("faces of their cuts have no face on the other side", "list", self.case)
        self.make("decomposePar", "-fileHandler", "collated")
        points = self.case / "processors4" / "constant" / "polyMesh" / "points"
        whole = points.read_bytes()
        for damaged in (whole[:-200], whole.replace(b"// Processor2\n\n", b"// Processor2\n\n9"),
                        whole.replace(b"// Processor", b"// Piece")):
            points.write_bytes(damaged)
            self.refuse("points: its block . is damaged, or ends too soon", "list", self.case)

    def test_regions_are_one_mesh_whose_interface_is_tied(self):
        self.make("splitMeshRegions", "-cellZones", "-overwrite")
        listed = run("list", self.case).stdout
        self.assertRegex(listed, r"(?m)^fluid/top +25 ")
        self.assertRegex(listed, r"(?m)^fluid/fluid_to_solid +25 .*  inner$")
        self.assertRegex(listed, r"(?m)^solid/solid_to_fluid +25 .*  inner$")
        self.assertRegex(listed, r"(?m)^zone fluid: 100 cells$")
        self.copy()
        self.morph("--move", "fluid/fluid_to_solid", "--translate", "0,0,0.1", "--quiet",
                   self.case, self.out)
        mesh = "constant/%s/polyMesh/points"
        self.assertEqual(differing(self.case, self.out), {mesh % "fluid", mesh % "solid"})
        for region, box in (("fluid", "(0 0 0.6) (1 1 1)"), ("solid", "(0 0 0) (1 1 0.6)")):
            said = openfoam("checkMesh", self.out, "-region", region, "-constant")
            self.assertIn("Mesh OK", said)
            self.assertIn(f"bounding box {box}", said)

    def test_one_region_alone(self):
        self.make("splitMeshRegions", "-cellZones", "-overwrite")
        self.copy()
        self.morph("--region", "fluid", *TOP, self.case, self.out)
        points = "constant/fluid/polyMesh/points"
        self.assertEqual(differing(self.case, self.out), {points})
        self.morph("--region", "fluid", *TOP, self.case, self.case / "0.5")
        self.assertEqual((self.case / "0.5" / "fluid" / "polyMesh" / "points").read_bytes(),
                         (self.out / points).read_bytes())
        self.refuse("no region 'flud' .*Its regions are fluid, solid", "--region", "flud", *TOP,
                    self.case, self.out)
        openfoam("blockMesh", self.case)  # again a mesh of the case itself
        listed = run("list", self.case)
        self.assertIn("has a mesh of its own and regions: fluid, solid", listed.stderr)
        self.assertRegex(listed.stdout, "(?m)^top +25 ")
        (self.case / "constant" / "regionProperties").write_text("")
        listed = run("list", self.case)
        self.assertIn("which is neither read nor written", listed.stderr)
        self.assertRegex(listed.stdout, "(?m)^fluid/top +25 ")


    def test_the_commands_of_the_page(self):
        page = Path(__file__).parents[2] / "Documentation/SolverFiles.md"
        commands = re.findall(r"^ {4}((?:cp|morph-mesh) .*\bcase\b.*)$",
                              page.read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual(len(commands), 5)
        blocks = BLOCKS.replace("top {", "wall {")
        self.make("checkMesh", blocks=blocks)
        openfoam("blockMesh", self.case)
        programs = f"{Path(solver_files.PROGRAM).parent}:{os.environ['PATH']}"
        for number, command in enumerate(commands):
            if number == 1:
                self.make("splitMeshRegions", "-cellZones", "-overwrite", blocks=blocks)
            with self.subTest(command):
                done = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True,
                                      text=True, env={**os.environ, "PATH": programs}, timeout=120)
                self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)


solver_files.forget_tests_of_superclass(Cases)


if __name__ == "__main__":
    unittest.main()
