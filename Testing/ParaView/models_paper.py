# SPDX-License-Identifier: BSD-3-Clause
"""The eight meshes at the paper's size, and those of the variants. Their counts are printed next to
those of its Table 1. Slow: Gmsh makes millions of cells. Needs pvpython and Gmsh, not the
plugin."""

import sys
import unittest

from model_checks import MeshChecks


class PaperChecks(MeshChecks):
    small = False

    def test_counts_are_near_the_papers(self):
        paper = self.geometry.paper[self.kind]
        nodes, cells = len(self.mesh.points), len(self.mesh.cells)
        print(f"\n{self.model} {self.kind}: {nodes:,} nodes, {cells:,} cells; "
              f"Table 1: {paper.nodes:,}, {paper.cells:,}", flush=True)
        self.assertLess(abs(nodes / paper.nodes - 1), 0.1)
        self.assertLess(abs(cells / paper.cells - 1), 0.1)


class BoreHex(PaperChecks, unittest.TestCase):
    model, kind = "bore", "hex"


class BoreTet(PaperChecks, unittest.TestCase):
    model, kind = "bore", "tet"


class PipeHex(PaperChecks, unittest.TestCase):
    model, kind = "pipe", "hex"


class PipeTet(PaperChecks, unittest.TestCase):
    model, kind = "pipe", "tet"


class CanisterHex(PaperChecks, unittest.TestCase):
    model, kind = "canister", "hex"


class CanisterTet(PaperChecks, unittest.TestCase):
    model, kind = "canister", "tet"


class CourierHex(PaperChecks, unittest.TestCase):
    model, kind = "courier", "hex"


class CourierTet(PaperChecks, unittest.TestCase):
    model, kind = "courier", "tet"


class BoreTwistHex(PaperChecks, unittest.TestCase):
    model, kind = "bore_twist", "hex"


class BoreTwistTet(PaperChecks, unittest.TestCase):
    model, kind = "bore_twist", "tet"


class CanisterBlindHex(PaperChecks, unittest.TestCase):
    model, kind = "canister_blind", "hex"


class CanisterBlindTet(PaperChecks, unittest.TestCase):
    model, kind = "canister_blind", "tet"


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
