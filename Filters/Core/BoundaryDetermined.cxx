// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryDetermined.h"

#include "CellShape.h"
#include "SimplicialDecomposition.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace morph
{
std::vector<Index> boundaryDeterminedInversions(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points)
{
  std::vector<char> prescribed(mesh.numberOfNodes(), 0);
  for (Index node : partition.prescribed)
  {
    prescribed[node] = 1;
  }
  std::vector<Index> result;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const Index* nodes = mesh.cell(c);
    const auto inverted = [&](const WeightedTet& tet)
    {
      Index id[4];
      for (int k = 0; k < 4; ++k)
      {
        id[k] = nodes[shape.cornerNode[tet.corner[k]]];
        if (!prescribed[id[k]])
        {
          return false;
        }
      }
      const Eigen::RowVector3d o = points.row(id[0]);
      const Eigen::RowVector3d a = points.row(id[1]) - o, b = points.row(id[2]) - o,
                               d = points.row(id[3]) - o;
      return !(orientation[c] * a.dot(b.cross(d)) > 0);
    };
    const WeightedTet* tets = simplicialDecomposition(shape.shape).tets;
    if (std::any_of(tets, tets + cornerTetrahedra(shape.shape), inverted))
    {
      result.push_back(c);
    }
  }
  return result;
}
}
