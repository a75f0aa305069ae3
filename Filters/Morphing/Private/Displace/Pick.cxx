// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Pick.h"

#include "BoundaryMover/Dimension.h"
#include "BoundaryMover/Patches.h"
#include "Mesh/Topology.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/Selection.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string>

namespace morph::filters
{
namespace
{
using morph::Index;
using Corners = std::vector<Index>; ///< of a face, ascending node ids

/// What was selected on the boundary: each item lies on one surface or more.
struct Items
{
  std::vector<std::vector<Index>> SurfacesOf; ///< #items, ascending and unique
  std::vector<Index> FacesOn;                 ///< #surfaces, the selected faces on it
};

/// The mesh's node of a point of `shown`.
class Nodes
{
public:
  explicit Nodes(vtkDataSet* shown)
    : Ids(shown->GetPointData()->GetArray(Surface::IdName))
  {
    if (this->Ids && this->Ids->GetNumberOfTuples() != shown->GetNumberOfPoints())
    {
      this->Ids = nullptr;
    }
  }
  Index operator()(vtkIdType point) const
  {
    return static_cast<Index>(this->Ids ? this->Ids->GetComponent(point, 0) : point);
  }

private:
  vtkDataArray* Ids;
};

Corners cornersOf(vtkIdList* points, const Nodes& nodes)
{
  Corners corners;
  for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i)
  {
    corners.push_back(nodes(points->GetId(i)));
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Whether each of the model's nodes is at a selected point.
std::vector<std::uint8_t> selectedNodes(
  const std::vector<std::uint8_t>& flags, const Nodes& nodes, const InputBoundary& model)
{
  std::vector<Index> ids;
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    if (flags[i])
    {
      ids.push_back(nodes(static_cast<vtkIdType>(i)));
    }
  }
  sortUnique(ids);
  // A model made from a surface has numbers of its own for the mesh's nodes.
  vtkPolyData* surface = model.Surface();
  const Nodes nodesOfSurface(surface);
  std::vector<std::uint8_t> isSelected(model.points().rows(), 0);
  for (std::size_t i = 0; i < model.NodeOfPoint().size(); ++i)
  {
    const Index id = nodesOfSurface(static_cast<vtkIdType>(i));
    isSelected[model.NodeOfPoint()[i]] = std::binary_search(ids.begin(), ids.end(), id);
  }
  return isSelected;
}

Items itemsOfPoints(
  const std::vector<std::uint8_t>& flags, const Nodes& nodes, const InputBoundary& model)
{
  const morph::Classification& geometry = model.geometry;
  const std::vector<std::uint8_t> isSelected = selectedNodes(flags, nodes, model);
  std::vector<std::vector<Index>> surfacesOf(isSelected.size());
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    for (Index node : geometry.surfaces[s].nodes)
    {
      if (isSelected[node])
      {
        surfacesOf[node].push_back(static_cast<Index>(s));
      }
    }
  }
  Items items;
  items.FacesOn.assign(geometry.surfaces.size(), 0);
  std::copy_if(surfacesOf.begin(), surfacesOf.end(), std::back_inserter(items.SurfacesOf),
    [](const std::vector<Index>& surfaces) { return !surfaces.empty(); });
  return items;
}

/// Adds an item for each selected face: those of the boundary with the same corners.
void addFaces(std::vector<Corners>& selected, const InputBoundary& model, Items& items)
{
  std::sort(selected.begin(), selected.end());
  vtkPolyData* surface = model.Surface();
  const Nodes nodes(surface);
  vtkCellArray* polygons = surface->GetPolys();
  vtkNew<vtkIdList> points;
  for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
  {
    polygons->GetCellAtId(i, points);
    if (std::binary_search(selected.begin(), selected.end(), cornersOf(points, nodes)))
    {
      const Index number = model.geometry.surfaceOfFace[model.FaceOfPolygon()[i]];
      items.SurfacesOf.push_back({ number });
      ++items.FacesOn[number];
    }
  }
}

Items itemsOfCells(const std::vector<std::uint8_t>& flags, vtkDataSet* shown, const Nodes& nodes,
  const InputBoundary& model)
{
  const morph::BoundaryFaces& faces = model.faces;
  std::vector<Corners> selected;
  vtkNew<vtkIdList> points;
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    const vtkIdType cell = static_cast<vtkIdType>(i);
    if (flags[i] && shown->GetCell(cell)->GetCellDimension() == 2)
    {
      shown->GetCellPoints(cell, points);
      selected.push_back(cornersOf(points, nodes));
    }
  }
  Items items;
  items.FacesOn.assign(model.geometry.surfaces.size(), 0);
  std::vector<std::vector<Index>> surfacesOf(flags.size());
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const Index cell = faces.cells[f];
    if (cell >= 0 && cell < static_cast<Index>(flags.size()) && flags[cell] &&
        shown->GetCell(cell)->GetCellDimension() == 3)
    {
      const Index number = model.geometry.surfaceOfFace[f];
      surfacesOf[cell].push_back(number);
      ++items.FacesOn[number];
    }
  }
  for (std::vector<Index>& surfaces : surfacesOf)
  {
    if (!surfaces.empty())
    {
      sortUnique(surfaces);
      items.SurfacesOf.push_back(std::move(surfaces));
    }
  }
  if (!selected.empty())
  {
    addFaces(selected, model, items);
  }
  return items;
}

/// The fewest surfaces, greedily, so that each item lies on one.
std::vector<Index> cover(const Items& items)
{
  std::vector<Index> chosen;
  std::vector<std::uint8_t> isExplained(items.SurfacesOf.size(), 0);
  for (;;)
  {
    std::vector<Index> count(items.FacesOn.size(), 0);
    for (std::size_t i = 0; i < isExplained.size(); ++i)
    {
      for (Index surface : items.SurfacesOf[i])
      {
        count[surface] += isExplained[i] == 0;
      }
    }
    Index best = -1;
    const auto rank = [&](Index s) { return std::array<Index, 2>{ count[s], items.FacesOn[s] }; };
    for (Index s = 0; s < static_cast<Index>(count.size()); ++s)
    {
      if (count[s] > 0 && (best < 0 || rank(s) > rank(best)))
      {
        best = s;
      }
    }
    if (best < 0)
    {
      std::sort(chosen.begin(), chosen.end());
      return chosen;
    }
    chosen.push_back(best);
    for (std::size_t i = 0; i < isExplained.size(); ++i)
    {
      const std::vector<Index>& surfaces = items.SurfacesOf[i];
      isExplained[i] |= std::binary_search(surfaces.begin(), surfaces.end(), best);
    }
  }
}

void writeCurves(const InputBoundary& model, const std::vector<Index>& curves, vtkPolyData* output)
{
  const std::vector<Index>& nodeOfPoint = model.NodeOfPoint();
  vtkNew<vtkCellArray> lines;
  for (Index number : curves)
  {
    const morph::GeometryCurve& curve = model.geometry.curves[number];
    std::vector<vtkIdType> line;
    for (Index node : curve.nodes)
    {
      const auto at = std::lower_bound(nodeOfPoint.begin(), nodeOfPoint.end(), node);
      line.push_back(at - nodeOfPoint.begin());
    }
    if (curve.loop && !line.empty())
    {
      line.push_back(line.front());
    }
    lines->InsertNextCell(static_cast<vtkIdType>(line.size()), line.data());
  }
  output->SetLines(lines);
}

/// Adds an inner surface that is not among the faces of the boundary.
void addInner(const InputBoundary& model, const morph::InnerSurface& inner, vtkCellArray* polygons,
  vtkPolyData* output)
{
  const morph::BoundaryFaces faces = morph::facesAt(model.mesh, inner.places);
  vtkNew<vtkPoints> points;
  points->DeepCopy(output->GetPoints());
  vtkDataArray* known = output->GetPointData()->GetArray(Surface::IdName);
  const auto ids = vtkSmartPointer<vtkDataArray>::Take(known->NewInstance());
  ids->DeepCopy(known);
  std::map<Index, vtkIdType> pointOf;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    std::vector<vtkIdType> corners;
    for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
    {
      const Index node = faces.connectivity[k];
      const auto [at, isNew] = pointOf.emplace(node, points->GetNumberOfPoints());
      if (isNew)
      {
        points->InsertNextPoint(model.points().row(node).data());
        const double id = static_cast<double>(node);
        ids->InsertNextTuple(&id);
      }
      corners.push_back(at->second);
    }
    polygons->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(ids);
}
}

namespace Pick
{
std::vector<Index> Surfaces(vtkDataSet* shown, vtkSelection* selection,
  vtkExtractSelection* extractor, const InputBoundary& model)
{
  const Selection::Inside inside = Selection::Evaluate(shown, selection, extractor);
  const Nodes nodes(shown);
  return cover(inside.ByPoints ? itemsOfPoints(inside.Flags, nodes, model)
                               : itemsOfCells(inside.Flags, shown, nodes, model));
}

void Find(vtkDataObject* shown, vtkSelection* selection, vtkExtractSelection* extractor,
  const Blocks& blocks, const InputBoundary& model, vtkDataArraySelection* names)
{
  names->RemoveAllArrays();
  for (const std::string& name : morph::patchNames(model))
  {
    names->AddArray(name.c_str(), false);
  }
  if (!selection || selection->GetNumberOfNodes() == 0)
  {
    return;
  }
  if (!model.Surface())
  {
    throw morph::Error("The mesh is not read yet. Apply the filter once.");
  }
  Selection::OnGrid ofBlocks; // keeps what it holds until the end
  if (auto* tree = vtkDataObjectTree::SafeDownCast(shown))
  {
    ofBlocks = Selection::Translate(blocks, tree, selection, extractor);
    shown = ofBlocks.Shown;
    selection = ofBlocks.Selection;
  }
  auto* data = vtkDataSet::SafeDownCast(shown);
  if (!data || data->GetNumberOfPoints() == 0)
  {
    throw morph::Error("It is of data without points. Select points or cells of the mesh.");
  }
  for (Index surface : Surfaces(data, selection, extractor, model))
  {
    const std::string name = morph::surfaceName(model.geometry, surface);
    if (names->ArrayExists(name.c_str()))
    {
      names->EnableArray(name.c_str());
      continue;
    }
    const Index face = model.geometry.surfaces[surface].faces.front();
    for (const NamedSet& set : model.namedSets) // a sheet has their names alone
    {
      if (std::binary_search(set.faces.begin(), set.faces.end(), face))
      {
        names->EnableArray(set.name.c_str());
      }
    }
  }
}

std::set<std::string> Enabled(const InputBoundary& model, vtkDataArraySelection* names)
{
  std::set<std::string> enabled;
  for (const std::string& name : morph::patchNames(model))
  {
    if (names->ArrayExists(name.c_str()) && names->ArrayIsEnabled(name.c_str()))
    {
      enabled.insert(name);
    }
  }
  return enabled;
}

std::string DimensionOf(const InputBoundary& model, vtkDataArraySelection* names)
{
  try
  {
    const morph::Choice choice = morph::choosePatches(model, Enabled(model, names), {});
    return morph::dimensionOf(model, choice).text(model);
  }
  catch (const morph::Error& error)
  {
    return error.what();
  }
}

void Write(const InputBoundary& model, vtkDataArraySelection* names, vtkPolyData* positions,
  vtkPolyData* output)
{
  output->Initialize();
  vtkPolyData* surface = model.Surface();
  if (!surface)
  {
    return;
  }
  std::set<std::string> enabled = Enabled(model, names);
  const bool isMoved = positions && positions->GetNumberOfPoints() == surface->GetNumberOfPoints();
  output->SetPoints((isMoved ? positions : surface)->GetPoints());
  output->GetPointData()->AddArray(surface->GetPointData()->GetArray(Surface::IdName));
  vtkNew<vtkCellArray> polygons;
  for (const morph::InnerSurface& inner : model.innerSurfaces)
  {
    if (model.asked.count(inner.name) == 0 && enabled.erase(inner.name) > 0)
    {
      addInner(model, inner, polygons, output);
    }
  }
  const morph::PatchPart part = morph::findPatches(model, enabled, "the list");
  vtkNew<vtkIdList> points;
  for (vtkIdType i = 0; i < surface->GetPolys()->GetNumberOfCells(); ++i)
  {
    if (part.hasFace[model.FaceOfPolygon()[i]])
    {
      surface->GetPolys()->GetCellAtId(i, points);
      polygons->InsertNextCell(points);
    }
  }
  output->SetPolys(polygons);
  writeCurves(model, morph::curvesNamed(model.geometry, enabled), output);
}
}
}
