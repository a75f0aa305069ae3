// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/BoundaryModel.h"

#include "Boundary/FaceAreas.h"
#include "Mesh/FacesOfCells.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Pipeline/Input.h"
#include "Support/Error.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;

/// The arrays and options that the geometry of an input depends on beside its points and faces.
std::string geometryKey(vtkPointSet* input, const Geometry::Options& options)
{
  std::ostringstream key;
  key.precision(17);
  key << input->GetClassName() << ' ' << options.FeatureAngle << ' ' << options.CornerAngle << ' '
      << options.FeaturesInside << ' ' << options.UseGeometryArrays << ' '
      << options.SurfaceIdArray;
  const auto add = [&key](vtkAbstractArray* array) {
    key << '\n' << array << ' ' << (array ? array->GetMTime() : 0);
  };
  if (!options.SurfaceIdArray.empty())
  {
    add(input->GetCellData()->GetAbstractArray(options.SurfaceIdArray.c_str()));
  }
  else if (options.UseGeometryArrays)
  {
    for (const char* name : { Geometry::DimensionName, Geometry::IdName, Geometry::ParameterName })
    {
      add(input->GetPointData()->GetAbstractArray(name));
    }
  }
  return key.str();
}

/// An array that vtkExtractMorphBoundary wrote.
vtkDataArray* requireExtracted(vtkPolyData* surface, const char* name, int components)
{
  vtkDataArray* array = surface->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfComponents() < components ||
      array->GetNumberOfTuples() != surface->GetNumberOfPoints())
  {
    throw Error(
      std::string("The input is a surface ") +
      (array ? "whose point array " : "without the point array ") + name +
      (array ? " has the wrong number of components or values" : "") +
      ", so a morph could not tell which nodes of the mesh its points are. Give the volume "
      "mesh itself, or its boundary from Extract Morph Boundary or Classify Boundary.");
  }
  return array;
}

/// Throws for coordinates that are not finite or too large; `what`: "coordinates".
morph::Points moderatePoints(morph::Points points, const char* what)
{
  std::vector<Index> notFinite, huge;
  for (const Index n : DataCheck::Immoderate(points))
  {
    (points.row(n).allFinite() ? huge : notFinite).push_back(n);
  }
  if (!notFinite.empty())
  {
    throw Error(std::string("The input has ") + what +
                " that are not finite (NaN or infinite), at its points " +
                morph::listIds(notFinite) + ".");
  }
  if (!huge.empty())
  {
    throw Error(std::string("The input has ") + what + " above 1e50, at its points " +
                morph::listIds(huge) + ".");
  }
  return points;
}

morph::BoundaryFaces polygons(vtkPolyData* surface)
{
  morph::BoundaryFaces faces;
  faces.offsets.push_back(0);
  vtkNew<vtkIdList> corners;
  std::vector<Index> wrong;
  vtkCellArray* cells = surface->GetPolys();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellAtId(c, corners);
    const vtkIdType* begin = corners->GetPointer(0);
    faces.connectivity.insert(faces.connectivity.end(), begin, begin + corners->GetNumberOfIds());
    faces.offsets.push_back(static_cast<Index>(faces.connectivity.size()));
    if (corners->GetNumberOfIds() < 3)
    {
      wrong.push_back(surface->GetNumberOfVerts() + surface->GetNumberOfLines() + c);
    }
  }
  if (faces.offsets.size() == 1)
  {
    throw Error(
      "The input is a surface without polygons, so there is no boundary to move. Give the "
      "volume mesh, or its boundary from Extract Morph Boundary or Classify Boundary.");
  }
  if (!wrong.empty())
  {
    throw Error("The input has polygons with fewer than three points: its cells " +
                morph::listIds(wrong) + ". Remove them.");
  }
  faces.nodes = faces.connectivity;
  std::sort(faces.nodes.begin(), faces.nodes.end());
  faces.nodes.erase(std::unique(faces.nodes.begin(), faces.nodes.end()), faces.nodes.end());
  faces.between.offsets.assign(faces.nodes.size() + 1, 0);
  return faces;
}

/// The diagonal of the box around these nodes; 0 for none.
double sizeOf(const morph::Points& points, const std::vector<Index>& nodes)
{
  Eigen::AlignedBox3d box;
  for (const Index node : nodes)
  {
    box.extend(points.row(node).transpose());
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

bool samePoints(const morph::Points& a, const morph::Points& b)
{
  return a.rows() == b.rows() && a == b; // Eigen reads past the end of the shorter one
}

bool sameFaces(const morph::BoundaryFaces& a, const morph::BoundaryFaces& b)
{
  return a.offsets == b.offsets && a.connectivity == b.connectivity;
}
}

void BoundaryModel::Update(vtkPointSet* input, const Geometry::Options& options,
  morph::Monitor& monitor, const WholeSurface* whole)
{
  const std::string key = geometryKey(input, options);
  if (this->Kept.Input == input && this->Kept.InputTime == input->GetMTime() &&
      this->Kept.GeometryKey == key)
  {
    return;
  }
  State next;
  std::swap(next, this->Kept); // so that nothing is kept after an error
  next.Input = input;
  next.InputTime = input->GetMTime();
  next.InputVersion = ++this->Versions;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    this->TakeGrid(grid, options, key, whole, next, monitor);
  }
  else
  {
    this->TakeSurface(vtkPolyData::SafeDownCast(input), options, key, next, monitor);
  }
  const Index firstPolygon = next.Surface->GetNumberOfVerts() + next.Surface->GetNumberOfLines();
  next.NamedSets = FindNamedSets(input, next.Mesh, next.Faces, firstPolygon, next.Inner.size());
  const auto outer = std::stable_partition(next.NamedSets.begin(), next.NamedSets.end(),
    [](const NamedSet& set) { return !set.Nodes.empty(); });
  next.SetsInside.assign(outer, next.NamedSets.end());
  next.NamedSets.erase(outer, next.NamedSets.end());
  AddNamedSets(next.NamedSets, next.FaceOfPolygon, firstPolygon, next.Surface);
  next.GeometryKey = key;
  next.Size = sizeOf(next.Mesh.points, next.Faces.nodes);
  this->Kept = std::move(next);
  std::stable_partition(this->Kept.NamedSets.begin(), this->Kept.NamedSets.end(),
    [this](const NamedSet& set) { return !this->AreInner(set.Faces); });
}

void BoundaryModel::FindFaces(vtkUnstructuredGrid* grid, State& next, morph::Monitor& monitor)
{
  next.Mesh = GridMesh::FromGrid(grid);
  Input::RequireVolumeCells(next.Mesh);
  const morph::ConnectedComponents bodies = morph::connectedComponents(next.Mesh);
  next.BodyOfNode = bodies.ofNode;
  next.Faces = morph::boundaryFaces(next.Mesh, monitor);
  next.IsNamed = CellsOfNamedSets(grid);
  AddInner(next, monitor);
  const std::vector<std::int8_t> ofCell = morph::cellSigns(next.Mesh, bodies);
  next.Orientation.clear();
  for (Index cell : next.Faces.cells)
  {
    next.Orientation.push_back(ofCell[cell]);
  }
  monitor.check();
}

void BoundaryModel::AddInner(State& next, morph::Monitor& monitor)
{
  next.Inner = morph::innerFaces(next.Mesh, next.Faces, next.IsNamed, monitor);
  if (next.Inner.size() == 0)
  {
    return;
  }
  std::vector<std::pair<Index, int>> places;
  for (std::size_t f = 0; f < next.Faces.cells.size(); ++f)
  {
    places.emplace_back(next.Faces.cells[f], next.Faces.sides[f]);
  }
  for (const auto* inner : { &next.Inner.baffles, &next.Inner.sheets })
  {
    places.insert(places.end(), inner->begin(), inner->end());
  }
  next.Faces = morph::facesAt(next.Mesh, places);
}

bool BoundaryModel::AreLast(const std::vector<Index>& faces, std::size_t number) const
{
  const auto first = static_cast<Index>(this->Kept.Faces.offsets.size() - 1 - number);
  return !faces.empty() &&
         std::all_of(faces.begin(), faces.end(), [first](Index face) { return face >= first; });
}

bool BoundaryModel::AreInner(const std::vector<Index>& faces) const
{
  return this->AreLast(faces, this->Kept.Inner.size());
}

std::vector<Index> BoundaryModel::Sheets() const
{
  std::vector<Index> result;
  for (std::size_t s = 0; s < this->Kept.Geometry.surfaces.size(); ++s)
  {
    if (this->AreLast(this->Kept.Geometry.surfaces[s].faces, this->Kept.Inner.sheets.size()))
    {
      result.push_back(static_cast<Index>(s));
    }
  }
  return result;
}

std::vector<std::uint8_t> BoundaryModel::NodesOnlyOn(const std::vector<Index>& surfaces) const
{
  std::vector<std::uint8_t> result(this->Points().rows(), 0);
  const auto mark = [&](Index surface, std::uint8_t value)
  {
    for (const Index node : this->Kept.Geometry.surfaces[surface].nodes)
    {
      result[node] = value;
    }
  };
  for (const Index s : surfaces)
  {
    mark(s, 1);
  }
  for (std::size_t s = 0; s < this->Kept.Geometry.surfaces.size(); ++s)
  {
    if (!std::binary_search(surfaces.begin(), surfaces.end(), static_cast<Index>(s)))
    {
      mark(static_cast<Index>(s), 0);
    }
  }
  return result;
}

void BoundaryModel::TakeFaces(const WholeSurface& whole, State& next)
{
  next.Inner = {};
  next.Mesh = whole.Mesh();
  next.BodyOfNode = whole.BodyOfNode();
  next.Faces = whole.Faces();
  next.Orientation.clear();
  for (Index cell : next.Faces.cells)
  {
    next.Orientation.push_back(whole.Orientation()[cell]);
  }
}

void BoundaryModel::TakeGrid(vtkUnstructuredGrid* grid, const Geometry::Options& options,
  const std::string& geometryKey, const WholeSurface* whole, State& next, morph::Monitor& monitor)
{
  const bool sameMesh =
    next.Mesh.numberOfCells() > 0 && GridMesh::SameCells(grid, next.Mesh) &&
    GridMesh::SamePoints(grid, next.Mesh) &&
    (whole ? sameFaces(next.Faces, whole->Faces()) : next.IsNamed == CellsOfNamedSets(grid));
  if (!sameMesh && whole)
  {
    TakeFaces(*whole, next);
  }
  else if (!sameMesh)
  {
    FindFaces(grid, next, monitor);
  }
  if (!sameMesh || next.GeometryKey != geometryKey)
  {
    next.Geometry = Geometry::Classify(grid, next.Mesh, next.Faces, options, monitor);
    next.MotionVersion = ++this->Versions;
    ++this->Classified;
  }
  next.Surface = vtkSmartPointer<vtkPolyData>::New();
  next.FaceOfPolygon = Surface::Write(
    grid, next.Mesh, next.Faces, next.Surface, whole ? &whole->Orientation() : nullptr);
  next.NodeOfPoint = next.Faces.nodes;
  if (next.Inner.size() > 0)
  {
    const auto first = static_cast<Index>(next.Faces.cells.size() - next.Inner.size());
    vtkNew<vtkUnsignedCharArray> isInner;
    isInner->SetName("Inner");
    for (const Index face : next.FaceOfPolygon)
    {
      isInner->InsertNextValue(face >= first);
    }
    next.Surface->GetCellData()->AddArray(isInner);
  }
  Geometry::AddPointArrays(next.Geometry, next.NodeOfPoint, next.Surface->GetPointData());
  Geometry::AddSurfaceIds(next.Geometry, next.FaceOfPolygon, next.Surface);
}

void BoundaryModel::TakeSurface(vtkPolyData* surface, const Geometry::Options& options,
  const std::string& geometryKey, State& next, morph::Monitor& monitor)
{
  next.Inner = {};
  morph::BoundaryFaces faces = polygons(surface);
  requireExtracted(surface, Surface::IdName, 1);
  morph::Points rest =
    moderatePoints(GridMesh::FromVectors(requireExtracted(surface, Surface::RestName, 3)),
      "values of RestPosition");
  morph::Points points = moderatePoints(GridMesh::FromPoints(surface->GetPoints()), "coordinates");
  const bool sameGeometry =
    next.GeometryKey == geometryKey && sameFaces(next.Faces, faces) && samePoints(next.Rest, rest);
  if (!sameGeometry)
  {
    next.Geometry = Geometry::Classify(surface, rest, faces, options, monitor);
    next.Faces = std::move(faces);
    next.Orientation.assign(next.Faces.offsets.size() - 1, 1);
    next.Rest = std::move(rest);
    next.BodyOfNode.assign(points.rows(), -1);
    ++this->Classified;
  }
  if (!sameGeometry || !samePoints(next.Mesh.points, points))
  {
    next.MotionVersion = ++this->Versions;
  }
  next.Mesh = morph::Mesh();
  next.Mesh.points = std::move(points);
  next.Surface = vtkSmartPointer<vtkPolyData>::New();
  next.Surface->ShallowCopy(surface);
  next.NodeOfPoint.resize(surface->GetNumberOfPoints());
  std::iota(next.NodeOfPoint.begin(), next.NodeOfPoint.end(), Index(0));
  next.FaceOfPolygon.resize(next.Faces.offsets.size() - 1);
  std::iota(next.FaceOfPolygon.begin(), next.FaceOfPolygon.end(), Index(0));
  Geometry::AddPointArrays(next.Geometry, next.NodeOfPoint, next.Surface->GetPointData());
  if (next.FaceOfPolygon.size() == static_cast<std::size_t>(surface->GetNumberOfCells()))
  {
    Geometry::AddSurfaceIds(next.Geometry, next.FaceOfPolygon, next.Surface);
  }
}

morph::Points BoundaryModel::OutwardAreas(const morph::Points& points) const
{
  morph::Points areas = morph::faceAreas(points, this->Kept.Faces);
  for (Index f = 0; f < areas.rows(); ++f)
  {
    areas.row(f) *= this->Kept.Orientation[f];
  }
  return areas;
}

vtkPolyData* BoundaryModel::Surface() const
{
  return this->Kept.Surface;
}

morph::Index BoundaryModel::FirstPolygon() const
{
  return this->Kept.Surface->GetNumberOfVerts() + this->Kept.Surface->GetNumberOfLines();
}
}
