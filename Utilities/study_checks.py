#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Experiments that support the reading of the study's results in Documentation/Study.md. They take
some minutes, most of it Gmsh's.

    pvpython Utilities/study_checks.py > Documentation/Study/checks.txt

Prints what each explanation predicts and what is measured: why LBWARP is the same in relative and
absolute steps, where and when FEMWARP inverts cells on the canister and on the pipe, what a mere
stretch does to hexahedra and tetrahedra, what quality the boundary allows, and where smoothing
fails."""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
import Models  # noqa: E402  (needs the path above)
from demo_picture import producer  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from study_boundary import Boundaries, exact_positions, quality_limit, times  # noqa: E402
from study_mesh import study_mesh  # noqa: E402
from study_paper import STEPS  # noqa: E402
from study_pieces import commit  # noqa: E402
from study_series import SeriesRun  # noqa: E402


def quality(grid):
    return vtk_to_numpy(grid.GetCellData().GetArray("ScaledJacobian"))


def measured(grid):
    """(#cells,): scaled Jacobians of a vtkUnstructuredGrid."""
    source = producer(grid)
    measure = simple.ScaledJacobian(Input=source)
    measure.UpdatePipeline()
    found = quality(measure.GetClientSideObject().GetOutputDataObject(0)).copy()
    simple.Delete(measure)
    simple.Delete(source)
    return found


def morph(method, mesh, stepping, last=STEPS):
    """Yields (Step, grid) of steps on exact surfaces: the last alone for absolute ones."""
    ts = times(mesh.model, STEPS)
    positions = exact_positions(mesh, ts)
    none_lost = [np.array([], int)] * len(ts)
    run = SeriesRun(method, mesh, Boundaries(positions, none_lost), ts, stepping, os.cpu_count())
    for number in [last] if stepping == "absolute" else range(last + 1):
        yield run.step(number), run.mesh()
    run.remove()


def final(method, mesh, stepping, last=STEPS):
    """(minimum scaled Jacobian, (#nodes, 3) points, (#cells,) scaled Jacobians) of the last step.
    """
    for step, grid in morph(method, mesh, stepping, last):
        result = step.minimum, vtk_to_numpy(grid.GetPoints().GetData()).copy(), quality(grid).copy()
    return result


def jittered(mesh, share):
    """Moves the interior nodes at random by up to `share` of the mean edge."""
    inside = np.setdiff1d(np.arange(len(mesh.points)), mesh.nodes)
    points = mesh.points.copy()
    points[inside] += np.random.default_rng(1).uniform(-1, 1, (len(inside), 3)) * share * edge(mesh)
    mesh.points = points
    return mesh


def edge(mesh):
    ends = mesh.points[mesh.cells[:, :2]]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean()


def check_steppings():
    """LBWARP should end in relative steps where it ends in absolute ones; the others should not.

    LBWARP's weights are the mean where a node is the center of its neighbors, and affinely so
    everywhere. The morph keeps means of neighbors, so the next relative step finds the same
    weights."""
    print("Relative against absolute steps: small bore, hexahedra, S_F\n"
          "  interior        method             absolute  relative  nodes apart, edges")
    for share in (0, 0.15):
        mesh = jittered(study_mesh("bore", "hex", small=True), share)
        for method in ("LBWARP", "FEMWARP", "Simplex-linear", "Weighted residual"):
            (absolute, a, _), (relative, b, _) = (
                final(method, mesh, stepping) for stepping in ("absolute", "relative"))
            apart = np.linalg.norm(a - b, axis=1).max() / edge(mesh)
            name = f"jittered {share}" if share else "as made"
            print(f"  {name:15} {method:18} {absolute:8.4f}  {relative:8.4f}  {apart:8.3f}")


def check_canister():
    """The harmonic displacement around a hole crushes the cells next to the hole before t = 1.

    Around a hole of radius r in a cylinder of radius R it falls as the logarithm of the distance.
    The cells next to the hole, h thick, are crushed on the side that the hole moves to when
    t D ln(1 + h/r) / ln(R/r) = h, D = 0.5. A displacement that is linear in the gap, as that of
    simplex-linear is, lasts until t D = R - r."""
    mesh = study_mesh("canister", "hex", small=True)
    hole, rim, travel = 0.25, 1, 0.5
    radius = np.linalg.norm(mesh.points[:, :2], axis=1)
    rings = np.unique(radius.round(6))
    thick = rings[1] - rings[0]
    crushed = thick * np.log(rim / hole) / (travel * np.log(1 + thick / hole))
    print(f"\nCanister, hexahedra, absolute: cells at the hole {thick:.4f} thick; the logarithm "
          f"crushes them at t = {crushed:.3f} (thinner ones from "
          f"{hole * np.log(rim / hole) / travel:.3f} on), a linear displacement at "
          f"{(rim - hole) / travel:.2f}")
    for method in ("FEMWARP", "Simplex-linear"):
        last = len(times(mesh.model, STEPS))
        for number in range(last):
            _, _, found = final(method, mesh, "absolute", number)
            bad = mesh.cells[found <= 0]
            if len(bad):
                break
        if not len(bad):
            print(f"  {method}: no inverted cell up to t = {(last - 1) / STEPS:.2f}")
            continue
        centers = mesh.points[bad].mean(axis=1)
        inner = int((radius[bad].min(axis=1) < rings[0] + 1e-6).sum())
        angle = np.degrees(np.abs(np.arctan2(centers[:, 1], centers[:, 0]))).max()
        print(f"  {method}: first at t = {number / STEPS:.2f}, {len(bad)} cells, of which {inner} "
              f"at the hole, within {angle:.0f} degrees of the way it moves")


def check_pipe():
    """FEMWARP's worst cells should lie at the joints of straight and elbow.

    There the stretch along the pipe changes at once, and a harmonic displacement rounds that off
    inside the wall."""
    mesh = study_mesh("pipe", "hex", small=False)
    print("\nPipe, hexahedra, absolute, S_F")
    joints = np.array([[0, 0, 4.54], [3, 0, 7.54]])
    axes = np.array([[0, 0, 1.0], [1.0, 0, 0]])
    for method in ("FEMWARP", "LBWARP", "Simplex-linear"):
        minimum, _, found = final(method, mesh, "absolute")
        worst = mesh.points[mesh.cells[np.argsort(found)[:40]]].mean(axis=1)
        away = np.abs(np.einsum("nd,jd->nj", worst, axes)
                      - np.sum(joints * axes, axis=1)).min(axis=1)
        print(f"  {method}: minimum {minimum:.3f}; the 40 worst cells are up to {away.max():.2f} "
              f"from a joint's plane, whose cells are 0.17 long; "
              f"{int((found < 0.9).sum())} cells of {len(found)} below 0.9")


def check_stretch():
    """An affine stretch along the cells' own axes leaves a hexahedron's scaled Jacobian as it is,
    but not a tetrahedron's."""
    print("\nSmall bore stretched along its axis, minimum and mean scaled Jacobian")
    for kind in ("hex", "tet"):
        mesh = study_mesh("bore", kind, small=True)
        line = []
        for factor in (1, 2, 3):
            found = measured(mesh.to_vtk(mesh.points * [1, 1, factor]))
            line.append(f"x{factor}: {found.min():.3f}, {found.mean():.3f}")
        print(f"  {kind}: {'; '.join(line)}")


def check_limits():
    """What the boundary alone leaves possible: no mesh has a higher minimum scaled Jacobian than a
    corner whose nodes are all prescribed."""
    print("\nMinimum scaled Jacobian that the boundary allows at S_F, exact surfaces, meshes of "
          "the paper's size")
    for name in Models.NAMES:
        line = []
        for kind in ("hex", "tet"):
            mesh = study_mesh(name, kind, small=False)
            line.append(f"{kind} {quality_limit(mesh, exact_positions(mesh, [1])[0]):.4f}")
        print(f"  {name}: {'; '.join(line)}")


def check_smoothing():
    """Smoothing should fail where the boundary passes through several layers of cells.

    It starts from the affine map nearest to the boundary's motion, and has to untangle what the
    boundary passes through beside that."""
    print("\nSmoothing, hexahedra, absolute, small meshes: inverted cells with the boundary moved "
          "alone, and after smoothing")
    for name in ("bore", "pipe"):
        mesh = study_mesh(name, "hex", small=True)
        for t in (0.05, 0.25, 0.5, 0.75, 1):
            start = measured(mesh.to_vtk(mesh.moved(t)))
            way = np.linalg.norm(mesh.moved(t) - mesh.points, axis=1).max() / edge(mesh)
            _, _, found = final("Smoothing", mesh, "absolute", round(t * STEPS))
            print(f"  {name} t = {t:.2f}: boundary moved by up to {way:.1f} edges; "
                  f"{int((start <= 0).sum())} of {len(start)}, then {int((found <= 0).sum())}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    add_plugin(parser)
    load_plugin(parser.parse_args().plugin)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    print(f"Sources: {commit()}\n")
    check_steppings()
    check_canister()
    check_pipe()
    check_stretch()
    check_limits()
    check_smoothing()


if __name__ == "__main__":
    main()
