// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/TargetData.h"

#include "BoundaryMover/FitToTarget.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Precision.h"
#include "Support/Monitor.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <cmath>
#include <vector>

namespace morph::filters::TargetData
{
namespace
{
std::vector<morph::TargetTriangle> trianglesOf(vtkPolyData* surface)
{
  std::vector<morph::TargetTriangle> triangles;
  vtkNew<vtkIdList> points;
  const auto id = [&points](vtkIdType k) { return static_cast<morph::Index>(points->GetId(k)); };
  vtkCellArray* polygons = surface->GetPolys();
  for (vtkIdType c = 0; c < polygons->GetNumberOfCells(); ++c)
  {
    polygons->GetCellAtId(c, points);
    for (vtkIdType k = 2; k < points->GetNumberOfIds(); ++k)
    {
      triangles.push_back({ id(0), id(k - 1), id(k) });
    }
  }
  vtkCellArray* strips = surface->GetStrips();
  for (vtkIdType c = 0; c < strips->GetNumberOfCells(); ++c)
  {
    strips->GetCellAtId(c, points);
    for (vtkIdType k = 2; k < points->GetNumberOfIds(); ++k)
    {
      // Every other triangle of a strip is wound the other way.
      triangles.push_back({ id(k - 2), id(k - 1 + k % 2), id(k - k % 2) });
    }
  }
  return triangles;
}
}

std::unique_ptr<morph::Target> Make(vtkPolyData* surface, const morph::Points& mesh, double size,
  morph::Target::Options options, std::string& warning, morph::Monitor& monitor)
{
  const morph::Points points = GridMesh::FromPoints(surface->GetPoints());
  const Precision precision = Precision::Of(surface->GetPoints(), points);
  options.rounding = precision.IsFloat ? std::sqrt(3) / 2 * precision.Step() : 0;
  auto target =
    std::make_unique<morph::Target>(points, trianglesOf(surface), mesh, options, monitor);
  warning = options.rounding > 1e-6 * size
              ? "The target has " + precision.Text() +
                  ". Nodes as near to it as that stay, and others are as far off. Write it in "
                  "double precision, in a VTK file for instance, or with an origin near the mesh."
              : "";
  return target;
}

vtkSmartPointer<vtkPolyData> Surface(const morph::Target& target)
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  auto points = Arrays::MakePoints(VTK_DOUBLE);
  for (morph::Index i = 0; i < target.points().rows(); ++i)
  {
    points->InsertNextPoint(target.points().row(i).data());
  }
  vtkNew<vtkCellArray> polygons;
  for (const morph::TargetTriangle& triangle : target.triangles())
  {
    const vtkIdType corners[3] = { triangle[0], triangle[1], triangle[2] };
    polygons->InsertNextCell(3, corners);
  }
  surface->SetPoints(points);
  surface->SetPolys(polygons);
  return surface;
}
}

namespace morph::filters
{
void FittedTarget::Update(vtkPolyData* target, const morph::BoundaryModel& model,
  const morph::Choice* choice, bool align, const morph::Target::Options& options,
  morph::Monitor& monitor)
{
  const std::vector<morph::Index> onto =
    align && choice ? choice->moving : std::vector<morph::Index>();
  const auto isMade = [&](const morph::Target::Options& made)
  {
    return made.featureAngle == options.featureAngle && made.normalAngle == options.normalAngle &&
           made.reach == options.reach;
  };
  if (this->Place && this->Input == target && this->InputTime == target->GetMTime() &&
      this->MotionVersion == model.motionVersion && this->AlignedOnto == onto &&
      this->IsAligned == align && isMade(this->Place->options()))
  {
    return;
  }
  this->Place.reset(); // in case it throws
  morph::ProgressRange making(monitor, 0, 0.05), aligning(monitor, 0.05, 0.5);
  auto place = TargetData::Make(target, model.points(), model.size, options, this->Warning, making);
  if (align)
  {
    const Eigen::Isometry3d motion = morph::alignedOnto(model, choice, *place, aligning);
    const Eigen::Matrix3Xd points = motion * place->points().transpose();
    place = std::make_unique<morph::Target>(
      points.transpose(), place->triangles(), model.points(), place->options(), making);
  }
  this->Input = target;
  this->InputTime = target->GetMTime();
  this->MotionVersion = model.motionVersion;
  this->AlignedOnto = onto;
  this->IsAligned = align;
  this->Triangles = TargetData::Surface(*place);
  this->Place = std::move(place);
}
}
