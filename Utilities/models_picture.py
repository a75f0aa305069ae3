# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the models: for each the small hexahedral and tetrahedral mesh, at its initial and
at its final shape, a color for each surface and dark lines for the curves.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        pvpython --force-offscreen-rendering Utilities/models_picture.py

Writes models-<name>.png into Documentation/images, or the directory given. Needs ImageMagick, and
neither plugin nor Gmsh."""

import colorsys
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from demo_picture import INK, OVERSAMPLING, average_pixels, kept, move, producer, text  # noqa: E402
import Models  # noqa: E402  (needs the path above)
from Models.model_mesh import add_array  # noqa: E402
from picture_arguments import fewer_colors, parse, picture_parser  # noqa: E402

WIDTH = 1600
TITLE, LABEL = 0.055, 0.05  # heights of heading and labels as fractions of the width
KINDS = (("hex", "Hexahedra"), ("tet", "Tetrahedra"))
SHAPES = ((0, "initial"), (1, "final"))


@dataclass
class Look:
    """azimuth, tilt: where the camera stands, degrees from -y towards x and above the horizon. cut:
    whether the half of the boundary in front of y = 0 is left out, so that one looks inside. rows:
    1 for all panels side by side, 2 for hexahedra over tetrahedra."""

    azimuth: float
    tilt: float
    cut: bool
    rows: int
    caption: str

    @property
    def axes(self):
        """(3, 3): the picture's right and up, and towards the camera."""
        turn, tilt = np.radians([self.azimuth, self.tilt])
        right = np.array([np.cos(turn), np.sin(turn), 0])
        back = np.array([np.sin(turn), -np.cos(turn), 0])
        toward = np.cos(tilt) * back + np.sin(tilt) * np.array([0, 0, 1])
        return np.stack([right, np.cross(toward, right), toward])


LOOKS = {
    "bore": Look(0, 22, True, 1,
                 "Bore: all radii grow, the countersink turns (front half cut away)"),
    "pipe": Look(0, 15, True, 1,
                 "Pipe: narrower and thinner, a wider elbow (front half cut away)"),
    "canister": Look(0, 42, False, 1, "Canister: the hole moves towards the wall"),
    "courier": Look(28, 38, False, 2, "Courier-like: eight lengths change by 15 to 30 %"),
}


@dataclass
class Panel:
    """One mesh at one shape. low, high: its extent along the picture's axes."""

    label: str
    faces: vtkPolyData
    curves: vtkPolyData
    low: np.ndarray
    high: np.ndarray


def kept_surface(data, cells):
    """The cells of these ids of a vtkPolyData, as vtkPolyData."""
    surface = vtkGeometryFilter()
    surface.SetInputData(kept(data, cells))
    surface.Update()
    return surface.GetOutput()


def paint(faces):
    """Adds a color for each surface: neighbors in the list of surfaces get hues far apart."""
    numbers = vtk_to_numpy(faces.GetCellData().GetArray("GeometryId"))
    table = [colorsys.hsv_to_rgb(0.58 + 0.382 * number % 1, 0.3, 0.97)
             for number in range(numbers.max() + 1)]
    add_array(faces.GetCellData(), "Color", np.round(255 * np.array(table)[numbers])
              .astype(np.uint8))


def make_panel(mesh, cell_name, t, state, look):
    faces, curves = mesh.boundary_to_vtk(t), mesh.curves_to_vtk(t)
    paint(faces)
    if look.cut:
        behind = mesh.points[mesh.faces].mean(axis=1)[:, 1] > 0
        faces = kept_surface(faces, np.flatnonzero(behind))
        behind = mesh.points[mesh.curve_edges()[0]].mean(axis=1)[:, 1] > 0
        curves = kept_surface(curves, np.flatnonzero(behind))
    extent = vtk_to_numpy(faces.GetPoints().GetData()) @ look.axes.T
    label = f"{cell_name}, {state}\n{len(mesh.points):,} nodes, {len(mesh.cells):,} cells"
    return Panel(label, faces, curves, extent.min(axis=0), extent.max(axis=0))


def save_picture(path, look, rows):
    """Writes a PNG: rows of panels, all at one scale. Needs a display (xvfb-run gives one)."""
    columns = list(zip(*rows))
    widths = [max(panel.high[0] - panel.low[0] for panel in column) for column in columns]
    heights = [max(panel.high[1] - panel.low[1] for panel in row) for row in rows]
    gap = 0.06 * sum(widths)
    total = sum(widths) + gap * (len(widths) + 1)
    rise = sum(heights) + total * (TITLE + LABEL * len(rows)) + gap * 0.5 * len(rows)
    pixels = [WIDTH, round(WIDTH * rise / total)]

    view = simple.CreateRenderView(ViewSize=pixels)
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    top = rise - total * TITLE
    text(view, look.caption, (gap / total, 1 - 0.7 * total * TITLE / rise), 26, bold=True)
    for row, height in zip(rows, heights):
        top -= total * LABEL
        left = gap
        for panel, width in zip(row, widths):
            text(view, panel.label, (left / total, (top + 0.008 * total) / rise), 16)
            corner = np.array([left + (width - panel.high[0] + panel.low[0]) / 2 - panel.low[0],
                               top - height - panel.low[1], 0])
            _show(view, panel, corner @ look.axes)
            left += width + gap
        top -= height + 0.5 * gap

    right, up, toward = look.axes
    focus = total / 2 * right + rise / 2 * up
    view.CameraFocalPoint = focus
    view.CameraPosition = focus + 10 * total * toward
    view.CameraViewUp = up
    view.CameraParallelScale = rise / 2
    simple.SaveScreenshot(str(path), view, ImageResolution=[OVERSAMPLING * n for n in pixels])
    average_pixels(path)
    fewer_colors(path)
    simple.Delete(view)


def _show(view, panel, shift):
    faces = simple.Show(producer(panel.faces), view, "GeometryRepresentation")
    faces.SetRepresentationType("Surface With Edges")
    faces.ColorArrayName = ["CELLS", "Color"]
    faces.MapScalars = 0
    faces.EdgeColor = [0.3, 0.31, 0.33]
    faces.LineWidth = 0.6
    faces.Ambient, faces.Diffuse, faces.Specular = 0.6, 0.42, 0.0
    curves = simple.Show(producer(panel.curves), view, "GeometryRepresentation")
    curves.ColorArrayName = ["POINTS", ""]
    curves.AmbientColor = curves.DiffuseColor = INK
    curves.LineWidth = 3
    curves.PointSize = 12
    curves.RenderPointsAsSpheres = 1
    for shown in (faces, curves):
        move(shown, shift)


def parse_arguments():
    parser = picture_parser(__doc__)
    parser.add_argument("models", nargs="*", metavar="MODEL", help="default: all")
    arguments = parse(parser)
    unknown = [name for name in arguments.models if name not in Models.NAMES]
    if unknown:
        parser.error(f"no model {', '.join(unknown)}: choose from {', '.join(Models.NAMES)}")
    return arguments


def main():
    arguments = parse_arguments()
    for name in arguments.models or Models.NAMES:
        look, model = LOOKS[name], Models.get(name)
        rows = []
        for kind, cell_name in KINDS:
            mesh = model.read_small(kind)
            rows.append([make_panel(mesh, cell_name, t, state, look) for t, state in SHAPES])
        if look.rows == 1:
            rows = [rows[0] + rows[1]]
        path = arguments.output / f"models-{name}.png"
        save_picture(path, look, rows)
        print(f"Written {path}")


if __name__ == "__main__":
    main()
