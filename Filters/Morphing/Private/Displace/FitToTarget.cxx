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

/// A target whose surface serves for curves too, where it has no feature edge near. Nodes on the
/// rim of what moves that are on surfaces which slide go to target and sliding surfaces together.
class WithCurves : public morph::ProjectionTarget
{
public:
  WithCurves(const Target& target, const FitToTarget::Rim& rim)
    : Place(target)
    , Rim(rim)
  {
  }
  bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const override
  {
    return this->Place.closestOnSurface(surface, x, normal, y);
  }
  bool closestOnFeatures(Index node, const Row& x, Row& y) const override
  {
    if (this->Rim.Has(node))
    {
      return this->Rim.Meet(
        node, x, [&](const Row& at, Row& to) { return this->Anywhere(at, to); }, y);
    }
    return this->Place.closestOnFeatures(node, x, y) || this->Anywhere(x, y);
  }
  bool ClosestForVertex(Index node, const Row& x, Row& y) const
  {
    if (!this->Rim.Has(node))
    {
      return this->Place.ClosestOnVertices(x, y) || this->closestOnFeatures(node, x, y);
    }
    // Where surfaces that move meet, their common edge goes to the target's.
    const auto onEdge = [&](const Row& at, Row& to)
    { return this->Place.closestOnFeatures(node, at, to); };
    return (this->Rim.IsOnEdge(node) && this->Rim.Meet(node, x, onEdge, y)) ||
           this->closestOnFeatures(node, x, y);
  }

private:
  bool Anywhere(const Row& x, Row& y) const
  {
    return this->Place.closestOnSurface(-1, x, Row::Zero(), y);
  }

  const Target& Place;
  const FitToTarget::Rim& Rim;
};

/// The boundary's polygons, those that move where `choice` is given.
vtkSmartPointer<vtkPolyData> polygonsOf(const BoundaryModel& model, const Choice* choice)
{
  const morph::BoundaryFaces& faces = model.faces;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(model.points().rows());
  for (Index i = 0; i < model.points().rows(); ++i)
  {
    points->SetPoint(i, model.points().row(i).data());
  }
  const bool any =
    choice && std::count(choice->isMovingFace.begin(), choice->isMovingFace.end(), 1) > 0;
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIdList> corners;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    if (!any || choice->isMovingFace[f])
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

BoundaryMotion allHeld(const BoundaryModel& model)
{
  BoundaryMotion motion;
  motion.rest = model.points();
  motion.displacement = Points::Zero(motion.rest.rows(), 3);
  motion.state.assign(motion.rest.rows(), BoundaryMotion::Unknown);
  motion.bodyOfNode = model.bodyOfNode;
  for (const Index node : model.faces.nodes)
  {
    motion.state[node] = BoundaryMotion::Held;
  }
  return motion;
}

/// The motion's start: what does not move is given, and vertices that move are, where they find a
/// place. `missed`: those that find none.
BoundaryMotion begin(const BoundaryModel& model, const Choice& choice, const WithCurves& place,
  std::vector<Index>& missed)
{
  const morph::Classification& geometry = model.geometry;
  BoundaryMotion motion = allHeld(model);
  for (const Index node : choice.moving)
  {
    motion.state[node] = BoundaryMotion::Unknown;
    Row y;
    if (geometry.dimension[node] == 0)
    {
      motion.state[node] = BoundaryMotion::Held;
      if (place.ClosestForVertex(node, motion.rest.row(node), y))
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
void await(const Choice& choice, const morph::Classification& geometry, int dimension,
  BoundaryMotion::State state, BoundaryMotion& motion)
{
  for (const Index node : choice.moving)
  {
    if (motion.state[node] == BoundaryMotion::Unknown && geometry.dimension[node] == dimension)
    {
      motion.state[node] = state;
    }
  }
}
}

void FitToTarget::Update(vtkPolyData* target, const BoundaryModel& model, const Choice* choice,
  const Options& options, morph::Monitor& monitor)
{
  const std::vector<Index> onto = options.Align && choice ? choice->moving : std::vector<Index>();
  if (this->Place && this->Input == target && this->InputTime == target->GetMTime() &&
      this->MotionVersion == model.motionVersion && this->AlignedOnto == onto &&
      this->Made.Align == options.Align && this->Made.FeatureAngle == options.FeatureAngle &&
      this->Made.Angle == options.Angle && this->Made.Reach == options.Reach)
  {
    this->Made = options; // the others change nothing here
    return;
  }
  this->Place.reset(); // in case it throws
  const auto make = [&](vtkPolyData* surface, double from)
  {
    morph::ProgressRange part(monitor, from, from + 0.05);
    return std::make_unique<Target>(
      surface, model.points(), options.FeatureAngle, options.Angle, options.Reach, part);
  };
  auto place = make(target, 0);
  if (options.Align)
  {
    morph::ProgressRange aligning(monitor, 0.05, 0.5);
    auto aligned =
      make(Alignment::Onto(place->Surface(), polygonsOf(model, choice), aligning), 0.5);
    aligned->TakePrecision(*place);
    place = std::move(aligned);
  }
  this->Input = target;
  this->InputTime = target->GetMTime();
  this->MotionVersion = model.motionVersion;
  this->AlignedOnto = onto;
  this->Made = options;
  this->Place = std::move(place);
}

std::set<std::string> FitToTarget::NearestSurfaces(const BoundaryModel& model) const
{
  const morph::Classification& geometry = model.geometry;
  const vtkSmartPointer<vtkPolyData> boundary = polygonsOf(model, nullptr);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(boundary);
  locator->BuildLocator();
  std::vector<double> votes(geometry.surfaces.size(), 0), own(geometry.surfaces.size(), 0);
  const Points areas = morph::faceAreas(model.points(), model.faces);
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

FitToTarget::Rim::Rim(const BoundaryModel& model, const Choice& choice,
  const std::vector<Index>& sliding, Surroundings& surroundings)
  : Model(model)
  , Surfaces(surroundings)
{
  const std::vector<morph::GeometrySurface>& surfaces = model.geometry.surfaces;
  for (const Index s : sliding)
  {
    surroundings.shapeOf(model, s); // before several threads ask for it
    for (const Index node : surfaces[s].nodes)
    {
      if (model.geometry.dimension[node] < 2 &&
          std::binary_search(choice.moving.begin(), choice.moving.end(), node))
      {
        this->Nodes[node].Sliding.push_back(s);
      }
    }
  }
  for (const morph::GeometrySurface& surface : surfaces)
  {
    const bool moves = std::any_of(surface.faces.begin(), surface.faces.end(),
      [&](Index face) { return choice.isMovingFace[face] != 0; });
    for (const Index node : surface.nodes)
    {
      const auto found = this->Nodes.find(node);
      if (moves && found != this->Nodes.end())
      {
        ++found->second.Moving;
      }
    }
  }
}

Eigen::RowVector3d FitToTarget::Rim::Along(Index node, const Row& direction) const
{
  const auto found = this->Nodes.find(node);
  Row along = direction;
  if (found != this->Nodes.end())
  {
    std::vector<Row> normals; // orthonormal
    for (const Index s : found->second.Sliding)
    {
      const Row x = this->Model.points().row(node);
      Row normal = this->Surfaces.shapeOf(this->Model, s).normal(x);
      for (const Row& other : normals)
      {
        normal -= normal.dot(other) * other;
      }
      if (normal.norm() > 1e-6)
      {
        normals.push_back(normal.normalized());
        along -= along.dot(normals.back()) * normals.back();
      }
    }
  }
  return along.norm() > 1e-6 ? Row(along.normalized()) : direction;
}

void FitToTarget::MoveAlong(const BoundaryModel& model, const Choice& choice, const Rim& rim,
  BoundaryMotion& motion, std::vector<Index>& missed)
{
  const Options& how = this->Made;
  Points directions =
    how.Direction.normalized().replicate(static_cast<Index>(choice.moving.size()), 1);
  if (how.Direction.isZero(0))
  {
    directions = morph::nodeNormals(
      model.outwardAreas(model.points()), model.faces, choice.isMovingFace, choice.moving);
  }
  const Points normals =
    morph::surfaceNodeNormals(model.points(), model.points(), model.faces, model.geometry);
  this->Place->Orient(model.points(), normals);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    const Index node = choice.moving[i];
    const Row direction = rim.Along(node, directions.row(static_cast<Index>(i)));
    const auto find = [&](const Row& at, Row& to)
    { return this->Place->ClosestAlong(at, direction, normals.row(node), to); };
    const Row x = model.points().row(node);
    Row y;
    if (rim.Has(node) ? rim.Meet(node, x, find, y) : find(x, y))
    {
      motion.displacement.row(node) = y - x;
    }
    else
    {
      // A vertex has nothing to follow.
      motion.state[node] =
        model.geometry.dimension[node] == 0 ? BoundaryMotion::Held : BoundaryMotion::Unknown;
      missed.push_back(node);
    }
  }
}

Points FitToTarget::Targets(const BoundaryModel& model, const Choice& choice,
  const std::vector<Index>& sliding, Surroundings& surroundings, morph::Monitor& monitor)
{
  const morph::Classification& geometry = model.geometry;
  this->Place->WarnOfRounding(model.size, monitor);
  const Rim rim(model, choice, sliding, surroundings);
  const WithCurves place(*this->Place, rim);
  const bool isAlong = this->Made.How == Project::Along;
  std::vector<Index> missed;
  BoundaryMotion motion;
  if (isAlong)
  {
    motion = allHeld(model);
    this->MoveAlong(model, choice, rim, motion, missed);
  }
  else
  {
    motion = begin(model, choice, place, missed);
  }
  morph::SurfaceMorphOptions how;
  how.unattached = morph::UnattachedMotion::Stay;
  morph::ProgressRange onCurves(monitor, 0.55, 0.75), onSurfaces(monitor, 0.75, 1);
  const auto add = [&missed](const morph::ProjectionReport& report)
  {
    for (const auto* some : { &report.missed, &report.kept })
    {
      missed.insert(missed.end(), some->begin(), some->end());
    }
  };
  morph::morphCurves(geometry, how.unattached, motion, onCurves);
  await(choice, geometry, 1, BoundaryMotion::OnCurve, motion);
  if (!isAlong)
  {
    add(morph::projectCurves(geometry, place, motion, monitor));
  }
  morph::morphSurfaces(model.faces, geometry, how, motion, onSurfaces);
  await(choice, geometry, 2, BoundaryMotion::OnSurface, motion);
  if (!isAlong)
  {
    const Points moved = motion.moved();
    this->Place->Assign(geometry, moved);
    this->Place->Orient(
      moved, morph::surfaceNodeNormals(model.points(), moved, model.faces, geometry));
    add(morph::projectSurfaces(model.faces, geometry, place, motion, monitor));
  }
  std::sort(missed.begin(), missed.end());
  const std::string along = isAlong ? " along the direction" : "";
  if (missed.size() == choice.moving.size())
  {
    throw morph::Error("No node that moves reaches the target: it has no place within "
                       "TargetReach" +
                       along +
                       " whose normal is within TargetAngle. Align the target, or raise "
                       "TargetReach.");
  }
  if (!missed.empty())
  {
    monitor.warn("Nodes do not reach the target, since it has no place within TargetReach" + along +
                 " whose normal is within TargetAngle, or faces would fold there: point ids " +
                 morph::listIds(missed) + " of the input.");
  }
  return motion.moved()(choice.moving, morph::allColumns);
}
}
