// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SubMesh.h"

#include <algorithm>
#include <iterator>

namespace morph
{
SubMesh::SubMesh(const Mesh& whole, const std::vector<Index>& cells)
  : cells(cells)
{
  std::vector<Index> number(whole.numberOfNodes(), -1);
  for (const Index c : cells)
  {
    std::for_each(
      whole.cell(c), whole.cell(c) + whole.cellSize(c), [&](Index node) { number[node] = 0; });
  }
  for (Index node = 0; node < whole.numberOfNodes(); ++node)
  {
    if (number[node] == 0)
    {
      number[node] = static_cast<Index>(this->nodes.size());
      this->nodes.push_back(node);
    }
  }
  this->mesh.points = whole.points(this->nodes, allColumns);
  this->mesh.layer = whole.layer; // cells have both images of their nodes, and fronts come first
  this->mesh.layer.nodes =
    std::lower_bound(this->nodes.begin(), this->nodes.end(), whole.layer.nodes) -
    this->nodes.begin();
  for (const Index c : cells)
  {
    this->mesh.types.push_back(whole.types[c]);
    std::transform(whole.cell(c), whole.cell(c) + whole.cellSize(c),
      std::back_inserter(this->mesh.connectivity), [&](Index node) { return number[node]; });
    this->mesh.offsets.push_back(static_cast<Index>(this->mesh.connectivity.size()));
  }
}

std::vector<Index> SubMesh::numbersOf(const std::vector<Index>& ids) const
{
  std::vector<Index> result(ids.size(), -1);
  std::transform(ids.begin(), ids.end(), result.begin(),
    [this](Index id)
    {
      const auto found = std::lower_bound(this->nodes.begin(), this->nodes.end(), id);
      return found != this->nodes.end() && *found == id
               ? static_cast<Index>(found - this->nodes.begin())
               : Index(-1);
    });
  return result;
}
}
