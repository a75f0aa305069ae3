// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/SurfaceShape.h"

#include "Boundary/FaceAreas.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkStaticCellLocator.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::Points;
using Row = SurfaceShape::Row;

Points rowsOf(const Points& all, const std::vector<Index>& ids)
{
  Points some(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    some.row(static_cast<Index>(i)) = all.row(ids[i]);
  }
  return some;
}

/// Of a symmetric matrix, that of the smallest eigenvalue.
Row smallestEigenvector(const Eigen::Matrix3d& matrix)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors().col(0).transpose();
}

/// Two unit vectors that are normal to `axis` and to each other.
std::pair<Row, Row> across(const Row& axis)
{
  const Row first = axis.unitOrthogonal();
  return { first, axis.cross(first) };
}
}

SurfaceShape::SurfaceShape(
  const Points& points, const morph::BoundaryFaces& faces, const morph::GeometrySurface& surface)
{
  constexpr double Fits = 1e-6;  // of the nodes' extent
  constexpr double Better = 0.1; // than a plane
  const Points nodes = rowsOf(points, surface.nodes);
  const double ofPlane = this->FitPlane(nodes);
  const double most = Fits * (nodes.rowwise() - this->Center).rowwise().norm().maxCoeff();
  if (ofPlane <= most)
  {
    this->How = Kind::Plane;
  }
  else if (this->FitCylinder(nodes, rowsOf(morph::faceAreas(points, faces), surface.faces),
             std::min(most, Better * ofPlane)))
  {
    this->How = Kind::Cylinder;
  }
  else
  {
    this->TakeFacets(points, faces, surface);
  }
}

double SurfaceShape::FitPlane(const Points& nodes)
{
  this->Center = nodes.colwise().mean();
  const Points from = nodes.rowwise() - this->Center;
  this->Direction = smallestEigenvector(from.transpose() * from);
  return (from * this->Direction.transpose()).cwiseAbs().maxCoeff();
}

/// `tolerance`: the largest distance of a node, besides that part of the radius.
bool SurfaceShape::FitCylinder(const Points& nodes, const Points& areas, double tolerance)
{
  // Normals are all across the axis; the normals of facets only nearly, so that Gauss-Newton's
  // method follows. Unknowns: the center and the axis, each in the two directions across the axis,
  // and the radius.
  this->Direction = smallestEigenvector(areas.transpose() * areas);
  this->Center = nodes.colwise().mean();
  this->Radius = 0;
  constexpr double OfRadius = 1e-6;
  double last = std::numeric_limits<double>::infinity(); ///< length of the last step
  for (int iteration = 0; iteration < 30; ++iteration)
  {
    const auto [u, v] = across(this->Direction);
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
    double worst = 0;
    for (Index i = 0; i < nodes.rows(); ++i)
    {
      const Row from = nodes.row(i) - this->Center;
      const double along = from.dot(this->Direction);
      const Row out = from - along * this->Direction;
      const double distance = out.norm();
      if (!(distance > 0))
      {
        return false;
      }
      const double cu = out.dot(u) / distance, cv = out.dot(v) / distance;
      Eigen::Matrix<double, 5, 1> row;
      row << -cu, -cv, -cu * along, -cv * along, -1;
      const double residual = distance - this->Radius;
      normal += row * row.transpose();
      right -= residual * row;
      worst = std::max(worst, std::abs(residual));
    }
    // The last step is that of rounding; beyond it more of them help no more.
    if (worst <= std::min(tolerance, OfRadius * this->Radius) &&
        (last <= 1e-13 * this->Radius || iteration == 29))
    {
      return true;
    }
    // Of dynamic size: GCC 16 warns of the bounds of a fixed one.
    const Eigen::MatrixXd matrix = normal;
    const Eigen::VectorXd step = matrix.completeOrthogonalDecomposition().solve(right);
    this->Center += step[0] * u + step[1] * v;
    this->Direction = (this->Direction + step[2] * u + step[3] * v).normalized();
    this->Radius += step[4];
    last = step.norm();
    if (!std::isfinite(this->Radius) || !this->Direction.allFinite())
    {
      return false;
    }
  }
  return false;
}

void SurfaceShape::TakeFacets(
  const Points& points, const morph::BoundaryFaces& faces, const morph::GeometrySurface& surface)
{
  std::map<Index, vtkIdType> number;
  vtkNew<vtkPoints> corners;
  corners->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIdList> ids;
  for (const Index face : surface.faces)
  {
    ids->Reset();
    for (Index k = faces.offsets[face]; k < faces.offsets[face + 1]; ++k)
    {
      const Index node = faces.connectivity[k];
      const auto [at, isNew] = number.emplace(node, corners->GetNumberOfPoints());
      if (isNew)
      {
        corners->InsertNextPoint(points.row(node).data());
      }
      ids->InsertNextId(at->second);
    }
    polygons->InsertNextCell(ids);
  }
  vtkNew<vtkPolyData> facets;
  facets->SetPoints(corners);
  facets->SetPolys(polygons);
  this->Locator = vtkSmartPointer<vtkStaticCellLocator>::New();
  this->Locator->SetDataSet(facets);
  this->Locator->BuildLocator();
}

Row SurfaceShape::Closest(const Row& x) const
{
  if (this->How == Kind::Plane)
  {
    return x - (x - this->Center).dot(this->Direction) * this->Direction;
  }
  if (this->How == Kind::Cylinder)
  {
    const Row from = x - this->Center;
    const Row axial = from.dot(this->Direction) * this->Direction;
    const double distance = (from - axial).norm();
    // On the axis all points of a circle are as near.
    return distance > 0 ? Row(this->Center + axial + (from - axial) * (this->Radius / distance))
                        : x;
  }
  Row closest = x;
  vtkIdType cell = -1;
  int part = 0;
  double squared = 0;
  vtkNew<vtkGenericCell> memory; // the locator's own is not for several threads
  this->Locator->FindClosestPoint(x.data(), closest.data(), memory, cell, part, squared);
  return cell < 0 ? x : closest;
}

Row SurfaceShape::Slid(const Row& from, const Row& to) const
{
  if (this->How == Kind::Plane)
  {
    return to - (to - from).dot(this->Direction) * this->Direction;
  }
  const Row height = from - this->Closest(from);
  return this->Closest(to) + (this->How == Kind::Cylinder
                                 ? Row(height.dot(this->Outwards(from)) * this->Outwards(to))
                                 : height);
}

Row SurfaceShape::Normal(const Row& x) const
{
  if (this->How == Kind::Plane)
  {
    return this->Direction;
  }
  if (this->How == Kind::Cylinder)
  {
    return this->Outwards(x);
  }
  Row closest = x, normal = Row::Zero();
  vtkIdType cell = -1;
  int part = 0;
  double squared = 0;
  this->Locator->FindClosestPoint(x.data(), closest.data(), cell, part, squared);
  if (cell >= 0)
  {
    vtkNew<vtkIdList> corners;
    this->Locator->GetDataSet()->GetCellPoints(cell, corners);
    vtkPolygon::ComputeNormal(vtkPolyData::SafeDownCast(this->Locator->GetDataSet())->GetPoints(),
      static_cast<int>(corners->GetNumberOfIds()), corners->GetPointer(0), normal.data());
  }
  return normal;
}

Row SurfaceShape::Outwards(const Row& x) const
{
  const Row from = x - this->Center;
  const Row out = from - from.dot(this->Direction) * this->Direction;
  return out.norm() > 0 ? Row(out.normalized()) : Row(Row::Zero());
}
}
