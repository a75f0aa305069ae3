// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

/// Meshes with polyhedra, for the tests of the core and of the filters.
namespace meshes
{
/// Adds a polyhedron; its nodes are those of its faces, ascending.
void addPolyhedron(Mesh& mesh, const std::vector<std::vector<Index>>& faces);
/// The same cells, those that are chosen given as polyhedra; all where `isChosen` is empty.
Mesh asPolyhedra(const Mesh& mesh, const std::function<bool(Index cell)>& isChosen = {});
/// n x n x n hexagonal prisms that fill space, as polyhedra.
Mesh honeycomb(int n);
/// n x n boxes of size 2, on top of them 2n x 2n x 2 hexahedra of size 1: the boxes' upper faces
/// are split into four, and their sides have five nodes. Polyhedra below, hexahedra above.
Mesh refinedLayer(int n);
/// The Voronoi cells of n x n x n random points in a box, each in a unit cube of its own.
Mesh voronoi(int n);
/// 4 x 4 x 4 hexahedra of a kind; an edge inside has no length, so that four have seven corners.
Mesh collapsed(const CellKind& kind);
/// Some of the others, jittered inside, with a name for the message.
std::vector<std::pair<std::string, Mesh>> polyhedral();
}
