// SPDX-License-Identifier: BSD-3-Clause
// Cells of any order: where their nodes are, in the order of VTK's Lagrange and Bezier cells, which
// is corners, edges, faces, inside.
#include "Mesh/CellShape.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
using Place = std::array<double, 3>;
/// How often each corner of a simplex counts, of the order in all.
template <std::size_t N>
using Counts = std::array<int, N>;

/// Adds the inner points of edges, whose corners are given in the direction of the points.
template <std::size_t N>
void addEdges(int order, const std::vector<std::pair<int, int>>& edges, std::vector<Counts<N>>& to)
{
  for (const auto& [first, second] : edges)
  {
    for (int m = 1; m < order; ++m)
    {
      Counts<N> counts{};
      counts[first] = order - m;
      counts[second] = m;
      to.push_back(counts);
    }
  }
}

/// Adds those of a smaller simplex inside, each corner of which counts once more.
template <std::size_t N>
void addInside(const std::vector<Counts<N>>& inner, std::vector<Counts<N>>& to)
{
  for (Counts<N> counts : inner)
  {
    for (int& count : counts)
    {
      ++count;
    }
    to.push_back(counts);
  }
}

/// A simplex of order 0 is one point.
template <std::size_t N>
std::vector<Counts<N>> corners(int order)
{
  std::vector<Counts<N>> result;
  for (std::size_t i = 0; i < (order == 0 ? 1 : N); ++i)
  {
    Counts<N> counts{};
    counts[i] = order;
    result.push_back(counts);
  }
  return result;
}

/// None of an order below 0, as inside of a small one.
std::vector<Counts<3>> triangle(int order)
{
  if (order < 0)
  {
    return {};
  }
  std::vector<Counts<3>> result = corners<3>(order);
  addEdges<3>(order, { { 0, 1 }, { 1, 2 }, { 2, 0 } }, result);
  addInside(triangle(order - 3), result);
  return result;
}

std::vector<Counts<4>> tetrahedron(int order)
{
  if (order < 0)
  {
    return {};
  }
  std::vector<Counts<4>> result = corners<4>(order);
  addEdges<4>(order, { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } }, result);
  constexpr int Faces[4][3] = { { 0, 1, 3 }, { 2, 3, 1 }, { 0, 3, 2 }, { 0, 2, 1 } };
  for (const auto& face : Faces)
  {
    std::vector<Counts<3>> inside;
    addInside(triangle(order - 3), inside);
    for (const Counts<3>& of : inside)
    {
      Counts<4> counts{};
      for (int i = 0; i < 3; ++i)
      {
        counts[face[i]] = of[i];
      }
      result.push_back(counts);
    }
  }
  addInside(tetrahedron(order - 4), result);
  return result;
}

/// The points of an edge, or of a face that two edges from its first corner span, of a cell with
/// these corners.
void addLine(int order, const Place& from, const Place& to, std::vector<Place>& places)
{
  for (int m = 1; m < order; ++m)
  {
    Place place;
    for (int j = 0; j < 3; ++j)
    {
      place[j] = from[j] + (to[j] - from[j]) * m / order;
    }
    places.push_back(place);
  }
}

void addQuad(
  int order, const Place& at, const Place& first, const Place& second, std::vector<Place>& places)
{
  for (int m = 1; m < order; ++m)
  {
    Place from, to;
    for (int j = 0; j < 3; ++j)
    {
      from[j] = at[j] + (second[j] - at[j]) * m / order;
      to[j] = from[j] + first[j] - at[j];
    }
    addLine(order, from, to, places);
  }
}

/// Row by row, unlike the triangles of a tetrahedron.
void addTriangle(int order, double height, std::vector<Place>& places)
{
  for (int j = 1; j < order; ++j)
  {
    for (int i = 1; i + j < order; ++i)
    {
      places.push_back({ double(i) / order, double(j) / order, height });
    }
  }
}

/// Where the nodes after the corners are.
std::vector<Place> tetrahedronPlaces(int order)
{
  const std::vector<Counts<4>> all = tetrahedron(order);
  std::vector<Place> places;
  for (auto counts = all.begin() + 4; counts < all.end(); ++counts)
  {
    places.push_back(
      { double((*counts)[1]) / order, double((*counts)[2]) / order, double((*counts)[3]) / order });
  }
  return places;
}

std::vector<Place> hexahedronPlaces(int order)
{
  constexpr Place Corners[] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
    { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
  constexpr int Edges[12][2] = { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 4, 5 }, { 5, 6 },
    { 7, 6 }, { 4, 7 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
  constexpr int Faces[6][3] = { { 0, 3, 4 }, { 1, 2, 5 }, { 0, 1, 4 }, { 3, 2, 7 }, { 0, 1, 3 },
    { 4, 5, 7 } };
  std::vector<Place> places;
  for (const auto& edge : Edges)
  {
    addLine(order, Corners[edge[0]], Corners[edge[1]], places);
  }
  for (const auto& face : Faces)
  {
    addQuad(order, Corners[face[0]], Corners[face[1]], Corners[face[2]], places);
  }
  for (int m = 1; m < order; ++m)
  {
    const double height = double(m) / order;
    addQuad(order, { 0, 0, height }, { 1, 0, height }, { 0, 1, height }, places);
  }
  return places;
}

std::vector<Place> wedgePlaces(int order)
{
  constexpr Place Corners[] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
    { 0, 1, 1 } };
  constexpr int Edges[9][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 },
    { 0, 3 }, { 1, 4 }, { 2, 5 } };
  constexpr int Faces[3][3] = { { 0, 1, 3 }, { 1, 2, 4 }, { 2, 0, 5 } };
  std::vector<Place> places;
  for (const auto& edge : Edges)
  {
    addLine(order, Corners[edge[0]], Corners[edge[1]], places);
  }
  addTriangle(order, 0, places);
  addTriangle(order, 1, places);
  for (const auto& face : Faces)
  {
    addQuad(order, Corners[face[0]], Corners[face[1]], Corners[face[2]], places);
  }
  for (int m = 1; m < order; ++m)
  {
    addTriangle(order, double(m) / order, places);
  }
  return places;
}

/// Order 2 with a node in the middle of each triangle and inside.
std::vector<Place> tetrahedronOf15()
{
  constexpr double Third = 1. / 3;
  std::vector<Place> places = tetrahedronPlaces(2);
  places.insert(places.end(), { { Third, Third, 0 }, { Third, 0, Third }, { Third, Third, Third },
                                { 0, Third, Third }, { .25, .25, .25 } });
  return places;
}

std::vector<Place> wedgeOf21()
{
  constexpr double Third = 1. / 3;
  std::vector<Place> places = wedgePlaces(2);
  places.insert(places.begin() + 9, { { Third, Third, 0 }, { Third, Third, 1 } });
  places.push_back({ Third, Third, .5 });
  return places;
}

/// Makes the share of the first corner of a simplex, 1 - r - s - t, exactly 0 where rounding alone
/// is left of it: nodes are told apart by the corners that have a share in them.
void removeRounding(Shape shape, std::vector<Place>& places)
{
  constexpr double Rounding = 1e-12;
  for (auto& [r, s, t] : places)
  {
    if (shape == Shape::Tet && t > 0 && std::abs(1 - r - s - t) < Rounding)
    {
      t = 1 - r - s;
    }
    else if ((shape == Shape::Tet ? t == 0 : shape == Shape::Wedge) &&
             std::abs(1 - r - s) < Rounding)
    {
      s = 1 - r;
    }
  }
}

struct Owned
{
  CellShape shape;
  std::vector<Place> places; ///< what shape.extraNodes points to
};

/// Owned shapes stay where they are, so that what points to their places does, too.
using Shapes = std::map<std::pair<std::uint8_t, Index>, Owned>;

void addShapes(std::uint8_t type, Shapes& shapes)
{
  const CellShape& open = *cellShape(type);
  const auto add = [&](int nodes, std::vector<Place> places)
  {
    removeRounding(open.shape, places);
    Owned& owned = shapes[{ type, nodes }] = { open, std::move(places) };
    owned.shape.numberOfNodes = nodes;
    owned.shape.extraNodes =
      owned.places.empty() ? nullptr : reinterpret_cast<const double(*)[3]>(owned.places.data());
    owned.shape.isMapped = nodes == open.numberOfCorners; // of a cell without other nodes
  };
  const auto addVolume = [&](std::vector<Place> places)
  {
    const int nodes = open.numberOfCorners + static_cast<int>(places.size());
    add(nodes, std::move(places));
  };
  for (int order = 1; order <= HighestOrder; ++order)
  {
    switch (open.shape)
    {
      case Shape::Tet:
        addVolume(tetrahedronPlaces(order));
        break;
      case Shape::Hex:
        addVolume(hexahedronPlaces(order));
        break;
      case Shape::Wedge:
        addVolume(wedgePlaces(order));
        break;
      case Shape::Tri:
        add((order + 1) * (order + 2) / 2, {});
        break;
      case Shape::Quadrilateral:
        add((order + 1) * (order + 1), {});
        break;
      default:
        add(order + 1, {});
    }
  }
  switch (open.shape)
  {
    case Shape::Tet:
      addVolume(tetrahedronOf15());
      break;
    case Shape::Wedge:
      addVolume(wedgeOf21());
      break;
    case Shape::Tri:
      add(7, {});
      break;
    default:
      break;
  }
}
}

const CellShape* shapeOfAnyOrder(std::uint8_t type, Index nodes)
{
  static const auto shapes = []
  {
    Shapes all;
    for (std::uint8_t known = LagrangeCurve; known <= BezierWedge; ++known)
    {
      if (cellShape(known))
      {
        addShapes(known, all);
      }
    }
    return all;
  }();
  const auto found = shapes.find({ type, nodes });
  return found == shapes.end() ? nullptr : &found->second.shape;
}
}
