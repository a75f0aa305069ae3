# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries of the models at the size of the paper, moved after their vertices and curves and
projected onto the true surface. Slow: needs Gmsh.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython models_boundary_paper.py
"""

import sys
import unittest

from boundary_checks import BoundaryChecks


class PaperBoundaryChecks(BoundaryChecks):
    small, pieces = False, 2


class BoreHex(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "hex"


class BoreTet(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "tet"


class PipeHex(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "hex"


class PipeTet(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "tet"


class CanisterHex(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "hex"


class CanisterTet(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "tet"


class CourierHex(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "hex"


class CourierTet(PaperBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "tet"


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
