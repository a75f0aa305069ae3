// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankQuality.h"

#include "Distributed/Quality.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"

#include <algorithm>
#include <sstream>
#include <tuple>

namespace morph::filters::RankQuality
{
using morph::distributed::DistributedMesh;

Measured Measure(const DistributedMesh& mesh, const morph::Points& points,
  const morph::InvertedBefore& before, morph::Monitor& monitor)
{
  std::vector<std::uint8_t> skip = mesh.isGhost();
  for (std::size_t c = 0; c < skip.size(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.mesh().types[c]);
    skip[c] |= !shape || shape->dimension < 3;
  }
  Measured result;
  mesh.ranks().together(
    [&]
    {
      result.Mine = morph::measureQuality(mesh.mesh(), points, mesh.orientation(), skip, monitor);
      result.Added = before.added(points, morph::invertedCells(result.Mine));
    });
  result.AddedOfAll = mesh.ranks().sum(static_cast<morph::Index>(result.Added.size()));
  result.Whole = morph::distributed::reduce(mesh.ranks(), result.Mine, mesh.cellIds());
  return result;
}

std::vector<morph::Index> GatherIds(
  const DistributedMesh& mesh, const std::vector<morph::Index>& cells)
{
  std::vector<morph::Index> ids;
  for (const morph::Index cell : cells)
  {
    if (mesh.isGhost()[cell] == 0)
    {
      ids.push_back(mesh.cellId(cell));
    }
  }
  ids = mesh.ranks().gather(ids);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::string Found(
  const DistributedMesh& mesh, const Measured& measured, const morph::Points& points)
{
  struct Line
  {
    double jacobian;
    std::int64_t id;
    double center[3];
  };
  constexpr std::size_t Most = 10;
  const auto before = [](const Line& a, const Line& b)
  { return std::tie(a.jacobian, a.id) < std::tie(b.jacobian, b.id); };
  std::vector<Line> lines;
  for (const morph::Index cell : measured.Added)
  {
    const morph::Index corners =
      morph::cornerCount(mesh.mesh(), cell, *morph::cellShape(mesh.mesh().types[cell]));
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    for (morph::Index k = 0; k < corners; ++k)
    {
      center += points.row(mesh.mesh().cell(cell)[k]) / static_cast<double>(corners);
    }
    lines.push_back({ measured.Mine.scaledJacobian[cell], mesh.cellId(cell),
      { center[0], center[1], center[2] } });
  }
  const auto keepWorst = [&]
  {
    std::sort(lines.begin(), lines.end(), before);
    lines.resize(std::min(lines.size(), Most));
  };
  keepWorst();
  lines = mesh.ranks().gather(lines);
  keepWorst();
  std::ostringstream text;
  text << measured.AddedOfAll << " cells are inverted or degenerate"
       << (measured.AddedOfAll == measured.Bad() ? "" : " by the motion")
       << ". The worst, with their centers:";
  for (const Line& line : lines)
  {
    text << "\n  cell " << line.id << " at (" << line.center[0] << ", " << line.center[1] << ", "
         << line.center[2] << "), scaled Jacobian " << line.jacobian;
  }
  text << (measured.AddedOfAll > static_cast<morph::Index>(lines.size()) ? "\n  ...\n" : "\n");
  return text.str();
}
}
