# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on binary files of Gmsh, and on those that a library reads and writes: Exodus II
(netCDF) and CGNS (HDF5 and ADF). What it writes is the original with other coordinates.

Run: MORPH_MESH=<path of morph-mesh> SAMPLE_FILES=<path of MeshMorphingSampleFiles>
         python3 library_files.py
MORPH_TEST_SEED sets another first seed. What is not installed is skipped by name: ncgen, ncdump
(netcdf-bin), gmsh, cgnsdiff (cgns-convert). A format that morph-mesh was
built without is skipped, too.
"""
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import exodus_models
import gmsh_models
import solver_models as models
from legacy_files import cells_of, points_of

PROGRAM = os.environ["MORPH_MESH"]
SAMPLES = os.environ["SAMPLE_FILES"]
SEED = int(os.environ.get("MORPH_TEST_SEED", "1"))
MOVE = ("--move", "wall", "--translate", "0.05,0.02,-0.03")


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


# Of VTK's quadratic tetrahedron, hexahedron (20, 27), wedge (15, 18) and pyramid: the corners
# between which each further node lies.
BETWEEN = {24: ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
           25: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                (2, 6), (3, 7)),
           26: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
           27: ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))}
BETWEEN[29] = BETWEEN[25] + ((0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3),
                             (4, 5, 6, 7), tuple(range(8)))
BETWEEN[32] = BETWEEN[26] + ((0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
# Of a tetrahedron of 15 nodes: those of faces, whose order nothing depends on.
FACES = ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))
BETWEEN[71] = BETWEEN[24] + FACES + ((0, 1, 2, 3),)
CORNERS = {71: 4, 24: 4, 25: 8, 26: 6, 27: 5, 29: 8, 32: 6}


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def morph(self, path, out, *arguments):
        result = run(*(arguments or MOVE), path, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        for line in result.stderr.splitlines():
            self.assertRegex(line, "^morph-mesh: warning: (Surfaces beside|The motion|Quality)")
        return result.stdout

    def exact(self, path, *arguments):
        """The morphed coordinates, by way of VTK's file."""
        vtk = self.folder / "exact.vtk"
        self.morph(path, vtk, *arguments)
        return points_of(vtk)

    def still(self, path):
        """The coordinates of a file, by way of VTK's."""
        csv = self.folder / "still.csv"
        csv.write_text("id,dx,dy,dz\n0,0,0,0\n")
        return self.exact(path, "--displacements", csv)

    def check_middles(self, path, *types):
        """In the undeformed mesh, further nodes lie midway between the corners that VTK says."""
        points = self.still(path)
        found = set()
        for what, nodes in cells_of(self.folder / "exact.vtk"):
            for i, corners in enumerate(BETWEEN.get(what, ()), CORNERS.get(what, 0)):
                for axis in range(3):
                    middle = sum(points[3 * nodes[c] + axis] for c in corners) / len(corners)
                    self.assertAlmostEqual(points[3 * nodes[i] + axis], middle, delta=1e-9,
                                           msg=f"{path}: cell type {what}, node {i}")
            found.add(what)
        self.assertLessEqual(set(types), found)

    def refuse(self, message, *arguments):
        before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        result = run(*arguments)
        errors = [line for line in result.stderr.splitlines() if "warning: " not in line]
        self.assertEqual((result.returncode, len(errors)), (1, 1), result.stderr)
        self.assertRegex(errors[0], message)
        self.assertEqual(before,
                         {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()})

    def surfaces(self, path):
        listed = run("--list-surfaces", path)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        rows = re.findall(r"^(.+?)  +(\d+) ", listed.stdout, re.MULTILINE)
        return {name: int(faces) for name, faces in rows}

    def rounding(self, printed):
        match = re.search("rounding of a coordinate: (.*)", printed)
        return float(match[1]) if match else 0


class Gmsh(Files):
    def test_binary_files_keep_all_but_coordinates(self):
        for version in ("2.2", "4.1"):
            for seed in range(SEED, SEED + 3):
                with self.subTest(version=version, seed=seed):
                    model, _ = models.random_model(f"gmsh {seed}", kind=("mixed", "tetrahedra",
                                                                         "hexahedra")[seed % 3])
                    content, places = gmsh_models.gmsh_binary(model, version)
                    path, out = self.folder / "model.msh", self.folder / "out.msh"
                    path.write_bytes(content)
                    self.assertEqual(self.rounding(self.morph(path, out)), 0)
                    expected = bytearray(content)
                    values = iter(self.exact(path))
                    for node in model.order:
                        for axis in range(3):
                            at = places[node, axis]
                            expected[at:at + 8] = struct.pack("<d", next(values))
                    self.assertNotEqual(bytes(expected), content)
                    self.assertEqual(out.read_bytes(), bytes(expected))
                    names = self.surfaces(path)
                    for name, faces in (("wall", model.wall), ("inlet", model.inlet)):
                        self.assertEqual(names[name], len(faces))
                    self.morph(path, path)
                    self.assertEqual(path.read_bytes(), out.read_bytes())

    def test_text_and_binary_files_are_the_same_mesh(self):
        model, rng = models.random_model("gmsh")
        style, models_number = gmsh_models.number_text, lambda rng, x, style=None: repr(x)
        gmsh_models.number_text = models_number
        self.addCleanup(setattr, gmsh_models, "number_text", style)
        results = []
        for version in ("2.2", "4.1"):
            path = self.folder / f"text{version}.msh"
            path.write_bytes(models.text_of(gmsh_models.gmsh(model, rng, version=version)))
            results.append(self.exact(path))
            path = self.folder / f"binary{version}.msh"
            path.write_bytes(gmsh_models.gmsh_binary(model, version)[0])
            results.append(self.exact(path))
        self.assertEqual(len(set(results)), 1)

    def test_damaged_files_are_refused(self):
        model, _ = models.random_model("gmsh")
        for version in ("2.2", "4.1"):
            content, places = gmsh_models.gmsh_binary(model, version)
            path = self.folder / "model.msh"
            first = places[model.order[0], 0]
            nan = content[:first] + struct.pack("<d", float("nan")) + content[first + 8:]
            for damaged, message in (
                    (content.replace(b" 1 8\n\1\0\0\0", b" 1 8\n\0\0\0\1"), "another order"),
                    (nan, "not finite"), (content[:first + 8], "has no end"),
                    (content[:first + 8] + content[first + 16:],
                     "should follow|out of range|not defined|not finite|negative|no volume|not "
                     "supported")):
                with self.subTest(version=version, message=message):
                    path.write_bytes(damaged)
                    self.refuse("Cannot read .*(" + message + ")", "--list-surfaces", path)

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (gmsh)")
    def test_gmsh_reads_its_file_back_with_its_groups(self):
        """Both orders: a node between corners lies between them in the undeformed mesh."""
        (self.folder / "cube.geo").write_text(
            'SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 2, 2, 2};\n'
            'Physical Surface("left") = {1};\nPhysical Surface("right") = {2};\n'
            'Physical Surface("both") = {1, 2};\nPhysical Volume("body") = {1};\n'
            "Mesh.MeshSizeMax = 0.9;\n")
        for version, binary, order in ((v, b, o) for v in (22, 41) for b in (0, 1) for o in (1, 2)):
            with self.subTest(version=version, binary=binary, order=order):
                path, out = self.folder / "c.msh", self.folder / "o.msh"
                subprocess.run(["gmsh", "-3", "cube.geo", "-format", f"msh{version}", "-setnumber",
                                "Mesh.Binary", str(binary), "-order", str(order), "-o", path],
                               cwd=self.folder, check=True, capture_output=True, timeout=120)
                names = self.surfaces(path)
                self.assertEqual(names["both"], names["left"] + names["right"])
                self.morph(path, out, "--move", "left", "--translate", "-0.3,0,0", "--validity",
                           "Refuse")
                before, after = self.as_written_by_gmsh(path), self.as_written_by_gmsh(out)
                coordinates = re.compile(rb"\$Nodes.*?\$EndNodes", re.S)
                self.assertNotEqual(before, after)
                self.assertEqual(coordinates.sub(b"", before), coordinates.sub(b"", after))
                self.assertIn(b'2 3 "both"', after)
                if order == 2:
                    self.check_middles(path, 24)

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (gmsh)")
    def test_second_order_elements(self):
        extrude = ("Point(1) = {{0, 0, 0}}; Point(2) = {{2, 0, 0}}; Point(3) = {{2, 2, 0}};\n"
                   "Point(4) = {{0, 2, 0}}; Line(1) = {{1, 2}}; Line(2) = {{2, 3}};\n"
                   "Line(3) = {{3, 4}}; Line(4) = {{4, 1}}; Curve Loop(1) = {{1, 2, 3, 4}};\n"
                   "Plane Surface(1) = {{1}}; Transfinite Curve{{1:4}} = 3;\n"
                   "Transfinite Surface{{1}};\n{}\n"
                   "Extrude {{0, 0, 2}} {{ Surface{{1}}; Layers{{2}}; Recombine; }}\n"
                   "Mesh.SecondOrderIncomplete = {};\n")
        for recombine, incomplete, what in (("Recombine Surface{1};", 1, 25),
                                            ("Recombine Surface{1};", 0, 29), ("", 1, 26),
                                            ("", 0, 32)):
            (self.folder / "box.geo").write_text(extrude.format(recombine, incomplete))
            for version in (22, 41):
                with self.subTest(what=what, version=version):
                    path = self.folder / "box.msh"
                    subprocess.run(["gmsh", "-3", "box.geo", "-order", "2", "-format",
                                    f"msh{version}", "-o", path], cwd=self.folder, check=True,
                                   capture_output=True, timeout=120)
                    self.check_middles(path, what)

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (gmsh)")
    def test_pyramids_with_a_node_in_their_base(self):
        (self.folder / "box.geo").write_text(
            'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 2, 2, 2};\n'
            "Transfinite Curve{:} = 3; Transfinite Surface{5}; Recombine Surface{5};\n"
            'Physical Volume("body") = {1}; Physical Surface("foot") = {5};\n')
        path, out = self.folder / "box.msh", self.folder / "out.msh"
        subprocess.run(["gmsh", "-3", "box.geo", "-order", "2", "-format", "msh22", "-o", path],
                       cwd=self.folder, check=True, capture_output=True, timeout=120)
        self.morph(path, out, "--move", "foot", "--translate", "0.25,0,-0.5")
        nodes, elements = path.read_text().split("$EndNodes")
        points = [{line.split()[0]: [float(x) for x in line.split()[1:]]
                   for line in file.read_text().split("$EndNodes")[0].split("\n")
                   if len(line.split()) == 4} for file in (path, out)]
        pyramids = [line.split()[5:] for line in elements.splitlines()
                    if line.split()[1:2] == ["14"]]
        self.assertEqual({len(nodes) for nodes in pyramids}, {14})
        for nodes in pyramids:
            for before, after, by in zip(points[0][nodes[13]], points[1][nodes[13]], (.25, 0, -.5)):
                self.assertAlmostEqual(after - before, by, delta=1e-12)

    def as_written_by_gmsh(self, path):
        """What Gmsh writes after it has read a file: text of version 2.2."""
        out = self.folder / "again.msh"
        result = subprocess.run(["gmsh", "-0", path, "-format", "msh22", "-setnumber",
                                 "Mesh.Binary", "0", "-o", out], capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertNotIn("Error", result.stdout + result.stderr)
        return out.read_bytes()


@unittest.skipUnless(shutil.which("ncgen") and shutil.which("ncdump"),
                     "ncgen and ncdump are not installed (netcdf-bin)")
class Exodus(Files):
    def write(self, kind, seed=SEED, shape="mixed", name="model.exo", **options):
        model, _ = models.random_model(f"exodus {seed}", kind=shape)
        cdl, path = self.folder / "model.cdl", self.folder / name
        cdl.write_text(exodus_models.exodus(model, **options))
        subprocess.run(["ncgen", "-k", kind, "-o", path, cdl], check=True, timeout=60)
        # An output that is no .exo is refused before the mesh is read.
        if "built without netCDF" in run(*MOVE, path, self.folder / "none.inp").stderr:
            self.skipTest("morph-mesh was built without netCDF")
        return model, path

    @staticmethod
    def dump(path):
        """The file as text, without its coordinates."""
        text = subprocess.run(["ncdump", "-p", "9,17", path], check=True, capture_output=True,
                              text=True, timeout=60).stdout
        text = text.partition("{")[2]  # without its name
        rest, found = re.subn(r"\n coord[xyz]? =[^;]*;", "", text)
        return rest, found

    def test_all_but_coordinates_is_kept(self):
        """Byte by byte: of netCDF-4 files too, which nothing else is written into."""
        for kind in ("classic", "64-bit offset", "64-bit data", "netCDF-4"):
            for together, single in ((False, False), (True, False), (False, True)):
                with self.subTest(kind=kind, together=together, single=single):
                    model, path = self.write(kind, together=together, single=single)
                    out = self.folder / "out.exo"
                    rounding = self.rounding(self.morph(path, out))
                    exact = self.exact(path)
                    code = "f" if single else "d"
                    order = ">" if kind != "netCDF-4" else "<"
                    def packed(axis):
                        return b"".join(struct.pack(order + code, x) for x in axis)
                    expected = path.read_bytes()
                    for axis in range(3):
                        old = packed([model.points[n][axis] for n in model.order])
                        self.assertEqual(expected.count(old), 1)
                        expected = expected.replace(old, packed(exact[axis::3]))
                    self.assertEqual(out.read_bytes() == expected, True)
                    self.assertNotEqual(path.read_bytes(), expected)
                    self.assertEqual(rounding > 0, single)
                    self.assertLess(rounding, 3e-7)
                    rest, found = self.dump(out)
                    self.assertEqual((rest, found), self.dump(path))
                    self.assertEqual(found, 1 if together else 3)
                    self.assertIn("vals_nod_var1 =", rest)
                    self.morph(path, path)
                    self.assertEqual(path.read_bytes() == expected, True)

    def test_compressed_variables(self):
        """Of netCDF-4: packed, the data sets may change their length."""
        if not shutil.which("nccopy"):
            self.skipTest("nccopy is not installed (netcdf-bin)")
        _, plain = self.write("netCDF-4")
        path, out = self.folder / "packed.exo", self.folder / "out.exo"
        subprocess.run(["nccopy", "-d", "6", "-s", plain, path], check=True, timeout=60)
        self.morph(path, out)
        self.assertEqual(self.dump(out), self.dump(path))
        self.assertEqual(self.exact(path), self.exact(plain))
        self.assertEqual(self.still(out), self.exact(plain))

    def test_names_of_blocks_and_sets(self):
        for names, wall, inlet, nodes in ((True, "wall", "inlet", "wall nodes"),
                                          (False, "surface_7", "surface_8", "nodelist_5")):
            for shape in ("mixed", "tetrahedra", "hexahedra"):
                model, path = self.write("classic", shape=shape, names=names)
                found = self.surfaces(path)
                self.assertEqual(found[wall], len(model.wall))
                self.assertEqual(found[nodes], len(model.wall))
                self.assertEqual(found[inlet], len(model.inlet))
                self.assertIn("tetra" if shape == "tetrahedra" else "hexahedron"
                              if names else "block_10", list(found) + ["tetra"] * (not names))
                moved = self.exact(path, "--move", wall, "--translate", "0.05,0.02,-0.03")
                self.assertEqual(moved, self.exact(path, "--move", nodes, "--translate",
                                                   "0.05,0.02,-0.03"))

    def test_blocks_with_nodes_of_their_own_stay_together(self):
        _, path = self.write("classic")
        exact = self.exact(path)
        model, other = models.random_model(f"exodus {SEED}", kind="mixed")[0], "apart.exo"
        count = len(model.points)
        exodus_models.apart(model)
        self.assertGreater(len(model.points), count)
        (self.folder / "model.cdl").write_text(exodus_models.exodus(model))
        subprocess.run(["ncgen", "-o", self.folder / other, self.folder / "model.cdl"], check=True,
                       timeout=60)
        before = {tuple(p): exact[3 * i:3 * i + 3] for i, p in enumerate(
            [model.points[n] for n in model.order[:count]])}
        self.morph(self.folder / other, self.folder / "out.exo")
        text = subprocess.run(["ncdump", "-p", "9,17", "-v", "coordx,coordy,coordz",
                               self.folder / "out.exo"], capture_output=True, text=True,
                              check=True).stdout
        axes = [list(map(float, re.search(rf"coord{a} =([^;]*);", text)[1].split(",")))
                for a in "xyz"]
        self.assertEqual(len(axes[0]), len(model.points))
        for node, x in zip(model.order, zip(*axes)):
            for a, b in zip(x, before[tuple(model.points[node])]):
                self.assertAlmostEqual(a, b, delta=1e-7)

    def test_node_numbers_of_the_file(self):
        model, path = self.write("classic")
        node = model.wall_nodes[0]
        csv, out = self.folder / "moves.csv", self.folder / "out.exo"
        csv.write_text(f"id,dx,dy,dz\n{model.numbers[node]},0.01,-0.02,0.5\n")
        self.morph(path, out, "--displacements", csv, "--node-numbers", "--validity", "None")
        written = self.still(out)
        at = 3 * model.order.index(node)
        for axis, shift in enumerate((0.01, -0.02, 0.5)):
            self.assertAlmostEqual(written[at + axis], model.points[node][axis] + shift,
                                   delta=1e-14)

    def test_displacements_of_the_last_step_become_coordinates(self):
        """All nodes move by them, inner ones too; time steps stay."""
        for kind, together in (("classic", False), ("netCDF-4", True)):
            model, path = self.write(kind, together=together)
            out = self.folder / "out.exo"
            self.morph(path, out, "--displacement-array", "displ_", "--validity", "None", path)
            self.assertEqual(self.dump(out), self.dump(path))
            baked = self.folder / "baked.exo"
            result = run("bake", "--displacement-array", "displ_", "--validity", "None", path,
                         baked)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(baked.read_bytes(), out.read_bytes())
            written, count = self.still(out), len(model.order)
            for i, node in enumerate(model.order):
                for axis in range(3):
                    step = 1e-3 * (axis + 1) + 1e-5 * (count + i)
                    self.assertAlmostEqual(written[3 * i + axis], model.points[node][axis] + step,
                                           delta=1e-14)
        _, path = self.write("classic", nodal=("disp_z", "velocity", "disp_x"))
        result = run("--displacement-array", "disp_", path, path, self.folder / "out2.exo")
        self.assertEqual(result.returncode, 1)

    def test_displacements_of_any_step(self):
        """By the file as boundary, and by the file as field, which moves another mesh too."""
        model, path = self.write("classic")
        out, count = self.folder / "out.exo", len(model.order)
        for step in (0, 1):
            self.morph(path, out, "--displacement-array", "displ_", "--time-step", str(step),
                       "--validity", "None", path)
            written = self.still(out)
            for i, node in enumerate(model.order):
                shift = 1e-3 + 1e-5 * (step * count + i)
                self.assertAlmostEqual(written[3 * i], model.points[node][0] + shift, delta=1e-14)
            again = self.folder / "again.exo"
            self.morph(path, again, "--moving", "everything", "--field", path, "--field-array",
                       "displ_", "--time-step", str(step), "--validity", "None")
            moved, rest = self.still(again), self.still(path)
            wall = {node for _, _, nodes in model.wall for node in nodes}
            for i, node in enumerate(model.order):
                if node in wall:
                    self.assertAlmostEqual(moved[3 * i] - rest[3 * i], written[3 * i] - rest[3 * i],
                                           delta=1e-12)
        take = ("--displacement-array", "displ_", "--time-step")
        self.refuse("displacements of 2 time steps, which count from 0; --time-step is 2", *take,
                    "2", path, path, out)
        self.refuse("--time-step is of files of Exodus II and CGNS", *take, "0", path,
                    self.folder / "x.vtu", out)
        _, still = self.write("classic", nodal=("a", "b", "c"))
        self.refuse("no displacements of which --time-step could be one", *take, "0", still, still,
                    out)

    def test_damaged_files_are_refused(self):
        _, path = self.write("classic")
        whole = path.read_bytes()
        cdl = (self.folder / "model.cdl").read_text()
        for size in (len(whole) // 3, len(whole) - 8, 40):
            path.write_bytes(whole[:size])
            self.refuse("Cannot read .*it is damaged, or ends too soon", "--list-surfaces", path)
            self.refuse("Cannot read .*it is damaged, or ends too soon", *MOVE, path, path)
        for change, message in (
                (lambda s: s.replace("num_dim = 3", "num_dim = 2").replace("coordz", "other"),
                 "nodes have 2 coordinates"),
                (lambda s: s.replace("num_dim", "other"), "no file of Exodus II"),
                (lambda s: re.sub(r"connect1 = \d+", "connect1 = 9999", s), "position 9999"),
                (lambda s: re.sub(r"elem_ss1 = \d+", "elem_ss1 = 9999", s), "position 9999"),
                (lambda s: re.sub(r"node_ns1 = \d+", "node_ns1 = -3", s), "position -3"),
                (lambda s: re.sub(r"coordy = [-.\d]+", "coordy = NaN", s), "are not finite"),
                (lambda s: s.replace('"HEX8"', '"HEX64"', 1).replace('"WEDGE"', '"SUPER"'),
                 "the type 'SUPER' with 6 nodes"),
                (lambda s: re.sub(r"(node_num_map = \d+, )\d+, (\d+)", r"\1\2, \2", s),
                 "more than one node")):
            with self.subTest(message=message):
                self.assertNotEqual(change(cdl), cdl)
                (self.folder / "model.cdl").write_text(change(cdl))
                subprocess.run(["ncgen", "-k", "classic", "-o", path, self.folder / "model.cdl"],
                               check=True, timeout=60)
                self.refuse(message, "--list-surfaces", path)
        self.refuse("is .exo too", *MOVE, path, self.folder / "out.inp")


class SecondOrder(Files):
    """One element of second order in each format."""
    POINTS = {25: [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2),
                   (0, 2, 2)],
              26: [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (0, 2, 2)],
              24: [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)]}
    # Corners between which the further nodes lie: bottom, sides, top.
    BOTTOM_SIDES_TOP = {
        25: ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7),
             (7, 4)),
        26: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)),
        24: BETWEEN[24]}
    POINTS[32], POINTS[71] = POINTS[26], POINTS[24]
    BOTTOM_SIDES_TOP[32] = BOTTOM_SIDES_TOP[26] + BETWEEN[32][9:]
    BOTTOM_SIDES_TOP[71] = BETWEEN[24] + ((0, 1, 2, 3),) + FACES

    def nodes(self, what, between):
        corners = self.POINTS[what]
        return corners + [tuple(sum(corners[c][a] for c in group) / len(group) for a in range(3))
                          for group in between[what]]

    def test_nastran(self):
        for what, name in ((25, "CHEXA"), (26, "CPENTA"), (24, "CTETRA")):
            nodes = self.nodes(what, self.BOTTOM_SIDES_TOP)
            lines = ["BEGIN BULK"] + [f"GRID,{i},,{x:.1f},{y:.1f},{z:.1f}"
                                      for i, (x, y, z) in enumerate(nodes, 1)]
            fields = ["7", "1"] + [str(i + 1) for i in range(len(nodes))]
            for at in range(0, len(fields), 8):
                lines.append(",".join([name if at == 0 else ""] + fields[at:at + 8]))
            path = self.folder / "one.bdf"
            path.write_text("\n".join(lines) + "\nENDDATA\n")
            self.check_middles(path, what)

    def test_abaqus(self):
        for what, name in ((25, "C3D20R"), (26, "C3D15"), (24, "C3D10")):
            nodes = self.nodes(what, BETWEEN)
            lines = ["*NODE"] + [f"{i}, {x}, {y}, {z}" for i, (x, y, z) in enumerate(nodes, 1)]
            numbers = ["7"] + [str(i + 1) for i in range(len(nodes))]
            lines += [f"*ELEMENT, TYPE={name}", ", ".join(numbers[:12]) + ",",
                      ", ".join(numbers[12:])]
            if not numbers[12:]:
                lines[-2:] = [lines[-2][:-1]]
            path = self.folder / "one.inp"
            path.write_text("\n".join(lines) + "\n")
            self.check_middles(path, what)

    @unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
    def test_exodus(self):
        for what, name in ((25, "HEX20"), (26, "WEDGE15"), (32, "WEDGE18"), (24, "TETRA10"),
                           (71, "TETRA15")):
            nodes = self.nodes(what, self.BOTTOM_SIDES_TOP)
            values = lambda axis: ", ".join(str(x[axis]) for x in nodes)
            (self.folder / "one.cdl").write_text(
                f"netcdf one {{ dimensions: num_dim = 3 ; num_nodes = {len(nodes)} ; num_elem = 1 ;"
                f"num_el_blk = 1 ; num_el_in_blk1 = 1 ; num_nod_per_el1 = {len(nodes)} ;\n"
                "variables: double coordx(num_nodes) ; double coordy(num_nodes) ;"
                "double coordz(num_nodes) ; int connect1(num_el_in_blk1, num_nod_per_el1) ;\n"
                f'connect1:elem_type = "{name}" ;\ndata: coordx = {values(0)} ;\n'
                f"coordy = {values(1)} ;\ncoordz = {values(2)} ;\n"
                f"connect1 = {', '.join(str(i + 1) for i in range(len(nodes)))} ; }}\n")
            path = self.folder / "one.exo"
            subprocess.run(["ncgen", "-o", path, self.folder / "one.cdl"], check=True, timeout=60)
            if "built without netCDF" in run(*MOVE, path, self.folder / "none.inp").stderr:
                self.skipTest("morph-mesh was built without netCDF")
            self.check_middles(path, what)


class Cgns(Files):
    def setUp(self):
        super().setUp()
        subprocess.run([SAMPLES, self.folder], check=True)
        if not (self.folder / "cube.cgns").exists():
            self.skipTest("the library of CGNS is not installed (libcgns-dev)")
        listed = run("--list-surfaces", self.folder / "cube.cgns")
        if "built without the library of CGNS" in listed.stderr:
            self.skipTest("morph-mesh was built without CGNS")

    @staticmethod
    def axis(points, nodes, code):
        return b"".join(struct.pack("<" + code, x) for x in [points[n] for n in nodes])

    def test_all_but_coordinates_is_kept(self):
        """Byte by byte, in two zones whose common nodes are one in the mesh; ADF has a date."""
        for name, code in (("cube.cgns", "d"), ("cube_adf.cgns", "d"), ("cube_single.cgns", "f")):
            with self.subTest(name=name):
                path, out = self.folder / name, self.folder / "out.cgns"
                if "adf" in name and "required for parallel" in run(*MOVE, path, out).stderr:
                    self.skipTest("this library of CGNS, made for MPI, writes no ADF")
                rounding = self.rounding(self.morph(path, out))
                exact = self.exact(path)
                self.assertEqual(len(exact) // 3, 64)
                rest = [[i % 4, i // 4 % 4, i // 16] for i in range(64)]
                content, expected = out.read_bytes(), path.read_bytes()
                for zone in (range(16, 64), range(32)):  # the longer one holds the other's numbers
                    for axis in range(3):
                        old = self.axis([float(x[axis]) for x in rest], zone, code)
                        self.assertEqual(expected.count(old), 1)
                        expected = expected.replace(old, self.axis(exact[axis::3], zone, code))
                self.assertEqual(len(content), len(expected))
                differing = [i for i, (a, b) in enumerate(zip(content, expected)) if a != b]
                if "adf" in name:
                    self.assertLess(max(differing, default=0), 186)  # the header
                else:
                    self.assertEqual(differing, [])
                self.assertEqual(rounding > 0, code == "f")
                self.assertLess(rounding, 3e-7)
                self.morph(path, path)
                self.assertEqual(path.read_bytes()[186:], content[186:])

    @unittest.skipUnless(shutil.which("cgnsdiff"), "cgnsdiff is not installed (cgns-convert)")
    def test_cgns_finds_no_other_difference(self):
        path, out = self.folder / "cube.cgns", self.folder / "out.cgns"
        self.morph(path, out)
        found = subprocess.run(["cgnsdiff", "-d", path, out], capture_output=True, text=True,
                               timeout=60).stdout.splitlines()
        self.assertEqual(len(found), 6)
        for line in found:
            self.assertRegex(line, "/GridCoordinates/Coordinate[XYZ] : data values differ")

    def test_displacements_of_any_step(self):
        """Solutions at vertices are the steps; the coordinates of both zones take one."""
        path, out = self.folder / "steps.cgns", self.folder / "out.cgns"
        rest = self.still(path)
        for step, words in ((1, ()), (0, ("--time-step", "0"))):
            self.morph(path, out, "--displacement-array", "Displacement", *words, "--validity",
                       "None", path)
            moved = self.still(out)
            for i in range(0, len(rest), 3):
                self.assertEqual(moved[i:i + 3], (rest[i] + 0.125 + step, rest[i + 1],
                                                  1.25 * rest[i + 2]))
        self.refuse("displacements of 2 time steps", "--displacement-array", "Displacement",
                    "--time-step", "2", path, path, out)

    def test_names(self):
        found = self.surfaces(self.folder / "cube.cgns")
        self.assertEqual(found["wall"], 9)  # of both zones
        self.assertEqual(found["faces"], 9)
        self.assertEqual(found["outflow"], 9)
        self.assertEqual(found["top"], 9)  # its family
        self.assertEqual(found["body"], 54)

    def test_second_order_elements(self):
        for name, what in (("hexa_20", 25), ("hexa_27", 29), ("penta_15", 26)):
            self.check_middles(self.folder / (name + ".cgns"), what)

    def test_what_is_refused(self):
        self.refuse("zone block is structured", "--list-surfaces", self.folder / "structured.cgns")
        self.refuse("base Plane is not three-dimensional", "--list-surfaces",
                    self.folder / "planar.cgns")
        for name in ("cube.cgns", "cube_adf.cgns"):
            path = self.folder / name
            content = path.read_bytes()
            for size in (len(content) // 2, 300):
                path.write_bytes(content[:size])
                self.refuse("Cannot read", "--list-surfaces", path)
                self.refuse("Cannot read", *MOVE, path, path)


if __name__ == "__main__":
    unittest.main()
