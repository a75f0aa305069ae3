# SPDX-License-Identifier: BSD-3-Clause
"""Solves a system that linear-system has written, by a solver of PETSc, on one MPI rank or more.

    mpiexec -n 2 python3 solve_system.py SYSTEM gamg|hypre|cholmod|klu

Prints the seconds of set-up and three solutions, those of the solutions alone, the most iterations,
and the largest difference from our solution over the largest entry. Iterative solvers are conjugate
gradients, to our default relative residual of 1e-10."""

import json
import sys
import time

import petsc4py

petsc4py.init([])
from petsc4py import PETSc  # noqa: E402  (reads the options above)

DIRECT = {"cholmod": "cholesky", "klu": "lu"}


def seconds(action):
    PETSc.COMM_WORLD.barrier()
    start = time.perf_counter()
    action()
    PETSc.COMM_WORLD.barrier()
    return time.perf_counter() - start


def main():
    path, name = sys.argv[1:]
    viewer = PETSc.Viewer().createBinary(path, "r")
    matrix = PETSc.Mat().load(viewer)
    sides = [PETSc.Vec().load(viewer) for _ in range(3)]
    ours = [PETSc.Vec().load(viewer) for _ in range(3)]
    found = [side.duplicate() for side in sides]
    solver = PETSc.KSP().create()
    solver.setOperators(matrix)
    solver.setTolerances(rtol=1e-10, max_it=2000)
    precondition = solver.getPC()
    if name in DIRECT:
        solver.setType("preonly")
        precondition.setType(DIRECT[name])
        precondition.setFactorSolverType(name)
        matrix.setOption(PETSc.Mat.Option.SPD, DIRECT[name] == "cholesky")
    else:
        solver.setType("cg")
        precondition.setType(name)
    set_up = seconds(solver.setUp)
    iterations = []

    def solve():
        for side, x in zip(sides, found):
            x.set(0)
            solver.solve(side, x)
            if solver.getConvergedReason() < 0:
                sys.exit(f"{name} did not converge: reason {solver.getConvergedReason()}")
            iterations.append(solver.getIterationNumber())

    first, later = seconds(solve), seconds(solve)
    largest = max(x.norm(PETSc.NormType.INFINITY) for x in ours)
    for x, y in zip(found, ours):
        x.axpy(-1, y)
    difference = max(x.norm(PETSc.NormType.INFINITY) for x in found) / largest
    if PETSc.COMM_WORLD.getRank() == 0:
        print(json.dumps({"first": set_up + first, "later": later, "iterations": max(iterations),
                          "difference": difference}))


if __name__ == "__main__":
    main()
