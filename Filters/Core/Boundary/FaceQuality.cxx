// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FaceQuality.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
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
}
