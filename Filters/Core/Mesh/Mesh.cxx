// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Mesh.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <string>

namespace morph
{
void validate(const Mesh& mesh)
{
  const Index cells = mesh.numberOfCells();
  const Index nodes = mesh.numberOfNodes();
  if (static_cast<Index>(mesh.offsets.size()) != cells + 1 || mesh.offsets.front() != 0 ||
      mesh.offsets.back() != static_cast<Index>(mesh.connectivity.size()))
  {
    throw Error("The mesh's cell offsets do not match its types and connectivity.");
  }

  const auto falls = std::is_sorted_until(mesh.offsets.begin(), mesh.offsets.end());
  if (falls != mesh.offsets.end())
  {
    throw Error("The mesh's cell offsets decrease at cell " +
                std::to_string(falls - mesh.offsets.begin() - 1) + ".");
  }

  std::vector<Index> unknown, wrongSize, wrongNodes;
  for (Index c = 0; c < cells; ++c)
  {
    const Index size = mesh.cellSize(c);
    const CellShape* shape = cellShape(mesh, c);
    if (!shape)
    {
      unknown.push_back(c);
      continue;
    }
    if (shape->numberOfNodes >= 0 && size != shape->numberOfNodes)
    {
      wrongSize.push_back(c);
    }
    for (const Index* node = mesh.cell(c); node != mesh.cell(c) + size; ++node)
    {
      if (*node < 0 || *node >= nodes)
      {
        wrongNodes.push_back(c);
        break;
      }
    }
  }
  if (!unknown.empty())
  {
    const int type = mesh.types[unknown.front()];
    throw Error("Cells of VTK type " + std::to_string(type) +
                (type >= 60 ? " (higher order)" : "") + " cannot be morphed: cell ids " +
                listIds(unknown) +
                ". Use tetrahedra, hexahedra, voxels, wedges, pyramids, their quadratic forms, "
                "Lagrange or Bezier cells of one order up to " +
                std::to_string(HighestOrder) + ", or polyhedra.");
  }
  if (!wrongSize.empty())
  {
    throw Error(
      "Cells with the wrong number of nodes for their type: cell ids " + listIds(wrongSize) + ".");
  }
  if (!wrongNodes.empty() && nodes == 0)
  {
    throw Error("The mesh has " + std::to_string(cells) + " cells but no points.");
  }
  if (!wrongNodes.empty())
  {
    throw Error("Cells that name nodes outside 0 to " + std::to_string(nodes - 1) + ": cell ids " +
                listIds(wrongNodes) + ".");
  }
  requireClosedPolyhedra(mesh);

  std::vector<Index> notFinite;
  for (Index n = 0; n < nodes; ++n)
  {
    if (!mesh.points.row(n).allFinite())
    {
      notFinite.push_back(n);
    }
  }
  if (notFinite.empty())
  {
    return;
  }
  std::vector<std::uint8_t> isUsed(nodes, 0);
  for (Index c = 0; c < cells; ++c)
  {
    for (Index k = 0; mesh.types[c] != EmptyCell && k < mesh.cellSize(c); ++k)
    {
      isUsed[mesh.cell(c)[k]] = 1;
    }
  }
  notFinite.erase(std::remove_if(notFinite.begin(), notFinite.end(),
                    [&](Index node) { return isUsed[node] == 0; }),
    notFinite.end());
  if (!notFinite.empty())
  {
    throw Error("Coordinates that are not finite (NaN or infinite) at node ids " +
                listIds(notFinite) + ". Correct them, or remove their cells.");
  }
}

void requireIndexable(Index nodes, Index cells, Index corners)
{
  constexpr Index Limit = (Index(1) << 31) - (Index(1) << 20);
  const auto require = [](Index count, const char* of)
  {
    if (count >= Limit)
    {
      throw Error("The mesh is too large: it has " + std::to_string(count) + " " + of +
                  ", and the methods can number fewer than " + std::to_string(Limit) +
                  ". Morph it in parts.");
    }
  };
  require(nodes, "nodes");
  require(cells, "cells");
  require(corners, "corners of cells");
}

void requireIndexable(const Mesh& mesh)
{
  requireIndexable(
    mesh.numberOfNodes(), mesh.numberOfCells(), static_cast<Index>(mesh.connectivity.size()));
}

bool isModerate(const Eigen::RowVector3d& x)
{
  // Written so that a NaN is not moderate.
  return (x.array().abs() <= LargestLength).all();
}

std::vector<Index> immoderateRows(const Points& x, Monitor* monitor)
{
  std::vector<Index> rows;
  // Nearly always none: told without a branch for each value.
  std::atomic<bool> areModerate = true;
  Monitor serial;
  (monitor ? *monitor : serial)
    .parallelFor(x.size(), 16384,
      [&](Index first, Index last)
      {
        bool isModerate = true;
        for (const double* value = x.data() + first; value != x.data() + last; ++value)
        {
          isModerate &= std::abs(*value) <= LargestLength; // a NaN is not
        }
        if (!isModerate)
        {
          areModerate = false;
        }
      });
  if (areModerate)
  {
    return rows;
  }
  for (Index i = 0; i < x.rows(); ++i)
  {
    if (!isModerate(x.row(i)))
    {
      rows.push_back(i);
    }
  }
  return rows;
}

double meshSize(const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; volumeShape(mesh, c) && k < mesh.cellSize(c); ++k)
    {
      box.extend(mesh.points.row(mesh.cell(c)[k]).transpose());
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().stableNorm();
}

void requireExtent(double size, const char* subject)
{
  if (size > 0 && size < SmallestLength)
  {
    std::ostringstream text;
    text << subject << " is only " << size
         << " long, less than 1e-50. Use another unit, or correct its coordinates.";
    throw Error(text.str());
  }
}

void requireVolumeCells(const Mesh& mesh)
{
  if (mesh.numberOfCells() == 0)
  {
    throw Error("The input has no cells, so there is nothing to morph.");
  }
  if (std::none_of(mesh.types.begin(), mesh.types.end(),
        [](std::uint8_t type) { return cellShape(type)->dimension == 3; }))
  {
    throw Error("None of the input's " + std::to_string(mesh.numberOfCells()) +
                " cells is a volume cell (the first is a " + cellShape(mesh.types.front())->name +
                "). Tetrahedra, hexahedra, wedges or pyramids are needed.");
  }
  requireExtent(meshSize(mesh), "The input's volume mesh");
}
}
