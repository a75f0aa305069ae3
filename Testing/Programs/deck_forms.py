# SPDX-License-Identifier: BSD-3-Clause
"""Forms of decks and tables that engineers and their programs write: labels, blanks, tabs, titles,
sets and elements by the published card layouts. Each is read, and a motion of zero keeps its bytes.

Run: MORPH_MESH=<path of morph-mesh> python3 deck_forms.py
"""
import re
import unittest

import solver_files
import solver_models
import vtk_pieces
from solver_files import run


class DeckForms(solver_files.SolverFiles):
    TOP = "*NSET, NSET=%s\n5, 6, 7, 8\n"

    def listed(self, path):
        """The rows of surfaces: name, then faces, area and center as text."""
        result = run("list", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return dict(re.findall(r"(?m)^(.+?)  +(\d+ +\S+  .*)$", result.stdout)), result.stderr

    def check(self, name, text, rows, moved="Top"):
        """The surfaces of the file; what moves, moves. Returns what it says."""
        path, out = self.folder / name, self.folder / ("out-" + name)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        found, said = self.listed(path)
        for surface, row in rows.items():
            self.assertRegex(found.get(surface, f"not among {list(found)}"), f"^{row}$", surface)
        still = run("--move", moved, "--translate", "0,0,0", path, out)
        self.assertEqual((still.returncode, out.read_bytes()), (0, path.read_bytes()), still.stderr)
        self.assertEqual(run("--move", moved, "--translate", "0.25,0,0.5", path, out).returncode, 0)
        before, after = (self.center(rows[0][moved]) for rows in (self.listed(path),
                                                                  self.listed(out)))
        for a, b, by in zip(before, after, (0.25, 0, 0.5)):
            self.assertAlmostEqual(a + by, b, 5)
        return said

    @staticmethod
    def center(row):
        return [float(x) for x in re.search(r"(\S+), (\S+), (\S+)", row).groups()]

    LID = r"1 +1  0\.5, 0\.5, 1"

    def test_labels_in_quotes(self):
        part = ('*PART, NAME="A part"\n' + self.CUBE + self.BRICK + self.TOP % '"The top"'
                + "*END PART\n")
        text = (part + '*INSTANCE, NAME="A part-1", PART="a part"\n*END INSTANCE\n'
                '*NSET, NSET=Top\n"A part-1"."The top"\n*NSET, NSET=Again\n"A part-1.The top",\n')
        said = self.check("m.inp", text, {name: self.LID for name in ("Top", "Again",
                                                                      "A part-1.The top")})
        self.assertEqual(said, "")

    def test_a_set_of_nodes_and_of_elements_behind_them_is_a_face(self):
        """As CAE writes the set of a picked face: its other sides do not move."""
        self.check("m.inp", self.CUBE + self.BRICK + self.TOP % "Top" + "*ELSET, ELSET=Top\n1\n",
                   {"Top": self.LID, "Solid": "6 .*"})

    def test_sides_of_plane_elements_and_of_shells_are_edges(self):
        nodes = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n"
        middles = "5, .5, 0.\n6, 1., .5\n7, .5, 1.\n8, 0., .5\n"
        right = r"[12] +1  1, 0\.5, 0"
        for kind, more, side in (("CPS4R", "", "S2"), ("CAX8", middles, "S2"), ("S4", "", "E2"),
                                 ("S8R", middles, "E2"), ("S4R", "", "S4")):
            with self.subTest(kind=kind, side=side):
                ids = ", ".join(str(n + 1) for n in range(8 if more else 4))
                self.check("m.inp", f"{nodes}{more}*ELEMENT, TYPE={kind}\n1, {ids}\n"
                           f"*SURFACE, NAME=Right\n1, {side}\n", {"Right": right}, "Right")

    def test_a_side_and_a_node_that_are_not_there_are_named(self):
        said = self.check("m.inp", self.CUBE + self.BRICK + self.TOP % "Top" +
                          "*NSET, NSET=Top\n77\n*SURFACE, NAME=Wrong\nSolid, S7\n",
                          {"Top": self.LID})
        self.assertIn("'Top' names nodes that the file does not define: numbers 77.", said)
        self.assertIn("'Wrong' names the side S7 of element 1, which has no such side", said)

    GRIDS = "".join(f"GRID,{i + 1},,{i & 1}.,{i >> 1 & 1}.,{i >> 2}.\n" for i in range(8))
    NASTRAN = GRIDS + "CHEXA,1,1,1,2,4,3,5,6,\n,8,7\nCQUAD4,2,9,5,6,8,7\n"

    def test_a_set_of_nodes_and_elements_inside_is_an_inner_surface(self):
        """As CAE writes the picked face between two cells."""
        nodes = "".join(f"{i + 1}, {i % 3}, {i // 3 % 3}, {i // 9 * 2}\n" for i in range(27))
        corners = [n + a for n in (1, 2, 4, 5, 10, 11, 13, 14) for a in (0, 1, 4, 3, 9, 10, 13, 12)]
        cells = "".join(f"{i + 1}, {', '.join(map(str, corners[8 * i:8 * i + 8]))}\n"
                        for i in range(8))
        text = ("*NODE\n" + nodes + "*ELEMENT, TYPE=C3D8\n" + cells +
                "*NSET, NSET=Top, GENERATE\n10, 18, 1\n*ELSET, ELSET=Top\n1, 2, 3, 4\n")
        self.check("m.inp", text, {"Top": "4 +4  1, 1, 2 +inner"})

    def test_what_defines_entries_by_others_is_named(self):
        """And elements of any number of nodes; a deck that CalculiX's preprocessor calls .msh."""
        path = self.folder / "m.bdf"
        path.write_text("GRID,1,,0.,0.,0.\n=,*1,=,*1.,==\n=3\n")
        self.refuse("line 2: it has a replication", "list", path)
        said = self.check("m.msh", self.CUBE + self.BRICK + "*ELEMENT, TYPE=C3D15V\n" + ", ".join(
            map(str, range(2, 18))) + "\n18, 19, 20\n" + self.TOP % "Top", {"Top": self.LID})
        self.assertIn("Elements of the type 'C3D15V' are left out", said)

    def test_parameters_of_abaqus_matter_where_nodes_have_them(self):
        parameters = "*PARAMETER\nthickness = 0.5\nhigh = 1.\n"
        text = self.CUBE + self.BRICK + self.TOP % "Top"
        self.check("m.inp", parameters + text, {"Top": self.LID})
        path = self.folder / "m.inp"
        path.write_text(parameters + text.replace("1., 1., 1.", "1., 1., <high>"))
        self.refuse("line 12: '<high>' is no number", "list", path)

    def test_byte_order_marks(self):
        mark, node = b"\xef\xbb\xbf", "%8d%16.3f%16.3f%16.3f\n"
        dyna = ("*KEYWORD\n*NODE\n" + "".join(node % (i + 1, i & 1, i >> 1 & 1, i >> 2)
                                               for i in range(8)) +
                "*ELEMENT_SOLID\n1,7,1,2,4,3,5,6,8,7\n*SET_NODE_LIST_TITLE\nTop\n1\n5,6,7,8\n")
        inp = "*HEADING\n" + self.CUBE + self.BRICK + self.TOP % "Top"
        for name, text, top in (("m.inp", inp, "Top"), ("m.k", dyna, "Top"),
                                ("m.bdf", self.NASTRAN, "PID 9")):
            self.check(name, mark + text.encode(), {top: self.LID}, top)
        path = self.folder / "m.inp"
        path.write_text((self.CUBE + self.BRICK).replace("\n", "\r"), newline="")
        self.refuse("lines end with carriage returns alone. Convert them", "list", path)

    def test_tabs_of_nastran(self):
        """Each goes on to the next field. A coordinate keeps its columns, and its text if it
        stays."""
        text = self.NASTRAN.replace(",", "\t").replace("5\t6\t\n\t8", "5\t6\n\t8")
        self.check("m.bdf", text, {"PID 9": self.LID}, "PID 9")
        out = (self.folder / "out-m.bdf").read_text().splitlines()
        self.assertEqual(out[:4], text.splitlines()[:4])
        self.assertEqual(out[4], "GRID\t5\t\t.25000000.\t1.500000")
        large = "".join(f"GRID*\t{i + 1}\t\t\t\t{i & 1}.\t\t{i >> 1 & 1}.\n*\t{i >> 2}.\n"
                        for i in range(8))
        self.check("m.bdf", text.replace(self.GRIDS.replace(",", "\t"), large),
                   {"PID 9": self.LID}, "PID 9")

    def test_what_a_deck_of_nastran_says_beside_its_fields(self):
        """A late comment, notes beyond column 80, elements of other types; axisymmetric ones."""
        grids = "".join(f"GRID    {i + 1:<16d}{i & 1:<8.1f}{i >> 1 & 1:<8.1f}{i >> 2:<8.1f}"
                        .ljust(80) + "as measured, twice\n" for i in range(8))
        said = self.check("m.bdf", grids + "$ was after BEGIN BULK\n" +
                          self.NASTRAN.replace(self.GRIDS, "") + "CTRIAX6,5,9,1,2,3,4,5,6\n",
                          {"PID 9": self.LID}, "PID 9")
        self.assertIn("Elements of the type 'CTRIAX6' are left out of the mesh", said)
        self.check("m.bdf", self.GRIDS + "CQUADX4,1,9,5,6,8,7\nPLOTEL,2,6,8\n",
                   {"Surface 1": r"1 +1  .*"}, "Surface 1")

    def test_middle_nodes_that_are_left_out(self):
        """The others go along with their edge, and zeros stand for blanks."""
        grids = self.GRIDS + "GRID,9,,0.5,0.,0.\nGRID,10,,0.,0.5,1.\n"
        for fields in ("," * 11, ",".join("0" * 12), "9,,,,,,,,,,,10", "9,,,,,0,0,,,,,10"):
            with self.subTest(fields=fields):
                brick = "CHEXA,1,1,1,2,4,3,5,6,8,7," + fields
                path, out = self.folder / "m.bdf", self.folder / "out.bdf"
                path.write_text(grids + brick + "\nCQUAD4,2,9,5,6,8,7\n")
                result = run("--move", "PID 1", "--scale", "2,1,3", path, out)
                self.assertEqual(result.returncode, 0, result.stderr)
                lines = out.read_text().splitlines()
                here, there = fields.startswith("9"), fields.endswith("10")
                self.assertEqual("GRID,9,,0.5,0.,-1." in lines, here)
                self.assertEqual("GRID,10,,-0.5,0.5,2." in lines, there)
        path.write_text(grids + "CHEXA,1,1,1,2,,3,5,6,8,7,9\n")
        self.refuse("line 11: CHEXA 1 lacks its corner 3", "list", path)

    def dyna(self, rest="", width=8, head="*KEYWORD", keyword="", real=16):
        number = lambda *values: "".join(f"{v:{width}d}" for v in values)
        return (f"{head}\n*NODE{keyword}\n" + "".join(
            number(i + 1) + f"{i & 1:{real}.3f}{i >> 1 & 1:{real}.3f}{i >> 2:{real}.3f}{0:8d}\n"
            for i in range(8)) + f"   \n*ELEMENT_SOLID{keyword}\n" +
            number(1, 7, 1, 2, 4, 3, 5, 6, 8, 7) + "\n" + rest)

    def test_fields_of_other_widths_of_ls_dyna(self):
        top = "*SET_NODE_LIST_TITLE\nTop\n         1\n         5         6         7         8\n"
        for options in ({}, {"head": "*KEYWORD I10=Y", "width": 10},
                        {"keyword": " %", "width": 10}, {"keyword": "+", "width": 20, "real": 20},
                        {"keyword": " +", "width": 20, "real": 20}):
            self.check("m.k", self.dyna(top, **options), {"Top": self.LID})

    def test_titles_of_ls_dyna(self):
        """Empty ones, and those of several; a line without content counts where one belongs."""
        text = self.dyna("*ELEMENT_SHELL_THICKNESS\n1,8,5,6,8,7\n\n2,9,1,2,4,3\n\n"
                         "*PART\n\n7,1,1\nlid\n8,1,1\nlid\n9,1,1\n"
                         "*SET_NODE_LIST_TITLE\n\n1\n5,6,7,8\n"
                         "*SET_NODE_LIST_TITLE\nlid\n2\n5,6,7,8\n")
        bottom = r"1 +1  0\.5, 0\.5, 0"
        self.check("m.k", text, {"PID 7": "6 .*", "lid (PID 8)": self.LID, "lid (PID 9)": bottom,
                                 "Node set 1": self.LID, "lid (Node set 2)": self.LID},
                   "Node set 1")

    def test_the_end_of_an_included_file_of_ls_dyna(self):
        (self.folder / "nodes.k").write_text(self.dyna().split("   \n")[0] + "*END\nno deck\n")
        (self.folder / "m.k").write_text("*KEYWORD\n*INCLUDE\nnodes.k\n" +
                                         self.dyna().split("   \n")[1] + "*END\nno deck\n")
        self.assertRegex(self.listed(self.folder / "m.k")[0]["PID 7"], "^6 ")

    def test_what_partitions_of_su2_exchange(self):
        text = ("NDIME= 3\nNELEM= 1\n12 0 1 3 2 4 5 7 6\nNPOIN= 8\n" +
                "".join(f"{i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)) +
                "NMARK= 2\nMARKER_TAG= Top\nMARKER_ELEMS= 1\n9 4 5 7 6\n"
                "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 1\nSEND_TO= 1\n1 0 0\n")
        self.check("m.su2", text, {"Top": self.LID})

    def test_the_first_version_of_gmsh_is_refused_with_a_way(self):
        path = self.folder / "m.msh"
        path.write_text("$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n")
        self.refuse("Let Gmsh write version 4.1 or 2.2", "list", path)

    def test_named_blocks_of_vtm(self):
        """Each is a name, and so is the interface of two."""
        model, _ = solver_models.random_model("blocks")
        path, out = (self.folder / name / "m.vtm" for name in ("in", "out"))
        for folder in (path.parent, out.parent):
            folder.mkdir()
        vtk_pieces.write(model, path, ("low", "high"))
        rows, said = self.listed(path)
        self.assertEqual(said, "")
        for name in ("low", "high", "low | high"):
            self.assertRegex(rows.get(name, f"not among {list(rows)}"), "^[1-9]", name)
        moved = run("--move", "low | high", "--translate", "0,0,0.01", path, out)
        self.assertEqual(moved.returncode, 0, moved.stderr)
        shift = [b - a for a, b in zip(*(self.center(self.listed(file)[0]["low | high"])
                                         for file in (path, out)))]
        self.assertAlmostEqual(shift[2], 0.01, 4)

    def test_tables_of_excel(self):
        """A line that names the separator, and lines of an old Macintosh; encodings and nodes that
        contradict each other are refused."""
        path, table, out = (self.folder / name for name in ("m.inp", "t.csv", "out.inp"))
        path.write_text(self.CUBE + self.BRICK)
        rows = "id;dx;dy;dz\n" + "".join(f"{n};0;0;0,5\n" for n in (5, 6, 7, 8, 8))
        results = set()
        for text in (rows, "sep=;\n" + rows, rows.replace("\n", "\r")):
            table.write_bytes(text.encode())
            result = run("--displacements", table, "--node-numbers", path, out)
            self.assertEqual(result.returncode, 0, result.stderr)
            results.add(out.read_text())
        self.assertEqual(len(results), 1)
        for content, message in ((rows.encode("utf-16"), "t.csv: it is no text in UTF-8. Save it"),
                                 (rows.encode() + b"5;0;0;1\n", "line 7: the node 5 has another "
                                  "displacement than in .*line 2")):
            table.write_bytes(content)
            self.refuse(message, "--displacements", table, "--node-numbers", path, out)


solver_files.forget_tests_of_superclass(DeckForms)


if __name__ == "__main__":
    unittest.main()
