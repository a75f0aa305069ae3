// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Crossings.h"

#include "Boundary/WholeBoundary.h"
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
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace morph::filters::Crossings
{
namespace
{
using morph::Index;

using Pairs = std::vector<std::array<Index, 2>>; ///< of faces; see crossingFaces()

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
  std::multimap<Index, Index> ofCell;
  for (const auto& [face, name] : names)
  {
    ofCell.emplace(faces.cells[face], face);
  }
  std::map<Index, Index> most;
  vtkNew<vtkIdList> points;
  for (vtkIdType polygon = 0; polygon < boundary->GetNumberOfCells(); ++polygon)
  {
    const auto [begin, end] =
      ofCell.equal_range(static_cast<Index>(owners->GetComponent(polygon, 0)));
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
std::string place(const morph::WholeBoundary& boundary, const morph::Points& points, Index face)
{
  const morph::BoundaryFaces& faces = boundary.faces();
  const Index* corners = faces.connectivity.data();
  const Eigen::RowVector3d mean =
    morph::meanOfRows(points, corners + faces.offsets[face], corners + faces.offsets[face + 1]);
  std::ostringstream text;
  text << "cell " << boundary.cells()[face] << " at (" << mean[0] << ", " << mean[1] << ", "
       << mean[2] << ")";
  return text.str();
}

/// The faces of all pairs, ascending.
std::vector<Index> facesOf(const Pairs& pairs)
{
  std::vector<Index> faces;
  for (const std::array<Index, 2>& pair : pairs)
  {
    faces.insert(faces.end(), pair.begin(), pair.end());
  }
  sortUnique(faces);
  return faces;
}

/// Names the surfaces that some faces belong to: by the smallest set of the file, as `grid` has it,
/// or else by the ids that `boundary` has. `mesh`, `faces`: of `grid`.
std::map<Index, std::string> namesOf(const std::vector<Index>& some, const morph::Mesh& mesh,
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

/// The names that processes give their own faces, by the numbers of the faces in the whole
/// boundary.
std::map<Index, std::string> gathered(const std::map<Index, std::string>& own,
  const std::vector<Index>& numberOf, const morph::Communicator& processes)
{
  std::vector<double> flat; // numbers, lengths and characters
  for (const auto& [face, name] : own)
  {
    flat.push_back(static_cast<double>(numberOf[face]));
    flat.push_back(static_cast<double>(name.size()));
    flat.insert(flat.end(), name.begin(), name.end());
  }
  flat = processes.gather(flat);
  std::map<Index, std::string> names;
  for (auto at = flat.begin(); at != flat.end();)
  {
    std::string& name = names[static_cast<Index>(*at++)];
    for (auto size = static_cast<std::size_t>(*at++); name.size() < size; ++at)
    {
      name += static_cast<char>(*at);
    }
  }
  return names;
}

/// `names`: of the faces of the pairs.
std::string describe(const Pairs& pairs, const std::map<Index, std::string>& names,
  const morph::WholeBoundary& boundary, const morph::Points& points)
{
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
              place(boundary, points, f) + " and " + place(boundary, points, g);
    }
  }
  return "The boundary crosses itself: " + std::to_string(names.size()) +
         " faces run into others that they did not cross before the motion. Surfaces that cross:" +
         text + (seen.size() > Most ? "\n  ...\n" : "\n") +
         "Move the boundary less there, or along another path.";
}

/// `own`: the faces that `whole` has from this process, of `grid`.
Found findAmong(const morph::WholeBoundary& whole, const morph::BoundaryFaces& own,
  const morph::Mesh& grid, vtkUnstructuredGrid* output, vtkPointSet* boundary,
  const morph::ConstPoints& written, const morph::Communicator& processes, morph::Monitor& monitor)
{
  const morph::Points moved = whole.gather(written);
  const Pairs pairs = whole.crossings(whole.faces(), moved, monitor);
  if (pairs.empty())
  {
    return {};
  }
  const std::vector<Index> faces = facesOf(pairs);
  Found found;
  std::map<Index, std::string> names;
  processes.together(
    [&]
    {
      for (std::size_t f = 0; f < own.cells.size(); ++f)
      {
        if (std::binary_search(faces.begin(), faces.end(), whole.numberOfOwn()[f]))
        {
          found.Own.push_back(static_cast<Index>(f));
        }
      }
      if (!found.Own.empty())
      {
        names = namesOf(found.Own, grid, own, output, boundary);
      }
    });
  names = gathered(names, whole.numberOfOwn(), processes);
  found.Count = static_cast<Index>(faces.size());
  found.Warning = describe(pairs, names, whole, moved);
  return found;
}
}

Found Find(const morph::UndeformedMesh& rest, const morph::Mesh& grid, vtkUnstructuredGrid* output,
  vtkPointSet* boundary, morph::Monitor& monitor)
{
  return withPoints(output,
    [&](const morph::ConstPoints& written)
    {
      // The sides of a layer are the edges of a plane mesh; a shell crosses itself by its faces.
      if (grid.layer.isCurved() || morph::leavesPlane(grid, written, rest.all()))
      {
        const morph::BoundaryFaces front = morph::frontFaces(grid);
        const std::vector<std::int8_t> alike(grid.numberOfCells(), 1);
        const morph::WholeBoundary whole(grid, front, alike, rest.all());
        Found found = findAmong(whole, front, grid, output, nullptr, written, rest.all(), monitor);
        found.Own.clear();
        return found;
      }
      return findAmong(
        rest.boundary(), rest.outerFaces(), grid, output, boundary, written, rest.all(), monitor);
    });
}
}
