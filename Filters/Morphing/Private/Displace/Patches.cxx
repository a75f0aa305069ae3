// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Patches.h"

#include "Support/Error.h"

#include <algorithm>

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
  const std::set<std::string>& missing, const morph::Classification& geometry, const char* property)
{
  if (!missing.empty())
  {
    throw morph::Error(std::string(property) + " names '" + *missing.begin() +
                       "', which the boundary does not have; it has " + list(Names(geometry)) +
                       ". Names change with the feature angle.");
  }
}
}

std::vector<std::string> Names(const morph::Classification& geometry)
{
  std::vector<std::string> names;
  addNames(geometry.surfaces, surfaceName, names);
  addNames(geometry.curves, curveName, names);
  return names;
}

Part Find(
  const morph::Classification& geometry, const std::set<std::string>& names, const char* property)
{
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
  requireNone(missing, geometry, property);
  return part;
}

std::vector<Index> Surfaces(
  const morph::Classification& geometry, const std::set<std::string>& names, const char* property)
{
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
  requireNone(missing, geometry, property);
  return numbers;
}
}
}
