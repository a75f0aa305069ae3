# SPDX-License-Identifier: BSD-3-Clause
"""Fits the weights of three shapes of the bore to a target volume and a target position of its
hole, with SciPy's optimizer and the adjoint of Morph Shapes.

The shapes widen the hole, shift it, and stretch the part. The objective is the sum of squares of
two relative errors: of the part's volume, and of the mean position of the hole's nodes. Its
derivatives with respect to all nodes have a closed form. MorphAdjoint turns them into derivatives
with respect to the three weights, at the cost of one pass over the nodes.

Run: pvpython fit_shapes.py <MeshMorphing.so> <Data/Models/small/bore_hex_small.vtu>
"""
import argparse

import numpy
from paraview import servermanager, simple
from scipy.optimize import minimize
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import vtk_to_numpy

parser = argparse.ArgumentParser()
parser.add_argument("plugin")
parser.add_argument("model")
arguments = parser.parse_args()
simple.LoadPlugin(arguments.plugin, remote=False, ns=globals())

TARGET = numpy.array([0.6, -0.8, 0.4])  # the weights that are to be found
# Hexahedra in six tetrahedra round a diagonal: exact where faces are plane.
TETRAHEDRA = numpy.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6],
                          [0, 5, 1, 6]])


def result_of(proxy):
    proxy.UpdatePipeline()
    return WrapDataObject(servermanager.Fetch(proxy))


part = simple.XMLUnstructuredGridReader(FileName=[arguments.model])
rest = result_of(part)
boundary = result_of(ExtractMorphBoundary(Input=part))
places = numpy.array(boundary.Points)
# The wall inside is a surface of its own; the fade is 1 there, and 0 on the wall outside.
radius = numpy.hypot(places[:, 0], places[:, 1])
outer = radius.max()
fade = numpy.clip((outer - radius) / (outer - radius.min()), 0, 1)
is_inner = numpy.zeros(len(places), dtype=bool)
for end in numpy.unique(places[:, 2].round(6)):
    ring = (abs(places[:, 2] - end) < 1e-5) & (radius < outer - 0.1)
    is_inner |= ring & (radius < radius[ring].min(initial=numpy.inf) + 1e-5)
hole = numpy.array(boundary.PointData["MorphPointId"])[is_inner]


def shape(function):
    """A displaced boundary. `function`: from positions to displacements."""
    data = boundary.VTKObject.NewInstance()
    data.DeepCopy(boundary.VTKObject)
    data = WrapDataObject(data)
    data.Points = numpy.ascontiguousarray(places + function(places))
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data.VTKObject)
    return source


axial = numpy.array([0, 0, 1])
wide = shape(lambda x: 0.2 * fade[:, None] * x * (1 - axial) / radius[:, None])
shift = shape(lambda x: 0.2 * fade[:, None] * numpy.array([1, 0, 0]))
long = shape(lambda x: 0.1 * x * axial)
blend = MorphShapes(Input=part, Shapes=[wide, shift, long], ShapeNames=["wide", "shift", "long"],
                    OutputPointsPrecision="Double", FindValidRanges=0)

cells = vtk_to_numpy(rest.VTKObject.GetCells().GetConnectivityArray()).reshape(-1, 8)
tetrahedra = cells[:, TETRAHEDRA].reshape(-1, 4)


def volume_of(points):
    """The mesh's volume and its derivatives with respect to the nodes."""
    a, b, c, d = (points[tetrahedra[:, i]] for i in range(4))
    faces = {1: numpy.cross(c - a, d - a), 2: numpy.cross(d - a, b - a),
             3: numpy.cross(b - a, c - a)}
    gradient = numpy.zeros_like(points)
    for corner, vector in faces.items():
        numpy.add.at(gradient, tetrahedra[:, corner], vector / 6)
        numpy.add.at(gradient, tetrahedra[:, 0], -vector / 6)
    return ((b - a) * faces[1]).sum() / 6, gradient


def points_at(weights):
    blend.Weights = list(weights)
    result = result_of(blend)
    if blend.MorphStatus not in ("Valid", "Inverted"):  # "Failed": the error has been printed
        raise SystemExit(f"no mesh for these weights: {blend.MorphStatus}")
    return numpy.array(result.Points)


goal = points_at(TARGET)
goal_volume, goal_position = volume_of(goal)[0], goal[hole].mean(axis=0)
derivatives = simple.TrivialProducer()


def objective(weights):
    """The objective and its derivatives with respect to the weights."""
    points = points_at(weights)
    volume, volume_gradient = volume_of(points)
    error = volume / goal_volume - 1
    distance = points[hole].mean(axis=0) - goal_position
    gradient = 2 * error / goal_volume * volume_gradient
    gradient[hole] += 2 * distance / len(hole)
    data = rest.VTKObject.NewInstance()
    data.DeepCopy(rest.VTKObject)
    WrapDataObject(data).PointData.append(numpy.ascontiguousarray(gradient), "dJdx")
    derivatives.GetClientSideObject().SetOutput(data)
    derivatives.MarkModified(derivatives)
    adjoint.MarkModified(adjoint)
    found = result_of(adjoint).VTKObject.GetFieldData().GetArray("ShapeGradient")
    return error ** 2 + (distance ** 2).sum(), vtk_to_numpy(found).copy()


derivatives.GetClientSideObject().SetOutput(rest.VTKObject)
adjoint = MorphAdjoint(Input=part, Gradient=derivatives, GradientArray="dJdx", MorphShapes=blend)

start = numpy.zeros(3)
_, exact = objective(start + 0.1)
for i in range(3):
    step = 1e-4 * numpy.eye(3)[i]
    difference = (objective(start + 0.1 + step)[0] - objective(start + 0.1 - step)[0]) / 2e-4
    print(f"derivative by weight {i}: adjoint {exact[i]:.8g}, central difference "
          f"{difference:.8g}, relative error {abs(exact[i] / difference - 1):.1e}")
print(f"at the start: objective {objective(start)[0]:.3e}")
found = minimize(objective, start, jac=True, method="BFGS",
                 options={"gtol": 1e-9, "maxiter": 15})
blend.UpdatePropertyInformation()
print(f"after {found.nit} iterations: objective {found.fun:.3e}, weights "
      + " ".join(f"{weight:.4f}" for weight in found.x)
      + f", target {' '.join(map(str, TARGET))}, largest error {abs(found.x - TARGET).max():.1e}")
print(f"displacement fields solved: {int(blend.SolveCount)}; mesh {blend.MorphStatus}")
