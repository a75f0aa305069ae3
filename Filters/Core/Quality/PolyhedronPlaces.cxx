// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronPlaces.h"

#include "Mesh/Polyhedra.h"

#include <algorithm>
#include <numeric>

namespace morph
{
bool PolyhedronPlaces::take(const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  const Index* nodes = mesh.cell(cell);
  const Index size = mesh.cellSize(cell);
  this->place_.resize(size);
  std::iota(this->place_.begin(), this->place_.end(), 0);
  std::sort(this->place_.begin(), this->place_.end(),
    [nodes](int a, int b) { return nodes[a] < nodes[b]; });
  this->sorted_.clear();
  for (const int place : this->place_)
  {
    this->sorted_.push_back(nodes[place]);
  }
  const auto placeOf = [this](Index node)
  {
    const auto at = std::lower_bound(this->sorted_.begin(), this->sorted_.end(), node);
    return this->place_[at - this->sorted_.begin()];
  };

  this->corners_.clear();
  for (const PolyhedronCorner& c : this->find_.find(mesh, cell, sign))
  {
    this->corners_.push_back(
      { placeOf(c.node), placeOf(c.last), placeOf(c.next), placeOf(c.other) });
  }
  this->centers_.compute(mesh, cell, points, sign);
  this->shares_ = this->centers_.shares;
  this->nodes_.clear();
  this->weights_.clear();
  this->start_.assign(1, 0);
  bool hasLengths = true;
  forEachFace(mesh, cell,
    [&](const Index* face, Index count)
    {
      const double* triangles = this->centers_.triangles.data() + this->nodes_.size();
      const double sum = std::accumulate(triangles, triangles + count, 0.);
      const double mean = 1 / static_cast<double>(count);
      for (Index k = 0; k < count; ++k)
      {
        this->nodes_.push_back(placeOf(face[k]));
        // Each triangle has two of the nodes, and a third of it is the mean of all.
        const double own = triangles[k] + triangles[(k + count - 1) % count];
        this->weights_.push_back(count > 3 && sum > 0 ? own / (3 * sum) + mean / 3 : mean);
        hasLengths = hasLengths && points.row(face[k]) != points.row(face[(k + 1) % count]);
      }
      this->start_.push_back(this->nodes_.size());
    });
  return hasLengths && !this->shares_.empty();
}
}
