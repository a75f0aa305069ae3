# SPDX-License-Identifier: BSD-3-Clause
"""Runs one series of the study: a model's mesh, morphed by one method to one boundary after the
other."""

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

from demo_picture import producer
from Models.model_mesh import vtk_points
from study_records import Step

#: Proxies of the methods, with their default options. In the order of the figures.
METHODS = {
    "Smoothing": "MorphSmoothing",
    "Weighted residual": "MorphWeightedResidual",
    "FEMWARP": "MorphFEMWARP",
    "LBWARP": "MorphLBWARP",
    "Simplex-linear": "MorphSimplexLinear",
    "Simplex-natural neighbor": "MorphSimplexNaturalNeighbor",
    "Radial basis": "MorphRadialBasis",
    "Inversion-free": "MorphInversionFree",
}

#: How many of a step's inverted cells are named.
NAMED_CELLS = 20


class BoundarySource(VTKPythonAlgorithmBase):
    """The boundary of a mesh at positions (n, #boundary nodes, 3) that follow one another at times
    0, 1, 2, ..."""

    def __init__(self, mesh, positions):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._rest, self._positions = mesh.boundary_to_vtk(0), positions

    def RequestInformation(self, request, inputs, outputs):
        info, last = outputs.GetInformationObject(0), len(self._positions) - 1
        info.Set(Pipeline.TIME_STEPS(), [float(step) for step in range(last + 1)], last + 1)
        info.Set(Pipeline.TIME_RANGE(), [0.0, float(last)], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        info = outputs.GetInformationObject(0)
        step = info.Get(Pipeline.UPDATE_TIME_STEP()) if info.Has(Pipeline.UPDATE_TIME_STEP()) else 0
        output = vtkPolyData.GetData(info)
        output.ShallowCopy(self._rest)
        output.SetPoints(vtk_points(self._positions[int(step)]))
        output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), step)
        return 1


class SeriesRun:
    """A method at work on a mesh.

    `boundaries`: Boundaries at times `ts`; `stepping`: "absolute" or "relative"; `threads`: 1 or
    more; `commit`: of the sources."""

    def __init__(self, method, mesh, boundaries, ts, stepping, threads, commit=""):
        self._ts, self._lost = ts, boundaries.lost
        self._commit = commit
        self._rest, self._boundary = producer(mesh.to_vtk()), producer(mesh.boundary_to_vtk(0))
        self._source = BoundarySource(mesh, boundaries.positions)
        self._proxy = getattr(simple, METHODS[method])(Input=self._rest, Boundary=self._boundary)
        self._proxy.Validity = "None"
        self._proxy.Stepping = stepping.capitalize()
        self._proxy.NumberOfThreads = threads
        self._proxy.UpdateVTKObjects()
        # ParaView's TimeKeeper has no part in this: the source hangs on the filter itself.
        self._filter = self._proxy.GetClientSideObject()
        self._filter.SetInputConnection(1, self._source.GetOutputPort())

    def step(self, number):
        """The Step of that number. Relative steps before it that were not asked for are computed
        first. Raises RuntimeError where the method gives no mesh."""
        self._filter.UpdateTimeStep(float(number))
        output = self.mesh()
        field = output.GetFieldData()
        if field.GetAbstractArray("MorphStatus").GetValue(0) == "Failed":
            raise RuntimeError(f"no mesh at step {number}")

        def value(name):
            return field.GetArray(name).GetValue(0)

        quality = vtk_to_numpy(output.GetCellData().GetArray("ScaledJacobian"))
        inverted = np.flatnonzero(~(quality > 0))
        own = np.setdiff1d(inverted, self._lost[number])
        boundary = int(value("BoundaryInvertedCells"))
        return Step(number, float(self._ts[number]), value("MinScaledJacobian"),
                    value("MeanScaledJacobian"), len(inverted), boundary,
                    len(inverted) - len(own) - boundary, " ".join(map(str, own[:NAMED_CELLS])),
                    self._commit)

    def mesh(self):
        """The mesh (vtkUnstructuredGrid) of the last step, with the arrays that the filter
        makes."""
        return self._filter.GetOutputDataObject(0)

    def remove(self):
        """Takes the filter and its inputs out of the pipeline."""
        for proxy in (self._proxy, self._boundary, self._rest):
            simple.Delete(proxy)


def finished(steps, to_final, ts):
    """Whether a series of these Steps ends here.

    `to_final` steps lead to S_F, at `ts` there are boundaries. Past S_F, as far as they go, the
    series continues until the method inverts a cell."""
    if len(steps) >= len(ts):
        return True
    return len(steps) > to_final and not all(step.valid for step in steps)


def run(series, mesh, boundaries, ts, to_final, records, threads, commit, fresh, deadline):
    """Runs what is missing of the series, and records each step. A method that gives no mesh ends
    it.

    `fresh`: steps of another commit count as missing, and those of a series that is resumed come
    from this one alone. Raises OutOfTime between steps."""
    steps = records.steps(series)
    if fresh or not finished(steps, to_final, ts):
        steps = records.steps(series, commit)
    if finished(steps, to_final, ts):
        return
    deadline.check()
    work = SeriesRun(series.method, mesh, boundaries, ts, series.stepping, threads, commit)
    try:
        while not finished(steps, to_final, ts):
            deadline.check()
            steps.append(work.step(len(steps)))
            records.add(series, steps[-1])
    except RuntimeError as error:
        print(f"{series}: {error}")
    finally:
        work.remove()
