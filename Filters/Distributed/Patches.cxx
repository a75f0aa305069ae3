// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Patches.h"

#include "Mesh/CellShape.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/InversionFree.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace morph::distributed
{
namespace
{
using Position = std::array<double, 3>;
constexpr std::int64_t None = std::int64_t(1) << 52;

bool isVolume(const Mesh& mesh, Index cell)
{
  const CellShape* shape = cellShape(mesh.types[cell]);
  return shape && shape->dimension == 3;
}

/// A node as it travels to the rank of a patch.
struct PatchNode
{
  std::int64_t patch, id, isMoving;
  Position reference, rest, moved;
};

struct PlacedNode
{
  std::int64_t id;
  Position x;
};

/// The nodes that move, by the label of their patch; None for the others.
class Labels
{
public:
  Labels(const DistributedMesh& mesh, const NodePartition& partition)
    : of(mesh.mesh().numberOfNodes(), None)
    , mesh_(mesh)
    , canMove_(mesh.mesh().numberOfNodes(), 0)
  {
    for (const std::vector<Index>* list : { &partition.free, &partition.higherOrderNodes })
    {
      for (const Index node : *list)
      {
        this->canMove_[node] = 1;
      }
    }
  }

  /// Marks the nodes of the seeds and of so many rings of cells around them.
  void mark(const std::vector<Index>& seeds, int rings)
  {
    const Mesh& mesh = this->mesh_.mesh();
    std::vector<std::int64_t> outside(mesh.numberOfNodes(), 1); // 0: marked
    for (const Index cell : seeds)
    {
      std::for_each(mesh.cell(cell), mesh.cell(cell) + mesh.cellSize(cell),
        [&](Index node) { outside[node] = 0; });
    }
    this->mesh_.halo().minimum(this->mesh_.ranks(), outside);
    for (int ring = 0; ring < rings; ++ring)
    {
      std::vector<std::int64_t> next = outside;
      this->forOwnCells(
        [&](Index cell)
        {
          const Index *first = mesh.cell(cell), *last = first + mesh.cellSize(cell);
          if (std::any_of(first, last, [&](Index node) { return outside[node] == 0; }))
          {
            std::for_each(first, last, [&](Index node) { next[node] = 0; });
          }
        });
      outside.swap(next);
      this->mesh_.halo().minimum(this->mesh_.ranks(), outside);
    }
    for (std::size_t n = 0; n < outside.size(); ++n)
    {
      if (outside[n] == 0 && this->canMove_[n])
      {
        this->of[n] = this->mesh_.nodeId(static_cast<Index>(n));
      }
    }
  }

  /// The label of a cell's patch, None for a cell in no patch.
  std::int64_t ofCell(Index cell) const
  {
    const Mesh& mesh = this->mesh_.mesh();
    std::int64_t label = None;
    for (Index k = 0; k < mesh.cellSize(cell); ++k)
    {
      label = std::min(label, this->of[mesh.cell(cell)[k]]);
    }
    return label;
  }

  /// Gives the nodes of patches that touch one label.
  void join()
  {
    const Mesh& mesh = this->mesh_.mesh();
    for (Index changes = 1; changes > 0;)
    {
      const std::vector<std::int64_t> before = this->of;
      for (bool again = true; again;)
      {
        again = false;
        this->forOwnCells(
          [&](Index cell)
          {
            const std::int64_t label = this->ofCell(cell);
            for (Index k = 0; k < mesh.cellSize(cell); ++k)
            {
              std::int64_t& node = this->of[mesh.cell(cell)[k]];
              if (node != None && node > label)
              {
                node = label;
                again = true;
              }
            }
          });
      }
      this->mesh_.halo().minimum(this->mesh_.ranks(), this->of);
      changes = this->mesh_.ranks().sum(Index(before != this->of));
    }
  }

  template <typename Visit>
  void forOwnCells(const Visit& visit) const
  {
    for (Index c = 0; c < this->mesh_.pieceCells(); ++c)
    {
      if (this->mesh_.isGhost()[c] == 0 && isVolume(this->mesh_.mesh(), c))
      {
        visit(c);
      }
    }
  }

  std::vector<std::int64_t> of;

private:
  const DistributedMesh& mesh_;
  std::vector<char> canMove_;
};

/// One patch, on the rank that repairs it.
struct Patch
{
  std::map<std::int64_t, PatchNode> nodes;                                          ///< by id
  std::map<std::int64_t, std::pair<std::uint8_t, std::vector<std::int64_t>>> cells; ///< by id

  /// Returns the moved nodes.
  std::vector<PlacedNode> repair(Monitor& monitor) const
  {
    const Index count = static_cast<Index>(this->nodes.size());
    Mesh mesh;
    mesh.offsets = { 0 };
    mesh.points.resize(count, 3);
    Points reference(count, 3), moved(count, 3);
    std::vector<Index> prescribed;
    std::map<std::int64_t, Index> local;
    for (const auto& [id, node] : this->nodes)
    {
      const Index n = static_cast<Index>(local.size());
      local[id] = n;
      const auto put = [n](Points& points, const Position& x)
      { points.row(n) << x[0], x[1], x[2]; };
      put(mesh.points, node.rest);
      put(reference, node.reference);
      put(moved, node.moved);
      if (node.isMoving == 0)
      {
        prescribed.push_back(n);
      }
    }
    for (const auto& [id, cell] : this->cells)
    {
      mesh.types.push_back(cell.first);
      for (const std::int64_t node : cell.second)
      {
        mesh.connectivity.push_back(local.at(node));
      }
      mesh.offsets.push_back(static_cast<Index>(mesh.connectivity.size()));
    }
    const NodePartition partition = partitionNodes(mesh, prescribed);
    ProgressRange first(monitor, 0, 0.3), second(monitor, 0.3, 1);
    morph::InversionFree method;
    method.setReference(reference);
    method.prepare(mesh, partition, first);
    method.repair(moved, second);
    std::vector<PlacedNode> result;
    for (const auto& [id, n] : local)
    {
      if (this->nodes.at(id).isMoving != 0)
      {
        result.push_back({ id, { moved(n, 0), moved(n, 1), moved(n, 2) } });
      }
    }
    return result;
  }
};

/// Sends each patch to its rank, which is that of its number among `all` labels in turn.
std::vector<Patch> gatherPatches(const DistributedMesh& mesh, const Points& reference,
  const InvertedBefore& before, const Labels& labels, const std::vector<std::int64_t>& all,
  const Points& moved, double& bytes)
{
  const Ranks& ranks = mesh.ranks();
  std::vector<std::vector<PatchNode>> nodes(ranks.count());
  std::vector<std::vector<std::int64_t>> cells(ranks.count());
  std::set<std::pair<std::int64_t, Index>> sent;
  labels.forOwnCells(
    [&](Index cell)
    {
      const std::int64_t label = labels.ofCell(cell);
      if (label == None || before.positivePlaces(cell))
      {
        return;
      }
      const Index patch = std::lower_bound(all.begin(), all.end(), label) - all.begin();
      const int rank = static_cast<int>(patch % ranks.count());
      std::vector<std::int64_t>& stream = cells[rank];
      stream.insert(stream.end(),
        { patch, mesh.cellId(cell), mesh.mesh().types[cell], mesh.mesh().cellSize(cell) });
      for (Index k = 0; k < mesh.mesh().cellSize(cell); ++k)
      {
        const Index node = mesh.mesh().cell(cell)[k];
        stream.push_back(mesh.nodeId(node));
        if (sent.emplace(patch, node).second)
        {
          const auto row = [node](const Points& points) {
            return Position{ points(node, 0), points(node, 1), points(node, 2) };
          };
          nodes[rank].push_back({ patch, mesh.nodeId(node), labels.of[node] != None, row(reference),
            row(mesh.mesh().points), row(moved) });
        }
      }
    });
  for (int r = 0; r < ranks.count(); ++r)
  {
    bytes += r == ranks.rank() ? 0
                               : static_cast<double>(nodes[r].size() * sizeof(PatchNode) +
                                                     cells[r].size() * sizeof(std::int64_t));
  }
  std::map<std::int64_t, Patch> mine;
  for (const auto& part : ranks.exchange(nodes))
  {
    for (const PatchNode& node : part)
    {
      mine[node.patch].nodes.emplace(node.id, node);
    }
  }
  for (const auto& stream : ranks.exchange(cells))
  {
    for (std::size_t at = 0; at < stream.size();)
    {
      auto& cell = mine[stream[at]].cells[stream[at + 1]];
      cell.first = static_cast<std::uint8_t>(stream[at + 2]);
      const auto first = stream.begin() + static_cast<std::ptrdiff_t>(at) + 4;
      cell.second.assign(first, first + stream[at + 3]);
      at += 4 + static_cast<std::size_t>(stream[at + 3]);
    }
  }
  std::vector<Patch> patches;
  for (auto& patch : mine)
  {
    patches.push_back(std::move(patch.second));
  }
  return patches;
}
}

PatchReport repairPatches(const DistributedMesh& mesh, const Points& reference,
  const NodePartition& partition, const std::vector<Index>& seeds, const InvertedBefore& before,
  const PatchLimits& limits, Points& moved, Monitor& monitor)
{
  const Ranks& ranks = mesh.ranks();
  PatchReport report;
  Labels labels(mesh, partition);
  labels.mark(seeds, limits.rings);
  Index cells = 0;
  labels.forOwnCells([&](Index cell) { cells += labels.ofCell(cell) != None; });
  report.cells = ranks.sum(cells);
  if (report.cells > std::max(limits.few,
                       static_cast<Index>(limits.share * static_cast<double>(mesh.volumeCells()))))
  {
    report.isTooLarge = true;
    return report;
  }
  labels.join();
  std::vector<std::int64_t> all;
  labels.forOwnCells([&](Index cell) { all.push_back(labels.ofCell(cell)); });
  const auto makeUnique = [](std::vector<std::int64_t>& values)
  {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  makeUnique(all);
  if (!all.empty() && all.back() == None)
  {
    all.pop_back();
  }
  all = ranks.gather(all);
  makeUnique(all);
  report.patches = static_cast<Index>(all.size());

  const std::vector<Patch> patches =
    gatherPatches(mesh, reference, before, labels, all, moved, report.bytes);
  std::vector<PlacedNode> placed, unknown;
  ranks.together(
    [&]
    {
      Silent silent(monitor);
      for (const Patch& patch : patches)
      {
        try
        {
          const std::vector<PlacedNode> nodes = patch.repair(silent);
          placed.insert(placed.end(), nodes.begin(), nodes.end());
        }
        catch (const Error& error)
        {
          if (error.kind() == Error::Kind::Cancelled)
          {
            throw;
          }
          ++report.failed;
        }
      }
    });
  if (ranks.count() > 1)
  {
    report.bytes += static_cast<double>(placed.size() * sizeof(PlacedNode));
  }
  for (const PlacedNode& node : mesh.directory().route(placed, unknown))
  {
    const Index n = mesh.nodeOf(node.id);
    if (n >= 0)
    {
      moved.row(n) << node.x[0], node.x[1], node.x[2];
    }
  }
  mesh.halo().update(ranks, moved);
  mesh.copyToDoubles(moved);
  report.failed = ranks.sum(report.failed);
  report.bytes = ranks.sum(report.bytes);
  return report;
}

RepairReport repairInverted(const DistributedMesh& mesh, const Points& reference,
  const NodePartition& partition, const InvertedBefore& before, Points& moved, Monitor& monitor)
{
  const Ranks& ranks = mesh.ranks();
  std::vector<std::uint8_t> skip = mesh.isGhost();
  for (std::size_t c = 0; c < skip.size(); ++c)
  {
    skip[c] |= !isVolume(mesh.mesh(), static_cast<Index>(c));
  }
  std::vector<Index> bad;
  const auto count = [&](const Points& points)
  {
    ranks.together(
      [&]
      {
        monitor.check();
        bad = before.added(points,
          invertedCells(measureQuality(mesh.mesh(), points, mesh.orientation(), skip, monitor)));
      });
    return ranks.sum(static_cast<Index>(bad.size()));
  };
  RepairReport result;
  result.bad = count(moved);
  result.cells = mesh.volumeCells();
  for (const int rings : { 6, 12, 24 })
  {
    if (result.bad == 0)
    {
      break;
    }
    PatchLimits limits;
    limits.rings = rings;
    Points repaired = moved;
    const PatchReport report =
      repairPatches(mesh, reference, partition, bad, before, limits, repaired, monitor);
    if (report.isTooLarge)
    {
      result.tooLarge = report.cells;
      break;
    }
    const std::vector<Index> before = bad;
    const Index left = count(repaired);
    if (left < result.bad)
    {
      moved.swap(repaired);
      result.bad = left;
    }
    else
    {
      bad = before;
    }
  }
  return result;
}
}
