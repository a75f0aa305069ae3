# SPDX-License-Identifier: BSD-3-Clause
"""A model's mesh that knows which geometry owns each of its nodes, and so where its boundary is on
every other shape of the model."""

from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from .classification import face_surfaces, owners
from .model_mesh import ModelMesh, add_array, vtk_points


@dataclass
class ClassifiedMesh(ModelMesh):
    """A ModelMesh at S_0 of `model`. The arrays of length #nodes cover interior nodes too.

    nodes: (#boundary nodes,) ascending ids of the nodes on the boundary.
    places: (#boundary nodes, k) their places on the model (see Model).
    geometry_dimension: (#nodes,) int8: 0 vertex, 1 curve, 2 surface, 3 volume.
    geometry_id: (#nodes,) int32: which vertex, curve, or surface; 0 for the one volume.
    curve_parameter: (#nodes,) in [0, 1] for nodes on curves, 0 for all others.
    faces: (#faces, 3 or 4) node ids, seen from outside counterclockwise; face_surface: (#faces,)
        int32, the surface of each.
    """

    model: object
    nodes: np.ndarray
    places: np.ndarray
    geometry_dimension: np.ndarray
    geometry_id: np.ndarray
    curve_parameter: np.ndarray
    faces: np.ndarray
    face_surface: np.ndarray

    @classmethod
    def of(cls, model, mesh):
        """See Model.classified. Takes over the arrays of `mesh`."""
        faces = mesh.boundary_faces()
        nodes, corners = np.unique(faces, return_inverse=True)
        corners = corners.reshape(faces.shape)
        places = model.locate(mesh.points[nodes])
        mesh.points[nodes] = model.positions(places, model.initial)
        boundary = mesh.points[nodes]
        found = owners(model, places, boundary)
        dimension = np.full(len(mesh.points), 3, np.int8)
        number = np.zeros(len(mesh.points), np.int32)
        parameter = np.zeros(len(mesh.points))
        dimension[nodes], number[nodes] = found.dimension, found.number
        parameter[nodes] = found.curve_parameter
        return cls(mesh.points, mesh.cells, mesh.cell_type, model, nodes, places, dimension, number,
                   parameter, faces, face_surfaces(model, places, boundary, corners))

    def boundary_positions(self, t):
        """(#boundary nodes, 3): exact positions of `nodes` at S_t ("exact surfaces"); at t = 0 the
        mesh's own, bit for bit."""
        return self.model.positions(self.places, self.model.parameters(t))

    @property
    def curve_nodes(self):
        """Ascending ids of the nodes on vertices and curves."""
        return np.flatnonzero(self.geometry_dimension < 2)

    def curve_positions(self, t):
        """(#curve_nodes, 3): exact positions of `curve_nodes` at S_t, for methods that find the
        surfaces themselves."""
        return self.boundary_positions(t)[self.geometry_dimension[self.nodes] < 2]

    def moved(self, t):
        """(#nodes, 3): the points with the boundary at S_t and the interior at rest."""
        points = self.points.copy()
        points[self.nodes] = self.boundary_positions(t)
        return points

    def to_vtk(self, points=None):
        """ModelMesh.to_vtk with point arrays GeometryDimension, GeometryId, CurveParameter, and
        FinalDisplacement: that of boundary nodes from S_0 to S_F, 0 for interior nodes."""
        grid = super().to_vtk(points)
        self._add_ownership(grid.GetPointData(), np.arange(len(self.points)))
        add_array(grid.GetPointData(), "FinalDisplacement", self.moved(1) - self.points)
        return grid

    def boundary_to_vtk(self, t):
        """The boundary at S_t as vtkPolyData, one polygon for each of `faces`, a point for each of
        `nodes`: what a morphing filter takes as displaced boundary. Point arrays as to_vtk, with
        MorphPointId and RestPosition (see vtkExtractMorphBoundary); cell array GeometryId: the
        surface."""
        surface = self._points_to_vtk(self.nodes, self.boundary_positions(t))
        surface.SetPolys(_cell_array(np.searchsorted(self.nodes, self.faces)))
        add_array(surface.GetCellData(), "GeometryId", self.face_surface)
        return surface

    def curves_to_vtk(self, t):
        """Vertices and curves alone at S_t as vtkPolyData: a line for each edge of the mesh on a
        curve, arrays as boundary_to_vtk; cell array GeometryId: the curve."""
        edges, curves = self.curve_edges()
        lines = self._points_to_vtk(self.curve_nodes, self.curve_positions(t))
        lines.SetLines(_cell_array(np.searchsorted(self.curve_nodes, edges)))
        add_array(lines.GetCellData(), "GeometryId", curves)
        return lines

    def curve_edges(self):
        """(#edges, 2) node ids of the mesh edges on curves, where faces of two surfaces meet, and
        (#edges,) int32: the curve of each."""
        ends = np.stack([self.faces, np.roll(self.faces, -1, axis=1)], axis=-1).reshape(-1, 2)
        surface = np.repeat(self.face_surface, self.faces.shape[1])
        ends = np.sort(ends, axis=1)
        order = np.lexsort((ends[:, 1], ends[:, 0]))
        first, second = order[0::2], order[1::2]  # a closed surface: every edge has two faces
        between = surface[first] != surface[second]
        first, second = first[between], second[between]
        ids = {frozenset(curve.surfaces): number
               for number, curve in enumerate(self.model.curves)}
        pairs = zip(surface[first].tolist(), surface[second].tolist())
        return ends[first], np.array([ids[frozenset(pair)] for pair in pairs], np.int32)

    def _points_to_vtk(self, ids, positions):
        data = vtkPolyData()
        data.SetPoints(vtk_points(positions))
        self._add_ownership(data.GetPointData(), ids)
        array = numpy_to_vtkIdTypeArray(ids.astype(np.int64), deep=1)
        array.SetName("MorphPointId")
        data.GetPointData().AddArray(array)
        rest = np.column_stack([self.points[ids], np.ones(len(ids))])
        add_array(data.GetPointData(), "RestPosition", rest)
        return data

    def _add_ownership(self, attributes, ids):
        add_array(attributes, "GeometryDimension", self.geometry_dimension[ids])
        add_array(attributes, "GeometryId", self.geometry_id[ids])
        add_array(attributes, "CurveParameter", self.curve_parameter[ids])


def _cell_array(cells):
    count, corners = cells.shape
    array = vtkCellArray()
    array.SetData(
        numpy_to_vtkIdTypeArray(np.arange(count + 1, dtype=np.int64) * corners, deep=1),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, dtype=np.int64).ravel(), deep=1))
    return array
