// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/ControlPoints.h"

#include "Mesh/Mesh.h"
#include "Private/Data/Arrays.h"
#include "Support/Error.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

/// An array of so many tuples and components; null where it is optional and there is none.
vtkDataArray* arrayOf(vtkFieldData* data, const std::string& name, int components, vtkIdType tuples,
  const std::string& whose, bool isOptional = false)
{
  vtkAbstractArray* any = data->GetAbstractArray(name.c_str());
  if (!any && isOptional)
  {
    return nullptr;
  }
  auto* array = vtkDataArray::SafeDownCast(any);
  const std::string subject = whose + " array '" + name + "'";
  if (!array)
  {
    throw Error(subject + (any ? " is not numeric." : " is missing."));
  }
  if (array->GetNumberOfComponents() != components)
  {
    throw Error(subject + " has " + std::to_string(array->GetNumberOfComponents()) +
                " components; " + std::to_string(components) + " are needed.");
  }
  if (array->GetNumberOfTuples() < tuples)
  {
    throw Error(subject + " has " + std::to_string(array->GetNumberOfTuples()) + " values for " +
                std::to_string(tuples) + " points.");
  }
  return array;
}

/// The rows of a table in columns of these names. A last name after a '?' is optional, else 0.
template <std::size_t Columns>
std::vector<std::array<double, Columns>> rowsOf(
  vtkTable* table, const std::array<const char*, Columns>& names, const std::string& whose)
{
  std::vector<std::array<double, Columns>> rows(table->GetNumberOfRows());
  for (std::size_t c = 0; c < Columns; ++c)
  {
    const bool isOptional = names[c][0] == '?';
    vtkDataArray* column = arrayOf(table->GetRowData(), names[c] + (isOptional ? 1 : 0), 1,
      table->GetNumberOfRows(), whose, isOptional);
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      rows[r][c] = column ? column->GetComponent(static_cast<vtkIdType>(r), 0) : 0;
    }
  }
  return rows;
}

vtkPointSet* pointsOf(vtkDataObject* given)
{
  auto* points = vtkPointSet::SafeDownCast(given);
  if (!points)
  {
    throw Error(std::string("The control points are a ") + given->GetClassName() +
                "; a vtkPointSet or a vtkTable is needed.");
  }
  return points;
}

Handle handleOf(const std::array<double, 7>& v)
{
  return { { v[0], v[1], v[2] }, { v[3], v[4], v[5] }, v[6] };
}

/// With a vertex each, since VTK's append filter may leave out what has no cells.
vtkSmartPointer<vtkPolyData> asPoints(const std::vector<Handle>& handles)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  auto places = Arrays::MakePoints(VTK_DOUBLE);
  auto vectors = Arrays::Make<vtkDoubleArray>("Displacement", 0, 3);
  result->AllocateExact(static_cast<vtkIdType>(handles.size()), 1);
  result->SetPoints(places);
  for (const Handle& handle : handles)
  {
    const vtkIdType point = places->InsertNextPoint(handle.place.data());
    vectors->InsertNextTuple(handle.displacement.data());
    result->InsertNextCell(VTK_VERTEX, 1, &point);
  }
  result->GetPointData()->AddArray(vectors);
  result->GetPointData()->AddArray(Arrays::MakeOf<vtkDoubleArray>(
    "Radius", handles, [](const Handle& handle) { return handle.radius; }));
  return result;
}

/// Adds a displacement, of a point i, j, k.
void addTo(Points& displacements, const std::array<double, 6>& row, const std::array<int, 3>& size)
{
  Index id = 0;
  for (int d = 2; d >= 0; --d)
  {
    if (!(row[d] >= 0 && row[d] < size[d]) || row[d] != std::floor(row[d]))
    {
      throw Error("The lattice has no control point " + std::to_string(row[0]) + ", " +
                  std::to_string(row[1]) + ", " + std::to_string(row[2]) +
                  ": i, j and k are whole numbers from 0, below `LatticeSize` (" +
                  std::to_string(size[0]) + ", " + std::to_string(size[1]) + ", " +
                  std::to_string(size[2]) + ").");
    }
    id = id * size[d] + static_cast<Index>(row[d]);
  }
  displacements.row(id) += Eigen::RowVector3d(row[3], row[4], row[5]);
}
}

namespace ControlPoints
{
bool AreNone(vtkDataObject* given)
{
  auto* table = vtkTable::SafeDownCast(given);
  auto* points = vtkPointSet::SafeDownCast(given);
  return !given || (table && table->GetNumberOfColumns() == 0) ||
         (points && points->GetNumberOfPoints() == 0);
}

std::vector<Handle> Handles(
  vtkDataObject* given, const std::vector<std::array<double, 7>>& listed, const std::string& whose)
{
  std::vector<Handle> result;
  std::transform(listed.begin(), listed.end(), std::back_inserter(result), handleOf);
  if (AreNone(given))
  {
    return result;
  }
  if (auto* table = vtkTable::SafeDownCast(given))
  {
    for (const auto& row : rowsOf<7>(table, { "x", "y", "z", "dx", "dy", "dz", "?radius" }, whose))
    {
      result.push_back(handleOf(row));
    }
    return result;
  }
  vtkPointSet* points = pointsOf(given);
  const vtkIdType count = points->GetNumberOfPoints();
  vtkDataArray* vectors = arrayOf(points->GetPointData(), "Displacement", 3, count, whose);
  vtkDataArray* radii = arrayOf(points->GetPointData(), "Radius", 1, count, whose, true);
  for (vtkIdType i = 0; i < count; ++i)
  {
    Handle handle;
    points->GetPoint(i, handle.place.data());
    vectors->GetTuple(i, handle.displacement.data());
    handle.radius = radii ? radii->GetComponent(i, 0) : 0;
    result.push_back(handle);
  }
  return result;
}

Points Lattice(vtkDataObject* given, const std::vector<std::array<double, 6>>& listed,
  const std::array<int, 3>& size)
{
  const Index count = static_cast<Index>(size[0]) * size[1] * size[2];
  Points result = Points::Zero(count, 3);
  for (const auto& row : listed)
  {
    addTo(result, row, size);
  }
  auto* table = vtkTable::SafeDownCast(given);
  if (table && !AreNone(given))
  {
    for (const auto& row : rowsOf<6>(table, { "i", "j", "k", "dx", "dy", "dz" }, Whose))
    {
      addTo(result, row, size);
    }
  }
  else if (!AreNone(given))
  {
    vtkPointSet* points = pointsOf(given);
    if (points->GetNumberOfPoints() != count)
    {
      throw Error("The lattice has " + std::to_string(count) +
                  " control points, the product of "
                  "`LatticeSize`, and " +
                  std::to_string(points->GetNumberOfPoints()) + " are given.");
    }
    vtkDataArray* vectors = arrayOf(points->GetPointData(), "Displacement", 3, count, Whose);
    for (Index i = 0; i < count; ++i)
    {
      Eigen::RowVector3d vector;
      vectors->GetTuple(i, vector.data());
      result.row(i) += vector;
    }
  }
  const std::vector<Index> bad = morph::immoderateRows(result);
  if (!bad.empty())
  {
    throw Error("Control points have displacements that are not finite or beyond 1e50: control "
                "points " +
                morph::listIds(bad) + ", those of the first direction counted first.");
  }
  return result;
}

void Write(const std::vector<Handle>& handles, vtkPolyData* output)
{
  output->ShallowCopy(asPoints(handles));
}

void Write(const LatticeMotion& lattice, vtkPolyData* output)
{
  std::vector<Handle> points;
  const Points rest = lattice.controlPoints();
  for (Index i = 0; i < rest.rows(); ++i)
  {
    const Eigen::RowVector3d by = lattice.controlDisplacements.row(i);
    points.push_back({ rest.row(i) + by, by, 0 });
  }
  output->ShallowCopy(asPoints(points));
  output->GetPointData()->RemoveArray("Radius");
  vtkNew<vtkCellArray> lines;
  Index step = 1;
  for (const int count : lattice.size)
  {
    for (Index i = 0; i < rest.rows(); ++i)
    {
      if (i / step % count + 1 < count)
      {
        const vtkIdType ends[] = { static_cast<vtkIdType>(i), static_cast<vtkIdType>(i + step) };
        lines->InsertNextCell(2, ends);
      }
    }
    step *= count;
  }
  output->SetLines(lines);
}

vtkSmartPointer<vtkPolyData> AsHandles(vtkDataObject* given, const std::string& whose)
{
  return asPoints(Handles(given, {}, whose));
}

vtkSmartPointer<vtkPolyData> AsLattice(vtkDataObject* given, const std::array<int, 3>& size)
{
  std::vector<Handle> handles;
  const Points displacements = AreNone(given) ? Points() : Lattice(given, {}, size);
  for (Index i = 0; i < displacements.rows(); ++i)
  {
    handles.push_back({ Eigen::RowVector3d::Zero(), displacements.row(i), 0 });
  }
  return asPoints(handles);
}
}
}
