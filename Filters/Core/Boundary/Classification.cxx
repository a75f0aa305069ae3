// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/Classification.h"

#include "Boundary/GivenSurfaces.h"
#include "Boundary/SheetSurfaces.h"
#include "Mesh/CellShape.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace morph
{
namespace
{
constexpr double NoParameter = std::numeric_limits<double>::quiet_NaN();

void requireLength(std::size_t length, Index needed, const char* what)
{
  if (length != 0 && static_cast<Index>(length) != needed)
  {
    throw Error(std::string("The given ") + what + " have " + std::to_string(length) +
                " entries; " + std::to_string(needed) + " are needed.");
  }
}

void requireAngle(double angle, const char* what)
{
  if (!(angle >= 0 && angle <= 180))
  {
    throw Error(std::string("The ") + what + " is " + std::to_string(angle) +
                " degrees; it has to be between 0 and 180.");
  }
}

void validate(Index nodes, const BoundaryFaces& faces, const ClassificationOptions& options)
{
  const GivenGeometry& given = options.given;
  requireAngle(options.featureAngle, "feature angle");
  requireAngle(options.cornerAngle, "corner angle");
  requireLength(given.surface.size(), static_cast<Index>(faces.offsets.size()) - 1, "surface ids");
  requireLength(given.dimension.size(), nodes, "dimensions");
  requireLength(given.id.size(), nodes, "ids");
  requireLength(given.parameter.size(), nodes, "curve parameters");
  if (given.dimension.empty() != given.id.empty())
  {
    throw Error("The dimensions of the nodes' geometry are given without its ids, or the ids "
                "without dimensions. Give both.");
  }
  std::vector<Index> wrong;
  for (Index node : faces.nodes)
  {
    if (!given.dimension.empty() && (given.dimension[node] < 0 || given.dimension[node] > 2))
    {
      wrong.push_back(node);
    }
  }
  if (!wrong.empty())
  {
    throw Error("Nodes on the boundary are given to a geometry of another dimension than 0 "
                "(vertex), 1 (curve) or 2 (surface): node ids " +
                listIds(wrong) + ".");
  }
}

/// Adds to `to`, which ascends, the values that it lacks.
void unite(std::vector<Index> values, std::vector<Index>& to)
{
  sortUnique(values);
  std::vector<Index> all;
  std::set_union(values.begin(), values.end(), to.begin(), to.end(), std::back_inserter(all));
  to = std::move(all);
}

class Classifier
{
public:
  Classifier(
    const ConstPoints& points, const BoundaryFaces& faces, const ClassificationOptions& options)
    : points_(points)
    , faces_(faces)
    , options_(options)
    , given_(options.given)
  {
  }

  Classification run(Monitor& monitor)
  {
    validate(static_cast<Index>(this->points_.rows()), this->faces_, this->options_);
    const Index nodes = static_cast<Index>(this->points_.rows());
    this->result_.dimension = std::vector<std::int8_t>(nodes, -1);
    this->result_.entity = std::vector<Index>(nodes, -1);
    this->result_.parameter = std::vector<double>(nodes, NoParameter);
    this->result_.edges = surfaceEdges(this->points_, this->faces_, monitor);
    monitor.check();
    monitor.progress(0.4);
    this->findPatches(monitor);
    monitor.check();
    monitor.progress(0.6);
    this->findMiddles();
    this->findVertices();
    this->findCurves(monitor);
    monitor.check();
    monitor.progress(0.8);
    this->placeNodes();
    this->nameVerticesAndSurfaces();
    this->compareWithGiven(monitor);
    return std::move(this->result_);
  }

private:
  bool isGiven(Index node, int dimension) const
  {
    return !this->given_.dimension.empty() && this->given_.dimension[node] == dimension;
  }

  void findPatches(Monitor& monitor)
  {
    SurfaceEdges& edges = this->result_.edges;
    const GivenSurfaces known = givenSurfaces(this->points_, this->faces_, edges, this->options_);
    this->patches_ = surfacePatches(this->faces_, edges, this->options_.featureAngle, known.id,
      known.isCurve, this->options_.featuresInside);
    this->result_.surfaceOfFace = this->patches_.ofFace;

    const auto patchesOf = [this](Index first, Index last, const auto& add)
    {
      for (Index f = first; f < last; ++f)
      {
        for (Index k = this->faces_.offsets[f]; k < this->faces_.offsets[f + 1]; ++k)
        {
          add(this->faces_.connectivity[k], this->patches_.ofFace[f]);
        }
      }
    };
    this->patchesAtNode_ = sortIntoBuckets(static_cast<Index>(this->patches_.ofFace.size()),
      static_cast<Index>(this->points_.rows()), monitor, patchesOf);
    removeRepeated(this->patchesAtNode_);
    for (Index e = 0; e < edges.count(); ++e)
    {
      if (this->patches_.isCurve[e])
      {
        this->curveEdges_.push_back(e);
      }
    }
  }

  /// Lists mid-side nodes by their edge, for edges on curves.
  void findMiddles()
  {
    for (std::size_t i = 0; i < this->faces_.nodes.size(); ++i)
    {
      const Index k = static_cast<Index>(i);
      const Index* corners = this->faces_.between.begin(k);
      const Index edge = this->faces_.between.end(k) - corners == 2
                           ? this->result_.edges.find(corners[0], corners[1])
                           : -1;
      if (edge >= 0 && this->patches_.isCurve[edge])
      {
        this->middles_.emplace_back(edge, this->faces_.nodes[i]);
      }
    }
    std::sort(this->middles_.begin(), this->middles_.end());
  }

  std::vector<Index> patchesAtEdge(Index edge) const
  {
    std::vector<Index> patches;
    const Adjacency& faces = this->result_.edges.faces;
    for (const Index* f = faces.begin(edge); f != faces.end(edge); ++f)
    {
      patches.push_back(this->patches_.ofFace[*f]);
    }
    std::sort(patches.begin(), patches.end());
    return patches;
  }

  Index otherEnd(Index edge, Index node) const
  {
    const auto& ends = this->result_.edges.nodes[edge];
    return ends[0] == node ? ends[1] : ends[0];
  }

  bool turns(Index node, const std::array<Index, 2>& edges) const
  {
    const Eigen::RowVector3d in =
      this->points_.row(node) - this->points_.row(this->otherEnd(edges[0], node));
    const Eigen::RowVector3d out =
      this->points_.row(this->otherEnd(edges[1], node)) - this->points_.row(node);
    const double angle = std::atan2(in.cross(out).norm(), in.dot(out));
    return angle * 180 / std::acos(-1.) > this->options_.cornerAngle;
  }

  /// Returns the curve given to a node or, for a vertex, to the edge's other end.
  Index givenCurve(Index edge, Index node) const
  {
    const Index other = this->otherEnd(edge, node);
    return this->isGiven(other, 1)  ? this->given_.id[other]
           : this->isGiven(node, 1) ? this->given_.id[node]
                                    : NoGeometry;
  }

  /// Whether a curve ends at this corner. `degree`: number of its curve edges; `edges`: the first
  /// two of them.
  bool isVertex(Index node, int degree, const std::array<Index, 2>& edges) const
  {
    if (this->isGiven(node, 0) || degree == 1 || degree > 2)
    {
      return true;
    }
    const Index* first = this->patchesAtNode_.begin(node);
    const Index* last = this->patchesAtNode_.end(node);
    if (degree == 0)
    {
      return last - first > 1;
    }
    std::vector<Index> beside = this->patchesAtEdge(edges[0]);
    if (beside != this->patchesAtEdge(edges[1]))
    {
      return true;
    }
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    if (!std::equal(first, last, beside.begin(), beside.end()))
    {
      return true; // another surface touches the curve here
    }
    const Index a = this->givenCurve(edges[0], node), b = this->givenCurve(edges[1], node);
    if (a != NoGeometry && b != NoGeometry && a != b)
    {
      return true;
    }
    return !this->isGiven(node, 1) && this->turns(node, edges);
  }

  /// Returns each end of each curve edge with that edge, sorted.
  std::vector<std::pair<Index, Index>> endsOfCurveEdges() const
  {
    std::vector<std::pair<Index, Index>> ends;
    for (const Index e : this->curveEdges_)
    {
      for (const Index node : this->result_.edges.nodes[e])
      {
        ends.emplace_back(node, e);
      }
    }
    std::sort(ends.begin(), ends.end());
    return ends;
  }

  void findVertices()
  {
    this->isVertex_.assign(this->points_.rows(), 0);
    const std::vector<std::pair<Index, Index>> ends = this->endsOfCurveEdges();
    auto next = ends.begin();
    for (std::size_t i = 0; i < this->faces_.nodes.size(); ++i) // ascending
    {
      const Index node = this->faces_.nodes[i], k = static_cast<Index>(i);
      int degree = 0;
      std::array<Index, 2> edges = { -1, -1 };
      for (; next != ends.end() && next->first == node; ++next, ++degree)
      {
        if (degree < 2)
        {
          edges[degree] = next->second;
        }
      }
      const bool isCorner = this->faces_.between.begin(k) == this->faces_.between.end(k);
      if (isCorner && this->isVertex(node, degree, edges))
      {
        this->isVertex_[node] = 1;
        this->result_.dimension[node] = 0;
        this->result_.entity[node] = static_cast<Index>(this->result_.vertices.size());
        this->result_.vertices.push_back({ 0, node });
      }
    }
  }

  void findCurves(Monitor& monitor)
  {
    std::vector<Index> badParameter;
    for (CurveChain& chain :
      curveChains(this->result_.edges, this->curveEdges_, this->isVertex_, this->middles_))
    {
      GeometryCurve curve;
      static_cast<CurveChain&>(curve) = std::move(chain);
      curve.id = NoGeometry;
      for (Index node : curve.nodes)
      {
        if (curve.id == NoGeometry && this->isGiven(node, 1))
        {
          curve.id = this->given_.id[node];
        }
      }
      if (!this->takeGivenParameters(curve))
      {
        badParameter.push_back(curve.nodes[curve.loop ? 0 : 1]);
        curve.parameter.clear();
      }
      if (curve.parameter.empty())
      {
        curve.parameter = arcLengthParameters(this->points_, curve);
      }
      curve.surfaces = this->patchesAtEdge(curve.edges[0]);
      curve.surfaces.erase(
        std::unique(curve.surfaces.begin(), curve.surfaces.end()), curve.surfaces.end());
      this->result_.curves.push_back(std::move(curve));
    }
    name(this->result_.curves);
    if (!badParameter.empty())
    {
      monitor.warn(
        "Given curve parameters that do not rise or fall along their curve within [0, 1] "
        "are not used; the curves take arc length. They hold the nodes with ids " +
        listIds(badParameter) + ".");
    }
  }

  /// Fills curve.parameter if every inner node has a given parameter, and sorts the nodes by it.
  /// Returns false if the given parameters are inconsistent.
  bool takeGivenParameters(GeometryCurve& curve) const
  {
    const auto given = [&](Index node)
    {
      return this->isGiven(node, 1) && !this->given_.parameter.empty()
               ? this->given_.parameter[node]
               : NoParameter;
    };
    const auto inside = curve.loop ? curve.nodes.begin() : curve.nodes.begin() + 1;
    const auto end = curve.loop ? curve.nodes.end() : curve.nodes.end() - 1;
    if (inside == end || std::all_of(inside, end, [&](Index n) { return std::isnan(given(n)); }))
    {
      return true;
    }
    if (std::any_of(inside, end, [&](Index n) { return !(given(n) >= 0 && given(n) <= 1); }))
    {
      return false;
    }
    if (curve.loop)
    {
      const auto lower = [&](Index a, Index b) { return given(a) < given(b); };
      std::rotate(curve.nodes.begin(),
        std::min_element(curve.nodes.begin(), curve.nodes.end(), lower), curve.nodes.end());
      if (curve.nodes.size() > 2 && given(curve.nodes[1]) > given(curve.nodes.back()))
      {
        std::reverse(curve.nodes.begin() + 1, curve.nodes.end());
      }
    }
    else if (given(*inside) > given(*(end - 1)))
    {
      std::reverse(curve.nodes.begin(), curve.nodes.end());
      std::reverse(curve.edges.begin(), curve.edges.end());
    }
    for (std::size_t i = 0; i < curve.nodes.size(); ++i)
    {
      const bool isEnd = !curve.loop && (i == 0 || i + 1 == curve.nodes.size());
      curve.parameter.push_back(isEnd ? static_cast<double>(i > 0) : given(curve.nodes[i]));
    }
    // Ends may coincide with a first node at 0; inner nodes must differ.
    return std::is_sorted(curve.parameter.begin(), curve.parameter.end()) &&
           std::adjacent_find(
             inside, end, [&](Index a, Index b) { return given(a) == given(b); }) == end;
  }

  /// Assigns ids: as given; missing ids follow the largest given one, or count from 0.
  template <typename Entities>
  static void name(Entities& entities)
  {
    Index next = 0;
    for (const auto& entity : entities)
    {
      if (entity.id != NoGeometry)
      {
        next = std::max(next, entity.id + 1);
      }
    }
    for (auto& entity : entities)
    {
      if (entity.id == NoGeometry)
      {
        entity.id = next++;
      }
    }
  }

  void nameVerticesAndSurfaces()
  {
    for (GeometryVertex& vertex : this->result_.vertices)
    {
      vertex.id = this->isGiven(vertex.node, 0) ? this->given_.id[vertex.node] : NoGeometry;
    }
    name(this->result_.vertices);
    name(this->result_.surfaces);
  }

  void place(Index node, int dimension, Index entity)
  {
    this->result_.dimension[node] = static_cast<std::int8_t>(dimension);
    this->result_.entity[node] = entity;
  }

  void placeNodes()
  {
    Classification& result = this->result_;
    const std::size_t count = this->patches_.id.size();
    result.surfaces.resize(count);
    std::vector<std::vector<Index>> onCurves(count); // nodes, by surface
    for (std::size_t c = 0; c < result.curves.size(); ++c)
    {
      const GeometryCurve& curve = result.curves[c];
      for (std::size_t i = 0; i < curve.nodes.size(); ++i)
      {
        if (!this->isVertex_[curve.nodes[i]])
        {
          this->place(curve.nodes[i], 1, static_cast<Index>(c));
          result.parameter[curve.nodes[i]] = curve.parameter[i];
        }
      }
      for (const Index s : curve.surfaces)
      {
        onCurves[s].insert(onCurves[s].end(), curve.nodes.begin(), curve.nodes.end());
        result.surfaces[s].curves.push_back(static_cast<Index>(c));
      }
    }
    for (std::size_t i = 0; i < this->faces_.nodes.size(); ++i) // ascending
    {
      const Index node = this->faces_.nodes[i];
      if (result.dimension[node] < 0)
      {
        this->place(node, 2, this->surfaceOf(static_cast<Index>(i)));
      }
      const Index* first = this->patchesAtNode_.begin(node);
      const Index* last = this->patchesAtNode_.end(node);
      std::for_each(first, last, [&](Index s) { result.surfaces[s].nodes.push_back(node); });
      const Index own = result.dimension[node] == 2 ? result.entity[node] : -1;
      if (own >= 0 && std::find(first, last, own) == last) // in the middle of an edge or a face
      {
        result.surfaces[own].nodes.push_back(node);
      }
    }
    for (std::size_t s = 0; s < count; ++s)
    {
      result.surfaces[s].id = this->patches_.id[s];
      unite(std::move(onCurves[s]), result.surfaces[s].nodes);
    }
    for (std::size_t f = 0; f < this->patches_.ofFace.size(); ++f)
    {
      result.surfaces[this->patches_.ofFace[f]].faces.push_back(static_cast<Index>(f));
    }
  }

  /// Returns the surface of faces.nodes[i], which is on no curve: the one that all its corners
  /// touch.
  Index surfaceOf(Index i) const
  {
    const Index node = this->faces_.nodes[i];
    const Index* corner = this->faces_.between.begin(i);
    const Index* end = this->faces_.between.end(i);
    if (corner == end)
    {
      return *this->patchesAtNode_.begin(node);
    }
    if (end - corner == 2)
    {
      const Index edge = this->result_.edges.find(corner[0], corner[1]);
      if (edge >= 0)
      {
        return this->patches_.ofFace[*this->result_.edges.faces.begin(edge)];
      }
    }
    // A face node: finds the face with these corners at one of its edges.
    const std::vector<Index> corners(corner, end);
    const auto onFace = [&](Index face, Index n)
    {
      const auto* nodes = this->faces_.connectivity.data();
      const Index* last = nodes + this->faces_.offsets[face + 1];
      return std::find(nodes + this->faces_.offsets[face], last, n) != last;
    };
    for (Index other : corners)
    {
      const Index edge = this->result_.edges.find(corners[0], other);
      const Adjacency& faces = this->result_.edges.faces;
      for (const Index* f = edge < 0 ? nullptr : faces.begin(edge); f && f != faces.end(edge); ++f)
      {
        if (std::all_of(corners.begin(), corners.end(), [&](Index n) { return onFace(*f, n); }))
        {
          return this->patches_.ofFace[*f];
        }
      }
    }
    return *this->patchesAtNode_.begin(corners[0]);
  }

  void compareWithGiven(Monitor& monitor) const
  {
    std::vector<Index> other;
    for (Index node : this->faces_.nodes)
    {
      if (!this->given_.dimension.empty() &&
          (this->given_.dimension[node] != this->result_.dimension[node] ||
            this->given_.id[node] != this->result_.id(node)))
      {
        other.push_back(node);
      }
    }
    if (!other.empty())
    {
      monitor.warn(
        "The given geometry contradicts the mesh at node ids " + listIds(other) +
        ": a node given to a curve is beside no curve edge, say, or curves end at a node not "
        "given as a vertex. These nodes are classified by the faces around them.");
    }
  }

  const ConstPoints& points_;
  const BoundaryFaces& faces_;
  const ClassificationOptions& options_;
  const GivenGeometry& given_;
  SurfacePatches patches_;
  Adjacency patchesAtNode_; ///< #nodes
  std::vector<Index> curveEdges_;
  std::vector<std::pair<Index, Index>> middles_;
  std::vector<std::uint8_t> isVertex_;
  Classification result_;
};
}

Index Classification::id(Index node) const
{
  const Index number = this->entity[node];
  switch (this->dimension[node])
  {
    case 0:
      return this->vertices[number].id;
    case 1:
      return this->curves[number].id;
    case 2:
      return this->surfaces[number].id;
    default:
      return number;
  }
}

Classification classify(const ConstPoints& points, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor)
{
  return Classifier(points, faces, options).run(monitor);
}

Classification classify(const Mesh& mesh, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor)
{
  Classification result = options.sheets.empty()
                            ? classify(ConstPoints(mesh.points), faces, options, monitor)
                            : classifyWithSheets(mesh, faces, options, monitor);
  const ConnectedComponents parts = connectedComponents(mesh, monitor);
  const auto placeInside = [&](Index node, Index body)
  {
    if (body >= 0 && result.dimension[node] < 0)
    {
      result.dimension[node] = 3;
      result.entity[node] = body;
    }
  };
  parallel(
    mesh.numberOfNodes(), monitor, [&](Index node) { placeInside(node, parts.ofNode[node]); });
  const auto hasNodesBetween = [&mesh](Index c)
  {
    const CellShape* shape = cellShape(mesh, c);
    return !shape || shape->numberOfCorners != mesh.cellSize(c);
  };
  const Index cells = mesh.numberOfCells();
  const Index withNodesBetween =
    reproducibleSum(cells, monitor, Index(0), [&](Index c) { return Index(hasNodesBetween(c)); });
  for (Index c = 0; withNodesBetween > 0 && c < cells; ++c)
  {
    if (!hasNodesBetween(c))
    {
      continue;
    }
    for (Index k = 0; k < mesh.cellSize(c); ++k)
    {
      placeInside(mesh.cell(c)[k], parts.ofCell[c]);
    }
  }
  return result;
}
}
