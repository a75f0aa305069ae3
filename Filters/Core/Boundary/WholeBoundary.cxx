// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/WholeBoundary.h"

#include "Boundary/CrossingFaces.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace morph
{
namespace
{
using Row = std::vector<double>; // numbers below 2^53

/// The rows of all processes, in lexicographic order.
std::vector<Row> gathered(
  const std::vector<Row>& mine, const Communicator& processes, std::size_t& bytes)
{
  std::vector<double> flat;
  for (const Row& row : mine)
  {
    flat.push_back(static_cast<double>(row.size()));
    flat.insert(flat.end(), row.begin(), row.end());
  }
  flat = processes.gather(flat);
  bytes += sizeof(double) * flat.size();
  std::vector<Row> all;
  for (auto at = flat.begin(); at != flat.end();)
  {
    const auto size = static_cast<std::ptrdiff_t>(*at++);
    all.emplace_back(at, at + size);
    at += size;
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Adds the ids from `first` to before `last`.
void add(const std::vector<Index>& ids, Index first, Index last, Row& row)
{
  row.insert(row.end(), ids.begin() + first, ids.begin() + last);
}
}

WholeBoundary::WholeBoundary(const Mesh& mesh, const BoundaryFaces& own,
  const std::vector<std::int8_t>& orientation, const Communicator& processes)
  : processes_(processes)
  , own_(own.nodes)
{
  const std::vector<Index> cellIds = processes.idsOfCells(own.cells),
                           nodeIds = processes.idsOf(own.nodes),
                           corners = processes.idsOf(own.connectivity),
                           between = processes.idsOf(own.between.values);
  std::vector<Row> faces, nodes;
  for (std::size_t f = 0; f < cellIds.size(); ++f)
  {
    faces.push_back({ static_cast<double>(cellIds[f]), static_cast<double>(own.sides[f]),
      static_cast<double>(orientation[own.cells[f]]) });
    add(corners, own.offsets[f], own.offsets[f + 1], faces.back());
  }
  for (std::size_t n = 0; n < nodeIds.size(); ++n)
  {
    nodes.push_back({ static_cast<double>(nodeIds[n]) });
    add(between, own.between.offsets[n], own.between.offsets[n + 1], nodes.back());
  }
  std::vector<Row> mine = faces;
  faces = gathered(faces, processes, this->bytes_);
  nodes = gathered(nodes, processes, this->bytes_);
  // A node that is a corner to one process is none between others; its row comes first.
  nodes.erase(std::unique(nodes.begin(), nodes.end(),
                [](const Row& a, const Row& b) { return a[0] == b[0]; }),
    nodes.end());
  for (const Row& node : nodes)
  {
    this->nodes_.push_back(static_cast<Index>(node[0]));
  }
  const auto numberOf = [this](double id)
  { return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), id) - this->nodes_.begin(); };
  const auto addNumbers = [&](const Row& row, std::ptrdiff_t first, std::vector<Index>& offsets,
                            std::vector<Index>& values)
  {
    std::transform(row.begin() + first, row.end(), std::back_inserter(values), numberOf);
    offsets.push_back(static_cast<Index>(values.size()));
  };
  for (const Row& face : faces)
  {
    this->cells_.push_back(static_cast<Index>(face[0]));
    this->faces_.sides.push_back(static_cast<int>(face[1]));
    this->orientation_.push_back(static_cast<std::int8_t>(face[2]));
    addNumbers(face, 3, this->faces_.offsets, this->faces_.connectivity);
  }
  for (const Row& node : nodes)
  {
    addNumbers(node, 1, this->faces_.between.offsets, this->faces_.between.values);
  }
  this->faces_.cells = consecutive(faces.size());
  this->faces_.nodes = consecutive(nodes.size());
  for (const Row& face : mine)
  {
    this->numberOfOwn_.push_back(
      std::lower_bound(faces.begin(), faces.end(), face) - faces.begin());
  }
  std::transform(nodeIds.begin(), nodeIds.end(), std::back_inserter(this->ownNumber_), numberOf);
  this->rest_ = this->gather(mesh.points);
}

Points WholeBoundary::gather(const ConstPoints& rows) const
{
  std::vector<double> flat; // the number of a node, and its row
  for (std::size_t i = 0; i < this->own_.size(); ++i)
  {
    if (this->own_[i] < rows.rows())
    {
      const auto row = rows.row(this->own_[i]);
      flat.insert(flat.end(), { static_cast<double>(this->ownNumber_[i]), row[0], row[1], row[2] });
    }
  }
  flat = this->processes_.gather(flat);
  Points result = Points::Zero(static_cast<Index>(this->nodes_.size()), 3);
  for (std::size_t i = 0; i < flat.size(); i += 4)
  {
    result.row(static_cast<Index>(flat[i])) << flat[i + 1], flat[i + 2], flat[i + 3];
  }
  return result;
}

std::vector<char> WholeBoundary::isAmong(const std::vector<Index>& nodes) const
{
  std::vector<double> numbers;
  for (std::size_t i = 0; i < this->own_.size(); ++i)
  {
    if (std::binary_search(nodes.begin(), nodes.end(), this->own_[i]))
    {
      numbers.push_back(static_cast<double>(this->ownNumber_[i]));
    }
  }
  std::vector<char> result(this->nodes_.size(), 0);
  for (const double number : this->processes_.gather(numbers))
  {
    result[static_cast<std::size_t>(number)] = 1;
  }
  return result;
}

std::vector<std::array<Index, 2>> WholeBoundary::crossings(
  const BoundaryFaces& some, const Points& moved, Monitor& monitor) const
{
  std::vector<std::array<Index, 2>> pairs;
  this->processes_.together(
    [&] { pairs = crossingFaces(this->rest_, moved, some, this->orientation_, monitor); });
  return pairs;
}
}
