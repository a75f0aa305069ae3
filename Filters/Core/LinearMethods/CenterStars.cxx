// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/CenterStars.h"

#include "Mesh/CellShape.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace morph
{
namespace
{
// So many more pairs may be coupled: the vectors of the iteration lose the center, so that a step
// costs no more.
constexpr int MostAdded = 8;
constexpr Index Grain = 4096;

/// A star that is being collected; cells couple all pairs of their nodes.
class Collected
{
public:
  /// Collects the nodes of the cells around `center`. Returns false where they are too many.
  bool collect(const Mesh& mesh, Index center, const Adjacency& around)
  {
    this->nodes_.clear();
    for (const Index* cell = around.begin(center); cell != around.end(center); ++cell)
    {
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      for (int k = 0; k < shape.numberOfCorners; ++k)
      {
        const Index node = mesh.cell(*cell)[shape.cornerNode[k]];
        if (node != center &&
            std::find(this->nodes_.begin(), this->nodes_.end(), node) == this->nodes_.end())
        {
          this->nodes_.push_back(node);
        }
      }
      if (this->nodes_.size() > CenterStars::MostNodes)
      {
        return false;
      }
    }
    std::sort(this->nodes_.begin(), this->nodes_.end());
    return true;
  }

  /// Whether few pairs are coupled through the center alone.
  bool staysSparse(const Mesh& mesh, Index center, const Adjacency& around) const
  {
    std::uint32_t coupled[CenterStars::MostNodes] = {};
    for (const Index* cell = around.begin(center); cell != around.end(center); ++cell)
    {
      const CellShape& shape = *cellShape(mesh.types[*cell]);
      std::uint32_t own = 0;
      for (int k = 0; k < shape.numberOfCorners; ++k)
      {
        const Index node = mesh.cell(*cell)[shape.cornerNode[k]];
        own |= node == center ? 0 : std::uint32_t(1) << this->place(node);
      }
      for (std::size_t a = 0; a < this->nodes_.size(); ++a)
      {
        coupled[a] |= own >> a & 1 ? own : 0;
      }
    }
    int missing = 0;
    for (std::size_t a = 0; a < this->nodes_.size(); ++a)
    {
      for (std::size_t b = 0; b < a; ++b)
      {
        missing += (coupled[a] >> b & 1) == 0;
      }
    }
    return missing <= static_cast<int>(this->nodes_.size()) + MostAdded;
  }

  const std::vector<Index>& nodes() const { return this->nodes_; }

private:
  std::ptrdiff_t place(Index node) const
  {
    return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node) - this->nodes_.begin();
  }

  std::vector<Index> nodes_; ///< ascending
};
}

CenterStars::CenterStars(
  const Mesh& mesh, const std::vector<Index>& free, Index firstCenter, const Adjacency& around)
{
  const auto first = std::lower_bound(free.begin(), free.end(), firstCenter);
  if (first == free.end())
  {
    return;
  }
  this->ofCell_.assign(mesh.numberOfCells(), -1);
  Collected star;
  for (auto center = first; center != free.end(); ++center)
  {
    const auto isTaken = [&](Index cell) { return this->ofCell_[cell] >= 0; };
    if (std::any_of(around.begin(*center), around.end(*center), isTaken) ||
        !star.collect(mesh, *center, around) || !star.staysSparse(mesh, *center, around))
    {
      continue;
    }
    std::for_each(around.begin(*center), around.end(*center),
      [&](Index cell) { this->ofCell_[cell] = static_cast<int>(this->centers_.size()); });
    this->centers_.push_back(*center);
    this->nodes_.add(star.nodes().begin(), star.nodes().end());
  }
  this->weights_.assign(this->nodes_.values.size(), 0);
  if (this->centers_.empty())
  {
    this->ofCell_.clear();
    return;
  }
  const auto places = static_cast<Index>(this->nodes_.values.size());
  this->ofNode_ = gatherMap(
    places, mesh.numberOfNodes(), [&](Index place) { return this->nodes_.values[place]; });
  std::vector<Index> starOf(static_cast<std::size_t>(places));
  for (Index s = 0; s < this->size(); ++s)
  {
    std::fill(
      starOf.begin() + this->nodes_.offsets[s], starOf.begin() + this->nodes_.offsets[s + 1], s);
  }
  std::transform(this->ofNode_.values.begin(), this->ofNode_.values.end(),
    this->ofNode_.values.begin(), [&](Index place) { return starOf[place]; });
}

std::vector<Index> CenterStars::others(const std::vector<Index>& free) const
{
  std::vector<Index> result;
  result.reserve(free.size() - this->centers_.size());
  std::set_difference(free.begin(), free.end(), this->centers_.begin(), this->centers_.end(),
    std::back_inserter(result));
  return result;
}

void CenterStars::assembled(Index nodes, const NodePartition& partition)
{
  // Unlike = {}, this frees a vector.
  std::vector<int>().swap(this->ofCell_);
  this->ofNode_ = Adjacency();
  if (this->centers_.empty())
  {
    return;
  }
  const std::vector<std::int32_t> free = inverseIndex(partition.free, nodes);
  const std::vector<std::int32_t> prescribed = inverseIndex(partition.prescribed, nodes);
  const auto placesOf = [&](const std::vector<Index>& ids)
  {
    std::vector<int> places(ids.size());
    std::transform(ids.begin(), ids.end(), places.begin(),
      [&](Index node) { return free[node] >= 0 ? free[node] : -1 - prescribed[node]; });
    return places;
  };
  this->rowOfCenter_ = placesOf(this->centers_);
  this->places_ = placesOf(this->nodes_.values);
  std::vector<Index>().swap(this->nodes_.values);
  std::vector<Index>().swap(this->centers_);
}

namespace
{
template <typename Columns>
void setCenters(const std::vector<int>& centers, const std::vector<Index>& offsets,
  const std::vector<int>& places, const std::vector<double>& weights, const Columns& prescribed,
  Columns& free, Monitor& monitor)
{
  const Columns& known = free;
  parallel(static_cast<Index>(centers.size()), Grain, monitor,
    [&](Index s)
    {
      auto mean = Eigen::Matrix<double, 1, Columns::ColsAtCompileTime>::Zero().eval();
      for (Index k = offsets[s]; k < offsets[s + 1]; ++k)
      {
        const int at = places[k];
        mean += weights[k] * (at >= 0 ? known.row(at) : prescribed.row(-1 - at));
      }
      free.row(centers[s]) = mean;
    });
}
}

void CenterStars::recover(const Points& prescribed, Points& free, Monitor& monitor) const
{
  setCenters(this->rowOfCenter_, this->nodes_.offsets, this->places_, this->weights_, prescribed,
    free, monitor);
}

void CenterStars::recover(const FourFields& prescribed, FourFields& free, Monitor& monitor) const
{
  setCenters(this->rowOfCenter_, this->nodes_.offsets, this->places_, this->weights_, prescribed,
    free, monitor);
}

void CenterStars::recoverTranspose(Points& free, Points& prescribed) const
{
  for (std::size_t s = 0; s < this->rowOfCenter_.size(); ++s)
  {
    const Eigen::RowVector3d gradient = free.row(this->rowOfCenter_[s]);
    for (Index k = this->nodes_.offsets[s]; k < this->nodes_.offsets[s + 1]; ++k)
    {
      const int at = this->places_[k];
      auto row = at >= 0 ? free.row(at) : prescribed.row(-1 - at);
      row += this->weights_[k] * gradient;
    }
  }
}
}
