// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/SolverMesh.h"

#include "Support/Error.h"

#include <algorithm>

namespace morph::io
{
void SolverMesh::addNode(Index number, double x, double y, double z)
{
  this->nodeNumbers.push_back(number);
  this->coordinates.insert(this->coordinates.end(), { x, y, z });
}

Index SolverMesh::addCell(std::uint8_t type, const std::vector<Index>& nodes, Index number)
{
  this->cellTypes.push_back(type);
  this->connectivity.insert(this->connectivity.end(), nodes.begin(), nodes.end());
  this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  this->cellNumbers.push_back(number);
  if (!this->faceOffsets.empty())
  {
    this->faceOffsets.push_back(static_cast<Index>(this->faces.size()));
  }
  return this->cells() - 1;
}

Index SolverMesh::addPolyhedron(const std::vector<std::vector<Index>>& faces, Index number)
{
  this->faceOffsets.resize(this->offsets.size(), 0);
  std::vector<Index> nodes;
  for (const std::vector<Index>& face : faces)
  {
    this->faces.push_back(static_cast<Index>(face.size()));
    this->faces.insert(this->faces.end(), face.begin(), face.end());
    nodes.insert(nodes.end(), face.begin(), face.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return this->addCell(Polyhedron, nodes, number);
}

NamedSet& SolverMesh::set(const std::string& name)
{
  const auto found = std::find_if(
    this->sets.begin(), this->sets.end(), [&](const NamedSet& set) { return set.name == name; });
  if (found != this->sets.end())
  {
    return *found;
  }
  this->sets.push_back({ name, {}, {} });
  return this->sets.back();
}

std::unordered_map<Index, Index> positionsOf(
  const std::vector<Index>& numbers, const char* what, const std::string& file)
{
  std::unordered_map<Index, Index> positions;
  positions.reserve(numbers.size());
  std::vector<Index> twice;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0 && !positions.emplace(numbers[i], static_cast<Index>(i)).second)
    {
      twice.push_back(numbers[i]);
    }
  }
  if (!twice.empty())
  {
    throw Error("Cannot read " + file + ": it defines more than one " + what +
                " with the numbers " + listIds(twice) + ".");
  }
  return positions;
}

int dimensionOf(std::uint8_t type)
{
  const CellShape* shape = cellShape(type);
  return shape ? shape->dimension : 3;
}
}
