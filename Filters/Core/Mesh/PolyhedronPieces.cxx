// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/PolyhedronPieces.h"

#include "Mesh/FaceTable.h"
#include "Mesh/Mesh.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <utility>

namespace morph
{
namespace
{
constexpr double LeastSine = 0.1; // of a corner of a quadrilateral that stays whole
constexpr Index Whole = -1;       // a face without a node at its center

Eigen::RowVector3d doubleArea(const Mesh& mesh, const Index* nodes, Index size)
{
  Eigen::RowVector3d area = Eigen::RowVector3d::Zero();
  for (Index k = 2; k < size; ++k)
  {
    const Eigen::RowVector3d a = mesh.points.row(nodes[k - 1]) - mesh.points.row(nodes[0]);
    const Eigen::RowVector3d b = mesh.points.row(nodes[k]) - mesh.points.row(nodes[0]);
    area += a.cross(b);
  }
  return area;
}

/// Whether each corner turns clearly to the inside. A node in the middle of a side does not.
bool isPlain(const Mesh& mesh, const Index* nodes, Index size)
{
  const Eigen::RowVector3d normal = doubleArea(mesh, nodes, size).normalized();
  for (Index k = 0; k < size; ++k)
  {
    const Eigen::RowVector3d x = mesh.points.row(nodes[k]);
    const Eigen::RowVector3d next = mesh.points.row(nodes[(k + 1) % size]) - x;
    const Eigen::RowVector3d last = mesh.points.row(nodes[(k + size - 1) % size]) - x;
    if (!(next.cross(last).dot(normal) > LeastSine * next.norm() * last.norm()))
    {
      return false;
    }
  }
  return true;
}

/// For each face of the table the number of its center, or Whole.
std::vector<Index> numberCenters(const Mesh& mesh, const FaceTable& table, Index& count)
{
  const Index faces = table.start.back();
  std::vector<char> isOfStandardCell(faces, 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index f = table.start[c]; f < table.start[c + 1] && !isPolyhedron(mesh, c); ++f)
    {
      isOfStandardCell[table.first[f]] = 1;
    }
  }
  std::vector<Index> centers(faces, Whole);
  count = 0;
  for (Index f = 0; f < faces; ++f)
  {
    if (table.first[f] != f)
    {
      centers[f] = centers[table.first[f]];
      continue;
    }
    const Index size = table.size(f);
    const bool isWhole = isOfStandardCell[f] || size <= 3 ||
                         (size == 4 && isPlain(mesh, table.corners.begin(f), size));
    centers[f] = isWhole ? Whole : count++;
  }
  return centers;
}

/// The weights of nodes in centers, center by center.
struct Means
{
  std::vector<Index> offsets = { 0 };
  std::vector<std::pair<Index, double>> weights; ///< node and weight, the nodes of each ascending

  /// The weights since the last close() become those of the next center, by ascending nodes.
  void close()
  {
    std::sort(this->weights.begin() + this->offsets.back(), this->weights.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    this->offsets.push_back(static_cast<Index>(this->weights.size()));
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> matrix(Index nodes) const
  {
    const auto rows = static_cast<Index>(this->offsets.size()) - 1;
    Eigen::SparseMatrix<double, Eigen::RowMajor, int> result(rows, nodes);
    result.reserve(static_cast<Index>(this->weights.size()));
    for (Index row = 0; row < rows; ++row)
    {
      result.startVec(row);
      for (Index k = this->offsets[row]; k < this->offsets[row + 1]; ++k)
      {
        result.insertBackByOuterInner(row, this->weights[k].first) = this->weights[k].second;
      }
    }
    result.finalize();
    return result;
  }
};

/// Adds the weights of a cell's nodes in its center, one entry a node. `areas`: memory.
void addCellCenter(
  const Mesh& mesh, const FaceTable& table, Index cell, std::vector<double>& areas, Means& means)
{
  areas.clear();
  double sum = 0;
  for (Index f = table.start[cell]; f < table.start[cell + 1]; ++f)
  {
    areas.push_back(doubleArea(mesh, table.corners.begin(f), table.size(f)).norm());
    sum += areas.back();
  }
  for (const Index* node = mesh.cell(cell); node != mesh.cell(cell) + mesh.cellSize(cell); ++node)
  {
    means.weights.emplace_back(*node, 0.);
  }
  const auto first = static_cast<std::ptrdiff_t>(means.offsets.back());
  means.close();
  for (Index f = table.start[cell]; f < table.start[cell + 1]; ++f)
  {
    const double share =
      sum > 0 ? areas[f - table.start[cell]] / sum : 1 / static_cast<double>(areas.size());
    for (const Index* node = table.corners.begin(f); node != table.corners.end(f); ++node)
    {
      const auto at = std::lower_bound(means.weights.begin() + first, means.weights.end(), *node,
        [](const auto& weight, Index id) { return weight.first < id; });
      at->second += share / static_cast<double>(table.size(f));
    }
  }
}

/// Whether all corners are clearly positive. `nodes`: in VTK's order.
bool isClearlyValid(const Mesh& mesh, Shape shape, const std::vector<Index>& nodes)
{
  const SimplicialDecomposition split = simplicialDecomposition(shape);
  return std::all_of(split.tets, split.tets + cornerTetrahedra(shape),
    [&](const WeightedTet& tet)
    {
      Eigen::RowVector3d edge[3];
      double product = 1;
      for (int k = 0; k < 3; ++k)
      {
        edge[k] = mesh.points.row(nodes[tet.corner[k + 1]]) - mesh.points.row(nodes[tet.corner[0]]);
        product *= edge[k].norm();
      }
      return edge[0].dot(edge[1].cross(edge[2])) > LeastSine * product;
    });
}

/// The node of a hexahedron that an edge joins with `node` of its bottom; -1 if there is none.
Index nodeAbove(const FaceTable& table, Index bottom, Index last, Index node)
{
  const auto isInBottom = [&](Index other)
  {
    return std::find(table.corners.begin(bottom), table.corners.end(bottom), other) !=
           table.corners.end(bottom);
  };
  for (Index f = bottom + 1; f < last; ++f)
  {
    const Index* n = table.corners.begin(f);
    for (Index k = 0; k < table.size(f); ++k)
    {
      for (const Index other : { n[(k + 1) % 4], n[(k + 3) % 4] })
      {
        if (n[k] == node && !isInBottom(other))
        {
          return other;
        }
      }
    }
  }
  return -1;
}

/// The nodes in VTK's order of a polyhedron that is a valid tetrahedron or hexahedron with whole
/// faces; none for another one.
std::vector<Index> standardNodes(
  const Mesh& mesh, const FaceTable& table, const std::vector<Index>& centers, Index cell)
{
  const Index first = table.start[cell], last = table.start[cell + 1];
  const Index size = table.size(first), corners = mesh.cellSize(cell);
  const bool isTet = last - first == 4 && size == 3 && corners == 4;
  const bool isHex = last - first == 6 && size == 4 && corners == 8;
  for (Index f = first; f < last; ++f)
  {
    if ((!isTet && !isHex) || table.size(f) != size || centers[f] != Whole)
    {
      return {};
    }
  }
  const Index* face = table.corners.begin(first);
  std::vector<Index> nodes(face, face + size);
  std::reverse(nodes.begin(), nodes.end()); // from inside
  for (Index k = 0; isHex && k < size; ++k)
  {
    nodes.push_back(nodeAbove(table, first, last, nodes[k]));
  }
  if (isTet)
  {
    nodes.push_back(*std::find_if(mesh.cell(cell), mesh.cell(cell) + corners,
      [&](Index node) { return std::find(face, face + size, node) == face + size; }));
  }
  // The faces of the standard cell have to be the polyhedron's.
  const CellShape& shape = *cellShape(isTet ? Tetra : Hexahedron);
  const auto isFace = [&](const FaceShape& wanted)
  {
    for (Index f = first; f < last; ++f)
    {
      const Index* begin = table.corners.begin(f);
      if (std::all_of(wanted.corner, wanted.corner + wanted.size,
            [&](int k) { return std::find(begin, begin + size, nodes[k]) != begin + size; }))
      {
        return true;
      }
    }
    return false;
  };
  const bool isStandard = std::all_of(shape.faces, shape.faces + shape.numberOfFaces, isFace) &&
                          isClearlyValid(mesh, shape.shape, nodes);
  return isStandard ? nodes : std::vector<Index>();
}
}

PolyhedronPieces::PolyhedronPieces(const Mesh& mesh, Monitor& monitor, bool cutsAll)
  : nodes_(mesh.numberOfNodes())
{
  requireIndexable(mesh); // the weights of centers are numbered by ints
  const FaceTable table = faceTable(mesh, monitor);
  const std::vector<Index> centers = numberCenters(mesh, table, this->faceCenters_);
  Means means;
  for (Index f = 0; f < table.start.back(); ++f)
  {
    if (centers[f] == Whole || table.first[f] != f)
    {
      continue;
    }
    const double share = 1 / static_cast<double>(table.size(f));
    for (const Index* node = table.corners.begin(f); node != table.corners.end(f); ++node)
    {
      means.weights.emplace_back(*node, share);
    }
    means.close();
  }
  Mesh others; // the cells after the first of each polyhedron
  std::vector<double> areas;
  Index row = this->faceCenters_;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!isPolyhedron(mesh, c))
    {
      this->pieces_.add(mesh.types[c], mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
      continue;
    }
    if (const std::vector<Index> nodes = standardNodes(mesh, table, centers, c);
        !nodes.empty() && !cutsAll)
    {
      this->pieces_.add(nodes.size() == 4 ? Tetra : Hexahedron, nodes.begin(), nodes.end());
      continue;
    }
    const Index apex = this->nodes_ + row;
    ++row;
    addCellCenter(mesh, table, c, areas, means);
    Mesh* to = &this->pieces_;
    for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
    {
      // From inside, as VTK's order has the faces at the apex of a valid cell.
      const Index* n = table.corners.begin(f);
      const Index size = table.size(f);
      if (centers[f] == Whole && size == 3)
      {
        to->add(Tetra, { n[2], n[1], n[0], apex });
      }
      else if (centers[f] == Whole)
      {
        to->add(Pyramid, { n[3], n[2], n[1], n[0], apex });
      }
      for (Index k = 0; centers[f] != Whole && k < size; ++k)
      {
        to->add(Tetra, { n[(k + 1) % size], n[k], this->nodes_ + centers[f], apex });
        to = &others;
      }
      to = &others;
    }
    this->cellOfOther_.resize(others.types.size(), c);
  }
  this->means_ = means.matrix(this->nodes_);
  for (Index c = 0; c < others.numberOfCells(); ++c)
  {
    this->pieces_.add(others.types[c], others.cell(c), others.cell(c) + others.cellSize(c));
  }
  this->pieces_.points = this->extend(ConstPoints(mesh.points));
}

CellPieces::~CellPieces() = default;

std::shared_ptr<const Communicator> PolyhedronPieces::processes() const
{
  return std::make_shared<ProcessesOfPieces<Communicator>>(
    *this, Communicator::alone(), Communicator::alone());
}

Index PolyhedronPieces::cellOf(Index piece) const
{
  const Index cells = this->pieces_.numberOfCells() - static_cast<Index>(this->cellOfOther_.size());
  return piece < cells ? piece : this->cellOfOther_[piece - cells];
}

Points PolyhedronPieces::extend(const ConstPoints& points) const
{
  Points all(this->nodes_ + this->means_.rows(), 3);
  all.topRows(this->nodes_) = points;
  all.bottomRows(this->means_.rows()) = this->means_ * points;
  return all;
}

Points PolyhedronPieces::reduce(const Points& all, Points points) const
{
  points = all.topRows(this->nodes_);
  return points;
}

Points PolyhedronPieces::extendTranspose(const ConstPoints& all) const
{
  return all.topRows(this->nodes_) + this->means_.transpose() * all.bottomRows(this->means_.rows());
}

std::vector<double> PolyhedronPieces::extend(const std::vector<double>& values) const
{
  std::vector<double> all = values;
  for (const Index cell : this->cellOfOther_)
  {
    all.push_back(values[cell]);
  }
  return all;
}

NodePartition PolyhedronPieces::extend(const NodePartition& partition) const
{
  std::vector<char> isPrescribed(this->nodes_, 0);
  for (const Index node : partition.prescribed)
  {
    isPrescribed[node] = 1;
  }
  std::vector<char> isUsed(this->pieces_.numberOfNodes(), 0);
  for (const Index node : this->pieces_.connectivity)
  {
    isUsed[node] = 1;
  }
  std::vector<Index> prescribed;
  std::copy_if(partition.prescribed.begin(), partition.prescribed.end(),
    std::back_inserter(prescribed), [&](Index node) { return isUsed[node] != 0; });
  for (Index f = 0; f < this->faceCenters_; ++f)
  {
    bool all = true;
    for (decltype(this->means_)::InnerIterator node(this->means_, f); node; ++node)
    {
      all = all && isPrescribed[node.col()] != 0;
    }
    if (all)
    {
      prescribed.push_back(this->nodes_ + f);
    }
  }
  return partitionNodes(this->pieces_, std::move(prescribed));
}

std::shared_ptr<const CellPieces> cutCells(const Mesh& mesh, const HangingNodes& hanging,
  const Communicator& processes, int layers, Monitor& monitor, bool cutsAll)
{
  if (std::shared_ptr<const CellPieces> pieces = processes.cut(mesh, layers, monitor))
  {
    return pieces;
  }
  return std::make_shared<PolyhedronPieces>(hanging.conforming(mesh), monitor, cutsAll);
}
}
