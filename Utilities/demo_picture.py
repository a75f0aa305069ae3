# SPDX-License-Identifier: BSD-3-Clause
"""The demo's picture: meshes cut open and side by side at one scale, colored by scaled Jacobian in
the colors that the plugin gives to arrays of that name."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "Examples/gallery"))
from gallery import (INK, OVERSAMPLING, average_pixels, kept, move,  # noqa: E402
                     producer, text)  # (needs the path above)

SIZE = (1600, 860)
GAP = 1 / 30  # between panels, of the sum of their widths


@dataclass
class Panel:
    """title, note: text over the mesh. grid: vtkUnstructuredGrid with cell array ScaledJacobian.
    cells: ids shown."""

    title: str
    note: str
    grid: vtkUnstructuredGrid
    cells: np.ndarray


def save_picture(path, heading, panels, tilt=22):
    """Writes a PNG of SIZE pixels with the panels from left to right, seen from the front and
    `tilt` degrees above it. Needs a display (xvfb-run gives one)."""
    view = simple.CreateRenderView(ViewSize=list(SIZE))
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1

    sources = [_extract(panel) for panel in panels]
    bounds = [source.GetDataInformation().GetBounds() for source in sources]
    widths = [b[1] - b[0] for b in bounds]
    gap = GAP * sum(widths)
    total = sum(widths) + gap * (len(panels) + 1)
    left = gap
    for panel, source, bound, width in zip(panels, sources, bounds, widths):
        _show(view, source, left - bound[0])
        text(view, panel.title, (left / total, 0.86), 18, bold=True)
        text(view, panel.note, (left / total, 0.80), 14)
        left += width + gap
    text(view, heading, (gap / total, 0.925), 24, bold=True)
    _color_bar(view)
    _look(view, total, bounds, np.radians(tilt))

    simple.SaveScreenshot(str(path), view, ImageResolution=[OVERSAMPLING * side for side in SIZE])
    average_pixels(path)


def _extract(panel):
    return producer(kept(panel.grid, panel.cells))


def _show(view, source, shift):
    shown = simple.Show(source, view, "UnstructuredGridRepresentation")
    # The active cell scalars color the mesh. simple.ColorBy would fit the colors' range to the data
    # and so move their break away from 0.
    shown.SetRepresentationType("Surface With Edges")
    move(shown, [shift, 0, 0])
    shown.EdgeColor = INK
    shown.LineWidth = 0.6
    shown.Ambient, shown.Diffuse, shown.Specular = 0.45, 0.6, 0.0
    shown.InterpolateScalarsBeforeMapping = 0


def _color_bar(view):
    colors = simple.GetColorTransferFunction("ScaledJacobian")
    bar = simple.GetScalarBar(colors, view)
    bar.Title = "scaled Jacobian (below 0: inverted)"
    bar.ComponentTitle = ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.25, 0.04]
    bar.ScalarBarLength = 0.5
    bar.ScalarBarThickness = 18
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize = bar.LabelFontSize = 16
    bar.AddRangeLabels = 0
    bar.UseCustomLabels = 1
    bar.CustomLabels = [-1, -0.5, 0, 0.5, 1]
    bar.Visibility = 1


def _look(view, total, bounds, tilt):
    """So wide that the panels fill the view, all at the same scale."""
    height = total * SIZE[1] / SIZE[0]
    up = np.array([0, np.sin(tilt), np.cos(tilt)])
    middle = np.array([total / 2, 0, (min(b[4] for b in bounds) + max(b[5] for b in bounds)) / 2])
    focus = middle + 0.055 * height * up  # the text needs more room than the color bar
    view.CameraFocalPoint = focus
    view.CameraPosition = focus + 100 * np.array([0, -np.cos(tilt), np.sin(tilt)])
    view.CameraViewUp = up
    view.CameraParallelScale = 0.5 * height
