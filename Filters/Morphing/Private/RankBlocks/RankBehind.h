// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Distributed/SharedPlaces.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"

#include <utility>
#include <vector>

class vtkDataArray;

namespace morph::filters
{
/// The mesh's cells behind the cells of sets, on whatever MPI process they are.
class RankBehind
{
public:
  /// `merged`: with the nodes of all blocks. Collective, as Worst().
  RankBehind(const morph::distributed::Ranks& ranks, const std::vector<Leaves::Leaf>& mine,
    const morph::distributed::SharedPlaces& places, const MergedBlocks& merged);

  /// For each of the leaves the lowest of the values behind each of its cells, NaN where there is
  /// none; empty for leaves that are no sets. All are empty where no process has values.
  /// `values`: of this process's cells, or null.
  std::vector<std::vector<double>> Worst(vtkDataArray* values) const;

private:
  morph::distributed::Ranks Ranks;
  std::vector<vtkIdType> Cells; ///< #leaves: of a set
  /// For each process: the leaf and cell that it is asked about.
  std::vector<std::vector<std::pair<std::size_t, vtkIdType>>> Questions;
  /// For each process: the cells of this one behind each cell that it asks about.
  std::vector<std::vector<std::vector<vtkIdType>>> Answers;
};
}
