// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/GridMesh.h"

#include "Mesh/CollapsedCells.h"
#include "Mesh/Polyhedra.h"
#include "Private/Data/Version.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace morph::filters
{
namespace
{
/// Compares bits, so that 0.0 and -0.0 differ.
std::uint64_t bitsOf(double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Calls visit(values, count) with the array's values in memory, 64 or 32 bits wide. Arrays of
/// other classes are copied: since VTK 9.6 offsets may be a formula and ids any array.
template <typename Visitor>
void visitIntegers(vtkDataArray* array, Visitor&& visit)
{
  if (auto* wide = vtkAOSDataArrayTemplate<vtkTypeInt64>::FastDownCast(array))
  {
    visit(wide->GetPointer(0), wide->GetNumberOfValues());
  }
  else if (auto* narrow = vtkAOSDataArrayTemplate<vtkTypeInt32>::FastDownCast(array))
  {
    visit(narrow->GetPointer(0), narrow->GetNumberOfValues());
  }
  else
  {
    vtkNew<vtkTypeInt64Array> copy;
    copy->DeepCopy(array);
    visit(copy->GetPointer(0), copy->GetNumberOfValues());
  }
}

std::vector<std::uint8_t> typesOf(vtkUnstructuredGrid* grid)
{
  std::vector<std::uint8_t> types(grid->GetNumberOfCells());
  vtkDataArray* array = Version::CellTypes(grid);
  if (auto* bytes = vtkUnsignedCharArray::FastDownCast(array))
  {
    std::copy_n(bytes->GetPointer(0), types.size(), types.data());
    return types;
  }
  for (std::size_t c = 0; c < types.size(); ++c)
  {
    types[c] = static_cast<std::uint8_t>(array->GetComponent(static_cast<vtkIdType>(c), 0));
  }
  return types;
}

template <typename Value>
bool equals(const Value* values, vtkIdType count, const std::vector<morph::Index>& kept)
{
  return static_cast<std::size_t>(count) == kept.size() &&
         std::equal(kept.begin(), kept.end(), values,
           [](morph::Index a, Value b) { return a == static_cast<morph::Index>(b); });
}

template <typename Value>
void copyIntegers(
  const Value* values, vtkIdType count, std::vector<morph::Index>& to, morph::Monitor& monitor)
{
  constexpr morph::Index Grain = 1 << 16;
  to.resize(count);
  monitor.parallelFor(count, Grain,
    [&](morph::Index first, morph::Index last)
    { std::copy(values + first, values + last, to.begin() + first); });
}

/// Copies cells without the faces of polyhedra.
void readCells(vtkUnstructuredGrid* grid, morph::Mesh& mesh, morph::Monitor& monitor)
{
  if (grid->GetNumberOfCells() > 0)
  {
    mesh.types = typesOf(grid);
    visitIntegers(grid->GetCells()->GetOffsetsArray(), [&](const auto* values, vtkIdType count)
      { copyIntegers(values, count, mesh.offsets, monitor); });
    visitIntegers(grid->GetCells()->GetConnectivityArray(), [&](const auto* values, vtkIdType count)
      { copyIntegers(values, count, mesh.connectivity, monitor); });
  }
}

/// Copies the faces of polyhedra. Returns those whose faces the grid does not hold.
std::vector<morph::Index> readFaces(vtkUnstructuredGrid* grid, morph::Mesh& mesh)
{
  std::vector<morph::Index> missing;
  const morph::Index cells = mesh.numberOfCells();
  if (std::find(mesh.types.begin(), mesh.types.end(), morph::Polyhedron) == mesh.types.end())
  {
    return missing;
  }
  const bool isReadable = Version::AreFacesReadable(grid);
  mesh.faceOffsets.assign(1, 0);
  for (morph::Index c = 0; c < cells; ++c)
  {
    if (mesh.types[c] == morph::Polyhedron &&
        (!isReadable || !Version::AppendFaces(grid, c, mesh.faces)))
    {
      missing.push_back(c);
      mesh.faces.resize(mesh.faceOffsets.back());
    }
    mesh.faceOffsets.push_back(static_cast<morph::Index>(mesh.faces.size()));
  }
  return missing;
}

/// Whether the nodes of the grid's cells are those of `mesh`.
bool haveNodes(vtkUnstructuredGrid* grid, const morph::Mesh& mesh)
{
  bool same = true;
  for (const auto& [array, kept] : { std::pair(grid->GetCells()->GetOffsetsArray(), &mesh.offsets),
         std::pair(grid->GetCells()->GetConnectivityArray(), &mesh.connectivity) })
  {
    const std::vector<morph::Index>& own = *kept;
    if (same)
    {
      visitIntegers(
        array, [&](const auto* values, vtkIdType count) { same = equals(values, count, own); });
    }
  }
  return same;
}

constexpr const char* LayerName = "MorphShellLayer";

/// Unknown cells pass the core's checks as poly-vertices; their node ids are still checked.
void validateKnown(morph::Mesh& mesh)
{
  const std::vector<std::uint8_t> types = mesh.types;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!morph::cellShape(mesh, c))
    {
      mesh.types[c] = morph::PolyVertex;
    }
  }
  morph::validate(mesh);
  mesh.types = types;
}

bool sameCells(const morph::Mesh& a, const morph::Mesh& b)
{
  return a.types == b.types && a.offsets == b.offsets && a.connectivity == b.connectivity &&
         a.faceOffsets == b.faceOffsets && a.faces == b.faces;
}
}

namespace GridMesh
{
morph::Mesh FromGrid(vtkUnstructuredGrid* grid, UnknownCells unknown)
{
  morph::Monitor serial;
  return FromGrid(grid, unknown, serial);
}

morph::Mesh FromGrid(vtkUnstructuredGrid* grid, UnknownCells unknown, morph::Monitor& monitor)
{
  morph::Mesh mesh;
  mesh.points = FromPoints(grid->GetPoints());
  readCells(grid, mesh, monitor);
  const std::vector<morph::Index> withoutFaces = readFaces(grid, mesh);
  if (!withoutFaces.empty())
  {
    throw morph::Error("Polyhedra whose faces the grid does not hold: cell ids " +
                       morph::listIds(withoutFaces) + ". Write the grid's faces again.");
  }
  if (unknown == UnknownCells::Keep)
  {
    validateKnown(mesh);
  }
  else
  {
    morph::validate(mesh);
  }
  morph::recognizeCells(mesh, monitor);
  mesh.layer = LayerOf(grid);
  return mesh;
}

morph::ShellLayer LayerOf(vtkUnstructuredGrid* grid)
{
  vtkDataArray* mark = grid->GetFieldData()->GetArray(LayerName);
  if (!mark || mark->GetNumberOfValues() != 6)
  {
    return {};
  }
  const auto nodes = static_cast<morph::Index>(mark->GetComponent(0, 0));
  if (2 * nodes > grid->GetNumberOfPoints())
  {
    return {}; // a part of the layer
  }
  return { nodes, mark->GetComponent(1, 0),
    { mark->GetComponent(2, 0), mark->GetComponent(3, 0), mark->GetComponent(4, 0) } };
}

morph::Index PointsOfFront(vtkUnstructuredGrid* grid)
{
  vtkDataArray* mark = grid->GetFieldData()->GetArray(LayerName);
  return mark && mark->GetNumberOfValues() == 6
           ? static_cast<morph::Index>(mark->GetComponent(5, 0))
           : static_cast<morph::Index>(grid->GetNumberOfPoints());
}

void MarkLayer(const morph::ShellLayer& layer, morph::Index points, vtkUnstructuredGrid* grid)
{
  grid->GetFieldData()->RemoveArray(LayerName);
  if (layer.nodes > 0)
  {
    vtkNew<vtkDoubleArray> mark;
    mark->SetName(LayerName);
    mark->InsertNextValue(static_cast<double>(layer.nodes));
    mark->InsertNextValue(layer.thickness);
    for (const double component : layer.normal)
    {
      mark->InsertNextValue(component);
    }
    mark->InsertNextValue(static_cast<double>(points));
    grid->GetFieldData()->AddArray(mark);
  }
}

morph::Points FromPoints(vtkPoints* points)
{
  return points ? FromVectors(points->GetData()) : morph::Points(0, 3);
}

morph::Points FromVectors(vtkDataArray* vectors)
{
  const vtkIdType count = vectors->GetNumberOfTuples();
  const int components = vectors->GetNumberOfComponents();
  morph::Points result;
  result.resize(count, 3);
  if (auto* doubles = vtkDoubleArray::FastDownCast(vectors); doubles && components >= 3)
  {
    using Stride = Eigen::OuterStride<>;
    result = Eigen::Map<const morph::Points, 0, Stride>(
      doubles->GetPointer(0), count, 3, Stride(components));
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

int Dimension(std::uint8_t type)
{
  if (const morph::CellShape* shape = morph::cellShape(type))
  {
    return shape->dimension;
  }
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  return cell ? cell->GetCellDimension() : 0;
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
  if (!morph::hasPolyhedra(mesh) && typesOf(grid) == mesh.types)
  {
    return haveNodes(grid, mesh);
  }
  // FromGrid() has replaced cells, or may have turned faces.
  morph::Monitor serial;
  morph::Mesh read;
  read.points = FromPoints(grid->GetPoints());
  readCells(grid, read, serial);
  if (!readFaces(grid, read).empty() || read.numberOfNodes() != mesh.numberOfNodes())
  {
    return false;
  }
  if (sameCells(read, mesh))
  {
    return true;
  }
  try
  {
    validateKnown(read);
  }
  catch (const morph::Error&)
  {
    return false; // it is told where the grid is copied
  }
  morph::recognizeCells(read, serial);
  return sameCells(read, mesh);
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
  // Bits, not values: 0.0 and -0.0 are different undeformed positions to an identical motion.
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
