# SPDX-License-Identifier: BSD-3-Clause
"""Runs in ParaView's window (paraview --script): takes a picture of the screen each time a state is
saved. MORPH_SHOTS has the paths of the pictures in their order, without extension."""
import os
import subprocess

from paraview import servermanager, simple

paths = os.environ.get("MORPH_SHOTS", "").split("\n")


def take(*_):
    """What is on the screen, after the window has drawn what is due."""
    if not paths or not paths[0]:
        return
    view = simple.GetActiveView()
    interactor = view.GetInteractor() if view and hasattr(view, "GetInteractor") else None
    for _ in range(3 if interactor else 0):
        interactor.ProcessEvents()
    subprocess.run(["import", "-window", "root", paths.pop(0) + ".png"], check=False)


servermanager.ProxyManager().AddObserver("SaveStateEvent", take)
