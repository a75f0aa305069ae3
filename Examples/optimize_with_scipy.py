# SPDX-License-Identifier: BSD-3-Clause
"""Finds four design variables of a hole from the positions of all nodes of the mesh, with SciPy and
the adjoint: its change of radius, its shift along x and y, and its twist along z.

The objective is J = 1/2 sum |x - x_measured|^2 over the nodes of the volume. Its derivatives with
respect to them are x - x_measured. The adjoint turns these into derivatives with respect to the
displacements of the hole, and the chain rule into those of the design. So an iteration costs two
solves, whatever the number of variables. What was "measured" is a mesh with a hidden design.

Run: python3 optimize_with_scipy.py [Data/Models/small/bore_hex_small.vtu]
"""
import sys
from pathlib import Path

import meshio
import meshmorphing as mm
import numpy
from scipy.optimize import minimize

BORE = Path(__file__).resolve().parent.parent / "Data/Models/small/bore_hex_small.vtu"
part = meshio.read(sys.argv[1] if len(sys.argv) > 1 else BORE)
mesh = mm.Mesh(part.points, part.cells)
# By area, the largest surface is the outside, which stays; the next is the hole.
outside, hole = sorted(mesh.surfaces(), key=lambda surface: -surface.area)[:2]
nodes = numpy.concatenate([hole.nodes, numpy.setdiff1d(outside.nodes, hole.nodes)])
count = len(hole.nodes)
# The nodes of the end faces follow, in their planes.
prepared = mm.FEMWARP().prepare(mesh, nodes, fix_unnamed_boundary=False)
x, y, z = mesh.points[hole.nodes].T
radius, height = numpy.hypot(x, y), z / z.max()


def displacements(design):
    """Of all nodes, and of the hole's their derivatives with respect to each variable."""
    grow, along_x, along_y, twist = design
    angle, factor = twist * height, 1 + grow / radius
    turned = numpy.array([numpy.cos(angle) * x - numpy.sin(angle) * y,
                          numpy.sin(angle) * x + numpy.cos(angle) * y])
    one, zero = numpy.ones(count), numpy.zeros(count)
    motion = numpy.zeros((len(nodes), 3))
    motion[:count, 0] = factor * turned[0] + along_x - x
    motion[:count, 1] = factor * turned[1] + along_y - y
    across = height * factor
    slopes = numpy.array([[turned[0] / radius, turned[1] / radius, zero], [one, zero, zero],
                          [zero, one, zero], [-across * turned[1], across * turned[0], zero]])
    return motion, slopes.transpose(0, 2, 1)


def objective(design):
    motion, slopes = displacements(design)
    misfit = prepared.evaluate(motion) - measured
    gradient = prepared.adjoint(misfit)[:count]
    return (misfit**2).sum() / 2, (slopes * gradient).sum(axis=(1, 2))


hidden = numpy.array([-0.2, 0.15, -0.1, 0.3])
measured = prepared.evaluate(displacements(hidden)[0])
found = minimize(objective, numpy.zeros(4), jac=True, method="BFGS", options={"gtol": 1e-6})
quality = mm.quality(mesh, prepared.evaluate(displacements(found.x)[0]))
print("hidden:", *hidden)
print("found: ", *found.x.round(8))
print(f"{found.nfev} evaluations, misfit {found.fun:.1e}, minimum scaled Jacobian "
      f"{quality.minimum:.3f}, inverted cells {quality.inverted}")
if quality.inverted:
    raise SystemExit("The mesh is not valid.")
