# SPDX-License-Identifier: BSD-3-Clause
"""Steps in ParaView's time, Compare Morph Methods, and a quick study that is interrupted and
resumed.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython steps_and_study.py
"""
import csv
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=vars(simple))
import Models  # noqa: E402  (needs the path above)
from models_folds import MovedSurfaces  # noqa: E402
from study_boundary import Boundaries, determined_cells, lost_cells  # noqa: E402
from study_records import Records, Series as StudySeries, Step, last_valid  # noqa: E402
from study_series import SeriesRun  # noqa: E402

SEED = int(os.environ.get("MORPH_TEST_SEED", "7"))


def inputs():
    """A grid, and its boundary warped."""
    grid = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 6, 0, 6, 0, 6])])
    boundary = simple.Calculator(Input=ExtractMorphBoundary(Input=grid), CoordinateResults=1,
                                 Function="coords + 2*sin(coordsX)*kHat")
    return grid, boundary


def points(proxy):
    output = proxy.GetClientSideObject().GetOutputDataObject(0)
    return vtk_to_numpy(output.GetPoints().GetData()).copy()


class Steps(unittest.TestCase):
    def test_are_times_of_paraview(self):
        grid, boundary = inputs()
        morph = MorphSimplexLinear(Input=grid, Boundary=boundary, NumberOfSteps=5,
                                   Stepping="Relative", Validity="None")
        morph.UpdatePipelineInformation()
        self.assertEqual(list(morph.TimestepValues), [0, 1, 2, 3, 4, 5])
        scene = simple.GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(list(scene.TimeKeeper.TimestepValues), [0, 1, 2, 3, 4, 5])
        morph.UpdatePipeline(5)
        jumped = points(morph)
        played = MorphSimplexLinear(Input=grid, Boundary=boundary, NumberOfSteps=5,
                                    Stepping="Relative", Validity="None")
        for step in range(6):
            played.UpdatePipeline(step)
        self.assertTrue((points(played) == jumped).all())
        morph.UpdatePipeline(0)
        self.assertFalse((points(morph) == jumped).all())


class Compare(unittest.TestCase):
    def test_fills_three_tables(self):
        grid, boundary = inputs()
        compare = CompareMorphMethods(Input=grid, Boundary=boundary, NumberOfSteps=3, Relative=1,
                                      Smoothing=0)
        compare.UpdatePipeline()
        tables = [compare.GetClientSideObject().GetOutputDataObject(port) for port in range(3)]
        self.assertEqual([table.GetNumberOfRows() for table in tables], [7 * 2 * 4, 4, 7 * 2])
        with tempfile.TemporaryDirectory() as folder:
            file = str(Path(folder) / "ranking.csv")
            simple.SaveData(file, proxy=simple.OutputPort(compare, 2))
            with open(file, newline="", encoding="utf-8") as text:
                rows = list(csv.DictReader(text))
        self.assertEqual([int(row["Rank"]) for row in rows], list(range(1, 15)))
        self.assertEqual(rows[0]["Method"], tables[2].GetValueByName(0, "Method").ToString())


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


class Study(unittest.TestCase):
    """Of two methods on the small bore, as --quick runs all eight."""

    def run_study(self, folder, *options):
        command = ["pvpython", "--force-offscreen-rendering", str(ROOT / "Utilities" / "study.py"),
                   "--quick", "--output", folder, *options]
        process = subprocess.run(command, capture_output=True, text=True, timeout=200)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        return process.stdout

    def test_quick(self):
        methods = ["FEMWARP", "Weighted residual", "Inversion-free"]
        with tempfile.TemporaryDirectory() as folder:
            results = Path(folder) / "results.csv"
            self.run_study(folder, "--methods", *methods)
            rows = rows_of(results)
            # Two kinds, two kinds of surfaces, two steppings; S_0 to S_F is steps 0 to 4.
            series = {tuple(row.values())[:5] for row in rows}
            self.assertEqual(len(series), 2 * 2 * 2 * 3)
            for one in series:
                mine = [row for row in rows if tuple(row.values())[:5] == one]
                self.assertEqual([int(row["step"]) for row in mine], list(range(len(mine))))
                self.assertGreaterEqual(len(mine), 5)
                own = [int(row["inverted"]) > int(row["boundary"]) + int(row["folded"])
                       for row in mine]
                # Past S_F a series ends with its first inverted cell, or with the geometry, at
                # t = 1.5.
                self.assertFalse(any(own[5:-1]))
                self.assertTrue(any(own) or float(mine[-1]["t"]) == 1.5, one)
            self.assertFalse([row for row in rows
                              if row["method"] == "Inversion-free" and int(row["step"]) <= 4
                              and int(row["inverted"]) > 0])
            report = (Path(folder) / "Results.md").read_text(encoding="utf-8")
            for text in ("Figure 2", "Table 2", "Section 4.5"):
                self.assertIn(text, report)
            # The paper's seconds for FEMWARP on the bore, hexahedra, relative.
            self.assertTrue(re.search(r"^\| FEMWARP \| [0-9.]+; 0\.30 \|", report, re.MULTILINE))
            timings = rows_of(Path(folder) / "timing.csv")
            self.assertEqual(len(timings), 2 * 2 * 3)
            self.assertTrue(all(float(row["prepare"]) > 0 and float(row["evaluate"]) > 0
                                for row in timings))
            pictures = sorted(path.name for path in Path(folder).glob("*.png"))
            self.assertEqual(pictures, ["figure-bore-exact.png",
                                        "figure-bore-weighted-residual.png", "figure-scaling.png"])

            # Interrupted in the middle of a row, and gone on with.
            text = results.read_text(encoding="utf-8")
            results.write_text(text[:len(text) * 2 // 3], encoding="utf-8")
            kept = rows_of(results)[:-1]  # the last one is cut off
            self.run_study(folder, "--methods", *methods, "--no-scaling")
            again = rows_of(results)
            self.assertEqual(again[:len(kept)], kept)
            quality = ("minimum", "mean", "inverted", "boundary", "folded", "cells")

            def table(all_rows):
                return {tuple(row.values())[:6]: [row[name] for name in quality]
                        for row in all_rows if None not in row.values()}
            self.assertEqual(table(again), table(rows))

            # Every row has its commit.
            self.assertEqual(len({row["commit"] for row in again}), 1)
            self.assertNotEqual(again[0]["commit"], "")

            # A piece without time does nothing; with --fresh a series of another commit is missing.
            other = results.read_text(encoding="utf-8").replace(again[0]["commit"], "0000000")
            results.write_text(other, encoding="utf-8")
            self.run_study(folder, "--methods", *methods, "--fresh", "--minutes", "0")
            self.assertEqual(results.read_text(encoding="utf-8"), other)
            self.run_study(folder, "--methods", "FEMWARP", "--kinds", "hex", "--surfaces", "exact",
                           "--steppings", "absolute", "--fresh", "--no-timing", "--no-scaling")
            added = results.read_text(encoding="utf-8")[len(other):].splitlines()
            self.assertTrue(all(line.startswith("bore,hex,exact,absolute,FEMWARP,")
                                and line.endswith(again[0]["commit"]) for line in added))
            self.assertGreaterEqual(len(added), 5)
            missing = self.run_study(folder, "--methods", *methods, "--fresh", "--list")
            self.assertEqual(missing.count("0 of 5 steps"), 23)
            self.assertNotIn("hex, exact surfaces, absolute, FEMWARP", missing)


class StudyBoundary(unittest.TestCase):
    """Which inverted cells the study puts down to the boundary."""

    def test_folded_faces_take_their_cells(self):
        mesh = Models.get("canister").read_small("hex")
        surfaces = MovedSurfaces(mesh)
        surfaces.move_to(1)
        folded = mesh.faces[surfaces.folded(1)]
        owners = [np.flatnonzero(np.isin(mesh.cells, face).sum(axis=1) == 4) for face in folded]
        positions = surfaces.moved[mesh.nodes][None]
        surfaces.remove()
        self.assertTrue(owners)
        # Two measures of a fold: by the true surface's corners, and by a normal that the surface's
        # motion carries along.
        lost = lost_cells(mesh, positions)
        self.assertEqual(set(lost[0]), set(np.concatenate(owners)))

        run = SeriesRun("FEMWARP", mesh, Boundaries(positions, lost), [1.0], "absolute", 2)
        step = run.step(0)
        inverted = vtk_to_numpy(run.mesh().GetCellData().GetArray("ScaledJacobian")) <= 0
        run.remove()
        self.assertEqual(step.inverted, inverted.sum())
        self.assertEqual(step.boundary + step.folded, inverted[lost[0]].sum())
        self.assertGreater(step.folded, 0)
        self.assertGreater(step.own, 0)
        named = [int(cell) for cell in step.cells.split()]
        self.assertTrue(inverted[named].all() and not np.isin(named, lost[0]).any())

    def test_finds_inverted_corners_as_the_filter_counts_them(self):
        for name, kind in (("canister", "hex"), ("bore", "tet")):
            mesh = Models.get(name).read_small(kind)
            positions = mesh.boundary_positions(0)[None]
            edge = np.linalg.norm(np.diff(mesh.points[mesh.cells[:, :2]], axis=1), axis=2).mean()
            random = np.random.default_rng(SEED)
            scrambled = positions + random.uniform(-edge, edge, positions.shape)
            both = np.concatenate([positions, scrambled])
            determined = determined_cells(mesh, both)
            run = SeriesRun("Simplex-linear", mesh, Boundaries(both, determined), [0, 1],
                            "absolute", 2)
            steps = [run.step(0), run.step(1)]
            run.remove()
            counts = [len(cells) for cells in determined]
            self.assertEqual([step.boundary for step in steps], counts, (name, SEED))
            self.assertEqual((counts[0], steps[1].folded), (0, 0), (name, SEED))
            self.assertGreater(counts[1], 0, (name, SEED))

    def test_rows_of_one_commit_take_the_place_of_another_s(self):
        series = StudySeries("bore", "hex", "exact", "absolute", "FEMWARP")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "results.csv"
            for number in range(3):
                Records(file).add(series, Step(number, 0.0, 0.5, 0.9, 0, 0, 0, "7 9", "def"))
            records = Records(file)
            self.assertEqual([(step.cells, step.commit) for step in records.steps(series)],
                             3 * [("7 9", "def")])
            # The longer series' end is gone, too.
            records.add(series, Step(0, 0.0, 0.6, 0.9, 0, 0, 0, "", "abc"))
            for read in (records, Records(file)):
                self.assertEqual([step.minimum for step in read.steps(series)], [0.6])
                self.assertEqual(read.steps(series, "def"), [])
                self.assertEqual([step.commit for step in read.steps(series)], ["abc"])

    def test_refuses_results_without_the_column(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "results.csv"
            Records(file).add(StudySeries("bore", "hex", "exact", "absolute", "FEMWARP"),
                              Step(0, 0.0, 0.5, 0.9, 3, 1, 2, "", "abc"))
            steps = Records(file).steps(StudySeries("bore", "hex", "exact", "absolute", "FEMWARP"))
            self.assertEqual((steps[0].own, last_valid(steps)), (0, 0.0))
            text = file.read_text(encoding="utf-8")
            old = text.replace(",folded", "")
            file.write_text(old, encoding="utf-8")
            self.assertRaises(ValueError, Records, file)
            self.assertEqual(file.read_text(encoding="utf-8"), old)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
