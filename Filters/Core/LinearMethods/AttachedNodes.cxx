// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/AttachedNodes.h"

#include "Geometry/AffineFit.h"
#include "Geometry/RotationFit.h"
#include "Mesh/CellShape.h"
#include "Support/Lists.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
using Row = Eigen::RowVector3d;
using Square = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Rigid links may join nodes at one place: at least this part of the links' mean length counts.
constexpr double LeastLength = 1e-6;

/// Calls act(row, column, value).
template <typename Matrix, typename Act>
void forEachEntry(const Matrix& matrix, const Act& act)
{
  for (int k = 0; k < matrix.outerSize(); ++k)
  {
    for (typename Matrix::InnerIterator entry(matrix, k); entry; ++entry)
    {
      act(entry.row(), entry.col(), entry.value());
    }
  }
}

std::vector<std::uint8_t> nodesOfVolume(const Mesh& mesh)
{
  std::vector<std::uint8_t> isUsed(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index size = volumeShape(mesh, c) ? mesh.cellSize(c) : 0;
    for (const Index* node = mesh.cell(c); node != mesh.cell(c) + size; ++node)
    {
      isUsed[*node] = 1;
    }
  }
  return isUsed;
}

/// Calls link(i, j) for pairs of a cell's nodes: all of a cell with a known number of nodes, else
/// neighbors along a line, an outline or a strip.
template <typename Link>
void forPairs(const CellShape& shape, Index size, const Link& link)
{
  const bool isOpen = shape.numberOfNodes < 0;
  for (Index i = 0; i < size; ++i)
  {
    const Index reach = isOpen ? shape.dimension : size;
    for (Index j = i + 1; j < std::min(size, i + reach + 1); ++j)
    {
      link(i, j);
    }
  }
  if (isOpen && shape.dimension == 2 && size > 3)
  {
    link(0, size - 1);
  }
}

/// The place of an id in ascending ones, or -1.
Index placeOf(const std::vector<Index>& ids, Index id)
{
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  return found != ids.end() && *found == id ? found - ids.begin() : -1;
}

/// The nodes of links that are anchors, ascending.
template <typename Link>
std::vector<Index> anchorsOf(
  const Mesh& mesh, const std::vector<Link>& links, const std::vector<Index>& prescribed)
{
  std::vector<Index> anchors;
  if (links.empty())
  {
    return anchors;
  }
  std::vector<std::uint8_t> isAnchor = nodesOfVolume(mesh);
  for (const Index node : prescribed)
  {
    isAnchor[node] = 1;
  }
  for (const Link& link : links)
  {
    for (const Index node : { link.a, link.b })
    {
      if (isAnchor[node])
      {
        anchors.push_back(node);
      }
    }
  }
  sortUnique(anchors);
  return anchors;
}
}

/// By the nodes here.
std::vector<AttachedNodes::Link> AttachedNodes::linksHere(const Mesh& mesh) const
{
  const std::vector<std::uint8_t> isUsed = nodesOfVolume(mesh);
  std::vector<Link> links;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh, c);
    const Index *cell = mesh.cell(c), size = mesh.cellSize(c);
    if (!shape || shape->dimension == 0 || shape->dimension == 3 || this->processes_->isCopy(c) ||
        std::all_of(cell, cell + size, [&](Index n) { return isUsed[n] != 0; }))
    {
      continue;
    }
    forPairs(*shape, size,
      [&](Index i, Index j)
      {
        const Index a = std::min(cell[i], cell[j]), b = std::max(cell[i], cell[j]);
        if (a != b)
        {
          links.push_back({ a, b, (mesh.points.row(a) - mesh.points.row(b)).norm() });
        }
      });
  }
  return links;
}

/// By ids.
std::vector<AttachedNodes::Link> AttachedNodes::linksOfAll(std::vector<Link> links) const
{
  std::vector<double> numbers;
  for (const Link& link : links)
  {
    const std::vector<Index> ids = this->processes_->idsOf({ link.a, link.b });
    numbers.insert(numbers.end(), { static_cast<double>(std::min(ids[0], ids[1])),
                                    static_cast<double>(std::max(ids[0], ids[1])), link.length });
  }
  numbers = this->processes_->gather(numbers);
  links.clear();
  for (std::size_t i = 0; i < numbers.size(); i += 3)
  {
    links.push_back(
      { static_cast<Index>(numbers[i]), static_cast<Index>(numbers[i + 1]), numbers[i + 2] });
  }
  return links;
}

AttachedNodes::AttachedNodes(
  const Mesh& rest, const NodePartition& partition, const Communicator& processes)
  : rest_(&rest)
  , processes_(&processes)
{
  std::vector<Link> links = this->linksHere(rest);
  if (processes.all(links.empty()))
  {
    return;
  }
  std::vector<Index> anchors = processes.gatherNodes(anchorsOf(rest, links, partition.prescribed));
  sortUnique(anchors); // of several processes
  this->prepare(this->linksOfAll(std::move(links)), std::move(anchors));
}

void AttachedNodes::prepare(std::vector<Link> links, std::vector<Index> anchors)
{
  std::sort(links.begin(), links.end(),
    [](const Link& l, const Link& r)
    { return std::tie(l.a, l.b, l.length) < std::tie(r.a, r.b, r.length); });
  double mean = 0;
  std::vector<Index> all;
  for (const Link& link : links)
  {
    mean += link.length / static_cast<double>(links.size());
    all.insert(all.end(), { link.a, link.b });
  }
  sortUnique(all);
  UnionFind<Index> parts(static_cast<Index>(all.size()));
  for (const Link& link : links)
  {
    parts.join(placeOf(all, link.a), placeOf(all, link.b));
  }
  std::vector<std::uint8_t> hangs(all.size(), 0);
  for (const Index anchor : anchors)
  {
    hangs[parts.root(placeOf(all, anchor))] = 1;
  }
  for (const Index id : all)
  {
    if (placeOf(anchors, id) < 0)
    {
      (hangs[parts.root(placeOf(all, id))] ? this->ids_ : this->loose_).push_back(id);
    }
  }
  this->anchors_ = std::move(anchors);
  std::vector<int> first(all.size(), -1); // anchor of a part
  for (int a = static_cast<int>(this->anchors_.size()) - 1; a >= 0; --a)
  {
    first[parts.root(placeOf(all, this->anchors_[a]))] = a;
  }
  for (const Index id : this->ids_)
  {
    this->reference_.push_back(first[parts.root(placeOf(all, id))]);
  }

  std::vector<Eigen::Triplet<double, int>> own, coupling;
  for (const Link& link : links)
  {
    const double length = std::max(link.length, LeastLength * mean);
    const double weight = length > 0 ? mean / length : 1;
    for (const auto& [from, to] : { std::pair(link.a, link.b), std::pair(link.b, link.a) })
    {
      const int row = static_cast<int>(placeOf(this->ids_, from));
      if (row < 0)
      {
        continue;
      }
      own.emplace_back(row, row, weight);
      if (const int other = static_cast<int>(placeOf(this->ids_, to)); other >= 0)
      {
        own.emplace_back(row, other, -weight);
      }
      else
      {
        coupling.emplace_back(row, static_cast<int>(placeOf(this->anchors_, to)), weight);
      }
    }
  }
  const auto rows = static_cast<int>(this->ids_.size());
  if (rows == 0)
  {
    return;
  }
  Matrix laplace(rows, rows);
  laplace.setFromTriplets(own.begin(), own.end());
  this->factor_ = std::make_shared<Eigen::SimplicialLDLT<Matrix>>(laplace);
  this->coupling_.resize(rows, static_cast<int>(this->anchors_.size()));
  this->coupling_.setFromTriplets(coupling.begin(), coupling.end());
  this->findNodes();
  this->findRings();
}

void AttachedNodes::findNodes()
{
  std::vector<Index> nodes = consecutive(this->rest_->numberOfNodes());
  const std::vector<Index> ids = this->processes_->idsOf(nodes);
  std::vector<Index> nodeOfAnchor(this->anchors_.size(), -1);
  this->nodeOf_.assign(this->ids_.size(), -1);
  for (const Index node : nodes)
  {
    if (const Index i = placeOf(this->ids_, ids[node]); i >= 0)
    {
      this->nodeOf_[i] = node;
    }
    if (const Index a = placeOf(this->anchors_, ids[node]); a >= 0)
    {
      nodeOfAnchor[a] = node;
    }
  }
  this->elsewhere_ = this->processes_->rows()->countedElsewhere();
  for (Index& node : nodeOfAnchor)
  {
    node = this->countsHere(node) ? node : -1;
  }
  this->nodeOfAnchor_ = std::move(nodeOfAnchor);
}

bool AttachedNodes::countsHere(Index node) const
{
  return node >= 0 && placeOf(this->elsewhere_, node) < 0;
}

void AttachedNodes::findRings()
{
  std::vector<std::vector<Index>> rings(this->anchors_.size());
  std::vector<Index> anchorAt(this->rest_->numberOfNodes(), -1);
  double origin[3] = { 0, 0, 0 };
  for (std::size_t a = 0; a < rings.size(); ++a)
  {
    const Index node = this->nodeOfAnchor_[a];
    if (node >= 0)
    {
      anchorAt[node] = static_cast<Index>(a);
      if (a == 0)
      {
        Eigen::Map<Row>(origin, 3) = this->rest_->points.row(node);
      }
    }
  }
  this->processes_->sum(origin, 3);
  this->origin_ = Eigen::Map<Row>(origin, 3);
  for (Index c = 0; c < this->rest_->numberOfCells(); ++c)
  {
    const Index size = volumeShape(*this->rest_, c) ? this->rest_->cellSize(c) : 0;
    const Index *first = this->rest_->cell(c), *last = first + size;
    for (const Index* node = first; node != last; ++node)
    {
      if (anchorAt[*node] >= 0)
      {
        std::vector<Index>& ring = rings[anchorAt[*node]];
        ring.insert(ring.end(), first, last);
      }
    }
  }
  for (std::vector<Index>& ring : rings)
  {
    sortUnique(ring);
    this->rings_.add(ring.begin(), ring.end());
  }
}

Points AttachedNodes::ringOf(Index anchor, const Points& points) const
{
  const std::vector<Index> ring(this->rings_.begin(anchor), this->rings_.end(anchor));
  return points(ring, allColumns);
}

void AttachedNodes::apply(Points& moved) const
{
  if (this->ids_.empty())
  {
    return;
  }
  const Points& rest = this->rest_->points;
  Rows motion = Rows::Zero(static_cast<Index>(this->anchors_.size()), 12);
  for (Index a = 0; a < motion.rows(); ++a)
  {
    const Index node = this->nodeOfAnchor_[a];
    if (node < 0)
    {
      continue;
    }
    const Points ring = this->ringOf(a, rest), shift = this->ringOf(a, moved) - ring;
    Square turn = Square::Zero(); // of row vectors, less the identity
    if (!shift.isZero(0))
    {
      const Eigen::Matrix3d gradient = AffineLeastSquares(ring).fit(shift).gradient();
      turn = nearestRotation(Eigen::Matrix3d::Identity() + gradient).transpose() -
             Eigen::Matrix3d::Identity();
    }
    motion.row(a).head<3>() =
      moved.row(node) - rest.row(node) - (rest.row(node) - this->origin_) * turn;
    motion.row(a).tail<9>() = Eigen::Map<const Eigen::RowVectorXd>(turn.data(), 9);
  }
  this->processes_->sum(motion.data(), static_cast<int>(motion.size()));
  // From the motion of one anchor on: what hangs at that alone moves by it, to the last bit.
  Rows right = Rows::Zero(static_cast<Index>(this->ids_.size()), 12);
  forEachEntry(this->coupling_, [&](Index i, Index a, double weight)
    { right.row(i) += weight * (motion.row(a) - motion.row(this->reference_[i])); });
  const Rows own = Rows(this->factor_->solve(right)) + motion(this->reference_, allColumns);
  for (Index i = 0; i < own.rows(); ++i)
  {
    const Index node = this->nodeOf_[i];
    if (node < 0)
    {
      continue;
    }
    Square turn;
    Eigen::Map<Eigen::RowVectorXd>(turn.data(), 9) = own.row(i).tail<9>();
    const Row shift = own.row(i).head<3>() + (rest.row(node) - this->origin_) * turn;
    moved.row(node) = rest.row(node);
    if (!shift.isZero(0))
    {
      moved.row(node) += shift;
    }
  }
}

void AttachedNodes::applyTranspose(Points& gradient) const
{
  if (this->ids_.empty())
  {
    return;
  }
  const Points& rest = this->rest_->points;
  Rows own = Rows::Zero(static_cast<Index>(this->ids_.size()), 12);
  for (Index i = 0; i < own.rows(); ++i)
  {
    const Index node = this->nodeOf_[i];
    if (this->countsHere(node))
    {
      const Square turn = (rest.row(node) - this->origin_).transpose() * gradient.row(node);
      own.row(i).head<3>() = gradient.row(node);
      own.row(i).tail<9>() = Eigen::Map<const Eigen::RowVectorXd>(turn.data(), 9);
    }
    if (node >= 0)
    {
      gradient.row(node).setZero();
    }
  }
  this->processes_->sum(own.data(), static_cast<int>(own.size()));
  const Rows right = this->factor_->solve(own);
  Rows motion = Rows::Zero(static_cast<Index>(this->anchors_.size()), 12);
  for (Index i = 0; i < own.rows(); ++i)
  {
    motion.row(this->reference_[i]) += own.row(i);
  }
  forEachEntry(this->coupling_,
    [&](Index i, Index a, double weight)
    {
      motion.row(a) += weight * right.row(i);
      motion.row(this->reference_[i]) -= weight * right.row(i);
    });
  for (Index a = 0; a < motion.rows(); ++a)
  {
    const Index node = this->nodeOfAnchor_[a];
    if (node < 0)
    {
      continue;
    }
    const Row shift = motion.row(a).head<3>();
    gradient.row(node) += shift;
    Square turn;
    Eigen::Map<Eigen::RowVectorXd>(turn.data(), 9) = motion.row(a).tail<9>();
    turn -= (rest.row(node) - this->origin_).transpose() * shift;
    // To first order the rotation is that of the antisymmetric part of the fit's gradient, and this
    // is what a fit moves at three places more than at a fourth.
    Points places = Points::Zero(4, 3), derivatives = Points::Zero(4, 3);
    places.topRows<3>().setIdentity();
    derivatives.topRows<3>() = (turn - turn.transpose()) / 2;
    derivatives.row(3) = -derivatives.topRows<3>().colwise().sum();
    const Points ring = this->ringOf(a, rest);
    places.rowwise() += rest.row(node);
    Points ofRing = Points::Zero(ring.rows(), 3);
    if (ring.rows() > 0)
    {
      AffineLeastSquares(ring).fitTranspose(places, derivatives, ofRing);
    }
    for (Index k = 0; k < ring.rows(); ++k)
    {
      gradient.row(this->rings_.begin(a)[k]) += ofRing.row(k);
    }
  }
}
}
