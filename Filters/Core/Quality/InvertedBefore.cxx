// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/InvertedBefore.h"

#include "Mesh/Polyhedra.h"
#include "Mesh/StandingCells.h"
#include "Quality/MeasuredPlaces.h"
#include "Quality/PolyhedronQuality.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <limits>

namespace morph
{
using Vector = Eigen::Vector3d;

InvertedBefore::InvertedBefore(
  const Mesh& mesh, const std::vector<std::int8_t>& orientation, const Quality& atRest)
{
  this->mesh_ = &mesh;
  // An edge as short as this is rounding, and so is the sign of what it spans.
  const double rounding = 8 * std::numeric_limits<double>::epsilon() *
                          (mesh.points.size() > 0 ? mesh.points.cwiseAbs().maxCoeff() : 0);
  for (std::size_t c = 0; c < atRest.scaledJacobian.size(); ++c)
  {
    if (atRest.scaledJacobian[c] <= Flat)
    {
      this->cells_.push_back(static_cast<Index>(c));
      this->signs_.push_back(orientation.empty() ? 1 : orientation[c]);
      this->positive_.push_back(
        this->placesOf(this->cells_.back(), this->signs_.back(), mesh.points, Flat, rounding));
    }
  }
}

std::vector<bool> InvertedBefore::placesOf(
  Index cell, double sign, const ConstPoints& points, double least, double leastEdge) const
{
  std::vector<bool> positive;
  const auto add = [&](const Vector& a, const Vector& b, const Vector& c)
  {
    const double lengths[] = { a.norm(), b.norm(), c.norm() };
    positive.push_back(*std::min_element(lengths, lengths + 3) > leastEdge &&
                       sign * a.dot(b.cross(c)) > least * lengths[0] * lengths[1] * lengths[2]);
  };
  const Index* nodes = this->mesh_->cell(cell);
  const CellShape& shape = *cellShape(*this->mesh_, cell);
  if (hasFaces(*this->mesh_, cell))
  {
    std::vector<Vector> x;
    std::transform(nodes, nodes + this->mesh_->cellSize(cell), std::back_inserter(x),
      [&](Index node) -> Vector { return (points.row(node) - points.row(nodes[0])).transpose(); });
    PolyhedronPlaces places;
    places.take(*this->mesh_, cell, x);
    places.forEach(x.data(), add);
    return positive;
  }
  Vector x[8];
  copyStanding(*this->mesh_, cell, shape, points, x[0].data());
  forEachMeasuredPlace(shape.shape, x, add);
  return positive;
}

const std::vector<bool>* InvertedBefore::positivePlaces(Index cell) const
{
  const auto at = std::lower_bound(this->cells_.begin(), this->cells_.end(), cell);
  return at != this->cells_.end() && *at == cell ? &this->positive_[at - this->cells_.begin()]
                                                 : nullptr;
}

std::vector<Index> InvertedBefore::added(
  const ConstPoints& points, const std::vector<Index>& inverted) const
{
  std::vector<Index> result;
  for (const Index cell : inverted)
  {
    if (const std::vector<bool>* before = this->positivePlaces(cell))
    {
      const std::ptrdiff_t i = before - this->positive_.data();
      std::vector<bool> now = this->placesOf(cell, this->signs_[i], points, 0, 0);
      now.resize(before->size(), false); // without volume, a polyhedron has fewer places
      if (std::equal(before->begin(), before->end(), now.begin(),
            [](bool was, bool is) { return is || !was; }))
      {
        continue;
      }
    }
    result.push_back(cell);
  }
  return result;
}

std::vector<Index> InvertedBefore::without(const std::vector<Index>& cells) const
{
  std::vector<Index> result;
  std::set_difference(cells.begin(), cells.end(), this->cells_.begin(), this->cells_.end(),
    std::back_inserter(result));
  return result;
}
}
