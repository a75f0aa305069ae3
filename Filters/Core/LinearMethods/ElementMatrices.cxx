// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/ElementMatrices.h"

#include "LinearMethods/ElementStiffness.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/StandingCells.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Parallel.h"

#include <cmath>

namespace morph
{
namespace
{

/// Sets K of a star, eliminates its center, and sets the center's weights. Returns false where the
/// center has no stiffness.
bool starMatrix(const Mesh& mesh, const Adjacency& around, CellMatrix& cell, CenterStars& stars,
  Index star, double* K)
{
  const Index* nodes = stars.nodes().begin(star);
  const auto n = static_cast<int>(stars.nodes().end(star) - nodes);
  double sum[CenterStars::MostNodes + 1][CenterStars::MostNodes + 1] = {}; // the center is last
  const Index center = stars.center(star);
  for (const Index* c = around.begin(center); c != around.end(center); ++c)
  {
    double part[triangleSize(8)];
    cell.compute(*c, part);
    const CellShape& shape = *cellShape(mesh.types[*c]);
    int place[8];
    for (int a = 0; a < shape.numberOfCorners; ++a)
    {
      const Index node = mesh.cell(*c)[shape.cornerNode[a]];
      place[a] =
        node == center ? n : static_cast<int>(std::lower_bound(nodes, nodes + n, node) - nodes);
    }
    for (int a = 0, k = 0; a < shape.numberOfCorners; ++a)
    {
      for (int b = a; b < shape.numberOfCorners; ++b, ++k)
      {
        const bool isTwice = a != b && place[a] == place[b]; // (a, b) and (b, a)
        sum[std::min(place[a], place[b])][std::max(place[a], place[b])] +=
          isTwice ? 2 * part[k] : part[k];
      }
    }
  }
  const double diagonal = sum[n][n];
  const bool isUsable = diagonal > 0 && std::isfinite(diagonal) && std::isfinite(1 / diagonal);
  const double inverse = isUsable ? 1 / diagonal : 0;
  for (int a = 0, k = 0; a < n; ++a)
  {
    stars.weights(star)[a] = -sum[a][n] * inverse;
    for (int b = a; b < n; ++b, ++k)
    {
      K[k] = sum[a][b] + stars.weights(star)[a] * sum[b][n];
    }
  }
  return isUsable;
}

}

CellMatrix::CellMatrix(
  const Mesh& mesh, const std::vector<double>& factors, std::vector<std::int8_t>& sign)
  : mesh_(mesh)
  , factors_(factors)
  , sign_(sign)
  , isBad_(mesh.numberOfCells(), 0)
{
  sign.assign(mesh.numberOfCells(), 1);
}

void CellMatrix::compute(Index c, double* K)
{
  const CellShape& shape = *cellShape(this->mesh_, c);
  double corners[8][3];
  copyStanding(this->mesh_, c, shape, this->mesh_.points, corners[0]);
  const int sign = elementStiffness(shape.shape, corners, K);
  this->sign_[c] = static_cast<std::int8_t>(sign);
  if (!this->factors_.empty())
  {
    Eigen::Map<Eigen::ArrayXd>(K, triangleSize(numberOfCorners(shape.shape))) *= this->factors_[c];
  }
  // The sign of a tetrahedron or pyramid is that of its corners.
  const bool isElsewhere = shape.shape == Shape::Hex || shape.shape == Shape::Wedge;
  this->isBad_[c] = sign != 1 || (isElsewhere && !(scaledJacobian(shape, corners) > 0));
}

bool CellMatrix::isAnyBad() const
{
  return std::find(this->isBad_.begin(), this->isBad_.end(), 1) != this->isBad_.end();
}

Matrices starMatrices(const Mesh& mesh, const Adjacency& around, CellMatrix& cell,
  CenterStars& stars, std::vector<Index>& singularCenters, Monitor& monitor)
{
  Matrices result;
  Index entries = 0;
  for (Index s = 0; s < stars.size(); ++s)
  {
    result.start.push_back(entries);
    entries += triangleSize(static_cast<int>(stars.nodes().end(s) - stars.nodes().begin(s)));
  }
  result.K.resize(entries);
  std::vector<std::uint8_t> isUsable(stars.size(), 1);
  parallel(stars.size(), monitor,
    [&](Index s) { isUsable[s] = starMatrix(mesh, around, cell, stars, s, result.of(s)); });
  for (Index s = 0; s < stars.size(); ++s)
  {
    if (!isUsable[s])
    {
      singularCenters.push_back(stars.center(s));
    }
  }
  return result;
}

Matrices cellMatrices(
  const Mesh& mesh, const std::vector<int>& starOf, CellMatrix& cell, Monitor& monitor)
{
  const auto entriesOf = [&](Index c)
  {
    const bool isInStar = !starOf.empty() && starOf[c] >= 0;
    return isInStar ? 0 : triangleSize(numberOfCorners(cellShape(mesh, c)->shape));
  };
  Matrices result;
  result.start.resize(mesh.numberOfCells());
  Index entries = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    result.start[c] = entries;
    entries += entriesOf(c);
  }
  result.K.resize(entries);
  parallel(mesh.numberOfCells(), monitor,
    [&](Index c)
    {
      if (entriesOf(c) > 0)
      {
        cell.compute(c, result.of(c));
      }
    });
  return result;
}
}
