# SPDX-License-Identifier: BSD-3-Clause
"""How many pictures a second a drag in ParaView makes: the box of Morph Mesh is dragged with
the mouse for five seconds, with Live Drag on. A picture counts where its points differ from the
last one's. Needs xdotool.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -a -s "-screen 0 1280x1024x24" \\
         python3 Utilities/benchmark_window.py [--cells 50] [--seconds 5] [--surroundings Fade]
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SIZE = 1280, 1000  # of ParaView's window, whose view is at its lower right
BORDER = 12, 36    # beside and below the view


def scene():
    """Runs in ParaView (--script): the mesh, Morph Mesh, and a line for each picture."""
    sys.path.insert(0, os.environ["MORPH_UTILITIES"])
    import benchmark_live
    from paraview import simple
    from vtkmodules.util.numpy_support import vtk_to_numpy
    part = simple.TrivialProducer()
    part.GetClientSideObject().SetOutput(benchmark_live.cube(int(os.environ["MORPH_CELLS"])))
    part.UpdatePipeline()
    view = simple.GetActiveViewOrCreate("RenderView")
    morph = benchmark_live.MorphMesh(Input=part, Surfaces=["Surface 0"], LiveDrag=1,
                                     Surroundings=os.environ["MORPH_SURROUNDINGS"])
    simple.Show(morph, view)
    view.ResetCamera()
    simple.SetActiveSource(morph)
    lines = open(os.environ["MORPH_FRAMES"], "w", encoding="utf-8")

    def finished(*_):
        surface = morph.SMProxy.GetClientSideObject().GetOutputDataObject(2)
        points = surface.GetPoints()
        line = {"time": time.perf_counter(), "view": list(view.ViewSize),
                "sum": float(vtk_to_numpy(points.GetData()).sum()) if points else 0}
        lines.write(json.dumps(line) + "\n")
        lines.flush()

    view.GetRenderWindow().AddObserver("EndEvent", finished)
    simple.Render(view)


def settings(home):
    """No welcome, and a window of SIZE at the corner of the screen."""
    version = subprocess.run(["paraview", "--version"], capture_output=True, text=True, check=True,
                             env={**os.environ, "QT_QPA_PLATFORM": "offscreen"}).stdout.split()[-1]
    name = "ParaView.ini" if version.startswith("6") else f"ParaView{version}.ini"
    file = home / ".config/ParaView" / name
    file.parent.mkdir(parents=True)
    file.write_text("[General]\nGeneralSettings.ShowWelcomeDialog=false\n[MainWindow]\n"
                    f"Size=@Size({SIZE[0]} {SIZE[1]})\nPosition=@Point(0 0)\n", encoding="utf-8")
    home.chmod(0o700)


def read(frames):
    if not frames.exists():
        return []
    return [json.loads(line) for line in frames.read_text(encoding="utf-8").splitlines()]


def drag(seconds, view):
    """With the middle button, which moves the box as a whole; at most 200 steps a second."""
    x, y = (SIZE[axis] - BORDER[axis] - view[axis] // 2 for axis in (0, 1))
    xdotool = ["xdotool"]
    subprocess.run([*xdotool, "mousemove", str(x), str(y), "mousedown", "2"], check=True)
    end, step = time.perf_counter() + seconds, 0
    while time.perf_counter() < end:
        step += 1
        side = 1 if step // 100 % 2 == 0 else -1
        subprocess.run([*xdotool, "mousemove_relative", "--", str(side), "0"], check=True)
        time.sleep(0.005)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=50, help="cells along an edge of the cube")
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--surroundings", default="Fade", choices=("Stay", "Follow", "Fade"))
    parser.add_argument("--screenshot", help="a file for a picture of the screen at the end")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        settings(home)
        frames = home / "frames.jsonl"
        environment = {**os.environ, "HOME": name, "XDG_RUNTIME_DIR": name,
                       "DASHBOARD_TEST_FROM_CTEST": "1", "MORPH_FRAMES": str(frames),
                       "MORPH_UTILITIES": str(Path(__file__).resolve().parent),
                       "MORPH_SCENE": "1", "MORPH_CELLS": str(options.cells),
                       "MORPH_SURROUNDINGS": options.surroundings}
        with open(home / "log", "w", encoding="utf-8") as log, \
             subprocess.Popen(["paraview", f"--script={Path(__file__).resolve()}"], cwd=home,
                              env=environment, stdout=log, stderr=log) as paraview:
            try:
                start = time.perf_counter()
                while not read(frames):
                    if paraview.poll() is not None or time.perf_counter() - start > 120:
                        sys.exit("ParaView shows nothing:\n" + (home / "log").read_text())
                    time.sleep(0.5)
                time.sleep(5)  # the window settles
                before = read(frames)
                drag(options.seconds, before[-1]["view"])
                if options.screenshot:
                    subprocess.run(["import", "-window", "root", options.screenshot], check=True)
                shown = read(frames)[len(before):]
            finally:
                paraview.kill()
    changed = [frame for last, frame in zip([before[-1], *shown], shown)
               if frame["sum"] != last["sum"]]
    if len(changed) < 2:
        sys.exit(f"The drag moved nothing: {len(shown)} pictures, {len(changed)} of them new.")
    between = [b["time"] - a["time"] for a, b in zip(changed, changed[1:])]
    print(f"{(options.cells + 1) ** 3:,} nodes, {options.surroundings}: {len(changed)} pictures in "
          f"{options.seconds:g} s, median {1e3 * statistics.median(between):.0f} ms between them")


if "MORPH_SCENE" in os.environ:
    scene()
elif __name__ == "__main__":
    main()
