# SPDX-License-Identifier: BSD-3-Clause
"""Runs in ParaView's window (paraview --script): makes the scene that MORPH_SCENE names, then
writes a line of JSON to MORPH_FRAMES for each picture: the outputs that are shown, with the sum of
their points' coordinates, the filter's properties and, with MORPH_COLORS, how many pixels have a
color of the boxes."""
import json
import os
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

# ParaView runs a script without the name of its file.
MESH = Path(os.environ["MORPH_SOURCE"]) / "Data/Models/small/bore_hex_small.vtu"
SHAPES = "coords + 0.1*coordsZ*iHat", "coords + 0.2*coordsX*kHat"
#: Of the lines of a box, in parts of the brightest: of a region, and of what moves it.
BOXES = {"blue": (0.3, 0.6, 1), "orange": (1, 0.6, 0.1)}
#: Names of properties that each line has.
WATCHED = {"box": ("LiveDrag", "Live", "Quality", "MinScaledJacobian", "MorphStatus"),
           "dent": ("LiveDrag", "Live", "Quality", "MinScaledJacobian", "MorphStatus",
                    "InvertedCells", "SurfaceInvertedCells"),
           "sliders": ("LiveDrag", "FindValidRanges", "Quality", "MinScaledJacobian",
                       "MorphStatus", "Weights", "ValidRanges")}


def scene(name, **more):
    """The filter of a scene, in this process."""
    if name == "dent":
        cube = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 6] * 3)])
        middle = simple.Calculator(Input=cube, ResultArrayName="Middle", Function=(
            "if(coordsX < 0.5, if((coordsY-3)^2 + (coordsZ-3)^2 < 2.5, 1, 0), 0)"))
        return MorphMesh(Input=middle, Moving="Array", MovingArray="Middle", **more)
    part = simple.OpenDataFile(str(MESH))
    if name == "box":
        return MorphMesh(Input=part, Surfaces=["Surface 1"], **more)
    if name == "region":
        part.UpdatePipeline()
        bounds = part.GetDataInformation().GetBounds()
        morph = MorphMesh(Input=part, Moving="Region", Region="Box", **more)
        morph.Region.Position = bounds[::2]
        morph.Region.Length = [b - a for a, b in zip(bounds[::2], bounds[1::2])]
        return morph
    boundary = ExtractMorphBoundary(Input=part)
    shapes = [simple.Calculator(Input=boundary, Function=function, CoordinateResults=1)
              for function in SHAPES]
    return MorphShapes(Input=part, Shapes=shapes, ShapeNames=["lean", "rise"], Weights=[0, 0.5],
                       **more)


def points(morph, port):
    """The sum of the coordinates of an output in this process."""
    data = morph.SMProxy.GetClientSideObject().GetOutputDataObject(port)
    found = data.GetPoints()
    return float(vtk_to_numpy(found.GetData()).sum()) if found else 0.


def bad_faces(morph):
    """How many faces of the output Surface have an inverted cell behind them."""
    faces = morph.SMProxy.GetClientSideObject().GetOutputDataObject(2)
    quality = faces.GetCellData().GetArray("ScaledJacobian")
    return int((vtk_to_numpy(quality) <= 0).sum())


def boxes(view):
    """How many pixels of the picture have a color of BOXES."""
    width, height = view.ViewSize
    pixels = vtkUnsignedCharArray()
    view.GetRenderWindow().GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels)
    colors = vtk_to_numpy(pixels).reshape(-1, 4)[:, :3].astype(float)
    return {name: int((abs(colors - 255 * np.array(color)).max(axis=1) < 40).sum())
            for name, color in BOXES.items()}


def main():
    name = os.environ["MORPH_SCENE"]
    view = simple.GetActiveViewOrCreate("RenderView")
    morph = scene(name, LiveDrag=1)
    simple.Show(morph, view)
    view.ResetCamera()
    simple.SetActiveSource(morph)
    frames = open(os.environ["MORPH_FRAMES"], "w", encoding="utf-8")

    def finished(*_):
        shown = {}
        for representation in view.Representations:
            source = getattr(representation, "Input", None)
            if source and representation.Visibility and source.SMProxy == morph.SMProxy:
                shown[source.Port] = points(morph, source.Port)
        line = {"shown": shown}
        if name == "dent" and "2" in map(str, shown):
            line["red"] = bad_faces(morph)
        if "MORPH_COLORS" in os.environ:
            line["boxes"] = boxes(view)
        for key in WATCHED.get(name, ()):
            value = getattr(morph, key)
            line[key] = (list(value) if key == "Weights" else
                         value if isinstance(value, (int, float)) else str(value).strip("'"))
        if name != "sliders":
            line["Position"] = list(morph.Transform.Translate)
        frames.write(json.dumps(line) + "\n")
        frames.flush()

    view.GetRenderWindow().AddObserver("EndEvent", finished)
    simple.Render(view)


if "MORPH_SCENE" in os.environ:
    if "MORPH_SHOTS" in os.environ:
        import window_shots  # noqa: F401  (takes the pictures)
    main()
