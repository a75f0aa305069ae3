# SPDX-License-Identifier: BSD-3-Clause
"""The plugin on both sides of a connection: pvserver morphs, this client sets properties and reads
the panel's numbers."""

import os
import socket
import subprocess
import time
import unittest

from paraview import simple

import ranks


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class ClientServer(unittest.TestCase):
    COMMAND = ["pvserver"]

    def setUp(self):
        port = free_port()
        self.server = subprocess.Popen(self.COMMAND + [f"--server-port={port}"],
                                       env=ranks.environment(), stdout=subprocess.DEVNULL)
        self.addCleanup(self.server.wait, 30)
        self.addCleanup(self.server.terminate)
        deadline = time.monotonic() + 60
        while True:
            with socket.socket() as probe:
                # The server ends with its first client, so the probe must not be one: it asks the
                # kernel whether the port is taken.
                try:
                    probe.bind(("localhost", port))
                except OSError:
                    break
            self.assertIsNone(self.server.poll(), "pvserver ended")
            self.assertLess(time.monotonic(), deadline, "pvserver does not listen")
            time.sleep(0.1)
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
