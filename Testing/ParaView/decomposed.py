# SPDX-License-Identifier: BSD-3-Clause
"""Decomposed files of solvers on two MPI ranks: each rank reads its part, as composite data.

The mesh has to move as the same file in one part does on one rank.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython decomposed.py
The same file is the job that the ranks run: mpiexec -n 2 pvbatch decomposed.py FOLDER
"""
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "Programs"))
import exodus_models
import ranks as ranks_of_mpi
import solver_models as models
from foam_case import FoamCase

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

DECOMPOSE = """numberOfSubdomains 2; method simple;
coeffs { n (1 1 2); } simpleCoeffs { n (1 1 2); delta 0.001; }"""
# On each rank: the points of all leaves, before and after, and whether they are of volume cells.
LEAVES = """
import numpy as np
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.vtkParallelCore import vtkMultiProcessController
data = self.GetInputDataObject(0, 0)
rows = []
item = data.NewIterator()
item.InitTraversal()
while not item.IsDoneWithTraversal():
    leaf = dataset_adapter.WrapDataObject(item.GetCurrentDataObject())
    if leaf.GetNumberOfPoints() > 0:
        by = leaf.PointData["MorphDisplacement"]
        isSet = item.GetCurrentDataObject().GetClassName() == "vtkPolyData" or (
            leaf.GetMaxCellSize() < 5 and leaf.GetCellType(0) != 10)
        rows.append(np.column_stack([leaf.Points - by, by, np.full(len(by), float(isSet))]))
    item.GoToNextItem()
rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
np.save("%s_%d.npy" % (NAME, rank), np.concatenate(rows) if rows else np.zeros((0, 7)))
"""


def select_all(reader):
    """All blocks, side sets and node sets, or all patches."""
    reader.UpdatePipelineInformation()
    for name in ("ElementBlocks", "NodeSets", "SideSets", "SideSetArrayStatus",
                 "NodeSetArrayStatus", "MeshRegions"):
        if hasattr(reader, name):
            available = reader.GetProperty(name).Available
            setattr(reader, name, available)
    for name, value in (("ApplyDisplacements", 0), ("Decomposepolyhedra", 0),
                        ("ScalarSize", "64-bit (DP)"), ("GenerateGlobalElementIdArray", 1),
                        ("GenerateGlobalNodeIdArray", 1)):
        if hasattr(reader, name):
            setattr(reader, name, value)


def read(case, part):
    """The file that `case` names as "whole" or "parts"."""
    reader = getattr(simple, case["reader"])(FileName=case[part])
    if case["reader"] == "OpenFOAMReader":
        reader.CaseType = "Decomposed Case" if part == "parts" else "Reconstructed Case"
    select_all(reader)
    return reader


def morphed(case, part):
    reader = read(case, part)
    boundary = BoundaryDisplacement(Input=reader, Moving="Surfaces", Surfaces=[case["wall"]],
                                    Displacement="Vector", Vector=[0.05, 0.02, -0.03])
    return MorphFEMWARP(Input=reader, Boundary=boundary, Tolerance=1e-12)


def job(folder):
    for case in json.loads((Path(folder) / "cases.json").read_text()):
        print("CASE", case["name"], flush=True)
        morph = morphed(case, "parts")
        dump = simple.ProgrammableFilter(Input=morph)
        dump.Script = f"NAME = {os.path.join(folder, case['name'])!r}\n" + LEAVES
        dump.UpdatePipeline()
        print("STATUS", morph.MorphStatus, morph.MinScaledJacobian, morph.PrescribedPoints,
              flush=True)
    print("DONE", flush=True)


def part_of(model, owner, rank):
    """A model of the cells that `owner` gives to a rank, with its numbers."""
    cells = [c for c in range(len(model.cells)) if owner[c] == rank]
    nodes = sorted({n for c in cells for n in model.cells[c][1]})
    node = {n: i for i, n in enumerate(nodes)}
    cell = {c: i for i, c in enumerate(cells)}
    faces = lambda given: [(cell[c], side, [node[n] for n in corners])
                           for c, side, corners in given if c in cell]
    return types.SimpleNamespace(
        points=[model.points[n] for n in nodes], numbers=[model.numbers[n] for n in nodes],
        elements=[model.elements[c] for c in cells], order=list(range(len(nodes))),
        cells=[(model.cells[c][0], [node[n] for n in model.cells[c][1]]) for c in cells],
        wall=faces(model.wall), inlet=faces(model.inlet), outlet=faces(model.outlet),
        wall_nodes=[node[n] for n in model.wall_nodes if n in node])


class Decomposed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def exodus(self, seed):
        """The whole file, and a file for each of two ranks."""
        if not shutil.which("ncgen"):
            self.skipTest("ncgen is not installed")
        model, _ = models.random_model(f"decomposed {seed}", sizes=(4, 5, 6))
        rng = random.Random(seed)
        owner = [rng.randrange(2) for _ in model.cells]
        paths = []
        for name, part in [("model.exo", model)] + [
                (f"model.exo.2.{rank}", part_of(model, owner, rank)) for rank in range(2)]:
            (self.folder / "model.cdl").write_text(exodus_models.exodus(part, together=True))
            paths.append(self.folder / name)
            subprocess.run(["ncgen", "-o", paths[-1], self.folder / "model.cdl"], check=True,
                           timeout=60)
        return [str(path) for path in paths]

    def foam(self):
        """A case that decomposePar has cut in two."""
        if not shutil.which("decomposePar"):
            self.skipTest("OpenFOAM is not installed")
        model, rng = models.random_model("decomposed foam", kind="hexahedra", sizes=(4, 5, 6))
        (self.folder / "case").mkdir()
        case = FoamCase(self.folder / "case")
        models.OpenFoam(model, rng).write(case.folder)
        case.write("system/decomposeParDict", "dictionary", DECOMPOSE)
        case.run("decomposePar")
        return str(case.folder / "case.foam")

    def run_cases(self, cases):
        (self.folder / "cases.json").write_text(json.dumps(cases))
        output = ranks_of_mpi.run(2, __file__, str(self.folder))
        self.assertNotIn("ERR|", output)
        self.assertIn("DONE", output)
        statuses = [line.split()[1:] for line in output.splitlines() if line.startswith("STATUS")]
        for case, (status, minimum, prescribed) in zip(cases, statuses):
            with self.subTest(case["name"]):
                serial = morphed(case, "whole")
                simple.UpdatePipeline(proxy=serial)
                self.assertEqual(status, serial.MorphStatus)
                self.assertEqual(status, "Valid")
                self.assertEqual(float(prescribed), serial.PrescribedPoints)
                self.assertAlmostEqual(float(minimum), serial.MinScaledJacobian, delta=1e-6)
                self.compare(case, serial)

    def compare(self, case, serial):
        """Every point of every block and set moves as that of the whole file."""
        dump = simple.ProgrammableFilter(Input=serial)
        dump.Script = f"NAME = {str(self.folder / (case['name'] + '_whole'))!r}\n" + LEAVES
        dump.UpdatePipeline()
        whole = np.load(self.folder / f"{case['name']}_whole_0.npy")
        size = np.linalg.norm(whole[:, :3].max(0) - whole[:, :3].min(0))
        parts = [np.load(self.folder / f"{case['name']}_{rank}.npy") for rank in range(2)]
        seen = np.zeros(len(whole), bool)
        for part in parts:
            self.assertGreater(np.count_nonzero(part[:, 6] == 0), 0, "a rank has no cells")
            distances = ((part[:, None, :3] - whole[None, :, :3])**2).sum(2)
            nearest = distances.argmin(1)
            self.assertLess(distances.min(1).max(), (1e-6 * size)**2)
            self.assertLess(abs(part[:, 3:6] - whole[nearest, 3:6]).max(),
                            case["tolerance"] * size)
            seen[(distances < (1e-6 * size)**2).any(0)] = True
        self.assertTrue(seen.all())
        self.assertGreater(abs(whole[:, 3:6]).max(), 0.04)

    def test_exodus(self):
        seed = int(os.environ.get("MORPH_TEST_SEED", "5"))
        print("seed", seed)
        whole, *parts = self.exodus(seed)
        readers = [name for name in ("IOSSReader", "ExodusIIReader") if hasattr(simple, name)]
        self.assertTrue(readers)
        self.run_cases([{"name": reader, "reader": reader, "whole": whole, "parts": parts,
                         "wall": "wall", "tolerance": 1e-8} for reader in readers])

    def test_openfoam(self):
        path = self.foam()
        self.run_cases([{"name": "foam", "reader": "OpenFOAMReader", "whole": path,
                         "parts": path, "wall": "wall", "tolerance": 1e-8}])


if __name__ == "__main__":
    if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]):
        job(sys.argv[1])
    else:
        unittest.main()
