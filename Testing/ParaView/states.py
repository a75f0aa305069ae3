# SPDX-License-Identifier: BSD-3-Clause
"""Every filter of the plugin, saved in a state (.pvsm and .py) with options that are not the
defaults. The loaded pipeline has the same properties and makes the same data, to the last bit.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_XML=<its XML files, : between>
         pvpython states.py
"""
import os
import runpy
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from paraview import servermanager, simple, smstate
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

# Seconds and memory differ from run to run, and so does the ranking, which depends on seconds.
MEASURED = "Seconds", "PeakMegabytes"
RANKING = "CompareMorphMethods", 2
OPTIONS = {"NumberOfThreads": 1, "FeatureAngle": 40, "FixUnnamedBoundary": 0, "Percentile": 5,
           "ScaleFactor": 0.5, "Certify": 1, "SurfaceMethod": 1, "OutputPointsPrecision": 1,
           "DisplacementArray": "Shift", "Weights": [0.5], "ShapeNames": ["a shape"]}


def proxies():
    """The XML element of each proxy."""
    found = []
    for path in os.environ["MESHMORPHING_XML"].split(":"):
        found += ElementTree.parse(path).getroot().findall("ProxyGroup[@name='filters']/*")
    return found


def build():
    """Makes a pipeline with every filter on a small cube.

    Their names in the pipeline browser are those of the proxies."""
    cube = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 3] * 3)])
    grid = simple.Tetrahedralize(Input=cube)
    moved = simple.Calculator(Input=ExtractMorphBoundary(Input=grid), ResultArrayName="Shift",
                              Function="4*sin(coordsX*coordsZ)*jHat")
    moved.UpdatePipeline()
    for xml in proxies():
        names = [p.get("name") for p in xml.iter("InputProperty")]
        inputs = {"Input": grid, "Boundary": moved, "Shapes": moved}
        create = globals()[xml.get("label").replace(" ", "")]
        proxy = create(registrationName=xml.get("name"),
                       **{name: inputs[name] for name in names if name in inputs})
        for name in proxy.ListProperties():
            if name in OPTIONS:
                setattr(proxy, name, OPTIONS[name])
        if xml.get("name") == "CompareMorphMethods":
            proxy.NumberOfSteps, proxy.InversionFree, proxy.Smoothing = 2, 0, 0
        elif xml.get("name") == "MorphMesh":
            # The top of the cube goes through the bottom.
            proxy.Surfaces, proxy.Validity = ["Surface 5"], "Report"
            proxy.Displacement, proxy.Vector = "Vector", [0, 0, -9]
    adjoint = simple.FindSource("MorphAdjoint")
    adjoint.Gradient = simple.FindSource("MorphLBWARP")
    adjoint.Gradient.UpdatePipeline()
    adjoint.GradientArray = "MorphDisplacement"


def arrays(data):
    """Points and arrays of a data object, as text where they are not numbers."""
    found = {}
    for kind in ("PointData", "CellData", "RowData", "FieldData"):
        attributes = getattr(data, "Get" + kind)() if hasattr(data, "Get" + kind) else None
        for i in range(attributes.GetNumberOfArrays() if attributes else 0):
            array = attributes.GetAbstractArray(i)
            if not array.GetName().endswith(MEASURED):
                found[kind, array.GetName()] = (
                    vtk_to_numpy(array) if array.IsNumeric()
                    else [array.GetValue(k) for k in range(array.GetNumberOfValues())])
    if hasattr(data, "GetPoints") and data.GetPoints():
        found["Points"] = vtk_to_numpy(data.GetPoints().GetData())
    return found


def session():
    """What every filter was told, and what it made, by filter and port."""
    told, made = {}, {}
    for xml in proxies():
        name = xml.get("name")
        proxy = simple.FindSource(name)
        proxy.UpdatePipeline()
        told[name] = {p.get("name"): str(getattr(proxy, p.get("name"))) for p in xml
                      if p.tag.endswith("VectorProperty") and p.get("information_only") != "1"}
        for port in range(proxy.SMProxy.GetNumberOfOutputPorts()):
            if (name, port) != RANKING:
                made[name, port] = arrays(servermanager.Fetch(proxy, idx=port))
    return told, made


class States(unittest.TestCase):
    def test_saved_and_loaded(self):
        build()
        told, made = session()
        self.assertGreaterEqual(len(told), 13)
        changed = {option for values in told.values() for option in values} & set(OPTIONS)
        self.assertEqual(changed, set(OPTIONS))
        empty = {place for place, found in made.items()
                 if not found or max(map(len, found.values())) == 0}
        # The motion folds cells, which are the second outputs; these four have none. The last are
        # control points, which the motion has none of.
        self.assertLessEqual(empty, {("MorphInversionFree", 1), ("MorphRadialBasis", 1),
                                     ("MorphSmoothing", 1), ("RepairMesh", 1), ("MorphMesh", 3),
                                     ("RepairMesh", 3)})
        with tempfile.TemporaryDirectory() as folder:
            simple.SaveState(str(Path(folder, "state.pvsm")))
            Path(folder, "state.py").write_text(smstate.get_state(), encoding="utf-8")
            for name in ("state.pvsm", "state.py"):
                with self.subTest(state=name):
                    simple.ResetSession()
                    self.assertIsNone(simple.FindSource("MorphFEMWARP"))
                    path = str(Path(folder, name))
                    if name.endswith(".py"):
                        runpy.run_path(path)
                    else:
                        simple.LoadState(path)
                    self.assertSame((told, made), session())

    def assertSame(self, before, after):
        self.assertEqual(before[0], after[0])
        self.assertEqual(before[1].keys(), after[1].keys())
        for place, expected in before[1].items():
            self.assertEqual(expected.keys(), after[1][place].keys(), place)
            for array, values in expected.items():
                np.testing.assert_array_equal(after[1][place][array], values, f"{place} {array}")


if __name__ == "__main__":
    unittest.main()
