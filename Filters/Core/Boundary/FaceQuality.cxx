// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FaceQuality.h"

#include "Boundary/SurfaceEdges.h"
#include "Support/Error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace
{
/// Returns cof(F) of the affine map that fits a surface's motion: it maps undeformed normals to
/// moved ones.
Eigen::Matrix3d normalMap(
  const ConstPoints& rest, const ConstPoints& moved, const std::vector<Index>& nodes)
{
  const double n = static_cast<double>(nodes.size());
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero(), shift = center;
  for (Index node : nodes)
  {
    center += rest.row(node) / n;
    shift += (moved.row(node) - rest.row(node)) / n;
  }
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero(), P = Q;
  for (Index node : nodes)
  {
    const Eigen::RowVector3d d = rest.row(node) - center;
    Q += d.transpose() * d;
    P += (moved.row(node) - rest.row(node) - shift).transpose() * d;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Q);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j)
  {
    if (axes.eigenvalues()[j] > 1e-10 * axes.eigenvalues()[2])
    {
      inverse[j] = 1 / axes.eigenvalues()[j];
    }
  }
  // F is the identity across a plane; this has no effect, as cof(F) n is the cross product of two
  // moved tangents.
  const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + P * axes.eigenvectors() *
                                                            inverse.asDiagonal() *
                                                            axes.eigenvectors().transpose();
  Eigen::Matrix3d cofactor;
  for (int j = 0; j < 3; ++j)
  {
    cofactor.col(j) = F.col((j + 1) % 3).cross(F.col((j + 2) % 3));
  }
  return cofactor;
}

double leastCorner(
  const ConstPoints& x, const Index* nodes, Index size, const Eigen::RowVector3d& normal)
{
  double least = std::numeric_limits<double>::infinity();
  bool turned = false;
  for (Index k = 0; k < size; ++k)
  {
    const Eigen::RowVector3d a = x.row(nodes[(k + 1) % size]) - x.row(nodes[k]);
    const Eigen::RowVector3d b = x.row(nodes[(k + size - 1) % size]) - x.row(nodes[k]);
    const double lengths = a.norm() * b.norm();
    const Eigen::RowVector3d area = a.cross(b);
    const double sine = lengths > 0 ? area.norm() / lengths : 0;
    turned = area.dot(normal) < 0;
    // The corners of a triangle turn together: its sign applies to the minimum.
    least = std::min(least, turned && size == 4 ? -sine : sine);
  }
  return size == 3 ? (turned ? -least : least) * 2 / std::sqrt(3.) : least;
}
}

FaceQuality faceQuality(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  FaceQuality quality;
  quality.scaledJacobian.assign(count, std::numeric_limits<double>::quiet_NaN());
  quality.normal = Points::Zero(count, 3);
  for (const GeometrySurface& surface : geometry.surfaces)
  {
    const Eigen::Matrix3d cofactor = normalMap(rest, moved, surface.nodes);
    for (Index f : surface.faces)
    {
      const Index* nodes = faces.connectivity.data() + faces.offsets[f];
      const Index size = faces.offsets[f + 1] - faces.offsets[f];
      quality.normal.row(f) = vectorArea(rest, nodes, size) * cofactor.transpose();
      if (size == 3 || size == 4)
      {
        quality.scaledJacobian[f] = leastCorner(moved, nodes, size, quality.normal.row(f));
      }
    }
  }
  Index measured = 0;
  quality.minimum = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < count; ++f)
  {
    const double value = quality.scaledJacobian[f];
    if (std::isnan(value))
    {
      continue;
    }
    ++measured;
    quality.mean += value;
    quality.minimum = std::min(quality.minimum, value);
    if (value <= 0)
    {
      quality.folded.push_back(f);
    }
  }
  quality.mean /= static_cast<double>(measured); // NaN without a face
  quality.minimum = measured > 0 ? quality.minimum : quality.mean;
  return quality;
}

namespace
{
/// Whether the corners of a quadrilateral turn different ways.
bool isBowTie(const ConstPoints& points, const Index* nodes, Index size)
{
  if (size != 4)
  {
    return false;
  }
  const Eigen::RowVector3d area = vectorArea(points, nodes, size);
  for (Index k = 0; k < size; ++k)
  {
    const Eigen::RowVector3d a = points.row(nodes[(k + 1) % size]) - points.row(nodes[k]);
    const Eigen::RowVector3d b = points.row(nodes[(k + size - 1) % size]) - points.row(nodes[k]);
    if (!(a.cross(b).dot(area) > 0))
    {
      return true;
    }
  }
  return false;
}

enum class State : char
{
  Straight, ///< by faceQuality()
  BowTie,
  Turned, ///< not visited yet
  Visited
};

/// The rim of a patch of turned faces: its edges with a straight face of the same surface on the
/// other side.
struct Rim
{
  Index edges = 0;
  Index against = 0;    ///< number of these edges where the moved faces oppose each other
  bool bowTies = false; ///< the patch is next to such faces

  void add(double cosine)
  {
    ++this->edges;
    this->against += cosine <= 0 ? 1 : 0;
  }
  bool isFold() const { return this->edges > 0 ? 2 * this->against >= this->edges : this->bowTies; }
};

/// Calls body(g) once an edge for f and for the faces g of its surface that share the edge.
template <typename Body>
void forNeighbors(const Classification& geometry, Index f, const Body& body)
{
  const SurfaceEdges& edges = geometry.edges;
  for (const Index* e = edges.ofFace.begin(f); e != edges.ofFace.end(f); ++e)
  {
    for (const Index* g = edges.faces.begin(*e); g != edges.faces.end(*e); ++g)
    {
      if (geometry.surfaceOfFace[*g] == geometry.surfaceOfFace[f])
      {
        body(*g);
      }
    }
  }
}
}

std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry)
{
  const auto nodesOf = [&](Index f) { return faces.connectivity.data() + faces.offsets[f]; };
  const auto sizeOf = [&](Index f) { return faces.offsets[f + 1] - faces.offsets[f]; };
  std::vector<State> state(geometry.surfaceOfFace.size(), State::Straight);
  const std::vector<Index> candidates = faceQuality(rest, moved, faces, geometry).folded;
  std::vector<Index> folded, patch;
  for (Index f : candidates)
  {
    const bool bowTie = isBowTie(moved, nodesOf(f), sizeOf(f));
    state[f] = bowTie ? State::BowTie : State::Turned;
    if (bowTie)
    {
      folded.push_back(f);
    }
  }
  for (Index first : candidates)
  {
    if (state[first] != State::Turned)
    {
      continue;
    }
    Rim rim;
    state[first] = State::Visited;
    patch.assign(1, first);
    for (std::size_t next = 0; next < patch.size(); ++next)
    {
      const Index f = patch[next];
      forNeighbors(geometry, f,
        [&](Index g)
        {
          if (state[g] == State::Turned)
          {
            state[g] = State::Visited;
            patch.push_back(g);
          }
          rim.bowTies = rim.bowTies || state[g] == State::BowTie;
          if (state[g] == State::Straight)
          {
            rim.add(vectorArea(moved, nodesOf(f), sizeOf(f))
                      .dot(vectorArea(moved, nodesOf(g), sizeOf(g))));
          }
        });
    }
    if (rim.isFold())
    {
      folded.insert(folded.end(), patch.begin(), patch.end());
    }
  }
  std::sort(folded.begin(), folded.end());
  return folded;
}

std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<char>& isFixed)
{
  std::vector<Index> folded = foldedFaces(rest, moved, faces, geometry);
  const Index* nodes = faces.connectivity.data();
  const auto end = std::remove_if(folded.begin(), folded.end(),
    [&](Index f)
    {
      return !std::all_of(nodes + faces.offsets[f], nodes + faces.offsets[f + 1],
        [&](Index node) { return isFixed[node] != 0; });
    });
  folded.erase(end, folded.end());
  return folded;
}
}
