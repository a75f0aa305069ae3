# SPDX-License-Identifier: BSD-3-Clause
"""OpenFOAM's mesh motion on a mesh whose boundary is twisted.

Seconds are the processor time of moveDynamicMesh on one processor, its start included. The terms
that set displacementSBRStress apart come from the step before, so it takes ten equal steps."""

import re
import shutil

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

import foam_case  # meshes.py has set the path
from meshes import twisted

CONTROL = """application moveDynamicMesh; startFrom startTime; startTime %.6g; stopAt endTime;
endTime %.6g; deltaT %.6g; writeControl timeStep; writeInterval 1; writeFormat ascii;
writePrecision 17; libs ("libfvMotionSolvers.so");"""
SCHEMES = """ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }
divSchemes { default Gauss linear; } laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; } snGradSchemes { default corrected; }"""
SOLVERS = {"PCG": "solver PCG; preconditioner DIC;", "GAMG": "solver GAMG; smoother GaussSeidel;"}
SOLUTION = """solvers { "cellDisplacement.*" { %s tolerance 1e-10; relTol 0; } }
PIMPLE { nNonOrthogonalCorrectors 2; }"""
DYNAMIC = """dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs ("libfvMotionSolvers.so");
motionSolver %s; %sCoeffs { diffusivity inverseVolume; }"""
#: Motion solver, solver of its equation, equal steps.
SETTINGS = (("displacementLaplacian", "GAMG", 1), ("displacementLaplacian", "PCG", 1),
            ("displacementSBRStress", "PCG", 10))
NODES_A_BOX = 6.6  # of polyDualMesh's polyhedra: six tetrahedra to a box
GMSH = {4: 4, 8: 5}  # corners: Gmsh's number of the type


def write_gmsh(mesh, path):
    """Gmsh's format 2.2, which gmshToFoam reads."""
    with open(path, "w", encoding="ascii") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(mesh.points)}\n")
        numbers = np.arange(1, len(mesh.points) + 1)
        np.savetxt(file, np.column_stack([numbers, mesh.points]), "%d %.17g %.17g %.17g")
        count, corners = mesh.cells.shape
        file.write(f"$EndNodes\n$Elements\n{count}\n")
        head = np.tile([0, GMSH[corners], 2, 1, 1], (count, 1))
        head[:, 0] = np.arange(1, count + 1)
        np.savetxt(file, np.hstack([head, mesh.cells + 1]), "%d")
        file.write("$EndElements\n")


def make_case(folder, mesh, nodes):
    """A case of the mesh; None: polyDualMesh's polyhedra of about so many nodes."""
    case = foam_case.FoamCase(folder)
    if mesh is None:
        side = round((nodes / NODES_A_BOX / 2) ** (1 / 3))
        case.make_dual(side, side, 2 * side)
    else:
        write_gmsh(mesh, case.folder / "mesh.msh")
        case.run("gmshToFoam", "mesh.msh")
    return case


def outer_points(case):
    """The name of the only patch, and its points in the order of OpenFOAM's patch addressing."""
    text = (case.mesh / "boundary").read_text()
    name = re.search(r"\n\d+\n\(\s*(\w+)", text)[1]
    count, start = (int(re.search(rf"{key}\s+(\d+)", text)[1]) for key in ("nFaces", "startFace"))
    faces = re.findall(r"\d+\(([\d ]+)\)", (case.mesh / "faces").read_text())
    ids = np.concatenate([np.fromstring(face, int, sep=" ")
                          for face in faces[start:start + count]])
    _, first = np.unique(ids, return_index=True)
    return name, ids[np.sort(first)]


def boundary_field(name, rows):
    values = "\n".join("(%.17g %.17g %.17g)" % tuple(row) for row in rows)
    return (f"boundaryField {{ {name} {{ type fixedValue; value nonuniform List<vector> "
            f"{len(rows)} ({values}); }} }}\n")


def move(case, solver, linear_solver, steps):
    """Moves the mesh and returns the seconds of all steps. Time 1 has the result."""
    for old in case.folder.glob("[01]*"):
        shutil.rmtree(old)
    name, ids = outer_points(case)
    rest = vtk_to_numpy(case.read().GetPoints().GetData()).astype(float)
    rows = twisted(rest)[ids] - rest[ids]
    case.write("system/fvSchemes", "dictionary", SCHEMES)
    case.write("system/fvSolution", "dictionary", SOLUTION % SOLVERS[linear_solver])
    case.write("constant/dynamicMeshDict", "dictionary", DYNAMIC % (solver, solver))
    seconds = 0
    for step in range(steps):
        start, end = f"{step / steps:.6g}", f"{(step + 1) / steps:.6g}"
        internal = "internalField uniform (0 0 0);\n"
        if step > 0:
            text = (case.folder / start / "pointDisplacement").read_text()
            internal = re.search(r"internalField.*?;\n", text, re.S)[0]
        case.write(f"{start}/pointDisplacement", "pointVectorField",
                   "dimensions [0 1 0 0 0 0 0];\n" + internal +
                   boundary_field(name, (step + 1) / steps * rows))
        case.write("system/controlDict", "dictionary",
                   CONTROL % (step / steps, (step + 1) / steps, 1 / steps))
        output = case.run("moveDynamicMesh")
        if not (case.folder / end / "polyMesh/points").exists():
            raise RuntimeError(f"moveDynamicMesh wrote no points at {end}: {output[-2000:]}")
        seconds += float(re.findall(r"ExecutionTime = ([\d.e+-]+) s", output)[-1])
    return seconds
