// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Zones.h"

#include "Private/Blocks/MergedBlocks.h"
#include "Private/Displace/Choice.h"
#include "Private/Displace/Selection.h"
#include "Private/Distributed/WholeVolume.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImplicitFunction.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using Zones::Part;
using Flags = std::vector<std::uint8_t>;

/// Flags of the tuples with a component other than 0; a NaN marks nothing.
void takeNodes(const morph::Mesh& mesh, Flags isNode, Part& part)
{
  part.ByNodes = true;
  part.IsNode = std::move(isNode);
  part.IsCell.assign(mesh.numberOfCells(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    part.IsCell[c] = std::all_of(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c),
      [&](Index node) { return part.IsNode[node] != 0; });
  }
}

void takeCells(const morph::Mesh& mesh, Flags isCell, Part& part)
{
  part.IsCell = std::move(isCell);
  part.IsNode.assign(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; part.IsCell[c] && k < mesh.cellSize(c); ++k)
    {
      part.IsNode[mesh.cell(c)[k]] = 1;
    }
  }
}

/// Whether messages name the block of that name, or of the last part of its path, in this way.
bool isNamed(const std::string& block, const std::string& name)
{
  const std::string end = "/" + name + "'";
  return block == name || block == "Block '" + name + "'" ||
         (block.size() > end.size() &&
           block.compare(block.size() - end.size(), end.size(), end) == 0);
}

/// Fills `part` from the block of that name. Returns false where there is none.
bool takeBlock(const morph::Mesh& mesh, const MergedBlocks* blocks, Part& part)
{
  if (!blocks)
  {
    return false;
  }
  Flags isCell(mesh.numberOfCells(), 0);
  bool found = false;
  for (std::size_t b = 0; b < blocks->All.size(); ++b)
  {
    const MergedBlocks::Block& block = blocks->All[b];
    if (block.IsMesh && isNamed(block.Name, part.Name))
    {
      found = true;
      for (Index c = 0; c < mesh.numberOfCells(); ++c)
      {
        isCell[c] = isCell[c] || blocks->BlockOfCell[c] == static_cast<Index>(b);
      }
    }
  }
  if (found)
  {
    takeCells(mesh, std::move(isCell), part);
  }
  return found;
}

[[noreturn]] void throwUnknown(const Part& part, const MergedBlocks* blocks)
{
  std::string names;
  for (std::size_t b = 0; blocks && b < blocks->All.size(); ++b)
  {
    names += blocks->All[b].IsMesh ? (names.empty() ? "" : ", ") + blocks->All[b].Name : "";
  }
  throw Error("The zone '" + part.Name +
              "' is neither a point array, a cell array nor a block of the input" +
              (names.empty() ? "" : ", whose blocks are " + names) +
              ". A zone is where an array is not zero, or a block.");
}

/// `isPart`: whether other processes may have the block.
void takeNamed(vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const MergedBlocks* blocks,
  bool isPart, Part& part)
{
  vtkDataArray* ofPoints = grid->GetPointData()->GetArray(part.Name.c_str());
  vtkDataArray* ofCells = grid->GetCellData()->GetArray(part.Name.c_str());
  if (isPart && mesh.numberOfCells() == 0)
  {
    part.IsKnown = false;
    takeCells(mesh, Flags(), part);
  }
  else if (ofCells && ofCells->GetNumberOfTuples() == mesh.numberOfCells())
  {
    takeCells(mesh, Choice::Marked(ofCells), part);
  }
  else if (ofPoints && ofPoints->GetNumberOfTuples() == mesh.numberOfNodes())
  {
    takeNodes(mesh, Choice::Marked(ofPoints), part);
  }
  else if (!takeBlock(mesh, blocks, part))
  {
    if (!isPart || !blocks)
    {
      throwUnknown(part, blocks);
    }
    part.IsKnown = false;
    takeCells(mesh, Flags(mesh.numberOfCells(), 0), part);
  }
}

void takeRegion(const morph::Mesh& mesh, vtkImplicitFunction* region, Part& part)
{
  if (!region)
  {
    throw Error("No region is given for the zone: set ZoneRegion, a box for instance.");
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
  return std::none_of(part.IsNode.begin(), part.IsNode.end(), [](auto flag) { return flag != 0; });
}

[[noreturn]] void throwNowhere(const Part& part)
{
  throw Error("The zone '" + part.Name + "' has no node of the mesh.");
}
}

namespace Zones
{
std::vector<Part> Find(Kind kind, vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const Options& options)
{
  std::vector<Part> parts;
  const auto take = [&](const std::string& name, const auto& fill)
  {
    Part& part = parts.emplace_back();
    part.Name = name;
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
          takeCells(mesh, Flags(mesh.numberOfCells(), 0), part);
          return;
        }
        Selection::Inside inside = Selection::Evaluate(grid, options.Selection, options.Extractor);
        inside.ByPoints ? takeNodes(mesh, std::move(inside.Flags), part)
                        : takeCells(mesh, std::move(inside.Flags), part);
      });
  }
  return parts;
}

std::vector<Part> FindOnRanks(Kind kind, vtkUnstructuredGrid* grid, const WholeVolume& volume,
  const MergedBlocks* blocks, Options options)
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
      parts = Find(kind, grid, volume.Piece(), blocks, options);
    });
  for (Part& part : parts)
  {
    if (Ranks::Count(part.IsKnown) == 0)
    {
      Ranks::Together([&] { throwUnknown(part, blocks); });
    }
    Flags isNode = volume.AnyFlags(part.IsNode);
    if (Ranks::Count(!isNowhere(part)) == 0)
    {
      throwNowhere(part);
    }
    // A process without a part of the zone does not know what kind it is.
    Ranks::Count(part.ByNodes) > 0 ? takeNodes(volume.Piece(), std::move(isNode), part)
                                   : void(part.IsNode = std::move(isNode));
  }
  return parts;
}
}
}
