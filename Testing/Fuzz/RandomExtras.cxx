// SPDX-License-Identifier: BSD-3-Clause
#include "RandomExtras.h"

#include "vtkBoundaryDisplacement.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkMorphMesh.h"

#include <vtkBox.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSphere.h>
#include <vtkTransform.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace fuzz
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

Row middleOf(const RandomGrid& grid)
{
  return grid.mesh.numberOfNodes() > 0 ? Row(grid.mesh.points.row(grid.mesh.numberOfNodes() / 2))
                                       : Row(0, 0, 0);
}

/// The mesh's own boundary, with a few waves.
vtkSmartPointer<vtkPolyData> wavyBoundary(Random& random, const RandomGrid& grid)
{
  vtkNew<vtkExtractMorphBoundary> extract;
  extract->SetNumberOfThreads(1);
  extract->SetInputDataObject(grid.data);
  extract->Update();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPolys(extract->GetOutput()->GetPolys());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const double amount = 0.05 * random.unit() * grid.size;
  for (vtkIdType p = 0; p < extract->GetOutput()->GetNumberOfPoints(); ++p)
  {
    Row x;
    extract->GetOutput()->GetPoint(p, x.data());
    x += amount * (6 * x / grid.size).array().cos().matrix();
    points->InsertNextPoint(x.data());
  }
  result->SetPoints(points);
  return result;
}

/// A wavy sheet, or a rough sphere, around the mesh.
vtkSmartPointer<vtkPolyData> surface(Random& random, const RandomGrid& grid)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  const int n = 3 + random.below(4);
  const bool isSphere = random.happens(0.5);
  const Row middle = middleOf(grid);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const double u = static_cast<double>(i) / (n - 1), v = static_cast<double>(j) / (n - 1);
      Row x(u - 0.5, v - 0.5, 0.1 * random.unit());
      if (isSphere)
      {
        x = 0.4 * Row(std::cos(6.3 * u) * std::sin(3.1 * v), std::sin(6.3 * u) * std::sin(3.1 * v),
                    std::cos(3.1 * v));
      }
      points->InsertNextPoint(Row(middle + grid.size * x).data());
    }
  }
  const bool quads = random.happens(0.5);
  for (int j = 0; j + 1 < n; ++j)
  {
    for (int i = 0; i + 1 < n; ++i)
    {
      const vtkIdType a = i + n * j;
      const vtkIdType quad[] = { a, a + 1, a + 1 + n, a + n };
      const vtkIdType other[] = { a, a + 1 + n, a + n };
      polygons->InsertNextCell(quads ? 4 : 3, quad);
      if (!quads)
      {
        polygons->InsertNextCell(3, other);
      }
    }
  }
  result->SetPoints(points);
  result->SetPolys(polygons);
  return result;
}
}

bool randomTarget(
  Choices& choices, const RandomGrid& grid, double chance, vtkSmartPointer<vtkDataObject>& target)
{
  if (!choices.chance("with.target", chance))
  {
    return true;
  }
  Random random = choices.stream("target");
  auto data =
    grid.isAsMesh && random.happens(0.6) ? wavyBoundary(random, grid) : surface(random, grid);
  target = data;
  if (!choices.chance("hostile.target", 0.12) || data->GetNumberOfPolys() == 0)
  {
    return true;
  }
  const int wrong = choices.pick("target.wrong",
    { "nothing", "ids", "NaN", "huge point", "huge", "no polygons", "flat polygons", "tiny",
      "strips", "other type" },
    { 0, 2, 1, 1, 1, 1, 1, 1, 1, 1 });
  vtkPoints* points = data->GetPoints();
  vtkDataArray* ids = data->GetPolys()->GetConnectivityArray();
  double x[3];
  switch (wrong)
  {
    case 1:
    {
      constexpr double ids1[] = { -1, 1000, 1e9 };
      ids->SetComponent(random.below(static_cast<int>(ids->GetNumberOfTuples())), 0,
        random.happens(0.3) ? static_cast<double>(points->GetNumberOfPoints())
                            : ids1[random.below(3)]);
      break;
    }
    case 2:
    case 3:
    {
      const vtkIdType at = random.below(static_cast<int>(points->GetNumberOfPoints()));
      points->GetPoint(at, x);
      x[random.below(3)] = wrong == 2 ? NaN : random.power(40, 300);
      points->SetPoint(at, x);
      break;
    }
    case 4:
    case 7:
    {
      const double factor = wrong == 4 ? random.power(20, 250) : random.power(-250, -20);
      for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
      {
        points->GetPoint(p, x);
        points->SetPoint(p, factor * x[0], factor * x[1], factor * x[2]);
      }
      break;
    }
    case 5:
      data->SetPolys(nullptr);
      break;
    case 6:
      for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
      {
        if (random.happens(0.3))
        {
          ids->SetComponent(i, 0, 0);
        }
      }
      break;
    case 8:
      data->SetStrips(data->GetPolys());
      data->SetPolys(nullptr);
      break;
    case 9:
      target = grid.data;
      break;
    default:
      break;
  }
  return false;
}

namespace
{
/// Calls the function of that name and purpose of either filter.
void addSurface(vtkDisplacementAlgorithm* filter, int role, const std::string& name)
{
  using Boundary = vtkBoundaryDisplacement;
  using Add = void (Boundary::*)(const char*);
  constexpr Add ofBoundary[] = { &Boundary::AddSurface, &Boundary::AddFixedSurface,
    &Boundary::AddSlidingSurface, &Boundary::AddFreeSurface };
  using AddToMesh = void (vtkMorphMesh::*)(const char*);
  constexpr AddToMesh ofMesh[] = { &vtkMorphMesh::AddSurface, &vtkMorphMesh::AddFixedSurface,
    &vtkMorphMesh::AddSlidingSurface, &vtkMorphMesh::AddFreeSurface };
  auto* boundary = Boundary::SafeDownCast(filter);
  boundary ? (boundary->*ofBoundary[role])(name.c_str())
           : (vtkMorphMesh::SafeDownCast(filter)->*ofMesh[role])(name.c_str());
}

vtkSmartPointer<vtkTransform> transformAbout(
  const Row& middle, double size, Random& random, bool hostile)
{
  auto transform = vtkSmartPointer<vtkTransform>::New();
  transform->PostMultiply();
  transform->Translate((-middle).eval().data());
  transform->RotateWXYZ(random.between(-40, 40), 0.3, random.unit(), 1);
  const double zero = hostile && random.happens(0.3) ? 0 : 1;
  transform->Scale(random.between(0.8, 1.2), zero * random.between(0.8, 1.2), 1);
  transform->Translate(middle.data());
  transform->Translate(0.1 * size * random.unit(), 0, 0);
  if (hostile && random.happens(0.4))
  {
    transform->Translate(random.happens(0.5) ? NaN : random.power(30, 300), 0, 0);
  }
  return transform;
}

/// `kind`: 0 for none.
vtkSmartPointer<vtkImplicitFunction> region(
  int kind, const Row& middle, double size, Random& random, bool hostile)
{
  switch (kind)
  {
    case 1:
    {
      auto sphere = vtkSmartPointer<vtkSphere>::New();
      sphere->SetCenter(middle.x() + size / 2, middle.y(), middle.z());
      sphere->SetRadius(hostile && random.happens(0.3) ? NaN : random.between(0.1, 1) * size);
      return sphere;
    }
    case 2:
    {
      auto box = vtkSmartPointer<vtkBox>::New();
      box->SetBounds(middle.x(), middle.x() + size, middle.y() - size, middle.y() + size,
        middle.z() - size, middle.z() + size);
      return box;
    }
    case 3:
    {
      auto plane = vtkSmartPointer<vtkPlane>::New();
      plane->SetOrigin(middle.x(), middle.y(), middle.z());
      plane->SetNormal(hostile ? NaN : random.between(-1, 1), random.unit(), 1);
      return plane;
    }
    default:
      return nullptr;
  }
}

void setControlPoints(
  const RandomGrid& grid, Random random, bool hostile, vtkDisplacementAlgorithm* filter)
{
  const double size = grid.size;
  const auto any = [&] { return 0.1 * size * random.between(-1, 1); };
  const int handles = random.below(5);
  for (int i = 0; i < handles && grid.mesh.numberOfNodes() > 0; ++i)
  {
    const Row x = grid.mesh.points.row(random.below(static_cast<int>(grid.mesh.numberOfNodes())));
    const double radius = random.happens(0.5) ? 0 : size * random.unit();
    filter->AddHandle(
      x.x(), x.y(), x.z(), any(), any(), any(), hostile && random.happens(0.2) ? NaN : radius);
  }
  const int points = random.below(4);
  filter->SetLatticeSize(2 + random.below(3), 2 + random.below(3), 2 + random.below(3));
  for (int i = 0; i < points; ++i)
  {
    const int last = hostile ? 5 : 2;
    filter->AddLatticeDisplacement(
      random.below(last), random.below(last), random.below(last), any(), any(), any());
  }
}
}

bool setMotion(Choices& choices, const RandomGrid& grid, vtkDisplacementAlgorithm* filter,
  vtkSmartPointer<vtkDataObject>& selection)
{
  Random random = choices.stream("displace");
  const bool hostile = choices.chance("hostile.motion", 0.12);
  const Row middle = middleOf(grid);
  const double size = grid.size;
  filter->SetTransform(transformAbout(middle, size, random, hostile));
  filter->SetDisplacementArray("Displacement");
  filter->SetFieldData(grid.data); // broken, where the input is
  filter->SetFieldArray("Displacement");
  filter->SetMovingArray("Marked");
  const int kind =
    choices.pick("displace.region", { "none", "sphere", "box", "plane" }, { 1, 1, 1, 1 });
  filter->SetRegion(region(kind, middle, size, random, hostile));
  setControlPoints(grid, choices.stream("control points"), hostile, filter);
  // Of all roles; in two of them only if that may be refused.
  std::set<std::string> named;
  const int surfaces = choices.whole("with.surfaces", 0, [](Random& r) { return r.below(5); });
  for (int i = 0; i < surfaces; ++i)
  {
    const bool isSurface = random.happens(0.8);
    const int last = random.below(6);
    const std::string name = (isSurface ? "Surface " : "Curve ") +
                             std::to_string(random.below(last + 1) - (hostile ? 2 : 0));
    const int role = i == 0 ? 0 : random.below(4);
    if (named.insert(name).second || hostile)
    {
      addSurface(filter, role, hostile && random.happens(0.3) ? "Surface x" : name);
    }
  }
  if (grid.hasWalls && choices.chance("with.wallsByName", 0.7))
  {
    addSurface(filter, choices.stream("walls by name").below(4), "Walls");
  }
  if (grid.hasParts && choices.chance("with.partsByName", 0.7))
  {
    Random parts = choices.stream("parts by name");
    addSurface(filter, parts.below(4), parts.happens(0.6) ? "Left | Right" : "Between");
  }
  const int zone = choices.pick("with.zones",
    { "none", "frozen array", "rigid array", "both", "region", "selection" },
    { 20, 1, 1, 1, 1, 1 });
  if (zone == 1 || zone == 3)
  {
    filter->AddFixedZone(random.happens(0.5) ? "Zone" : "Marked");
  }
  if (zone == 2 || zone == 3)
  {
    filter->AddRigidZone(random.happens(0.5) ? "Zone" : "Marked");
  }
  const int type = 1 + random.below(3);
  filter->SetZoneRegion(region(1 + random.below(3), middle, size, random, hostile));
  filter->SetZoneRegionType(zone == 4 ? type : vtkDisplacementAlgorithm::ZONE_NONE);
  filter->SetZoneSelectionType(zone == 5 ? type : vtkDisplacementAlgorithm::ZONE_NONE);
  if (random.happens(0.3))
  {
    filter->SetRigidTransform(transformAbout(middle, size, random, hostile));
  }
  if (zone == 5 || choices.chance("displace.selection", 0.4))
  {
    vtkNew<vtkIdTypeArray> ids;
    const int count = random.below(8);
    for (int i = 0; i < count; ++i)
    {
      ids->InsertNextValue(
        hostile && random.happens(0.3)
          ? 5000
          : random.below(static_cast<int>(std::max<Index>(grid.mesh.numberOfNodes(), 1))));
    }
    vtkNew<vtkSelectionNode> node;
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetFieldType(random.happens(0.5) ? vtkSelectionNode::POINT : vtkSelectionNode::CELL);
    node->SetSelectionList(ids);
    vtkNew<vtkSelection> chosen;
    chosen->AddNode(node);
    selection = chosen;
  }
  return !hostile;
}

bool randomGradient(
  Choices& choices, const RandomGrid& grid, vtkSmartPointer<vtkDataObject>& carrier)
{
  carrier = nullptr;
  if (!grid.grid())
  {
    return false;
  }
  Random random = choices.stream("gradient");
  vtkNew<vtkUnstructuredGrid> copy;
  copy->ShallowCopy(grid.grid());
  vtkNew<vtkDoubleArray> gradient;
  gradient->SetName("Gradient");
  gradient->SetNumberOfComponents(3);
  gradient->SetNumberOfTuples(copy->GetNumberOfPoints());
  for (vtkIdType p = 0; p < copy->GetNumberOfPoints(); ++p)
  {
    gradient->SetTuple3(p, random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  }
  copy->GetPointData()->AddArray(gradient);
  carrier = copy;
  if (!choices.chance("hostile.gradient", 0.12) || copy->GetNumberOfPoints() == 0)
  {
    return true;
  }
  switch (
    choices.pick("gradient.wrong", { "none", "NaN", "short", "name", "huge" }, { 0, 1, 1, 1, 1 }))
  {
    case 1:
      gradient->SetComponent(random.below(static_cast<int>(copy->GetNumberOfPoints())), 1, NaN);
      break;
    case 2:
      gradient->SetNumberOfTuples(copy->GetNumberOfPoints() / 2);
      break;
    case 3:
      gradient->SetName("NoGradient");
      break;
    default:
      gradient->SetComponent(random.below(static_cast<int>(copy->GetNumberOfPoints())), 1, 1e300);
      break;
  }
  return false;
}

vtkSmartPointer<vtkDataObject> boundaryOfGrid(Choices& choices, const RandomGrid& grid)
{
  vtkNew<vtkExtractMorphBoundary> extract;
  extract->SetNumberOfThreads(1);
  extract->SetInputDataObject(grid.data);
  extract->Update();
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(extract->GetOutput());
  if (!choices.chance("hostile.surface", 0.2))
  {
    return surface;
  }
  Random random = choices.stream("surface");
  const int wrong = choices.pick("surface.wrong",
    { "nothing", "no rest positions", "polygon ids", "node ids", "odd arrays", "no polygons" },
    { 0, 1, 1, 1, 1, 1 });
  vtkDataArray* corners = surface->GetPolys()->GetConnectivityArray();
  vtkDataArray* nodes = surface->GetPointData()->GetArray("MorphPointId");
  bool odd = false;
  switch (wrong)
  {
    case 1:
      surface->GetPointData()->RemoveArray("RestPosition");
      break;
    case 2:
    case 3:
    {
      // Of their own: extract's output is not to be touched.
      vtkNew<vtkPolyData> copy;
      copy->DeepCopy(surface);
      surface = copy;
      corners = surface->GetPolys()->GetConnectivityArray();
      nodes = surface->GetPointData()->GetArray("MorphPointId");
      vtkDataArray* ids = wrong == 2 ? corners : nodes;
      constexpr double values[] = { -1, 5000, 1e9 };
      if (ids && ids->GetNumberOfTuples() > 0)
      {
        ids->SetComponent(
          random.below(static_cast<int>(ids->GetNumberOfTuples())), 0, values[random.below(3)]);
      }
      break;
    }
    case 4:
      addArrays(choices, surface, "surface", true, odd);
      break;
    default:
      surface->SetPolys(nullptr);
      break;
  }
  return surface;
}
}
