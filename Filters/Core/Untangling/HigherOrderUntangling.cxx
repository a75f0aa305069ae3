// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/HigherOrderUntangling.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Optimization/Minimizers.h"
#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>

namespace morph
{
namespace
{
/// What each coefficient is to reach, in units of six times the volume of the straight cell. Half
/// of it is enough. From 0.03 to 0.1 it leaves as few cells within 6 %, from 0.2 on more.
constexpr double Margin = 0.1;
constexpr int Steps = 100; // of the minimizer; three times as many leave as many cells

using Vector = Eigen::Vector3d;

/// Returns six times the volume of the cell through the corners.
double straightVolume(
  const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index cell, const Points& points)
{
  const CellShape& shape = *cellShape(mesh, cell);
  double corners[8][3];
  copyCorners(mesh, cell, shape, points, corners[0]);
  return 6 * orientation[cell] * signedVolume(shape.shape, corners);
}

/// Returns the cells whose certificate says so, ascending.
std::vector<Index> invertedCells(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<std::uint8_t>& skip, const Points& points, Monitor& monitor)
{
  std::vector<Index> cells;
  const CertificateReport report = certify(mesh, points, orientation, skip, monitor);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (report.cells[c] == Certificate::Inverted)
    {
      cells.push_back(c);
    }
  }
  return cells;
}

/// Returns those of the ascending `nodes` that cells have, ascending.
std::vector<Index> nodesOf(
  const Mesh& mesh, const std::vector<Index>& cells, const std::vector<Index>& nodes)
{
  std::vector<Index> result;
  for (const Index c : cells)
  {
    std::copy_if(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c), std::back_inserter(result),
      [&](Index node) { return std::binary_search(nodes.begin(), nodes.end(), node); });
  }
  sortUnique(result);
  return result;
}

/// The sum of the squares of what the Bernstein coefficients of cells lack of their margin.
class CoefficientPenalty : public Objective
{
public:
  /// `cells`: quadratic ones with a positive straight volume; `free`: ascending.
  CoefficientPenalty(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& cells, const std::vector<Index>& free, const Points& points,
    const Communicator& processes)
    : mesh_(mesh)
    , orientation_(orientation)
    , cells_(cells)
    , free_(free)
    , row_(mesh.numberOfNodes(), -1)
  {
    this->share(processes, free, Eigen::RowVector3d::Zero(), {});
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      this->row_[free[i]] = static_cast<Index>(i);
    }
    for (const Index c : cells)
    {
      this->volume_.push_back(straightVolume(mesh, orientation, c, points));
    }
  }

  const std::vector<Index>& free() const override { return this->free_; }

  Value value(const Points& points, Monitor& monitor) const override
  {
    std::vector<double> least(this->cells_.size() + 1, Margin); // of no cells, too
    const double energy = reproducibleSum(this->size(), monitor, 0.,
      [&](Index i)
      {
        BernsteinHalving::Coefficients lack;
        this->lack(i, points, lack);
        const auto end = lack.begin() + this->map(i).terms();
        least[i] = Margin - *std::max_element(lack.begin(), end);
        return std::inner_product(lack.begin(), end, lack.begin(), 0.);
      });
    const double worst =
      this->communicator().minimum(*std::min_element(least.begin(), least.end()));
    return { this->communicator().sum(energy), true, worst >= Margin / 2 };
  }

  void gradient(const Points& points, Points& result, Monitor& monitor) const override
  {
    std::vector<std::array<Vector, CellMap::MostNodes>> parts(this->cells_.size());
    parallel(this->size(), 16, monitor,
      [&](Index i)
      {
        BernsteinHalving::Coefficients lack;
        const CellMap::Derivatives derivatives = this->lack(i, points, lack);
        for (double& c : lack)
        {
          c *= -2 / this->volume_[i];
        }
        this->map(i).gradient(derivatives, lack, parts[i].data());
      });
    result.setZero(static_cast<Index>(this->free_.size()), 3);
    for (Index i = 0; i < this->size(); ++i)
    {
      const Index c = this->cells_[i];
      for (int k = 0; k < this->map(i).numberOfNodes(); ++k)
      {
        const Index row = this->row_[this->mesh_.cell(c)[k]];
        if (row >= 0)
        {
          parts[i][k][2] *= this->orientation_[c];
          result.row(row) += parts[i][k].transpose();
        }
      }
    }
    this->rows().add(result);
  }

private:
  Index size() const { return static_cast<Index>(this->cells_.size()); }
  const CellMap& map(Index i) const { return *CellMap::find(this->mesh_.types[this->cells_[i]]); }

  /// Computes what each coefficient of a cell lacks.
  CellMap::Derivatives lack(
    Index i, const Points& points, BernsteinHalving::Coefficients& result) const
  {
    const CellMap& map = this->map(i);
    Vector x[CellMap::MostNodes];
    for (int k = 0; k < map.numberOfNodes(); ++k)
    {
      x[k] = points.row(this->mesh_.cell(this->cells_[i])[k]).transpose();
      x[k][2] *= this->orientation_[this->cells_[i]]; // a mirrored cell as its mirror image
    }
    const CellMap::Derivatives derivatives = map.derivatives(x);
    result.fill(0);
    map.determinant(derivatives, 0, result);
    for (int k = 0; k < map.terms(); ++k)
    {
      result[k] = std::max(0., Margin - result[k] / this->volume_[i]);
    }
    return derivatives;
  }

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const std::vector<Index>& cells_;
  const std::vector<Index>& free_;
  std::vector<Index> row_;     ///< #nodes; -1 where fixed
  std::vector<double> volume_; ///< #cells: six times the straight one
};
}

void untangleHigherOrder(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, Points& points, Monitor& monitor,
  const Communicator& processes)
{
  if (processes.all(partition.higherOrderNodes.empty()))
  {
    return;
  }
  std::vector<std::uint8_t> skip(mesh.numberOfCells());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh, c);
    skip[c] = !shape || !isQuadraticVolume(*shape) || hasFaces(mesh, c) ||
              !(straightVolume(mesh, orientation, c, points) > 0);
  }
  const std::vector<Index> before = invertedCells(mesh, orientation, skip, points, monitor);
  std::vector<Index> free = nodesOf(mesh, before, partition.higherOrderNodes);
  processes.spread(free);
  std::sort(free.begin(), free.end());
  if (processes.all(free.empty()))
  {
    return;
  }
  // All other cells keep their certificates.
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    skip[c] = skip[c] != 0 || nodesOf(mesh, { c }, free).empty();
    if (skip[c] == 0)
    {
      cells.push_back(c);
    }
  }
  Points trial = points;
  MinimizerEffort effort;
  MinimizerLimits limits;
  limits.steps = Steps;
  limitedMemoryBfgs(CoefficientPenalty(mesh, orientation, cells, free, points, processes), trial,
    limits, effort, monitor);
  const auto count = [&](const std::vector<Index>& some)
  { return processes.sum(static_cast<Index>(some.size())); };
  if (count(invertedCells(mesh, orientation, skip, trial, monitor)) < count(before))
  {
    points.swap(trial);
  }
}
}
