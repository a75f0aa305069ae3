// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <vtkType.h>

#include <vector>

class vtkAbstractArray;
class vtkDataSetAttributes;
class vtkIdList;

/// Arrays of several blocks as arrays of one mesh, and back.
namespace morph::filters::BlockArrays
{
/// The tuples `FromIds` of the arrays of one block go to `ToIds`.
struct Part
{
  vtkDataSetAttributes* From;
  vtkIdList *FromIds, *ToIds;
  bool MayLack = false; ///< without an array, the others keep it
};

/// Fills `to` with arrays of `count` tuples: those that all parts have, with as many components.
/// Numbers that a part may lack, but for global ids, are 0 there. One of several types becomes
/// double. Ghost flags are 0 where a part has none. The first part says which arrays are active.
/// Cost: one pass over the arrays.
void Merge(const std::vector<Part>& parts, vtkIdType count, vtkDataSetAttributes* to);

/// Adds to `to` the tuples `ids` of `array`, under its name. Where an id is -1: 0 for the array
/// `zeros`, NaN in other arrays of floating-point numbers, and -1 in those of integers.
void Spread(vtkAbstractArray* array, const std::vector<morph::Index>& ids, const char* zeros,
  vtkDataSetAttributes* to);
}
