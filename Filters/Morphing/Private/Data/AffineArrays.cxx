// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/AffineArrays.h"

#include "Private/Data/Arrays.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <limits>

namespace morph::filters::AffineArrays
{
void Write(vtkDataArray* fields, const morph::AffineMotion& motion, vtkPointSet* boundary)
{
  boundary->GetPointData()->AddArray(fields);
  auto rows = Arrays::Make<vtkDoubleArray>(MotionName, 3, 4);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      rows->SetTypedComponent(i, j, motion(i, j));
    }
  }
  boundary->GetFieldData()->AddArray(rows);
}

void Remove(vtkPointSet* boundary)
{
  boundary->GetPointData()->RemoveArray(FieldsName);
  boundary->GetFieldData()->RemoveArray(MotionName);
}

double Rounding(double size, bool isFloat)
{
  return 32 * size *
         (isFloat ? double(std::numeric_limits<float>::epsilon())
                  : std::numeric_limits<double>::epsilon());
}

std::optional<Found> Read(vtkPointSet* boundary)
{
  Found found;
  found.Fields = boundary->GetPointData()->GetArray(FieldsName);
  vtkDataArray* rows = boundary->GetFieldData()->GetArray(MotionName);
  if (!found.Fields || !rows || found.Fields->GetNumberOfComponents() != 4 ||
      found.Fields->GetNumberOfTuples() != boundary->GetNumberOfPoints() ||
      rows->GetNumberOfComponents() != 4 || rows->GetNumberOfTuples() != 3)
  {
    return {};
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      found.Motion(i, j) = rows->GetComponent(i, j);
    }
  }
  if (!found.Motion.allFinite())
  {
    return {};
  }
  return found;
}
}
