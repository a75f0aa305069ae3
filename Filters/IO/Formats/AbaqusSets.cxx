// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusSets.h"

#include "Formats/AbaqusElements.h"
#include "Formats/AbaqusKeyword.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <iterator>

namespace morph::io
{
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

void AbaqusSets::addInstance(
  const AbaqusSets& part, const std::string& name, Index nodes, Index elements)
{
  const std::string start = name + ".", key = upperCase(start);
  const auto prefixed = [&key](std::vector<std::string> names)
  {
    std::transform(names.begin(), names.end(), names.begin(),
      [&key](const std::string& one) { return key + one; });
    return names;
  };
  for (const auto member : { &AbaqusSets::nodeSets_, &AbaqusSets::elementSets_ })
  {
    const Index shift = member == &AbaqusSets::nodeSets_ ? nodes : elements;
    for (const auto& [one, set] : part.*member)
    {
      NamedEntries copy = set;
      copy.name = start + set.name;
      copy.entries.names = prefixed(set.entries.names);
      copy.elementSets = prefixed(set.elementSets);
      for (Index& number : copy.entries.numbers)
      {
        number += shift;
      }
      for (auto& range : copy.entries.ranges)
      {
        range[0] += shift;
        range[1] += shift;
      }
      (this->*member)[key + one] = std::move(copy);
    }
  }
  for (NamedSurface surface : part.surfaces_)
  {
    surface.name = start + surface.name;
    for (auto& line : surface.lines)
    {
      const auto number = parseInteger(line.first);
      line.first =
        number ? std::to_string(*number + (surface.ofNodes ? nodes : elements)) : key + line.first;
    }
    this->surfaces_.push_back(std::move(surface));
  }
}

std::vector<const AbaqusSets::NamedEntries*> AbaqusSets::reached(
  const Sets& sets, const std::string& name, std::string& missing)
{
  std::vector<const NamedEntries*> result;
  std::vector<std::string> names = { name };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const auto set = sets.find(names[i]);
    if (set == sets.end())
    {
      missing = missing.empty() ? names[i] : missing;
    }
    else if (std::find(result.begin(), result.end(), &set->second) == result.end())
    {
      result.push_back(&set->second);
      const std::vector<std::string>& more = set->second.entries.names;
      names.insert(names.end(), more.begin(), more.end());
    }
  }
  return result;
}

std::vector<Index> AbaqusSets::positions(
  const Sets& sets, const std::string& name, const Numbering& numbering)
{
  std::vector<Index> result;
  std::string missing;
  for (const NamedEntries* set : reached(sets, name, missing))
  {
    for (const Index number : set->entries.numbers)
    {
      numbering.add(number, number, result);
    }
    for (const auto& [first, last, step] : set->entries.ranges)
    {
      numbering.add(first, last, result, step);
    }
  }
  sortUnique(result);
  return result;
}

std::vector<Index> AbaqusSets::nodesOf(const std::string& name, const SolverMesh& mesh,
  const Numbering& nodes, const Numbering& elements) const
{
  std::vector<Index> result = positions(this->nodeSets_, name, nodes);
  std::string missing;
  for (const NamedEntries* set : reached(this->nodeSets_, name, missing))
  {
    for (const std::string& elementSet : set->elementSets)
    {
      for (const Index cell : positions(this->elementSets_, elementSet, elements))
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

void AbaqusSets::addSurface(const NamedSurface& surface, SolverMesh& mesh, const Numbering& nodes,
  const Numbering& elements, const std::vector<std::uint8_t>& arePlane) const
{
  std::vector<Index> cells, points;
  for (const auto& [what, face] : surface.lines)
  {
    const auto number = parseInteger(what);
    std::vector<Index> chosen;
    if (surface.ofNodes)
    {
      number ? nodes.add(*number, *number, chosen)
             : void(chosen = this->nodesOf(what, mesh, nodes, elements));
      points.insert(points.end(), chosen.begin(), chosen.end());
      continue;
    }
    number ? elements.add(*number, *number, chosen)
           : void(chosen = positions(this->elementSets_, what, elements));
    for (const Index element : chosen)
    {
      const auto at = static_cast<std::size_t>(element);
      const auto corners = abaqusSide(mesh.cellTypes[at], arePlane[at] != 0, face);
      if (!corners)
      {
        mesh.warnings.push_back("The surface '" + surface.name + "' names the side " + face +
                                " of element " + std::to_string(mesh.cellNumbers[at]) +
                                ", which has no such side, and is left out.");
        return;
      }
      if (corners->empty())
      {
        cells.push_back(element); // a shell, or the whole outside of volume elements
        continue;
      }
      std::vector<Index> sideNodes;
      for (const int corner : *corners)
      {
        sideNodes.push_back(mesh.connectivity[static_cast<std::size_t>(mesh.offsets[at] + corner)]);
      }
      const std::uint8_t type = sideNodes.size() == 2   ? Line
                                : sideNodes.size() == 3 ? Triangle
                                                        : Quad;
      cells.push_back(mesh.addCell(type, sideNodes, -1));
    }
  }
  NamedSet& set = mesh.set(surface.name);
  set.cells.insert(set.cells.end(), cells.begin(), cells.end());
  set.nodes.insert(set.nodes.end(), points.begin(), points.end());
  sortUnique(set.cells);
  sortUnique(set.nodes);
}

std::string AbaqusSets::missing(const Sets& sets, const std::string& name) const
{
  std::string result;
  for (const NamedEntries* set : reached(sets, name, result))
  {
    for (const std::string& other : set->elementSets)
    {
      reached(this->elementSets_, other, result);
    }
  }
  return result;
}

std::string AbaqusSets::missing(const NamedSurface& surface) const
{
  std::string result;
  for (const auto& [what, face] : surface.lines)
  {
    if (!parseInteger(what) && result.empty())
    {
      result = this->missing(surface.ofNodes ? this->nodeSets_ : this->elementSets_, what);
    }
  }
  return result;
}

void AbaqusSets::addTo(SolverMesh& mesh, const Numbering& nodes, const Numbering& elements,
  const std::vector<std::uint8_t>& arePlane) const
{
  const auto isWhole = [&mesh](const std::string& name, const std::string& missing)
  {
    if (!missing.empty())
    {
      mesh.warnings.push_back("The set '" + name + "' names the set '" + missing +
                              "', which the file does not define, and is left out.");
    }
    return missing.empty();
  };
  for (const auto& [key, set] : this->nodeSets_)
  {
    if (isWhole(set.name, this->missing(this->nodeSets_, key)))
    {
      std::vector<Index> found = this->nodesOf(key, mesh, nodes, elements), undefined;
      const std::vector<Index>& numbers = set.entries.numbers;
      std::copy_if(numbers.begin(), numbers.end(), std::back_inserter(undefined),
        [&nodes](Index number) { return nodes.find(number) < 0; });
      if (!undefined.empty())
      {
        mesh.warnings.push_back("The set '" + set.name + "' names nodes that the file does not " +
                                "define: numbers " + listIds(undefined) + ".");
      }
      mesh.set(set.name).nodes = std::move(found);
    }
  }
  for (const auto& [key, set] : this->elementSets_)
  {
    if (isWhole(set.name, this->missing(this->elementSets_, key)))
    {
      mesh.set(set.name).cells = positions(this->elementSets_, key, elements);
    }
  }
  for (const NamedSurface& surface : this->surfaces_)
  {
    if (isWhole(surface.name, this->missing(surface)))
    {
      this->addSurface(surface, mesh, nodes, elements, arePlane);
    }
  }
}
}
