# SPDX-License-Identifier: BSD-3-Clause
"""Runs in ParaView's window (paraview --script): each time a state is saved, writes a line of JSON
on the properties panel to MORPH_ROWS, as panel_rows.cxx gives it in a dock of MORPH_DOCK pixels."""
import ctypes
import os

from paraview import servermanager

library = ctypes.CDLL(os.environ["MESHMORPHING_PANEL_ROWS"])
library.panel_rows.restype = ctypes.c_char_p


def write(*_):
    with open(os.environ["MORPH_ROWS"], "a", encoding="utf-8") as file:
        file.write(library.panel_rows(int(os.environ["MORPH_DOCK"])).decode() + "\n")


servermanager.ProxyManager().AddObserver("SaveStateEvent", write)
if "MORPH_SHOTS" in os.environ:
    import window_shots  # noqa: F401  (takes the pictures)
