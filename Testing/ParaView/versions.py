# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView 5.11, 5.13 and 6.1 call differently, for the tests."""
from paraview import simple
from paraview.servermanager import vtkSMProxyManager

MAJOR, MINOR = vtkSMProxyManager.GetVersionMajor(), vtkSMProxyManager.GetVersionMinor()
PATCH = vtkSMProxyManager.GetVersionPatch()

#: Numbers points and cells.
number_points = simple.PointAndCellIds if MAJOR >= 6 else simple.GenerateIds

#: The window's settings, in the user's folder .config/ParaView.
SETTINGS = "ParaView.ini" if MAJOR >= 6 else f"ParaView{MAJOR}.{MINOR}.{PATCH}.ini"

#: The file dialog of the plugin manager, as test scripts name it.
PLUGIN_FILE_DIALOG = "pqFileDialog" if (MAJOR, MINOR) < (5, 12) else "1pqFileDialog0"
