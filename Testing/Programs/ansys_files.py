# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on archives of Ansys, blocked and unblocked: no byte but coordinates is changed. No
program of Debian writes them, so they are typed by the layouts that CDWRITE documents.

Run: MORPH_MESH=<path of morph-mesh> python3 ansys_files.py
"""
import re
import unittest

import solver_files
from solver_files import run


class Ansys(solver_files.SolverFiles):
    BRICK, LID = (1, 2, 4, 3, 5, 6, 8, 7), (5, 6, 8, 7)

    def cdb(self, corners, elements, ints=9, real=(21, 13, 3), rest=""):
        """An archive by the layout that CDWRITE documents. Elements: type, nodes."""
        width, digits, exponent = real
        def number(x):
            mantissa, power = f"{x:.{digits}E}".split("E")
            return f"{mantissa}E{int(power):+0{exponent + 1}d}".rjust(width)
        integer = lambda values: "".join(f"{v:{ints}d}" for v in values)
        text = ("/COM, typed by the published layout\n/PREP7\nET,1,185\nET,2,SOLID186\n"
                f"ET,        3,181\nET,4,170\nNBLOCK,6,SOLID,{len(corners)},{len(corners)}\n"
                f"(3i{ints},6e{width}.{digits}e{exponent})\n")
        for i, corner in enumerate(corners):  # zeros at the end are left out
            while corner and corner[-1] == 0:
                corner = corner[:-1]
            text += integer((i + 1, 0, 0)) + "".join(map(number, corner)) + "\n"
        text += (f"N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,{len(elements)},{len(elements)}\n"
                 f"(19i{ints})\n")
        for i, (kind, nodes) in enumerate(elements):
            head = (kind, kind, 1, 1, 0, 0, 0, 0, len(nodes), 0, i + 11)
            text += integer((*head, *nodes[:8])) + "\n"
            text += integer(nodes[8:]) + "\n" if nodes[8:] else ""
        return text + f"{-1:{ints}d}\n{rest}MPDATA,EX,1,1, 2.1E11\nFINISH\n"

    def unblocked(self, corners, elements, label="R5.3", rest=""):
        """The same, with a command for each node and two or more for each element."""
        text = "/COM, typed\n/PREP7\nET,1,185\nET,2,186\nET,3,181\nET,4,170\n"
        for i, corner in enumerate(corners):
            values = ",".join(f"{x: .10E}" for x in corner)
            text += f"N,{label},LOC,{i + 1:8d},       0,       0,{values}\n"
            text += f"N,{label},ANG,{i + 1:8d},       0,       0, 0.0, 0.0, 0.0\n"
        text += f"N,{label},LOC,      -1,\n"
        for i, (kind, nodes) in enumerate(elements):
            numbers = (len(nodes), kind, kind, 1, 1, 0, i + 11, 0, 0, 0)
            text += f"EN,{label},ATTR," + ",".join(f"{n:8d}" for n in numbers) + "\n"
            for at in range(0, len(nodes), 8):
                text += f"EN,{label},NODE," + ",".join(f"{n:8d}" for n in nodes[at:at + 8]) + ",\n"
        return text + f"EN,{label},ATTR,      -1,\n{rest}FINISH\n"

    def test_archives_of_ansys(self):
        """Two widths of fields, components with ranges, elements that are left out; text stays."""
        path, out = self.folder / "m.cdb", self.folder / "out.cdb"
        brick, lid = (1, 2, 4, 3, 5, 6, 8, 7), (5, 6, 8, 7)
        rest = ("CMBLOCK,TOP     ,NODE,       2  ! users node component definition\n(8i10)\n"
                "         5        -8\nCMBLOCK,LID,ELEM,       1\n(8i10)\n        12\n"
                "CMBLOCK,PATCH,AREA,       1\n(8i10)\n        11\n")
        for options in ({}, {"ints": 8, "real": (16, 9, 2)}):
            with self.subTest(**options):
                path.write_text(self.cdb(self.CORNERS, ((1, brick), (3, lid), (4, lid)), rest=rest,
                                         **options))
                listed = run("--list-surfaces", path)
                self.assertIn("Elements of the type 170 are left out", listed.stderr)
                self.assertNotIn("PATCH", listed.stdout)
                for name, faces in (("Material 1", 6), ("TOP", 1), ("LID", 1)):
                    self.assertRegex(listed.stdout, f"(?m)^{name} +{faces} ")
                for name, move, rounding in (("LID", "0,0,0.25", 1e-13), ("TOP", "0.1,0,0", 1e-9)):
                    self.check_by_reading(path, out, "--move", name, "--translate", move,
                                          delta=rounding)
                    old, new = (file.read_text().splitlines() for file in (path, out))
                    self.assertEqual([i for i in range(len(old)) if old[i] != new[i]],
                                     [12, 13, 14, 15])

    def test_collapsed_hexahedra_of_ansys(self):
        """With their middle nodes, each halfway between two of its corners."""
        edges = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                 (2, 6), (3, 7))
        path = self.folder / "m.cdb"
        for nodes, faces in (((1, 2, 3, 3, 5, 5, 5, 5), 4), ((1, 2, 4, 3, 5, 5, 5, 5), 5),
                             ((1, 2, 3, 3, 5, 6, 7, 7), 5), ((1, 2, 4, 3, 5, 6, 8, 7), 6)):
            corners, places = list(self.CORNERS), {}
            for a, b in edges:
                ends = sorted((nodes[a], nodes[b]))
                if ends[0] != ends[1] and tuple(ends) not in places:
                    x, y = (self.CORNERS[n - 1] for n in ends)
                    corners.append(tuple((p + q) / 2 for p, q in zip(x, y)))
                    places[tuple(ends)] = len(corners)
            middles = tuple(places.get(tuple(sorted((nodes[a], nodes[b]))), nodes[a])
                            for a, b in edges)
            for kind, given in ((1, nodes), (2, nodes + middles)):
                path.write_text(self.cdb(corners, ((kind, given),)))
                still = run("--move", f"Material {kind}", "--translate", "1,0,0", path,
                            self.folder / "out.cdb")
                self.assertEqual(still.returncode, 0, still.stderr)
                self.assertRegex(still.stdout, r"inverted cells +0 +0\n")
                self.assertRegex(still.stdout, r"collapsed cells +0 +0\n")
                if kind == 1:
                    self.assertRegex(run("--list-surfaces", path).stdout, f"Material 1 +{faces} ")

    def test_archives_with_a_command_for_each_node(self):
        """As CDWRITE writes them unblocked, old and new, and as a user types them."""
        rest = ("CMBLOCK,TOP     ,NODE,       2\n(8i10)\n         5        -8\n")
        typed = ("/PREP7\nET,1,SOLID185\nMAT,1\nTYPE,1\n"
                 + "".join(f"n,{i + 1},{','.join(f'{x:g}' for x in c)} ! typed\n"
                           for i, c in enumerate(self.CORNERS))
                 + "EN,7," + ",".join(map(str, self.BRICK)) + "\n" + rest)
        elements = ((1, self.BRICK), (3, self.LID), (4, self.LID))
        path, out = self.folder / "m.cdb", self.folder / "out.cdb"
        for text in (self.unblocked(self.CORNERS, elements, rest=rest),
                     self.unblocked(self.CORNERS, elements, "UNBL", rest), typed):
            path.write_text(text)
            listed = run("list", path).stdout
            for name, faces in (("Material 1", 6), ("TOP", 1)):
                self.assertRegex(listed, f"(?m)^{name} +{faces} ")
            self.check_by_reading(path, out, "--move", "TOP", "--translate", "0.1,0,0.25")
            old, new = (file.read_text().splitlines() for file in (path, out))
            moved = [i for i in range(len(old)) if old[i] != new[i]]
            self.assertEqual(len(moved), 4)
            self.assertTrue(all(re.match("(?i)n,.*", old[i]) for i in moved))
            still = run("--move", "TOP", "--translate", "0,0,0", path, out)
            self.assertEqual((still.returncode, out.read_text()), (0, text), still.stderr)

    def test_short_commands_and_elements_of_twenty_nodes(self):
        """A coordinate that is left out is 0, and is written if it moves."""
        path, out = self.folder / "m.cdb", self.folder / "out.cdb"
        path.write_text("ET,1,185\nN,1\nN,2,1\nN,3,0,1\nN,4,0,0,1\nEN,1,1,2,3,3,4,4,4,4\n"
                        "CMBLOCK,ONE,NODE,1\n(8i10)\n         1\n")
        self.morph(path, out, "--move", "ONE", "--translate", "-0.5,0,0.25")
        self.assertEqual(out.read_text(), path.read_text().replace("N,1\n", "N,1,-0.5,0.,0.25\n"))

        edges = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                 (2, 6), (3, 7))
        corners = list(self.CORNERS)
        for a, b in edges:
            x, y = (self.CORNERS[self.BRICK[n] - 1] for n in (a, b))
            corners.append(tuple((p + q) / 2 for p, q in zip(x, y)))
        path.write_text(self.unblocked(corners, ((2, self.BRICK + tuple(range(9, 21))),)))
        self.check_by_reading(path, out, "--move", "Surface 0", "--translate", "0,0,0.01")

    def test_types_in_a_block_and_plane_elements(self):
        """ETBLOCK, as Workbench writes it, in place of ET; PLANE183 with one triangle."""
        path, out = self.folder / "m.cdb", self.folder / "out.cdb"
        square = [c for c in self.CORNERS if c[2] == 0] + [(2., 0., 0.)]
        for elements, name in ((((1, self.BRICK),), "Surface 5"),
                               (((2, (1, 2, 4, 3)), (2, (2, 5, 4, 4))), "Surface 0")):
            corners = square if len(elements) > 1 else self.CORNERS
            text = re.sub("ET,1,185.*?ET,4,170\n", "ETBLOCK,        2,        2\n(2i9,19a9)\n"
                          "        1      185\n        2      182\n       -1\n",
                          self.cdb(corners, elements), flags=re.S)
            path.write_text(text)
            self.check_by_reading(path, out, "--move", name, "--translate", "0.125,0.25,0")
        path.write_text(text.replace("        2      182\n", ""))
        self.refuse("element 11 is of type 2, which no ET or ETBLOCK defines", "list", path)

    def test_middle_nodes_that_are_left_out(self):
        """0 stands for them; those that are there go along with their edge."""
        path, out = self.folder / "m.cdb", self.folder / "out.cdb"
        corners = [*self.CORNERS, (0.5, 0., 0.)]
        nodes = self.BRICK + (9,) + (0,) * 11
        path.write_text(self.cdb(corners, ((2, nodes),)))
        points = self.check_by_reading(path, out, "--move", "Material 2", "--scale", "2,1,3")
        self.assertEqual(tuple(points[-3:]), (0.5, 0, -1))

    def test_damaged_archives_are_refused_with_their_line(self):
        cdb = self.cdb([(1., 0., 0.), (2., 0., 0.), (1., 1., 0.), (1., 0., 1.)],
                       [(1, (1, 2, 3, 4))])
        plain = self.unblocked(self.CORNERS, ((1, self.BRICK),))
        cases = (
            (cdb.replace("0E+000", "0E+xyz", 1), "line 9: .* is no number"),
            (cdb.replace("(3i9", "(3z9"), "line 8: the format of the block is missing"),
            (cdb.replace("        3        4\n", "        3       44\n"),
             "element 11 has the node 44"),
            (cdb.replace("        3        4\n", "        3\n"),
             "line 16: element 11 should have 4 nodes, and has 3"),
            (cdb[:cdb.index("       -1,") - 30], "line 12: .*is no|ends inside of NBLOCK"),
            ("/PREP7\n", "no nodes, in NBLOCK or in commands N"),
            (plain.replace("LOC,       2", "LOC,       1"), "more than one node .* 1"),
            (plain.replace(" 0.0000000000E+00", " x", 1), "line 7: 'x' is no number"),
            (plain.replace("      11", "      1x"), "line 24: .*is no"),
            (plain[:plain.index("EN,R5.3,NODE")], "line 24: element 11 lacks 8 of its nodes"),
            ("EN,R5.3,NODE,1,2\n", "line 1: nodes are given of no element"),
            ("CSYS,11\nN,1,1,0,0\n", "line 2: the node 1 is in the coordinate system 11"),
            ("N,1\nNGEN,2,8,1,8,1,1\n", "line 2: the command NGEN is not supported"))
        path = self.folder / "m.cdb"
        for text, message in cases:
            with self.subTest(message=message):
                path.write_text(text)
                self.refuse(message, "--move", "Surface 0", "--translate", "1,0,0", path,
                            self.folder / "out.cdb")


solver_files.forget_tests_of_superclass(Ansys)


if __name__ == "__main__":
    unittest.main()
