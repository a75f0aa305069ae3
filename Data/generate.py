#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the models' meshes and their boundaries' motion as files that ParaView opens.

For each model, kind of mesh and size, named <model>_<kind> or <model>_<kind>_small:

  NAME.vtu            the mesh at the initial shape S_0, with point arrays GeometryDimension,
                      GeometryId, CurveParameter (who owns a node) and FinalDisplacement (boundary
                      nodes, from S_0 to S_F; 0 inside)
  NAME_boundary.pvd   the boundary at S_0 + (i / N) (S_F - S_0), i = 0 ... N, on the exact surfaces:
                      the displaced boundary for a morphing filter
  NAME_curves.pvd     vertices and curves alone, for methods that find the surfaces themselves

Needs numpy and VTK for Python; for tetrahedra, the canister and the courier Gmsh (Debian:
python3-paraview, python3-gmsh). The small meshes are in Data/Models/small already; they were made
by: generate.py --size small --mesh-only --output Data/Models/small"""

import argparse
import sys
from pathlib import Path

import Models
from Models.vtk_files import write_grid, write_pvd


def write_series(name, output, times, make):
    """Writes make(t) for each of `times` and the .pvd that lists the files."""
    folder = output / f"{name}_series"
    folder.mkdir(exist_ok=True)
    files = [folder / f"{name}_{step:02d}.vtp" for step in range(len(times))]
    for file, t in zip(files, times):
        write_grid(make(t), file)
    write_pvd(output / f"{name}.pvd", files, times)


def print_counts(name, mesh, paper):
    """One line: our counts and those of the paper's Table 1, where the mesh is of that size."""
    line = f"{name:22}{len(mesh.points):>9,}{len(mesh.cells):>9,}"
    if paper:
        nodes, cells = len(mesh.points) / paper.nodes - 1, len(mesh.cells) / paper.cells - 1
        line += f"{paper.nodes:>11,}{paper.cells:>9,}{nodes:>+9.1%}{cells:>+8.1%}"
    print(line, flush=True)


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", metavar="MODEL",
                        help=f"{', '.join(Models.NAMES)} (default: these), or a variant:"
                             f" {', '.join(Models.VARIANTS)}")
    parser.add_argument("--kind", choices=("hex", "tet", "both"), default="both",
                        help="default: %(default)s")
    parser.add_argument("--size", choices=("paper", "small", "both"), default="paper",
                        help="default: %(default)s")
    parser.add_argument("--steps", type=int, default=20, metavar="N",
                        help="steps from the initial to the final shape (default: %(default)s)")
    parser.add_argument("--mesh-only", action="store_true", help="write no boundaries")
    parser.add_argument("--output", type=Path, default=Path("models-output"),
                        help="directory to write to (default: %(default)s)")
    arguments = parser.parse_args()
    known = Models.NAMES + Models.VARIANTS
    unknown = [name for name in arguments.models if name not in known]
    if unknown:
        parser.error(f"no model {', '.join(unknown)}: choose from {', '.join(known)}")
    if arguments.steps < 1:
        parser.error("--steps must be 1 or more")
    return arguments


def main():
    arguments = parse_arguments()
    output = arguments.output.resolve()
    output.mkdir(parents=True, exist_ok=True)
    kinds = ("hex", "tet") if arguments.kind == "both" else (arguments.kind,)
    sizes = ("paper", "small") if arguments.size == "both" else (arguments.size,)
    times = [step / arguments.steps for step in range(arguments.steps + 1)]

    print(f"{'':22}{'nodes':>9}{'cells':>9}{'Table 1':>11}{'':>9}{'differ':>9}")
    for model in map(Models.get, arguments.models or Models.NAMES):
        for small in (size == "small" for size in sizes):
            for kind in kinds:
                mesh = model.make(kind, small)
                name = f"{model.name}_{kind}" + ("_small" if small else "")
                print_counts(name, mesh, None if small else model.paper[kind])
                write_grid(mesh.to_vtk(), output / f"{name}.vtu")
                if not arguments.mesh_only:
                    write_series(f"{name}_boundary", output, times, mesh.boundary_to_vtk)
                    write_series(f"{name}_curves", output, times, mesh.curves_to_vtk)
    print(f"Written to {output}")


if __name__ == "__main__":
    sys.exit(main())
