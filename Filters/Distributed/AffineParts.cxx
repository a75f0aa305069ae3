// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AffineParts.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

namespace morph::distributed
{
namespace
{
/// Sums fixed-size matrices, one a component, over the ranks.
template <typename Matrix>
void sumAll(const Ranks& ranks, std::vector<Matrix>& values)
{
  std::vector<double> flat;
  for (const Matrix& value : values)
  {
    flat.insert(flat.end(), value.data(), value.data() + value.size());
  }
  ranks.sum(flat.data(), flat.size());
  const double* next = flat.data();
  for (Matrix& value : values)
  {
    std::copy_n(next, value.size(), value.data());
    next += value.size();
  }
}
}

AffineParts::AffineParts(const DistributedMesh& mesh, const std::vector<Index>& rows,
  const CsrMatrix& interior, const CsrMatrix& coupling, const std::vector<Index>& prescribed,
  const std::vector<Index>& ghosts)
  : prescribed_(prescribed)
{
  this->number(mesh, rows, interior, coupling, ghosts, static_cast<Index>(prescribed.size()));
  this->couple(mesh, coupling);
  const Points& rest = mesh.mesh().points;
  std::vector<Eigen::RowVector3d> sums(this->count_.size(), Eigen::RowVector3d::Zero());
  for (const Coupled& pair : this->coupled_)
  {
    this->count_[pair.component] += 1;
    sums[pair.component] += rest.row(prescribed[pair.node]);
  }
  mesh.ranks().sum(this->count_.data(), this->count_.size());
  sumAll(mesh.ranks(), sums);
  this->center_ = sums;
  for (std::size_t c = 0; c < sums.size(); ++c)
  {
    this->center_[c] /= std::max(1., this->count_[c]);
  }
  std::vector<Eigen::Matrix3d> spread(sums.size(), Eigen::Matrix3d::Zero());
  for (const Coupled& pair : this->coupled_)
  {
    const Eigen::RowVector3d arm = rest.row(prescribed[pair.node]) - this->center_[pair.component];
    spread[pair.component] += arm.transpose() * arm;
  }
  sumAll(mesh.ranks(), spread);
  std::vector<PrincipalDirections> directions;
  for (std::size_t c = 0; c < spread.size(); ++c)
  {
    directions.emplace_back(spread[c], this->count_[c]);
  }
  // Of each component, the largest leverages of its coupled nodes, and those of its rows.
  std::vector<double> largest(6 * spread.size(), 0);
  const auto add = [&](Index node, Index c, Index first)
  {
    Eigen::Map<Eigen::RowVector3d> most(largest.data() + 6 * c + first);
    most = most.cwiseMax(directions[c].leverages(rest.row(node) - this->center_[c]));
  };
  for (const Coupled& pair : this->coupled_)
  {
    add(prescribed[pair.node], pair.component, 0);
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    add(rows[i], this->ofRow_[i], 3);
  }
  mesh.ranks().maximum(largest.data(), largest.size());
  for (std::size_t c = 0; c < spread.size(); ++c)
  {
    const Eigen::Map<const Eigen::RowVector3d> within(largest.data() + 6 * c),
      reach(within.data() + 3);
    directions[c].limit(within, reach);
    this->inverse_.push_back(directions[c].inverse());
  }
}

/// Numbers the components: the label of one is the minimum id of its nodes.
void AffineParts::number(const DistributedMesh& mesh, const std::vector<Index>& rows,
  const CsrMatrix& interior, const CsrMatrix& coupling, const std::vector<Index>& ghosts,
  Index prescribed)
{
  const Ranks& ranks = mesh.ranks();
  constexpr std::int64_t None = std::int64_t(1) << 52;
  std::vector<std::int64_t> label(mesh.mesh().numberOfNodes(), None);
  for (const std::vector<Index>* list : { &rows, &ghosts })
  {
    for (const Index node : *list)
    {
      label[node] = mesh.nodeId(node);
    }
  }
  for (Index changes = 1; changes > 0;)
  {
    changes = 0;
    for (Index here = 1; here > 0; changes += here)
    {
      here = 0;
      for (Index i = 0; i < interior.rows(); ++i)
      {
        const auto join = [&](Index other)
        {
          std::int64_t &a = label[rows[i]], &b = label[other];
          here += a != b;
          a = b = std::min(a, b);
        };
        for (CsrMatrix::InnerIterator entry(interior, static_cast<int>(i)); entry; ++entry)
        {
          join(rows[entry.col()]);
        }
        for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
        {
          if (entry.col() >= prescribed)
          {
            join(ghosts[entry.col() - prescribed]);
          }
        }
      }
    }
    const std::vector<std::int64_t> before = label;
    mesh.halo().minimum(ranks, label);
    changes = ranks.sum(changes + Index(before != label));
  }
  std::vector<std::int64_t> labels;
  for (const Index node : rows)
  {
    labels.push_back(label[node]);
  }
  const auto makeUnique = [](std::vector<std::int64_t>& values)
  {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  makeUnique(labels);
  labels = ranks.gather(labels);
  makeUnique(labels);
  for (const Index node : rows)
  {
    this->ofRow_.push_back(
      std::lower_bound(labels.begin(), labels.end(), label[node]) - labels.begin());
  }
  this->count_.assign(labels.size(), 0);
}

/// Tells each prescribed node's owner which components are coupled with it.
void AffineParts::couple(const DistributedMesh& mesh, const CsrMatrix& coupling)
{
  struct Pair
  {
    std::int64_t id, component;
    bool operator<(const Pair& other) const
    {
      return std::tie(id, component) < std::tie(other.id, other.component);
    }
    bool operator==(const Pair& other) const
    {
      return id == other.id && component == other.component;
    }
  };
  const auto makeUnique = [](std::vector<Pair>& pairs)
  {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  };
  const Index count = static_cast<Index>(this->prescribed_.size());
  std::vector<Pair> pairs;
  for (Index i = 0; i < coupling.rows(); ++i)
  {
    for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
    {
      if (entry.col() < count)
      {
        pairs.push_back({ mesh.nodeId(this->prescribed_[entry.col()]), this->ofRow_[i] });
      }
    }
  }
  makeUnique(pairs);
  std::vector<std::vector<Pair>> to(mesh.ranks().count());
  std::vector<std::pair<std::int64_t, Index>> rowOf;
  for (Index k = 0; k < count; ++k)
  {
    rowOf.emplace_back(mesh.nodeId(this->prescribed_[k]), k);
  }
  std::sort(rowOf.begin(), rowOf.end());
  const auto find = [&](std::int64_t id)
  { return std::lower_bound(rowOf.begin(), rowOf.end(), std::pair(id, Index(-1)))->second; };
  for (const Pair& pair : pairs)
  {
    to[mesh.owner(this->prescribed_[find(pair.id)])].push_back(pair);
  }
  std::vector<Pair> mine;
  for (const std::vector<Pair>& part : mesh.ranks().exchange(to))
  {
    mine.insert(mine.end(), part.begin(), part.end());
  }
  makeUnique(mine);
  for (const Pair& pair : mine)
  {
    this->coupled_.push_back({ pair.component, find(pair.id) });
  }
}

std::vector<AffineFit> AffineParts::fits(
  const DistributedMesh& mesh, const Points& prescribed) const
{
  const Points& rest = mesh.mesh().points;
  std::vector<Eigen::RowVector3d> mean(this->count_.size(), Eigen::RowVector3d::Zero());
  for (const Coupled& pair : this->coupled_)
  {
    mean[pair.component] += prescribed.row(pair.node);
  }
  sumAll(mesh.ranks(), mean);
  for (std::size_t c = 0; c < mean.size(); ++c)
  {
    mean[c] /= std::max(1., this->count_[c]);
  }
  std::vector<Eigen::Matrix3d> stretch(this->count_.size(), Eigen::Matrix3d::Zero());
  for (const Coupled& pair : this->coupled_)
  {
    stretch[pair.component] +=
      (rest.row(this->prescribed_[pair.node]) - this->center_[pair.component]).transpose() *
      (prescribed.row(pair.node) - mean[pair.component]);
  }
  sumAll(mesh.ranks(), stretch);
  std::vector<AffineFit> result;
  for (std::size_t c = 0; c < mean.size(); ++c)
  {
    result.emplace_back(this->center_[c], mean[c], this->inverse_[c], stretch[c]);
  }
  return result;
}

void AffineParts::addTranspose(
  const DistributedMesh& mesh, std::vector<Load> loads, Points& prescribed) const
{
  std::vector<Eigen::RowVector3d> force;
  std::vector<Eigen::Matrix3d> moment;
  for (const Load& load : loads)
  {
    force.push_back(load.force);
    moment.push_back(load.moment);
  }
  sumAll(mesh.ranks(), force);
  sumAll(mesh.ranks(), moment);
  for (std::size_t c = 0; c < moment.size(); ++c)
  {
    moment[c] = this->inverse_[c] * moment[c];
  }
  for (const Coupled& pair : this->coupled_)
  {
    const Index c = pair.component;
    prescribed.row(pair.node) +=
      force[c] / this->count_[c] +
      (mesh.mesh().points.row(this->prescribed_[pair.node]) - this->center_[c]) * moment[c];
  }
}
}
