// SPDX-License-Identifier: BSD-3-Clause
#include "FaceAreas.h"

#include "Error.h"
#include "SurfaceEdges.h"

#include <algorithm>

namespace morph
{
namespace
{
/// For each of faces.nodes the sum of the areas of the faces round it, or of those of them that are chosen.
Points sums(const Points& areas, const BoundaryFaces& faces, const std::vector<std::uint8_t>* isChosen)
{
  Points sum = Points::Zero(static_cast<Index>(faces.nodes.size()), 3);
  std::vector<Index> row;
  if (!faces.nodes.empty())
  {
    row.assign(faces.nodes.back() + 1, -1);
  }
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    row[faces.nodes[i]] = static_cast<Index>(i);
  }
  for (Index f = 0; f < areas.rows(); ++f)
  {
    for (Index k = faces.offsets[f]; (!isChosen || (*isChosen)[f]) && k < faces.offsets[f + 1]; ++k)
    {
      sum.row(row[faces.connectivity[k]]) += areas.row(f);
    }
  }
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i);
    for (const Index* corner = faces.between.begin(k); corner != faces.between.end(k); ++corner)
    {
      sum.row(k) += sum.row(row[*corner]);
    }
  }
  return sum;
}
}

Points faceAreas(const ConstPoints& points, const BoundaryFaces& faces)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  Points areas(count, 3);
  for (Index f = 0; f < count; ++f)
  {
    areas.row(f) = vectorArea(points, faces.connectivity.data() + faces.offsets[f],
      faces.offsets[f + 1] - faces.offsets[f]);
  }
  return areas;
}

Points nodeNormals(const Points& areas, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isChosen, const std::vector<Index>& nodes)
{
  const Points chosen = sums(areas, faces, &isChosen), all = sums(areas, faces, nullptr);
  const double least = 1e-12 * (areas.rows() > 0 ? areas.rowwise().norm().maxCoeff() : 0);
  Points normals(static_cast<Index>(nodes.size()), 3);
  std::vector<Index> without;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Index k =
      std::lower_bound(faces.nodes.begin(), faces.nodes.end(), nodes[i]) - faces.nodes.begin();
    const Eigen::RowVector3d sum = chosen.row(k).isZero(0) ? all.row(k) : chosen.row(k);
    const double size = sum.norm();
    if (!(size > least))
    {
      without.push_back(nodes[i]);
    }
    normals.row(static_cast<Index>(i)) = sum / size;
  }
  if (!without.empty())
  {
    throw Error("The boundary has no normal at node ids " + listIds(without) +
                ": the areas of the faces round them cancel out or are zero. Move them by a "
                "vector, or leave them out.");
  }
  return normals;
}
}
