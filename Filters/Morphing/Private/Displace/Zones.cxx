// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Zones.h"

#include "Mesh/CellShape.h"
#include "Private/Blocks/MergedBlocks.h"
#include "Private/Displace/Chosen.h"
#include "Private/Displace/Selection.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImplicitFunction.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using Zones::Part;
using Flags = std::vector<std::uint8_t>;

void takeNodes(const morph::Mesh& mesh, Flags isNode, Part& part)
{
  part.ByNodes = true;
  morph::takeNodes(mesh, std::move(isNode), part);
}

/// Whether messages name the block of that name, or of the last part of its path, in this way.
bool isNamed(const std::string& block, const std::string& name)
{
  const std::string end = "/" + name + "'";
  return block == name || block == "Block '" + name + "'" ||
         (block.size() > end.size() &&
           block.compare(block.size() - end.size(), end.size(), end) == 0);
}

/// What a name marks.
struct Marked
{
  bool AreNodes = false;
  std::vector<std::uint8_t> Flags; ///< #nodes or #cells
};

/// What a cell array, a point array or else a block of that name marks.
std::optional<Marked> findNamed(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const std::string& name)
{
  vtkDataArray* ofPoints = grid->GetPointData()->GetArray(name.c_str());
  vtkDataArray* ofCells = grid->GetCellData()->GetArray(name.c_str());
  if (ofCells && ofCells->GetNumberOfTuples() == mesh.numberOfCells())
  {
    return Marked{ false, Chosen::Marked(ofCells) };
  }
  if (ofPoints && ofPoints->GetNumberOfTuples() == mesh.numberOfNodes())
  {
    return Marked{ true, Chosen::Marked(ofPoints) };
  }
  Marked cells{ false, std::vector<std::uint8_t>(mesh.numberOfCells(), 0) };
  bool found = false;
  for (std::size_t b = 0; blocks && b < blocks->All.size(); ++b)
  {
    const MergedBlocks::Block& block = blocks->All[b];
    if (block.IsMesh && isNamed(block.Name, name))
    {
      found = true;
      for (Index c = 0; c < mesh.numberOfCells(); ++c)
      {
        cells.Flags[c] = cells.Flags[c] || blocks->BlockOfCell[c] == static_cast<Index>(b);
      }
    }
  }
  return found ? std::optional(std::move(cells)) : std::nullopt;
}

/// The last part of the path of a block, as isNamed() takes it.
std::string shortName(const std::string& block)
{
  const std::size_t end = block.rfind('\'');
  const std::size_t begin = block.find_last_of("/'", end == 0 ? 0 : end - 1);
  return end == std::string::npos || begin == std::string::npos
           ? block
           : block.substr(begin + 1, end - begin - 1);
}

/// The array of that name, if it may mark something.
vtkDataArray* arrayOfMarks(vtkDataSetAttributes* data, const char* name, vtkIdType size)
{
  vtkDataArray* array = name ? data->GetArray(name) : nullptr; // null for texts
  return array && array->GetNumberOfComponents() == 1 && array->GetNumberOfTuples() == size &&
             name != std::string(vtkDataSetAttributes::GhostArrayName())
           ? array
           : nullptr;
}

/// Whether the arrays of all processes, null for none, have two values, one of them 0.
bool areMarks(vtkDataArray* array, const morph::Communicator& processes)
{
  double least = HUGE_VAL, most = -HUGE_VAL; // but for 0
  bool hasZero = false, hasNaN = false;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    const double value = array->GetComponent(i, 0);
    hasZero = hasZero || value == 0;
    hasNaN = hasNaN || std::isnan(value);
    least = value != 0 ? std::min(least, value) : least;
    most = value != 0 ? std::max(most, value) : most;
  }
  least = processes.minimum(least);
  most = processes.maximum(most);
  return processes.all(!hasNaN) && !processes.all(!hasZero) && least == most;
}

/// The names of the blocks of all processes, in the order of the blocks.
std::vector<std::string> namesOfBlocks(
  vtkUnstructuredGrid* grid, const MergedBlocks* blocks, const morph::Communicator& processes)
{
  vtkDataArray* numbers = grid->GetCellData()->GetArray("MorphBlockId");
  std::vector<std::string> mine;
  std::map<std::string, double> first; // the number of the first block of a name
  for (std::size_t b = 0; blocks && b < blocks->All.size(); ++b)
  {
    const MergedBlocks::Block& block = blocks->All[b];
    if (block.IsMesh)
    {
      mine.push_back(shortName(block.Name));
      first.emplace(mine.back(),
        block.Cells.empty() || !numbers ? HUGE_VAL : numbers->GetComponent(block.Cells[0], 0));
    }
  }
  std::vector<std::pair<double, std::string>> all;
  for (const std::string& name : processes.gatherTexts(mine))
  {
    const auto found = first.find(name);
    all.emplace_back(processes.minimum(found == first.end() ? HUGE_VAL : found->second), name);
  }
  std::stable_sort(
    all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  std::transform(all.begin(), all.end(), std::back_inserter(names),
    [](const auto& block) { return block.second; });
  return names;
}

/// The names that may be a zone's, in the order of the list.
std::vector<std::string> candidates(
  vtkUnstructuredGrid* grid, const MergedBlocks* blocks, const morph::Communicator& processes)
{
  std::vector<std::string> names = processes.gatherTexts(NamesOfSets(grid));
  const auto add = [&](const std::string& name)
  {
    if (std::find(names.begin(), names.end(), name) == names.end())
    {
      names.push_back(name);
    }
  };
  for (const std::string& name : namesOfBlocks(grid, blocks, processes))
  {
    add(name);
  }
  const auto addMarks = [&](vtkDataSetAttributes* data, vtkIdType size)
  {
    std::vector<std::string> mine;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      if (arrayOfMarks(data, data->GetArrayName(i), size))
      {
        mine.emplace_back(data->GetArrayName(i));
      }
    }
    for (const std::string& name : processes.gatherTexts(mine))
    {
      if (areMarks(arrayOfMarks(data, name.c_str(), size), processes))
      {
        add(name);
      }
    }
  };
  addMarks(grid->GetCellData(), grid->GetNumberOfCells());
  addMarks(grid->GetPointData(), grid->GetNumberOfPoints());
  return names;
}

/// The first names of the list, for a message.
std::string listed(vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const MergedBlocks* blocks)
{
  constexpr std::size_t Most = 10;
  const std::vector<ListedZone> zones = Zones::List(grid, mesh, blocks);
  std::string names;
  for (std::size_t i = 0; i < std::min(zones.size(), Most); ++i)
  {
    names += (i > 0 ? ", " : "") + zones[i].Name;
  }
  return zones.size() > Most ? names + ", ..." : names;
}

[[noreturn]] void throwUnknown(
  vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const MergedBlocks* blocks, const Part& part)
{
  const std::string names = listed(grid, mesh, blocks);
  throw Error("The zone '" + part.name +
              "' is neither a set, a point or cell array nor a block of the input" +
              (names.empty() ? "" : "; it has " + names) +
              ". A zone is where an array is not zero, or a block.");
}

/// `isPart`: whether other processes may have the block.
void takeNamed(vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const MergedBlocks* blocks,
  bool isPart, Part& part)
{
  const bool isEmpty = isPart && mesh.numberOfCells() == 0;
  std::optional<Marked> marked = isEmpty ? std::nullopt : findNamed(grid, mesh, blocks, part.name);
  if (!marked)
  {
    if (!isEmpty && (!isPart || !blocks))
    {
      throwUnknown(grid, mesh, blocks, part);
    }
    part.IsKnown = false;
    marked = Marked{ false, Flags(mesh.numberOfCells(), 0) };
  }
  marked->AreNodes ? takeNodes(mesh, std::move(marked->Flags), part)
                   : morph::takeCells(mesh, std::move(marked->Flags), part);
}

void takeRegion(const morph::Mesh& mesh, vtkImplicitFunction* region, Part& part)
{
  if (!region)
  {
    throw Error("No region is given for the zone: set `ZoneRegion`, a box for instance.");
  }
  Flags isNode(mesh.numberOfNodes(), 0);
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    isNode[n] = region->FunctionValue(mesh.points(n, 0), mesh.points(n, 1), mesh.points(n, 2)) <= 0;
  }
  takeNodes(mesh, std::move(isNode), part);
}

bool isNowhere(const Part& part)
{
  return std::none_of(part.isNode.begin(), part.isNode.end(), [](auto flag) { return flag != 0; });
}

[[noreturn]] void throwNowhere(const Part& part)
{
  throw Error("The zone '" + part.name + "' has no node of the mesh.");
}
}

namespace Zones
{
std::vector<ListedZone> List(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const morph::Communicator& processes)
{
  std::vector<ListedZone> zones;
  for (const std::string& name : candidates(grid, blocks, processes))
  {
    ListedZone zone;
    zone.Name = name;
    const std::optional<Marked> marked = findNamed(grid, mesh, blocks, name);
    for (std::size_t i = 0; marked && i < marked->Flags.size(); ++i)
    {
      const morph::CellShape* shape = marked->AreNodes ? nullptr : morph::cellShape(mesh.types[i]);
      const auto number = static_cast<Index>(i);
      const bool isImage = mesh.layer.nodes > 0 && number >= mesh.layer.nodes;
      zone.Nodes += marked->AreNodes && marked->Flags[i] && !isImage && processes.owns(number);
      if (shape && shape->dimension == 3 && marked->Flags[i] && !processes.isCopy(number))
      {
        zone.Cells.push_back(number);
      }
    }
    zone.CellCount = processes.sum(static_cast<Index>(zone.Cells.size()));
    zone.Nodes = processes.sum(zone.Nodes);
    if (zone.CellCount > 0 || zone.Nodes > 0)
    {
      zones.push_back(zone);
    }
  }
  return zones;
}

std::vector<Part> Find(Kind kind, vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const Options& options)
{
  std::vector<Part> parts;
  const auto take = [&](const std::string& name, const auto& fill)
  {
    Part& part = parts.emplace_back();
    part.name = name;
    fill(part);
    if (!options.IsPart && isNowhere(part))
    {
      throwNowhere(part);
    }
  };
  const NameSet::Names& names = kind == Fixed   ? options.Fixed
                                : kind == Rigid ? options.Rigid
                                                : options.Soft;
  for (const std::string& name : names)
  {
    take(name, [&](Part& part) { takeNamed(grid, mesh, blocks, options.IsPart, part); });
  }
  if (options.RegionKind == kind)
  {
    take("ZoneRegion", [&](Part& part) { takeRegion(mesh, options.Region, part); });
  }
  if (options.SelectionKind == kind)
  {
    take("ZoneSelection",
      [&](Part& part)
      {
        if (options.IsPart && !(options.Selection && options.Selection->GetNumberOfNodes() > 0))
        {
          morph::takeCells(mesh, Flags(mesh.numberOfCells(), 0), part);
          return;
        }
        Selection::Inside inside = Selection::Evaluate(grid, options.Selection, options.Extractor);
        inside.ByPoints ? takeNodes(mesh, std::move(inside.Flags), part)
                        : morph::takeCells(mesh, std::move(inside.Flags), part);
      });
  }
  return parts;
}

std::vector<Part> FindOnRanks(Kind kind, vtkUnstructuredGrid* grid,
  const morph::InnerPieces& volume, const MergedBlocks* blocks, Options options)
{
  // A selection that is nowhere is an error, as on one process.
  const bool isSelected = options.Selection && options.Selection->GetNumberOfNodes() > 0;
  options.IsPart = Ranks::Count(isSelected) > 0 || options.SelectionKind != kind;
  std::vector<Part> parts;
  Ranks::Together(
    [&]
    {
      if (!options.IsPart)
      {
        Selection::Evaluate(grid, nullptr, nullptr); // which throws
      }
      parts = Find(kind, grid, volume.piece(), blocks, options);
    });
  for (Part& part : parts)
  {
    if (Ranks::Count(part.IsKnown) == 0)
    {
      Ranks::Together([&] { throwUnknown(grid, volume.piece(), blocks, part); });
    }
    Flags isNode = volume.anyFlags(part.isNode);
    if (Ranks::Count(!isNowhere(part)) == 0)
    {
      throwNowhere(part);
    }
    // A process without a part of the zone does not know what kind it is.
    Ranks::Count(part.ByNodes) > 0 ? takeNodes(volume.piece(), std::move(isNode), part)
                                   : void(part.isNode = std::move(isNode));
  }
  return parts;
}
}
}
