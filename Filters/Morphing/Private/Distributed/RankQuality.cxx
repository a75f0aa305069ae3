// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankQuality.h"

#include "Distributed/Quality.h"
#include "Mesh/CellShape.h"
#include "Session/Validity.h"

#include <algorithm>

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

std::string Found(
  const DistributedMesh& mesh, const Measured& measured, const morph::Points& points)
{
  std::vector<morph::Validity::BadCell> worst = mesh.ranks().gatherSorted(
    morph::Validity::worst(mesh.mesh(), measured.Added, measured.Mine, points, &mesh.cellIds()));
  worst.resize(std::min(worst.size(), morph::Validity::mostNamed));
  return morph::Validity::found(measured.AddedOfAll, measured.Bad(), worst);
}
}
