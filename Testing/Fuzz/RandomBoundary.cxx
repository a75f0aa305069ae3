// SPDX-License-Identifier: BSD-3-Clause
#include "RandomBoundary.h"

#include "RandomMesh.h"
#include "vtkExtractMorphBoundary.h"

#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace fuzz
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;
using Map = std::function<Row(const Row&)>;

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// Where the boundary goes. Lengths are in units of the mesh's size.
Map motion(Choices& choices, const RandomGrid& grid, bool hostile, RandomBoundary& boundary)
{
  const bool isApart = !grid.known.twin.empty() && choices.value("twin.gap") != 0;
  const int kind = choices.pick("motion",
    { "none", "affine", "turn", "twist", "bulge", "noise", "collapse", "huge", "into the other" },
    { 1, 3, 1, 2, 2, 2, hostile ? 0.8 : 0, hostile ? 1.5 : 0, isApart ? 8. : 0. });
  auto random = std::make_shared<Random>(choices.stream("motion"));
  Row middle = Row::Zero();
  for (const Index n : grid.outer)
  {
    middle += grid.mesh.points.row(n) / static_cast<double>(grid.outer.size());
  }
  const double size = grid.size > 0 && std::isfinite(grid.size) ? grid.size : 1;
  const double amount = choices.number("motion.amount", 0.1,
    [hostile](Random& r)
    { return r.happens(hostile ? 0.4 : 0.1) ? r.between(0, 1) : r.between(0, 0.2); });
  const auto any = [&] { return random->between(-1, 1); };
  const auto affine = [&](const Eigen::Matrix3d& matrix, const Row& shift) -> Map
  {
    boundary.isAffine = true;
    boundary.matrix = matrix;
    boundary.shift = middle + shift - middle * matrix.transpose();
    return [=](const Row& x) -> Row { return middle + shift + (x - middle) * matrix.transpose(); };
  };
  switch (kind)
  {
    case 1:
    {
      Eigen::Matrix3d change;
      change << any(), any(), any(), any(), any(), any(), any(), any(), any();
      return affine(
        Eigen::Matrix3d::Identity() + amount * change, amount * size * Row(any(), any(), any()));
    }
    case 2:
      return affine(
        Eigen::AngleAxisd(30 * amount * any(), Eigen::Vector3d(any(), any(), 1.1).normalized())
          .toRotationMatrix(),
        Row::Zero());
    case 3:
    {
      const double turn = 6 * amount * any() / size;
      return [=](const Row& x) -> Row
      {
        const Row d = x - middle;
        const double c = std::cos(turn * d.z()), s = std::sin(turn * d.z());
        return middle + Row(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
      };
    }
    case 4:
    {
      const Row direction = amount * size * Row(any(), any(), any());
      return [=](const Row& x) -> Row
      { return x + direction * std::cos(3 * (x - middle).sum() / size); };
    }
    case 5:
      return [=](const Row& x) -> Row
      {
        return x + 0.3 * amount * size *
                     Row(random->between(-1, 1), random->between(-1, 1), random->between(-1, 1));
      };
    case 6:
      return [=](const Row& x) -> Row { return middle + 0 * x; };
    case 7:
    {
      const double factor = random->power(3, random->happens(0.5) ? 12 : 300);
      return [=](const Row& x) -> Row { return middle + factor * (x - middle); };
    }
    case 8:
    {
      std::set<std::vector<double>> places;
      Row step = Row::Zero(); // from a body to the other, a copy
      for (const Index n : grid.outer)
      {
        const Row x = grid.mesh.points.row(n);
        const std::vector<Index>& twin = grid.known.twin;
        const bool isTwin = std::binary_search(twin.begin(), twin.end(), n);
        step += (isTwin ? 2. : -2.) / static_cast<double>(grid.outer.size()) * x;
        if (isTwin)
        {
          places.insert({ x[0], x[1], x[2] });
        }
      }
      const Row into = -random->between(0.3, 0.7) * step;
      return [=](const Row& x) -> Row {
        return places.count({ x[0], x[1], x[2] }) > 0 ? Row(x + into) : x;
      };
    }
    default:
      boundary.isNothing = boundary.isAffine = true;
      return [](const Row& x) { return x; };
  }
}

/// The nodes to be named.
std::vector<Index> chooseNodes(Choices& choices, const RandomGrid& grid, RandomBoundary& boundary)
{
  const int which = choices.pick("boundary.nodes",
    { "outer", "part of the outer", "outer and some inside", "all", "few", "one", "one end" },
    { 12, 3, 1.5, 0.4, 0.6, 0.3, 2 });
  Random random = choices.stream("boundary.nodes");
  const std::vector<Index>& all = grid.nodes;
  const std::set<Index> outer(grid.outer.begin(), grid.outer.end());
  const double part = random.unit();
  double last = -Infinity;
  for (const Index n : all)
  {
    last = std::max(last, grid.mesh.points(n, 0));
  }
  const double end = last - 0.2 * part * grid.size;
  std::vector<Index> nodes;
  for (const Index n : all)
  {
    const bool isOuter = outer.count(n) > 0;
    const bool takes[] = { isOuter, isOuter && random.happens(part),
      isOuter || random.happens(0.3 * part), true, random.happens(0.1), nodes.empty(),
      isOuter && grid.mesh.points(n, 0) >= end };
    if (takes[which])
    {
      nodes.push_back(n);
    }
  }
  if (which == 1 || which >= 4)
  {
    boundary.isAffine = false;
  }
  if (choices.chance("boundary.shuffled", 0.2))
  {
    for (std::size_t i = nodes.size(); i > 1; --i)
    {
      std::swap(nodes[i - 1], nodes[random.below(static_cast<int>(i))]);
    }
  }
  return nodes;
}

/// Whether two nodes are in one place: no position tells which is meant.
bool hasTwins(const morph::Mesh& mesh)
{
  std::set<std::array<double, 3>> places;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    places.insert({ mesh.points(n, 0), mesh.points(n, 1), mesh.points(n, 2) });
  }
  return static_cast<Index>(places.size()) < mesh.numberOfNodes();
}

vtkSmartPointer<vtkPoints> newPoints(int type)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  return points;
}

vtkSmartPointer<vtkDataArray> idsOfType(int type)
{
  switch (type)
  {
    case 1:
      return vtkSmartPointer<vtkIntArray>::New();
    case 2:
      return vtkSmartPointer<vtkDoubleArray>::New();
    case 3:
      return vtkSmartPointer<vtkFloatArray>::New();
    default:
      return vtkSmartPointer<vtkIdTypeArray>::New();
  }
}

void spoilIds(Random random, vtkDataArray* ids, vtkPointSet* data, Index nodes)
{
  const auto count = static_cast<int>(ids->GetNumberOfTuples());
  const int at = count > 0 ? random.below(count) : 0;
  const int how = random.below(count > 0 ? 8 : 1);
  constexpr double away[] = { 0, -1, -7, 1e9, 0.5 };
  if (how >= 1 && how <= 4)
  {
    ids->SetComponent(at, 0, how == 3 ? static_cast<double>(nodes) + random.below(3) : away[how]);
  }
  else if (how == 5)
  {
    ids->SetComponent(at, 0, ids->GetComponent(random.below(count), 0));
  }
  else if (how == 6)
  {
    ids->SetNumberOfTuples(random.happens(0.5) ? at : count + 3);
  }
  else if (how == 7)
  {
    vtkNew<vtkStringArray> names;
    names->SetName(ids->GetName());
    names->SetNumberOfTuples(count);
    data->GetPointData()->RemoveArray(ids->GetName());
    data->GetPointData()->AddArray(names);
  }
  else
  {
    ids->SetName("NobodyKnowsThis");
  }
}

void spoilPoints(Random random, vtkPoints* points)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return;
  }
  constexpr double values[] = { NaN, Infinity, -Infinity, 1e39, 1e55, 1e100, 1e160, 1e200, 1e300 };
  double x[3];
  const vtkIdType at = random.below(static_cast<int>(points->GetNumberOfPoints()));
  points->GetPoint(at, x);
  x[random.below(3)] = values[random.below(static_cast<int>(std::size(values)))];
  points->SetPoint(at, x);
}

void spoilVectors(Random random, vtkPointSet* data, const char* name)
{
  vtkDataArray* array = data->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfTuples() == 0)
  {
    return;
  }
  const int at = random.below(static_cast<int>(array->GetNumberOfTuples()));
  constexpr double values[] = { NaN, Infinity, 1e60, 1e200, 5 };
  if (random.happens(0.6))
  {
    array->SetComponent(at, random.below(3), values[random.below(5)]);
  }
  else
  {
    array->SetNumberOfTuples(random.happens(0.5) ? at : array->GetNumberOfTuples() + 2);
  }
}

void addRest(
  vtkPointSet* data, const std::vector<Index>& nodes, const morph::Points& points, const char* name)
{
  vtkNew<vtkDoubleArray> rest;
  rest->SetName(name);
  rest->SetNumberOfComponents(4);
  for (const Index n : nodes)
  {
    rest->InsertNextTuple4(points(n, 0), points(n, 1), points(n, 2), 1);
  }
  data->GetPointData()->AddArray(rest);
}

/// What vtkProbeFilter and others mark as nothing: points whose values, and here places, say
/// nothing. With displacements they name no node; else the mask means nothing.
void addMask(Random random, vtkPointSet* data, RandomBoundary& boundary)
{
  vtkNew<vtkSignedCharArray> mask;
  mask->SetName("vtkValidPointMask");
  const double part = random.between(0.3, 1);
  std::vector<std::pair<Index, Row>> left;
  const bool areNamed =
    static_cast<vtkIdType>(boundary.targets.size()) == data->GetNumberOfPoints();
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    const bool isValid = random.happens(part);
    mask->InsertNextValue(isValid);
    if (areNamed && isValid)
    {
      left.push_back(boundary.targets[p]);
    }
  }
  data->GetPointData()->AddArray(mask);
  if (!boundary.displacementArray.empty())
  {
    boundary.targets = left;
    boundary.isRight = boundary.isRight && areNamed;
    boundary.isAffine = false;
  }
}

/// As an application would: Extract Morph Boundary, then a filter that moves points.
vtkSmartPointer<vtkPointSet> extracted(
  const RandomGrid& grid, const Map& map, RandomBoundary& boundary)
{
  vtkNew<vtkExtractMorphBoundary> extract;
  extract->SetNumberOfThreads(1);
  extract->SetInputDataObject(grid.data);
  extract->Update();
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(extract->GetOutput());
  auto points = newPoints(VTK_DOUBLE);
  vtkDataArray* ids = surface->GetPointData()->GetArray("MorphPointId");
  if (!ids || ids->GetNumberOfTuples() != surface->GetNumberOfPoints())
  {
    boundary.isRight = false;
    return surface;
  }
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p)
  {
    Row rest;
    surface->GetPoint(p, rest.data());
    const Row target = map(rest);
    points->InsertNextPoint(target.data());
    const auto node = static_cast<Index>(ids->GetComponent(p, 0));
    if (node < grid.mesh.numberOfNodes()) // others are images across a shell
    {
      boundary.targets.emplace_back(node, target);
    }
  }
  boundary.isRight = grid.isAsMesh;
  surface->SetPoints(points);
  return surface;
}

/// Whether a place does not tell which node is meant: another node lies there that is not named, or
/// that goes elsewhere.
bool areAmbiguous(const morph::Points& points, const std::vector<std::pair<Index, Row>>& targets)
{
  const auto place = [&points](Index n) -> std::array<double, 3> {
    return { points(n, 0), points(n, 1), points(n, 2) };
  };
  std::map<std::array<double, 3>, std::pair<std::set<Index>, Row>> named;
  for (const auto& [node, target] : targets)
  {
    if (points.row(node).allFinite())
    {
      auto& [nodes, first] =
        named.try_emplace(place(node), std::set<Index>(), target).first->second;
      nodes.insert(node);
      if (first != target)
      {
        return true;
      }
    }
  }
  for (Index n = 0; n < points.rows(); ++n)
  {
    const auto found = points.row(n).allFinite() ? named.find(place(n)) : named.end();
    if (found != named.end() && found->second.first.count(n) == 0)
    {
      return true;
    }
  }
  return false;
}

vtkSmartPointer<vtkDataObject> otherData(int type, vtkPointSet* data)
{
  switch (type)
  {
    case 1:
      return nullptr;
    case 2:
    {
      auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
      blocks->SetBlock(0, data);
      return blocks;
    }
    case 3:
      return vtkSmartPointer<vtkImageData>::New();
    case 4:
      return vtkSmartPointer<vtkTable>::New();
    default:
      return vtkSmartPointer<vtkPolyData>::New();
  }
}
}

RandomBoundary randomBoundary(Choices& choices, const RandomGrid& grid)
{
  RandomBoundary boundary;
  const bool hostile = choices.chance("hostile.boundary", 0.13);
  const Map map = motion(choices, grid, hostile, boundary);
  Random random = choices.stream("boundary");
  const int ids = choices.pick("boundary.ids",
    { "MorphPointId", "Extract Morph Boundary", "own array", "PointIds", "vtkOriginalPointIds",
      "as many points", "nearest" },
    { 4, grid.isAsMesh ? 4.0 : 0.0, 1.5, 0.7, 0.4, 0.7, 0.7 });
  const bool isComposite = vtkCompositeDataSet::SafeDownCast(grid.data);
  const bool displaced = ids == 6 || choices.chance("boundary.displacements", 0.12);
  const int pointType =
    choices.chance("boundary.float", 0.15) && !displaced ? VTK_FLOAT : VTK_DOUBLE;
  vtkSmartPointer<vtkPointSet> data;
  if ((ids == 1 && !displaced && grid.isAsMesh) || isComposite)
  {
    data = extracted(grid, map, boundary);
  }
  else
  {
    std::vector<Index> nodes = chooseNodes(choices, grid, boundary);
    if (ids == 5)
    {
      nodes.resize(grid.mesh.numberOfNodes());
      std::iota(nodes.begin(), nodes.end(), Index{ 0 });
    }
    if (choices.chance("boundary.isGrid", 0.15))
    {
      data = vtkSmartPointer<vtkUnstructuredGrid>::New();
    }
    else
    {
      data = vtkSmartPointer<vtkPolyData>::New();
    }
    auto points = newPoints(pointType);
    auto numbers = idsOfType(
      choices.pick("boundary.idType", { "vtkIdType", "int", "double", "float" }, { 8, 1, 1, 1 }));
    constexpr const char* names[] = { "MorphPointId", "MorphPointId", "MyIds", "PointIds",
      "vtkOriginalPointIds" };
    vtkNew<vtkDoubleArray> displacements;
    displacements->SetName("MyDisplacement");
    displacements->SetNumberOfComponents(3);
    const std::set<Index> outer(grid.outer.begin(), grid.outer.end());
    for (const Index n : nodes)
    {
      const Row rest = grid.mesh.points.row(n);
      const Row target = map(rest);
      const Row step = target - rest;
      points->InsertNextPoint((displaced ? rest : target).data());
      displacements->InsertNextTuple(step.data());
      numbers->InsertNextTuple1(static_cast<double>(n));
      // Nodes inside are not taken where numbers alone tell which is which.
      if (ids != 5 || outer.count(n))
      {
        double stored[3];
        points->GetPoint(points->GetNumberOfPoints() - 1, stored);
        boundary.targets.emplace_back(
          n, displaced ? Row(rest + step) : Row(stored[0], stored[1], stored[2]));
      }
    }
    data->SetPoints(points);
    if (ids < 5)
    {
      numbers->SetName(names[ids]);
      data->GetPointData()->AddArray(numbers);
      boundary.idArray = ids == 2 ? "MyIds" : "";
    }
    if (displaced)
    {
      data->GetPointData()->AddArray(displacements);
      boundary.displacementArray = "MyDisplacement";
      boundary.isExact = false;
    }
    if (choices.chance("boundary.restPosition", 0.3) && ids != 5)
    {
      addRest(data, nodes, grid.mesh.points, "RestPosition");
    }
    if (choices.chance("with.mask", 0.06))
    {
      addMask(choices.stream("mask"), data, boundary);
    }
  }
  // As many points as the mesh has nodes are matched by their numbers before their names are looked
  // at.
  const bool isLikeMesh = data->GetNumberOfPoints() == grid.mesh.numberOfNodes();
  if ((isLikeMesh && (ids == 3 || ids == 4 || ids == 6)) || (ids == 6 && hasTwins(grid.mesh)))
  {
    boundary.isRight = false;
  }
  if (ids == 6 && areAmbiguous(grid.mesh.points, boundary.targets))
  {
    boundary.isRight = false;
  }
  // Several nodes may lie in one place; and the float nearest to an undeformed position is not
  // that position.
  boundary.isExact = boundary.isExact && ids != 6;
  if (hostile)
  {
    vtkDataArray* numbers =
      data->GetPointData()->GetArray(boundary.idArray.empty() ? "MorphPointId" : "MyIds");
    const int wrong = choices.pick("boundary.wrong",
      { "nothing", "ids", "points", "rest positions", "displacements", "type", "odd arrays" },
      { 3, 3, 2, 1, 1, 1, 2 });
    if (wrong == 1 && numbers)
    {
      spoilIds(choices.stream("boundary.wrongIds"), numbers, data, grid.mesh.numberOfNodes());
    }
    else if (wrong == 2)
    {
      spoilPoints(choices.stream("boundary.wrongPoints"), data->GetPoints());
    }
    else if (wrong == 3 || wrong == 4)
    {
      spoilVectors(choices.stream("boundary.wrongVectors"), data,
        wrong == 3 ? "RestPosition" : "MyDisplacement");
    }
    else if (wrong == 6)
    {
      bool odd = false;
      addArrays(choices, data, "boundary", true, odd);
    }
    boundary.isRight = boundary.isRight && wrong == 0;
    boundary.isNothing = boundary.isNothing && wrong == 0;
    boundary.data = data;
    if (wrong == 5)
    {
      boundary.data = otherData(1 + random.below(5), data);
    }
  }
  else
  {
    boundary.data = data;
  }
  return boundary;
}
}
