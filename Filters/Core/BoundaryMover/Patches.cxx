// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Patches.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMover/SurfaceShape.h"
#include "Mesh/ShellLayer.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <map>

namespace morph
{
namespace
{
std::string surfaceName(Index id)
{
  return "Surface " + std::to_string(id);
}

std::string curveName(Index id)
{
  return "Curve " + std::to_string(id);
}

template <typename Patches>
void addNames(const Patches& patches, std::size_t count, std::string (*name)(Index),
  std::vector<std::string>& names)
{
  std::set<Index> ids;
  for (std::size_t i = 0; i < count; ++i)
  {
    ids.insert(patches[i].id);
  }
  for (Index id : ids)
  {
    names.push_back(name(id));
  }
}

/// The first few names for a message.
std::string list(const std::vector<std::string>& names)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 10); ++i)
  {
    text += (i > 0 ? ", " : "") + names[i];
  }
  return names.size() > 10 ? text + ", ... (" + std::to_string(names.size()) + " in all)" : text;
}
}

namespace
{
void requireNone(
  const std::set<std::string>& missing, const BoundaryModel& model, const char* option)
{
  for (const NamedSet& set : model.setsInside)
  {
    if (missing.count(set.name) > 0)
    {
      throw Error("`" + std::string(option) + "` names '" + set.name +
                  "', which lies inside of the mesh. Surfaces on the boundary and sets of "
                  "faces can move; a zone holds or moves the nodes of '" +
                  set.name + "'.");
    }
  }
  if (!missing.empty())
  {
    throw Error("`" + std::string(option) + "` names '" + *missing.begin() +
                "', which the boundary does not have; it has " + list(patchNames(model)) +
                ". Names change with the feature angle.");
  }
}

/// The numbers of the surfaces that make up a set; throws where a part of one is left out.
std::vector<Index> wholeSurfaces(
  const Classification& geometry, const NamedSet& set, const char* option)
{
  const auto has = [&](Index face)
  { return std::binary_search(set.faces.begin(), set.faces.end(), face); };
  std::vector<Index> numbers;
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    const std::vector<Index>& faces = geometry.surfaces[s].faces;
    const auto count = std::count_if(faces.begin(), faces.end(), has);
    if (count == 0)
    {
      continue;
    }
    if (count < static_cast<std::ptrdiff_t>(faces.size()))
    {
      throw Error("`" + std::string(option) + "` names '" + set.name +
                  "', which has a part alone of " + surfaceName(geometry.surfaces[s].id) +
                  ". Nodes slide along whole surfaces: name that one, or change the feature "
                  "angle.");
    }
    numbers.push_back(static_cast<Index>(s));
  }
  return numbers;
}

/// The area of each face, or the length of the edge that a layer's face is of: in the front.
Eigen::VectorXd faceMeasures(
  const Points& points, const BoundaryFaces& faces, const ShellLayer& layer)
{
  Eigen::VectorXd measures = faceAreas(points, faces).rowwise().norm();
  for (Index f = 0; layer.nodes > 0 && f < measures.size(); ++f)
  {
    std::vector<Index> ends;
    std::copy_if(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1], std::back_inserter(ends),
      [&](Index node) { return node < layer.nodes; });
    measures[f] = (points.row(ends.back()) - points.row(ends.front())).norm();
  }
  return measures;
}
}

std::vector<std::string> patchNames(const BoundaryModel& model)
{
  const Classification& geometry = model.geometry;
  std::vector<std::string> names;
  for (const NamedSet& set : model.namedSets)
  {
    if (model.asked.count(set.name) == 0) // which come with the other inner surfaces
    {
      names.push_back(set.name);
    }
  }
  for (const InnerSurface& surface : model.innerSurfaces)
  {
    names.push_back(surface.name);
  }
  const std::vector<Index> sheets = model.sheets(); // which have names, and come last
  addNames(geometry.surfaces, geometry.surfaces.size() - sheets.size(), surfaceName, names);
  if (model.mesh.layer.nodes == 0) // those of a layer are corners, and its surfaces twice
  {
    addNames(geometry.curves, geometry.curves.size(), curveName, names);
  }
  return names;
}

std::vector<PatchSize> patchSizes(const BoundaryModel& model)
{
  const Classification& geometry = model.geometry;
  const Points& points = model.rest();
  const ShellLayer& layer = model.mesh.layer;
  const Eigen::VectorXd measures = faceMeasures(points, model.faces, layer);
  const auto addNodes = [&](const std::vector<Index>& nodes, PatchSize& size)
  {
    for (const Index node : nodes)
    {
      if (layer.nodes == 0 || node < layer.nodes)
      {
        size.box.extend(points.row(node).transpose());
      }
    }
  };
  const auto addFaces = [&](const std::vector<Index>& faces, PatchSize& size)
  {
    size.isInner = (size.count == 0 || size.isInner) && model.areInner(faces);
    size.count += static_cast<Index>(faces.size());
    for (const Index face : faces)
    {
      size.measure += measures[face];
    }
  };
  std::map<std::string, PatchSize> sizes;
  for (const NamedSet& set : model.namedSets)
  {
    addFaces(set.faces, sizes[set.name]);
    addNodes(set.nodes, sizes[set.name]);
  }
  for (const InnerSurface& surface : model.innerSurfaces)
  {
    const BoundaryFaces faces = facesAt(model.mesh, surface.places);
    PatchSize size;
    size.isInner = true;
    size.count = static_cast<Index>(surface.places.size());
    size.measure = faceMeasures(points, faces, layer).sum();
    addNodes(faces.nodes, size);
    sizes[surface.name] = size;
  }
  for (const GeometrySurface& surface : geometry.surfaces)
  {
    addFaces(surface.faces, sizes[surfaceName(surface.id)]);
    addNodes(surface.nodes, sizes[surfaceName(surface.id)]);
  }
  for (const GeometryCurve& curve : geometry.curves)
  {
    PatchSize& size = sizes[curveName(curve.id)];
    addNodes(curve.nodes, size);
    size.count += static_cast<Index>(curve.edges.size());
    for (const Index edge : curve.edges)
    {
      const auto& ends = geometry.edges.nodes[edge];
      size.measure += (points.row(ends[0]) - points.row(ends[1])).norm();
    }
  }
  std::vector<PatchSize> result;
  for (const std::string& name : patchNames(model))
  {
    sizes[name].name = name;
    result.push_back(sizes[name]);
  }
  return result;
}

std::vector<std::string> patchShapes(const BoundaryModel& model)
{
  const Points& points = model.rest();
  std::map<std::string, GeometrySurface> parts; // of one name, several patches or a set
  const auto add = [](const auto& more, std::vector<Index>& all)
  {
    all.insert(all.end(), more.begin(), more.end());
    sortUnique(all);
  };
  for (const NamedSet& set : model.namedSets)
  {
    add(set.faces, parts[set.name].faces);
    add(set.nodes, parts[set.name].nodes);
  }
  for (const GeometrySurface& surface : model.geometry.surfaces)
  {
    GeometrySurface& part = parts[surfaceName(surface.id)];
    add(surface.faces, part.faces);
    add(surface.nodes, part.nodes);
  }
  std::map<std::string, std::string> shapes;
  for (const auto& [name, part] : parts)
  {
    if (!part.faces.empty())
    {
      shapes[name] = SurfaceShape::text(points, model.faces, part);
    }
  }
  for (const InnerSurface& inner : model.innerSurfaces)
  {
    const BoundaryFaces faces = facesAt(model.mesh, inner.places);
    GeometrySurface part;
    part.faces = consecutive(inner.places.size());
    part.nodes = faces.nodes;
    shapes[inner.name] = SurfaceShape::text(points, faces, part);
  }
  std::vector<std::string> result;
  for (const std::string& name : patchNames(model))
  {
    result.push_back(shapes[name]);
  }
  return result;
}

PatchPart findPatches(
  const BoundaryModel& model, const std::set<std::string>& names, const char* option)
{
  const Classification& geometry = model.geometry;
  PatchPart part;
  part.hasNode.assign(geometry.dimension.size(), 0);
  part.hasFace.assign(geometry.surfaceOfFace.size(), 0);
  std::set<std::string> missing = names;
  const auto has = [&](const std::string& name)
  {
    missing.erase(name);
    return names.count(name) > 0;
  };
  const auto addNodes = [&](const std::vector<Index>& nodes)
  {
    for (Index node : nodes)
    {
      part.hasNode[node] = 1;
    }
  };
  for (const GeometrySurface& surface : geometry.surfaces)
  {
    if (has(surfaceName(surface.id)))
    {
      addNodes(surface.nodes);
      for (Index face : surface.faces)
      {
        part.hasFace[face] = 1;
      }
    }
  }
  for (const GeometryCurve& curve : geometry.curves)
  {
    if (has(curveName(curve.id)))
    {
      addNodes(curve.nodes);
    }
  }
  for (const NamedSet& set : model.namedSets)
  {
    if (has(set.name))
    {
      addNodes(set.nodes);
      for (Index face : set.faces)
      {
        part.hasFace[face] = 1;
      }
    }
  }
  requireNone(missing, model, option);
  return part;
}

SymmetryPlanes symmetryPlanes(const BoundaryModel& model, const std::set<std::string>& names)
{
  const Classification& geometry = model.geometry;
  SymmetryPlanes result;
  for (const NamedSet& set : model.namedSets)
  {
    if (names.count(set.name) == 0 || set.faces.empty())
    {
      continue;
    }
    std::map<Index, std::size_t> faces; // of each surface
    for (const Index face : set.faces)
    {
      ++faces[geometry.surfaceOfFace[face]];
    }
    const bool arePlanes = std::all_of(faces.begin(), faces.end(),
      [&](const auto& its)
      {
        const GeometrySurface& surface = geometry.surfaces[its.first];
        return its.second == surface.faces.size() &&
               SurfaceShape(model.points(), model.faces, surface).kind() ==
                 SurfaceShape::Kind::Plane;
      });
    for (const auto& its : faces)
    {
      if (arePlanes)
      {
        result.surfaces.push_back(its.first);
      }
    }
    if (!arePlanes)
    {
      result.others.push_back(set.name);
    }
  }
  sortUnique(result.surfaces);
  return result;
}

std::vector<Index> surfacesNamed(
  const BoundaryModel& model, const std::set<std::string>& names, const char* option)
{
  if (names.empty())
  {
    return {};
  }
  const Classification& geometry = model.geometry;
  std::vector<Index> numbers;
  std::set<std::string> missing = names;
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    const std::string name = surfaceName(geometry.surfaces[s].id);
    if (names.count(name) > 0)
    {
      numbers.push_back(static_cast<Index>(s));
      missing.erase(name);
    }
  }
  for (const NamedSet& set : model.namedSets)
  {
    if (names.count(set.name) > 0)
    {
      const std::vector<Index> whole = wholeSurfaces(geometry, set, option);
      numbers.insert(numbers.end(), whole.begin(), whole.end());
      missing.erase(set.name);
    }
  }
  requireNone(missing, model, option);
  sortUnique(numbers);
  return numbers;
}

std::string surfaceName(const Classification& geometry, Index surface)
{
  return surfaceName(geometry.surfaces[surface].id);
}

std::vector<Index> curvesNamed(const Classification& geometry, const std::set<std::string>& names)
{
  std::vector<Index> numbers;
  for (std::size_t c = 0; c < geometry.curves.size(); ++c)
  {
    if (names.count(curveName(geometry.curves[c].id)) > 0)
    {
      numbers.push_back(static_cast<Index>(c));
    }
  }
  return numbers;
}
}
