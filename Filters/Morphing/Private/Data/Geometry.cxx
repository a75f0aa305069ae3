// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Geometry.h"

#include "Mesh/CellShape.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Surface.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;

/// The array of that name, with one number for each of `count` cells or points; null where there is
/// no such array.
vtkDataArray* findNumbers(
  vtkDataSetAttributes* data, const std::string& name, vtkIdType count, const char* what)
{
  vtkAbstractArray* array = data->GetAbstractArray(name.c_str());
  if (!array)
  {
    return nullptr;
  }
  const std::string subject = std::string("The input's ") + what + " array '" + name + "'";
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers)
  {
    throw Error(subject + " is not numeric (it is a " + array->GetClassName() +
                "). Convert it to numbers, or rename it.");
  }
  if (numbers->GetNumberOfComponents() != 1)
  {
    throw Error(subject + " has " + std::to_string(numbers->GetNumberOfComponents()) +
                " components; one is needed.");
  }
  // VTK does not ensure that arrays are as long as their data set.
  if (numbers->GetNumberOfTuples() != count)
  {
    throw Error(subject + " has " + std::to_string(numbers->GetNumberOfTuples()) + " values for " +
                std::to_string(count) + " " + what + "s. Give it one for each, or remove it.");
  }
  return numbers;
}

/// The array's values at `places` as ids, in an array as long as the whole; 0 elsewhere.
std::vector<Index> wholeNumbers(
  vtkDataArray* array, const std::vector<Index>& places, const char* what)
{
  std::vector<Index> values(array->GetNumberOfTuples(), 0), wrong;
  for (Index place : places)
  {
    const double value = array->GetComponent(place, 0);
    // 2^53: above it a double does not hold every whole number.
    if (std::floor(value) == value && std::abs(value) <= 9007199254740992.)
    {
      values[place] = static_cast<Index>(value);
    }
    else
    {
      wrong.push_back(place);
    }
  }
  if (!wrong.empty())
  {
    throw Error(std::string("The input's ") + what + " array '" + array->GetName() +
                "' holds values that are not whole numbers, at its " + what + "s " +
                morph::listIds(wrong) + ".");
  }
  return values;
}

const morph::CellShape* shapeOf(const morph::Mesh& mesh, Index cell, int dimension)
{
  const morph::CellShape* shape = morph::cellShape(mesh.types[cell]);
  return shape && shape->dimension == dimension ? shape : nullptr;
}

vtkDataArray* requireCellNumbers(vtkDataSet* input, const std::string& name)
{
  vtkDataArray* array = findNumbers(input->GetCellData(), name, input->GetNumberOfCells(), "cell");
  if (!array)
  {
    throw Error("`SurfaceIdArray` names '" + name + "', which is no cell array of the input.");
  }
  return array;
}

/// The ids of the faces, from the cells on them or, where the grid has volume cells alone, from the
/// cells behind them.
std::vector<Index> surfaceIds(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const std::string& name)
{
  vtkDataArray* array = requireCellNumbers(grid, name);
  std::vector<Index> flat;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (shapeOf(mesh, c, 2) && mesh.cellSize(c) >= 3)
    {
      flat.push_back(c);
    }
  }
  const std::vector<Index> ids = wholeNumbers(array, flat.empty() ? faces.cells : flat, "cell");

  std::vector<Index> result(faces.cells.size(), morph::NoGeometry);
  if (flat.empty())
  {
    std::transform(faces.cells.begin(), faces.cells.end(), result.begin(),
      [&](Index cell) { return ids[cell]; });
    return result;
  }
  std::map<std::vector<Index>, Index> byCorners; // the lowest cell's id
  for (Index c : flat)
  {
    const int known = shapeOf(mesh, c, 2)->numberOfCorners;
    const Index size = known > 0 ? known : mesh.cellSize(c);
    std::vector<Index> corners(mesh.cell(c), mesh.cell(c) + size);
    std::sort(corners.begin(), corners.end());
    byCorners.emplace(std::move(corners), ids[c]);
  }
  for (std::size_t f = 0; f < result.size(); ++f)
  {
    std::vector<Index> corners(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
    std::sort(corners.begin(), corners.end());
    const auto found = byCorners.find(corners);
    result[f] = found == byCorners.end() ? morph::NoGeometry : found->second;
  }
  if (!faces.cells.empty() &&
      std::all_of(result.begin(), result.end(), [](Index id) { return id == morph::NoGeometry; }))
  {
    throw Error("None of the input's " + std::to_string(flat.size()) +
                " two-dimensional cells, whose '" + name +
                "' would name the surfaces, lies on a boundary face of its volume cells. Merge "
                "coincident points first (Clean to Grid), or choose another array.");
  }
  return result;
}

void readGeometryArrays(
  vtkDataSet* grid, const std::vector<Index>& nodes, morph::GivenGeometry& given)
{
  vtkPointData* data = grid->GetPointData();
  const auto find = [&](const char* name)
  { return findNumbers(data, name, grid->GetNumberOfPoints(), "point"); };
  vtkDataArray* dimension = find(Geometry::DimensionName);
  vtkDataArray* id = find(Geometry::IdName);
  vtkDataArray* parameter = find(Geometry::ParameterName);
  if (!dimension && !id)
  {
    return;
  }
  if (!dimension || !id)
  {
    throw Error(
      std::string("The input has the point array ") +
      (id ? "GeometryId, but no GeometryDimension" : "GeometryDimension, but no GeometryId") +
      ". Give both, or turn `UseGeometryArrays` off.");
  }
  for (Index value : wholeNumbers(dimension, nodes, "point"))
  {
    given.dimension.push_back(static_cast<std::int8_t>(std::clamp<Index>(value, -1, 3)));
  }
  given.id = wholeNumbers(id, nodes, "point");
  for (vtkIdType n = 0; parameter && n < parameter->GetNumberOfTuples(); ++n)
  {
    given.parameter.push_back(parameter->GetComponent(n, 0));
  }
}

morph::ClassificationOptions coreOptions(const Geometry::Options& options)
{
  morph::ClassificationOptions core;
  core.featureAngle = options.FeatureAngle;
  core.cornerAngle = options.CornerAngle;
  core.featuresInside = options.FeaturesInside;
  core.sheets = options.Sheets;
  return core;
}
}

namespace Geometry
{
std::string Key(vtkPointSet* input, const Options& options)
{
  std::ostringstream key;
  key.precision(17);
  key << input->GetClassName() << ' ' << options.FeatureAngle << ' ' << options.CornerAngle << ' '
      << options.FeaturesInside << ' ' << options.UseGeometryArrays << ' '
      << options.SurfaceIdArray;
  const auto add = [&key](vtkAbstractArray* array) {
    key << '\n' << array << ' ' << (array ? array->GetMTime() : 0);
  };
  if (!options.SurfaceIdArray.empty())
  {
    add(input->GetCellData()->GetAbstractArray(options.SurfaceIdArray.c_str()));
  }
  else if (options.UseGeometryArrays)
  {
    for (const char* name : { DimensionName, IdName, ParameterName })
    {
      add(input->GetPointData()->GetAbstractArray(name));
    }
  }
  return key.str();
}

morph::Classification Classify(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor)
{
  morph::ClassificationOptions core = coreOptions(options);
  if (!options.SurfaceIdArray.empty())
  {
    core.given.surface = surfaceIds(grid, mesh, faces, options.SurfaceIdArray);
  }
  else if (options.UseGeometryArrays)
  {
    readGeometryArrays(grid, faces.nodes, core.given);
  }
  return morph::classify(mesh, faces, core, monitor);
}

morph::Classification Classify(vtkPolyData* surface, const morph::Points& points,
  const morph::BoundaryFaces& faces, const Options& options, morph::Monitor& monitor)
{
  morph::ClassificationOptions core = coreOptions(options);
  if (!options.SurfaceIdArray.empty())
  {
    std::vector<Index> polygons = consecutive<Index>(
      faces.offsets.size() - 1, surface->GetNumberOfVerts() + surface->GetNumberOfLines());
    const std::vector<Index> ids =
      wholeNumbers(requireCellNumbers(surface, options.SurfaceIdArray), polygons, "cell");
    core.given.surface.assign(ids.begin() + polygons[0], ids.begin() + polygons.back() + 1);
  }
  else if (options.UseGeometryArrays)
  {
    readGeometryArrays(surface, faces.nodes, core.given);
  }
  return morph::classify(points, faces, core, monitor);
}

void AddPointArrays(const morph::Classification& geometry, const std::vector<morph::Index>& nodes,
  vtkDataSetAttributes* output)
{
  auto dimension =
    Arrays::Make<vtkSignedCharArray>(DimensionName, static_cast<vtkIdType>(nodes.size()));
  auto id = Arrays::Make<vtkIdTypeArray>(IdName, static_cast<vtkIdType>(nodes.size()));
  auto parameter =
    Arrays::Make<vtkDoubleArray>(ParameterName, static_cast<vtkIdType>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const vtkIdType k = static_cast<vtkIdType>(i);
    dimension->SetValue(k, geometry.dimension[nodes[i]]);
    id->SetValue(k, geometry.id(nodes[i]));
    // Not NaN elsewhere: VTK writes that to ASCII files, and cannot read it.
    parameter->SetValue(k, geometry.dimension[nodes[i]] == 1 ? geometry.parameter[nodes[i]] : 0);
  }
  Arrays::Add(dimension, output);
  Arrays::Add(id, output);
  Arrays::Add(parameter, output);
}

void AddSurfaceIds(const morph::Classification& geometry, const std::vector<morph::Index>& faceOf,
  vtkPolyData* output)
{
  Arrays::Add(Arrays::MakeOf<vtkIdTypeArray>(IdName, faceOf,
                [&](Index face) { return geometry.surfaces[geometry.surfaceOfFace[face]].id; }),
    output->GetCellData());
}

void WriteCurves(
  vtkUnstructuredGrid* grid, const morph::Classification& geometry, vtkPolyData* output)
{
  std::vector<morph::Index> nodes;
  for (std::size_t n = 0; n < geometry.dimension.size(); ++n)
  {
    if (geometry.dimension[n] == 0 || geometry.dimension[n] == 1)
    {
      nodes.push_back(static_cast<Index>(n));
    }
  }
  std::vector<vtkIdType> number(geometry.dimension.size(), -1);
  auto points = Arrays::MakePoints(grid->GetPoints()->GetDataType());
  auto ids = Arrays::Make<vtkIdTypeArray>(Surface::IdName, static_cast<vtkIdType>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    number[nodes[i]] = points->InsertNextPoint(grid->GetPoint(nodes[i]));
    ids->SetValue(static_cast<vtkIdType>(i), nodes[i]);
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(ids);
  AddPointArrays(geometry, nodes, output->GetPointData());

  const auto cells = static_cast<vtkIdType>(geometry.vertices.size() + geometry.curves.size());
  auto dimension = Arrays::Make<vtkSignedCharArray>(DimensionName, cells);
  auto id = Arrays::Make<vtkIdTypeArray>(IdName, cells);
  vtkIdType cell = 0;
  vtkNew<vtkCellArray> vertices, lines;
  for (const morph::GeometryVertex& vertex : geometry.vertices)
  {
    vertices->InsertNextCell(1, &number[vertex.node]);
    dimension->SetValue(cell, 0);
    id->SetValue(cell++, vertex.id);
  }
  for (const morph::GeometryCurve& curve : geometry.curves)
  {
    lines->InsertNextCell(static_cast<int>(curve.nodes.size() + curve.loop));
    for (Index node : curve.nodes)
    {
      lines->InsertCellPoint(number[node]);
    }
    if (curve.loop)
    {
      lines->InsertCellPoint(number[curve.nodes[0]]);
    }
    dimension->SetValue(cell, 1);
    id->SetValue(cell++, curve.id);
  }
  output->SetVerts(vertices);
  output->SetLines(lines);
  output->GetCellData()->AddArray(dimension);
  output->GetCellData()->AddArray(id);
}
}
}
