# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries of the small models: found, moved after their vertices and curves, and projected onto the true surface.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython models_boundary.py
"""

import sys
import unittest

from boundary_checks import SmallBoundaryChecks


class BoreHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "hex"


class BoreTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "tet"


class PipeHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "hex"


class PipeTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "tet"


class CanisterHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "hex"


class CanisterTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "tet"


class CourierHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "hex"


class CourierTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "tet"


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
