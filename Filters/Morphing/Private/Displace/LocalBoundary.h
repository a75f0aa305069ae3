// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"

#include <vector>

namespace morph::filters
{
/// A boundary by itself: its nodes are numbered from 0 on, in the order of their numbers in the
/// mesh. What moves a boundary takes as long as its nodes are many, not those of the mesh.
class LocalBoundary
{
public:
  /// Renumbers the boundary of `model`, unless it is that of the last call.
  void Update(const BoundaryModel& model);

  /// The mesh's number of each node, ascending.
  const std::vector<morph::Index>& Nodes() const { return this->NodeOf; }
  const morph::Points& Points() const { return this->Positions; } ///< #Nodes() x 3, current
  const morph::BoundaryFaces& Faces() const { return this->Polygons; }
  const morph::Classification& Geometry() const { return this->Entities; }
  const std::vector<morph::Index>& BodyOfNode() const { return this->Bodies; }
  /// The numbers here of nodes of the boundary.
  std::vector<morph::Index> NumbersOf(const std::vector<morph::Index>& nodes) const;

private:
  vtkIdType Version = -1; ///< BoundaryModel::MotionVersion() of all of this
  std::vector<morph::Index> NodeOf;
  morph::Points Positions;
  morph::BoundaryFaces Polygons;
  morph::Classification Entities;
  std::vector<morph::Index> Bodies;
  std::vector<morph::Index> Number; ///< #nodes of the mesh, -1 inside
};
}
