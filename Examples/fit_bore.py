# SPDX-License-Identifier: BSD-3-Clause
"""Gradient descent with the adjoint of a morph: fits the boundary of the bore to a target shape.
The target is known by the positions of all nodes of the target mesh.

The objective is an integral over the volume, J = 1/2 integral |x - x_target|^2 dV: a sum over the
nodes of the mesh, each weighted by the volume that belongs to it. Its derivatives with respect to
all nodes have a closed form. MorphAdjoint turns them into derivatives with respect to the
boundary's points, which are the unknowns. J is quadratic in the unknowns, so the best step along
the gradient is known too: an iteration morphs twice and applies the adjoint once.

Run: pvpython fit_bore.py <MeshMorphing.so> <Data/Models/small/bore_hex_small.vtu>
         [--iterations 20] [--method FEMWARP]
"""
import argparse

import numpy
from paraview import servermanager, simple
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import vtk_to_numpy

parser = argparse.ArgumentParser()
parser.add_argument("plugin")
parser.add_argument("model")
parser.add_argument("--iterations", type=int, default=20)
parser.add_argument("--method", default="FEMWARP")
arguments = parser.parse_args()
simple.LoadPlugin(arguments.plugin, remote=False, ns=globals())


class Given:
    """A source whose data this script sets.

    The data are a copy of `template` with other points or another array."""

    def __init__(self, template):
        self.template = template
        self.proxy = simple.TrivialProducer()
        self.set(template.Points)

    def set(self, points, **arrays):
        data = self.template.VTKObject.NewInstance()
        data.DeepCopy(self.template.VTKObject)
        data = WrapDataObject(data)
        data.Points = numpy.ascontiguousarray(points)
        for name, values in arrays.items():
            data.PointData.append(numpy.ascontiguousarray(values), name)
        self.proxy.GetClientSideObject().SetOutput(data.VTKObject)
        self.proxy.MarkModified(self.proxy)


def result_of(proxy):
    proxy.UpdatePipeline()
    return WrapDataObject(servermanager.Fetch(proxy))


def node_volumes(grid):
    """An equal share of each of its cells."""
    volumes = numpy.array(result_of(simple.CellSize(Input=part)).CellData["Volume"])
    cells = grid.VTKObject.GetCells()
    sizes = numpy.diff(vtk_to_numpy(cells.GetOffsetsArray()))
    shares = numpy.repeat(volumes / sizes, sizes)
    nodes_of_cells = vtk_to_numpy(cells.GetConnectivityArray())
    return numpy.bincount(nodes_of_cells, shares, grid.GetNumberOfPoints())[:, None]


part = simple.XMLUnstructuredGridReader(FileName=[arguments.model])
rest = result_of(part)
start = result_of(ExtractMorphBoundary(Input=part))              # knows which nodes it is
volume = node_volumes(rest)

boundary = Given(start)
morph = globals()["Morph" + arguments.method](Input=part, Boundary=boundary.proxy,
                                              OutputPointsPrecision="Double")
derivatives = Given(rest)
derivatives.set(rest.Points, dJdx=numpy.zeros(rest.Points.shape))
adjoint = MorphAdjoint(Input=part, Boundary=boundary.proxy, Gradient=derivatives.proxy,
                       GradientArray="dJdx", Morph=morph)


def nodes(points):
    """The mesh for a boundary at `points`."""
    boundary.set(points)
    result = result_of(morph)
    if morph.MorphStatus not in ("Valid", "Inverted"):  # "Failed": the error has been printed
        raise SystemExit(f"no mesh for this boundary: {morph.MorphStatus}")
    return numpy.array(result.Points)


def objective(points):
    return 0.5 * (volume * (nodes(points) - target) ** 2).sum()


def gradient(points):
    derivatives.set(rest.Points, dJdx=volume * (nodes(points) - target))
    return numpy.array(result_of(adjoint).PointData["MorphGradient"])


goal = start.Points + start.PointData["FinalDisplacement"]       # to be found
target = nodes(goal)
x = numpy.array(start.Points, dtype=float)

# The gradient against central differences through the pipeline, in a random direction.
direction = numpy.random.default_rng(1).normal(size=x.shape)
difference = (objective(x + 1e-3 * direction) - objective(x - 1e-3 * direction)) / 2e-3
exact = (gradient(x) * direction).sum()
print(f"derivative: adjoint {exact:.10g}, central difference {difference:.10g}, "
      f"relative error {abs(exact / difference - 1):.1e}")

for iteration in range(arguments.iterations + 1):
    at = nodes(x)
    J = 0.5 * (volume * (at - target) ** 2).sum()
    error = abs(x - goal).max()
    print(f"iteration {iteration:2d}: objective {J:.4e}, "
          f"largest distance to the target boundary {error:.2e}")
    descent = -gradient(x)
    change = nodes(x + descent) - at                             # linear in the boundary
    x = x + (descent ** 2).sum() / (volume * change ** 2).sum() * descent
