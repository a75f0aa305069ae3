// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PlaceOfNode.h"

#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"

#include <utility>

namespace morph
{
void addHalfSpaces(const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index c,
  Index node, const std::vector<char>& isPrescribed, const Points& points,
  std::vector<HalfSpace>& result)
{
  const CellShape& shape = *cellShape(mesh.types[c]);
  const WeightedTet* tets = simplicialDecomposition(shape.shape).tets;
  for (int t = 0; t < cornerTetrahedra(shape.shape); ++t)
  {
    std::array<Index, 4> id = nodesAt(mesh, c, shape, tets[t].corner);
    int own = -1, prescribed = 0;
    for (int k = 0; k < 4; ++k)
    {
      own = id[k] == node ? k : own;
      prescribed += isPrescribed[id[k]] ? 1 : 0;
    }
    if (own < 0 || prescribed != 3)
    {
      continue;
    }
    // Moves the node to the front, which inverts the tetrahedron unless it is there already.
    std::swap(id[0], id[own]);
    if ((own == 0) != (orientation[c] > 0))
    {
      std::swap(id[1], id[2]);
    }
    result.push_back({ points.row(id[1]), points.row(id[2]), points.row(id[3]) });
  }
}
}
