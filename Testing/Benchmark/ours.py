# SPDX-License-Identifier: BSD-3-Clause
"""One method on one mesh whose boundary is twisted, as whole filter, on one MPI rank or more.

    mpiexec -n 2 pvbatch --symmetric ours.py PLUGIN METHOD THREADS STEPS MESH.vtu [MOVED.vtu]

Prints seconds of the first step and the median of later ones, with topology, preparation, quality
and output; those of prepare and evaluate among them; peak memory in GB beside the mesh and its
output's connectivity, of the rank that needs most; inverted cells and the minimum. STEPS: later
ones."""

import ctypes
import json
import statistics
import sys
import time
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import (numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy)
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints
from vtkmodules.vtkFiltersCore import vtkExtractCells
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from meshes import twisted


def status(name):
    """GB of a line of /proc/self/status."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{name}:"):
            return int(line.split()[1]) / 1e6
    raise RuntimeError(f"/proc/self/status has no {name}")


def producer(data):
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    return source


def slab(grid, rank, ranks):
    """The rank's part of the cells, with global ids of its nodes."""
    ids = numpy_to_vtkIdTypeArray(np.arange(grid.GetNumberOfPoints()), deep=True)
    ids.SetName("GlobalPointId")
    grid.GetPointData().SetGlobalIds(ids)
    if ranks == 1:
        return grid
    count = grid.GetNumberOfCells()
    part = vtkExtractCells()
    part.SetInputData(grid)
    part.AddCellRange(count * rank // ranks, count * (rank + 1) // ranks - 1)
    part.Update()
    return part.GetOutput()


def largest(controller, value):
    """Of all ranks."""
    mine, most = vtkIdTypeArray(), vtkIdTypeArray()
    mine.InsertNextValue(int(1e9 * value))
    most.InsertNextValue(0)
    controller.AllReduce(mine, most, 0)  # 0: the maximum
    return most.GetValue(0) / 1e9


def main():
    plugin, method, threads, later_steps, mesh, *moved = sys.argv[1:]
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    controller = vtkMultiProcessController.GetGlobalController()
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(mesh)
    reader.Update()
    grid = reader.GetOutput()
    rest = vtk_to_numpy(grid.GetPoints().GetData()).copy()
    part = slab(grid, controller.GetLocalProcessId(), controller.GetNumberOfProcesses())
    del reader, grid
    source = producer(part)
    outer = simple.ExtractMorphBoundary(Input=source)
    outer.UpdatePipeline()
    surface = outer.GetClientSideObject().GetOutputDataObject(0)
    ids = vtk_to_numpy(surface.GetPointData().GetArray("MorphPointId"))
    places, motion = rest[ids], twisted(rest)[ids] - rest[ids]
    boundary = producer(surface)
    morph = getattr(simple, f"Morph{method}")(Input=source, Boundary=boundary)
    morph.NumberOfThreads = int(threads)
    ctypes.CDLL(None).malloc_trim(0)  # what was freed would be used again without a new peak
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # VmHWM starts again
    before = status("VmRSS")
    seconds, evaluate = [], []
    for step in range(1 + int(later_steps)):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(places + (1 - 0.02 * step) * motion, deep=True))
        surface.SetPoints(points)
        boundary.MarkModified(boundary)
        controller.Barrier()
        start = time.perf_counter()
        morph.UpdatePipeline()
        controller.Barrier()
        seconds.append(time.perf_counter() - start)
        output = morph.GetClientSideObject().GetOutputDataObject(0)
        field = lambda name: output.GetFieldData().GetArray(name).GetValue(0)
        evaluate.append(field("EvaluateSeconds"))
        if step == 0:
            first = {"prepare": field("PrepareSeconds"), "inverted": field("InvertedCells"),
                     "minimum": field("MinScaledJacobian")}
            if moved:
                writer = vtkXMLUnstructuredGridWriter()
                writer.SetFileName(moved[0])
                writer.SetInputData(output)
                writer.Write()
    memory = largest(controller, status("VmHWM") - before)
    if controller.GetLocalProcessId() == 0:
        print(json.dumps({"first": seconds[0], "later": statistics.median(seconds[1:] or seconds),
                          **first, "evaluate": statistics.median(evaluate), "memory": memory}))


main()
