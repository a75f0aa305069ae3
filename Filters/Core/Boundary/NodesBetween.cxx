// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/NodesBetween.h"

#include "Geometry/AffineFit.h"
#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Support/Lists.h"

#include <algorithm>
#include <map>
#include <utility>

namespace morph
{
Eigen::VectorXd weightsBetween(const BoundaryFaces& faces, Index node, const Points& rest)
{
  const std::vector<Index> corners(faces.between.begin(node), faces.between.end(node));
  if (corners.empty())
  {
    return {};
  }
  const Eigen::RowVector3d place = rest.row(faces.nodes[node]);
  return AffineLeastSquares(rest(corners, allColumns), place).weights(place);
}

std::vector<Index> nodesOnLinearEdges(const Mesh& mesh, const BoundaryFaces& faces)
{
  std::map<std::pair<Index, Index>, Index> middle; // of edges
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const auto k = static_cast<Index>(i);
    const Index* ends = faces.between.begin(k);
    if (faces.between.end(k) - ends == 2)
    {
      middle.emplace(std::minmax(ends[0], ends[1]), k);
    }
  }
  std::vector<Index> result;
  const auto take = [&](const Index* face, Index size)
  {
    for (Index k = 0; k < size; ++k)
    {
      const auto found = middle.find(std::minmax(face[k], face[(k + 1) % size]));
      if (found != middle.end())
      {
        result.push_back(found->second);
      }
    }
  };
  for (Index c = 0; c < mesh.numberOfCells() && !middle.empty(); ++c)
  {
    const CellShape* shape = volumeShape(mesh, c);
    if (isPolyhedron(mesh, c) || (shape && shape->numberOfNodes == shape->numberOfCorners))
    {
      forEachSide(mesh, c, take);
    }
  }
  sortUnique(result);
  return result;
}

Parting partingNodes(const std::vector<Index>& onLinearEdges, const BoundaryFaces& faces,
  const Points& rest, const Points& moved, double size)
{
  Parting result;
  for (const Index k : onLinearEdges)
  {
    const Index node = faces.nodes[k];
    const auto shift = [&](Index n) { return Eigen::RowVector3d(moved.row(n) - rest.row(n)); };
    const double gap = (shift(node) - meanBetween(faces, k, rest, shift)).norm();
    if (gap > 1e-6 * size)
    {
      result.nodes.push_back(node);
      result.largest = std::max(result.largest, gap);
    }
  }
  return result;
}
}
