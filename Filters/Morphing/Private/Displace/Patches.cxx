// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Patches.h"

#include "Boundary/FaceAreas.h"
#include "Support/Error.h"

#include <algorithm>
#include <map>

namespace morph::filters
{
namespace
{
using morph::Index;

std::string surfaceName(Index id)
{
  return "Surface " + std::to_string(id);
}

std::string curveName(Index id)
{
  return "Curve " + std::to_string(id);
}

template <typename Patches>
void addNames(const Patches& patches, std::string (*name)(Index), std::vector<std::string>& names)
{
  std::set<Index> ids;
  for (const auto& patch : patches)
  {
    ids.insert(patch.id);
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

namespace Patches
{
namespace
{
void requireNone(
  const std::set<std::string>& missing, const BoundaryModel& model, const char* property)
{
  for (const NamedSet& set : model.SetsInside())
  {
    if (missing.count(set.Name) > 0)
    {
      throw morph::Error(std::string(property) + " names '" + set.Name +
                         "', which lies inside of the mesh. Surfaces on the boundary and sets of "
                         "faces can move; a zone holds or moves the nodes of '" +
                         set.Name + "'.");
    }
  }
  if (!missing.empty())
  {
    throw morph::Error(std::string(property) + " names '" + *missing.begin() +
                       "', which the boundary does not have; it has " + list(Names(model)) +
                       ". Names change with the feature angle.");
  }
}

/// The numbers of the surfaces that make up a set; throws where a part of one is left out.
std::vector<Index> wholeSurfaces(
  const morph::Classification& geometry, const NamedSet& set, const char* property)
{
  const auto has = [&](Index face)
  { return std::binary_search(set.Faces.begin(), set.Faces.end(), face); };
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
      throw morph::Error(std::string(property) + " names '" + set.Name +
                         "', which has a part alone of " + surfaceName(geometry.surfaces[s].id) +
                         ". Nodes slide along whole surfaces: name that one, or change the feature "
                         "angle.");
    }
    numbers.push_back(static_cast<Index>(s));
  }
  return numbers;
}
}

std::vector<std::string> Names(const BoundaryModel& model)
{
  const morph::Classification& geometry = model.Geometry();
  std::vector<std::string> names;
  for (const NamedSet& set : model.NamedSets())
  {
    names.push_back(set.Name);
  }
  addNames(geometry.surfaces, surfaceName, names);
  addNames(geometry.curves, curveName, names);
  return names;
}

std::vector<Size> Sizes(const BoundaryModel& model)
{
  const morph::Classification& geometry = model.Geometry();
  const morph::Points& points = model.Rest();
  const morph::Points areas = morph::faceAreas(points, model.Faces());
  const auto addNodes = [&](const std::vector<Index>& nodes, Size& size)
  {
    for (const Index node : nodes)
    {
      size.Box.extend(points.row(node).transpose());
    }
  };
  const auto addFaces = [&](const std::vector<Index>& faces, Size& size)
  {
    size.IsInner = (size.Count == 0 || size.IsInner) && model.AreInner(faces);
    size.Count += static_cast<Index>(faces.size());
    for (const Index face : faces)
    {
      size.Measure += areas.row(face).norm();
    }
  };
  std::map<std::string, Size> sizes;
  for (const NamedSet& set : model.NamedSets())
  {
    addFaces(set.Faces, sizes[set.Name]);
    addNodes(set.Nodes, sizes[set.Name]);
  }
  for (const morph::GeometrySurface& surface : geometry.surfaces)
  {
    addFaces(surface.faces, sizes[surfaceName(surface.id)]);
    addNodes(surface.nodes, sizes[surfaceName(surface.id)]);
  }
  for (const morph::GeometryCurve& curve : geometry.curves)
  {
    Size& size = sizes[curveName(curve.id)];
    addNodes(curve.nodes, size);
    size.Count += static_cast<Index>(curve.edges.size());
    for (const Index edge : curve.edges)
    {
      const auto& ends = geometry.edges.nodes[edge];
      size.Measure += (points.row(ends[0]) - points.row(ends[1])).norm();
    }
  }
  std::vector<Size> result;
  for (const std::string& name : Names(model))
  {
    sizes[name].Name = name;
    result.push_back(sizes[name]);
  }
  return result;
}

Part Find(const BoundaryModel& model, const std::set<std::string>& names, const char* property)
{
  const morph::Classification& geometry = model.Geometry();
  Part part;
  part.HasNode.assign(geometry.dimension.size(), 0);
  part.HasFace.assign(geometry.surfaceOfFace.size(), 0);
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
      part.HasNode[node] = 1;
    }
  };
  for (const morph::GeometrySurface& surface : geometry.surfaces)
  {
    if (has(surfaceName(surface.id)))
    {
      addNodes(surface.nodes);
      for (Index face : surface.faces)
      {
        part.HasFace[face] = 1;
      }
    }
  }
  for (const morph::GeometryCurve& curve : geometry.curves)
  {
    if (has(curveName(curve.id)))
    {
      addNodes(curve.nodes);
    }
  }
  for (const NamedSet& set : model.NamedSets())
  {
    if (has(set.Name))
    {
      addNodes(set.Nodes);
      for (Index face : set.Faces)
      {
        part.HasFace[face] = 1;
      }
    }
  }
  requireNone(missing, model, property);
  return part;
}

std::vector<Index> Surfaces(
  const BoundaryModel& model, const std::set<std::string>& names, const char* property)
{
  if (names.empty())
  {
    return {};
  }
  const morph::Classification& geometry = model.Geometry();
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
  for (const NamedSet& set : model.NamedSets())
  {
    if (names.count(set.Name) > 0)
    {
      const std::vector<Index> whole = wholeSurfaces(geometry, set, property);
      numbers.insert(numbers.end(), whole.begin(), whole.end());
      missing.erase(set.Name);
    }
  }
  requireNone(missing, model, property);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::string SurfaceName(const morph::Classification& geometry, Index surface)
{
  return surfaceName(geometry.surfaces[surface].id);
}

std::vector<Index> Curves(const morph::Classification& geometry, const std::set<std::string>& names)
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
}
