# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of what Classify Boundary finds and of what Morph Boundary does, on small models.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        pvpython --force-offscreen-rendering Utilities/boundary_picture.py

Writes classify-boundary.png and morph-boundary.png into Documentation/images, or the directory
given. Needs the plugin and ImageMagick; not Gmsh."""

import sys
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from demo_picture import producer  # noqa: E402  (needs the path above)
import Models  # noqa: E402
from Models.model_mesh import add_array  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from models_folds import MovedSurfaces, output  # noqa: E402
from models_picture import Look, Panel, paint, save_picture  # noqa: E402
from picture_arguments import parse, picture_parser  # noqa: E402

RED = (214, 39, 40)


def panel(label, faces, curves, look):
    extent = vtk_to_numpy(faces.GetPoints().GetData()) @ look.axes.T
    return Panel(label, faces, curves, extent.min(axis=0), extent.max(axis=0))


def classified(name, kind, title, look, **options):
    """A panel of one model's boundary as Classify Boundary parts it."""
    mesh = Models.get(name).read_small(kind)
    classify = simple.ClassifyBoundary(Input=producer(mesh.to_vtk()), **options)
    classify.UpdatePipeline()
    classify.UpdatePropertyInformation()
    faces = output(classify, 1)
    paint(faces)
    numbers = [int(classify.GetProperty(f"NumberOf{what.capitalize()}").GetData())
               for what in ("surfaces", "curves", "vertices")]
    found = "{} surfaces, {} curves, {} vertices".format(*(number or "no" for number in numbers))
    return panel(f"{title}\n{found}", faces, output(classify, 2), look)


def classify_picture(path):
    look = Look(28, 38, False, 1,
                "Classify Boundary: surfaces (colors), curves (lines) and vertices (dots)")
    save_picture(path, look, [[
        # By more than 25 degrees the small mesh turns within its bores, too.
        classified("courier", "tet", "Courier-like part, by feature angle", look,
                   UseGeometryArrays=0, FeatureAngle=40),
        classified("pipe", "hex", "Pipe, by feature angle", look, UseGeometryArrays=0),
        classified("pipe", "hex", "Pipe, by the ids in its file", look)]])


def moved(mesh, title, look, method, target=None):
    """A panel of the boundary that Morph Boundary makes of exact final curves, folded faces in
    red."""
    surfaces = MovedSurfaces(mesh, method)
    if target:
        surfaces.filter.Target = target
    surfaces.move_to(1)
    faces = output(surfaces.filter)
    return folds_panel(title, faces, mesh.curves_to_vtk(1), look)


def folds_panel(title, faces, curves, look):
    paint(faces)
    colors = vtk_to_numpy(faces.GetCellData().GetArray("Color")).copy()
    quality = faces.GetCellData().GetArray("ScaledJacobian")
    folded = vtk_to_numpy(quality) <= 0 if quality else np.zeros(len(colors), bool)
    colors[folded] = RED
    add_array(faces.GetCellData(), "Color", colors)
    number = np.count_nonzero(folded)
    return panel(f"{title}\n{number if number else 'no'} folded faces", faces, curves, look)


def morph_picture(path):
    look = Look(0, 52, False, 1,
                "Morph Boundary: surfaces follow the curves of the canister's hole (red: folded)")
    mesh = Models.get("canister").read_small("hex")
    target = producer(mesh.boundary_to_vtk(1))
    save_picture(path, look, [[
        folds_panel("Before", mesh.boundary_to_vtk(0), mesh.curves_to_vtk(0), look),
        moved(mesh, "Weighted residual", look, "Weighted residual"),
        moved(mesh, "Smoothing", look, "Smoothing"),
        moved(mesh, "Weighted residual, onto a target", look, "Weighted residual", target)]])


def main():
    parser = picture_parser(__doc__)
    add_plugin(parser)
    arguments = parse(parser)
    load_plugin(arguments.plugin)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # the filter warns of folded faces
    for name, draw in (("classify-boundary", classify_picture), ("morph-boundary", morph_picture)):
        path = arguments.output / f"{name}.png"
        draw(path)
        print(f"Written {path}")


if __name__ == "__main__":
    main()
