// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/LayerMotion.h"

#include "Boundary/FaceAreas.h"
#include "Geometry/RigidFit.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <unordered_map>

namespace morph
{
namespace
{
/// The rotation of each wall node.
std::vector<Eigen::Matrix3d> wallRotations(const Points& rest, const Points& moved,
  const BoundaryFaces& faces, const std::vector<std::uint8_t>& isWall,
  const std::vector<Index>& walls)
{
  const Points areas = faceAreas(rest, faces), areasMoved = faceAreas(moved, faces);
  struct Sums
  {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(), normalMoved = normal;
    double size = 0;
  };
  std::vector<Sums> sums(walls.size());
  for (std::size_t f = 0; f < isWall.size(); ++f)
  {
    const Index first = faces.offsets[f], last = faces.offsets[f + 1];
    for (Index k = first; isWall[f] && k < last; ++k)
    {
      const Index node = faces.connectivity[k];
      Sums& sum = sums[std::lower_bound(walls.begin(), walls.end(), node) - walls.begin()];
      const auto row = static_cast<Index>(f);
      sum.normal += areas.row(row).normalized().transpose();
      sum.normalMoved += areasMoved.row(row).normalized().transpose();
      for (const Index other : { faces.connectivity[k + 1 < last ? k + 1 : first],
             faces.connectivity[k > first ? k - 1 : last - 1] })
      {
        const Eigen::Vector3d e = (rest.row(other) - rest.row(node)).transpose();
        const Eigen::Vector3d to = (moved.row(other) - moved.row(node)).transpose();
        sum.moment += e * to.transpose();
        sum.size += e.squaredNorm();
      }
    }
  }
  std::vector<Eigen::Matrix3d> rotations;
  for (const Sums& sum : sums)
  {
    const Eigen::Vector3d n = sum.normal.normalized(), to = sum.normalMoved.normalized();
    const Eigen::Matrix3d near = nearestRotation(sum.moment + sum.size * n * to.transpose());
    const Eigen::Vector3d turned = near * n;
    rotations.emplace_back(
      Eigen::Quaterniond::FromTwoVectors(turned, to).toRotationMatrix() * near);
  }
  return rotations;
}

/// The normals of the moved faces outside the wall, at each boundary node of a column.
std::unordered_map<Index, std::vector<Eigen::RowVector3d>> sideNormals(const Points& moved,
  const BoundaryFaces& faces, const std::vector<std::uint8_t>& isWall, const WallLayers& layers)
{
  std::unordered_map<Index, std::vector<Eigen::RowVector3d>> normals;
  for (const Index node : layers.columns.values)
  {
    if (std::binary_search(faces.nodes.begin(), faces.nodes.end(), node))
    {
      normals[node];
    }
  }
  if (normals.empty())
  {
    return normals;
  }
  const Points areas = faceAreas(moved, faces);
  for (std::size_t f = 0; f < isWall.size(); ++f)
  {
    const Eigen::RowVector3d normal = areas.row(static_cast<Index>(f)).normalized();
    for (Index k = faces.offsets[f]; !isWall[f] && k < faces.offsets[f + 1]; ++k)
    {
      const auto found = normals.find(faces.connectivity[k]);
      if (found != normals.end() && normal.allFinite())
      {
        found->second.push_back(normal);
      }
    }
  }
  return normals;
}

/// The nearest point to `x` of the planes through `at` with these normals. Normals nearly alike are
/// one plane.
Eigen::RowVector3d ontoPlanes(const Eigen::RowVector3d& x, const Eigen::RowVector3d& at,
  const std::vector<Eigen::RowVector3d>& normals)
{
  if (normals.empty())
  {
    return x;
  }
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Eigen::RowVector3d& normal : normals)
  {
    moment += normal.transpose() * normal;
  }
  constexpr double Alike = 0.1; // of the largest singular value: 18 degrees between two
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU);
  Eigen::RowVector3d result = x;
  for (int j = 0; j < 3 && svd.singularValues()[j] > Alike * svd.singularValues()[0]; ++j)
  {
    const Eigen::Vector3d axis = svd.matrixU().col(j);
    result -= (x - at).dot(axis.transpose()) * axis.transpose();
  }
  return result;
}
}

void moveLayers(const Points& rest, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, const WallLayers& layers, Points& moved)
{
  const std::vector<Eigen::Matrix3d> rotations =
    wallRotations(rest, moved, faces, isWall, layers.walls);
  const auto normals = sideNormals(moved, faces, isWall, layers);
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    const Index wall = layers.walls[i], column = static_cast<Index>(i);
    for (const Index* n = layers.columns.begin(column); n != layers.columns.end(column); ++n)
    {
      const Eigen::RowVector3d arm = rest.row(*n) - rest.row(wall);
      // Where nothing moves, bit for bit.
      const Eigen::RowVector3d shift =
        (moved.row(wall) - rest.row(wall)) + (arm * rotations[i].transpose() - arm);
      Eigen::RowVector3d to = rest.row(*n) + shift;
      const auto side = normals.find(*n);
      if (side != normals.end())
      {
        to = ontoPlanes(to, moved.row(*n), side->second);
      }
      moved.row(*n) = to;
    }
  }
}
}
