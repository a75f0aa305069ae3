// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "TestGrids.h"

#include <vtkDataObjectTree.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <map>

class vtkDataSet;
class vtkIdList;

/// Composite data for the tests of filters on MPI ranks.
namespace rank_trees
{
/// These cells with their points and all arrays, of the type of `data`; null without cells.
vtkSmartPointer<vtkDataObject> cellsOf(vtkDataSet* data, vtkIdList* ids);

/// A tree with `leafOf` of each leaf in its place.
vtkSmartPointer<vtkDataObjectTree> withLeaves(vtkDataObjectTree* whole,
  const std::function<vtkSmartPointer<vtkDataObject>(vtkDataObject*)>& leafOf);

/// This rank's part of `whole`: of each leaf the cells that a random partition gives it, with their
/// points and all arrays. Leaves without cells here are null. `ofSets`: the rank that gets the
/// leaves of polygons whole, or -1 for a random partition of these, too.
vtkSmartPointer<vtkDataObjectTree> part(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole, unsigned seed, int ofSets = -1);

/// This rank's part of `whole`: each leaf is whole on one rank, and null on the others.
vtkSmartPointer<vtkDataObjectTree> wholeLeaves(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole);

/// The largest distance on any rank of points from those with the same number in `whole`.
double distance(const morph::distributed::Ranks& ranks, vtkDataObject* mine,
  const std::map<vtkIdType, grids::Row>& whole);
}
