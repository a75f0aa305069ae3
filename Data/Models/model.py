# SPDX-License-Identifier: BSD-3-Clause
"""What all models have in common: a parametric solid whose boundary nodes keep their place on the
geometry while its parameters change.

A node's *place* is a row of numbers that does not depend on the parameters: on which part of the
boundary it lies, and its surface coordinates there (an angle, a fraction of a length, ...). A model
finds the places of the boundary nodes of a mesh at S_0 (`locate`) and evaluates places on any other
shape (`positions`). Every node so moves exactly on the true surface.
"""

from abc import ABC, abstractmethod
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .classified_mesh import ClassifiedMesh
from .model_mesh import read_mesh

SMALL_FILES = Path(__file__).resolve().parent / "small"


class Curve(NamedTuple):
    """Where two surfaces meet. A closed curve is a circle with one vertex, at angle 0, and the
    parameter angle / 2 pi; an open one is a straight line between two vertices. Both parameters are
    fractions of the arc length."""

    surfaces: tuple
    closed: bool = True


class Counts(NamedTuple):
    """Of nodes and of cells."""

    nodes: int
    cells: int


class Model(ABC):
    """One of the four models. All numbers of a geometry are 0, 1, ... within their dimension.

    name: as in file names.
    initial, final: the Shape S_0 and S_F.
    last: the largest t the model is meant for; its geometry ends soon after.
    Surface: IntEnum of the surfaces; `curves`: tuple of Curve; `corners`: tuple of the sets of
        three surfaces that meet in a vertex. The vertices are the corners, then one for each closed
        curve in turn.
    paper: Counts of Table 1 of the paper by kind of mesh, "hex" and "tet".
    """

    name = ""
    initial = final = None
    last = 1.0
    Surface = None
    curves = ()
    corners = ()
    paper = {}

    # What a model knows of its geometry.

    @abstractmethod
    def locate(self, points):
        """The places (n, k) of boundary points (n, 3) of S_0; those on curves and vertices exactly
        so. Raises ValueError for a point that is not on the boundary."""

    @abstractmethod
    def positions(self, places, shape):
        """(n, 3): the exact positions of places on a Shape."""

    @abstractmethod
    def on_surfaces(self, places):
        """(n, #surfaces) bool: on which surfaces places are."""

    @abstractmethod
    def angles(self, places):
        """(n,): radians about the axis of the closed curve a place is on; exactly 0 at its vertex.
        No meaning elsewhere."""

    @abstractmethod
    def normals(self, surfaces, points, shape):
        """(n, 3): true unit normals, out of the solid, of the surface of each point, (n,), at
        points (n, 3) on it or near."""

    @abstractmethod
    def volume(self, shape):
        """By formula."""

    # What a model knows of its meshes.

    @abstractmethod
    def hex_mesh(self, small=False):
        """A ClassifiedMesh of hexahedra at S_0: at the paper's size, or small."""

    @abstractmethod
    def tet_mesh(self, small=False):
        """A ClassifiedMesh of tetrahedra at S_0, by Gmsh: at the paper's size, or small. The same
        call on the same machine gives the same mesh. Initializes and finalises Gmsh: anything else
        the process had in it is lost. Raises RuntimeError if Gmsh fails."""

    # The same for all.

    def parameters(self, t):
        """The Shape S_t = S_0 + t (S_F - S_0). Raises ValueError where that is no solid; t is meant
        to be in [0, last]."""
        return self.initial.toward(self.final, t)

    def make(self, kind, small=False):
        """hex_mesh for "hex", tet_mesh for "tet". Raises ValueError for another kind."""
        return {"hex": self.hex_mesh, "tet": self.tet_mesh}[_known(kind)](small)

    def small_file(self, kind):
        """Path of the committed small mesh, kind "hex" or "tet"."""
        return SMALL_FILES / f"{self.name}_{_known(kind)}_small.vtu"

    def read_small(self, kind):
        """The committed small mesh as a ClassifiedMesh: as make(kind, small=True), without Gmsh."""
        return self.classified(read_mesh(self.small_file(kind)))

    def classified(self, mesh):
        """Takes over a ModelMesh of S_0: finds its boundary nodes' places and puts these nodes
        there, to the last bit."""
        return ClassifiedMesh.of(self, mesh)

    @property
    def vertices(self):
        """tuple of (surfaces, curve): the surfaces that meet in each vertex, and the id of the
        closed curve it is on, or None."""
        corners = tuple((frozenset(corner), None) for corner in self.corners)
        return corners + tuple((frozenset(curve.surfaces), number)
                               for number, curve in enumerate(self.curves) if curve.closed)

    def curve_ends(self, curve):
        """Ids of the two vertices, ascending, at the ends of an open curve."""
        ends = [number for number, corner in enumerate(self.corners)
                if set(self.curves[curve].surfaces) <= set(corner)]
        if len(ends) != 2:
            raise ValueError(f"curve {curve} of {self.name} has {len(ends)} ends, not 2")
        return ends


def snapped(values, tolerance):
    """The values, those within `tolerance` of a whole number rounded to it: the coordinates of
    places are whole on curves and vertices."""
    whole = np.round(values)
    return np.where(np.abs(values - whole) <= tolerance, whole, values)


def _known(kind):
    if kind not in ("hex", "tet"):
        raise ValueError(f"no kind of mesh '{kind}': hex or tet")
    return kind
