// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

class vtkDataObjectTree;
class vtkPolyData;

namespace morph::filters
{
struct MergedBlocks;

/// Composite data on another port than the mesh's.
namespace BlockPoints
{
/// Returns points without cells, with the point arrays that all blocks have. If `data` have the
/// blocks of `mesh`, as a moved copy of it has, these are its nodes in their order. The array
/// MorphPointId is left out then, since it names interior nodes, too. Else they are the points of
/// the blocks, one after another. `mesh`: may be null. `agreeing`: a point array that has to be
/// equal at the points of one node, or null. Throws morph::Error that begins with `subject` for
/// data that DataCheck::Require() refuses. In the first case also where the points of one node are
/// farther apart than 1e-6 of the size.
vtkSmartPointer<vtkPolyData> Make(vtkDataObjectTree* data, const MergedBlocks* mesh,
  const char* subject, const char* agreeing = nullptr);
}
}
