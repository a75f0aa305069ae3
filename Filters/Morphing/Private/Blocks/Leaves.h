// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkDataObjectTree;

/// The data sets of composite data.
namespace morph::filters::Leaves
{
struct Leaf
{
  vtkDataObject* Data;       ///< of any type, never null
  unsigned int FlatIndex;    ///< as VTK's iterators count: the root is 0
  std::string Name;          ///< for messages: "Block 'fluid'", or "Block 3" by its flat index
  vtkDataObjectTree* Parent; ///< a multi-block or a partitioned data set
  unsigned int Place;        ///< among the parent's children
  std::string Label;         ///< the name that the file gives, of a partition that of all; or empty
  std::string Path;          ///< the places from the root; partitions have that of all of them
};

/// `data` as a tree of blocks, or null where it is none. Levels of adaptive refinement are none:
/// they overlap, though VTK 9.6 derives them from vtkPartitionedDataSetCollection.
vtkDataObjectTree* TreeOf(vtkDataObject* data);

/// The leaves that are not null, in the order of VTK's iterators.
std::vector<Leaf> Of(vtkDataObjectTree* tree);

/// Puts `data` in the leaf's place.
void Replace(const Leaf& leaf, vtkDataObject* data);

/// Makes `to` a copy of `from`, of the same class: structure, names, metadata, field data, and
/// shallow copies of the leaves.
void Copy(vtkDataObjectTree* from, vtkDataObjectTree* to);
}
