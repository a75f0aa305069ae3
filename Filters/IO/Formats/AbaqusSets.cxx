// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusSets.h"

#include "Formats/AbaqusElements.h"
#include "Formats/AbaqusKeyword.h"
#include "Text/NumberText.h"

#include <algorithm>

namespace morph::io
{
namespace
{
void sortUnique(std::vector<Index>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

void addFound(
  Index number, const std::unordered_map<Index, Index>& positionOf, std::vector<Index>& list)
{
  const auto found = positionOf.find(number);
  if (found != positionOf.end())
  {
    list.push_back(found->second);
  }
}
}

AbaqusSets::Entries* AbaqusSets::entriesOf(Sets& sets, const std::string& name)
{
  if (name.empty())
  {
    return nullptr;
  }
  NamedEntries& set = sets[upperCase(name)];
  if (set.name.empty())
  {
    set.name = name;
  }
  return &set.entries;
}

AbaqusSets::Surface* AbaqusSets::surface(const std::string& name, bool ofNodes)
{
  if (name.empty())
  {
    return nullptr;
  }
  this->surfaces_.push_back({ name, ofNodes, {} });
  return &this->surfaces_.back().lines;
}

void AbaqusSets::addNodesOf(const std::string& elementSet, const std::string& nodeSet)
{
  if (!nodeSet.empty())
  {
    entriesOf(this->nodeSets_, nodeSet);
    this->nodeSets_[upperCase(nodeSet)].elementSets.push_back(upperCase(elementSet));
  }
}

std::vector<Index> AbaqusSets::positions(const Sets& sets, const std::string& name,
  const std::unordered_map<Index, Index>& positionOf, int depth)
{
  std::vector<Index> result;
  const auto set = sets.find(name);
  if (set == sets.end() || depth > 20) // sets that name each other
  {
    return result;
  }
  for (const Index number : set->second.entries.numbers)
  {
    addFound(number, positionOf, result);
  }
  for (const auto& [first, last, step] : set->second.entries.ranges)
  {
    // A range may be longer than the mesh by far.
    if ((last - first) / step <= static_cast<Index>(positionOf.size()))
    {
      for (Index number = first; number <= last; number += step)
      {
        addFound(number, positionOf, result);
      }
      continue;
    }
    for (const auto& [number, position] : positionOf)
    {
      if (number >= first && number <= last && (number - first) % step == 0)
      {
        result.push_back(position);
      }
    }
  }
  for (const std::string& other : set->second.entries.names)
  {
    const std::vector<Index> more = positions(sets, other, positionOf, depth + 1);
    result.insert(result.end(), more.begin(), more.end());
  }
  sortUnique(result);
  return result;
}

std::vector<Index> AbaqusSets::nodesOf(const std::string& name, const SolverMesh& mesh,
  const std::unordered_map<Index, Index>& nodes,
  const std::unordered_map<Index, Index>& elements) const
{
  std::vector<Index> result = positions(this->nodeSets_, name, nodes, 0);
  const auto set = this->nodeSets_.find(name);
  if (set != this->nodeSets_.end())
  {
    for (const std::string& elementSet : set->second.elementSets)
    {
      for (const Index cell : positions(this->elementSets_, elementSet, elements, 0))
      {
        const auto begin = mesh.connectivity.begin();
        result.insert(result.end(), begin + mesh.offsets[static_cast<std::size_t>(cell)],
          begin + mesh.offsets[static_cast<std::size_t>(cell) + 1]);
      }
    }
  }
  sortUnique(result);
  return result;
}

void AbaqusSets::addSurface(const NamedSurface& surface, SolverMesh& mesh,
  const std::unordered_map<Index, Index>& nodes,
  const std::unordered_map<Index, Index>& elements) const
{
  std::vector<Index> cells, points;
  for (const auto& [what, face] : surface.lines)
  {
    const auto number = parseInteger(what);
    std::vector<Index> chosen;
    if (surface.ofNodes)
    {
      number ? addFound(*number, nodes, chosen)
             : void(chosen = this->nodesOf(what, mesh, nodes, elements));
      points.insert(points.end(), chosen.begin(), chosen.end());
      continue;
    }
    number ? addFound(*number, elements, chosen)
           : void(chosen = positions(this->elementSets_, what, elements, 0));
    for (const Index element : chosen)
    {
      const auto at = static_cast<std::size_t>(element);
      const auto digit = face.size() == 2 && face[0] == 'S' ? face[1] - '0' : 0;
      const std::vector<int> corners = abaqusFace(mesh.cellTypes[at], digit);
      if (corners.empty())
      {
        cells.push_back(element); // a shell, or the whole outside of volume elements
        continue;
      }
      std::vector<Index> faceNodes;
      for (const int corner : corners)
      {
        faceNodes.push_back(mesh.connectivity[static_cast<std::size_t>(mesh.offsets[at] + corner)]);
      }
      cells.push_back(mesh.addCell(corners.size() == 3 ? Triangle : Quad, faceNodes, -1));
    }
  }
  NamedSet& set = mesh.set(surface.name);
  set.cells.insert(set.cells.end(), cells.begin(), cells.end());
  set.nodes.insert(set.nodes.end(), points.begin(), points.end());
  sortUnique(set.cells);
  sortUnique(set.nodes);
}

void AbaqusSets::addTo(SolverMesh& mesh, const std::unordered_map<Index, Index>& nodes) const
{
  const auto elements = positionsOf(mesh.cellNumbers, "element", "the file");
  for (const auto& [key, set] : this->nodeSets_)
  {
    std::vector<Index> found = this->nodesOf(key, mesh, nodes, elements);
    mesh.set(set.name).nodes = std::move(found);
  }
  for (const auto& [key, set] : this->elementSets_)
  {
    mesh.set(set.name).cells = positions(this->elementSets_, key, elements, 0);
  }
  for (const NamedSurface& surface : this->surfaces_)
  {
    this->addSurface(surface, mesh, nodes, elements);
  }
}
}
