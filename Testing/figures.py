#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The figures of the pages are those of the data files, rounded as the pages show. The version is
the same everywhere."""
import csv
import math
import re
import statistics
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Testing/Benchmark"), str(ROOT / "Utilities")]
import performance_page  # noqa: E402  (needs the path above)
import study_paper  # noqa: E402

STUDY = ROOT / "Documentation/Study"
RESULTS = ROOT / "Testing/Benchmark/results"


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def prose(page):
    """The text of a page, in one line."""
    path = ROOT / page if page == "README.md" else ROOT / "Documentation" / page
    return " ".join(path.read_text(encoding="utf-8").split())


def table(page, heading):
    """The rows of the table below the heading, or of the table whose first cell it is."""
    text = (ROOT / "Documentation" / page).read_text(encoding="utf-8")
    start = text.index(heading)
    lines = re.search(r"(?:^\|.*\n)+", text[start:], re.MULTILINE)[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def power(nodes, seconds):
    """p of seconds ~ nodes^p, by least squares."""
    x, y = [math.log(n) for n in nodes], [math.log(s) for s in seconds]
    return statistics.linear_regression(x, y).slope


LINEAR = ("FEMWARP", "LBWARP", "Weighted residual", "Simplex-linear", "Simplex-natural neighbor",
          "Radial basis")
MODELS = ("bore", "pipe", "canister", "courier")

#: Numbers with a unit that pages have by definition, by arithmetic or from a source that they name.
GIVEN = {
    "Filters.md": ["1000 MB", "24 bytes"],
    "Methods.md": ["12 bytes", "1 kB", "4000 MB", "8 bytes", "32 MB"],
    "Models.md": ["30 %"],
    "MorphShapes.md": ["24 bytes", "29 %"],
    "Outputs.md": ["1 %"],
    "Performance.md": ["600 s"],
    "Units.md": ["6 bytes"],  # 10^6
    "HowTo/PitchAnAirfoil.md": ["1 %"],  # what its script prints
    "HowTo/CalculixAndScipy.md": ["2 times"],
}
#: Those that a test below compares with a data file.
MEASURED = {
    "README.md": ["549 MB", "2.8 GB"],
    "Performance.md": ["23 times", "11 s", "1.3 times", "11 times"],
    "Study.md": ["0.23 s", "0.47 s", "216 s", "1 %", "85 times", "16 times"],
    "WhatToExpect.md": ["100 s", "8.1 GB", "73 ms", "62 ms", "72 ms", "67 ms", "171 ms", "131 ms",
                        "169 ms", "137 ms", "253 ms", "91 ms"],
}


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
    def assertIn(self, sentence, page):
        """The message does not hold the whole page."""
        self.assertTrue(sentence in page, f"the page does not say: {sentence}")

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

    def test_installation(self):
        data = rows(RESULTS / "install.csv")
        found = table("Install.md", "| system")
        self.assertEqual(len(found), len(data))
        self.check_table(found, data, lambda cells: (cells[0].lower(),),
                         [("release",), "download_MB", "disk_MB"])
        self.assertIn(f"The packages are {data[0]['download_MB']} MB to download and "
                      f"{int(data[0]['disk_MB']) / 1000:.1f} GB on the disk of a bare Debian 12",
                      prose("README.md"))
        minutes, = rows(RESULTS / "install-minutes.csv")
        self.assertIn(f"take {float(minutes['install_minutes']):.0f} minutes. The build takes "
                      f"{float(minutes['build_processor_minutes']):.0f} minutes of processor time",
                      prose("README.md"))

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

    def test_the_papers_variants(self):
        data = {(r["model"], r["kind"]): r for r in rows(STUDY / "variants.csv")}
        found = table("Study.md", "| model | hexahedra, ours")
        self.assertEqual([cells[0] for cells in found], list(MODELS))
        columns = [(kind, start) for kind in ("hex", "tet")
                   for start in ("smoothing", "undeformed")]
        for model, *cells in found:
            for (kind, start), shown in zip(columns, cells, strict=True):
                with self.subTest(model=model, kind=kind, start=start):
                    row = data[model, kind]
                    self.assertEqual(shown[0] == "(", row[start + "_inverted"] != "0")
                    self.check(shown, row[start + ("_inverted" if shown[0] == "(" else "_minimum")])
        self.assertIn("ties give the same minima on all small meshes", prose("Study.md"))
        for key, row in data.items():
            with self.subTest(mesh=key):
                self.assertEqual({row["ties_lowest"], row["ties_highest"]}, {row["linear_minimum"]})

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
        page = prose("Study.md")
        data = {(r["model"], r["kind"], r["method"]): r for r in rows(STUDY / "timing.csv")
                if r["stepping"] == "absolute"}
        pairs = [(row, data[model, kind, "Simplex-linear"])
                 for (model, kind, method), row in data.items() if method in ("FEMWARP", "LBWARP")]
        faster = [float(one["evaluate"]) / float(ours["evaluate"]) for one, ours in pairs]
        longer = [float(ours["prepare"]) / float(one["prepare"]) for one, ours in pairs]
        ratios = (f"{min(faster):.0f} to {max(faster):.0f} times faster than FEMWARP and LBWARP; "
                  f"preparing takes {min(longer):.1f} to {max(longer):.0f} times as long")
        self.assertIn(ratios, page)
        self.assertIn(
            f"The paper has {study_paper.seconds('canister', 'FEMWARP', 'hex', 'absolute'):.0f} s",
            page)
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

    def series(self):
        """{(model, kind, stepping, method): rows on exact surfaces, from S_0 on}"""
        found = {}
        for row in rows(STUDY / "results.csv"):
            if row["surfaces"] == "exact":
                found.setdefault((row["model"], row["kind"], row["stepping"], row["method"]),
                                 []).append(row)
        return {key: sorted(steps, key=lambda row: int(row["step"]))
                for key, steps in found.items()}

    def test_sentences_on_the_steps_of_the_study(self):
        study, which = prose("Study.md"), prose("WhichMethod.md")
        series = self.series()
        own = lambda row: int(row["inverted"]) - int(row["boundary"]) - int(row["folded"])
        final = lambda *key: next(row for row in series[key] if row["step"] == "20")
        minimum = lambda *key: float(final(*key)["minimum"])
        valid = lambda *key: not any(own(row) for row in series[key][:21])
        meshes = [(model, kind) for model in MODELS for kind in ("hex", "tet")]
        self.assertIn("holds on five of eight meshes", study)
        self.assertEqual(sum(not valid(*mesh, "absolute", "Smoothing") for mesh in meshes), 5)
        self.assertIn("In 20 relative steps smoothing is valid on all eight meshes.", which)
        self.assertTrue(all(valid(*mesh, "relative", "Smoothing") for mesh in meshes))
        self.assertIn("On tetrahedra it is then ahead of every linear method in the study", which)
        for model in MODELS:
            self.assertGreater(
                minimum(model, "tet", "relative", "Smoothing"),
                max(minimum(model, "tet", stepping, method)
                    for method in LINEAR for stepping in ("absolute", "relative")))
        bore = [minimum("bore", "hex", "absolute", method) for method in LINEAR]
        self.assertIn(f"{min(bore):.2f} to {max(bore):.2f} on hexahedra by linear methods", study)
        failed = lambda *key: next((int(row["step"]) for row in series[key] if own(row)), 1000)
        others = [any(failed(*mesh, stepping, method) <
                      failed(*mesh, stepping, "Weighted residual") for method in LINEAR)
                  for mesh in meshes for stepping in ("absolute", "relative")]
        self.assertIn(f"one series of {len(others)} is an exception", study)
        self.assertEqual(sum(others), 1)

    def test_growth_of_the_study(self):
        bricks = {}
        for row in rows(STUDY / "scaling.csv"):
            if int(row["n"]) >= 60:
                nodes, seconds = bricks.setdefault((row["motion"], row["method"]), ([], []))
                nodes.append(int(row["nodes"]))
                seconds.append(float(row["prepare"]) + float(row["evaluate"]))
        powers = [power(*brick) for brick in bricks.values()]
        self.assertIn(f"powers of {min(powers):.2f} to {max(powers):.2f} for prepare and evaluate",
                      prose("Study.md"))

    def test_reasons_of_the_study(self):
        """What study_checks.py prints."""
        page, checks = prose("Study.md"), (STUDY / "checks.txt").read_text(encoding="utf-8")
        predicted, linear = re.search(
            r"crushes them at t = ([\d.]+) .*a linear displacement at ([\d.]+)", checks).groups()
        self.assertIn(f"that is t = {float(predicted):.2f} for the small mesh (h = 0.0625)", page)
        self.assertIn(f"lasts until t = {float(linear):.1f}.", page)
        first, inverted, inner = re.search(
            r"FEMWARP: first at t = ([\d.]+), (\d+) cells, of which (\d+) at the hole",
            checks).groups()
        self.assertEqual(inverted, inner)
        paper = next(row["t"] for row in self.series()["canister", "hex", "absolute", "FEMWARP"]
                     if int(row["inverted"]))
        self.assertIn(f"at t = {first} and {paper}, all of them at the hole", page)
        away, length = map(float, re.search(
            r"FEMWARP: .* the 40 worst cells are up to ([\d.]+) from .* are ([\d.]+) long",
            checks).groups())
        self.assertIn("FEMWARP's 40 worst cells lie at the joints", page)
        self.assertLess(away, length)

    def test_bounds_of_the_study(self):
        text = (STUDY / "checks.txt").read_text(encoding="utf-8")
        lines = re.findall(r"^  (\w+): hex ([\d.]+); tet ([\d.]+)$", text, re.MULTILINE)
        bounds = {(model, kind): float(bound) for model, *both in lines
                  for kind, bound in zip(("hex", "tet"), both)}
        self.assertIn("bounds the minimum at {:.4f} on the bore's tetrahedra, {:.4f} on the "
                      "canister's, {:.4f} on the courier's, and {:.4f} on the pipe's hexahedra. "
                      "Inversion-free reaches the first two and comes within 1 % of the others."
                      .format(bounds["bore", "tet"], bounds["canister", "tet"],
                              bounds["courier", "tet"], bounds["pipe", "hex"]), prose("Study.md"))
        for (model, kind), share in ((("bore", "tet"), 1e-3), (("canister", "tet"), 1e-3),
                                     (("courier", "tet"), 1e-2), (("pipe", "hex"), 1e-2)):
            reached = float(self.series()[model, kind, "absolute", "Inversion-free"][20]["minimum"])
            self.assertLess(abs(reached / bounds[model, kind] - 1), share, (model, kind))

    def test_models(self):
        """Their sizes, and their surfaces that fold."""
        data = {(row["model"], row["kind"], row["method"], row["stepping"]): row
                for row in rows(STUDY / "folds.csv") if row["size"] == "paper"}
        of = lambda model, kind: data[model, kind, "Weighted residual", "absolute"]
        found = table("Models.md", "| model | hexahedra")
        self.assertEqual(len(found), len(MODELS))
        for model, (_, hexahedra, _, tetrahedra, _) in zip(MODELS, found):
            for kind, shown in (("hex", hexahedra), ("tet", tetrahedra)):
                row = of(model, kind)
                self.assertEqual(shown, f"{int(row['nodes']):,}, {int(row['cells']):,}", model)
        nodes = [int(row["nodes"]) for row in data.values()]
        self.assertIn(f"{round(min(nodes), -3):,} to {round(max(nodes), -3):,} nodes",
                      prose("WhichMethod.md"))
        size = lambda model, kind: f"{int(of(model, kind)['nodes']):,} nodes"
        expect = prose("WhatToExpect.md")
        self.assertIn(f"bore hex, {size('bore', 'hex')}", expect)
        self.assertIn(f"The canister is hexahedra with {size('canister', 'hex')}, the courier "
                      f"tetrahedra with {size('courier', 'tet')}", expect)
        self.assertIn(f"On the canister's {size('canister', 'hex')} FEMWARP", prose("Study.md"))
        folded = lambda model, kind: of(model, kind)["folded"]
        self.assertIn(", ".join(f"{folded(model, 'hex')} and {folded(model, 'tet')} of the {model}"
                                for model in MODELS[1:]), prose("Models.md"))
        self.assertEqual({folded("bore", "hex"), folded("bore", "tet")}, {"0"})
        self.assertEqual({row["model"] for row in data.values()
                          if row["stepping"] == "relative" and int(row["folded"])}, {"canister"})
        canister = [data["canister", "hex", method, "absolute"]["folded"]
                    for method in ("Weighted residual", "Smoothing", "Mesh smoothing")]
        self.assertEqual(canister[2], "0")
        self.assertIn(f"*Weighted residual* folds {canister[0]} hexahedral faces in one step, "
                      f"*Smoothing* {canister[1]}, and *Mesh smoothing* none",
                      prose("MovingABoundary.md"))

    def test_layers(self):
        found = table("MovingABoundary.md", "| method | lean, degrees")
        self.assertEqual(len(found), 3)
        self.check_table(found, rows(RESULTS / "ring.csv"), lambda cells: (cells[0],),
                         [("method",), "lean", "first_height"])

    def test_advice_on_performance(self):
        runs = {}
        for row in rows(performance_page.DATA):
            runs.setdefault((row["mesh"], int(row["nodes"]), row["program"], row["processors"]),
                            []).append(row)
        middle = lambda key, name: performance_page.median(runs[key], name)
        beside = lambda program, processors: [
            middle((*mesh, program, processors), "later_s") /
            middle((*mesh, "FEMWARP", "2"), "later_s")
            for *mesh, name, of in runs if (name, of) == (program, processors)]
        page = prose("Performance.md")
        self.assertEqual({row["inverted"] for key, found in runs.items() if key[2] == "FEMWARP"
                          for row in found}, {"0"})
        self.assertIn(f"at up to {max(beside('Inversion-free', '2')):.0f} times its later step",
                      page)
        first = max(middle(key, "first_s") for key in runs if key[2] == "CHOLMOD")
        cholmod = beside("CHOLMOD", "1")
        self.assertIn(f"takes up to {first:.0f} s, and its substitution {min(cholmod):.1f} to "
                      f"{max(cholmod):.1f} times as long", page)
        cube = ("cube", max(nodes for _, nodes, _, _ in runs))
        ranks = (middle((*cube, "FEMWARP on MPI ranks", "2"), "later_s") /
                 middle((*cube, "FEMWARP", "2"), "later_s"))
        self.assertIn(f"two take {ranks:.0f} times as long", page)

    def test_no_page_has_another_measured_figure(self):
        """A number with a unit is in a list above."""
        unit = re.compile(r"(?<![\w.,])\d[\d,.]* (?:s|ms|%|times|bytes|[kMG]B)(?![\w])")
        for path in [ROOT / "README.md", *sorted((ROOT / "Documentation").rglob("*.md"))]:
            if path.name == "Results.md":
                continue  # study_report.py writes it
            text = path.read_text(encoding="utf-8")
            if path == performance_page.PAGE:
                text = text[:text.index(performance_page.START)]
            text = re.sub(r"^```[^`]*^```|^ {4}.*$", "", text, flags=re.M)
            page = str(path.relative_to(ROOT)).removeprefix("Documentation/")
            with self.subTest(page=page):
                known = GIVEN.get(page, []) + MEASURED.get(page, [])
                self.assertEqual(sorted(set(unit.findall(" ".join(text.split())))),
                                 sorted(set(known)))

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
                         lambda cells: (cells[0].replace(",", ""), "5.11", cells[1]),
                         [("nodes", "paraview", "dragged"), "picture_ms", "floor_ms"])

    def test_sentences(self):
        text = prose("WhatToExpect.md")
        whole, = rows(RESULTS / "whole-program.csv")
        self.assertIn(f"{int(whole['nodes']):,} nodes in {whole['seconds']} s, with "
                      f"{whole['memory_GB']} GB", text)
        mesh, surface = (next(row["picture_ms"] for row in rows(RESULTS / "dragging.csv")
                              if (row["paraview"], row["dragged"]) ==
                              ("5.11", f"Morph FEMWARP, {shown}"))
                         for shown in ("the mesh", "its surface"))
        self.assertIn(f"takes {mesh} ms to the picture, and {surface} ms with the surface", text)

    def test_gallery(self):
        self.check_table(table("Gallery.md", "## In figures"), rows(STUDY / "gallery.csv"),
                         lambda cells: tuple(cells[:2]),
                         [("script", "method"), "cells", "minimum_before", "minimum_after"])

    def test_data_files_say_where_their_rows_come_from(self):
        """The commit of the sources, and the machine where a column has a time."""
        for path in [*STUDY.glob("*.csv"), *RESULTS.glob("*.csv")]:
            data = rows(path)
            time = re.search(r"seconds|_m?s\b|evaluate|minutes|ratio", ",".join(data[0]))
            for column in ("machine", "commit") if time else ("commit",):
                with self.subTest(file=path.name, column=column):
                    self.assertIn(column, data[0])
                    self.assertEqual([row for row in data if not row[column]], [])

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
