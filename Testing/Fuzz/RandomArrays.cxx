// SPDX-License-Identifier: BSD-3-Clause
#include "RandomGrid.h"

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <limits>

namespace fuzz
{
namespace
{
/// Names that filters look for or write.
constexpr const char* Names[] = { "MorphPointId", "RestPosition", "PointIds", "vtkOriginalPointIds",
  "MorphCellId", "GeometryDimension", "GeometryId", "CurveParameter", "ScaledJacobian",
  "JacobianCertificate", "MorphDisplacement", "MorphGradient", "Gradient", "Displacement",
  "Surface", "Role", "BoundaryDisplacement", "GlobalIds", "vtkGhostType", "Normals", "Temperature",
  "" };

vtkSmartPointer<vtkAbstractArray> arrayOfType(int type)
{
  switch (type)
  {
    case 0:
      return vtkSmartPointer<vtkDoubleArray>::New();
    case 1:
      return vtkSmartPointer<vtkFloatArray>::New();
    case 2:
      return vtkSmartPointer<vtkIdTypeArray>::New();
    case 3:
      return vtkSmartPointer<vtkIntArray>::New();
    case 4:
      return vtkSmartPointer<vtkSignedCharArray>::New();
    case 5:
      return vtkSmartPointer<vtkUnsignedCharArray>::New();
    case 6:
      return vtkSmartPointer<vtkBitArray>::New();
    default:
      return vtkSmartPointer<vtkStringArray>::New();
  }
}

/// Values that the library itself writes are whole numbers of this size, or lengths.
void fill(vtkAbstractArray* array, Random& random, vtkIdType range)
{
  auto* numbers = vtkDataArray::SafeDownCast(array);
  const bool wild = random.happens(0.3);
  const bool floating = array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
  for (vtkIdType i = 0; numbers && i < array->GetNumberOfValues(); ++i)
  {
    double value = random.below(static_cast<int>(range));
    if (floating && wild)
    {
      value = random.happens(0.02)   ? std::numeric_limits<double>::quiet_NaN()
              : random.happens(0.02) ? 1e30
                                     : random.between(-1, 1);
    }
    numbers->SetComponent(i / array->GetNumberOfComponents(),
      static_cast<int>(i % array->GetNumberOfComponents()), value);
  }
}

void addTo(vtkDataSetAttributes* attributes, vtkIdType count, Random random, bool hostile,
  bool& hasOddArrays)
{
  const int arrays = 1 + random.below(3);
  for (int a = 0; a < arrays; ++a)
  {
    const char* name = hostile ? Names[random.below(static_cast<int>(std::size(Names)))]
                               : Names[random.happens(0.5) ? 20 : 8 + random.below(3)];
    auto array = arrayOfType(hostile ? random.below(8) : random.below(2));
    constexpr int components[] = { 1, 1, 3, 3, 2, 4, 9 };
    array->SetNumberOfComponents(components[random.below(hostile ? 7 : 3)]);
    array->SetName(name);
    vtkIdType length = count;
    if (hostile && random.happens(0.5))
    {
      const vtkIdType lengths[] = { 0, 1, count / 2, count - 1, count + 1, 2 * count + 3 };
      length = std::max<vtkIdType>(0, lengths[random.below(6)]);
    }
    array->SetNumberOfTuples(length);
    fill(array, random,
      std::max<vtkIdType>(1, random.happens(0.8) ? std::min<vtkIdType>(count, 100) : 3));
    hasOddArrays = hasOddArrays || hostile;
    // In place of an active array one of another size would be active, of which VTK itself warns.
    attributes->RemoveArray(name);
    attributes->AddArray(array);
    if (hostile && random.happens(0.1))
    {
      attributes->SetActiveAttribute(name, random.below(vtkDataSetAttributes::NUM_ATTRIBUTES));
    }
  }
}

void addGhosts(Choices& choices, vtkDataSetAttributes* attributes, vtkIdType count, Random random)
{
  auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(count);
  const bool blank = choices.chance("ghosts.blank", 0.5);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const unsigned char kind =
      blank ? vtkDataSetAttributes::HIDDENCELL : vtkDataSetAttributes::DUPLICATECELL;
    ghosts->SetValue(i, random.happens(0.2) ? kind : 0);
  }
  attributes->AddArray(ghosts);
}
}

void addArrays(
  Choices& choices, vtkDataSet* data, const std::string& prefix, bool hostile, bool& hasOddArrays)
{
  if (choices.chance(prefix + ".pointArrays", 0.25))
  {
    addTo(data->GetPointData(), data->GetNumberOfPoints(), choices.stream(prefix + ".pointArrays"),
      false, hasOddArrays);
  }
  if (choices.chance(prefix + ".cellArrays", 0.25))
  {
    addTo(data->GetCellData(), data->GetNumberOfCells(), choices.stream(prefix + ".cellArrays"),
      false, hasOddArrays);
  }
  if (hostile && choices.chance(prefix + ".oddPointArrays", 0.2))
  {
    addTo(data->GetPointData(), data->GetNumberOfPoints(),
      choices.stream(prefix + ".oddPointArrays"), true, hasOddArrays);
  }
  if (hostile && choices.chance(prefix + ".oddCellArrays", 0.2))
  {
    addTo(data->GetCellData(), data->GetNumberOfCells(), choices.stream(prefix + ".oddCellArrays"),
      true, hasOddArrays);
  }
  if (choices.chance(prefix + ".ghostCells", 0.05))
  {
    addGhosts(choices, data->GetCellData(), data->GetNumberOfCells(),
      choices.stream(prefix + ".ghostCells"));
  }
  if (choices.chance(prefix + ".ghostPoints", 0.02))
  {
    addGhosts(choices, data->GetPointData(), data->GetNumberOfPoints(),
      choices.stream(prefix + ".ghostPoints"));
  }
  if (hostile && choices.chance(prefix + ".shortGhosts", 0.06))
  {
    Random random = choices.stream(prefix + ".shortGhosts");
    const vtkIdType count = data->GetNumberOfCells();
    addGhosts(choices, data->GetCellData(),
      random.happens(0.8) ? random.below(static_cast<int>(count) + 1) : count + 2, random);
    hasOddArrays = true;
  }
}
}
