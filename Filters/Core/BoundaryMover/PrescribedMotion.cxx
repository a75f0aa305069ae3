// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/PrescribedMotion.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMover/Dimension.h"
#include "BoundaryMover/Patches.h"
#include "BoundaryMover/SurfaceShape.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <string>

namespace morph
{
namespace
{
Points positions(const BoundaryModel& model, const Choice& choice)
{
  return model.points()(choice.moving, allColumns);
}
}

AffineMotion affineMotion(const Placement& placement)
{
  const auto turn = [&](int axis)
  {
    const double radians = placement.rotation[axis] * std::acos(-1.) / 180;
    return Eigen::AngleAxisd(radians, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
  };
  AffineMotion motion;
  motion.col(0) = Eigen::Vector3d::Map(placement.translation.data());
  motion.rightCols<3>() =
    turn(2) * turn(0) * turn(1) *
      Eigen::Vector3d::Map(placement.scale.data()).asDiagonal().toDenseMatrix() -
    Eigen::Matrix3d::Identity();
  return motion;
}

// x goes to c + R S (x - c) + d, with the turn R and the symmetric stretch S of the polar
// decomposition, and with the displacement d of the center c. A point c + q of the screw's axis, of
// direction u, has (I - R) q = d' for the part d' of d across u. By R(p), the turn by p of the
// angle a, the center goes to (I - R(p)) q + p (d - d'). With A = p a / 2 and B = a / 2 the first
// term is sin A / sin B (cos(A - B) d' + sin(A - B) u x d'), which is exact for small angles, too,
// whose axis is far away.
AffineMotion partOf(const AffineMotion& whole, const Eigen::RowVector3d& center, double part)
{
  using Matrix = Eigen::Matrix3d;
  const Matrix linear = whole.rightCols<3>() + Matrix::Identity();
  const Eigen::JacobiSVD<Matrix> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sizes = svd.singularValues();
  Matrix out = svd.matrixU();
  if ((out * svd.matrixV().transpose()).determinant() < 0)
  {
    out.col(2) *= -1; // a mirror image is a stretch by a negative factor
    sizes[2] *= -1;
  }
  const Eigen::AngleAxisd turn(Matrix(out * svd.matrixV().transpose()));
  const Matrix stretch = svd.matrixV() * sizes.asDiagonal() * svd.matrixV().transpose();
  const Matrix turned = Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix() *
                        (Matrix::Identity() + part * (stretch - Matrix::Identity()));

  const Eigen::Vector3d c = center.transpose(), u = turn.axis();
  const Eigen::Vector3d shift = whole.col(0) + whole.rightCols<3>() * c;
  const Eigen::Vector3d along = u * u.dot(shift), across = shift - along;
  const double half = turn.angle() / 2, partly = part * half;
  const double ratio = std::sin(half) == 0 ? part : std::sin(partly) / std::sin(half);
  AffineMotion motion;
  motion.rightCols<3>() = turned - Matrix::Identity();
  motion.col(0) =
    part * along - motion.rightCols<3>() * c +
    ratio * (std::cos(partly - half) * across + std::sin(partly - half) * u.cross(across));
  return motion;
}

Points movedAlongNormals(const BoundaryModel& model, const Choice& choice, double distance)
{
  return positions(model, choice) + distance * nodeNormals(model.outwardAreas(model.points()),
                                                 model.faces, choice.isMovingFace, choice.moving);
}

Points movedByRadius(const BoundaryModel& model, const Choice& choice, double change)
{
  std::vector<Index> row(model.points().rows(), -1);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    row[choice.moving[i]] = static_cast<Index>(i);
  }
  Points to = positions(model, choice);
  std::vector<std::uint8_t> isDone(choice.moving.size(), 0);
  for (const Index s : movingSurfaces(model, choice))
  {
    const GeometrySurface& surface = model.geometry.surfaces[s];
    const SurfaceShape shape(model.points(), model.faces, surface);
    const std::string name = surfaceName(model.geometry, s);
    if (!shape.isRound())
    {
      throw Error("`RadiusChange` needs cylinders or spheres, and " + name +
                  " is neither. Choose such surfaces, or another displacement.");
    }
    if (shape.radius() + change <= 0)
    {
      throw Error("`RadiusChange` would leave " + name + " no radius: it has " +
                  std::to_string(shape.radius()) + ".");
    }
    for (const Index node : surface.nodes)
    {
      if (row[node] >= 0 && !isDone[row[node]])
      {
        to.row(row[node]) += change * shape.outwards(model.points().row(node));
        isDone[row[node]] = 1;
      }
    }
  }
  if (std::all_of(isDone.begin(), isDone.end(), [](std::uint8_t done) { return !done; }))
  {
    throw Error("`RadiusChange` needs cylinders or spheres, and no face moves. Choose such "
                "surfaces.");
  }
  return to;
}

Eigen::RowVector3d centerOfMoving(const BoundaryModel& model, const Choice& choice)
{
  if (choice.moving.empty())
  {
    return Eigen::RowVector3d::Zero();
  }
  const Points from = positions(model, choice);
  return 0.5 * (from.colwise().minCoeff() + from.colwise().maxCoeff());
}

std::vector<Index> collapsedFaces(
  const BoundaryModel& model, const Choice& choice, const Points& moved)
{
  const BoundaryFaces& faces = model.faces;
  const Points after = faceAreas(moved, faces);
  // No face of the boundary is larger than this, and nearly always all are larger than that part.
  constexpr double Rounding = 1e-12;
  const double largest = model.size * model.size;
  if (after.rows() == 0 || after.rowwise().norm().minCoeff() > Rounding * largest)
  {
    return {};
  }
  const Points before = faceAreas(model.points(), faces);
  std::vector<Index> collapsed;
  for (Index f = 0; f < after.rows(); ++f)
  {
    const double area = before.row(f).norm();
    if (area > 0 && after.row(f).norm() <= Rounding * area &&
        std::all_of(faces.connectivity.begin() + faces.offsets[f],
          faces.connectivity.begin() + faces.offsets[f + 1],
          [&](Index node)
          { return std::binary_search(choice.moving.begin(), choice.moving.end(), node); }))
    {
      collapsed.push_back(f);
    }
  }
  return collapsed;
}
}
