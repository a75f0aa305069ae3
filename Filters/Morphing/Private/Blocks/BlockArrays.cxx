// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockArrays.h"

#include "Private/Data/Arrays.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace morph::filters::BlockArrays
{
namespace
{
bool isGhosts(vtkAbstractArray* array)
{
  return std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0;
}

/// The type of an array that takes the values of that name from all parts, or -1 where there can be
/// none.
int commonType(const std::vector<Part>& parts, vtkAbstractArray* first)
{
  int type = first->GetDataType();
  for (const Part& part : parts)
  {
    vtkAbstractArray* array = part.From->GetAbstractArray(first->GetName());
    if (!array && part.MayLack && first != parts.front().From->GetGlobalIds())
    {
      continue;
    }
    if (!array || array->GetNumberOfComponents() != first->GetNumberOfComponents())
    {
      return -1;
    }
    if (array->GetDataType() != type)
    {
      const bool areNumbers =
        vtkDataArray::SafeDownCast(array) && vtkDataArray::SafeDownCast(first);
      if (!areNumbers)
      {
        return -1;
      }
      type = VTK_DOUBLE;
    }
  }
  return type;
}

void copyTuples(vtkAbstractArray* from, const Part& part, vtkAbstractArray* to)
{
  if (from->GetDataType() == to->GetDataType())
  {
    to->InsertTuples(part.ToIds, part.FromIds, from);
    return;
  }
  auto* numbers = vtkDataArray::SafeDownCast(from);
  auto* result = vtkDataArray::SafeDownCast(to);
  for (vtkIdType i = 0; i < part.ToIds->GetNumberOfIds(); ++i)
  {
    for (int j = 0; j < to->GetNumberOfComponents(); ++j)
    {
      result->SetComponent(
        part.ToIds->GetId(i), j, numbers->GetComponent(part.FromIds->GetId(i), j));
    }
  }
}

vtkSmartPointer<vtkAbstractArray> makeLike(vtkAbstractArray* array, int type, vtkIdType count)
{
  auto result = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  if (result)
  {
    result->SetName(array->GetName());
    result->SetNumberOfComponents(array->GetNumberOfComponents());
    result->CopyComponentNames(array);
    result->SetNumberOfTuples(count);
  }
  return result;
}

/// Ghost flags of all parts, where any has them.
void mergeGhosts(const std::vector<Part>& parts, vtkIdType count, vtkDataSetAttributes* to)
{
  const char* name = vtkDataSetAttributes::GhostArrayName();
  vtkSmartPointer<vtkUnsignedCharArray> ghosts;
  for (const Part& part : parts)
  {
    auto* flags = vtkUnsignedCharArray::SafeDownCast(part.From->GetAbstractArray(name));
    if (!flags || flags->GetNumberOfComponents() != 1)
    {
      continue;
    }
    if (!ghosts)
    {
      ghosts = Arrays::Make<vtkUnsignedCharArray>(name, count);
      ghosts->FillValue(0);
    }
    copyTuples(flags, part, ghosts);
  }
  if (ghosts)
  {
    to->AddArray(ghosts);
  }
}
}

void Merge(const std::vector<Part>& parts, vtkIdType count, vtkDataSetAttributes* to)
{
  if (parts.empty())
  {
    return;
  }
  vtkDataSetAttributes* first = parts.front().From;
  for (int i = 0; i < first->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = first->GetAbstractArray(i);
    if (!array || !array->GetName() || isGhosts(array))
    {
      continue;
    }
    const int type = commonType(parts, array);
    const auto merged = type < 0 ? nullptr : makeLike(array, type, count);
    if (!merged)
    {
      continue;
    }
    auto* numbers = vtkDataArray::SafeDownCast(merged);
    const bool isEverywhere = std::all_of(parts.begin(), parts.end(),
      [&](const Part& part) { return part.From->HasArray(array->GetName()) != 0; });
    if (numbers && !isEverywhere)
    {
      numbers->Fill(0);
    }
    for (const Part& part : parts)
    {
      if (vtkAbstractArray* from = part.From->GetAbstractArray(array->GetName()))
      {
        copyTuples(from, part, merged);
      }
    }
    to->AddArray(merged);
  }
  mergeGhosts(parts, count, to);
  for (int kind = 0; kind < vtkDataSetAttributes::NUM_ATTRIBUTES; ++kind)
  {
    vtkAbstractArray* active = first->GetAbstractAttribute(kind);
    if (active && active->GetName() && to->HasArray(active->GetName()))
    {
      to->SetActiveAttribute(active->GetName(), kind);
    }
  }
}

void Spread(vtkAbstractArray* array, const std::vector<morph::Index>& ids, const char* zeros,
  vtkDataSetAttributes* to)
{
  const auto count = static_cast<vtkIdType>(ids.size());
  const auto spread = makeLike(array, array->GetDataType(), count);
  if (!spread)
  {
    return;
  }
  vtkNew<vtkIdList> fromIds, toIds;
  fromIds->Allocate(count);
  toIds->Allocate(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (ids[i] >= 0)
    {
      fromIds->InsertNextId(ids[i]);
      toIds->InsertNextId(i);
    }
  }
  auto* numbers = vtkDataArray::SafeDownCast(spread);
  if (numbers && fromIds->GetNumberOfIds() < count)
  {
    const bool isReal = numbers->GetDataType() == VTK_DOUBLE || numbers->GetDataType() == VTK_FLOAT;
    numbers->Fill(array->GetName() == std::string(zeros) ? 0 : isReal ? vtkMath::Nan() : -1);
  }
  spread->InsertTuples(toIds, fromIds, array);
  to->AddArray(spread);
}
}
