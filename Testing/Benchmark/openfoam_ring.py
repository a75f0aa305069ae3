# SPDX-License-Identifier: BSD-3-Clause
"""The ring of keep_layers.py, whose wall turns by 30 degrees, by FEMWARP and by OpenFOAM's mesh
motion.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython openfoam_ring.py
Writes results/ring.csv: for each method the largest lean of the wall-normal lines in degrees, the
least relative height of the first cells, and the number of inverted cells. The turn has equal
steps, since the terms that set displacementSBRStress apart come from the step before. The file has
no row for a solver that fails on a mesh that it has inverted. Needs OpenFOAM's blockMesh and
moveDynamicMesh.
"""
import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "ParaView"), str(HERE.parent.parent / "Utilities")]
import keep_layers as ring  # (needs the path above)
from study_pieces import commit

# Solver, diffusivity and equal steps of the turn.
SETTINGS = (("displacementLaplacian", "uniform", 1), ("displacementLaplacian", "inverseVolume", 1),
            ("displacementLaplacian", "quadratic inverseDistance (wall)", 1),
            ("displacementSBRStress", "uniform", 10), ("displacementSBRStress", "uniform", 30),
            ("displacementSBRStress", "inverseVolume", 10),
            ("displacementSBRStress", "quadratic inverseDistance (wall)", 10))
HEADER = "FoamFile { version 2.0; format ascii; class %s; object %s; }\n"
CONTROL = """application moveDynamicMesh; startFrom startTime; startTime 0; stopAt endTime;
endTime %(steps)d; deltaT 1; writeControl timeStep; writeInterval %(steps)d; writeFormat ascii;
writePrecision 17; libs ("libfvMotionSolvers.so");"""
SCHEMES = """ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }
divSchemes { default Gauss linear; }
laplacianSchemes { default Gauss linear limited corrected 0.33; }
interpolationSchemes { default linear; } snGradSchemes { default limited corrected 0.33; }"""
SOLUTION = """solvers { "cellDisplacement.*"
{ solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0; } }
PIMPLE { nNonOrthogonalCorrectors 2; }"""
TURN = """solidBodyMotionFunction rotatingMotion;
rotatingMotionCoeffs { origin (0 0 0); axis (0 0 1); omega %.17g; }"""
FIELD = """dimensions [0 1 0 0 0 0 0]; internalField uniform (0 0 0); boundaryField {
wall { %s } outer { type fixedValue; value uniform (0 0 0); } sides { type slip; } }"""
MOVING = {"pointVectorField": "type solidBodyMotionDisplacement; value uniform (0 0 0); " + TURN,
          "volVectorField": "type cellMotion; value uniform (0 0 0);"}


def blocks(points):
    """blockMeshDict: a block for each interval of the angle. `points`: #z x #around x #radii
    x 3."""
    high, around, radii = points.shape[:3]
    corners = points[[0, -1]][:, :, [0, -1]]
    a = np.arange(corners.size // 3).reshape(2, around, 2)  # k, j, inner or outer
    b = np.roll(a, -1, axis=1)  # the next j
    listed = lambda nodes: "(" + " ".join(map(str, nodes)) + ")"
    ends = [[(a[k, j, 0], a[k, j, 1], b[k, j, 1], b[k, j, 0]) for k in (0, 1)]
            for j in range(around)]
    one = [listed(low + high_) for low, high_ in ends]
    along = lambda r: [listed((a[0, j, r], b[0, j, r], b[1, j, r], a[1, j, r]))
                       for j in range(around)]
    sides = {"wall": along(0), "outer": along(1),
             "sides": [listed(face) for pair in ends for face in pair]}
    grading = ring.GROWTH ** (radii - 2)
    text = "convertToMeters 1; vertices ("
    text += " ".join("(%.17g %.17g %.17g)" % tuple(p) for p in corners.reshape(-1, 3))
    text += ") ; blocks (" + "\n".join(
        f"hex {block} ({radii - 1} 1 {high - 1}) simpleGrading ({grading:.17g} 1 1)"
        for block in one) + "); edges (); boundary ("
    for name, faces in sides.items():
        kind = "wall" if name == "wall" else "patch"
        text += f"{name} {{ type {kind}; faces ({' '.join(faces)}); }}"
    return text + "); mergePatchPairs ();"


def read_points(path):
    numbers = re.findall(r"\(([-\d.e+]+) ([-\d.e+]+) ([-\d.e+]+)\)", path.read_text())
    return np.array(numbers, float)


def write(case, name, kind, text):
    path = case / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER % (kind, path.name) + text + "\n")


def call(case, program):
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}  # where Debian has it
    done = subprocess.run([program, "-case", str(case)], capture_output=True, text=True,
                          check=False, env=environment)
    if done.returncode != 0:
        raise RuntimeError(done.stdout + done.stderr)


def inverted(points):
    """Cells with a corner whose determinant is not positive."""
    def corner(i, j, k):
        at = lambda di, dj, dk: np.roll(points, -dj, axis=1)[
            dk:points.shape[0] - 1 + dk, :, di:points.shape[2] - 1 + di]
        here = at(i, j, k)
        edges = [at(1 - i, j, k) - here, at(i, 1 - j, k) - here, at(i, j, 1 - k) - here]
        sign = (-1) ** (i + j + k)
        return sign * np.linalg.det(np.stack(edges, axis=-1))
    bad = np.zeros((points.shape[0] - 1, points.shape[1], points.shape[2] - 1), bool)
    for i, j, k in np.ndindex(2, 2, 2):
        bad |= corner(i, j, k) <= 0
    return np.count_nonzero(bad)


def moved(solver, diffusivity, steps, rest):
    with tempfile.TemporaryDirectory() as name:
        case = pathlib.Path(name)
        write(case, "system/controlDict", "dictionary", CONTROL % {"steps": steps})
        write(case, "system/fvSchemes", "dictionary", SCHEMES)
        write(case, "system/fvSolution", "dictionary", SOLUTION)
        write(case, "system/blockMeshDict", "dictionary", blocks(rest))
        write(case, "constant/dynamicMeshDict", "dictionary",
              'dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs ("libfvMotionSolvers.so");'
              f" motionSolver {solver}; {solver}Coeffs {{ diffusivity {diffusivity}; }}")
        for field, kind in (("pointDisplacement", "pointVectorField"),
                            ("cellDisplacement", "volVectorField")):
            motion = MOVING[kind].replace("%.17g", repr(ring.ANGLE / steps))
            write(case, f"0/{field}", kind, FIELD % motion)
        call(case, "blockMesh")
        before = read_points(case / "constant/polyMesh/points")
        call(case, "moveDynamicMesh")
        after = read_points(case / f"{steps}/polyMesh/points")
    # blockMesh numbers the points its own way.
    flat = rest.reshape(-1, 3)
    nearest = np.array([np.argmin(((before - p) ** 2).sum(axis=1)) for p in flat])
    assert np.abs(before[nearest] - flat).max() < 1e-6 and len(np.unique(nearest)) == len(flat)
    return after[nearest].reshape(rest.shape)


def results():
    """Yields (name, points at rest, moved points)."""
    rest = ring.ring_points()
    for name, points in ring.morphed(rest):
        yield name, rest, points
    for solver, diffusivity, steps in SETTINGS:
        name = f"{solver}, {diffusivity}, {'1 step' if steps == 1 else f'{steps} steps'}"
        try:
            yield name, rest, moved(solver, diffusivity, steps, rest)
        except RuntimeError as error:
            step = ["0", *re.findall(r"\nTime = (\d+)", str(error))][-1]
            print(f"{name}: fails at step {step}")


def main():
    with open(HERE / "results" / "ring.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["method", "lean", "first_height", "inverted", "commit"])
        for name, rest, points in results():
            lean, height = ring.figures(rest, points)
            table.writerow([name, f"{lean:.2f}", f"{height:.5g}", inverted(points), commit()])
            file.flush()


if __name__ == "__main__":
    main()
