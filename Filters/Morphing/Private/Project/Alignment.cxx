// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/Alignment.h"

#include "Support/ProgressRange.h"

#include <vtkCellArray.h>
#include <vtkCellLocator.h>
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
/// Between two looks at the monitor.
constexpr int AtATime = 10;

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

/// The surface onto which another one is turned and shifted.
struct Place
{
  vtkPolyData* Surface;
  vtkNew<vtkCellLocator> Cells; ///< for all iterations

  explicit Place(vtkPolyData* surface)
    : Surface(surface)
  {
    this->Cells->SetDataSet(surface);
    this->Cells->SetNumberOfCellsPerBucket(1); // as the iterations set it
    this->Cells->BuildLocator();
  }
};

/// Closest-point iterations; adds their motion. Returns how many there were.
int iterate(const std::vector<Vector>& landmarks, const Place& place, int iterations, Rigid& motion)
{
  vtkNew<vtkIterativeClosestPointTransform> closest;
  closest->SetSource(cloud(landmarks, motion));
  closest->SetTarget(place.Surface);
  closest->SetLocator(place.Cells);
  closest->GetLandmarkTransform()->SetModeToRigidBody();
  closest->SetMaximumNumberOfLandmarks(static_cast<int>(landmarks.size()));
  closest->SetMaximumNumberOfIterations(iterations);
  closest->CheckMeanDistanceOn();
  closest->SetMaximumMeanDistance(1e-9 * place.Surface->GetLength());
  closest->Update();
  Rigid step = Rigid::Identity();
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      step(i, j) = closest->GetMatrix()->GetElement(i, j);
    }
  }
  motion = step * motion;
  return closest->GetNumberOfIterations();
}

/// The motion after closest-point iterations from a start. A few at a time, since VTK's run tells
/// no progress and cannot be stopped.
Rigid iterated(const std::vector<Vector>& landmarks, const Rigid& start, const Place& place,
  int iterations, morph::Monitor& monitor)
{
  Rigid motion = start;
  for (int done = 0; done < iterations; done += AtATime)
  {
    monitor.check();
    monitor.progress(static_cast<double>(done) / iterations);
    if (iterate(landmarks, place, AtATime, motion) < AtATime)
    {
      break;
    }
  }
  monitor.progress(1);
  return motion;
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
vtkSmartPointer<vtkPolyData> Onto(vtkPolyData* surface, vtkPolyData* onto, morph::Monitor& monitor)
{
  const Place place(onto);
  const std::vector<Vector> landmarks = landmarksOf(surface, FewLandmarks);
  const double size = onto->GetLength();
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(onto);
  locator->BuildLocator();
  Rigid best = Rigid::Identity();
  double least = -1;
  const std::vector<Rigid> starts = startsOf(momentsOf(surface), momentsOf(onto));
  for (std::size_t i = 0; i < starts.size(); ++i)
  {
    const double share = 0.5 / static_cast<double>(starts.size());
    const double done = share * static_cast<double>(i);
    morph::ProgressRange part(monitor, done, done + share);
    const Rigid motion = iterated(landmarks, starts[i], place, FewIterations, part);
    const double distance = meanDistance(landmarks, motion, locator);
    if (motion.matrix().allFinite() && (least < 0 || distance < 0.99 * least - 1e-6 * size))
    {
      least = distance;
      best = motion;
    }
  }
  morph::ProgressRange last(monitor, 0.5, 1);
  best = iterated(landmarksOf(surface, Landmarks), best, place, Iterations, last);
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
