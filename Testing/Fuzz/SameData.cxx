// SPDX-License-Identifier: BSD-3-Clause
#include "SameData.h"

#include "Private/Data/Version.h"

#include <vtkBitArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <cstring>

namespace fuzz
{
namespace
{
std::string nameOf(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "(no name)";
}

bool sameValues(vtkAbstractArray* a, vtkAbstractArray* b)
{
  const vtkIdType count = a->GetNumberOfValues();
  auto* numbers = vtkDataArray::SafeDownCast(a);
  if (numbers && !vtkBitArray::SafeDownCast(a))
  {
    const std::size_t bytes = static_cast<std::size_t>(count) * a->GetDataTypeSize();
    return bytes == 0 || std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), bytes) == 0;
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (a->GetVariantValue(i) != b->GetVariantValue(i))
    {
      return false;
    }
  }
  return true;
}

std::string difference(vtkAbstractArray* a, vtkAbstractArray* b)
{
  if (!a || !b)
  {
    return a == b ? "" : "an array is missing";
  }
  const bool same = nameOf(a) == nameOf(b) && a->GetDataType() == b->GetDataType() &&
                    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
                    a->GetNumberOfTuples() == b->GetNumberOfTuples() &&
                    a->GetNumberOfValues() == b->GetNumberOfValues() && sameValues(a, b);
  return same ? "" : "array " + nameOf(a);
}

std::string difference(vtkFieldData* a, vtkFieldData* b, const std::set<std::string>& except)
{
  if (a->GetNumberOfArrays() != b->GetNumberOfArrays())
  {
    return "number of arrays";
  }
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = a->GetAbstractArray(i);
    if (array && except.count(nameOf(array)))
    {
      continue;
    }
    if (const std::string found = difference(array, b->GetAbstractArray(i)); !found.empty())
    {
      return found;
    }
  }
  auto* first = vtkDataSetAttributes::SafeDownCast(a);
  auto* second = vtkDataSetAttributes::SafeDownCast(b);
  for (int i = 0; first && second && i < vtkDataSetAttributes::NUM_ATTRIBUTES; ++i)
  {
    vtkAbstractArray* active = first->GetAbstractAttribute(i);
    vtkAbstractArray* other = second->GetAbstractAttribute(i);
    if (!active != !other || (active && nameOf(active) != nameOf(other)))
    {
      return "active attribute";
    }
  }
  return {};
}

std::string difference(vtkCellArray* a, vtkCellArray* b)
{
  if (!a || !b)
  {
    return a == b ? "" : "cells are missing";
  }
  if (a->GetOffsetsArray()->GetDataTypeSize() != b->GetOffsetsArray()->GetDataTypeSize())
  {
    return "storage of cells";
  }
  const bool same = difference(a->GetOffsetsArray(), b->GetOffsetsArray()).empty() &&
                    difference(a->GetConnectivityArray(), b->GetConnectivityArray()).empty();
  return same ? "" : "cells";
}

std::string difference(vtkPointSet* a, vtkPointSet* b)
{
  vtkPoints* points = a->GetPoints();
  vtkPoints* others = b->GetPoints();
  // No points and an empty list are the same.
  if ((points ? points->GetNumberOfPoints() : 0) != (others ? others->GetNumberOfPoints() : 0))
  {
    return "number of points";
  }
  if (points && others && !difference(points->GetData(), others->GetData()).empty())
  {
    return "points";
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(a);
  if (grid)
  {
    auto* other = vtkUnstructuredGrid::SafeDownCast(b);
    const std::string types = difference(
      morph::filters::Version::CellTypes(grid), morph::filters::Version::CellTypes(other));
    return types.empty() ? difference(grid->GetCells(), other->GetCells()) : "cell types";
  }
  if (auto* surface = vtkPolyData::SafeDownCast(a))
  {
    auto* other = vtkPolyData::SafeDownCast(b);
    for (const std::string& found : { difference(surface->GetVerts(), other->GetVerts()),
           difference(surface->GetLines(), other->GetLines()),
           difference(surface->GetPolys(), other->GetPolys()),
           difference(surface->GetStrips(), other->GetStrips()) })
    {
      if (!found.empty())
      {
        return found;
      }
    }
  }
  return {};
}
}

std::string difference(vtkDataObject* a, vtkDataObject* b, const std::set<std::string>& except)
{
  if (!a || !b)
  {
    return a == b ? "" : "one is null";
  }
  if (std::strcmp(a->GetClassName(), b->GetClassName()) != 0)
  {
    return "type";
  }
  std::string found = difference(a->GetFieldData(), b->GetFieldData(), except);
  for (int kind : { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW })
  {
    vtkFieldData* data = a->GetAttributesAsFieldData(kind);
    vtkFieldData* other = b->GetAttributesAsFieldData(kind);
    if (found.empty() && data && other)
    {
      found = difference(data, other, except);
    }
  }
  if (!found.empty())
  {
    return found;
  }
  if (auto* points = vtkPointSet::SafeDownCast(a))
  {
    return difference(points, vtkPointSet::SafeDownCast(b));
  }
  const std::vector<vtkDataObject*> parts = leaves(a), others = leaves(b);
  if (parts.size() != others.size())
  {
    return "number of blocks";
  }
  for (std::size_t i = 0; found.empty() && vtkCompositeDataSet::SafeDownCast(a) && i < parts.size();
       ++i)
  {
    found = difference(parts[i], others[i], except);
  }
  return found;
}

std::vector<vtkDataObject*> leaves(vtkDataObject* data)
{
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return { data };
  }
  std::vector<vtkDataObject*> result;
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    result.push_back(iterator->GetCurrentDataObject());
  }
  return result;
}

vtkSmartPointer<vtkDataObject> deepCopy(vtkDataObject* data)
{
  if (!data)
  {
    return nullptr;
  }
  auto copy = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
  copy->DeepCopy(data);
  return copy;
}
}
