// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/SheetSurfaces.h"

#include "Boundary/SurfaceEdges.h"
#include "Boundary/SurfacePatches.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
/// The patches of sheets: `faces` are theirs alone.
struct SheetPatches
{
  Index count = 0;
  std::vector<Index> ofFace;
  std::vector<std::vector<Index>> nodes; ///< #patches, ascending
};

SheetPatches sheetPatches(const ConstPoints& points, const BoundaryFaces& faces,
  const std::vector<Index>& numbers, double featureAngle, Monitor& monitor)
{
  const SurfaceEdges edges = surfaceEdges(points, faces, monitor);
  SheetPatches result;
  result.ofFace = surfacePatches(faces, edges, featureAngle, numbers, {}, true).ofFace;
  for (std::size_t f = 0; f < result.ofFace.size(); ++f)
  {
    result.count = std::max(result.count, result.ofFace[f] + 1);
    result.nodes.resize(result.count);
    std::vector<Index>& nodes = result.nodes[result.ofFace[f]];
    nodes.insert(nodes.end(), faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
  }
  for (std::size_t i = 0; i < faces.nodes.size(); ++i) // in the middle of an edge or a face
  {
    const Index *first = faces.between.begin(static_cast<Index>(i)),
                *last = faces.between.end(static_cast<Index>(i));
    for (const Index* other = first; other != last; ++other)
    {
      const Index edge = edges.find(*first, *other);
      const Adjacency& at = edges.faces;
      for (const Index* f = edge < 0 ? nullptr : at.begin(edge); f && f != at.end(edge); ++f)
      {
        const Index *corners = faces.connectivity.data() + faces.offsets[*f],
                    *end = faces.connectivity.data() + faces.offsets[*f + 1];
        if (std::all_of(first, last, [&](Index n) { return std::find(corners, end, n) != end; }))
        {
          result.nodes[result.ofFace[*f]].push_back(faces.nodes[i]);
        }
      }
    }
  }
  for (std::vector<Index>& nodes : result.nodes)
  {
    sortUnique(nodes);
  }
  return result;
}

/// Adds the last faces to the result for the others.
void addSheets(const Mesh& mesh, const BoundaryFaces& faces, const BoundaryFaces& sheets,
  const ClassificationOptions& options, Classification& result, Monitor& monitor)
{
  const Index outer = static_cast<Index>(faces.cells.size() - options.sheets.size());
  const SheetPatches patches =
    sheetPatches(ConstPoints(mesh.points), sheets, options.sheets, options.featureAngle, monitor);
  Index next = 0;
  for (const GeometrySurface& surface : result.surfaces)
  {
    next = std::max(next, surface.id + 1);
  }
  const std::size_t first = result.surfaces.size();
  result.surfaces.resize(first + patches.count);
  for (std::size_t f = 0; f < patches.ofFace.size(); ++f)
  {
    const Index surface = static_cast<Index>(first) + patches.ofFace[f];
    result.surfaceOfFace.push_back(surface);
    result.surfaces[surface].faces.push_back(outer + static_cast<Index>(f));
  }
  for (std::size_t s = first; s < result.surfaces.size(); ++s)
  {
    GeometrySurface& surface = result.surfaces[s];
    surface.id = next++; // a given id is that of the cell behind, which another surface has
    surface.nodes = patches.nodes[s - first];
    for (const Index node : surface.nodes)
    {
      if (result.dimension[node] < 0)
      {
        result.dimension[node] = 2;
        result.entity[node] = static_cast<Index>(s);
      }
    }
  }
}
}

Classification classifyWithSheets(const Mesh& mesh, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor)
{
  const auto all = static_cast<Index>(faces.cells.size());
  const Index outer = all - static_cast<Index>(options.sheets.size());
  ClassificationOptions without = options;
  without.sheets.clear();
  if (!without.given.surface.empty())
  {
    without.given.surface.resize(outer);
  }
  Classification result =
    classify(ConstPoints(mesh.points), facesBetween(mesh, faces, 0, outer), without, monitor);
  addSheets(mesh, faces, facesBetween(mesh, faces, outer, all), options, result, monitor);
  SurfaceEdges edges = surfaceEdges(ConstPoints(mesh.points), faces, monitor);
  for (GeometryCurve& curve : result.curves)
  {
    for (Index& edge : curve.edges)
    {
      const auto& ends = result.edges.nodes[edge];
      edge = edges.find(ends[0], ends[1]);
    }
  }
  result.edges = std::move(edges);
  return result;
}
}
