// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/FitToTarget.h"

#include "Boundary/FaceAreas.h"
#include "BoundaryMorphing/CurveMorph.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "Private/Project/Alignment.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <Eigen/Geometry>

#include <algorithm>

namespace morph::filters
{
namespace
{
using morph::BoundaryMotion;
using morph::Index;
using morph::Points;
using Row = morph::ProjectionTarget::Row;

/// A target whose surface serves for curves too, where it has no feature edge near.
class WithCurves : public morph::ProjectionTarget
{
public:
  explicit WithCurves(const Target& target)
    : Place(target)
  {
  }
  bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const override
  {
    return this->Place.closestOnSurface(surface, x, normal, y);
  }
  bool closestOnFeatures(const Row& x, Row& y) const override
  {
    return this->Place.closestOnFeatures(x, y) || this->Anywhere(x, y);
  }
  bool ClosestForVertex(const Row& x, Row& y) const
  {
    return this->Place.ClosestOnVertices(x, y) || this->closestOnFeatures(x, y);
  }

private:
  bool Anywhere(const Row& x, Row& y) const
  {
    return this->Place.closestOnSurface(-1, x, Row::Zero(), y);
  }

  const Target& Place;
};

/// The boundary's polygons, those that move where `choice` is given.
vtkSmartPointer<vtkPolyData> polygonsOf(const BoundaryModel& model, const Choice::Result* choice)
{
  const morph::BoundaryFaces& faces = model.Faces();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(model.Points().rows());
  for (Index i = 0; i < model.Points().rows(); ++i)
  {
    points->SetPoint(i, model.Points().row(i).data());
  }
  const bool any =
    choice && std::count(choice->IsMovingFace.begin(), choice->IsMovingFace.end(), 1) > 0;
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIdList> corners;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    if (!any || choice->IsMovingFace[f])
    {
      corners->Reset();
      for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
      {
        corners->InsertNextId(faces.connectivity[k]);
      }
      polygons->InsertNextCell(corners);
    }
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(polygons);
  surface->BuildCells();
  return surface;
}

/// The motion's start: what does not move is given, and vertices that move are, where they find a
/// place. `missed`: those that find none.
BoundaryMotion begin(const BoundaryModel& model, const Choice::Result& choice,
  const WithCurves& place, std::vector<Index>& missed)
{
  const morph::Classification& geometry = model.Geometry();
  BoundaryMotion motion;
  motion.rest = model.Points();
  motion.displacement = Points::Zero(motion.rest.rows(), 3);
  motion.state.assign(motion.rest.rows(), BoundaryMotion::Unknown);
  motion.bodyOfNode = model.BodyOfNode();
  for (const Index node : model.Faces().nodes)
  {
    motion.state[node] = BoundaryMotion::Held;
  }
  for (const Index node : choice.Moving)
  {
    motion.state[node] = BoundaryMotion::Unknown;
    Row y;
    if (geometry.dimension[node] == 0)
    {
      motion.state[node] = BoundaryMotion::Held;
      if (place.ClosestForVertex(motion.rest.row(node), y))
      {
        motion.displacement.row(node) = y - motion.rest.row(node);
      }
      else
      {
        missed.push_back(node);
      }
    }
  }
  return motion;
}

/// Nodes of closed curves or surfaces, about which nothing is known, wait where they are.
void await(const Choice::Result& choice, const morph::Classification& geometry, int dimension,
  BoundaryMotion::State state, BoundaryMotion& motion)
{
  for (const Index node : choice.Moving)
  {
    if (motion.state[node] == BoundaryMotion::Unknown && geometry.dimension[node] == dimension)
    {
      motion.state[node] = state;
    }
  }
}
}

void FitToTarget::Update(vtkPolyData* target, const BoundaryModel& model,
  const Choice::Result* choice, const Options& options, morph::Monitor& monitor)
{
  const std::vector<Index> onto = options.Align && choice ? choice->Moving : std::vector<Index>();
  if (this->Place && this->Input == target && this->InputTime == target->GetMTime() &&
      this->MotionVersion == model.MotionVersion() && this->AlignedOnto == onto &&
      this->Made.Align == options.Align && this->Made.FeatureAngle == options.FeatureAngle &&
      this->Made.Angle == options.Angle && this->Made.Reach == options.Reach)
  {
    return;
  }
  this->Place.reset(); // in case it throws
  const auto make = [&](vtkPolyData* surface, double from)
  {
    morph::ProgressRange part(monitor, from, from + 0.05);
    return std::make_unique<Target>(
      surface, model.Points(), options.FeatureAngle, options.Angle, options.Reach, part);
  };
  auto place = make(target, 0);
  if (options.Align)
  {
    morph::ProgressRange aligning(monitor, 0.05, 0.5);
    place = make(Alignment::Onto(place->Surface(), polygonsOf(model, choice), aligning), 0.5);
  }
  this->Input = target;
  this->InputTime = target->GetMTime();
  this->MotionVersion = model.MotionVersion();
  this->AlignedOnto = onto;
  this->Made = options;
  this->Place = std::move(place);
}

std::set<std::string> FitToTarget::NearestSurfaces(const BoundaryModel& model) const
{
  const morph::Classification& geometry = model.Geometry();
  const vtkSmartPointer<vtkPolyData> boundary = polygonsOf(model, nullptr);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(boundary);
  locator->BuildLocator();
  std::vector<double> votes(geometry.surfaces.size(), 0), own(geometry.surfaces.size(), 0);
  const Points areas = morph::faceAreas(model.Points(), model.Faces());
  for (Index f = 0; f < areas.rows(); ++f)
  {
    own[geometry.surfaceOfFace[f]] += areas.row(f).norm();
  }
  vtkPolyData* target = this->Place->Surface();
  vtkNew<vtkIdList> ids;
  vtkNew<vtkGenericCell> cell;
  for (vtkIdType c = 0; c < target->GetNumberOfCells(); ++c)
  {
    target->GetCellPoints(c, ids);
    Eigen::Vector3d x[3];
    for (int k = 0; k < 3; ++k)
    {
      target->GetPoint(ids->GetId(k), x[k].data());
    }
    // Triangles of an STL file may be as large as the surface: a sample in each quarter.
    const double area = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
    const Eigen::Vector3d center = (x[0] + x[1] + x[2]) / 3;
    const Eigen::Vector3d samples[] = { center, (center + x[0]) / 2, (center + x[1]) / 2,
      (center + x[2]) / 2 };
    for (const Eigen::Vector3d& sample : samples)
    {
      double place[3], distance2 = 0;
      vtkIdType face = -1;
      int part = 0;
      locator->FindClosestPoint(sample.data(), place, cell, face, part, distance2);
      if (face >= 0)
      {
        votes[geometry.surfaceOfFace[face]] += area / 4;
      }
    }
  }
  std::set<std::string> names;
  for (std::size_t s = 0; s < votes.size(); ++s)
  {
    if (votes[s] >= 0.5 * own[s] && votes[s] > 0)
    {
      names.insert("Surface " + std::to_string(geometry.surfaces[s].id));
    }
  }
  if (names.empty())
  {
    throw morph::Error("No surface of the mesh belongs to the target: none has half of its area "
                       "beside it. Choose the surfaces that are to fit, or align the target.");
  }
  return names;
}

Points FitToTarget::Targets(
  const BoundaryModel& model, const Choice::Result& choice, morph::Monitor& monitor)
{
  const morph::Classification& geometry = model.Geometry();
  const WithCurves place(*this->Place);
  std::vector<Index> missed;
  BoundaryMotion motion = begin(model, choice, place, missed);
  morph::SurfaceMorphOptions how;
  how.unattached = morph::UnattachedMotion::Stay;
  morph::ProgressRange onCurves(monitor, 0.55, 0.75), onSurfaces(monitor, 0.75, 1);
  morph::morphCurves(geometry, how.unattached, motion, onCurves);
  await(choice, geometry, 1, BoundaryMotion::OnCurve, motion);
  const morph::ProjectionReport curves = morph::projectCurves(geometry, place, motion, monitor);
  morph::morphSurfaces(model.Faces(), geometry, how, motion, onSurfaces);
  await(choice, geometry, 2, BoundaryMotion::OnSurface, motion);
  const Points moved = motion.moved();
  this->Place->Assign(geometry, moved);
  this->Place->Orient(
    moved, morph::surfaceNodeNormals(model.Points(), moved, model.Faces(), geometry));
  const morph::ProjectionReport surfaces =
    morph::projectSurfaces(model.Faces(), geometry, place, motion, monitor);
  for (const auto* some : { &curves.missed, &curves.kept, &surfaces.missed, &surfaces.kept })
  {
    missed.insert(missed.end(), some->begin(), some->end());
  }
  std::sort(missed.begin(), missed.end());
  if (missed.size() == choice.Moving.size())
  {
    throw morph::Error("No node that moves reaches the target: it has no place within "
                       "TargetReach whose normal is within TargetAngle. Align the target, or raise "
                       "TargetReach.");
  }
  if (!missed.empty())
  {
    monitor.warn("Nodes do not reach the target, since it has no place within TargetReach whose "
                 "normal is within TargetAngle, or faces would fold there: point ids " +
                 morph::listIds(missed) + " of the input.");
  }
  return motion.moved()(choice.Moving, morph::allColumns);
}
}
