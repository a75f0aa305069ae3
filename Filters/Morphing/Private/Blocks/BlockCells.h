// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/GridMesh.h"

#include <vtkType.h>

#include <string>
#include <vector>

class vtkDataSet;
class vtkDataSetAttributes;

/// One block of composite data, read.
namespace morph::filters::BlockCells
{
/// The highest dimension of the block's cells, -1 where it has none. Cost: one pass over the types.
int Dimension(vtkDataSet* block);

/// Points and cells of a data set of any type: cells of structured data are hexahedra or voxels,
/// hidden ones empty cells. Throws morph::Error that begins with `name` for arrays that are too
/// short, cells that name points that do not exist, and coordinates that are not finite. With
/// `unknown` Refuse, also for cells of types that cannot be morphed.
morph::Mesh Read(vtkDataSet* block, const std::string& name, GridMesh::UnknownCells unknown);

/// The points alone, #points x 3.
morph::Points ReadPoints(vtkDataSet* block);

/// The active global ids, whole numbers from 0 on; empty where there are none, or where one is
/// negative.
std::vector<morph::Index> GlobalIds(vtkDataSetAttributes* attributes, vtkIdType count);
}
