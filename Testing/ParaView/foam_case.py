# SPDX-License-Identifier: BSD-3-Clause
"""Small OpenFOAM cases with polyhedral meshes, made by OpenFOAM's own programs.

For openfoam_polyhedra.py, and for Testing/Benchmark/openfoam.py.
"""
import itertools
import math
import os
import pathlib
import random
import re
import shutil
import subprocess

from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.vtkIOGeometry import vtkOpenFOAMReader

PROGRAMS = ("blockMesh", "checkMesh", "gmshToFoam", "polyDualMesh", "snappyHexMesh")


def missing(*others):
    """The programs that are not installed."""
    return [name for name in (*PROGRAMS, *others) if not shutil.which(name)]


HEADER = "FoamFile {{ version 2.0; format ascii; class {0}; object {1}; }}\n"
CONTROL = """application none; startFrom startTime; startTime 0; stopAt endTime; endTime 1;
deltaT 1; writeControl timeStep; writeInterval 1; writeFormat ascii; writePrecision 17;"""
SCHEMES = """ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {}
interpolationSchemes {} snGradSchemes {}"""
BLOCK = """convertToMeters 1;
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 2) (1 0 2) (1 1 2) (0 1 2));
blocks (hex (0 1 2 3 4 5 6 7) (6 6 12) simpleGrading (1 1 1));
boundary (walls { type wall;
  faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); });"""
SNAPPY = """castellatedMesh true; snap false; addLayers false;
geometry { ball { type searchableSphere; centre (0.5 0.5 1); radius 0.25; } }
castellatedMeshControls { maxLocalCells 100000; maxGlobalCells 200000; minRefinementCells 0;
  nCellsBetweenLevels 1; features (); refinementSurfaces { ball { level (1 1); } }
  resolveFeatureAngle 30; refinementRegions {} locationInMesh (0.05 0.05 0.05);
  allowFreeStandingZoneFaces true; }
snapControls { nSmoothPatch 3; tolerance 2.0; nSolveIter 30; nRelaxIter 5; }
addLayersControls { relativeSizes true; layers {} expansionRatio 1; finalLayerThickness 0.3;
  minThickness 0.1; nGrow 0; featureAngle 30; nRelaxIter 3; nSmoothSurfaceNormals 1;
  nSmoothNormals 3; nSmoothThickness 10; maxFaceThicknessRatio 0.5;
  maxThicknessToMedialRatio 0.3; minMedianAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 50; }
meshQualityControls { maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4;
  maxConcave 80; minVol 1e-13; minTetQuality 1e-15; minArea -1; minTwist 0.02;
  minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01; minTriangleTwist -1;
  nSmoothScale 4; errorReduction 0.75; }
writeFlags (); mergeTolerance 1e-6;"""


def gmsh_tetrahedra(nx, ny, nz):
    """A box of 1 x 1 x 2, each of its boxes in six tetrahedra, in Gmsh's format 2.2."""
    random.seed(7)
    points, cells = [], []
    for k, j, i in itertools.product(range(nz + 1), range(ny + 1), range(nx + 1)):
        x = [float(i), float(j), float(k)]
        for d, n in enumerate((nx, ny, nz)):
            if 0 < x[d] < n:
                x[d] += random.uniform(-0.15, 0.15)
        points.append((x[0] / nx, x[1] / ny, 2 * x[2] / nz))
    for k, j, i in itertools.product(range(nz), range(ny), range(nx)):
        for order in itertools.permutations(range(3)):
            at = [i, j, k]
            corners = []
            for d in (None, *order):
                if d is not None:
                    at[d] += 1
                corners.append(1 + at[0] + (nx + 1) * (at[1] + (ny + 1) * at[2]))
            if sum(order[a] < order[b] for b in range(3) for a in range(b)) % 2 == 0:
                corners[2], corners[3] = corners[3], corners[2]
            cells.append(corners)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += ["%d %.17g %.17g %.17g" % (n + 1, *p) for n, p in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += ["%d 4 2 1 1 %d %d %d %d" % (n + 1, *c) for n, c in enumerate(cells)]
    return "\n".join(lines + ["$EndElements", ""])


def twisted(x):
    """About the axis of the box, by 90 degrees from the bottom to the top."""
    angle = math.pi / 4 * x[2]
    a, b = x[0] - 0.5, x[1] - 0.5
    return (0.5 + a * math.cos(angle) - b * math.sin(angle),
            0.5 + a * math.sin(angle) + b * math.cos(angle), x[2])


def bent(x):
    """Around an axis at a distance of 1.5, by 80 degrees from the bottom to the top."""
    angle = math.radians(40) * x[2]
    radius = 1.5 + x[0]
    return (radius * math.cos(angle) - 1.5, x[1], radius * math.sin(angle))


def waved(x):
    """Steep waves along x, which turn FEMWARP's cells over."""
    return (x[0], x[1], x[2] + 0.2 * math.sin(2 * math.pi * x[0]))


class FoamCase:
    """A case in a folder that exists."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.mesh = self.folder / "constant" / "polyMesh"
        (self.folder / "constant").mkdir()
        for name, text in (("controlDict", CONTROL), ("fvSchemes", SCHEMES), ("fvSolution", ""),
                           ("blockMeshDict", BLOCK), ("snappyHexMeshDict", SNAPPY)):
            self.write(f"system/{name}", "dictionary", text)
        (self.folder / "case.foam").write_text("")

    def write(self, path, kind, text):
        path = self.folder / path
        path.parent.mkdir(exist_ok=True)
        path.write_text(HEADER.format(kind, path.name) + text)

    def run(self, *command):
        """The output of one of OpenFOAM's programs, which must succeed."""
        environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}  # where Debian has it
        result = subprocess.run(command, capture_output=True, text=True, timeout=1500,
                                cwd=self.folder, env=environment)
        if result.returncode != 0:
            raise RuntimeError(f"{command} failed:\n{result.stdout}{result.stderr}")
        return result.stdout

    def make_dual(self, nx, ny, nz):
        """polyDualMesh of nx x ny x nz boxes of tetrahedra."""
        (self.folder / "tets.msh").write_text(gmsh_tetrahedra(nx, ny, nz))
        self.run("gmshToFoam", "tets.msh")
        self.run("polyDualMesh", "60", "-overwrite")

    def make_refined(self):
        """Hexahedra, refined around a ball by snappyHexMesh."""
        self.run("blockMesh")
        self.run("snappyHexMesh", "-overwrite")

    def check(self):
        """The texts of checkMesh's failed checks without numbers, and its whole output."""
        output = self.run("checkMesh")
        failed = {re.split(r"[:,0-9]", line)[0].strip()
                  for line in output.splitlines() if line.strip().startswith("***")}
        return failed, output

    def read(self, time=0):
        """The mesh at that time as a vtkUnstructuredGrid, its polyhedra whole."""
        reader = vtkOpenFOAMReader()
        reader.SetFileName(str(self.folder / "case.foam"))
        reader.DecomposePolyhedraOff()
        reader.SetUse64BitFloats(True)
        reader.UpdateTimeStep(time)
        return reader.GetOutput().GetBlock(0)

    def write_points(self, moved):
        """The points of a vtkUnstructuredGrid into the case's mesh."""
        points = dataset_adapter.WrapDataObject(moved).Points
        lines = [f"({x:.17g} {y:.17g} {z:.17g})" for x, y, z in points]
        self.write("constant/polyMesh/points", "vectorField",
                   "\n".join([str(len(lines)), "(", *lines, ")", ""]))
