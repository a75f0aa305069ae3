// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/CellBatches.h"

#include "Support/Lists.h"

#include <algorithm>
#include <array>

namespace morph
{
namespace
{
constexpr std::array<Shape, 4> Volumes = { Shape::Tet, Shape::Hex, Shape::Wedge, Shape::Pyramid };

/// Returns the minimum row of a volume cell's corners; negative if none is free.
Index minimumRow(const Mesh& mesh, Index cell, const std::vector<std::int32_t>& row)
{
  const CellShape& shape = *cellShape(mesh, cell);
  Index least = -1;
  for (int a = 0; a < numberOfCorners(shape.shape); ++a)
  {
    const Index own = row[mesh.cell(cell)[shape.cornerNode[a]]];
    least = own >= 0 && (least < 0 || own < least) ? own : least;
  }
  return least;
}
}

CellBatches::CellBatches(const Mesh& mesh, const std::vector<Index>& free)
  : CellBatches(mesh, free, consecutive(mesh.numberOfCells()))
{
}

CellBatches::CellBatches(
  const Mesh& mesh, const std::vector<Index>& free, const std::vector<Index>& cells)
{
  const auto rows = static_cast<Index>(free.size());
  const std::vector<std::int32_t> row = inverseIndex(free, mesh.numberOfNodes());
  std::array<Batch, Volumes.size()> open{};
  const auto close = [&](Batch& batch)
  {
    if (batch.cells > 0)
    {
      this->addPlaces(mesh, row, batch);
      this->batches_.push_back(batch);
      batch.cells = 0;
    }
  };
  // In the order of their minimum rows, so that a row's contributions are near in memory.
  const Adjacency order = gatherMap(static_cast<Index>(cells.size()), rows,
    [&](Index i) { return minimumRow(mesh, cells[i], row); });
  for (Index i : order.values)
  {
    const Shape shape = cellShape(mesh.types[cells[i]])->shape;
    Batch& batch = open[std::find(Volumes.begin(), Volumes.end(), shape) - Volumes.begin()];
    batch.shape = shape;
    batch.cell[batch.cells++] = cells[i];
    if (batch.cells == SimdWidth)
    {
      close(batch);
    }
  }
  std::for_each(open.begin(), open.end(), close);
  this->uses_ = gatherMap(this->places(), rows, [this](Index place) { return this->row(place); });
}

void CellBatches::addPlaces(const Mesh& mesh, const std::vector<std::int32_t>& row, Batch& batch)
{
  std::fill(batch.cell + batch.cells, batch.cell + SimdWidth, batch.cell[0]);
  batch.firstPlace = this->places();
  const int corners = numberOfCorners(batch.shape);
  for (int a = 0; a < corners; ++a)
  {
    this->batchOf_.push_back(static_cast<std::int32_t>(this->size()));
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      const Index c = batch.cell[lane];
      const Index node = mesh.cell(c)[cellShape(mesh, c)->cornerNode[a]];
      this->node_.push_back(static_cast<std::int32_t>(node));
      this->row_.push_back(lane < batch.cells ? row[node] : -1);
    }
  }
}

bool CellBatches::moves(Index batch, int lane, const int* corner) const
{
  return std::any_of(corner, corner + 4,
    [&](int a) { return this->row(this->firstPlace(batch) + a * SimdWidth + lane) >= 0; });
}

void CellBatches::setTargets(const TargetMatrices& targets)
{
  this->target_.assign(this->size(), Targets{});
  this->targetCorner_.assign(this->places() / SimdWidth, TargetCorners{});
  for (Index index = 0; index < this->size(); ++index)
  {
    const Batch& batch = this->batches_[index];
    const SimplicialDecomposition parts = simplicialDecomposition(batch.shape);
    TargetCorners* to = this->targetCorner_.data() + batch.firstPlace / SimdWidth;
    for (int lane = 0; lane < batch.cells; ++lane)
    {
      const Index c = batch.cell[lane];
      this->target_[index].factor[lane] = targets.factor[c];
      for (int t = 0; t < parts.count; ++t)
      {
        if (targets.includes(c, t) && this->moves(index, lane, parts.tets[t].corner))
        {
          this->target_[index].included[lane] |= 1ll << t;
        }
      }
      const double* from = targets.corners.data() + 3 * targets.start[c];
      for (int a = 0; a < numberOfCorners(batch.shape); ++a)
      {
        for (int i = 0; i < 3; ++i)
        {
          to[a].x[i][lane] = from[3 * a + i];
        }
      }
    }
  }
}
}
