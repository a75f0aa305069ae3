// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/SurfacePatches.h"

#include "Support/UnionFind.h"

#include <algorithm>

namespace morph
{
namespace
{
/// Numbers patches in the order of their lowest faces, compared by sorted node ids.
void number(const BoundaryFaces& faces, UnionFind<Index>& sets, SurfacePatches& result)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  std::vector<Index> sorted = faces.connectivity;
  for (Index f = 0; f < count; ++f)
  {
    std::sort(sorted.begin() + faces.offsets[f], sorted.begin() + faces.offsets[f + 1]);
  }
  const auto lower = [&](Index a, Index b)
  {
    return std::lexicographical_compare(sorted.begin() + faces.offsets[a],
      sorted.begin() + faces.offsets[a + 1], sorted.begin() + faces.offsets[b],
      sorted.begin() + faces.offsets[b + 1]);
  };
  std::vector<Index> lowest(count, -1); // by root
  for (Index f = 0; f < count; ++f)
  {
    Index& least = lowest[sets.root(f)];
    least = least < 0 || lower(f, least) ? f : least;
  }
  std::vector<Index> roots;
  for (Index f = 0; f < count; ++f)
  {
    if (lowest[f] >= 0)
    {
      roots.push_back(f);
    }
  }
  std::sort(
    roots.begin(), roots.end(), [&](Index a, Index b) { return lower(lowest[a], lowest[b]); });
  std::vector<Index> numberOf(count, -1);
  for (std::size_t i = 0; i < roots.size(); ++i)
  {
    numberOf[roots[i]] = static_cast<Index>(i);
  }
  result.ofFace.resize(count);
  for (Index f = 0; f < count; ++f)
  {
    result.ofFace[f] = numberOf[sets.root(f)];
  }
  result.id.assign(roots.size(), NoGeometry);
}
}

SurfacePatches surfacePatches(const BoundaryFaces& faces, const SurfaceEdges& edges,
  double featureAngle, const std::vector<Index>& ids, const std::vector<std::uint8_t>& curves,
  bool featuresInside)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  const std::vector<Index> id = ids.empty() ? std::vector<Index>(count, NoGeometry) : ids;
  const auto isFeature = [&](Index e) { return edges.angle[e] > featureAngle; };
  const auto isKnown = [&](Index e) { return !curves.empty() && curves[e]; };

  UnionFind<Index> sets(count); // of faces
  for (Index e = 0; e < edges.count(); ++e)
  {
    const Index* at = edges.faces.begin(e);
    if (edges.faces.end(e) - at != 2 || id[at[0]] != id[at[1]])
    {
      continue;
    }
    const bool given = id[at[0]] != NoGeometry;
    if (given ? !featuresInside || !isFeature(e) : !isFeature(e) && !isKnown(e))
    {
      sets.join(at[0], at[1]);
    }
  }

  SurfacePatches result;
  number(faces, sets, result);
  for (Index f = 0; f < count; ++f)
  {
    result.id[result.ofFace[f]] = id[f];
  }
  result.isCurve.assign(edges.count(), 0);
  for (Index e = 0; e < edges.count(); ++e)
  {
    const Index* at = edges.faces.begin(e);
    const bool manifold = edges.faces.end(e) - at == 2;
    result.isCurve[e] = !manifold || isKnown(e) || result.ofFace[at[0]] != result.ofFace[at[1]] ||
                        (isFeature(e) && (id[at[0]] == NoGeometry || featuresInside));
  }
  return result;
}
}
