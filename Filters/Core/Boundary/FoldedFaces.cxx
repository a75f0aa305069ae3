// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/FoldedFaces.h"

#include "Boundary/FaceQuality.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace morph
{
namespace
{
/// Whether the corners of a quadrilateral turn different ways.
bool isBowTie(const ConstPoints& points, const Index* nodes, Index size)
{
  if (size != 4)
  {
    return false;
  }
  const Eigen::RowVector3d area = vectorArea(points, nodes, size);
  for (Index k = 0; k < size; ++k)
  {
    const Eigen::RowVector3d a = points.row(nodes[(k + 1) % size]) - points.row(nodes[k]);
    const Eigen::RowVector3d b = points.row(nodes[(k + size - 1) % size]) - points.row(nodes[k]);
    if (!(a.cross(b).dot(area) > 0))
    {
      return true;
    }
  }
  return false;
}

enum class State : char
{
  Straight, ///< by faceQuality()
  BowTie,
  Turned, ///< not visited yet
  Visited
};

/// The rim of a patch of turned faces: its edges with a straight face of the same surface on the
/// other side.
struct Rim
{
  Index edges = 0;
  Index against = 0;    ///< number of these edges where the moved faces oppose each other
  bool bowTies = false; ///< the patch is next to such faces

  void add(double cosine)
  {
    ++this->edges;
    this->against += cosine <= 0 ? 1 : 0;
  }
  bool isFold() const { return this->edges > 0 ? 2 * this->against >= this->edges : this->bowTies; }
};

/// Calls body(g) once an edge for f and for the faces g of its surface that share the edge.
template <typename Body>
void forNeighbors(const Classification& geometry, Index f, const Body& body)
{
  const SurfaceEdges& edges = geometry.edges;
  for (const Index* e = edges.ofFace.begin(f); e != edges.ofFace.end(f); ++e)
  {
    for (const Index* g = edges.faces.begin(*e); g != edges.faces.end(*e); ++g)
    {
      if (geometry.surfaceOfFace[*g] == geometry.surfaceOfFace[f])
      {
        body(*g);
      }
    }
  }
}
}

std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry)
{
  const auto nodesOf = [&](Index f) { return faces.connectivity.data() + faces.offsets[f]; };
  const auto sizeOf = [&](Index f) { return faces.offsets[f + 1] - faces.offsets[f]; };
  std::vector<State> state(geometry.surfaceOfFace.size(), State::Straight);
  const std::vector<Index> candidates = faceQuality(rest, moved, faces, geometry).folded;
  std::vector<Index> folded, patch;
  for (Index f : candidates)
  {
    const bool bowTie = isBowTie(moved, nodesOf(f), sizeOf(f));
    state[f] = bowTie ? State::BowTie : State::Turned;
    if (bowTie)
    {
      folded.push_back(f);
    }
  }
  for (Index first : candidates)
  {
    if (state[first] != State::Turned)
    {
      continue;
    }
    Rim rim;
    state[first] = State::Visited;
    patch.assign(1, first);
    for (std::size_t next = 0; next < patch.size(); ++next)
    {
      const Index f = patch[next];
      forNeighbors(geometry, f,
        [&](Index g)
        {
          if (state[g] == State::Turned)
          {
            state[g] = State::Visited;
            patch.push_back(g);
          }
          rim.bowTies = rim.bowTies || state[g] == State::BowTie;
          if (state[g] == State::Straight)
          {
            rim.add(vectorArea(moved, nodesOf(f), sizeOf(f))
                      .dot(vectorArea(moved, nodesOf(g), sizeOf(g))));
          }
        });
    }
    if (rim.isFold())
    {
      folded.insert(folded.end(), patch.begin(), patch.end());
    }
  }
  std::sort(folded.begin(), folded.end());
  return folded;
}

std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<char>& isFixed)
{
  std::vector<Index> folded = foldedFaces(rest, moved, faces, geometry);
  const Index* nodes = faces.connectivity.data();
  const auto end = std::remove_if(folded.begin(), folded.end(),
    [&](Index f)
    {
      return !std::all_of(nodes + faces.offsets[f], nodes + faces.offsets[f + 1],
        [&](Index node) { return isFixed[node] != 0; });
    });
  folded.erase(end, folded.end());
  return folded;
}
}
