#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The figures in the tables of the pages are those of the data files, rounded as the pages show.
The version is the same everywhere."""
import csv
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Testing/Benchmark"))
import performance_page  # noqa: E402  (needs the path above)

STUDY = ROOT / "Documentation/Study"
RESULTS = ROOT / "Testing/Benchmark/results"


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def table(page, heading):
    """The rows of the table below the heading, or of the table whose first cell it is."""
    text = (ROOT / "Documentation" / page).read_text(encoding="utf-8")
    start = text.index(heading)
    lines = re.search(r"(?:^\|.*\n)+", text[start:], re.MULTILINE)[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


class Version(unittest.TestCase):
    def test_it_is_that_of_cmake_wherever_it_has_to_stand(self):
        version = re.search(r"^project\(MeshMorphing VERSION ([\d.]+)",
                            (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)[1]
        for path, line in (("CHANGELOG.md", f"## {version}\n"),
                           ("debian/changelog", f"meshmorphing ({version}) ")):
            text = (ROOT / path).read_text(encoding="utf-8")
            found = re.search(r"^(## |meshmorphing \()", text, re.MULTILINE).start()
            self.assertTrue(text[found:].startswith(line), path)


class Figures(unittest.TestCase):
    def check(self, shown, value):
        """What a page shows, such as 0.30 s or 1,320, is this value."""
        number = re.search(r"-?[\d,]+(?:\.(\d+))?", shown)
        self.assertIsNotNone(number, shown)
        digits = len(number[1] or "")
        self.assertLessEqual(abs(float(number[0].replace(",", "")) - float(value)),
                             0.5001 * 10 ** -digits, f"the page has {shown}, the data {value}")

    def check_table(self, found, data, key, columns):
        """Each row of the page has its row in the data; columns: of the data, one a column."""
        self.assertGreater(len(found), 1)
        for cells in found:
            row = next(r for r in data if key(cells) == tuple(r[k] for k in columns[0]))
            for shown, column in zip(cells[len(cells) - len(columns) + 1:], columns[1:]):
                if shown or row[column] not in ("", "0.00"):
                    with self.subTest(row=cells[0], column=column):
                        self.check(shown, row[column])

    def test_minima_by_method(self):
        data = {(r["model"], r["kind"], r["method"]): r for r in rows(STUDY / "results.csv")
                if (r["surfaces"], r["stepping"], float(r["t"])) == ("exact", "absolute", 1)}
        for kind, heading in (("hex", "| hexahedra"), ("tet", "| tetrahedra")):
            found = table("WhichMethod.md", heading)
            self.assertEqual(len(found), 8)
            for method, *cells in found:
                for model, shown in zip(("bore", "pipe", "canister", "courier"), cells):
                    with self.subTest(method=method, model=model, kind=kind):
                        row = data[model, kind, method]
                        self.assertEqual(shown[0] == "(", int(row["inverted"]) > 0)
                        self.check(shown, row["inverted" if shown[0] == "(" else "minimum"])

    def test_seconds_by_method(self):
        data = {(r["model"], r["kind"], r["method"]): r for r in rows(STUDY / "timing.csv")
                if r["stepping"] == "absolute"}
        found = table("WhatToExpect.md", "## By method")
        self.assertEqual(len(found), 8)
        for method, *cells in found:
            for number, (model, kind) in enumerate((("bore", "hex"), ("canister", "hex"),
                                                    ("courier", "tet"))):
                row = data[model, kind, method]
                with self.subTest(method=method, model=model):
                    self.check(cells[2 * number], row["prepare"])
                    self.check(cells[2 * number + 1], row["evaluate"])

    def test_claims_of_the_study(self):
        """Ratios of seconds, and meshes with inverted cells, that sentences of the page have."""
        page = " ".join((ROOT / "Documentation/Study.md").read_text("utf-8").split())
        data = {(r["model"], r["kind"], r["method"]): r for r in rows(STUDY / "timing.csv")
                if r["stepping"] == "absolute"}
        pairs = [(row, data[model, kind, "Simplex-linear"])
                 for (model, kind, method), row in data.items() if method in ("FEMWARP", "LBWARP")]
        faster = [float(one["evaluate"]) / float(ours["evaluate"]) for one, ours in pairs]
        longer = [float(ours["prepare"]) / float(one["prepare"]) for one, ours in pairs]
        ratios = (f"{min(faster):.0f} to {max(faster):.0f} times faster than FEMWARP and LBWARP; "
                  f"preparing takes {min(longer):.1f} to {max(longer):.0f} times as long")
        self.assertIn(ratios, page)
        canister = data["canister", "hex", "FEMWARP"]
        self.assertIn(f"takes {float(canister['evaluate']):.2f} s for an absolute step after "
                      f"{float(canister['prepare']):.2f} s to prepare", page)
        steps = [(r["surfaces"], int(r["inverted"]),
                  int(r["boundary"]) + int(r["folded"]))
                 for r in rows(STUDY / "results.csv")
                 if r["method"] == "Inversion-free" and 0 < float(r["t"]) < 1.0001]
        exact = [inverted for surfaces, inverted, _ in steps if surfaces == "exact"]
        self.assertIn(f"has no inverted cell in all {len(exact)} meshes", page)
        self.assertEqual(max(exact), 0)
        others = [(inverted, boundary) for surfaces, inverted, boundary in steps
                  if surfaces != "exact" and inverted > 0]
        own = sum(inverted > boundary for inverted, boundary in others)
        self.assertIn(f"{len(others)} of another {len(steps) - len(exact)} meshes have inverted "
                      f"cells. In {own} of these some are the method's own", page)

    def test_optimizers(self):
        data = {(r["mesh"], r["program"]): r
                for r in rows(ROOT / "Testing/Benchmark/results/optimizers.csv")}
        found = table("Methods.md", "| mesh | inverted at first")
        names = ("par_untangle_original_hex_mesh", "mixed-hex-pyr-tet", "tire", "twist", "bore_hex")
        self.assertEqual(len(found), len(names))
        for name, (_, before, ours, theirs) in zip(names, found):
            self.check(before, data[name, "start"]["inverted"])
            for shown, program in ((ours, "Default"), (theirs, "MFEM")):
                row = data[name, program]
                values = ([row["inverted"]] if int(row["inverted"])
                          else [row["minimum"], row["mean"]])
                numbers = re.findall(r"[\d.]+", shown)
                with self.subTest(mesh=name, program=program):
                    self.assertEqual(len(numbers), len(values))
                    for number, value in zip(numbers, values):
                        self.check(number, value)

    def test_performance(self):
        text = performance_page.PAGE.read_text(encoding="utf-8")
        self.assertEqual(text[text.index(performance_page.START):],
                         performance_page.tables(rows(performance_page.DATA)))

    def test_shapes_of_cells(self):
        self.check_table(table("WhatToExpect.md", "## By the shape of cells"),
                         rows(RESULTS / "boxes.csv"), lambda cells: (cells[0],),
                         [("cells",), "median_ratio", "worst_ratio", "median_iterations",
                          "most_iterations"])

    def test_dragging(self):
        self.check_table(table("WhatToExpect.md", "## While dragging"),
                         rows(RESULTS / "dragging.csv"),
                         lambda cells: (cells[0].replace(",", ""), cells[1]),
                         [("nodes", "dragged"), "picture_ms", "floor_ms"])

    def test_sentences(self):
        text = " ".join((ROOT / "Documentation/WhatToExpect.md").read_text("utf-8").split())
        whole, = rows(RESULTS / "whole-program.csv")
        self.assertIn(f"{int(whole['nodes']):,} nodes in {whole['seconds']} s, with "
                      f"{whole['memory_GB']} GB", text)
        shown = rows(RESULTS / "surface.csv")[0]
        self.assertIn(f"takes {shown['mesh_picture_ms']} ms to the picture, and "
                      f"{shown['surface_picture_ms']} ms with the surface", text)

    def test_gallery(self):
        self.check_table(table("Gallery.md", "## In figures"), rows(STUDY / "gallery.csv"),
                         lambda cells: tuple(cells[:2]),
                         [("script", "method"), "cells", "minimum_before", "minimum_after",
                          "seconds"])

    def test_no_two_pages_show_the_same_picture(self):
        shown = {}
        for page in [ROOT / "README.md", *sorted((ROOT / "Documentation").rglob("*.md"))]:
            if page.name == "Results.md":
                continue  # the list of all figures of the study
            for link in re.findall(r"!\[.*?\]\((.*?)\)", page.read_text(encoding="utf-8"), re.S):
                shown.setdefault((page.parent / link).resolve(), set()).add(page.name)
        self.assertEqual({path.name: pages for path, pages in shown.items() if len(pages) > 1}, {})
        kept = {path.resolve() for path in (ROOT / "Documentation").rglob("*.*")
                if path.suffix in (".png", ".gif", ".svg")}
        self.assertEqual(set(shown) - kept, set())  # none is missing
        results = (STUDY / "Results.md").read_text(encoding="utf-8")
        self.assertEqual([path.name for path in kept - set(shown) if path.name not in results], [])


if __name__ == "__main__":
    unittest.main()
