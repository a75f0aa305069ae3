// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher.h"

#include "Error.h"

namespace morph
{
namespace
{
constexpr Index Grain = 4096;

void requireRows(const char* what, Index rows, Index expected)
{
  if (rows != expected)
  {
    throw Error(std::string(what) + " has " + std::to_string(rows) + " rows where " +
                std::to_string(expected) + " are expected.");
  }
}

Points rowsOf(const Points& all, const std::vector<Index>& ids)
{
  Points some(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    some.row(static_cast<Index>(i)) = all.row(ids[i]);
  }
  return some;
}
/// Leaves a coordinate that does not move bit for bit: -0.0 + 0.0 would be 0.0.
template <typename Row, typename Displacement>
void moveBy(Row&& position, const Displacement& displacement)
{
  for (int j = 0; j < 3; ++j)
  {
    if (displacement[j] != 0)
    {
      position[j] += displacement[j];
    }
  }
}
}

Morpher::~Morpher() = default;

void Morpher::prepare(const Mesh& rest, const NodePartition& partition, Monitor& monitor)
{
  validate(rest);
  if (partition.prescribed.empty())
  {
    throw Error(Error::Kind::Singular, "No node is prescribed, so nothing says where the mesh "
                                       "goes. Prescribe the boundary's nodes.");
  }
  if (partition.free.empty())
  {
    throw Error("No node is free: every node of every volume cell is prescribed, so there is "
                "nothing to morph. Merge coincident points (Clean to Grid) if cells do not share "
                "theirs, refine "
                "the mesh, or prescribe fewer nodes.");
  }
  this->prepared_ = false; // until everything below belongs together
  this->rest_ = rest.points;
  this->partition_ = partition;
  this->followers_.prepare(rest, partition);
  monitor.check();
  this->doPrepare(rest, monitor);
  this->prepared_ = true;
  monitor.progress(1);
}

void Morpher::setReference(Points)
{
}

void Morpher::requirePrepared() const
{
  if (!this->prepared_)
  {
    throw Error(
      "The method is not prepared: call prepare() first, and again after one that failed.");
  }
}

EvaluateReport Morpher::evaluate(
  const ConstPoints& prescribed, Points& moved, Monitor& monitor) const
{
  this->requirePrepared();
  const std::vector<Index>& ids = this->partition_.prescribed;
  requireRows(
    "The array of prescribed positions", prescribed.rows(), static_cast<Index>(ids.size()));

  Points displacement(static_cast<Index>(ids.size()), 3);
  std::vector<Index> notFinite;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const Index k = static_cast<Index>(i);
    displacement.row(k) = prescribed.row(k) - this->rest_.row(ids[i]);
    if (!displacement.row(k).allFinite())
    {
      notFinite.push_back(ids[i]);
    }
  }
  if (!notFinite.empty())
  {
    throw Error("Prescribed positions that are not finite (NaN or infinite) at node ids " +
                listIds(notFinite) + ".");
  }

  Points freeDisplacement(static_cast<Index>(this->partition_.free.size()), 3);
  const EvaluateReport report = this->displace(displacement, freeDisplacement, monitor);

  Points result = this->rest_;
  if (this->followers_.empty())
  {
    monitor.parallelFor(freeDisplacement.rows(), Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          moveBy(result.row(this->partition_.free[i]), freeDisplacement.row(i));
        }
      });
  }
  else
  {
    Points all = Points::Zero(this->rest_.rows(), 3);
    for (Index i = 0; i < freeDisplacement.rows(); ++i)
    {
      all.row(this->partition_.free[i]) = freeDisplacement.row(i);
    }
    for (Index i = 0; i < displacement.rows(); ++i)
    {
      all.row(ids[i]) = displacement.row(i);
    }
    this->followers_.apply(all);
    for (Index n = 0; n < all.rows(); ++n)
    {
      moveBy(result.row(n), all.row(n));
    }
  }
  // Rest plus displacement may differ from the given position in the last bit.
  for (Index i = 0; i < prescribed.rows(); ++i)
  {
    result.row(ids[i]) = prescribed.row(i);
  }
  moved.swap(result);
  monitor.progress(1);
  return report;
}

EvaluateReport LinearMorpher::applyTranspose(
  const ConstPoints& gradient, Points& prescribed, Monitor& monitor) const
{
  this->requirePrepared();
  requireRows("The gradient", gradient.rows(), this->restPoints().rows());
  Points all = gradient;
  if (!all.allFinite())
  {
    throw Error("The gradient has entries that are not finite (NaN or infinite).");
  }
  // Prescribed nodes go through no weights: what followers hand to them is theirs as well.
  this->followers_.applyTranspose(all);
  Points result = rowsOf(all, this->partition().prescribed);
  const EvaluateReport report =
    this->displaceTranspose(rowsOf(all, this->partition().free), result, monitor);
  prescribed.swap(result);
  return report;
}
}
