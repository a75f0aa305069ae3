#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""FEMWARP beside the inversion-free morph, with default settings, on the models' exact surfaces.

    pvpython Utilities/inversion_free_table.py    # a minute on an idle machine; needs no Gmsh

Prints a table: minimum scaled Jacobian, and in parentheses the number of inverted cells where there
are any."""

import argparse
import sys
from pathlib import Path
from typing import NamedTuple

from paraview import simple

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from demo_picture import producer  # noqa: E402  (needs the path above)
import Models  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from models_folds import output  # noqa: E402

METHODS = ("MorphFEMWARP", "MorphInversionFree")
#: How far the canister's hole moves from S_0 to S_F.
CANISTER_OFFSET = 0.5


class Case(NamedTuple):
    """A model's mesh, small or at the paper's size, and how far it goes: 1 is S_F."""

    model: str
    kind: str
    small: bool
    t: float

    @property
    def title(self):
        if self.model == "canister":
            where = f"offset {CANISTER_OFFSET * self.t:.2f}"
        else:
            where = "S_F" if self.t == 1 else f"t = {self.t}"
        return f"{'small ' if self.small else ''}{self.model} {self.kind}, {where}"

    def mesh(self):
        model = Models.get(self.model)
        return model.read_small(self.kind) if self.small else model.make(self.kind)


CASES = (
    *(Case("bore", "hex", False, t) for t in (1, 1.55)),
    *(Case("pipe", "hex", False, t) for t in (1, 1.95)),
    *(Case("canister", "hex", True, t) for t in (0.24, 0.48, 0.72, 0.96, 1.2, 1.44)),
    *(Case("canister", "tet", True, t) for t in (0.96, 1.2)),
)


def morphed(method, mesh, t, **properties):
    """The grid that a filter of the plugin makes of a ClassifiedMesh with its boundary at S_t.
    Raises RuntimeError where it makes none."""
    rest, boundary = producer(mesh.to_vtk()), producer(mesh.boundary_to_vtk(t))
    morph = getattr(simple, method)(Input=rest, Boundary=boundary, **properties)
    morph.UpdatePipeline()
    made = output(morph)
    if made.GetNumberOfCells() != len(mesh.cells):
        raise RuntimeError(f"{mesh.model.name}: {method} gave no mesh at t = {t}")
    grid = made.NewInstance()
    grid.ShallowCopy(made)
    for proxy in (morph, rest, boundary):
        simple.Delete(proxy)
    return grid


def number(grid, name):
    """A number that the filter wrote as field data."""
    return grid.GetFieldData().GetArray(name).GetValue(0)


def quality(grid):
    """The text of a table's cell."""
    inverted = int(number(grid, "InvertedCells"))
    if inverted:
        return f"({inverted:,})"
    # Where sub-steps ended before S_t the number is not that of S_t.
    step = number(grid, "LargestValidStep")
    return f"{number(grid, 'MinScaledJacobian'):.3f}{'' if step == 1 else f' at {step} of it'}"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    add_plugin(parser)
    return parser.parse_args()


def main():
    load_plugin(parse_arguments().plugin)
    print("| mesh and shape | FEMWARP | inversion-free |\n|---|---|---|")
    for case in CASES:
        mesh = case.mesh()
        # The table itself counts FEMWARP's inverted cells.
        cells = (quality(morphed(method, mesh, case.t, **options))
                 for method, options in zip(METHODS, ({"Validity": "None"}, {})))
        print(f"| {case.title} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
