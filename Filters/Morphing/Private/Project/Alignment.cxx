// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/Alignment.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkIterativeClosestPointTransform.h>
#include <vtkLandmarkTransform.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace morph::filters
{
namespace
{
using Vector = Eigen::Vector3d;
using Rigid = Eigen::Isometry3d;

constexpr int Landmarks = 500;
constexpr int Iterations = 100;
/// To find the best start.
constexpr int FewLandmarks = 100;
constexpr int FewIterations = 30;

/// Centre of area and principal axes of a surface.
struct Moments
{
  Vector Center = Vector::Zero();
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity(); ///< right-handed, by ascending variance
};

Moments momentsOf(vtkPolyData* surface)
{
  Moments moments;
  std::vector<std::pair<Vector, double>> triangles; ///< centre and area
  const auto point = [&](vtkIdType id)
  {
    Vector x;
    surface->GetPoint(id, x.data());
    return x;
  };
  double area = 0;
  vtkNew<vtkIdList> ids;
  vtkCellArray* polygons = surface->GetPolys();
  for (vtkIdType c = 0; c < polygons->GetNumberOfCells(); ++c)
  {
    polygons->GetCellAtId(c, ids);
    for (vtkIdType k = 2; k < ids->GetNumberOfIds(); ++k)
    {
      const Vector a = point(ids->GetId(0)), b = point(ids->GetId(k - 1)), d = point(ids->GetId(k));
      triangles.emplace_back((a + b + d) / 3, (b - a).cross(d - a).norm() / 2);
      area += triangles.back().second;
      moments.Center += triangles.back().second * triangles.back().first;
    }
  }
  if (area == 0)
  {
    return moments;
  }
  moments.Center /= area;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [center, weight] : triangles)
  {
    const Vector x = center - moments.Center;
    covariance += weight * x * x.transpose();
  }
  moments.Axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  if (moments.Axes.determinant() < 0)
  {
    moments.Axes.col(0) *= -1;
  }
  return moments;
}

std::vector<Rigid> startsOf(const Moments& from, const Moments& to)
{
  const auto about = [&](const Eigen::Matrix3d& rotation)
  {
    Rigid start = Rigid::Identity();
    start.linear() = rotation;
    start.translation() = to.Center - rotation * from.Center;
    return start;
  };
  std::vector<Rigid> starts = { Rigid::Identity(), about(Eigen::Matrix3d::Identity()) };
  const Vector signs[] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
  for (const Vector& sign : signs)
  {
    starts.push_back(about(to.Axes * sign.asDiagonal() * from.Axes.transpose()));
  }
  return starts;
}

/// The surface's points that are polygons' corners, at most about `most` of them, evenly from all.
std::vector<Vector> landmarksOf(vtkPolyData* surface, int most)
{
  std::vector<vtkIdType> corners;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < surface->GetPolys()->GetNumberOfCells(); ++c)
  {
    surface->GetPolys()->GetCellAtId(c, ids);
    corners.insert(corners.end(), ids->begin(), ids->end());
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const std::size_t stride = 1 + corners.size() / most;
  std::vector<Vector> landmarks;
  for (std::size_t i = 0; i < corners.size(); i += stride)
  {
    Vector x;
    surface->GetPoint(corners[i], x.data());
    landmarks.push_back(x);
  }
  return landmarks;
}

vtkSmartPointer<vtkPolyData> cloud(const std::vector<Vector>& points, const Rigid& motion)
{
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  for (const Vector& x : points)
  {
    const Vector y = motion * x;
    moved->InsertNextPoint(y.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(moved);
  return data;
}

/// The motion after closest-point iterations from a start.
Rigid iterated(
  const std::vector<Vector>& landmarks, const Rigid& start, vtkPolyData* onto, int iterations)
{
  vtkNew<vtkIterativeClosestPointTransform> closest;
  closest->SetSource(cloud(landmarks, start));
  closest->SetTarget(onto);
  closest->GetLandmarkTransform()->SetModeToRigidBody();
  closest->SetMaximumNumberOfLandmarks(static_cast<int>(landmarks.size()));
  closest->SetMaximumNumberOfIterations(iterations);
  closest->CheckMeanDistanceOn();
  closest->SetMaximumMeanDistance(1e-9 * onto->GetLength());
  closest->Update();
  Rigid motion = Rigid::Identity();
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      motion(i, j) = closest->GetMatrix()->GetElement(i, j);
    }
  }
  return motion * start;
}

double meanDistance(
  const std::vector<Vector>& landmarks, const Rigid& motion, vtkStaticCellLocator* onto)
{
  vtkNew<vtkGenericCell> cell;
  double sum = 0;
  for (const Vector& x : landmarks)
  {
    const Vector y = motion * x;
    double place[3], distance2 = 0;
    vtkIdType id = -1;
    int part = 0;
    onto->FindClosestPoint(y.data(), place, cell, id, part, distance2);
    sum += std::sqrt(distance2);
  }
  return sum / static_cast<double>(landmarks.size());
}
}

namespace Alignment
{
vtkSmartPointer<vtkPolyData> Onto(vtkPolyData* surface, vtkPolyData* onto)
{
  const std::vector<Vector> landmarks = landmarksOf(surface, FewLandmarks);
  const double size = onto->GetLength();
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(onto);
  locator->BuildLocator();
  Rigid best = Rigid::Identity();
  double least = -1;
  for (const Rigid& start : startsOf(momentsOf(surface), momentsOf(onto)))
  {
    const Rigid motion = iterated(landmarks, start, onto, FewIterations);
    const double distance = meanDistance(landmarks, motion, locator);
    if (motion.matrix().allFinite() && (least < 0 || distance < 0.99 * least - 1e-6 * size))
    {
      least = distance;
      best = motion;
    }
  }
  best = iterated(landmarksOf(surface, Landmarks), best, onto, Iterations);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    Vector x;
    surface->GetPoint(i, x.data());
    const Vector y = best * x;
    points->SetPoint(i, y.data());
  }
  auto aligned = vtkSmartPointer<vtkPolyData>::New();
  aligned->ShallowCopy(surface);
  aligned->SetPoints(points);
  return aligned;
}
}
}
