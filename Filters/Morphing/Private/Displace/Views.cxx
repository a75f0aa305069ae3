// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Views.h"

#include "BoundaryMover/Choice.h"
#include "Geometry/PointOrders.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/Pick.h"
#include "Support/Error.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::Points;
using Row = Eigen::RowVector3d;

int typeOf(vtkIdType corners)
{
  return corners == 3 ? VTK_TRIANGLE : corners == 4 ? VTK_QUAD : VTK_POLYGON;
}

/// The number of each face's surface as active scalars of `output`.
void addNumbers(vtkPolyData* boundary, vtkDataSet* output)
{
  if (vtkDataArray* surfaces = boundary->GetCellData()->GetArray(Geometry::IdName))
  {
    auto named = vtkSmartPointer<vtkDataArray>::Take(surfaces->NewInstance());
    named->DeepCopy(surfaces);
    named->SetName(Views::SurfaceName);
    output->GetCellData()->AddArray(named);
    output->GetCellData()->SetActiveScalars(Views::SurfaceName);
  }
}

/// Of nodes that cover what moves evenly: at most a dozen.
std::vector<Index> arrowsOf(const Points& from)
{
  constexpr Index Looked = 1000, Shown = 12; // the order of all nodes would take too long
  const Index step = std::max<Index>(1, from.rows() / Looked);
  std::vector<Index> looked;
  for (Index i = 0; i < from.rows(); i += step)
  {
    looked.push_back(i);
  }
  morph::Monitor monitor;
  const morph::FarthestPoints far = morph::farthestPoints(from(looked, morph::allColumns), monitor);
  std::vector<Index> shown;
  for (std::size_t i = 0; i < far.order.size() && static_cast<Index>(shown.size()) < Shown; ++i)
  {
    shown.push_back(looked[far.order[i]]);
  }
  return shown;
}

/// A shaft, and a head with four sides.
void addArrow(const Row& from, const Row& to, vtkPolyData* output)
{
  constexpr double Head = 0.25, Width = 0.08; // of the length
  const Row along = to - from;
  const Row neck = to - Head * along;
  const Row side = Width * along.norm() * along.unitOrthogonal();
  const Row other = Width * along.cross(along.unitOrthogonal());
  vtkPoints* points = output->GetPoints();
  const auto add = [&](const Row& x) { return points->InsertNextPoint(x.data()); };
  const vtkIdType shaft[] = { add(from), add(neck) };
  output->GetLines()->InsertNextCell(2, shaft);
  const vtkIdType tip = add(to);
  const vtkIdType base[] = { add(neck + side), add(neck + other), add(neck - side),
    add(neck - other) };
  for (int k = 0; k < 4; ++k)
  {
    const vtkIdType triangle[] = { tip, base[k], base[(k + 1) % 4] };
    output->GetPolys()->InsertNextCell(3, triangle);
  }
}

/// The surface with its nodes at their targets.
vtkSmartPointer<vtkPolyData> movedSurface(
  const InputBoundary& model, const std::vector<Index>& nodes, const Points& targets)
{
  auto points = Arrays::MakePoints(VTK_DOUBLE);
  points->DeepCopy(model.Surface()->GetPoints());
  for (std::size_t i = 0; i < model.NodeOfPoint().size(); ++i)
  {
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), model.NodeOfPoint()[i]);
    if (at != nodes.end() && *at == model.NodeOfPoint()[i])
    {
      points->SetPoint(static_cast<vtkIdType>(i), targets.row(at - nodes.begin()).data());
    }
  }
  auto moved = vtkSmartPointer<vtkPolyData>::New();
  moved->SetPoints(points);
  return moved;
}
}

void Views::Boundary(vtkUnstructuredGrid* grid, vtkPolyData* boundary, vtkUnstructuredGrid* output)
{
  output->Initialize();
  output->SetPoints(grid->GetPoints());
  output->GetPointData()->ShallowCopy(grid->GetPointData());
  output->GetFieldData()->ShallowCopy(grid->GetFieldData());
  vtkDataArray* ids = boundary->GetPointData()->GetArray(Surface::IdName);
  output->AllocateExact(boundary->GetNumberOfPolys(), 4 * boundary->GetNumberOfPolys());
  vtkNew<vtkIdList> corners;
  vtkCellArray* faces = boundary->GetPolys();
  for (vtkIdType face = 0; face < faces->GetNumberOfCells(); ++face)
  {
    faces->GetCellAtId(face, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      corners->SetId(i, static_cast<vtkIdType>(ids->GetComponent(corners->GetId(i), 0)));
    }
    output->InsertNextCell(typeOf(corners->GetNumberOfIds()), corners);
  }
  output->GetCellData()->AddArray(boundary->GetCellData()->GetArray("MorphCellId"));
  addNumbers(boundary, output);
}

void Views::Boundary(vtkPolyData* boundary, vtkPolyData* output)
{
  output->ShallowCopy(boundary);
  addNumbers(boundary, output);
}

void Views::Preview(const InputBoundary& model, vtkDataArraySelection* names,
  const Motion::Options& motion, vtkPolyData* output)
{
  output->Initialize();
  try
  {
    const morph::Choice choice = morph::choosePatches(model, Pick::Enabled(model, names), {});
    const Points from = model.points()(choice.moving, morph::allColumns);
    const Points targets = Motion::Targets(model, choice, motion);
    if (from.rows() == 0 || targets == from)
    {
      return;
    }
    Pick::Write(model, names, movedSurface(model, choice.moving, targets), output);
    output->GetPointData()->Initialize(); // arrows have no nodes
    if (!output->GetLines())
    {
      output->SetLines(vtkNew<vtkCellArray>());
    }
    for (const Index i : arrowsOf(from))
    {
      if (from.row(i) != targets.row(i))
      {
        addArrow(from.row(i), targets.row(i), output);
      }
    }
  }
  catch (const morph::Error&)
  {
    output->Initialize(); // the execution says what is wrong
  }
}
}
