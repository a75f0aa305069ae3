# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on MPI ranks against morph-mesh on one, and the example MorphOnRanks.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_MORPH_MESH=<path of morph-mesh>
     MESHMORPHING_EXAMPLE=<path of morph-on-ranks> pvpython morph_mesh_ranks.py
"""
import os
import subprocess
import tempfile
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

import distributed
import ranks as ranks_of_mpi

PROGRAM = os.environ["MESHMORPHING_MORPH_MESH"]
FILES = 5


def morph_mesh(ranks, folder, *arguments):
    """Runs the program; returns its status and what it said."""
    command = [PROGRAM, *arguments]
    if ranks > 1:
        command = ranks_of_mpi.command(ranks, "true")[:-1] + command
    result = subprocess.run(command, cwd=folder, env=ranks_of_mpi.environment(),
                            capture_output=True, text=True, timeout=120)
    return result.returncode, result.stdout + result.stderr


def bend(path, moved):
    """The extracted boundary with its points moved; its arrays stay."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    boundary = reader.GetOutput()
    x = vtk_to_numpy(boundary.GetPoints().GetData()).copy()
    x += 0.2 * numpy.stack([numpy.sin(2 * x[:, 1]), x[:, 0] * x[:, 2], numpy.cos(3 * x[:, 0])], 1)
    boundary.GetPoints().SetData(numpy_to_vtk(x, deep=1))
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(moved)
    writer.SetInputData(boundary)
    writer.Write()


class MorphMeshOnRanks(unittest.TestCase):
    def compare(self, shape, sizes, seed, with_ids, *options):
        print("seed", seed)
        rng = numpy.random.default_rng(seed)
        points, cells = distributed.model(shape, sizes, seed)
        with tempfile.TemporaryDirectory() as folder:
            distributed.write_pieces(folder, "part", points, cells, shape,
                                     rng.integers(0, FILES, len(cells)), FILES, with_ids)
            status, said = morph_mesh(1, folder, "extract", "part.pvtu", "b.vtp")
            self.assertEqual(status, 0, said)
            bend(os.path.join(folder, "b.vtp"), os.path.join(folder, "moved.vtp"))
            reports = []
            for ranks in (1, 2, 3):
                os.mkdir(os.path.join(folder, f"on{ranks}"))
                status, said = morph_mesh(ranks, folder, *options, "part.pvtu", "moved.vtp",
                                          f"on{ranks}/part.pvtu")
                self.assertEqual(status, 0, said)
                reports.append([line for line in said.splitlines() if "inverted" in line])
                self.assertTrue(os.path.exists(os.path.join(folder, f"on{ranks}/part.pvtu")))
            self.assertEqual(reports[0], reports[1])
            self.assertEqual(reports[0], reports[2])
            size = numpy.linalg.norm(points.max(0) - points.min(0))
            for piece in range(FILES):
                places = [vtk_to_numpy(distributed.read(os.path.join(
                    folder, f"on{ranks}", f"part_{piece}.vtu")).GetPoints().GetData())
                          for ranks in (1, 2, 3)]
                self.assertLess(numpy.abs(places[0] - places[1]).max(), 1e-8 * size)
                self.assertLess(numpy.abs(places[0] - places[2]).max(), 1e-8 * size)

    def test_pieces_on_ranks(self):
        seed = int(os.environ.get("MORPH_TEST_SEED", "11"))
        self.compare(VTK_HEXAHEDRON, (7, 6, 5), seed, False, "--tolerance", "1e-12")
        self.compare(VTK_TETRA, (4, 4, 3), seed + 1, True, "--method", "LBWARP", "--tolerance",
                     "1e-12")

    def test_wrong_use(self):
        with tempfile.TemporaryDirectory() as folder:
            for arguments, expected in (
                    (("part.vtu", "moved.vtp", "out.vtu"), "reads a .pvtu and writes a .pvtu"),
                    (("extract", "part.pvtu", "b.vtp"), "needs one MPI rank"),
                    (("missing.pvtu", "moved.vtp", "out.pvtu"), "missing.pvtu")):
                status, said = morph_mesh(2, folder, *arguments)
                self.assertNotEqual(status, 0)
                self.assertIn(expected, said)

    def test_example(self):
        """The C++ example twists a mesh on two ranks as on one."""
        program = os.environ["MESHMORPHING_EXAMPLE"]
        rng = numpy.random.default_rng(5)
        points, cells = distributed.model(VTK_HEXAHEDRON, (6, 5, 4), 5)
        said = []
        with tempfile.TemporaryDirectory() as folder:
            for ranks in (1, 2):
                distributed.write_pieces(folder, f"part{ranks}", points, cells, VTK_HEXAHEDRON,
                                         rng.integers(0, ranks, len(cells)), ranks, True)
                command = ranks_of_mpi.command(ranks, "true")[:-1] + [
                    program, f"part{ranks}.pvtu", "20", f"twisted{ranks}.pvtu"]
                result = subprocess.run(command, cwd=folder, env=ranks_of_mpi.environment(),
                                        capture_output=True, text=True, timeout=120)
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                said.append(result.stdout)
                self.assertTrue(os.path.exists(os.path.join(folder, f"twisted{ranks}.pvtu")))
        self.assertEqual(said[0], said[1])
        self.assertIn("minimum scaled Jacobian", said[0])


if __name__ == "__main__":
    unittest.main()
