// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/Alignment.h"

#include "Support/ProgressRange.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
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
/// Iterations end where one moves the landmarks by less, root mean square, of the place's size.
constexpr double Still = 1e-9;

/// Center of area and principal axes of a surface.
struct Moments
{
  Vector Center = Vector::Zero();
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity(); ///< right-handed, by ascending variance
};

Moments momentsOf(vtkPolyData* surface)
{
  Moments moments;
  std::vector<std::pair<Vector, double>> triangles; ///< center and area
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

/// The surface onto which another one is turned and shifted.
class Place
{
public:
  explicit Place(vtkPolyData* surface)
    : Size(surface->GetLength())
  {
    this->Locator->SetDataSet(surface);
    this->Locator->BuildLocator();
  }

  Vector Closest(const Vector& x) const
  {
    Vector y;
    vtkIdType id = -1;
    int part = 0;
    double distance2 = 0;
    this->Locator->FindClosestPoint(x.data(), y.data(), this->Cell, id, part, distance2);
    return y;
  }

  const double Size;

private:
  vtkNew<vtkStaticCellLocator> Locator;
  vtkNew<vtkGenericCell> Cell;
};

/// The motion after closest-point iterations from a start: each takes the landmarks as near as
/// rigid motion can to their closest points.
Rigid iterated(const std::vector<Vector>& landmarks, const Rigid& start, const Place& place,
  int iterations, morph::Monitor& monitor)
{
  Rigid motion = start;
  const auto count = static_cast<Eigen::Index>(landmarks.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  double moved = std::numeric_limits<double>::infinity();
  for (int done = 0; done < iterations && moved > Still * place.Size; ++done)
  {
    monitor.check();
    monitor.progress(static_cast<double>(done) / iterations);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      from.col(i) = motion * landmarks[i];
      to.col(i) = place.Closest(from.col(i));
    }
    const Rigid step(Eigen::umeyama(from, to, false));
    motion = step * motion;
    moved = std::sqrt((step * from - from).colwise().squaredNorm().mean());
  }
  monitor.progress(1);
  return motion;
}

double meanDistance(const std::vector<Vector>& landmarks, const Rigid& motion, const Place& place)
{
  double sum = 0;
  for (const Vector& x : landmarks)
  {
    const Vector y = motion * x;
    sum += (place.Closest(y) - y).norm();
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
  Rigid best = Rigid::Identity();
  double least = -1;
  const std::vector<Rigid> starts = startsOf(momentsOf(surface), momentsOf(onto));
  for (std::size_t i = 0; i < starts.size(); ++i)
  {
    const double share = 0.5 / static_cast<double>(starts.size());
    const double done = share * static_cast<double>(i);
    morph::ProgressRange part(monitor, done, done + share);
    const Rigid motion = iterated(landmarks, starts[i], place, FewIterations, part);
    const double distance = meanDistance(landmarks, motion, place);
    if (motion.matrix().allFinite() && (least < 0 || distance < 0.99 * least - 1e-6 * place.Size))
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
