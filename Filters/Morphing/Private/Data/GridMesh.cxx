// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/GridMesh.h"

#include "Mesh/CellShape.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace morph::filters
{
namespace
{
/// Tells 0.0 from -0.0.
std::uint64_t bitsOf(double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Calls visit(values, count) with the array's memory, whatever integer type it has.
template <typename Visitor>
void visitOffsets(vtkCellArray* cells, Visitor&& visit)
{
  if (cells->IsStorage64Bit())
  {
    auto* array = cells->GetOffsetsArray64();
    visit(array->GetPointer(0), array->GetNumberOfValues());
  }
  else
  {
    auto* array = cells->GetOffsetsArray32();
    visit(array->GetPointer(0), array->GetNumberOfValues());
  }
}

template <typename Visitor>
void visitConnectivity(vtkCellArray* cells, Visitor&& visit)
{
  if (cells->IsStorage64Bit())
  {
    auto* array = cells->GetConnectivityArray64();
    visit(array->GetPointer(0), array->GetNumberOfValues());
  }
  else
  {
    auto* array = cells->GetConnectivityArray32();
    visit(array->GetPointer(0), array->GetNumberOfValues());
  }
}

template <typename Value>
bool equals(const Value* values, vtkIdType count, const std::vector<morph::Index>& kept)
{
  return static_cast<std::size_t>(count) == kept.size() &&
         std::equal(kept.begin(), kept.end(), values,
           [](morph::Index a, Value b) { return a == static_cast<morph::Index>(b); });
}

/// Unknown cells pass the core's checks as poly-vertices; the ids they name are checked all the
/// same.
void validateKnown(morph::Mesh& mesh)
{
  const std::vector<std::uint8_t> types = mesh.types;
  for (std::uint8_t& type : mesh.types)
  {
    if (!morph::cellShape(type))
    {
      type = morph::PolyVertex;
    }
  }
  morph::validate(mesh);
  mesh.types = types;
}
}

namespace GridMesh
{
morph::Mesh FromGrid(vtkUnstructuredGrid* grid, UnknownCells unknown)
{
  morph::Mesh mesh;
  mesh.points = FromPoints(grid->GetPoints());
  mesh.offsets = { 0 };
  if (grid->GetNumberOfCells() > 0)
  {
    const unsigned char* types = grid->GetCellTypesArray()->GetPointer(0);
    mesh.types.assign(types, types + grid->GetNumberOfCells());
    visitOffsets(grid->GetCells(), [&mesh](const auto* values, vtkIdType count)
      { mesh.offsets.assign(values, values + count); });
    visitConnectivity(grid->GetCells(), [&mesh](const auto* values, vtkIdType count)
      { mesh.connectivity.assign(values, values + count); });
  }
  if (unknown == UnknownCells::Keep)
  {
    validateKnown(mesh);
  }
  else
  {
    morph::validate(mesh);
  }
  return mesh;
}

morph::Points FromPoints(vtkPoints* points)
{
  return points ? FromVectors(points->GetData()) : morph::Points(0, 3);
}

morph::Points FromVectors(vtkDataArray* vectors)
{
  const vtkIdType count = vectors->GetNumberOfTuples();
  const int components = vectors->GetNumberOfComponents();
  morph::Points result(count, 3);
  if (auto* doubles = vtkDoubleArray::FastDownCast(vectors); doubles && components == 3)
  {
    std::copy_n(doubles->GetPointer(0), 3 * count, result.data());
  }
  else if (auto* floats = vtkFloatArray::FastDownCast(vectors); floats && components == 3)
  {
    std::copy_n(floats->GetPointer(0), 3 * count, result.data());
  }
  else
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        result(i, j) = vectors->GetComponent(i, j);
      }
    }
  }
  return result;
}

double Size(const morph::Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
    for (morph::Index k = 0; shape && shape->dimension == 3 && k < mesh.cellSize(c); ++k)
    {
      box.extend(mesh.points.row(mesh.cell(c)[k]).transpose());
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

bool SameCells(vtkUnstructuredGrid* grid, const morph::Mesh& mesh)
{
  if (grid->GetNumberOfCells() != mesh.numberOfCells())
  {
    return false;
  }
  if (mesh.numberOfCells() == 0)
  {
    return true;
  }
  if (!std::equal(mesh.types.begin(), mesh.types.end(), grid->GetCellTypesArray()->GetPointer(0)))
  {
    return false;
  }
  bool same = true;
  visitOffsets(grid->GetCells(),
    [&](const auto* values, vtkIdType count) { same = equals(values, count, mesh.offsets); });
  if (same)
  {
    visitConnectivity(grid->GetCells(), [&](const auto* values, vtkIdType count)
      { same = equals(values, count, mesh.connectivity); });
  }
  return same;
}

bool SamePoints(vtkUnstructuredGrid* grid, const morph::Mesh& mesh)
{
  if (grid->GetNumberOfPoints() != mesh.numberOfNodes())
  {
    return false;
  }
  if (mesh.numberOfNodes() == 0)
  {
    return true;
  }
  // Bits, not values: 0.0 and -0.0 are different rest positions to an identical motion.
  const auto same = [&mesh](auto* values)
  {
    const double* kept = mesh.points.data();
    for (morph::Index i = 0; i < mesh.points.size(); ++i)
    {
      const double value = static_cast<double>(values[i]);
      if (bitsOf(value) != bitsOf(kept[i]))
      {
        return false;
      }
    }
    return true;
  };
  vtkDataArray* data = grid->GetPoints()->GetData();
  if (auto* doubles = vtkDoubleArray::FastDownCast(data))
  {
    return same(doubles->GetPointer(0));
  }
  if (auto* floats = vtkFloatArray::FastDownCast(data))
  {
    return same(floats->GetPointer(0));
  }
  return same(FromVectors(data).data());
}
}
}
