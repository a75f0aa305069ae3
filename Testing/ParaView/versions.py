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

#: The fields of the box that can be dragged, as test scripts name them.
BOX_FIELDS = "" if MAJOR < 6 else "tabWidget/qt_tabwidget_stackedwidget/fieldsPage/"

#: Debian 13's ParaView 5.13 crashes when it opens its script editor, without this plugin, too.
HAS_SCRIPT_EDITOR = (MAJOR, MINOR) != (5, 13)

#: The toolbar of the plugin's filters, as test scripts name it.
TOOLBAR = ("" if (MAJOR, MINOR) < (5, 12) else "filters.") + "Mesh Morphing"

#: The file dialog of the plugin manager, as test scripts name it.
PLUGIN_FILE_DIALOG = "pqFileDialog" if (MAJOR, MINOR) < (5, 12) else "1pqFileDialog0"


def blocks_for_exodus(blocks):
    """A multi-block as the writer of Exodus files takes it."""
    return simple.ConvertToPartitionedDataSetCollection(Input=blocks) if MAJOR >= 6 else blocks


def traced(name, value):
    """A property's value as a state in Python has it."""
    return f"    {name}={value}," if MAJOR >= 6 else f".{name} = {value}"
