// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/Leaves.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataObjectTree.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>

namespace morph::filters::Leaves
{
namespace
{
struct Child
{
  vtkDataObject* Data;
  vtkInformation* MetaData;
};

/// The children of any of VTK's trees, null ones too.
std::vector<Child> childrenOf(vtkDataObjectTree* tree)
{
  std::vector<Child> children;
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(tree))
  {
    for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
    {
      children.push_back(
        { blocks->GetBlock(i), blocks->HasMetaData(i) ? blocks->GetMetaData(i) : nullptr });
    }
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(tree))
  {
    for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      children.push_back({ collection->GetPartitionedDataSet(i),
        collection->HasMetaData(i) ? collection->GetMetaData(i) : nullptr });
    }
  }
  else if (auto* parts = vtkPartitionedDataSet::SafeDownCast(tree)) // a multi-piece is one, too
  {
    for (unsigned int i = 0; i < parts->GetNumberOfPartitions(); ++i)
    {
      children.push_back({ parts->GetPartitionAsDataObject(i),
        parts->HasMetaData(i) ? parts->GetMetaData(i) : nullptr });
    }
  }
  return children;
}

/// With leading zeros: paths sort as the blocks do.
std::string placeText(std::size_t place)
{
  const std::string digits = std::to_string(place);
  return "/" + std::string(digits.size() < 10 ? 10 - digits.size() : 0, '0') + digits;
}

struct Inner
{
  std::string Name, Label, Path;
};

void add(vtkDataObjectTree* tree, const Inner& node, unsigned int& index, std::vector<Leaf>& leaves)
{
  const bool isPartitions = vtkPartitionedDataSet::SafeDownCast(tree) != nullptr;
  const std::vector<Child> children = childrenOf(tree);
  for (std::size_t i = 0; i < children.size(); ++i)
  {
    const Child& child = children[i];
    ++index;
    const char* given = child.MetaData && child.MetaData->Has(vtkCompositeDataSet::NAME())
                          ? child.MetaData->Get(vtkCompositeDataSet::NAME())
                          : nullptr;
    std::string name = node.Name;
    if (given && *given)
    {
      name += (node.Name.empty() ? "" : "/") + std::string(given);
    }
    const std::string own = given && *given ? given : isPartitions ? node.Label : std::string();
    const std::string path = isPartitions ? node.Path : node.Path + placeText(i);
    if (auto* inner = TreeOf(child.Data))
    {
      add(inner, { name, own, path }, index, leaves);
    }
    else if (child.Data)
    {
      if (name == node.Name && children.size() > 1 && !name.empty())
      {
        name += "/" + std::to_string(i);
      }
      leaves.push_back({ child.Data, index,
        name.empty() ? "Block " + std::to_string(index) : "Block '" + name + "'", tree,
        static_cast<unsigned int>(i), own, path });
    }
  }
}
}

vtkDataObjectTree* TreeOf(vtkDataObject* data)
{
  return data && data->IsA("vtkUniformGridAMR") ? nullptr : vtkDataObjectTree::SafeDownCast(data);
}

std::vector<Leaf> Of(vtkDataObjectTree* tree)
{
  std::vector<Leaf> leaves;
  unsigned int index = 0;
  add(tree, {}, index, leaves);
  return leaves;
}

void Replace(const Leaf& leaf, vtkDataObject* data)
{
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(leaf.Parent))
  {
    blocks->SetBlock(leaf.Place, data);
  }
  else if (auto* parts = vtkPartitionedDataSet::SafeDownCast(leaf.Parent))
  {
    parts->SetPartition(leaf.Place, data);
  }
}

void Copy(vtkDataObjectTree* from, vtkDataObjectTree* to)
{
  to->ShallowCopy(from);
  // Before VTK 9.3 that copy shares the leaves.
  for (const Leaf& leaf : Of(to))
  {
    const auto copy = vtkSmartPointer<vtkDataObject>::Take(leaf.Data->NewInstance());
    copy->ShallowCopy(leaf.Data);
    Replace(leaf, copy);
  }
}
}
