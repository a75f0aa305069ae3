# SPDX-License-Identifier: BSD-3-Clause
"""Two bodies in contact: a sleeve of wedges within a block of hexahedra, whose nodes do not match.
The sleeve gets oval, and the block's hole keeps its gap to it."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run, wedges

BORE, SLEEVE, GAP, SIDE, HIGH, OVAL = 0.5, 0.8, 0.01, 3.0, 1.0, 0.18


def ring(around, rings, layers, inner, outer):
    """Between the curves inner and outer: functions of the angle, (n,), with values (n, 2)."""
    points, cells = block(rings, around, layers)
    angle = 2 * np.pi * points[:, 1]
    flat = inner(angle) + points[:, :1] * (outer(angle) - inner(angle))
    return joined((np.c_[flat, HIGH * points[:, 2]], cells))


def circle(radius):
    return lambda angle: radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def square(angle):
    flat = circle(1)(angle)
    return SIDE / 2 * flat / abs(flat).max(axis=1)[:, None]


def example(n=12):
    sleeve, sleeve_cells = ring(3 * n, n // 4, n // 3, circle(BORE), circle(SLEEVE))
    housing, housing_cells = ring(4 * n, n // 2, n // 2, circle(SLEEVE + GAP), square)
    points = np.concatenate([sleeve, housing])
    of_sleeve = np.arange(len(points)) < len(sleeve)

    oval = np.zeros(points.shape)
    angle = np.arctan2(points[:, 1], points[:, 0])
    oval[:, :2] = OVAL * np.cos(2 * angle)[:, None] * circle(1)(angle) * of_sleeve[:, None]
    before = mesh(points, wedges(sleeve_cells), hexahedra(housing_cells + len(sleeve)),
                  arrays={"sleeve": of_sleeve, "Oval": oval})
    after = MorphMesh(Input=before, Moving="Array", MovingArray="sleeve", Displacement="Array",
                      DisplacementArray="Oval", ContactDistance=2 * GAP)
    goal = np.where(of_sleeve[:, None], points + oval, np.nan)
    from_axis = np.hypot(points[:, 0], points[:, 1])
    goal[(from_axis > BORE + 1e-6) & (from_axis < SLEEVE - 1e-6)] = np.nan
    return Example("Contact: the sleeve gets oval, the hole around it keeps its gap", before,
                   after, goal, 20, 50)


if __name__ == "__main__":
    run(example())
