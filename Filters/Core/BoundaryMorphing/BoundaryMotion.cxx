// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/BoundaryMotion.h"

#include "Boundary/FaceQuality.h"
#include "Geometry/RotationFit.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <unordered_map>

namespace morph
{
Index BoundaryMotion::count(State wanted) const
{
  return std::count(this->state.begin(), this->state.end(), wanted);
}

std::vector<Index> BoundaryMotion::known() const
{
  std::vector<Index> ids;
  for (std::size_t n = 0; n < this->state.size(); ++n)
  {
    if (this->state[n] != Unknown)
    {
      ids.push_back(static_cast<Index>(n));
    }
  }
  return ids;
}

Points BoundaryMotion::moved() const
{
  Points result = this->rest;
  for (Index n = 0; n < result.rows(); ++n)
  {
    if (!this->displacement.row(n).isZero(0))
    {
      result.row(n) += this->displacement.row(n);
    }
  }
  result(this->givenIds, allColumns) = this->givenTargets;
  return result;
}

namespace
{
void validate(Index numberOfNodes, const BoundaryFaces& faces, const std::vector<Index>& ids,
  const ConstPoints& targets)
{
  if (ids.empty())
  {
    throw Error("No node of the boundary is given a new position, so nothing says where it goes. "
                "Give its vertices at least, or nodes on its curves or surfaces.");
  }
  if (static_cast<Index>(ids.size()) != targets.rows())
  {
    throw Error("There are " + std::to_string(ids.size()) + " nodes with " +
                std::to_string(targets.rows()) + " new positions; each needs one.");
  }
  std::vector<Index> wrong, inside, twice, notFinite;
  std::vector<std::uint8_t> seen(numberOfNodes, 0), isOuter(numberOfNodes, 0);
  for (const Index node : faces.nodes)
  {
    isOuter[node] = 1;
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const Index id = ids[i];
    if (id < 0 || id >= numberOfNodes)
    {
      wrong.push_back(id);
      continue;
    }
    if (!isOuter[id])
    {
      inside.push_back(id);
    }
    if (seen[id]++)
    {
      twice.push_back(id);
    }
    if (!targets.row(static_cast<Index>(i)).allFinite())
    {
      notFinite.push_back(id);
    }
  }
  const auto refuse = [](const std::vector<Index>& nodes, const char* text)
  {
    if (!nodes.empty())
    {
      throw Error(text + listIds(nodes) + ".");
    }
  };
  refuse(wrong, "Nodes are given that do not exist: ids ");
  refuse(inside, "Nodes are given that are not on the boundary; it is the boundary that is moved "
                 "here. Leave them out, ids ");
  refuse(twice, "Nodes are given more than once: ids ");
  refuse(notFinite, "New positions that are not finite (NaN or infinite) at node ids ");
}
}

BoundaryMotion beginMotion(const Mesh& rest, const BoundaryFaces& faces,
  const Classification& geometry, const std::vector<Index>& ids, const ConstPoints& targets)
{
  return beginMotion(rest.points, connectedComponents(rest).ofNode, faces, geometry, ids, targets);
}

BoundaryMotion beginMotion(const ConstPoints& rest, const std::vector<Index>& bodyOfNode,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<Index>& ids,
  const ConstPoints& targets)
{
  validate(rest.rows(), faces, ids, targets);
  BoundaryMotion motion;
  motion.rest = rest;
  motion.displacement = Points::Zero(rest.rows(), 3);
  motion.state.assign(rest.rows(), BoundaryMotion::Unknown);
  motion.bodyOfNode = bodyOfNode;
  motion.givenIds = ids;
  motion.givenTargets = targets;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    motion.state[ids[i]] = BoundaryMotion::Given;
    motion.displacement.row(ids[i]) = targets.row(static_cast<Index>(i)) - rest.row(ids[i]);
  }
  for (const GeometryVertex& vertex : geometry.vertices)
  {
    std::uint8_t& state = motion.state[vertex.node];
    state = state == BoundaryMotion::Unknown ? std::uint8_t(BoundaryMotion::Held) : state;
  }
  return motion;
}

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
