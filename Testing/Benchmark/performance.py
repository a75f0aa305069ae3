#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Our methods and other programs on six kinds of mesh, in one run on an idle machine.

    python3 Testing/Benchmark/performance.py                       # all, in some hours
    python3 Testing/Benchmark/performance.py --kinds cube pipe --nodes 10000 --programs 'FEM|hypre'

Each run is a row of results/performance.csv; what is there already is not run again.
performance_page.py makes the tables of Documentation/Performance.md of it. Needs the plugin and
linear-system (preset paraview), and of Debian python3-petsc4py, calculix-ccx and openfoam:
install-packages.sh --benchmark --solvers."""

import argparse
import csv
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from paraview import simple

from meshes import KINDS, ROOT
import calculix
import openfoam
from study_pieces import ORIGIN, origin
from Models.vtk_files import write_grid

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results/performance.csv"
FIELDS = ("mesh", "nodes", "size", "program", "processors", "run", "first_s", "later_s",
          "prepare_s", "evaluate_s", "memory_GB", "iterations", "difference", "inverted", "minimum",
          *ORIGIN)
METHODS = {"FEMWARP": "FEMWARP", "LBWARP": "LBWARP", "Weighted residual": "WeightedResidual",
           "Simplex-linear": "SimplexLinear", "Simplex-natural neighbor": "SimplexNaturalNeighbor",
           "Radial basis": "RadialBasis", "Smoothing": "Smoothing",
           "Inversion-free": "InversionFree"}
#: Solvers of FEMWARP's system: what solve_system.py calls them, and on how many ranks they run.
SYSTEMS = {"hypre BoomerAMG": ("hypre", (1, 2)), "PETSc GAMG": ("gamg", (1, 2)),
           "CHOLMOD": ("cholmod", (1,)), "KLU": ("klu", (1,))}
SMALL = 200000  # nodes up to which direct solvers and elasticity run
SLOW = 100  # seconds: what takes longer runs once
LIMIT = 600  # seconds: what takes longer is ended, and its row is empty
RANKS = (1, 2, 4)


def run(command, limit=LIMIT):
    """The last line of a program's output as JSON; None if it takes longer than the limit."""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1", PYTHONDONTWRITEBYTECODE="1")
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, cwd=HERE,
                              env=environment, check=False)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        raise RuntimeError(f"{command}:\n{done.stdout[-500:]}{done.stderr[-1500:]}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def quality(grid):
    """Inverted cells and the minimum, by the filter Scaled Jacobian."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(grid)
    measured = simple.ScaledJacobian(Input=source)
    measured.UpdatePipeline()
    field = measured.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    return {"inverted": field.GetArray("InvertedCells").GetValue(0),
            "minimum": field.GetArray("MinScaledJacobian").GetValue(0)}


class Table:
    """The rows of the file, to which each run is added at once."""

    def __init__(self, path):
        self.path = path
        self.rows = []
        if path.exists():
            with open(path, newline="", encoding="utf-8") as file:
                self.rows = list(csv.DictReader(file))
        self.about = dict(zip(ORIGIN, origin()))

    def of(self, kind, size, program, processors):
        wanted = (kind, str(size), program, str(processors))
        return [row for row in self.rows
                if tuple(row[k] for k in ("mesh", "size", "program", "processors")) == wanted]

    def add(self, row):
        self.rows.append({key: str(row.get(key, "")) for key in FIELDS})
        with open(self.path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.rows)

    def measure(self, key, runs, work):
        """Adds rows until there are `runs`, one if it is slow. work() gives a dictionary, or None
        beyond the limit."""
        kind, nodes, size, program, processors = key
        while True:
            done = self.of(kind, size, program, processors)
            if len(done) >= runs or (done and not 0 < float(done[0]["first_s"] or 0) < SLOW):
                return
            found = work() or {}
            found = {{"first": "first_s", "later": "later_s", "prepare": "prepare_s",
                      "evaluate": "evaluate_s", "memory": "memory_GB"}.get(name, name):
                     f"{value:.4g}" for name, value in found.items()}
            self.add({"mesh": kind, "nodes": nodes, "size": size, "program": program,
                      "processors": processors, "run": len(done) + 1, **found, **self.about})
            print(*(self.rows[-1][name] for name in FIELDS[:12]), flush=True)


class Bench:
    def __init__(self, options, table):
        self.options, self.table = options, table
        self.program = options.build / "bin/linear-system"
        self.plugin = next((options.build / "lib").glob("**/MeshMorphing.so"))
        simple.LoadPlugin(str(self.plugin), remote=False, ns=vars(simple))

    def wants(self, program):
        return re.search(self.options.programs, program)

    def mesh(self, kind, size, folder):
        mesh = KINDS[kind](size) if KINDS[kind] else None
        case = None
        if mesh is None or self.wants("OpenFOAM"):
            (folder / "case").mkdir()
            case = openfoam.make_case(folder / "case", mesh, size)
        grid = mesh.to_vtk() if mesh else case.read()
        grid.GetPointData().Initialize()
        write_grid(grid, folder / "mesh.vtu")
        nodes = grid.GetNumberOfPoints()
        measure = lambda program, processors, work: self.table.measure(
            (kind, nodes, size, program, processors), self.options.runs, work)
        self.ours(folder, measure)
        self.systems(nodes, folder, measure)
        if case:
            self.openfoam(case, measure)
        if mesh and nodes <= SMALL and self.wants("CalculiX"):
            self.calculix(mesh, folder, measure)

    def ours(self, folder, measure):
        command = lambda method, threads: [
            "pvbatch", "--symmetric", "ours.py", self.plugin, METHODS[method], str(threads), "3",
            folder / "mesh.vtu"]
        for method in filter(self.wants, METHODS):
            measure(method, os.cpu_count(), lambda m=method: run(command(m, os.cpu_count())))
        if self.options.ranks and self.wants("FEMWARP"):
            for ranks in RANKS:
                measure("FEMWARP on MPI ranks", ranks, lambda n=ranks: run(
                    ["mpiexec", "-n", str(n), *command("FEMWARP", 1)]))

    def systems(self, nodes, folder, measure):
        programs = [name for name in SYSTEMS
                    if self.wants(name) and (nodes <= SMALL or len(SYSTEMS[name][1]) > 1)]
        eigen = nodes <= SMALL and self.wants("Eigen LDLT")
        system = folder / "system"
        write = [self.program, folder / "mesh.vtu", system]
        if programs:
            subprocess.run(write, check=True)
        if eigen:
            measure("Eigen LDLT", 1, lambda: run([*write, "--eigen"]))
        for name in programs:
            solver, ranks = SYSTEMS[name]
            for n in ranks:
                measure(name, n, lambda s=solver, n=n: run(
                    ["mpiexec", "-n", str(n), "/usr/bin/python3", "solve_system.py", system, s]))

    def openfoam(self, case, measure):
        for solver, linear_solver, steps in openfoam.SETTINGS:
            def work(solver=solver, linear_solver=linear_solver, steps=steps):
                try:
                    seconds = openfoam.move(case, solver, linear_solver, steps)
                except RuntimeError as error:  # it fails on meshes that it has inverted
                    print(f"{solver}: {error}", file=sys.stderr)
                    return None
                return {"first": seconds, **quality(case.read(1))}
            measure(f"OpenFOAM {solver}, {linear_solver}, {steps} step{'s' * (steps > 1)}", 1, work)

    def calculix(self, mesh, folder, measure):
        def work():
            seconds, moved = calculix.move(folder, mesh, os.cpu_count(), LIMIT)
            return seconds and {"first": seconds, **quality(mesh.to_vtk(moved))}
        measure("CalculiX elasticity", os.cpu_count(), work)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--nodes", nargs="+", type=int, default=[100000])
    parser.add_argument("--programs", default="", metavar="REGEX", help="default: all")
    parser.add_argument("--ranks", action="store_true", help="FEMWARP on MPI ranks, too")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--build", type=Path, default=ROOT / "build/paraview")
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    bench = Bench(options, Table(options.output))
    for size in options.nodes:
        for kind in options.kinds:
            with tempfile.TemporaryDirectory() as folder:
                bench.mesh(kind, size, Path(folder))


if __name__ == "__main__":
    main()
