// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/InputBoundary.h"

#include "Mesh/InnerFaces.h"
#include "Mesh/Mesh.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/GatheredSurface.h"
#include "Support/Error.h"
#include "Support/Lists.h"

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

#include <algorithm>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;

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
  for (const Index n : morph::immoderateRows(points))
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
  vtkNew<vtkIdList> corners;
  std::vector<Index> wrong;
  vtkCellArray* cells = surface->GetPolys();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellAtId(c, corners);
    const vtkIdType* begin = corners->GetPointer(0);
    faces.add(begin, begin + corners->GetNumberOfIds());
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
  faces.takeNodes();
  return faces;
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

std::set<std::string> InputBoundary::Asked(const std::set<std::string>& names) const
{
  std::set<std::string> result;
  for (const morph::InnerSurface& surface : this->innerSurfaces)
  {
    if (names.count(surface.name) > 0)
    {
      result.insert(surface.name);
    }
  }
  return result;
}

void InputBoundary::FindInnerSurfaces(
  vtkUnstructuredGrid* grid, const MergedBlocks* blocks, bool sameMesh, morph::Monitor& monitor)
{
  std::vector<Zones::Listed> listed = Zones::List(grid, this->mesh, blocks);
  std::vector<morph::NamedNodes> sets = NodeSets(grid);
  if (sameMesh && listed == this->Listed && sets == this->Sets)
  {
    return;
  }
  this->Listed = std::move(listed);
  this->Sets = std::move(sets);
  std::vector<morph::NamedCells> parts;
  for (const Zones::Listed& zone : this->Listed)
  {
    if (!zone.Cells.empty())
    {
      parts.push_back({ zone.Name, zone.Cells });
    }
  }
  this->innerSurfaces = morph::innerSurfaces(this->mesh, parts, this->Sets, monitor);
}

void InputBoundary::Update(vtkPointSet* input, const Options& options, morph::Monitor& monitor)
{
  const std::string key = Geometry::Key(input, options);
  if (this->Input == input && this->InputTime == input->GetMTime() && this->GeometryKey == key &&
      this->asked == this->Asked(options.Names))
  {
    return;
  }
  InputBoundary next = std::exchange(*this, InputBoundary()); // so nothing is kept if it throws
  this->Versions = next.Versions;
  this->Classified = next.Classified;
  next.inputVersion = ++next.Versions;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    next.TakeGrid(grid, options, key, monitor);
  }
  else
  {
    next.TakeSurface(vtkPolyData::SafeDownCast(input), options, key, monitor);
  }
  next.takeSets(
    FindNamedSets(input, next.mesh, next.faces, next.FirstPolygon(), next.inner.size()));
  AddNamedSets(next.namedSets, next.Polygons, next.FirstPolygon(), next.Written);
  next.Input = input;
  next.InputTime = input->GetMTime();
  next.GeometryKey = key;
  *this = std::move(next);
}

bool InputBoundary::LieInside(const GatheredSurface& boundary, const std::set<std::string>& names)
{
  std::map<morph::Corners, int> flat =
    morph::flatCells(boundary.Shell, CellsOfNamedSets(boundary.Grid));
  for (std::size_t f = 0; f < boundary.Faces.cells.size(); ++f)
  {
    flat.erase(morph::cornersOfCell(boundary.Shell, boundary.Faces, static_cast<Index>(f)));
  }
  std::set<std::string> outer;
  for (const NamedSet& set : FindNamedSets(boundary.Grid, boundary.Shell, boundary.Faces, 0))
  {
    if (!set.faces.empty())
    {
      outer.insert(set.name);
    }
  }
  const std::vector<std::string> sets = NamesOfSets(boundary.Grid);
  const auto mayLieInside = [&](const std::string& name)
  {
    return name.find(" | ") != std::string::npos ||
           (outer.count(name) == 0 && std::find(sets.begin(), sets.end(), name) != sets.end());
  };
  return !flat.empty() || std::any_of(names.begin(), names.end(), mayLieInside);
}

void InputBoundary::TakeFaces(const GatheredSurface& whole)
{
  this->inner = {};
  this->innerSurfaces.clear();
  this->asked.clear();
  this->Listed.clear();
  this->Sets.clear();
  this->mesh = whole.Shell;
  this->bodyOfNode = whole.BodyOfNode;
  this->faces = whole.Faces;
  this->orientation.clear();
  for (const Index cell : this->faces.cells)
  {
    this->orientation.push_back(whole.Orientation[cell]);
  }
}

void InputBoundary::TakeGrid(vtkUnstructuredGrid* grid, const Options& options,
  const std::string& key, morph::Monitor& monitor)
{
  const GatheredSurface* whole =
    options.Whole && !options.Whole->HasAll ? options.Whole : nullptr; // of the boundary alone
  const bool sameMesh = this->mesh.numberOfCells() > 0 && GridMesh::SameCells(grid, this->mesh) &&
                        GridMesh::SamePoints(grid, this->mesh);
  bool sameBoundary = sameMesh && whole && sameFaces(this->faces, whole->Faces);
  if (!sameBoundary && whole)
  {
    this->TakeFaces(*whole);
  }
  else if (!whole)
  {
    if (!sameMesh)
    {
      this->mesh = GridMesh::FromGrid(grid);
      morph::requireVolumeCells(this->mesh);
    }
    this->FindInnerSurfaces(grid, options.Blocks, sameMesh, monitor);
    std::vector<std::uint8_t> isNamed = CellsOfNamedSets(grid);
    std::set<std::string> asked = this->Asked(options.Names);
    sameBoundary = sameMesh && this->IsNamed == isNamed && this->asked == asked;
    this->IsNamed = std::move(isNamed);
    this->asked = std::move(asked);
    if (!sameBoundary)
    {
      this->findFaces(this->IsNamed, monitor);
    }
  }
  if (!sameBoundary || this->GeometryKey != key)
  {
    Geometry::Options geometry = options;
    geometry.Sheets = this->sheetNumbers();
    this->geometry = Geometry::Classify(grid, this->mesh, this->faces, geometry, monitor);
    this->motionVersion = ++this->Versions;
    ++this->Classified;
  }
  this->Written = vtkSmartPointer<vtkPolyData>::New();
  this->Polygons = Surface::Write(
    grid, this->mesh, this->faces, this->Written, whole ? &whole->Orientation : nullptr);
  this->Nodes = this->faces.nodes;
  if (this->inner.size() > 0)
  {
    const auto first = static_cast<Index>(this->faces.cells.size() - this->inner.size());
    this->Written->GetCellData()->AddArray(Arrays::MakeOf<vtkUnsignedCharArray>(
      "Inner", this->Polygons, [first](Index face) { return face >= first; }));
  }
  Geometry::AddPointArrays(this->geometry, this->Nodes, this->Written->GetPointData());
  Geometry::AddSurfaceIds(this->geometry, this->Polygons, this->Written);
}

void InputBoundary::TakeSurface(vtkPolyData* surface, const Geometry::Options& options,
  const std::string& key, morph::Monitor& monitor)
{
  this->inner = {};
  this->innerSurfaces.clear();
  this->asked.clear();
  this->Listed.clear();
  this->Sets.clear();
  morph::BoundaryFaces given = polygons(surface);
  requireExtracted(surface, Surface::IdName, 1);
  morph::Points at =
    moderatePoints(GridMesh::FromVectors(requireExtracted(surface, Surface::RestName, 3)),
      "values of RestPosition");
  morph::Points current = moderatePoints(GridMesh::FromPoints(surface->GetPoints()), "coordinates");
  const bool sameGeometry =
    this->GeometryKey == key && sameFaces(this->faces, given) && samePoints(this->undeformed, at);
  if (!sameGeometry)
  {
    this->geometry = Geometry::Classify(surface, at, given, options, monitor);
    this->faces = std::move(given);
    this->orientation.assign(this->faces.offsets.size() - 1, 1);
    this->undeformed = std::move(at);
    this->bodyOfNode.assign(current.rows(), -1);
    ++this->Classified;
  }
  if (!sameGeometry || !samePoints(this->points(), current))
  {
    this->motionVersion = ++this->Versions;
  }
  this->mesh = morph::Mesh();
  this->mesh.points = std::move(current);
  this->Written = vtkSmartPointer<vtkPolyData>::New();
  this->Written->ShallowCopy(surface);
  this->Nodes = consecutive(surface->GetNumberOfPoints());
  this->Polygons = consecutive(this->faces.offsets.size() - 1);
  Geometry::AddPointArrays(this->geometry, this->Nodes, this->Written->GetPointData());
  if (this->Polygons.size() == static_cast<std::size_t>(surface->GetNumberOfCells()))
  {
    Geometry::AddSurfaceIds(this->geometry, this->Polygons, this->Written);
  }
}

morph::Index InputBoundary::FirstPolygon() const
{
  return this->Written->GetNumberOfVerts() + this->Written->GetNumberOfLines();
}
}
