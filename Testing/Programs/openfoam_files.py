# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on cases of OpenFOAM: `points` is written again with moved points, and no other byte
is changed. OpenFOAM's own programs check and solve the morphed case where they are installed.

Run: MORPH_MESH=<path of morph-mesh> python3 openfoam_files.py
MORPH_TEST_SEED and MORPH_TEST_CASES as in solver_files.py.
"""
import gzip
import os
import re
import shutil
import struct
import subprocess
import unittest

import solver_files
import solver_models as models
from legacy_files import points_of, types_of
from solver_files import CASES, SEED, run


class OpenFoam(solver_files.SolverFiles):
    MOVE = ("--move", "wall", "--translate", "0.05,0.02,-0.03")

    def case(self, name="case", seed=SEED, **options):
        model, rng = models.random_model(f"foam {seed}", **options)
        return models.OpenFoam(model, rng), self.folder / name

    def exact(self, case):
        """The morphed coordinates of each point."""
        vtu = self.folder / "exact.vtk"
        self.morph(case, vtu, *self.MOVE)
        return points_of(vtu)

    def test_text_keeps_all_but_coordinates(self):
        for seed in range(SEED, SEED + CASES):
            with self.subTest(seed=seed):
                foam, case = self.case(f"case{seed}", seed,
                                       kind=("mixed", "tetrahedra", "hexahedra")[seed % 3])
                mesh = foam.write(case)
                exact = self.exact(case)
                others = {p: p.read_bytes() for p in mesh.iterdir() if p.name != "points"}
                old = models.coordinates_in(foam.pieces, (mesh / "points").read_bytes())
                out = case / "0.5" / "polyMesh" / "points"  # of a new time
                self.morph(case, out, *self.MOVE)
                found = models.coordinates_in(foam.pieces, out.read_bytes())
                values = [models.value(found[n, a]) for n in foam.model.order for a in range(3)]
                self.assertEqual(tuple(values), exact)
                self.assertNotEqual(old, found)
                self.morph(mesh / "points", mesh, *self.MOVE)  # in place, by other names
                self.assertEqual((mesh / "points").read_bytes(), out.read_bytes())
                self.assertEqual(others,
                                 {p: p.read_bytes() for p in mesh.iterdir() if p.name != "points"})
                # The time's points are read with the faces of constant/polyMesh.
                listed = run("--list-surfaces", out).stdout
                self.assertEqual(listed, run("--list-surfaces", mesh).stdout)
                self.assertRegex(listed, f"wall +{len(foam.model.wall)} ")

    def test_zones_of_cells_and_faces_are_read(self):
        foam, case = self.case(kind="hexahedra")
        mesh = foam.write(case)
        foam.write_zones(mesh, [0, 1, 2], [0])
        listed = run("list", case).stdout
        self.assertRegex(listed, r"(?m)^zone rotor: 3 cells$")
        self.assertRegex(listed, r"disk +1 +\S+ .*  inner")
        once, twice = self.folder / "once.vtk", self.folder / "twice.vtk"
        for out, way in ((once, "0.01,0,0"), (twice, "0.02,0,0")):
            result = run("--move", "wall", "--translate", way, "--fixed-zones", "rotor", case, out)
            self.assertEqual(result.returncode, 0, result.stderr)
        a, b = points_of(once), points_of(twice)
        place = {node: i for i, node in enumerate(foam.model.order)}
        held = {place[node] for _, nodes in foam.model.cells[:3] for node in nodes}
        for i in range(len(place)):
            if i in held:
                self.assertEqual(a[3 * i:3 * i + 3], b[3 * i:3 * i + 3])
        self.assertNotEqual(a, b)
        self.refuse("'rotr', which the mesh does not have; it has .*rotor.*Did you mean rotor",
                    "--move", "wall", "--translate", "1,0,0", "--rigid-zones", "rotr", case, once)
        foam.write_zones(mesh, [10 ** 6], [0])
        self.refuse("zone rotor of cellZones has the entry 1000000", "list", case)

    def test_binary_files_keep_all_but_coordinates(self):
        for label, scalar in ((4, 8), (8, 8), (4, 4)):
            with self.subTest(label=label, scalar=scalar):
                foam, case = self.case(f"binary{label}{scalar}")
                mesh, before, after = foam.write_binary(case, label, scalar)
                exact = self.exact(case)
                out = self.folder / "points"
                printed = self.morph(case, out, *self.MOVE)
                content = out.read_bytes()
                self.assertTrue(content.startswith(before) and content.endswith(after))
                numbers = content[len(before):-len(after)]
                code = "d" if scalar == 8 else "f"
                values = struct.unpack(f"<{len(numbers) // scalar}{code}", numbers)
                error = max(abs(a - b) for a, b in zip(values, exact))
                if scalar == 8:
                    self.assertEqual(values, exact)
                    self.assertNotIn("rounding", printed)
                else:
                    self.assertLess(error, 1e-6)
                    rounding = float(re.search("rounding of a coordinate: (.*)", printed)[1])
                    self.assertAlmostEqual(rounding / error, 1, delta=1e-3)
                out.unlink()

    def test_packed_files_and_regions(self):
        foam, case = self.case()
        region = case / "constant" / "fluid"
        mesh = foam.write(case).rename(region.parent / "polyMesh2")
        region.mkdir()
        mesh = mesh.rename(region / "polyMesh")
        for name in ("points", "faces", "owner"):
            (mesh / (name + ".gz")).write_bytes(gzip.compress((mesh / name).read_bytes()))
            (mesh / name).unlink()
        out = case / "0.1" / "fluid" / "polyMesh" / "points.gz"
        self.morph(region, out, *self.MOVE)
        models.coordinates_in(foam.pieces, gzip.decompress(out.read_bytes()))
        plain = self.folder / "points"
        self.morph(mesh / "points.gz", plain, *self.MOVE)
        self.assertEqual(plain.read_bytes(), gzip.decompress(out.read_bytes()))
        self.assertEqual(run("--list-surfaces", out).returncode, 0)
        (mesh / "points.gz").write_bytes(b"\x1f\x8b damaged")
        self.refuse("points.gz: it is damaged", "--list-surfaces", mesh)

    def test_point_displacement_of_a_case(self):
        """Uniform and nonuniform values, text and binary, in the order in which faces name points;
        a pattern of names; the patch that moves wins where one shares points with one that stays.
        """
        foam, case = self.case()
        foam.write(case)
        still = self.folder / "still.vtk"
        self.morph(case, still, "--move", "wall", "--translate", "0,0,0")
        rest = points_of(still)
        patches = {m[1]: foam.faces[int(m[3]):int(m[3]) + int(m[2])] for m in re.finditer(
            r"(\w+)\s*\{[^}]*nFaces (\d+);\s*startFace (\d+)", foam.boundary)}
        wall = list(dict.fromkeys(n for face in patches["wall"] for n in face))
        vectors = [(0.001 * i, 0, -0.002) for i in range(len(wall))]
        packed = b"".join(struct.pack("<3d", *v) for v in vectors)
        lists = " ".join("({} {} {})".format(*v) for v in vectors).encode()
        field, out = self.folder / "pointDisplacement", self.folder / "out.vtk"
        for style, kind, value, expected in (
                ("ascii", '"(wall|none)"', b"uniform (0 0.01 0)", [(0, 0.01, 0)] * len(wall)),
                ("ascii", "wall", b"nonuniform List<vector> %d (%b)" % (len(wall), lists), vectors),
                ("binary", "wall", b"nonuniform List<vector> %d(%b)" % (len(wall), packed),
                 vectors)):
            head = models.foam_header("pointVectorField", "pointDisplacement").replace(
                "ascii", style)
            field.write_bytes(head.encode() + b"dimensions [0 1 0 0 0 0 0];\n"
                              b"internalField uniform (0 0 0);\nboundaryField\n{\n inlet { type "
                              b"fixedValue; value uniform (0 0 0); }\n" + kind.encode() +
                              b" { a { b (1 2); } type fixedValue; value " + value +
                              b"; }\n outlet { type zeroGradient; }\n}\n")
            result = run("--displacements", field, "--validity", "None", case, out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("no fixedValue for the patches outlet (zeroGradient), sides.",
                          result.stderr)
            moved = points_of(out)
            for node, vector in zip(wall, expected):
                for axis in range(3):
                    self.assertAlmostEqual(moved[3 * node + axis] - rest[3 * node + axis],
                                           vector[axis], delta=1e-12)
        whole = field.read_bytes()
        for old, new, message in (
                (b"[0 1 0", b"[0 1 -1", "pointVectorField of lengths"),
                (b"pointVectorField", b"volVectorField", "of the class volVectorField"),
                (b"List<vector> %d(" % len(wall), b"List<vector> 1(", "is missing"),
                (b"uniform (0 0 0); }", b"$here; }", "'uniform' or 'nonuniform'")):
            field.write_bytes(whole.replace(old, new))
            self.refuse(message, "--displacements", field, case, self.folder / "x.vtk")
        field.write_bytes(whole.replace(packed, packed[:24]).replace(
            b"List<vector> %d(" % len(wall), b"List<vector> 1("))
        self.refuse("wall has %d points in the mesh, and 1 value" % len(wall), "--displacements",
                    field, case, self.folder / "x.vtk")

    def test_what_is_refused(self):
        foam, case = self.case()
        mesh = foam.write(case)
        whole = {p.name: p.read_text() for p in mesh.iterdir()}
        move = (*self.MOVE, case)
        self.refuse("called points or points.gz", *move, self.folder / "out.foam2")
        self.refuse("lies beside it", *move, mesh / "points.gz")
        self.refuse("there is no mesh in it as in .*case", *move, self.folder)
        cases = (
            ("points", lambda s: s.replace("(\n(", "(\n(nan ", 1), "point 0 .*'nan"),
            ("points", lambda s: s[:-400], "it ends too soon|is no number|missing"),
            ("points", lambda s: re.sub(r"\n(\d+)\n\(", r"\n99999\n(", s, 1), "is too short"),
            ("points", lambda s: s.replace("FoamFile", "File"), "no header FoamFile"),
            ("owner", lambda s: s.replace("\n0\n", "\n-7\n", 1), "cell -7"),
            ("owner", lambda s: s.replace("\n0\n", "\n99999999\n", 1), "cell 99999999"),
            ("faces", lambda s: re.sub(r"4\((\d+)", "4(9999", s, 1), "the point 9999"),
            ("boundary", lambda s: s.replace("startFace ", "startFace 9", 1), "patch wall"),
            ("boundary", lambda s: re.sub(r"type +\w+", "type processor", s, 1),
             "piece of a decomposed case .*patch wall .*Give the folder of the case"),
            ("boundary", lambda s: re.sub(r"type +\w+", "type processorCyclic", s, 1),
             "piece of a decomposed case"),
            ("neighbour", lambda s: s.replace("\n(\n", "\n(\nx", 1), "whole number is missing"))
        for name, damage, message in cases:
            with self.subTest(name=name, message=message):
                (mesh / name).write_text(damage(whole[name]))
                self.assertNotEqual((mesh / name).read_text(), whole[name])
                self.refuse(message, "--list-surfaces", case)
                (mesh / name).write_text(whole[name])

    def test_polyhedra(self):
        """Two hexahedra side by side, as one cell of ten faces."""
        foam, case = self.case(kind="hexahedra")
        mesh = foam.write(case)
        inner = len(foam.neighbour)
        first, second = foam.owner[0], foam.neighbour[0]

        def joined(cell):
            return first if cell == second else cell - (cell > second)

        foam.owner = [joined(cell) for cell in foam.owner[1:]]
        foam.neighbour = [joined(cell) for cell in foam.neighbour[1:]]
        foam.faces = foam.faces[1:]
        foam.boundary = re.sub(r"startFace (\d+)",
                               lambda m: f"startFace {int(m[1]) - 1}", foam.boundary)
        self.assertEqual(len(foam.neighbour), inner - 1)
        shutil.rmtree(case)
        mesh = foam.write(case)
        others = {p: p.read_bytes() for p in mesh.iterdir() if p.name != "points"}
        grid = self.folder / "grid.vtk"
        self.morph(case, grid, *self.MOVE)
        self.assertIn(42, types_of(grid))
        exact = self.exact(case)
        self.morph(case, mesh, *self.MOVE)
        found = models.coordinates_in(foam.pieces, (mesh / "points").read_bytes())
        values = [models.value(found[n, a]) for n in foam.model.order for a in range(3)]
        self.assertEqual(tuple(values), exact)
        self.assertEqual(others,
                         {p: p.read_bytes() for p in mesh.iterdir() if p.name != "points"})

    @unittest.skipUnless(shutil.which("checkMesh"), "OpenFOAM is not installed (openfoam)")
    def test_check_mesh_passes_what_it_passed(self):
        foam, case = self.case(kind="mixed", sizes=(4, 5, 6))
        mesh = foam.write(case)
        self.write_system(case)
        self.assertEqual(self.failed_checks(case), 0)
        for _ in range(2):
            self.morph(case, mesh, "--move", "wall", "--translate", "0.05,0.02,-0.03",
                       "--validity", "Refuse")
            self.assertEqual(self.failed_checks(case), 0)

    @unittest.skipUnless(shutil.which("laplacianFoam"), "OpenFOAM is not installed (openfoam)")
    def test_laplacian_foam_solves_the_morphed_case(self):
        """A temperature that is z on the boundary is nearly z inside. checkMesh prints the volume
        that the coordinates in the .vtk of the same morph have, by the divergence theorem."""
        foam, case = self.case(kind="mixed", sizes=(4, 5, 6))
        mesh = foam.write(case)
        self.write_system(case)
        move = ("--move", "wall", "--translate", "0.2,0.1,-0.3", "--validity", "Refuse")
        vtk = self.folder / "exact.vtk"
        self.morph(case, vtk, *move)
        values = points_of(vtk)
        points = [values[i:i + 3] for i in range(0, len(values), 3)]
        z = values[2::3]
        self.morph(case, mesh, *move)
        start = len(foam.neighbour)
        volume = sum(self.cone([points[n] for n in face]) for face in foam.faces[start:])
        printed = re.search(r"Total volume = ([\d.e+-]+)\.", self.openfoam("checkMesh", case))[1]
        self.assertAlmostEqual(float(printed) / volume, 1, delta=1e-6)
        patches = re.findall(r"(\w+)\s*\{[^}]*nFaces (\d+);\s*startFace (\d+)", foam.boundary)
        self.assertEqual(sum(int(count) for _, count, _ in patches), len(foam.faces) - start)
        fields = []
        for name, count, first in patches:
            faces = foam.faces[int(first):int(first) + int(count)]
            values = " ".join(repr(sum(z[n] for n in face) / len(face)) for face in faces)
            fields.append(f"{name} {{ type fixedValue; value nonuniform List<scalar> {count} "
                          f"({values}); }}\n")
        (case / "0").mkdir()
        (case / "0" / "T").write_text(
            models.foam_header("volScalarField", "T") + "dimensions [0 0 0 1 0 0 0];\n"
            f"internalField uniform 0;\nboundaryField {{ {''.join(fields)} }}\n")
        (case / "constant" / "transportProperties").write_text(
            models.foam_header("dictionary", "transportProperties") + "DT [0 2 -1 0 0 0 0] 1;\n")
        self.assertIn("\nEnd\n", self.openfoam("laplacianFoam", case))
        text = (case / "1" / "T").read_text()
        found = re.search(r"internalField\s+nonuniform List<scalar>\s+(\d+)\s*\(([^)]*)\)", text)
        nodes = [set() for _ in range(int(found[1]))]
        for f, face in enumerate(foam.faces):
            for cell in [foam.owner[f]] + foam.neighbour[f:f + 1]:
                nodes[cell].update(face)
        errors = [abs(float(value) - sum(z[n] for n in cell) / len(cell))
                  for value, cell in zip(found[2].split(), nodes)]
        self.assertLess(max(errors), 0.1)

    @staticmethod
    def cone(corners):
        """The volume between a face, in triangles at its mean, and the origin."""
        middle = [sum(x) / len(corners) for x in zip(*corners)]
        total = 0
        for (ax, ay, az), (bx, by, bz) in zip(corners, corners[1:] + corners[:1]):
            total += (middle[0] * (ay * bz - az * by) + middle[1] * (az * bx - ax * bz) +
                      middle[2] * (ax * by - ay * bx)) / 6
        return total

    @staticmethod
    def write_system(case):
        (case / "system").mkdir()
        for name, entries in (
                ("controlDict", "application x; startFrom startTime; startTime 0; stopAt endTime; "
                                "endTime 1; deltaT 1; writeControl timeStep; writeInterval 1; "
                                "writeFormat ascii; writePrecision 12;"),
                ("fvSchemes", "ddtSchemes { default steadyState; } divSchemes {} "
                              "gradSchemes { default Gauss linear; } "
                              "laplacianSchemes { default Gauss linear corrected; } "
                              "interpolationSchemes { default linear; } "
                              "snGradSchemes { default corrected; }"),
                ("fvSolution", "solvers { T { solver PCG; preconditioner DIC; tolerance 1e-10; "
                               "relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 10; }")):
            (case / "system" / name).write_text(models.foam_header("dictionary", name) + entries)

    @staticmethod
    def openfoam(program, case, *options):
        environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}  # where Debian has it
        result = subprocess.run([program, "-case", case, *options], capture_output=True, text=True,
                                timeout=120, env=environment)
        return result.stdout + result.stderr

    def failed_checks(self, case):
        output = self.openfoam("checkMesh", case)
        self.assertIn("Checking geometry", output)
        match = re.search(r"Failed (\d+) mesh checks", output)
        if not match:
            self.assertIn("Mesh OK", output)
        return int(match[1]) if match else 0


solver_files.forget_tests_of_superclass(OpenFoam)


if __name__ == "__main__":
    unittest.main()
