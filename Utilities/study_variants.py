#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simplex-linear and smoothing as the paper has them, beside ours: at S_F, by one absolute step, on
exact surfaces and the small meshes. Needs SciPy.

    pvpython Utilities/study_variants.py

Writes Documentation/Study/variants.csv, a row for each mesh, of minimum scaled Jacobians and
numbers of inverted cells: linear_*, our simplex-linear; ties_*, that of a tessellation whose ties
are divided as the numbering has it (Qhull's; of five numberings the lowest and the highest minimum,
and the most inverted cells); smoothing_*, ours; undeformed_*, smoothing that starts with the
interior where it was."""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from paraview import simple
from scipy.spatial import Delaunay
from vtkmodules.vtkCommonCore import vtkLogger

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
import Models  # noqa: E402  (needs the path above)
from demo_picture import producer  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from study_boundary import exact_positions  # noqa: E402
from study_checks import final, measured, quality  # noqa: E402
from study_mesh import study_mesh  # noqa: E402
from study_pieces import commit  # noqa: E402

DATA = ROOT / "Documentation/Study/variants.csv"
NUMBERINGS = 5


def worst(found):
    return float(found.min()), int((found <= 0).sum())


def moved_with_boundary(mesh):
    """(#nodes, 3): the boundary at S_F, the interior where it was."""
    points = mesh.points.copy()
    points[mesh.nodes] = exact_positions(mesh, [1])[0]
    return points


def by_numbering(mesh, seed):
    """(#nodes, 3): interior nodes by their barycentric coordinates in Delaunay's tetrahedra of the
    boundary nodes, whose ties Qhull divides by the order of the nodes: the order of `seed`."""
    points = moved_with_boundary(mesh)
    sites = mesh.nodes[np.random.default_rng(seed).permutation(len(mesh.nodes))]
    inside = np.setdiff1d(np.arange(len(points)), mesh.nodes)
    cells = Delaunay(mesh.points[sites])
    found = cells.find_simplex(mesh.points[inside], tol=1e-10)
    frames = cells.transform[found]
    if (found < 0).any() or np.isnan(frames).any():
        raise RuntimeError(f"{np.count_nonzero(found < 0)} nodes are in no tetrahedron")
    first = np.einsum("nij,nj->ni", frames[:, :3], mesh.points[inside] - frames[:, 3])
    weights = np.column_stack([first, 1 - first.sum(axis=1)])
    motion = (points - mesh.points)[sites[cells.simplices[found]]]
    points[inside] += np.einsum("nk,nkd->nd", weights, motion)
    return points


def from_the_undeformed(mesh):
    """(#cells,): scaled Jacobians after smoothing that starts with the interior where it was: that
    of the mesh whose boundary has moved, by a motion of zero."""
    start = producer(mesh.to_vtk(moved_with_boundary(mesh)))
    boundary = simple.ExtractMorphBoundary(Input=start)
    smoothed = simple.MorphSmoothing(Input=start, Boundary=boundary, Validity="None")
    smoothed.UpdatePipeline()
    found = quality(smoothed.GetClientSideObject().GetOutputDataObject(0)).copy()
    for proxy in (smoothed, boundary, start):
        simple.Delete(proxy)
    return found


def row(name, kind):
    mesh = study_mesh(name, kind, small=True)
    ties = [worst(measured(mesh.to_vtk(by_numbering(mesh, seed)))) for seed in range(NUMBERINGS)]
    values = (*worst(final("Simplex-linear", mesh, "absolute")[2]),
              min(one for one, _ in ties), max(one for one, _ in ties),
              max(count for _, count in ties),
              *worst(final("Smoothing", mesh, "absolute")[2]), *worst(from_the_undeformed(mesh)))
    return [name, kind, *(f"{value:.4f}" if isinstance(value, float) else value
                          for value in values), commit()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    add_plugin(parser)
    load_plugin(parser.parse_args().plugin)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    rows = [row(name, kind) for name in Models.NAMES for kind in ("hex", "tet")]
    with open(DATA, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["model", "kind", "linear_minimum", "linear_inverted", "ties_lowest",
                        "ties_highest", "ties_inverted", "smoothing_minimum",
                        "smoothing_inverted", "undeformed_minimum", "undeformed_inverted",
                        "commit"])
        table.writerows(rows)


if __name__ == "__main__":
    main()
