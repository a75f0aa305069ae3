// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/ElementMatrices.h"

#include "LinearMethods/ElementStiffness.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Quality/ScaledJacobian.h"
#include "Solvers/RowChunks.h"
#include "Support/HugePages.h"

#include <cmath>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr int MostBands = 8;
constexpr Index LeastRows = ChunkRows * ChunksOfArena; // of a band

/// Sets K of a star, eliminates its centre, and sets the centre's weights. Returns false where the
/// centre has no stiffness.
bool starMatrix(const Mesh& mesh, const Adjacency& around, CellMatrix& cell, CentreStars& stars,
  Index star, double* K)
{
  const Index* nodes = stars.nodes().begin(star);
  const auto n = static_cast<int>(stars.nodes().end(star) - nodes);
  double sum[CentreStars::MostNodes + 1][CentreStars::MostNodes + 1] = {}; // the centre is last
  const Index centre = stars.centre(star);
  for (const Index* c = around.begin(centre); c != around.end(centre); ++c)
  {
    double part[triangleSize(8)];
    cell.compute(*c, part);
    const CellShape& shape = *cellShape(mesh.types[*c]);
    int place[8];
    for (int a = 0; a < shape.numberOfCorners; ++a)
    {
      const Index node = mesh.cell(*c)[shape.cornerNode[a]];
      place[a] =
        node == centre ? n : static_cast<int>(std::lower_bound(nodes, nodes + n, node) - nodes);
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
  const CellShape& shape = *cellShape(this->mesh_.types[c]);
  double corners[8][3];
  copyCorners(this->mesh_, c, shape, this->mesh_.points, corners[0]);
  const int sign = elementStiffness(shape.shape, corners, K);
  this->sign_[c] = static_cast<std::int8_t>(sign);
  if (!this->factors_.empty())
  {
    Eigen::Map<Eigen::ArrayXd>(K, triangleSize(numberOfCorners(shape.shape))) *= this->factors_[c];
  }
  // The sign of a tetrahedron or pyramid is that of its corners.
  const bool isElsewhere = shape.shape == Shape::Hex || shape.shape == Shape::Wedge;
  this->isBad_[c] = sign != 1 || (isElsewhere && !areCornersSurelyPositive(shape.shape, corners) &&
                                   !(scaledJacobian(this->mesh_.types[c], corners) > 0));
}

bool CellMatrix::isAnyBad() const
{
  return std::find(this->isBad_.begin(), this->isBad_.end(), 1) != this->isBad_.end();
}

Matrices starMatrices(const Mesh& mesh, const Adjacency& around, CellMatrix& cell,
  CentreStars& stars, std::vector<Index>& singularCentres, Monitor& monitor)
{
  Matrices result;
  Index entries = 0;
  for (Index s = 0; s < stars.size(); ++s)
  {
    result.start.push_back(entries);
    entries += triangleSize(static_cast<int>(stars.nodes().end(s) - stars.nodes().begin(s)));
  }
  resizeUndefined(result.K, entries);
  std::vector<std::uint8_t> isUsable(stars.size(), 1);
  monitor.parallelFor(stars.size(), Grain,
    [&](Index first, Index last)
    {
      for (Index s = first; s < last; ++s)
      {
        isUsable[s] = starMatrix(mesh, around, cell, stars, s, result.of(s));
      }
    });
  for (Index s = 0; s < stars.size(); ++s)
  {
    if (!isUsable[s])
    {
      singularCentres.push_back(stars.centre(s));
    }
  }
  return result;
}

CellMatrices::CellMatrices(const Mesh& mesh, const std::vector<int>& starOf,
  const std::vector<int>& column, Index rows, CellMatrix& cell, Monitor& monitor)
  : mesh_(mesh)
  , cell_(cell)
  , bandRows_((rows / MostBands / LeastRows + 1) * LeastRows)
  , rows_(rows)
  , bands_(mesh.numberOfCells())
{
  this->matrices_.start.resize(mesh.numberOfCells());
  monitor.parallelFor(mesh.numberOfCells(), Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const bool isInStar = !starOf.empty() && starOf[c] >= 0;
        this->bands_[c] = isInStar ? Bands() : this->bandsOf(c, column);
      }
    });
  this->findBlocks();
}

void CellMatrices::findBlocks()
{
  this->blocks_.resize(this->size());
  const Index cells = this->mesh_.numberOfCells();
  for (Index first = 0; first < cells; first += Grain)
  {
    std::vector<std::uint8_t> has(this->size(), 0);
    for (Index c = first; c < std::min(cells, first + Grain); ++c)
    {
      for (int band = this->bands_[c].first; band <= this->bands_[c].last; ++band)
      {
        has[band] = 1;
      }
    }
    for (int band = 0; band < this->size(); ++band)
    {
      if (has[band])
      {
        this->blocks_[band].push_back(first / Grain);
      }
    }
  }
}

void CellMatrices::compute(int band, Monitor& monitor)
{
  const Index cells = this->mesh_.numberOfCells();
  const std::vector<Index>& blocks = this->blocks_[band];
  std::vector<Index> blockStart(blocks.size() + 1, 0);
  const auto forCells = [&](const auto& use)
  {
    monitor.parallelFor(static_cast<Index>(blocks.size()), 1,
      [&](Index first, Index last)
      {
        for (Index block = first; block < last; ++block)
        {
          Index at = blockStart[block];
          const Index firstCell = blocks[block] * Grain;
          for (Index c = firstCell; c < std::min(cells, firstCell + Grain); ++c)
          {
            if (this->bands_[c].first <= band && band <= this->bands_[c].last)
            {
              use(c, at);
              at += this->entries(c);
            }
          }
          blockStart[block] = at;
        }
      });
  };
  forCells([](Index, Index) {});
  Index before = 0;
  for (Index& start : blockStart)
  {
    const Index size = start;
    start = before;
    before += size;
  }
  if (before > this->matrices_.K.size())
  {
    this->matrices_.K.resize(0); // lets go of the memory first
    resizeUndefined(this->matrices_.K, before);
  }
  forCells(
    [&](Index c, Index at)
    {
      this->matrices_.start[c] = at;
      this->cell_.compute(c, this->matrices_.of(c));
    });
}

Index CellMatrices::entries(Index cell) const
{
  return triangleSize(numberOfCorners(cellShape(this->mesh_.types[cell])->shape));
}

CellMatrices::Bands CellMatrices::bandsOf(Index cell, const std::vector<int>& column) const
{
  const CellShape& shape = *cellShape(this->mesh_.types[cell]);
  Bands bands;
  for (int k = 0; k < numberOfCorners(shape.shape); ++k)
  {
    const int row = column[this->mesh_.cell(cell)[shape.cornerNode[k]]];
    if (row >= 0 && row < this->rows_)
    {
      const auto band = static_cast<std::int8_t>(this->bandOf(row));
      const bool isFirst = bands.first > bands.last;
      bands.first = isFirst ? band : std::min(bands.first, band);
      bands.last = isFirst ? band : std::max(bands.last, band);
    }
  }
  // A cell without a row is computed for its sign.
  const bool isEmpty = bands.first > bands.last;
  return isEmpty && this->entries(cell) > 0 ? Bands{ 0, 0 } : bands;
}
}
