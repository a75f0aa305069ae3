// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphTarget.h"

#include "Error.h"
#include "vtkMorphMesh.h"

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
#include <cmath>
#include <vector>

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

/// For each point the one that stands for all within the rounding of single precision, in which STL
/// files are written.
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
  locator->MergePoints(1e-7 * data->GetLength(), merged.data());
  return { merged.begin(), merged.end() };
}

/// The triangles of polygons and strips by merged points. Those without three different points are
/// left out.
morph::BoundaryFaces triangles(vtkPolyData* surface, const std::vector<Index>& merged)
{
  morph::BoundaryFaces faces;
  faces.offsets.push_back(0);
  const auto add = [&](Index a, Index b, Index c)
  {
    a = merged[a];
    b = merged[b];
    c = merged[c];
    if (a != b && b != c && c != a)
    {
      faces.connectivity.insert(faces.connectivity.end(), { a, b, c });
      faces.offsets.push_back(static_cast<Index>(faces.connectivity.size()));
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
}

struct vtkMorphTarget::Implementation
{
  vtkNew<vtkPolyData> Surface, Features;
  vtkNew<vtkStaticCellLocator> SurfaceLocator, FeatureLocator;
  morph::Points Normals; ///< #triangles x 3, unit length; zero without area
  double Sign = 1;
  double Cosine = 0;
  double Reach = 0;

  bool Fits(vtkIdType triangle, const Row& normal) const
  {
    return normal.isZero(0) || this->Sign * this->Normals.row(triangle).dot(normal) >= this->Cosine;
  }
};

vtkMorphTarget::vtkMorphTarget(vtkPolyData* surface, double featureAngle, double normalAngle,
  double reach, morph::Monitor& monitor)
  : Internals(new Implementation)
{
  Implementation& own = *this->Internals;
  own.Cosine = std::cos(normalAngle * std::acos(-1.) / 180);
  own.Reach = reach;
  const morph::Points x = vtkMorphMesh::FromPoints(surface->GetPoints());
  std::vector<Index> wrong;
  for (Index i = 0; i < x.rows(); ++i)
  {
    if (!x.row(i).allFinite())
    {
      wrong.push_back(i);
    }
  }
  if (!wrong.empty())
  {
    throw morph::Error("The target surface has coordinates that are not finite (NaN or infinite), "
                       "at its points " +
                       morph::listIds(wrong) + ".");
  }
  const morph::BoundaryFaces faces = triangles(surface, mergedPoints(x));
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  if (count == 0)
  {
    throw morph::Error("The target surface has no polygons to project onto (it has " +
                       std::to_string(surface->GetNumberOfCells()) + " cells and " +
                       std::to_string(x.rows()) + " points).");
  }

  own.Surface->SetPoints(makePoints(x));
  vtkNew<vtkCellArray> polygons;
  own.Normals.resize(count, 3);
  for (Index f = 0; f < count; ++f)
  {
    const Index* nodes = faces.connectivity.data() + 3 * f;
    const vtkIdType corners[3] = { nodes[0], nodes[1], nodes[2] };
    polygons->InsertNextCell(3, corners);
    own.Normals.row(f) = morph::vectorArea(x, nodes, 3).normalized();
  }
  own.Surface->SetPolys(polygons);
  locate(own.Surface, own.SurfaceLocator);

  morph::ClassificationOptions options;
  options.featureAngle = featureAngle;
  const morph::Classification geometry = morph::classify(x, faces, options, monitor);
  vtkNew<vtkCellArray> lines;
  for (const morph::GeometryCurve& curve : geometry.curves)
  {
    const std::size_t n = curve.nodes.size();
    for (std::size_t i = 0; i + 1 < n + curve.loop; ++i)
    {
      const vtkIdType ends[2] = { curve.nodes[i], curve.nodes[(i + 1) % n] };
      lines->InsertNextCell(2, ends);
    }
  }
  own.Features->SetPoints(own.Surface->GetPoints());
  own.Features->SetLines(lines);
  if (this->HasFeatures())
  {
    locate(own.Features, own.FeatureLocator);
  }
}

vtkMorphTarget::~vtkMorphTarget() = default;

void vtkMorphTarget::Orient(const morph::Points& points, const morph::Points& normals)
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
  vtkNew<vtkGenericCell> cell;
  Row y;
  const std::size_t stride = 1 + voters.size() / 2000; // as good as all of them
  for (std::size_t k = 0; k < voters.size(); k += stride)
  {
    const Index i = voters[k];
    const vtkIdType triangle = nearest(own.SurfaceLocator, points.row(i), own.Reach, cell, y);
    const double cosine = triangle < 0 ? 0 : own.Normals.row(triangle).dot(normals.row(i));
    agree += cosine > 0.5;
    disagree += cosine < -0.5;
  }
  own.Sign = disagree > agree ? -1 : 1;
}

bool vtkMorphTarget::HasFeatures() const
{
  return this->Internals->Features->GetNumberOfCells() > 0;
}

bool vtkMorphTarget::closestOnSurface(const Row& x, const Row& normal, Row& y) const
{
  const Implementation& own = *this->Internals;
  vtkNew<vtkGenericCell> cell;
  const vtkIdType first = nearest(own.SurfaceLocator, x, own.Reach, cell, y);
  if (first < 0 || own.Fits(first, normal))
  {
    return first >= 0;
  }
  // Another wall is nearer, or an edge where triangles meet: look further out among those that fit.
  vtkNew<vtkIdList> near;
  const double distance = (y - x).norm();
  for (double radius = std::max(2 * distance, 1e-3 * own.Reach);; radius *= 2)
  {
    radius = std::min(radius, own.Reach);
    double box[6] = { x[0] - radius, x[0] + radius, x[1] - radius, x[1] + radius, x[2] - radius,
      x[2] + radius };
    own.SurfaceLocator->FindCellsWithinBounds(box, near);
    near->Sort(); // of equally near triangles the merged
    double least = radius * radius;
    bool found = false;
    for (vtkIdType k = 0; k < near->GetNumberOfIds(); ++k)
    {
      const vtkIdType triangle = near->GetId(k);
      if (!own.Fits(triangle, normal))
      {
        continue;
      }
      double from[3] = { x[0], x[1], x[2] }, to[3], coordinates[3], weights[3], distance2 = 0;
      int part = 0;
      own.Surface->GetCell(triangle, cell);
      if (cell->EvaluatePosition(from, to, part, coordinates, distance2, weights) >= 0 &&
          (distance2 < least || (!found && distance2 <= least)))
      {
        least = distance2;
        y = Row(to[0], to[1], to[2]);
        found = true;
      }
    }
    if (found || radius >= own.Reach)
    {
      return found;
    }
  }
}

bool vtkMorphTarget::closestOnFeatures(const Row& x, Row& y) const
{
  const Implementation& own = *this->Internals;
  vtkNew<vtkGenericCell> cell;
  return this->HasFeatures() && nearest(own.FeatureLocator, x, own.Reach, cell, y) >= 0;
}
