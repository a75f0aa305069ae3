// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Crossings.h"

#include "Boundary/CrossingFaces.h"
#include "Geometry/MeanOfRows.h"
#include "Mesh/ShellLayer.h"
#include "Private/Data/NamedSets.h"
#include "Private/Data/Surface.h"
#include "Private/Data/WrittenPoints.h"
#include "Support/Lists.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

namespace morph::filters::Crossings
{
namespace
{
using morph::Index;

/// Takes the ids that vtkClassifyBoundary gave, from the polygons that have most of a face.
void takeIds(
  const morph::BoundaryFaces& faces, vtkPointSet* boundary, std::map<Index, std::string>& names)
{
  vtkDataArray* owners = boundary->GetCellData()->GetArray("MorphCellId");
  vtkDataArray* ids = boundary->GetCellData()->GetArray("GeometryId");
  vtkDataArray* nodes = boundary->GetPointData()->GetArray(Surface::IdName);
  if (!owners || !ids || !nodes)
  {
    return;
  }
  std::multimap<Index, Index> facesOf;
  for (const auto& [face, name] : names)
  {
    facesOf.emplace(faces.cells[face], face);
  }
  std::map<Index, Index> most;
  vtkNew<vtkIdList> points;
  for (vtkIdType polygon = 0; polygon < boundary->GetNumberOfCells(); ++polygon)
  {
    const auto [begin, end] =
      facesOf.equal_range(static_cast<Index>(owners->GetComponent(polygon, 0)));
    for (auto at = begin; at != end; ++at)
    {
      boundary->GetCellPoints(polygon, points);
      const Index face = at->second;
      const auto first = faces.connectivity.begin() + faces.offsets[face];
      const auto last = faces.connectivity.begin() + faces.offsets[face + 1];
      Index common = 0;
      for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i)
      {
        const auto node = static_cast<Index>(nodes->GetComponent(points->GetId(i), 0));
        common += std::find(first, last, node) != last;
      }
      if (common > most[face])
      {
        most[face] = common;
        names[face] =
          "Surface " + std::to_string(static_cast<Index>(ids->GetComponent(polygon, 0)));
      }
    }
  }
}

/// "cell 12 at (1, 2, 3)": the cell behind a face, and the mean of the face's corners.
std::string place(const morph::BoundaryFaces& faces, const std::vector<Index>& cells,
  const morph::ConstPoints& points, Index face)
{
  const Index* corners = faces.connectivity.data();
  const Eigen::RowVector3d mean =
    morph::meanOfRows(points, corners + faces.offsets[face], corners + faces.offsets[face + 1]);
  std::ostringstream text;
  text << "cell " << cells[face] << " at (" << mean[0] << ", " << mean[1] << ", " << mean[2] << ")";
  return text.str();
}
}

std::vector<Index> FacesOf(const Pairs& pairs)
{
  std::vector<Index> faces;
  for (const std::array<Index, 2>& pair : pairs)
  {
    faces.insert(faces.end(), pair.begin(), pair.end());
  }
  sortUnique(faces);
  return faces;
}

std::map<Index, std::string> NamesOf(const std::vector<Index>& some, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, vtkUnstructuredGrid* grid, vtkPointSet* boundary)
{
  std::map<Index, std::string> names;
  for (const Index face : some)
  {
    names[face] = "a surface without a name";
  }
  if (boundary)
  {
    takeIds(faces, boundary, names);
  }
  std::vector<NamedSet> sets = FindNamedSets(grid, mesh, faces, 0);
  // A set of everything, as the elements of the only body, distinguishes nothing.
  const auto isWhole = [&](const NamedSet& set) { return set.faces.size() == faces.cells.size(); };
  sets.erase(std::remove_if(sets.begin(), sets.end(), isWhole), sets.end());
  std::stable_sort(sets.begin(), sets.end(),
    [](const NamedSet& a, const NamedSet& b) { return a.faces.size() > b.faces.size(); });
  for (const NamedSet& set : sets)
  {
    for (auto& [face, name] : names)
    {
      if (std::binary_search(set.faces.begin(), set.faces.end(), face))
      {
        name = set.name;
      }
    }
  }
  return names;
}

Found Describe(const Pairs& pairs, const std::map<Index, std::string>& names,
  const morph::BoundaryFaces& faces, const std::vector<Index>& cells,
  const morph::ConstPoints& points)
{
  if (pairs.empty())
  {
    return {};
  }
  constexpr std::size_t Most = 10;
  std::set<std::pair<std::string, std::string>> seen;
  std::string text;
  for (const auto& [f, g] : pairs)
  {
    const std::string &first = names.at(f), &second = names.at(g);
    if (seen.emplace(std::min(first, second), std::max(first, second)).second &&
        seen.size() <= Most)
    {
      text += "\n  " + first + " and " + second + ", first the faces of " +
              place(faces, cells, points, f) + " and " + place(faces, cells, points, g);
    }
  }
  return { static_cast<Index>(names.size()), FacesOf(pairs),
    "The boundary crosses itself: " + std::to_string(names.size()) +
      " faces run into others that they did not cross before the motion. Surfaces that cross:" +
      text + (seen.size() > Most ? "\n  ...\n" : "\n") +
      "Move the boundary less there, or along another path." };
}

namespace
{
Found findAmong(const morph::Mesh& rest, const morph::BoundaryFaces& faces,
  const std::vector<std::int8_t>& orientation, vtkUnstructuredGrid* output, vtkPointSet* boundary,
  const morph::ConstPoints& written, morph::Monitor& monitor)
{
  const Pairs pairs = morph::crossingFaces(rest.points, written, faces, orientation, monitor);
  return Describe(
    pairs, NamesOf(FacesOf(pairs), rest, faces, output, boundary), faces, faces.cells, written);
}
}

Found Find(const morph::Mesh& rest, const morph::BoundaryFaces& faces,
  const std::vector<std::int8_t>& orientation, vtkUnstructuredGrid* output, vtkPointSet* boundary,
  morph::Monitor& monitor)
{
  return withPoints(output,
    [&](const morph::ConstPoints& written)
    {
      // The sides of a layer are the edges of a plane mesh; a shell crosses itself by its faces.
      const morph::ShellLayer& layer = rest.layer;
      if (layer.isCurved() || morph::leavesPlane(layer, written))
      {
        const morph::BoundaryFaces front = morph::frontFaces(rest);
        const std::vector<std::int8_t> alike(rest.numberOfCells(), 1);
        Found found = findAmong(rest, front, alike, output, nullptr, written, monitor);
        found.Own.clear();
        return found;
      }
      return findAmong(rest, faces, orientation, output, boundary, written, monitor);
    });
}
}
