// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Extent.h"

#include "Mesh/CellShape.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <string>

namespace morph
{
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
