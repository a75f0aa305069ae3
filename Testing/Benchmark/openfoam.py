# SPDX-License-Identifier: BSD-3-Clause
"""The same mesh and motion by OpenFOAM's own mesh motion and by ours, in one run.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython openfoam.py [--cells N] [--motion NAME]
Prints a table: seconds, non-orthogonality, skewness, and cells that checkMesh or the scaled
Jacobian finds wrong. OpenFOAM's seconds are the processor time of moveDynamicMesh, its start
included; ours are those of the whole filter. Both run on one processor. The mesh is polyDualMesh's,
of about 2 (N + 1)^3 polyhedra. The last line has FEMWARP's time over that on hexahedra of as many
nodes.
"""
import argparse
import os
import pathlib
import re
import shutil
import sys
import tempfile
import time

from paraview.simple import *
from paraview import servermanager

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "Testing" / "ParaView"), str(ROOT / "Utilities")]
import foam_case
from benchmark_filter import cube

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

CONTROL = """application moveDynamicMesh; startFrom startTime; startTime %.6g; stopAt endTime;
endTime %.6g; deltaT %.6g; writeControl timeStep; writeInterval 1; writeFormat ascii;
writePrecision 17; libs ("libfvMotionSolvers.so");"""
SCHEMES = """ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }
divSchemes { default Gauss linear; } laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; } snGradSchemes { default corrected; }"""
SOLUTION = """solvers { "cellDisplacement.*"
{ solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0; } }
PIMPLE { nNonOrthogonalCorrectors 2; }"""
DYNAMIC = """dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs ("libfvMotionSolvers.so");
motionSolver %s; %sCoeffs { diffusivity %s; }"""
# Solver, diffusivity and equal steps of the motion. The terms that set displacementSBRStress apart
# come from the step before, so that one step of it is displacementLaplacian's.
SETTINGS = (("displacementLaplacian", "uniform", 1),
            ("displacementLaplacian", "quadratic inverseDistance 1(%s)", 1),
            ("displacementLaplacian", "inverseVolume", 1),
            ("displacementLaplacian", "quadratic inverseDistance 1(%s)", 10),
            ("displacementSBRStress", "uniform", 10),
            ("displacementSBRStress", "quadratic inverseDistance 1(%s)", 10))
OURS = ("FEMWARP", "LBWARP", "SimplexLinear", "InversionFree")


def patch(case):
    """The name of the only patch, and its points in the order of OpenFOAM's patch addressing."""
    text = (case.mesh / "boundary").read_text()
    name = re.search(r"\n\d+\n\(\s*(\w+)", text)[1]
    count = int(re.search(r"nFaces\s+(\d+)", text)[1])
    start = int(re.search(r"startFace\s+(\d+)", text)[1])
    faces = re.findall(r"\d+\(([\d ]+)\)", (case.mesh / "faces").read_text())
    order = {}
    for face in faces[start:start + count]:
        for point in face.split():
            order.setdefault(int(point), None)
    return name, list(order)


def displacements(points, grid, motion):
    return [[b - a for a, b in zip(x, motion(x))] for x in map(grid.GetPoint, points)]


def boundary_field(name, rows, fraction):
    """The patch's displacement for a fraction of the motion."""
    values = "\n".join("(%.17g %.17g %.17g)" % tuple(fraction * x for x in row) for row in rows)
    value = f"nonuniform List<vector> {len(rows)} ({values})"
    return f"boundaryField {{ {name} {{ type fixedValue; value {value}; }} }}\n"


def openfoam(case, name, rows, solver, diffusivity, steps):
    """Moves the mesh; returns the seconds of all steps. The result is time 1's mesh."""
    for old in case.folder.glob("[01]*"):
        shutil.rmtree(old)
    case.write("system/fvSchemes", "dictionary", SCHEMES)
    case.write("system/fvSolution", "dictionary", SOLUTION)
    case.write("constant/dynamicMeshDict", "dictionary",
               DYNAMIC % (solver, solver, diffusivity.replace("%s", name)))
    seconds = 0
    for step in range(steps):
        start, end = f"{step / steps:.6g}", f"{(step + 1) / steps:.6g}"
        internal = "internalField uniform (0 0 0);\n"
        if step > 0:
            text = (case.folder / start / "pointDisplacement").read_text()
            internal = re.search(r"internalField.*?;\n", text, re.S)[0]
        case.write(f"{start}/pointDisplacement", "pointVectorField",
                   "dimensions [0 1 0 0 0 0 0];\n" + internal +
                   boundary_field(name, rows, (step + 1) / steps))
        case.write("system/controlDict", "dictionary",
                   CONTROL % (step / steps, (step + 1) / steps, 1 / steps))
        output = case.run("moveDynamicMesh")
        if not (case.folder / end / "polyMesh/points").exists():
            raise RuntimeError(f"moveDynamicMesh wrote no points at {end}: {output[-2000:]}")
        seconds += float(re.findall(r"ExecutionTime = ([\d.e+-]+) s", output)[-1])
    return seconds


def checked(output):
    """Non-orthogonality (largest, mean), skewness, and cells or faces that are wrong."""
    number = lambda pattern: float(found[1]) if (found := re.search(pattern, output)) else 0.0
    return (number(r"non-orthogonality Max: ([\d.e+-]+)"), number(r"average: ([\d.e+-]+)"),
            number(r"[Ss]kewness = ([\d.e+-]+)"),
            int(number(r"[Nn]umber of negative volume cells: (\d+)")),
            int(number(r"(\d+) faces are incorrectly oriented") or
                number(r"incorrectly oriented.*: (\d+)")))


def inverted(grid):
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(grid)
    quality = ScaledJacobian(Input=source)
    quality.UpdatePipeline()
    field = servermanager.Fetch(quality).GetFieldData()
    return (field.GetArray("InvertedCells").GetValue(0),
            field.GetArray("MinScaledJacobian").GetValue(0))


def report(label, seconds, output, bad, least):
    most, mean, skewness, volumes, pyramids = checked(output)
    print(f"| {label} | {seconds:.2f} | {most:.1f} | {mean:.1f} | {skewness:.2f} | {volumes} | "
          f"{pyramids} | {bad} | {least:.3f} |", flush=True)


def ours(source, motion, name):
    extract = ExtractMorphBoundary(Input=source)
    extract.UpdatePipeline()
    boundary = servermanager.Fetch(extract)
    for i in range(boundary.GetNumberOfPoints()):
        boundary.GetPoints().SetPoint(i, motion(boundary.GetPoint(i)))
    moved = TrivialProducer()
    moved.GetClientSideObject().SetOutput(boundary)
    morph = globals()["Morph" + name](Input=source, Boundary=moved, NumberOfThreads=1)
    start = time.process_time()
    morph.UpdatePipeline()
    return servermanager.Fetch(morph), time.process_time() - start


def against_hexahedra(source, motion, repeats=5):
    """Times of FEMWARP's filter by node: those of the polyhedra over those of hexahedra, each the
    least of several by turns."""
    nodes = source.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    box = TrivialProducer()
    grid = cube(round(nodes ** (1 / 3)) - 1)[0]
    box.GetClientSideObject().SetOutput(grid)
    seconds = {box: [], source: []}
    for _ in range(repeats):
        for mesh, of in seconds.items():
            of.append(ours(mesh, motion, "FEMWARP")[1])
    ours_least, hexahedra = min(seconds[source]), min(seconds[box])
    print(f"\nFEMWARP: {ours_least:.2f} s on {nodes} nodes of polyhedra, {hexahedra:.2f} s on "
          f"{grid.GetNumberOfPoints()} of hexahedra; a node takes "
          f"{ours_least / nodes / (hexahedra / grid.GetNumberOfPoints()):.2f} times as long.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cells", type=int, default=10, help="boxes along x and y (default 10)")
    parser.add_argument("--motion", choices=("twisted", "bent", "waved"), default="twisted")
    arguments = parser.parse_args()
    absent = foam_case.missing("moveDynamicMesh")
    if absent:
        sys.exit(f"OpenFOAM is not installed (openfoam): {', '.join(absent)}")
    motion = getattr(foam_case, arguments.motion)
    with tempfile.TemporaryDirectory() as folder:
        case = foam_case.FoamCase(folder)
        case.make_dual(arguments.cells, arguments.cells, 2 * arguments.cells)
        grid = case.read()
        name, points = patch(case)
        print(f"{grid.GetNumberOfCells()} cells, {grid.GetNumberOfPoints()} points, "
              f"{arguments.motion}\n")
        print("| | seconds | non-orthogonality, degrees | mean | skewness | negative volumes | "
              "wrong pyramids | inverted cells | min. scaled Jacobian |")
        print("|---|" + "---|" * 8)
        report("undeformed", 0, case.check()[1], *inverted(grid))
        rows = displacements(points, grid, motion)
        for solver, diffusivity, steps in SETTINGS:
            seconds = openfoam(case, name, rows, solver, diffusivity, steps)
            output = case.run("checkMesh", "-time", "1")
            many = "1 step" if steps == 1 else f"{steps} steps"
            report(f"{solver}, {diffusivity.replace(' 1(%s)', '')}, {many}", seconds, output,
                   *inverted(case.read(1)))
        source = TrivialProducer()
        source.GetClientSideObject().SetOutput(grid)
        for method in OURS:
            moved, seconds = ours(source, motion, method)
            case.write_points(moved)
            report(method, seconds, case.run("checkMesh", "-time", "0"), *inverted(moved))
        against_hexahedra(source, motion)


if __name__ == "__main__":
    main()
