# SPDX-License-Identifier: BSD-3-Clause
"""Errors of pvbatch on two MPI ranks: one each, on both ranks, without a deadlock; and a mesh that
is on one of them. distributed.py compares meshes on both with one rank.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython two_ranks.py
The same file is the job that the ranks run:
mpiexec -n 2 pvbatch two_ranks.py CASE FILE
"""
import os
import sys
import tempfile
import unittest

from paraview import simple
from paraview.simple import (AppendDatasets, LoadPlugin, PointDatatoCellData, ProgrammableFilter,
                             Transform, Wavelet, XMLUnstructuredGridReader)

import ranks

HAS_MPI = os.environ.get("MESHMORPHING_HAS_MPI") == "1"

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())


def distributed(_):
    """Wavelet gives each rank a piece."""
    grid = AppendDatasets(Input=[Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8])])
    grid.UpdatePipeline()
    return grid


def one_rank(path):
    """A file of one piece is read by rank 0."""
    return XMLUnstructuredGridReader(FileName=[path])


def job(case, path):
    grid = one_rank(path) if case in ("one_rank", "later_error") else distributed(path)
    if case == "invalid_rank":
        grid = ProgrammableFilter(Input=grid, CopyArrays=1, Script=INVALID_ON_RANK_1)
    moved = Transform(Input=ExtractMorphBoundary(Input=grid))
    moved.Transform.Scale = [2, 1, 1]
    if case == "copy":
        # Its boundary is the mesh, moved.
        moved = Transform(Input=grid)
        moved.Transform.Scale = [2, 1, 1]
        extracted = ExtractMorphBoundary(Input=grid)
        extracted.UpdatePipeline()
        print("BOUNDARY", extracted.GetDataInformation().GetNumberOfPoints(), flush=True)
    method = MorphSmoothing if case == "smoothing" else MorphFEMWARP
    morph = method(Input=grid, Boundary=moved)
    if case == "smoothed":
        morph.PostSmooth = 1
    if case == "later_error":
        morph.BoundaryIdArray = "Nowhere"
    # A filter that follows must neither hang nor get half a result.
    last = PointDatatoCellData(Input=MorphFEMWARP(Input=morph, Boundary=moved)
                               if case == "later_error" else morph)
    last.UpdatePipeline()
    info = morph.GetDataInformation()
    bounds = [round(b, 6) for b in info.GetBounds()] if info.GetNumberOfPoints() else None
    print("RESULT", info.GetNumberOfPoints(), bounds, flush=True)


INVALID_ON_RANK_1 = """
from vtkmodules.vtkParallelCore import vtkMultiProcessController
copy = self.GetUnstructuredGridOutput()
copy.DeepCopy(self.GetUnstructuredGridInput())
if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 1:
    copy.GetPoints().SetPoint(7, float('nan'), 0, 0)
"""


class TwoRanks(unittest.TestCase):
    def run_ranks(self, case):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "grid.vtu")
            grid = distributed(None)
            # Debian's expat cannot read raw appended data back.
            simple.SaveData(path, proxy=grid, DataMode="Binary")
            return ranks.run(2, __file__, case, path, timeout=120)

    @unittest.skipIf(HAS_MPI, "this build morphs meshes on several ranks")
    def test_without_mpi_cells_on_both_ranks_are_one_error_each_filter(self):
        output = self.run_ranks("copy")
        self.assertEqual(output.count("distributed over 2 MPI ranks"), 2, output)
        self.assertIn("BOUNDARY 0", output)
        self.assertRegex(output, r"RESULT \d+ \[0.0, 8.0, 0.0, 8.0, 0.0, 8.0\]")

    @unittest.skipUnless(HAS_MPI, "this build has no MPI")
    def test_a_moved_copy_of_both_pieces_is_a_boundary(self):
        output = self.run_ranks("copy")
        self.assertNotIn("ERR|", output)
        # 386 nodes are on the surface; each of the two pieces has those on the cut.
        self.assertIn("BOUNDARY 418", output)
        self.assertRegex(output, r"RESULT \d+ \[0.0, 16.0, 0.0, 8.0, 0.0, 8.0\]")

    @unittest.skipUnless(HAS_MPI, "this build has no MPI")
    def test_smoothing_works(self):
        output = self.run_ranks("smoothing")
        self.assertNotIn("ERR|", output)
        self.assertRegex(output, r"RESULT \d+ \[0.0, 16.0, 0.0, 8.0, 0.0, 8.0\]")

    @unittest.skipUnless(HAS_MPI, "this build has no MPI")
    def test_post_smooth_works(self):
        output = self.run_ranks("smoothed")
        self.assertNotIn("ERR|", output)
        self.assertRegex(output, r"RESULT \d+ \[0.0, 16.0, 0.0, 8.0, 0.0, 8.0\]")

    @unittest.skipUnless(HAS_MPI, "this build has no MPI")
    def test_an_invalid_mesh_on_one_rank_ends_both(self):
        output = self.run_ranks("invalid_rank")
        # Of Extract Morph Boundary and of the morph.
        self.assertEqual(output.count("not finite"), 2, output)
        self.assertIn("RESULT", output)

    def test_cells_on_one_rank_are_morphed(self):
        output = self.run_ranks("one_rank")
        self.assertNotIn("ERR|", output)
        self.assertIn("RESULT 729 [0.0, 16.0, 0.0, 8.0, 0.0, 8.0]",
                      output)

    def test_an_error_on_one_rank_ends_both(self):
        output = self.run_ranks("later_error")
        self.assertEqual(output.count("`BoundaryIdArray` names 'Nowhere'"), 1, output)
        self.assertIn("RESULT 729 [0.0, 8.0, 0.0, 8.0, 0.0, 8.0]", output)


if __name__ == "__main__":
    if len(sys.argv) > 2:
        job(*sys.argv[1:])
    else:
        unittest.main()
