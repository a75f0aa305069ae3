// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FaceAreas.h"

#include "Boundary/SurfaceEdges.h"
#include "Support/Error.h"

#include <algorithm>

namespace morph
{
namespace
{
class NodeSums
{
public:
  explicit NodeSums(const BoundaryFaces& faces)
    : faces_(faces)
    , row_(faces.nodes.empty() ? 0 : faces.nodes.back() + 1, -1)
    , between_(faces.nodes.size())
  {
    for (std::size_t i = 0; i < faces.nodes.size(); ++i)
    {
      this->row_[faces.nodes[i]] = static_cast<Index>(i);
    }
    for (Index i = 0; i < static_cast<Index>(faces.nodes.size()); ++i)
    {
      if (faces.between.begin(i) != faces.between.end(i))
      {
        this->between_[this->row_[*faces.between.begin(i)]].push_back(i);
      }
    }
  }

  /// Sums over faces that have the node as a corner or, for a node between corners, all of these.
  /// Unless `isChosen` is null, only chosen faces count.
  Points sum(const Points& areas, const std::vector<std::uint8_t>* isChosen) const
  {
    Points result = Points::Zero(static_cast<Index>(this->faces_.nodes.size()), 3);
    for (Index f = 0; f < areas.rows(); ++f)
    {
      if (isChosen && !(*isChosen)[f])
      {
        continue;
      }
      for (Index k = this->faces_.offsets[f]; k < this->faces_.offsets[f + 1]; ++k)
      {
        const Index corner = this->row_[this->faces_.connectivity[k]];
        result.row(corner) += areas.row(f);
        for (Index node : this->between_[corner])
        {
          if (this->liesIn(node, f))
          {
            result.row(node) += areas.row(f);
          }
        }
      }
    }
    return result;
  }

private:
  bool liesIn(Index node, Index face) const
  {
    const auto begin = this->faces_.connectivity.begin() + this->faces_.offsets[face];
    const auto end = this->faces_.connectivity.begin() + this->faces_.offsets[face + 1];
    return std::all_of(this->faces_.between.begin(node), this->faces_.between.end(node),
      [&](Index corner) { return std::find(begin, end, corner) != end; });
  }

  const BoundaryFaces& faces_;
  std::vector<Index> row_; ///< of a node in faces.nodes
  /// For each row, the rows of the nodes of which it is the first corner.
  std::vector<std::vector<Index>> between_;
};
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
  const NodeSums sums(faces);
  const Points chosen = sums.sum(areas, &isChosen), all = sums.sum(areas, nullptr);
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
                ": the areas of the faces around them cancel out or are zero. Move them by a "
                "vector, or leave them out.");
  }
  return normals;
}
}
