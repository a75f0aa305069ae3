# SPDX-License-Identifier: BSD-3-Clause
"""Runs in ParaView's window (paraview --script): each time a state is saved, writes a line of JSON
on the properties panel to MORPH_ROWS, as panel_rows.cxx gives it in a dock of MORPH_DOCK pixels, of
which 0 leaves it as it is.
"ghosts" are the bounds of what the active view shows translucent, and no pipeline has."""
import ctypes
import json
import os

from paraview import servermanager, simple

library = ctypes.CDLL(os.environ["MESHMORPHING_PANEL_ROWS"])
library.panel_rows.restype = ctypes.c_char_p


def ghosts():
    hidden = simple.GetActiveView().SMProxy.GetProperty("HiddenRepresentations")
    shown = [hidden.GetProxy(i) for i in range(hidden.GetNumberOfProxies())]
    sources = [one.GetProperty("Input").GetProxy(0) for one in shown
               if one.GetProperty("Input") and one.GetProperty("Opacity").GetElement(0) < 1]
    bounds = [[0] * 6 for _ in sources]
    for source, six in zip(sources, bounds):
        servermanager.Fetch(servermanager._getPyProxy(source)).GetCellsBounds(six)
    return bounds


def write(*_):
    panel = json.loads(library.panel_rows(int(os.environ["MORPH_DOCK"])).decode())
    panel["ghosts"] = ghosts()
    with open(os.environ["MORPH_ROWS"], "a", encoding="utf-8") as file:
        file.write(json.dumps(panel) + "\n")


servermanager.ProxyManager().AddObserver("SaveStateEvent", write)
if "MORPH_SHOTS" in os.environ:
    import window_shots  # noqa: F401  (takes the pictures)
