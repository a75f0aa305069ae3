# SPDX-License-Identifier: BSD-3-Clause
"""An animated picture of two weights of Morph Shapes, moved on the canister one after the other and
together: a GIF under 2 MB, with a slider for each weight below the mesh.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -a -s "-screen 0 1280x1024x24" \\
         pvpython --force-offscreen-rendering Utilities/shapes_animation.py <canister_hex_small.vtu>
         <picture.gif> [--frames 36]
Needs ImageMagick's convert.
"""
import argparse
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from paraview import simple

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

SIZE = (560, 400)
LEFT, STEP = 120, 230  # pixels: where the sliders begin
MOST_BYTES = 2_000_000
SHAPES = {"shift": "coords + 1.2*FinalDisplacement",
          "bulge": "coords + 0.3*sin(1.428*coordsZ)*(coordsX*iHat + coordsY*jHat)"}


def weights_at(fraction):
    """The first weight goes up and down, then the second, then both."""
    def hill(first, last):
        inside = min(max((fraction - first) / (last - first), 0), 1)
        return math.sin(math.pi * inside) ** 2
    return hill(0, 1 / 3) + hill(2 / 3, 1), hill(1 / 3, 2 / 3) + hill(2 / 3, 1)


def slider_arguments(weights):
    """What convert draws below the mesh."""
    arguments = ["-fill", "#212429"]
    for i, weight in enumerate(weights):
        x, y, length = LEFT + STEP * i, SIZE[1] - 22, 130
        arguments += ["-draw", f"roundrectangle {x},{y - 2} {x + length},{y + 2} 2,2",
                      "-draw", f"circle {x + weight * length},{y} {x + weight * length + 7},{y}"]
    return arguments


def canister_view(path):
    """The blend and a view of its surface."""
    part = simple.XMLUnstructuredGridReader(FileName=[path])
    boundary = ExtractMorphBoundary(Input=part)
    shapes = [simple.Calculator(Input=boundary, Function=function, CoordinateResults=1)
              for function in SHAPES.values()]
    blend = MorphShapes(Input=part, Shapes=shapes, ShapeNames=list(SHAPES), Weights=[1, 1],
                        FindValidRanges=0)
    view = simple.CreateRenderView(ViewSize=list(SIZE))
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    display = simple.Show(simple.OutputPort(blend, "Surface"), view)
    simple.ColorBy(display, ("CELLS", "ScaledJacobian"))
    display.SetRepresentationType("Surface With Edges")
    display.SetScalarBarVisibility(view, False)
    display.EdgeColor, display.Specular = [0.13, 0.14, 0.16], 0
    display.Ambient, display.Diffuse = 0.4, 0.65
    for i, name in enumerate(SHAPES):
        text = simple.Show(simple.Text(Text=name), view)
        text.WindowLocation = "Any Location"
        text.Position = [(LEFT + STEP * i - 55) / SIZE[0], 13 / SIZE[1]]
        text.Color, text.FontSize = [0.13, 0.14, 0.16], 15
    view.CameraPosition, view.CameraFocalPoint = [2.6, -4.6, 5.0], [0.1, 0, 0.95]
    view.CameraViewUp = [0, 0, 1]
    return blend, view


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("picture")
    parser.add_argument("--frames", type=int, default=36)
    options = parser.parse_args()
    blend, view = canister_view(options.model)
    with tempfile.TemporaryDirectory() as folder:
        frames = []
        for frame in range(options.frames):
            weights = weights_at(frame / options.frames)
            blend.Weights = list(weights)
            frames.append(str(Path(folder, f"{frame:03}.png")))
            simple.SaveScreenshot(frames[-1], view)
            subprocess.run(["convert", frames[-1], *slider_arguments(weights), frames[-1]],
                           check=True)
        subprocess.run(["convert", "-delay", "7", "-loop", "0", *frames, "-colors", "64",
                        options.picture], check=True)
    size = os.path.getsize(options.picture)
    print(f"{options.picture}: {size:,} bytes, {options.frames} frames")
    if size > MOST_BYTES:
        sys.exit(f"larger than {MOST_BYTES:,} bytes: take fewer frames")


if __name__ == "__main__":
    main()
