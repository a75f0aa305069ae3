# SPDX-License-Identifier: BSD-3-Clause
"""The plugin where it is installed: ParaView lists and loads it by itself, without LoadPlugin().

Run: PV_PLUGIN_PATH=<prefix>/lib/paraview-<version>/plugins pvpython installed_plugin.py
"""
import os
import unittest

from paraview import servermanager, simple


class InstalledPlugin(unittest.TestCase):
    def test_it_is_listed_loaded_and_works(self):
        manager = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
        plugins = manager.GetLocalInformation()
        names = [plugins.GetPluginName(i) for i in range(plugins.GetNumberOfPlugins())]
        self.assertEqual(names.count("MeshMorphing"), 1, names)
        index = names.index("MeshMorphing")
        self.assertTrue(plugins.GetPluginLoaded(index))
        folders = os.environ.get("PV_PLUGIN_PATH", "/usr/bin/plugins").split(":")
        self.assertIn(os.path.dirname(os.path.dirname(plugins.GetPluginFileName(index))), folders)

        part = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 4, 0, 4, 0, 4])])
        boundary = simple.ExtractMorphBoundary(Input=part)
        moved = simple.Transform(Input=boundary, Transform="Transform")
        moved.Transform.Scale = [2, 1, 1]
        morph = simple.MorphFEMWARP(Input=part, Boundary=moved)
        morph.UpdatePipeline()
        morph.UpdatePropertyInformation()
        self.assertEqual(morph.InvertedCells, 0)
        self.assertAlmostEqual(morph.GetDataInformation().GetBounds()[1], 8, delta=1e-5)


if __name__ == "__main__":
    unittest.main()
