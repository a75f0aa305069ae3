# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts of the gallery share: meshes from NumPy's arrays, and a picture of "before" and
"after", side by side, from one camera and at one scale.

The plugin has to be loaded, as by PV_PLUGIN_PATH. Pictures need a display; xvfb-run gives one."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import (VTK_HEXAHEDRON, VTK_QUAD, VTK_TETRA, VTK_TRIANGLE,
                                           VTK_WEDGE, vtkCellArray, vtkUnstructuredGrid)
from vtkmodules.vtkFiltersCore import vtkCellCenters, vtkExtractCells
from vtkmodules.vtkImagingCore import vtkImageShrink3D
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter

WIDTH, HEIGHT = 1000, 520  # pixels: of the picture, and the most that meshes may take
OVERSAMPLING = 2  # thin edges: drawn at twice the size, then averaged
INK = [0.13, 0.14, 0.16]
TITLE, LABEL, LEGEND = 44, 44, 64  # pixels: the heights of these rows
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
WEDGES = np.array([(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)])  # of a hexahedron
TETRAHEDRA = np.array([(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6),
                       (0, 5, 1, 6)])  # of a hexahedron, around its diagonal


def block(*counts):
    """The unit square or cube in equal cells: points (n, 2 or 3), and ids of the corners of each
    quadrilateral or hexahedron (m, 4 or 8). counts: cells in each direction."""
    axes = [np.linspace(0, 1, count + 1) for count in counts]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(counts))
    ids = np.arange(len(points)).reshape([count + 1 for count in counts])
    corners = CORNERS[:2**len(counts), :len(counts)]
    return points, np.stack([ids[tuple(slice(first, first + count)
                                       for first, count in zip(corner, counts))].ravel()
                             for corner in corners], axis=1)


def joined(*parts):
    """One mesh of several: `parts` are points and cells each. Points nearer than about 1e-6 become
    one, and points of no cell are left out. Cells need the same number of corners."""
    points = np.concatenate([part[0] for part in parts])
    first = np.cumsum([0] + [len(part[0]) for part in parts[:-1]])
    cells = np.concatenate([part[1] + start for part, start in zip(parts, first)])
    _, kept, number = np.unique(points[cells.ravel()].round(6) + 0.0, axis=0, return_index=True,
                                return_inverse=True)
    return points[cells.ravel()[kept]], number.reshape(cells.shape)


def mesh(points, *cells, surfaces=(), arrays=()):
    """A source of ParaView with this mesh.

    points: (n, 2 or 3). cells: arrays (m, corners), each a pair of it and its VTK type.
    surfaces: names of surfaces with masks of their points, (n,). arrays: names and point arrays."""
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.pad(np.asarray(points, float),
                                       ((0, 0), (0, 3 - points.shape[1]))), deep=1))
    grid.SetPoints(places)
    corners, sizes, types = [], [], []
    for ids, kind in cells:
        corners.append(ids.ravel())
        sizes.append(np.full(len(ids), ids.shape[1]))
        types.append(np.full(len(ids), kind, np.uint8))
    array = vtkCellArray()
    array.SetData(numpy_to_vtkIdTypeArray(np.r_[0, np.cumsum(np.concatenate(sizes))], deep=1),
                  numpy_to_vtkIdTypeArray(np.concatenate(corners), deep=1))
    grid.SetCells(numpy_to_vtk(np.concatenate(types), deep=1), array)
    names = vtkStringArray()
    names.SetName("SurfaceNames")
    for name, mask in dict(surfaces).items():
        names.InsertNextValue(name)
    for name, values in {**dict(surfaces), **dict(arrays)}.items():
        values = numpy_to_vtk(np.asarray(values, float), deep=1)
        values.SetName(name)
        grid.GetPointData().AddArray(values)
    if surfaces:
        grid.GetFieldData().AddArray(names)
    return producer(grid)


def hexahedra(cells):
    return cells, VTK_HEXAHEDRON


def wedges(cells):
    """Two wedges for each hexahedron, whose third direction is that of the wedges' sides."""
    return cells[:, WEDGES].reshape(-1, 6), VTK_WEDGE


def tetrahedra(cells):
    """Six for each hexahedron."""
    return cells[:, TETRAHEDRA].reshape(-1, 4), VTK_TETRA


def quadrilaterals(cells):
    return cells, VTK_QUAD


def triangles(cells):
    """Two for each quadrilateral."""
    return cells[:, [(0, 1, 2), (0, 2, 3)]].reshape(-1, 3), VTK_TRIANGLE


def producer(data):
    """A source of ParaView that hands out this data object."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def points_of(source):
    """(n, 3): the points of a mesh."""
    return vtk_to_numpy(servermanager.Fetch(source).GetPoints().GetData()).astype(float)


@dataclass
class Example:
    """A mesh before and after a morph.

    title: what moves. before, after: sources of ParaView; `after` is a filter of the plugin.
    goal: (n, 3), where the nodes should be, NaN where nothing is prescribed; None: on the target
    of the filter. azimuth, tilt, shown: as for picture()."""

    title: str
    before: object
    after: object
    goal: np.ndarray = None
    azimuth: float = 30
    tilt: float = 25
    shown: Callable = None

    def row(self):
        """What the morph did: minima are of the scaled Jacobian."""
        self.after.UpdatePipeline()
        quality = [servermanager.filters.ScaledJacobian(Input=source)
                   for source in (self.before, self.after)]
        for measured in quality:
            measured.UpdatePipeline()
        return {"cells": self.before.GetDataInformation().GetNumberOfCells(),
                "method": self.after.Method.GetData(), "status": self.after.MorphStatus,
                "minimum_before": quality[0].MinScaledJacobian,
                "minimum_after": quality[1].MinScaledJacobian,
                "inverted_before": int(quality[0].InvertedCells),
                "inverted_after": int(quality[1].InvertedCells),
                "miss": self.miss()}

    def miss(self):
        """The largest distance of a node from where it should be, in the unit of the points."""
        if self.goal is None:
            return self.after.MaxTargetDistance
        distance = np.linalg.norm(points_of(self.after) - self.goal, axis=1)
        return distance[np.isfinite(distance)].max()

    def save(self, path):
        """Writes the picture."""
        picture(path, self.title, [("Before", self.before), ("After", self.after)], self.azimuth,
                self.tilt, self.shown)


def run(example):
    """The script as a program: it prints the row, and writes the picture to the file that its first
    argument names, or to a PNG of the script's name here."""
    for name, value in example.row().items():
        print(f"{name}: {value}")
    example.save(sys.argv[1] if len(sys.argv) > 1 else Path(sys.argv[0]).stem + ".png")


@dataclass
class Panel:
    """One mesh of a picture. low, high: its extent along the picture's axes."""

    label: str
    data: vtkUnstructuredGrid
    low: np.ndarray
    high: np.ndarray


def picture(path, title, meshes, azimuth=30, tilt=25, shown=None, color=None):
    """Writes a PNG, WIDTH pixels wide, of meshes side by side.

    title: text above them. meshes: pairs of a label and a source. azimuth, tilt: where the camera
    stands, degrees from -y towards x, and above the horizon. shown: of the cells' centers in the
    first mesh, (m, 3), which to show; default all. It holds for all meshes with as many cells.
    color: association, name and title of the array that colors the meshes; default: the scaled
    Jacobian, in the plugin's colors, with its minimum and the number of inverted cells."""
    axes = _axes(azimuth, tilt)
    panels, ids = [], None
    for label, source in meshes:
        data, note = _measured(source) if color is None else (servermanager.Fetch(source), "")
        if shown and not panels:
            ids = np.flatnonzero(shown(_centers(data)))
            count = data.GetNumberOfCells()
        if shown and data.GetNumberOfCells() == count:
            data = kept(data, ids)
        extent = vtk_to_numpy(data.GetPoints().GetData()) @ axes.T
        panels.append(Panel(label + note, data, extent.min(axis=0), extent.max(axis=0)))

    widths = [panel.high[0] - panel.low[0] for panel in panels]
    highest = max(panel.high[1] - panel.low[1] for panel in panels)
    filled = sum(widths) * (1 + 0.04 * (len(panels) + 1))
    total = max(filled, highest * WIDTH / HEIGHT)
    gap = (total - sum(widths)) / (len(panels) + 1)
    unit = total / WIDTH  # of a pixel
    height = round(highest / unit) + TITLE + LABEL + LEGEND + 20
    view = _view([WIDTH, height])
    text(view, title, (0.04, 1 - 0.75 * TITLE / height), 19, bold=True)
    colors = _colors(color, panels)
    left = gap
    for panel, width in zip(panels, widths):
        text(view, panel.label, (left / total, 1 - (TITLE + 0.95 * LABEL) / height), 14)
        # All stand on one line.
        corner = np.array([left - panel.low[0], (LEGEND + 10) * unit - panel.low[1], 0])
        _show(view, panel.data, corner @ axes, colors, color)
        left += width + gap
    _legend(view, colors, color and color[2], height)

    right, up, toward = axes
    focus = total / 2 * right + height * unit / 2 * up
    view.CameraFocalPoint, view.CameraViewUp = focus, up
    view.CameraPosition = focus + 10 * total * toward
    view.CameraParallelScale = height * unit / 2
    simple.SaveScreenshot(str(path), view, ImageResolution=[OVERSAMPLING * WIDTH,
                                                            OVERSAMPLING * height])
    simple.Delete(view)
    average_pixels(path)


def _axes(azimuth, tilt):
    """(3, 3): the picture's right and up, and towards the camera."""
    turn, tilt = np.radians([azimuth, tilt])
    right = np.array([np.cos(turn), np.sin(turn), 0])
    back = np.array([np.sin(turn), -np.cos(turn), 0])
    toward = np.cos(tilt) * back + np.sin(tilt) * np.array([0, 0, 1])
    return np.stack([right, np.cross(toward, right), toward])


def _measured(source):
    """The mesh with its scaled Jacobian, and what to say of it."""
    # A surface, too, becomes an unstructured grid.
    quality = servermanager.filters.ScaledJacobian(Input=simple.AppendDatasets(Input=[source]))
    quality.UpdatePipeline()
    return servermanager.Fetch(quality), (f": minimum {quality.MinScaledJacobian:.3f}\n"
                                          f"{quality.InvertedCells:.0f} inverted cells")


def _centers(data):
    centers = vtkCellCenters()
    centers.SetInputData(data)
    centers.Update()
    return vtk_to_numpy(centers.GetOutput().GetPoints().GetData())


def kept(data, cells):
    """The cells of these ids, as a mesh."""
    ids = vtkIdList()
    for cell in cells:
        ids.InsertNextId(int(cell))
    extract = vtkExtractCells()
    extract.SetInputData(data)
    extract.SetCellList(ids)
    extract.Update()
    return extract.GetOutput()


def _view(size):
    view = simple.CreateRenderView(ViewSize=size)
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    return view


def _show(view, data, shift, colors, color):
    shown = simple.Show(producer(data), view)
    shown.SetRepresentationType("Surface With Edges")
    # simple.ColorBy would fit the range to the data, and so move the colors' break away from 0.
    shown.ColorArrayName = list(color[:2] if color else ("CELLS", "ScaledJacobian"))
    shown.LookupTable = colors
    move(shown, shift)
    shown.EdgeColor = INK
    shown.LineWidth = 0.6
    shown.Ambient, shown.Diffuse, shown.Specular = 0.45, 0.6, 0.0
    shown.InterpolateScalarsBeforeMapping = 0


def move(shown, shift):
    """Shows a representation elsewhere: since ParaView 5.12 its Position is its Translation."""
    setattr(shown, "Translation" if hasattr(shown, "Translation") else "Position", list(shift))


def _colors(color, panels):
    """The plugin's colors of the scaled Jacobian, or colors of which none means bad, over the range
    of the array in all panels."""
    colors = simple.GetColorTransferFunction(color[1] if color else "ScaledJacobian")
    if color:
        ranges = []
        for panel in panels:
            data = panel.data.GetPointData() if color[0] == "POINTS" else panel.data.GetCellData()
            array = data.GetArray(color[1])
            ranges.append(array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0))
        colors.ApplyPreset("Viridis (matplotlib)", True)
        colors.RescaleTransferFunction(min(low for low, _ in ranges),
                                       max(high for _, high in ranges))
    return colors


def text(view, words, lower_left, size, bold=False):
    """Words in the view; `lower_left`: their place as fractions of its width and height."""
    shown = simple.Show(simple.Text(Text=words), view)
    shown.WindowLocation = "Any Location"
    shown.Position = list(lower_left)
    shown.Justification = "Left"
    shown.FontSize, shown.Bold, shown.Color = size, int(bold), INK


def _legend(view, colors, title, height):
    bar = simple.GetScalarBar(colors, view)
    bar.Title = title or "scaled Jacobian (below 0: inverted)"
    bar.ComponentTitle = ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.25, 8 / height]
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.5, 12
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize = bar.LabelFontSize = 13
    bar.AddRangeLabels = int(title is not None)
    bar.RangeLabelFormat = "%.3g"
    if title is None:
        bar.UseCustomLabels, bar.CustomLabels = 1, [-1, -0.5, 0, 0.5, 1]
    bar.Visibility = 1


def average_pixels(path):
    """Replaces the PNG by one of 1 / OVERSAMPLING of its size."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    shrink = vtkImageShrink3D()
    shrink.SetInputConnection(reader.GetOutputPort())
    shrink.SetShrinkFactors(OVERSAMPLING, OVERSAMPLING, 1)
    shrink.MeanOn()
    shrink.Update()  # reads the file to its end before the writer opens it
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(shrink.GetOutputPort())
    writer.Write()
