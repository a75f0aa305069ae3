// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/Blocks.h"

#include "Private/Blocks/BlockOutput.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Data/Version.h"
#include "Support/Monitor.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <string>
#include <utility>

namespace morph::filters
{
namespace
{
vtkDataObjectTree* treeOf(vtkInformationVector* outputVector)
{
  return vtkDataObjectTree::SafeDownCast(vtkDataObject::GetData(outputVector));
}
}

void Blocks::MakeOutput(vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  auto* tree = Leaves::TreeOf(vtkDataObject::GetData(inputVector[0]));
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  const std::string type = tree ? tree->GetClassName() : "vtkUnstructuredGrid";
  if (!output || output->GetClassName() != type)
  {
    const auto fresh =
      tree ? vtkSmartPointer<vtkDataObject>::Take(tree->NewInstance())
           : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkUnstructuredGrid>::New());
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
}

MergedBlocks::Options Blocks::OptionsOf(int coincident, GridMesh::UnknownCells unknown)
{
  MergedBlocks::Options options;
  options.Merges = coincident != KeepApart;
  options.ByIds = coincident == Merge;
  options.Unknown = unknown;
  return options;
}

Blocks::Key Blocks::KeyOf(
  vtkDataObjectTree* tree, int coincident, GridMesh::UnknownCells unknown, bool areOnRanks)
{
  // Arrays, not data sets: a pipeline makes shallow copies of these.
  Key key = { { nullptr, static_cast<vtkMTimeType>(3 * static_cast<int>(unknown) + coincident) },
    { nullptr, areOnRanks } };
  if (!tree)
  {
    return key;
  }
  const auto add = [&key](vtkObject* object)
  { key.emplace_back(object, object ? object->GetMTime() : 0); };
  const auto addArrays = [&](vtkFieldData* data)
  {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      add(data->GetAbstractArray(i));
    }
  };
  addArrays(tree->GetFieldData());
  for (const Leaves::Leaf& leaf : Leaves::Of(tree))
  {
    key.emplace_back(nullptr, leaf.FlatIndex);
    key.emplace_back(nullptr, std::hash<std::string>{}(leaf.Name + "\n" + leaf.Label));
    auto* set = vtkPointSet::SafeDownCast(leaf.Data);
    auto* grid = vtkUnstructuredGrid::SafeDownCast(set);
    auto* structured = vtkStructuredGrid::SafeDownCast(set);
    if (!grid && !structured)
    {
      add(leaf.Data);
      continue;
    }
    add(set->GetPoints() ? set->GetPoints()->GetData() : nullptr);
    add(set->GetPoints());
    if (grid)
    {
      add(grid->GetCells());
      add(Version::CellTypes(grid));
    }
    else
    {
      int sizes[3];
      structured->GetDimensions(sizes);
      for (const int size : sizes)
      {
        key.emplace_back(nullptr, size);
      }
    }
    for (vtkDataSetAttributes* data : { static_cast<vtkDataSetAttributes*>(set->GetPointData()),
           static_cast<vtkDataSetAttributes*>(set->GetCellData()) })
    {
      addArrays(data);
      add(data->GetGlobalIds());
      add(data->GetScalars());
      add(data->GetVectors());
    }
  }
  return key;
}

vtkDataObject* Blocks::Gather(
  vtkDataObject* input, int coincident, GridMesh::UnknownCells unknown, morph::Monitor& monitor)
{
  this->Input = Leaves::TreeOf(input);
  if (this->Kept.WorstBehind)
  {
    this->Forget(); // what was made together with other processes
  }
  if (!this->Input)
  {
    return input;
  }
  Key key = KeyOf(this->Input, coincident, unknown, false);
  if (!this->Kept.Grid || key != this->MadeFrom)
  {
    this->Kept = {};
    this->Kept = MergedBlocks::Make(this->Input, OptionsOf(coincident, unknown));
    this->MadeFrom = std::move(key);
  }
  return this->Tell(monitor);
}

bool Blocks::IsKept(vtkDataObject* input, int coincident, GridMesh::UnknownCells unknown)
{
  this->Input = Leaves::TreeOf(input);
  this->Asked = KeyOf(this->Input, coincident, unknown, true);
  return this->Kept.Grid && this->Asked == this->MadeFrom;
}

void Blocks::Forget()
{
  this->Kept = {};
}

void Blocks::Keep(MergedBlocks merged)
{
  this->Kept = std::move(merged);
  this->MadeFrom = this->Asked;
}

vtkDataObject* Blocks::Tell(morph::Monitor& monitor) const
{
  for (const std::string& warning : this->Kept.Warnings)
  {
    monitor.warn(warning);
  }
  return this->Kept.Grid;
}

const MergedBlocks* Blocks::Merged() const
{
  return this->Input ? &this->Kept : nullptr;
}

vtkDataObjectTree* Blocks::Tree() const
{
  return this->Input;
}

vtkUnstructuredGrid* Blocks::Output(vtkInformationVector* outputVector)
{
  if (!treeOf(outputVector))
  {
    return vtkUnstructuredGrid::GetData(outputVector);
  }
  if (!this->Scratch)
  {
    this->Scratch = vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  return this->Scratch;
}

void Blocks::Scatter(vtkInformationVector* outputVector)
{
  vtkDataObjectTree* output = treeOf(outputVector);
  if (vtkUnstructuredGrid* grid = this->Output(outputVector))
  {
    this->Plane.Flatten(grid, output != nullptr);
  }
  if (outputVector->GetNumberOfInformationObjects() > 1)
  {
    this->Plane.FlattenCells(vtkUnstructuredGrid::GetData(outputVector, 1));
  }
  const vtkSmartPointer<vtkUnstructuredGrid> result = this->Scratch;
  this->Scratch = nullptr;
  std::vector<std::vector<double>> behind;
  if (this->Kept.WorstBehind) // all processes have one, and have to call it
  {
    behind = this->Kept.WorstBehind(result ? BlockOutput::NewQuality(this->Kept, result) : nullptr);
  }
  if (!output || !result)
  {
    return;
  }
  output->Initialize();
  if (this->Input && this->Kept.Grid &&
      result->GetNumberOfPoints() == this->Kept.Grid->GetNumberOfPoints())
  {
    Leaves::Copy(this->Input, output);
    const std::vector<Leaves::Leaf> leaves = Leaves::Of(output);
    const bool areFaces = result->GetCells() != this->Kept.Grid->GetCells();
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
      if (!this->Kept.All[i].Nodes.empty())
      {
        if (areFaces)
        {
          BlockOutput::WriteFaces(leaves[i], this->Kept, i, result);
          continue;
        }
        BlockOutput::Write(
          leaves[i], this->Kept, i, result, behind.empty() ? std::vector<double>() : behind[i]);
      }
    }
  }
  output->GetFieldData()->ShallowCopy(result->GetFieldData());
}
}
