// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/Target.h"

#include "Private/Data/GridMesh.h"
#include "Private/Data/Precision.h"
#include "Private/Data/Version.h"
#include "Support/Error.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>
#include <vtkStaticPointLocator.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace morph::filters
{
namespace
{
using morph::Index;
using Row = morph::ProjectionTarget::Row;

vtkSmartPointer<vtkPoints> makePoints(const morph::Points& x)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(x.rows());
  std::copy_n(x.data(), x.size(), coordinates->GetPointer(0));
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(coordinates);
  return points;
}

/// The rounding of single precision, in which STL files are written.
double roundingOf(const morph::Points& x)
{
  return x.rows() == 0 ? 0 : 1e-7 * (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
}

/// Gives for each point the one that replaces all points within the rounding.
std::vector<Index> mergedPoints(const morph::Points& x)
{
  if (x.rows() == 0)
  {
    return {};
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(makePoints(x));
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(data);
  locator->BuildLocator();
  std::vector<vtkIdType> merged(x.rows());
  locator->MergePoints(roundingOf(x), merged.data());
  return { merged.begin(), merged.end() };
}

using Triangle = std::array<Index, 3>;

/// A list of triangles without those that are no part of a surface: repeated ones, and flat ones,
/// whose height is within the rounding. A flat one may join a long edge of one side to the shorter
/// edges of the other side. It goes by dividing the triangle at its long edge, so that the surface
/// stays connected.
class TriangleList
{
public:
  TriangleList(const morph::Points& x, double rounding)
    : X(x)
    , Rounding(rounding)
  {
  }

  void Add(Triangle triangle)
  {
    std::rotate(
      triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    this->Triangles.push_back(triangle);
  }

  /// In the order in which they were added, the parts of divided ones last.
  std::vector<Triangle> Clean()
  {
    this->RemoveRepeated();
    std::vector<Triangle> all;
    all.swap(this->Triangles);
    for (Triangle& triangle : all)
    {
      (this->TurnFlat(triangle) ? this->Flat : this->Triangles).push_back(triangle);
    }
    if (!this->Flat.empty())
    {
      this->FindEdges();
    }
    // Thin triangles may become flat ones in turn.
    for (std::size_t left = 10 * this->Flat.size(); left > 0 && !this->Flat.empty(); --left)
    {
      this->RemoveFlat();
    }
    std::vector<Triangle> result;
    std::copy_if(this->Triangles.begin(), this->Triangles.end(), std::back_inserter(result),
      [](const Triangle& triangle) { return triangle != Divided; });
    return result;
  }

private:
  using Edge = std::pair<Index, Index>;
  static constexpr Triangle Divided = { -1, -1, -1 };

  void RemoveRepeated()
  {
    std::vector<std::size_t> order(this->Triangles.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b)
      { return std::tie(this->Triangles[a], a) < std::tie(this->Triangles[b], b); });
    std::vector<std::uint8_t> isFirst(order.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i)
    {
      isFirst[order[i]] = this->Triangles[order[i]] != this->Triangles[order[i - 1]];
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      if (isFirst[i])
      {
        this->Triangles[kept++] = this->Triangles[i];
      }
    }
    this->Triangles.resize(kept);
  }

  /// Whether it is flat; its longest edge then becomes that of its first two points.
  bool TurnFlat(Triangle& triangle) const
  {
    const auto length = [&](int k)
    { return (this->X.row(triangle[(k + 1) % 3]) - this->X.row(triangle[k])).norm(); };
    int longest = 0;
    for (int k = 1; k < 3; ++k)
    {
      longest = length(k) > length(longest) ? k : longest;
    }
    const double area = 2 * morph::vectorArea(this->X, triangle.data(), 3).norm();
    if (area > this->Rounding * length(longest))
    {
      return false;
    }
    std::rotate(triangle.begin(), triangle.begin() + longest, triangle.end());
    return true;
  }

  template <typename Act>
  void ForEdges(std::size_t number, const Act& act) const
  {
    const Triangle& t = this->Triangles[number];
    for (int k = 0; k < 3; ++k)
    {
      act(Edge(std::minmax(t[k], t[(k + 1) % 3])));
    }
  }

  void FindEdges()
  {
    for (std::size_t i = 0; i < this->Triangles.size(); ++i)
    {
      this->ForEdges(i, [&](const Edge& edge) { this->AtEdge.emplace_back(edge, i); });
    }
    std::sort(this->AtEdge.begin(), this->AtEdge.end());
  }

  /// The triangles at an edge.
  std::vector<std::size_t> Beside(const Edge& edge) const
  {
    std::vector<std::size_t> result;
    for (auto at = std::lower_bound(
           this->AtEdge.begin(), this->AtEdge.end(), std::pair(edge, std::size_t(0)));
         at != this->AtEdge.end() && at->first == edge; ++at)
    {
      if (this->Triangles[at->second] != Divided)
      {
        result.push_back(at->second);
      }
    }
    const auto [first, last] = this->AtNewEdge.equal_range(edge);
    for (auto at = first; at != last; ++at)
    {
      if (this->Triangles[at->second] != Divided)
      {
        result.push_back(at->second);
      }
    }
    return result;
  }

  void RemoveFlat()
  {
    const Triangle flat = this->Flat.back();
    this->Flat.pop_back();
    const std::vector<std::size_t> beside = this->Beside(Edge(std::minmax(flat[0], flat[1])));
    if (beside.size() != 1)
    {
      return;
    }
    Triangle divided = std::exchange(this->Triangles[beside.front()], Divided);
    while (Edge(std::minmax(divided[0], divided[1])) != Edge(std::minmax(flat[0], flat[1])))
    {
      std::rotate(divided.begin(), divided.begin() + 1, divided.end());
    }
    for (Triangle part :
      { Triangle{ divided[0], flat[2], divided[2] }, Triangle{ flat[2], divided[1], divided[2] } })
    {
      if (part[0] == part[1] || part[1] == part[2] || part[2] == part[0])
      {
        continue;
      }
      if (this->TurnFlat(part))
      {
        this->Flat.push_back(part);
        continue;
      }
      this->Triangles.push_back(part);
      this->ForEdges(this->Triangles.size() - 1,
        [&](const Edge& edge) { this->AtNewEdge.emplace(edge, this->Triangles.size() - 1); });
    }
  }

  const morph::Points& X;
  double Rounding;
  std::vector<Triangle> Triangles;
  std::vector<Triangle> Flat;
  std::vector<std::pair<Edge, std::size_t>> AtEdge; ///< sorted, the numbers in Triangles
  std::multimap<Edge, std::size_t> AtNewEdge;       ///< of those behind them
};

/// The triangles of polygons and strips by merged points.
morph::BoundaryFaces triangles(
  vtkPolyData* surface, const morph::Points& x, const std::vector<Index>& merged)
{
  TriangleList list(x, roundingOf(x));
  const auto add = [&](Index a, Index b, Index c)
  {
    const Triangle triangle = { merged[a], merged[b], merged[c] };
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
    {
      list.Add(triangle);
    }
  };
  vtkNew<vtkIdList> points;
  vtkCellArray* polygons = surface->GetPolys();
  for (vtkIdType c = 0; c < polygons->GetNumberOfCells(); ++c)
  {
    polygons->GetCellAtId(c, points);
    for (vtkIdType k = 2; k < points->GetNumberOfIds(); ++k)
    {
      add(points->GetId(0), points->GetId(k - 1), points->GetId(k));
    }
  }
  vtkCellArray* strips = surface->GetStrips();
  for (vtkIdType c = 0; c < strips->GetNumberOfCells(); ++c)
  {
    strips->GetCellAtId(c, points);
    for (vtkIdType k = 2; k < points->GetNumberOfIds(); ++k)
    {
      // Every other triangle of a strip is wound the other way.
      add(points->GetId(k - 2), points->GetId(k - 1 + k % 2), points->GetId(k - k % 2));
    }
  }
  morph::BoundaryFaces faces;
  faces.offsets.push_back(0);
  for (const Triangle& triangle : list.Clean())
  {
    faces.connectivity.insert(faces.connectivity.end(), triangle.begin(), triangle.end());
    faces.offsets.push_back(static_cast<Index>(faces.connectivity.size()));
  }
  faces.nodes = faces.connectivity;
  std::sort(faces.nodes.begin(), faces.nodes.end());
  faces.nodes.erase(std::unique(faces.nodes.begin(), faces.nodes.end()), faces.nodes.end());
  faces.between.offsets.assign(faces.nodes.size() + 1, 0);
  return faces;
}

/// A locator over polygonal data made here. BuildCells: threads must not do it.
void locate(vtkPolyData* data, vtkStaticCellLocator* locator)
{
  data->BuildCells();
  locator->SetDataSet(data);
  locator->BuildLocator();
}

/// The nearest cell within `radius`, or -1.
vtkIdType nearest(
  vtkStaticCellLocator* locator, const Row& x, double radius, vtkGenericCell* cell, Row& y)
{
  double from[3] = { x[0], x[1], x[2] }, to[3], distance2 = 0;
  vtkIdType id = -1;
  int part = 0, inside = 0;
  if (!locator->FindClosestPointWithinRadius(from, radius, to, cell, id, part, distance2, inside))
  {
    return -1;
  }
  y = Row(to[0], to[1], to[2]);
  return id;
}

/// Throws for places that no search is made for: VTK's take endless time to come from there, or end
/// the process.
void requireUsable(const morph::Points& x, const morph::Points& mesh)
{
  constexpr double Farthest = 1e5; // sizes of the mesh
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < mesh.rows(); ++i)
  {
    box.extend(mesh.row(i).transpose());
  }
  std::vector<Index> notFinite, far;
  for (Index i = 0; i < x.rows(); ++i)
  {
    if (!x.row(i).allFinite())
    {
      notFinite.push_back(i);
    }
    else if (box.exteriorDistance(x.row(i).transpose()) > Farthest * box.diagonal().norm())
    {
      far.push_back(i);
    }
  }
  if (!notFinite.empty())
  {
    throw morph::Error("The target surface has coordinates that are not finite (NaN or infinite), "
                       "at its points " +
                       morph::listIds(notFinite) + ".");
  }
  if (!far.empty())
  {
    throw morph::Error("The target surface is farther from the mesh than 100,000 times its size, "
                       "at its points " +
                       morph::listIds(far) + ". Give it the unit and the origin of the mesh.");
  }
}

/// Triangles that can be searched.
class Triangles
{
public:
  /// Takes the triangles of `faces` that are listed in `some`.
  Triangles(vtkPoints* points, const morph::Points& x, const morph::BoundaryFaces& faces,
    const std::vector<Index>& some)
    : Normals(static_cast<Index>(some.size()), 3)
    , Centers(static_cast<Index>(some.size()), 3)
    , Radii(some.size(), 0)
  {
    vtkNew<vtkCellArray> polygons;
    for (std::size_t i = 0; i < some.size(); ++i)
    {
      const Index* nodes = faces.connectivity.data() + 3 * some[i];
      const vtkIdType corners[3] = { nodes[0], nodes[1], nodes[2] };
      polygons->InsertNextCell(3, corners);
      const Index row = static_cast<Index>(i);
      this->Normals.row(row) = morph::vectorArea(x, nodes, 3).normalized();
      this->Centers.row(row) = (x.row(nodes[0]) + x.row(nodes[1]) + x.row(nodes[2])) / 3;
      for (int k = 0; k < 3; ++k)
      {
        this->Radii[i] =
          std::max(this->Radii[i], (x.row(nodes[k]) - this->Centers.row(row)).norm());
      }
      this->Largest = std::max(this->Largest, this->Radii[i]);
    }
    this->Data->SetPoints(points);
    this->Data->SetPolys(polygons);
    locate(this->Data, this->Locator);
    this->CenterData->SetPoints(makePoints(this->Centers));
    this->CenterLocator->SetDataSet(this->CenterData);
    this->CenterLocator->BuildLocator();
  }

  vtkIdType Nearest(const Row& x, double radius, Row& y) const
  {
    vtkNew<vtkGenericCell> cell;
    return nearest(this->Locator, x, radius, cell, y);
  }

  vtkPolyData* Surface() const { return this->Data; }

  Row Normal(vtkIdType triangle) const { return this->Normals.row(triangle); }

  /// Whether there is a triangle within `radius` that `fits`; `y` is then the nearest place on
  /// these triangles.
  template <typename Fits>
  bool NearestThat(const Row& x, double radius, const Fits& fits, Row& y) const
  {
    vtkNew<vtkIdList> near;
    vtkNew<vtkGenericCell> cell;
    // Not by the cell locator: its search in a box takes time quadratic in the number found.
    this->CenterLocator->FindPointsWithinRadius(radius + this->Largest, x.data(), near);
    near->Sort(); // of equally near triangles the first
    double least = radius * radius;
    bool found = false;
    for (vtkIdType k = 0; k < near->GetNumberOfIds(); ++k)
    {
      const vtkIdType triangle = near->GetId(k);
      const double nearest = (x - this->Centers.row(triangle)).norm() - this->Radii[triangle];
      if (nearest > std::sqrt(least) || !fits(triangle))
      {
        continue;
      }
      double from[3] = { x[0], x[1], x[2] }, to[3], coordinates[3], weights[3], distance2 = 0;
      int part = 0;
      this->Data->GetCell(triangle, cell);
      if (cell->EvaluatePosition(from, to, part, coordinates, distance2, weights) >= 0 &&
          (distance2 < least || (!found && distance2 <= least)))
      {
        least = distance2;
        y = Row(to[0], to[1], to[2]);
        found = true;
      }
    }
    return found;
  }

  /// Whether the line through `x` meets a triangle that `fits` within `radius`; `y` is then the
  /// nearest such place. A triangle is wider by `tolerance` than its edges.
  template <typename Fits>
  bool NearestAlong(const Row& x, const Row& direction, double radius, double tolerance,
    const Fits& fits, Row& y) const
  {
    // At the rim of the surface, searching a little inside finds what is within the tolerance.
    double bounds[6];
    this->Data->GetBounds(bounds);
    const Row middle = Row(bounds[0] + bounds[1], bounds[2] + bounds[3], bounds[4] + bounds[5]) / 2;
    Row inside = middle - x;
    inside -= inside.dot(direction) * direction;
    const double far = inside.norm();
    inside *= far > 0 ? std::min(1., 2 * tolerance / far) : 0;
    const Row from = x + inside - radius * direction, to = x + inside + radius * direction;
    vtkNew<vtkIdList> near;
    vtkNew<vtkGenericCell> cell;
    Version::FindCellsAlongLine(*this->Locator, from.data(), to.data(), 4 * tolerance, near, cell);
    near->Sort(); // of equally near triangles the first
    double least = radius;
    bool found = false;
    for (vtkIdType k = 0; k < near->GetNumberOfIds(); ++k)
    {
      const vtkIdType triangle = near->GetId(k);
      const Row triangleNormal = this->Normal(triangle);
      const double across = triangleNormal.dot(direction);
      if (across == 0 || !fits(triangle))
      {
        continue;
      }
      const double along = (this->Centers.row(triangle) - x).dot(triangleNormal) / across;
      const Row place = x + along * direction;
      // A place in a steep triangle is the farther off, the steeper it is.
      if (this->IsInside(triangle, place, 4 * tolerance / std::abs(across), cell) &&
          (std::abs(along) < least || (!found && std::abs(along) <= least)))
      {
        least = std::abs(along);
        y = place;
        found = true;
      }
    }
    return found;
  }

private:
  /// Whether a place in the triangle's plane is inside of it, or no farther than the tolerance.
  bool IsInside(vtkIdType triangle, const Row& place, double tolerance, vtkGenericCell* cell) const
  {
    this->Data->GetCell(triangle, cell);
    Row corner[3];
    for (int k = 0; k < 3; ++k)
    {
      cell->GetPoints()->GetPoint(k, corner[k].data());
    }
    const Row normal = this->Normal(triangle);
    for (int k = 0; k < 3; ++k)
    {
      const Row edge = corner[(k + 1) % 3] - corner[k];
      if (edge.cross(place - corner[k]).dot(normal) < -tolerance * edge.norm())
      {
        return false;
      }
    }
    return true;
  }

  vtkNew<vtkPolyData> Data;
  vtkNew<vtkStaticCellLocator> Locator;
  vtkNew<vtkPolyData> CenterData;
  vtkNew<vtkStaticPointLocator> CenterLocator;
  morph::Points Normals;     ///< #triangles x 3, unit length; zero without area
  morph::Points Centers;     ///< #triangles x 3
  std::vector<double> Radii; ///< #triangles, of the spheres about the centers that hold them
  double Largest = 0;
};
}

struct Target::Implementation
{
  morph::Points X;
  morph::BoundaryFaces Faces;
  morph::Classification Geometry;
  vtkSmartPointer<vtkPoints> Points;
  std::unique_ptr<Triangles> All;
  /// by the target's surfaces, where one was asked for
  std::vector<std::unique_ptr<Triangles>> Parts;
  std::vector<const Triangles*> OfSurface; ///< by the mesh's surfaces
  vtkNew<vtkPolyData> Features;
  vtkNew<vtkStaticCellLocator> FeatureLocator;
  double Sign = 1;
  double Cosine = 0;
  double Reach = 0;
  Precision PointPrecision;

  /// How far a place may be off in single precision.
  double Rounding() const
  {
    return this->PointPrecision.IsFloat ? std::sqrt(3) / 2 * this->PointPrecision.Step() : 0;
  }
  /// Returns `found`. A place `y` that was found as near to `x` as that is `x` itself.
  bool Found(bool found, const Row& x, Row& y) const
  {
    if (found && (y - x).norm() <= this->Rounding())
    {
      y = x;
    }
    return found;
  }

  /// Adds one to the count of each of the target's surfaces within `distance` of `x`.
  void Vote(const Row& x, double distance, std::vector<Index>& count) const
  {
    std::vector<Index> candidates;
    Row y;
    const auto collect = [&](vtkIdType triangle)
    {
      candidates.push_back(this->Geometry.surfaceOfFace[triangle]);
      return false;
    };
    this->All->NearestThat(x, distance, collect, y);
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    for (Index s : candidates)
    {
      const auto belongs = [&](vtkIdType triangle)
      { return this->Geometry.surfaceOfFace[triangle] == s; };
      count[s] += this->All->NearestThat(x, distance, belongs, y);
    }
  }

  const Triangles* Part(Index surface)
  {
    std::unique_ptr<Triangles>& part = this->Parts[surface];
    if (!part)
    {
      part = std::make_unique<Triangles>(
        this->Points, this->X, this->Faces, this->Geometry.surfaces[surface].faces);
    }
    return part.get();
  }
};

Target::Target(vtkPolyData* surface, const morph::Points& mesh, double featureAngle,
  double normalAngle, double reach, morph::Monitor& monitor)
  : Internals(new Implementation)
{
  Implementation& own = *this->Internals;
  own.Cosine = std::cos(normalAngle * std::acos(-1.) / 180);
  own.Reach = reach;
  own.X = GridMesh::FromPoints(surface->GetPoints());
  own.PointPrecision = Precision::Of(surface->GetPoints(), own.X);
  requireUsable(own.X, mesh);
  own.Faces = triangles(surface, own.X, mergedPoints(own.X));
  std::vector<Index> all(own.Faces.offsets.size() - 1);
  if (all.empty())
  {
    throw morph::Error("The target surface has no polygons to project onto (it has " +
                       std::to_string(surface->GetNumberOfCells()) + " cells and " +
                       std::to_string(own.X.rows()) + " points).");
  }
  std::iota(all.begin(), all.end(), Index(0));
  own.Points = makePoints(own.X);
  own.All = std::make_unique<Triangles>(own.Points, own.X, own.Faces, all);

  morph::ClassificationOptions options;
  options.featureAngle = featureAngle;
  own.Geometry = morph::classify(own.X, own.Faces, options, monitor);
  own.Parts.resize(own.Geometry.surfaces.size());
  vtkNew<vtkCellArray> lines;
  for (const morph::GeometryCurve& curve : own.Geometry.curves)
  {
    const std::size_t n = curve.nodes.size();
    for (std::size_t i = 0; i + 1 < n + curve.loop; ++i)
    {
      const vtkIdType ends[2] = { curve.nodes[i], curve.nodes[(i + 1) % n] };
      lines->InsertNextCell(2, ends);
    }
  }
  own.Features->SetPoints(own.Points);
  own.Features->SetLines(lines);
  if (this->HasFeatures())
  {
    locate(own.Features, own.FeatureLocator);
  }
}

Target::~Target() = default;

void Target::Orient(const morph::Points& points, const morph::Points& normals)
{
  Implementation& own = *this->Internals;
  std::vector<Index> voters;
  for (Index i = 0; i < points.rows(); ++i)
  {
    if (!normals.row(i).isZero(0))
    {
      voters.push_back(i);
    }
  }
  Index agree = 0, disagree = 0;
  Row y;
  const std::size_t stride = 1 + voters.size() / 2000; // a sample is enough
  for (std::size_t k = 0; k < voters.size(); k += stride)
  {
    const Index i = voters[k];
    const vtkIdType triangle = own.All->Nearest(points.row(i), own.Reach, y);
    const double cosine = triangle < 0 ? 0 : own.All->Normal(triangle).dot(normals.row(i));
    agree += cosine > 0.5;
    disagree += cosine < -0.5;
  }
  own.Sign = disagree > agree ? -1 : 1;
}

void Target::Assign(const morph::Classification& geometry, const morph::Points& moved)
{
  Implementation& own = *this->Internals;
  const double size = (own.X.colwise().maxCoeff() - own.X.colwise().minCoeff()).norm();
  own.OfSurface.assign(geometry.surfaces.size(), nullptr);
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    std::vector<Index> votes(own.Geometry.surfaces.size(), 0);
    Index voters = 0;
    for (Index node : geometry.surfaces[s].nodes)
    {
      if (geometry.dimension[node] < 2)
      {
        ++voters;
        own.Vote(moved.row(node), 1e-3 * size, votes);
      }
    }
    const auto best = std::max_element(votes.begin(), votes.end());
    if (best != votes.end() && 2 * *best > voters &&
        std::count(votes.begin(), votes.end(), *best) == 1)
    {
      own.OfSurface[s] = own.Part(best - votes.begin());
    }
  }
}

bool Target::HasFeatures() const
{
  return this->Internals->Features->GetNumberOfCells() > 0;
}

void Target::TakePrecision(const Target& original)
{
  this->Internals->PointPrecision = original.Internals->PointPrecision;
}

void Target::WarnOfRounding(double size, morph::Monitor& monitor) const
{
  const Implementation& own = *this->Internals;
  if (own.Rounding() > 1e-6 * size)
  {
    monitor.warn(
      "The target has " + own.PointPrecision.Text() +
      ". Nodes as near to it as that stay, and others are as far off. Write it in double "
      "precision, in a VTK file for instance, or with an origin near the mesh.");
  }
}

vtkPolyData* Target::Surface() const
{
  return this->Internals->All->Surface();
}

bool Target::ClosestOnVertices(const Row& x, Row& y) const
{
  const Implementation& own = *this->Internals;
  double least = own.Reach;
  bool found = false;
  for (const morph::GeometryVertex& vertex : own.Geometry.vertices)
  {
    const double distance = (own.X.row(vertex.node) - x).norm();
    if (distance < least || (!found && distance <= least))
    {
      least = distance;
      y = own.X.row(vertex.node);
      found = true;
    }
  }
  return own.Found(found, x, y);
}

bool Target::closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const
{
  const Implementation& own = *this->Internals;
  const bool isAssigned = surface >= 0 && !own.OfSurface.empty();
  const Triangles* assigned =
    isAssigned ? own.OfSurface[static_cast<std::size_t>(surface)] : nullptr;
  const Triangles& place = assigned ? *assigned : *own.All;
  const auto fits = [&](vtkIdType triangle)
  { return normal.isZero(0) || own.Sign * place.Normal(triangle).dot(normal) >= own.Cosine; };
  const vtkIdType first = place.Nearest(x, own.Reach, y);
  if (first < 0 || fits(first))
  {
    return own.Found(first >= 0, x, y);
  }
  // Another wall is nearer, or an edge where triangles meet: search farther, and only triangles
  // that fit.
  const double distance = (y - x).norm();
  for (double radius = std::max(2 * distance, 1e-3 * own.Reach);; radius *= 2)
  {
    radius = std::min(radius, own.Reach);
    if (place.NearestThat(x, radius, fits, y))
    {
      return own.Found(true, x, y);
    }
    if (radius >= own.Reach)
    {
      return false;
    }
  }
}

bool Target::ClosestAlong(const Row& x, const Row& direction, const Row& normal, Row& y) const
{
  const Implementation& own = *this->Internals;
  const auto fits = [&](vtkIdType triangle)
  { return normal.isZero(0) || own.Sign * own.All->Normal(triangle).dot(normal) >= own.Cosine; };
  return own.All->NearestAlong(x, direction, own.Reach, roundingOf(own.X), fits, y);
}

bool Target::closestOnFeatures(Index, const Row& x, Row& y) const
{
  const Implementation& own = *this->Internals;
  vtkNew<vtkGenericCell> cell;
  return own.Found(
    this->HasFeatures() && nearest(own.FeatureLocator, x, own.Reach, cell, y) >= 0, x, y);
}
}
