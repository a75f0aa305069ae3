// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockOutput.h"

#include "Private/Blocks/BlockArrays.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Directions.h"
#include "Private/Data/Quality.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace morph::filters::BlockOutput
{
namespace
{
using morph::Index;

constexpr const char* QualityName = "ScaledJacobian";

/// Its points and cells as data that hold points of their own; itself where it does.
vtkSmartPointer<vtkPointSet> withPoints(vtkDataSet* data)
{
  if (auto* set = vtkPointSet::SafeDownCast(data))
  {
    return set;
  }
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    image->GetExtent(extent);
  }
  else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data))
  {
    rectilinear->GetExtent(extent);
  }
  auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetExtent(extent);
  auto points = filters::Arrays::MakePoints(VTK_DOUBLE, data->GetNumberOfPoints());
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    points->SetPoint(i, data->GetPoint(i));
  }
  grid->SetPoints(points);
  grid->GetPointData()->ShallowCopy(data->GetPointData());
  grid->GetCellData()->ShallowCopy(data->GetCellData());
  grid->GetFieldData()->ShallowCopy(data->GetFieldData());
  return grid;
}

void movePoints(vtkPoints* from, const std::vector<Index>& nodes, vtkPointSet* set)
{
  const auto count = static_cast<vtkIdType>(nodes.size());
  auto points = filters::Arrays::MakePoints(from->GetDataType(), count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, nodes[i] < 0 ? set->GetPoint(i) : from->GetPoint(nodes[i]));
  }
  set->SetPoints(points);
  Directions::RemoveNormals(set);
}

bool hasArray(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  return array->GetName() && data->GetAbstractArray(array->GetName()) == array;
}

/// Arrays that `result` has and `before` has not go to the leaf, and the other way round. Returns
/// whether there are new ones.
bool spread(vtkDataSetAttributes* result, vtkDataSetAttributes* before,
  const std::vector<Index>& ids, vtkDataSetAttributes* leaf)
{
  for (int i = 0; i < before->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = before->GetAbstractArray(i);
    if (array && array->GetName() && !result->HasArray(array->GetName()))
    {
      leaf->RemoveArray(array->GetName());
    }
  }
  bool isAny = false;
  for (int i = 0; i < result->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = result->GetAbstractArray(i);
    if (array && array->GetName() && !hasArray(before, array))
    {
      BlockArrays::Spread(array, ids, "MorphDisplacement", leaf);
      isAny = true;
    }
  }
  return isAny;
}

void activate(
  vtkDataSetAttributes* result, vtkDataSetAttributes* before, vtkDataSetAttributes* leaf)
{
  const auto nameOf = [](vtkDataSetAttributes* data, int kind)
  {
    vtkAbstractArray* array = data->GetAbstractAttribute(kind);
    return array && array->GetName() ? std::string(array->GetName()) : std::string();
  };
  for (const int kind : { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS })
  {
    const std::string name = nameOf(result, kind);
    if (name == nameOf(before, kind) && !name.empty())
    {
      continue;
    }
    if (name.empty())
    {
      leaf->SetActiveAttribute(nullptr, kind);
    }
    else if (leaf->HasArray(name.c_str()))
    {
      leaf->SetActiveAttribute(name.c_str(), kind);
    }
  }
}

/// `of`: empty, or the id of each number in `ids`.
void addIds(const std::vector<Index>& ids, const std::vector<Index>& of, const char* name,
  vtkDataSetAttributes* leaf)
{
  leaf->AddArray(Arrays::MakeOf<vtkIdTypeArray>(
    name, ids, [&of](Index id) { return id < 0 || of.empty() ? id : of[id]; }));
}

/// The value of the mesh's worst cell behind each cell of a set; NaN where there is none.
std::vector<double> worstBehind(vtkDataArray* quality, const MergedBlocks::Block& set)
{
  std::vector<double> worst(set.Behind.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < worst.size(); ++i)
  {
    for (const Index cell : set.Behind[i])
    {
      worst[i] = std::fmin(worst[i], quality->GetComponent(cell, 0)); // a NaN loses
    }
  }
  return worst;
}

/// Gives the cells of a set the scaled Jacobian of what is behind each, so that they have a color
/// too.
void writeQualityBehind(const std::vector<double>& values, vtkDataSetAttributes* leaf)
{
  leaf->AddArray(
    Arrays::MakeOf<vtkDoubleArray>(QualityName, values, [](double value) { return value; }));
  leaf->SetActiveScalars(QualityName);
}
}

vtkDataArray* NewQuality(const MergedBlocks& merged, vtkUnstructuredGrid* result)
{
  vtkDataArray* quality = result->GetCellData()->GetArray(QualityName);
  return quality && !hasArray(merged.Grid->GetCellData(), quality) ? quality : nullptr;
}

void Write(const Leaves::Leaf& leaf, const MergedBlocks& merged, std::size_t block,
  vtkUnstructuredGrid* result, const std::vector<double>& behind)
{
  const MergedBlocks::Block& part = merged.All[block];
  vtkSmartPointer<vtkDataSet> data = vtkDataSet::SafeDownCast(leaf.Data);
  vtkUnstructuredGrid* before = merged.Grid;
  const bool isMoved = result->GetPoints() != before->GetPoints();
  if (isMoved)
  {
    const vtkSmartPointer<vtkPointSet> set = withPoints(data);
    movePoints(result->GetPoints(), part.Nodes, set);
    data = set;
  }
  vtkDataArray* quality = NewQuality(merged, result);
  if (isMoved || quality || !behind.empty())
  {
    Quality::Remove(data); // that of an input, which this block alone may have
  }
  bool isNew =
    spread(result->GetPointData(), before->GetPointData(), part.Nodes, data->GetPointData());
  if (part.IsMesh)
  {
    isNew |= spread(result->GetCellData(), before->GetCellData(), part.Cells, data->GetCellData());
  }
  if (isNew)
  {
    activate(result->GetPointData(), before->GetPointData(), data->GetPointData());
    addIds(part.Nodes, merged.NodeIds, "MorphPointId", data->GetPointData());
  }
  if (isNew && part.IsMesh)
  {
    activate(result->GetCellData(), before->GetCellData(), data->GetCellData());
    addIds(part.Cells, merged.CellIds, "MorphCellId", data->GetCellData());
  }
  if (!behind.empty() || (quality && !part.Behind.empty()))
  {
    writeQualityBehind(behind.empty() ? worstBehind(quality, part) : behind, data->GetCellData());
  }
  Leaves::Replace(leaf, data);
}

void WriteFaces(const Leaves::Leaf& leaf, const MergedBlocks& merged, std::size_t block,
  vtkUnstructuredGrid* result)
{
  const MergedBlocks::Block& part = merged.All[block];
  vtkDataArray* owners = result->GetCellData()->GetArray("MorphCellId");
  if (!part.IsMesh || !owners)
  {
    return;
  }
  const vtkSmartPointer<vtkPointSet> points = withPoints(vtkDataSet::SafeDownCast(leaf.Data));
  std::vector<Index> pointOf(result->GetNumberOfPoints(), -1);
  for (std::size_t i = 0; i < part.Nodes.size(); ++i)
  {
    pointOf[part.Nodes[i]] = static_cast<Index>(i);
  }
  vtkNew<vtkUnstructuredGrid> faces;
  faces->SetPoints(points->GetPoints());
  faces->GetPointData()->ShallowCopy(points->GetPointData());
  faces->GetFieldData()->ShallowCopy(points->GetFieldData());
  faces->Allocate(result->GetNumberOfCells());
  std::vector<Index> chosen;
  vtkNew<vtkIdList> corners;
  for (vtkIdType face = 0; face < result->GetNumberOfCells(); ++face)
  {
    const auto owner = static_cast<std::size_t>(owners->GetComponent(face, 0));
    if (merged.BlockOfCell[owner] != static_cast<Index>(block))
    {
      continue;
    }
    result->GetCellPoints(face, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      corners->SetId(i, static_cast<vtkIdType>(pointOf[corners->GetId(i)]));
    }
    faces->InsertNextCell(result->GetCellType(face), corners);
    chosen.push_back(static_cast<Index>(face));
  }
  for (int i = 0; i < result->GetCellData()->GetNumberOfArrays(); ++i)
  {
    BlockArrays::Spread(
      result->GetCellData()->GetAbstractArray(i), chosen, "", faces->GetCellData());
  }
  std::vector<Index> behind;
  for (const Index face : chosen)
  {
    behind.push_back(static_cast<Index>(owners->GetComponent(static_cast<vtkIdType>(face), 0)));
  }
  addIds(behind, merged.CellIds, "MorphCellId", faces->GetCellData());
  if (vtkDataArray* scalars = result->GetCellData()->GetScalars())
  {
    faces->GetCellData()->SetActiveScalars(scalars->GetName());
  }
  Leaves::Replace(leaf, faces);
}
}
