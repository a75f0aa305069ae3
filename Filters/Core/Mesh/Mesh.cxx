// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Mesh.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Support/Error.h"

#include <algorithm>

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
}
