# SPDX-License-Identifier: BSD-3-Clause
"""The package's meshes are those of the plugin's filters, to 1e-12 of the coordinates.

Run: PYTHONPATH=<folder of meshmorphing> MESHMORPHING_MODELS=<small models>
         python3 against_filters.py <pvpython> <MeshMorphing.so>
"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import meshmorphing as mm
import numpy

PVPYTHON, PLUGIN = sys.argv[1:3]
MODELS = Path(os.environ["MESHMORPHING_MODELS"])
METHODS = {"MorphFEMWARP": mm.FEMWARP(), "MorphLBWARP": mm.LBWARP(),
           "MorphWeightedResidual": mm.WeightedResidual(), "MorphRadialBasis": mm.RadialBasis(),
           "MorphSimplexLinear": mm.SimplexLinear(),
           "MorphSimplexNaturalNeighbor": mm.SimplexNaturalNeighbor()}
# Writes points, cells, the boundary's ids and where they go, each method's mesh, and its quality.
SCRIPT = r"""
import sys
import numpy
from paraview import servermanager, simple
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import vtk_to_numpy
plugin, model, folder = sys.argv[1:4]
simple.LoadPlugin(plugin, remote=False, ns=globals())
part = simple.OpenDataFile(model)
boundary = simple.Calculator(
    Input=ExtractMorphBoundary(Input=part), CoordinateResults=1, ResultArrayType="Double",
    Function="coords + 0.1*sin(coordsY)*iHat + 0.2*cos(coordsX + coordsZ)*jHat")
def keep(name, values):
    numpy.save(folder + "/" + name + ".npy", numpy.array(values))
grid = WrapDataObject(servermanager.Fetch(part))
keep("points", grid.Points)
cells = grid.VTKObject.GetCells()
keep("offsets", vtk_to_numpy(cells.GetOffsetsArray()))
keep("connectivity", vtk_to_numpy(cells.GetConnectivityArray()))
keep("types", vtk_to_numpy(grid.VTKObject.GetCellTypesArray()))
moved = WrapDataObject(servermanager.Fetch(boundary))
keep("ids", moved.PointData["MorphPointId"])
keep("targets", moved.Points)
for method in sys.argv[4:]:
    filter_ = globals()[method](Input=part, Boundary=boundary)
    filter_.OutputPointsPrecision = "Double"
    result = WrapDataObject(servermanager.Fetch(filter_))
    keep(method, result.Points)
    keep(method + "Quality", result.CellData["ScaledJacobian"])
"""


class AgainstFilters(unittest.TestCase):
    def run_filters(self, model):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        script = Path(folder.name, "filters.py")
        script.write_text(SCRIPT, encoding="utf-8")
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        subprocess.run([PVPYTHON, script, PLUGIN, MODELS / model, folder.name, *METHODS],
                       check=True, env=environment, timeout=200)
        return {path.stem: numpy.load(path) for path in Path(folder.name).glob("*.npy")}

    def test_same_meshes(self):
        for model in ("bore_hex_small.vtu", "pipe_tet_small.vtu"):
            ran = self.run_filters(model)
            mesh = mm.Mesh(ran["points"], (ran["offsets"], ran["connectivity"], ran["types"]))
            self.assertTrue((mesh.boundary.nodes == ran["ids"]).all())
            for name, method in METHODS.items():
                with self.subTest(model=model, method=name):
                    moved = method.prepare(mesh, ran["ids"]).evaluate(targets=ran["targets"])
                    self.assertGreater(abs(moved - mesh.points).max(), 0.1)
                    self.assertLess(abs(moved - ran[name]).max(), 1e-12)
                    quality = mm.quality(mesh, moved).scaled_jacobian
                    self.assertLess(abs(quality - ran[name + "Quality"]).max(), 1e-12)


if __name__ == "__main__":
    if not (shutil.which(PVPYTHON) and Path(PLUGIN).exists()):
        print(f"skipped: there is no {PVPYTHON} or no {PLUGIN}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
