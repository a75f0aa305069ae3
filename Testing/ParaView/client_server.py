# SPDX-License-Identifier: BSD-3-Clause
"""The plugin on both sides of a connection: pvserver morphs, this client sets properties and reads
the panel's numbers."""

import os
import unittest

from paraview import simple

import ranks


class ClientServer(unittest.TestCase):
    COMMAND = ["pvserver"]

    def setUp(self):
        server, port = ranks.start_server(self.COMMAND)
        self.addCleanup(server.wait, 30)
        self.addCleanup(server.terminate)
        simple.Connect("localhost", port)
        self.addCleanup(simple.Disconnect)

    def test_the_server_morphs(self):
        plugin = os.environ["MESHMORPHING_PLUGIN"]
        simple.LoadPlugin(plugin, remote=False)
        simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
        grid = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 4, 0, 4, 0, 4])])
        boundary = simple.ExtractMorphBoundary(Input=grid)
        moved = simple.Calculator(Input=boundary, CoordinateResults=1, Function="coords*1.5")
        morph = simple.MorphFEMWARP(Input=grid, Boundary=moved)
        morph.UpdatePipeline()
        morph.UpdatePropertyInformation()
        self.assertEqual(morph.GetDataInformation().GetNumberOfCells(), 64)
        for axis in range(3):
            self.assertAlmostEqual(morph.GetDataInformation().GetBounds()[2 * axis + 1], 6, 9)
        self.assertEqual(morph.InvertedCells, 0)
        self.assertAlmostEqual(morph.MinScaledJacobian, 1, 9)


@unittest.skipUnless(os.environ.get("MESHMORPHING_HAS_MPI") == "1", "this build has no MPI")
class ClientServerOnTwoRanks(ClientServer):
    """The wavelet gives each rank a piece."""
    COMMAND = ranks.command(2, "pvserver")


if __name__ == "__main__":
    unittest.main()
