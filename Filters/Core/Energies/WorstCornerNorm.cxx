// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/WorstCornerNorm.h"

#include "Energies/BatchReductions.h"
#include "Energies/CellBatchKernel.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/UnknownOrdering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using namespace foldover;
using Corners = WorstCornerNorm::Corners;

/// A tetrahedron's corners in positive order; the decomposition has only one of them.
constexpr WeightedTet TetCorners[4] = { { { 0, 1, 2, 3 }, 1 }, { { 1, 2, 0, 3 }, 1 },
  { { 2, 0, 1, 3 }, 1 }, { { 3, 0, 2, 1 }, 1 } };

SimplicialDecomposition cornerTets(Shape shape)
{
  return shape == Shape::Tet ? SimplicialDecomposition{ 4, TetCorners }
                             : SimplicialDecomposition{ cornerTetrahedra(shape),
                                 simplicialDecomposition(shape).tets };
}

/// Returns the factor that makes s 1 in the cell of scaled Jacobian 1.
double scaleOf(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
    case Shape::Pyramid:
      return std::sqrt(2.);
    case Shape::Wedge:
      return 2 / std::sqrt(3.);
    default:
      return 1;
  }
}

/// Computes the 2^squarings-th power of 1 / s from its square, in place.
MORPH_SIMD_INLINE void raise(int squarings, SimdDouble4& power)
{
  if (squarings == 0)
  {
    power = squareRoot(power);
  }
  for (int k = 1; k < squarings; ++k)
  {
    power *= power;
  }
}

/// Makes `power` infinite where the cell is inverted or flat, and 0 where it is left out.
MORPH_SIMD_INLINE void exclude(
  const SimdDouble4& signedVolume, const SimdDouble4& unit, SimdDouble4& power)
{
  const SimdDouble4 zero = {}, infinity = zero + std::numeric_limits<double>::infinity();
  power = select(signedVolume > 0., power, select(unit == 0., zero, infinity));
}

/// One corner of each cell.
struct Corner
{
  SimdMatrix edges, normals; ///< the normals of pairs of edges are the determinant's gradient
  SimdDouble4 byDeterminant, bySquare[3]; ///< reciprocals
  SimdDouble4 ofAngles, ofEdge[3], all;   ///< the summands of (least / s)^2, and their sum
  SimdDouble4 power[1];                   ///< of 1 / s

  MORPH_SIMD_INLINE Corner(const SimdVector (&x)[8], const int* corner,
    const WorstCornerNorm::Scales& scales, int squarings)
  {
    const SimdDouble4 unit = load(scales.unit);
    SimdDouble4 determinant, squares[3];
    edgesOf(x, corner, this->edges);
    cofactor(this->edges, this->normals);
    dot(this->edges[0], this->normals[0], determinant);
    for (int k = 0; k < 3; ++k)
    {
      dot(this->edges[k], this->edges[k], squares[k]);
    }
    const SimdDouble4 one = SimdDouble4{} + 1.;
    const SimdDouble4 product = squares[0] * squares[1] * squares[2];
    const SimdDouble4 both = determinant * product;
    const SimdDouble4 inverse = 1. / select(both == 0., one, both);
    this->byDeterminant = inverse * product;
    const SimdDouble4 ratio = unit * this->byDeterminant, byProduct = inverse * determinant;
    this->ofAngles = ratio * ratio * product;
    this->all = this->ofAngles;
    for (int k = 0; k < 3; ++k)
    {
      this->bySquare[k] = byProduct * squares[(k + 1) % 3] * squares[(k + 2) % 3];
      const SimdDouble4 square = load(scales.shortest[k]) * this->bySquare[k];
      const SimdDouble4 fourth = square * square;
      this->ofEdge[k] = fourth * fourth;
      this->all += this->ofEdge[k];
    }
    this->power[0] = this->all;
    raise(squarings, this->power[0]);
    exclude(unit * both, unit, this->power[0]);
  }
};

/// The four corners of a tetrahedron, which have one determinant and share their edges.
struct Tetrahedron
{
  static constexpr int Ends[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 2, 3 }, { 1, 3 }, { 1, 2 } };
  SimdVector edges[6]; ///< edge k + 3 is opposite to edge k
  SimdDouble4 squares[6], byDeterminant, power[4];

  MORPH_SIMD_INLINE Tetrahedron(
    const SimdVector (&x)[8], const SimdDouble4& unit, int squarings, SimdMatrix& normals)
  {
    for (int k = 0; k < 6; ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->edges[k][i] = x[Ends[k][1]][i] - x[Ends[k][0]][i];
      }
      dot(this->edges[k], this->edges[k], this->squares[k]);
    }
    for (int k = 0; k < 3; ++k)
    {
      cross(this->edges[(k + 1) % 3], this->edges[(k + 2) % 3], normals[k]);
    }
    SimdDouble4 determinant;
    dot(this->edges[0], normals[0], determinant);
    const SimdDouble4 one = SimdDouble4{} + 1.;
    this->byDeterminant = 1. / select(determinant == 0., one, determinant);
    const SimdDouble4 ratio = unit * this->byDeterminant, square = ratio * ratio;
    const SimdDouble4* l = this->squares;
    this->power[0] = square * (l[0] * l[1] * l[2]);
    this->power[1] = square * (l[0] * l[4] * l[5]);
    this->power[2] = square * (l[1] * l[3] * l[5]);
    this->power[3] = square * (l[2] * l[3] * l[4]);
    for (SimdDouble4& power : this->power)
    {
      raise(squarings, power);
      exclude(unit * determinant, unit, power);
    }
  }
};

MORPH_SIMD_INLINE const WorstCornerNorm::Scales* scalesOf(
  const CellBatches& batches, Index batch, const Corners& corners)
{
  return corners.scales.data() + batches.firstPlace(batch) / SimdWidth;
}

Corners scaledCorners(const CellBatches& batches, const std::vector<std::int8_t>& orientation,
  double least, int squarings)
{
  Corners result;
  result.squarings = squarings;
  result.scales.resize(batches.places() / SimdWidth);
  for (Index batch = 0; batch < batches.size(); ++batch)
  {
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    WorstCornerNorm::Scales* scales = result.scales.data() + batches.firstPlace(batch) / SimdWidth;
    for (int lane = 0; lane < batches.cells(batch); ++lane)
    {
      for (int t = 0; t < parts.count; ++t)
      {
        if (batches.moves(batch, lane, parts.tets[t].corner))
        {
          scales[t].unit[lane] =
            orientation[batches.cell(batch, lane)] * least / scaleOf(batches.shape(batch));
          ++result.count;
        }
      }
    }
  }
  return result;
}

// An edge is short at this part of its undeformed length, once the cell has its size in the mesh
// that the search starts from, or at that part of its length there.
constexpr double ShortOfUndeformed = 0.1, ShortOfStart = 0.8;

/// Sets the short lengths of one cell. Edges between prescribed nodes have none.
void keepEdgesOf(const CellBatches& batches, Index batch, int lane, const Points& undeformed,
  const Points& start, WorstCornerNorm::Scales* scales)
{
  const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
  const auto place = [&](int a) { return a * SimdWidth + lane; };
  const auto length = [&](const Points& points, const int* corner, int k)
  {
    const std::int32_t* nodes = batches.nodes(batch);
    return (points.row(nodes[place(corner[k + 1])]) - points.row(nodes[place(corner[0])])).norm();
  };
  double before = 0, now = 0;
  for (int t = 0; t < parts.count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      before += length(undeformed, parts.tets[t].corner, k);
      now += length(start, parts.tets[t].corner, k);
    }
  }
  const Index first = batches.firstPlace(batch);
  for (int t = 0; t < parts.count && before > 0; ++t)
  {
    const int* corner = parts.tets[t].corner;
    for (int k = 0; k < 3; ++k)
    {
      if (batches.row(first + place(corner[0])) >= 0 ||
          batches.row(first + place(corner[k + 1])) >= 0)
      {
        const double shortest =
          std::min(ShortOfUndeformed * now / before * length(undeformed, corner, k),
            ShortOfStart * length(start, corner, k));
        scales[t].shortest[k][lane] = shortest * shortest;
      }
    }
  }
}
}

/// Powers of all corners, by lane. Doubles, as memory of a vector is aligned for no wider ones.
struct WorstCornerNorm::Sum
{
  double lanes[SimdWidth] = {}, largest[SimdWidth] = {};

  Sum& operator+=(const Sum& other)
  {
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      this->lanes[lane] += other.lanes[lane];
      this->largest[lane] = std::max(this->largest[lane], other.largest[lane]);
    }
    return *this;
  }

  template <int Count>
  MORPH_SIMD_INLINE void add(const SimdDouble4 (&powers)[Count])
  {
    SimdDouble4 sum = {}, most = load(this->largest);
    for (const SimdDouble4& power : powers)
    {
      sum += power;
      most = select(power > most, power, most);
    }
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      this->lanes[lane] += sum[lane];
      this->largest[lane] = most[lane];
    }
  }
};

struct WorstCornerNorm::BatchValue
{
  static MORPH_SIMD_INLINE void run(
    Index batch, const CellBatches& batches, const Corners& corners, const Points& points, Sum& sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const WorstCornerNorm::Scales* scales = scalesOf(batches, batch, corners);
    if (batches.shape(batch) == Shape::Tet)
    {
      SimdMatrix normals;
      const Tetrahedron own(x, load(scales->unit), corners.squarings, normals);
      sum.add(own.power);
      return;
    }
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    for (int t = 0; t < parts.count; ++t)
    {
      const Corner own(x, parts.tets[t].corner, scales[t], corners.squarings);
      sum.add(own.power);
    }
  }
};

/// The value, and the gradient at the corners, at their places in `forces`.
struct WorstCornerNorm::BatchGradient
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Corners& corners,
    const Points& points, Points& forces, Sum& value)
  {
    SimdVector x[8], sum[8] = {};
    cornersOf(batches, batch, points, x);
    const WorstCornerNorm::Scales* scales = scalesOf(batches, batch, corners);
    const double mean = (1 << corners.squarings) / static_cast<double>(corners.count);
    if (batches.shape(batch) == Shape::Tet)
    {
      addTetrahedron(x, load(scales->unit), corners.squarings, mean, sum, value);
      storeAtPlaces(batches, batch, sum, forces);
      return;
    }
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    for (int t = 0; t < parts.count; ++t)
    {
      addCorner(x, parts.tets[t].corner, scales[t], corners.squarings, mean, sum, value);
    }
    storeAtPlaces(batches, batch, sum, forces);
  }

private:
  static MORPH_SIMD_INLINE void addTetrahedron(const SimdVector (&x)[8], const SimdDouble4& unit,
    int squarings, double mean, SimdVector (&sum)[8], Sum& value)
  {
    SimdMatrix normals;
    const Tetrahedron own(x, unit, squarings, normals);
    const SimdDouble4 all = (own.power[0] + own.power[1]) + (own.power[2] + own.power[3]);
    value.add(own.power);
    const SimdDouble4 byVolume = mean * all * own.byDeterminant, one = SimdDouble4{} + 1.;
    for (int k = 0; k < 3; ++k)
    {
      const SimdDouble4 both = own.squares[k] * own.squares[k + 3];
      const SimdDouble4 inverse = mean / select(both == 0., one, both);
      const SimdDouble4 byLength[2] = { inverse * own.squares[k + 3], inverse * own.squares[k] };
      for (int side = 0; side < 2; ++side)
      {
        const int edge = k + 3 * side;
        const int from = Tetrahedron::Ends[edge][0], to = Tetrahedron::Ends[edge][1];
        const SimdDouble4 factor = byLength[side] * (own.power[from] + own.power[to]);
        for (int i = 0; i < 3; ++i)
        {
          const SimdDouble4 force = factor * own.edges[edge][i];
          sum[to][i] += force;
          sum[from][i] -= force;
        }
      }
      for (int i = 0; i < 3; ++i)
      {
        const SimdDouble4 force = byVolume * normals[k][i];
        sum[k + 1][i] -= force;
        sum[0][i] += force;
      }
    }
  }

  static MORPH_SIMD_INLINE void addCorner(const SimdVector (&x)[8], const int* corner,
    const WorstCornerNorm::Scales& scales, int squarings, double mean, SimdVector (&sum)[8],
    Sum& value)
  {
    const Corner own(x, corner, scales, squarings);
    value.add(own.power);
    const SimdDouble4 one = SimdDouble4{} + 1.;
    const SimdDouble4 factor = mean * own.power[0] / select(own.all == 0., one, own.all);
    const SimdDouble4 byDeterminant = factor * own.ofAngles * own.byDeterminant;
    SimdVector all = {};
    for (int k = 0; k < 3; ++k)
    {
      const SimdDouble4 byLength = factor * (own.ofAngles - 4. * own.ofEdge[k]) * own.bySquare[k];
      for (int i = 0; i < 3; ++i)
      {
        const SimdDouble4 force = byLength * own.edges[k][i] - byDeterminant * own.normals[k][i];
        sum[corner[k + 1]][i] += force;
        all[i] += force;
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      sum[corner[0]][i] -= all[i];
    }
  }
};

namespace
{
/// Returns x to the power of 2^times. std::pow() would have other bits on other processors.
double squared(double x, int times)
{
  for (int k = 0; k < times; ++k)
  {
    x *= x;
  }
  return x;
}
}

WorstCornerNorm::WorstCornerNorm(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& cells, const std::vector<Index>& free, double least, int squarings,
  double goal, const Communicator& communicator)
  : free_(unknownOrdering(mesh, free))
  , batches_(mesh, this->free_, cells)
  , corners_(scaledCorners(this->batches_, orientation, least, squarings))
{
  this->corners_.enough = squared(least / goal, squarings);
  this->share(communicator, this->free_);
  this->corners_.count = std::max<Index>(1, communicator.sum(this->corners_.count));
}

void WorstCornerNorm::keepEdges(const Mesh& shapes, const Points& start)
{
  for (Index batch = 0; batch < this->batches_.size(); ++batch)
  {
    if (this->batches_.shape(batch) == Shape::Tet)
    {
      continue;
    }
    Scales* scales = this->corners_.scales.data() + this->batches_.firstPlace(batch) / SimdWidth;
    for (int lane = 0; lane < this->batches_.cells(batch); ++lane)
    {
      keepEdgesOf(this->batches_, batch, lane, shapes.points, start, scales);
    }
  }
}

Objective::Value WorstCornerNorm::valueOf(const Sum& sum) const
{
  const Communicator& processes = this->communicator();
  const double all = processes.sum((sum.lanes[0] + sum.lanes[1]) + (sum.lanes[2] + sum.lanes[3]));
  const double largest = processes.maximum(*std::max_element(sum.largest, sum.largest + SimdWidth));
  double mean = all / static_cast<double>(this->corners_.count);
  for (int k = 0; k < this->corners_.squarings; ++k)
  {
    mean = std::sqrt(mean);
  }
  return { mean, std::isfinite(all), largest <= this->corners_.enough };
}

Objective::Value WorstCornerNorm::value(const Points& points, Monitor& monitor) const
{
  return this->valueOf(
    sumOverBatches<BatchValue, Sum>(this->batches_, monitor, this->corners_, points));
}

void WorstCornerNorm::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  this->valueAndGradient(points, result, monitor);
}

Objective::Value WorstCornerNorm::valueAndGradient(
  const Points& points, Points& result, Monitor& monitor) const
{
  const Value value = this->valueOf(sumAndGather<BatchGradient, Sum>(
    this->batches_, this->parts_, result, monitor, this->corners_, points));
  this->rows().add(result);
  if (value.energy > 0 && std::isfinite(value.energy))
  {
    // p times the mean's gradient becomes the norm's
    const double mean = squared(value.energy, this->corners_.squarings);
    result *= mean > 0 ? value.energy / mean / (1 << this->corners_.squarings) : 0;
  }
  return value;
}
}
