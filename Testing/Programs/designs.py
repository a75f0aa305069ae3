# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh --shapes: a mesh for each row of a table, their quality, and runs that were stopped.

Run: MORPH_MESH=<path of morph-mesh> MESHMORPHING_MODELS=<folder of the small models>
         python3 designs.py
"""
import csv
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["MORPH_MESH"]
BORE = str(Path(os.environ["MESHMORPHING_MODELS"]) / "bore_hex_small.vtu")


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


class Designs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.shapes = [self.folder / "whole.vtp", self.folder / "again.vtp"]
        for shape in self.shapes:
            self.assertEqual(run("extract", BORE, shape).returncode, 0)
        self.table = self.folder / "doe.csv"
        self.table.write_text('note,"whole",again\na,0,0\nb,0.5,0.5\nc,1,0\n\nd,-8,0\n')
        self.designs = self.folder / "designs"

    def write(self, *options):
        return run(BORE, "--shapes", *self.shapes, "--table", self.table, "--output",
                   self.designs, "--displacement-array", "FinalDisplacement", *options)

    def quality(self):
        with open(self.designs / "quality.csv", newline="", encoding="utf-8") as table:
            return list(csv.DictReader(table))

    def test_a_mesh_and_a_line_for_each_row(self):
        result = self.write()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("the column 'note'", result.stderr)
        self.assertEqual(result.stdout,
                         "4 designs, 0 of them there already; 1 with inverted or collapsed cells\n")
        rows = self.quality()
        self.assertEqual([row["Design"] for row in rows], ["0", "1", "2", "3"])
        self.assertEqual([float(row["whole"]) for row in rows], [0, 0.5, 1, -8])
        self.assertAlmostEqual(float(rows[0]["MinScaledJacobian"]), 0.8619, delta=1e-4)
        # The halves of one shape are the shape, which a morph makes as well.
        morph = run(BORE, self.shapes[0], self.folder / "out.vtu", "--displacement-array",
                    "FinalDisplacement")
        for row in rows[1:3]:
            self.assertIn(f"{float(row['MinScaledJacobian']):.4f}", morph.stdout)
        self.assertEqual([int(row["InvertedCells"]) > 0 for row in rows],
                         [False, False, False, True])
        self.assertEqual(len(list(self.designs.glob("design_*.vtu"))), 4)
        self.assertEqual(self.write("--require-valid").returncode, 3)

    def test_a_run_continues(self):
        self.assertEqual(self.write().returncode, 0)
        made = {file: file.stat().st_mtime_ns for file in self.designs.glob("design_*.vtu")}
        whole = (self.designs / "quality.csv").read_text()
        # As if it had been killed after the second row, and another mesh was lost.
        lines = whole.splitlines(keepends=True)
        (self.designs / "quality.csv").write_text("".join(lines[:3]) + lines[3][:9])
        (self.designs / "design_0000.vtu").unlink()
        time.sleep(0.01)
        result = self.write()
        self.assertIn("4 designs, 1 of them there already", result.stdout)
        self.assertEqual((self.designs / "quality.csv").read_text(), whole)
        kept = [file.name for file, changed in made.items() if file.stat().st_mtime_ns == changed]
        self.assertEqual(kept, ["design_0001.vtu"])
        # A changed row is made again, the others are not.
        self.table.write_text(self.table.read_text().replace("c,1,0", "c,0.75,0"))
        self.assertIn("4 designs, 3 of them there already", self.write().stdout)

    def test_a_table_that_a_spreadsheet_wrote(self):
        self.assertEqual(self.write().returncode, 0)
        names, rows = self.table.read_text().split("\n", 1)
        rows = rows.replace(",", ";").replace(".", ",")
        self.table.write_text("\ufeff" + names.upper().replace(",", ";") + "\n" + rows)
        self.assertIn("4 designs, 4 of them there already", self.write().stdout)

    def test_a_killed_run_continues(self):
        self.table.write_text("whole,again\n" + "0.5,0.25\n" * 60)
        arguments = [PROGRAM, BORE, "--shapes", *map(str, self.shapes), "--table", str(self.table),
                     "--output", str(self.designs), "--displacement-array", "FinalDisplacement"]
        with subprocess.Popen(arguments, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as program:
            for _ in range(1000):
                if (self.designs / "design_0003.vtu").exists():
                    break
                time.sleep(0.01)
            program.kill()
        result = self.write()
        self.assertEqual(result.returncode, 0, result.stderr)
        already = int(result.stdout.split("60 designs, ")[1].split()[0])
        self.assertTrue(3 <= already, result.stdout)
        self.assertEqual(len(self.quality()), 60)
        self.assertEqual(len({row["MinScaledJacobian"] for row in self.quality()}), 1)

    def test_other_inputs_are_refused(self):
        self.assertEqual(self.write().returncode, 0)
        result = self.write("--method", "LBWARP")
        self.assertEqual(result.returncode, 1)
        self.assertIn("holds designs of another mesh, other shapes or other options",
                      result.stderr)

    def test_wrong_tables_and_options(self):
        for content, message in [("whole\n1\n", "no column 'again'"), ("", "empty"),
                                 ("whole,again\n", "no design"),
                                 ("whole,again,whole\n1,2,3\n", "two columns 'whole'"),
                                 ("whole,again\n1\n", "line 2: '1' has 1 columns"),
                                 ("whole,again\n1,x\n",
                                  "line 2: 'x' is no finite number, in '1,x'"),
                                 ("whole,again\n1,nan\n", "'nan' is no finite number")]:
            with self.subTest(content=content):
                self.table.write_text(content)
                result = self.write()
                self.assertEqual(result.returncode, 1)
                self.assertIn(message, result.stderr)
        for options, message in [(["--method", "Smoothing"], "needs a linear method"),
                                 (["--outside-hull", "relax"], "no effect on --shapes"),
                                 (["--scale-factor", "2"], "no effect"),
                                 (["--as-rotation", "other"], "which is no file of --shapes")]:
            with self.subTest(options=options):
                self.table.write_text("whole,again\n1,0\n")
                result = self.write(*options)
                self.assertEqual(result.returncode, 2)
                self.assertIn(message, result.stderr)
        self.assertFalse(self.designs.exists())
        self.assertEqual(run(BORE, "--shapes", self.shapes[0]).returncode, 2)


if __name__ == "__main__":
    unittest.main()
