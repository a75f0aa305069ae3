// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ShapeVolumes.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Parallel.h"

namespace morph
{
namespace
{
std::size_t slot(const ConnectedComponents& bodies, Index cell, Shape shape)
{
  return static_cast<std::size_t>(bodies.ofCell[cell]) * ShapeVolumes::Shapes +
         static_cast<std::size_t>(shape);
}
}

const int ShapeVolumes::Shapes = static_cast<int>(Shape::Polyhedron) + 1;

ShapeVolumes shapeVolumes(const Mesh& mesh, const ConnectedComponents& bodies, Monitor& monitor,
  const Communicator& processes)
{
  std::vector<double> volume(mesh.numberOfCells(), 0.);
  parallel(mesh.numberOfCells(), monitor,
    [&](Index c)
    {
      if (isPolyhedron(mesh, c))
      {
        volume[c] = polyhedronVolume(mesh, c, mesh.points);
      }
      else if (const CellShape* shape = volumeShape(mesh, c))
      {
        double corners[8][3];
        copyCorners(mesh, c, *shape, mesh.points, corners[0]);
        volume[c] = signedVolume(shape->shape, corners);
      }
    });
  ShapeVolumes sums;
  sums.volume.assign(bodies.count * ShapeVolumes::Shapes, 0);
  sums.cells.assign(sums.volume.size(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (const CellShape* shape = processes.isCopy(c) ? nullptr : volumeShape(mesh, c))
    {
      const std::size_t at = slot(bodies, c, shape->shape);
      sums.volume[at] += volume[c];
      ++sums.cells[at];
    }
  }
  processes.sum(sums.volume.data(), static_cast<int>(sums.volume.size()));
  processes.sum(sums.cells.data(), static_cast<int>(sums.cells.size()));
  return sums;
}

std::vector<std::int8_t> cellSigns(
  const Mesh& mesh, const ConnectedComponents& bodies, const ShapeVolumes& volumes)
{
  std::vector<std::int8_t> result(mesh.numberOfCells(), 1);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (const CellShape* shape = volumeShape(mesh, c))
    {
      const std::size_t at = slot(bodies, c, shape->shape);
      if (volumes.volume[at] < 0 && (volumes.cells[at] > 1 || shape->shape == Shape::Wedge))
      {
        result[c] = -1;
      }
    }
  }
  return result;
}
}
