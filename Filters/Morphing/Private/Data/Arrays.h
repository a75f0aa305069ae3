// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAbstractArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

namespace morph::filters::Arrays
{
/// An array of that name. Its values are not set.
template <typename Array>
vtkSmartPointer<Array> Make(const char* name, vtkIdType tuples = 0, int components = 1)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// Adds an array in place of one of its name, which may have been active: as tensors, say. An array
/// with another number of components is not active then.
inline void Add(vtkAbstractArray* array, vtkDataSetAttributes* to)
{
  vtkAbstractArray* before = to->GetAbstractArray(array->GetName());
  if (before && before->GetNumberOfComponents() != array->GetNumberOfComponents())
  {
    to->RemoveArray(array->GetName());
  }
  to->AddArray(array);
}

/// Points of that data type. Their coordinates are not set.
inline vtkSmartPointer<vtkPoints> MakePoints(int type, vtkIdType count = 0)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  points->SetNumberOfPoints(count);
  return points;
}

/// An array of that name, which has `of` each of a container's elements.
template <typename Array, typename Elements, typename Of>
vtkSmartPointer<Array> MakeOf(const char* name, const Elements& elements, const Of& of)
{
  auto array = Make<Array>(name, static_cast<vtkIdType>(elements.size()));
  vtkIdType next = 0;
  for (const auto& element : elements)
  {
    array->SetValue(next++, of(element));
  }
  return array;
}
}
