// SPDX-License-Identifier: BSD-3-Clause
#include "RandomMesh.h"

#include "../Core/BoundaryShapes.h"
#include "../Core/Meshes.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Quadratic.h"

#include <vtkCell.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace fuzz
{
using morph::Index;
using morph::Mesh;

namespace
{
using Row = Eigen::RowVector3d;

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

Mesh voxels(int nx, int ny, int nz)
{
  const Mesh hexes = meshes::hexes(nx, ny, nz);
  Mesh mesh;
  mesh.points = hexes.points;
  for (Index c = 0; c < hexes.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(hexes.cell(c), hexes.cell(c) + 8);
    std::swap(nodes[2], nodes[3]);
    std::swap(nodes[6], nodes[7]);
    meshes::add(mesh, morph::Voxel, nodes);
  }
  return mesh;
}

/// Each box in six pyramids about its center.
Mesh pyramids(int nx, int ny, int nz)
{
  const Mesh hexes = meshes::hexes(nx, ny, nz);
  Mesh mesh;
  mesh.points.resize(hexes.numberOfNodes() + hexes.numberOfCells(), 3);
  mesh.points.topRows(hexes.numberOfNodes()) = hexes.points;
  for (Index c = 0; c < hexes.numberOfCells(); ++c)
  {
    const Index apex = hexes.numberOfNodes() + c;
    Row middle = Row::Zero();
    for (int k = 0; k < 8; ++k)
    {
      middle += hexes.points.row(hexes.cell(c)[k]) / 8;
    }
    mesh.points.row(apex) = middle;
    const morph::CellShape& hexahedron = *morph::cellShape(morph::Hexahedron);
    for (int f = 0; f < 6; ++f)
    {
      // Faces are outward; a pyramid's base is seen from its apex.
      const int(&corner)[4] = hexahedron.faces[f].corner;
      meshes::add(mesh, morph::Pyramid,
        { hexes.cell(c)[corner[3]], hexes.cell(c)[corner[2]], hexes.cell(c)[corner[1]],
          hexes.cell(c)[corner[0]], apex });
    }
  }
  return mesh;
}

/// hexes() with a fin: a row of cells that only the last of hangs together with the others.
Mesh finned(int nx, int ny, int nz)
{
  Mesh mesh = meshes::hexes(nx, ny, nz);
  const Index corner = nx; // of the first layer
  Index root[4] = { corner, corner + (nx + 1), corner + (nx + 1) * (ny + 1) + (nx + 1),
    corner + (nx + 1) * (ny + 1) };
  for (int length = 1; length <= 3; ++length)
  {
    const Index before = mesh.numberOfNodes();
    mesh.points.conservativeResize(before + 4, 3);
    std::vector<Index> nodes(root, root + 4);
    for (int k = 0; k < 4; ++k)
    {
      mesh.points.row(before + k) = mesh.points.row(root[k]) + Row(1, 0, 0);
      root[k] = before + k;
      nodes.push_back(root[k]);
    }
    meshes::add(mesh, morph::Hexahedron, nodes);
  }
  return mesh;
}

/// Cells of any type between random points.
Mesh soup(Random random)
{
  Mesh mesh;
  mesh.points.resize(30 + random.below(40), 3);
  for (double& x : mesh.points.reshaped())
  {
    x = random.between(0, 3);
  }
  const int cells = 1 + random.below(15);
  while (mesh.numberOfCells() < cells)
  {
    const auto type = static_cast<std::uint8_t>(random.below(36));
    if (const morph::CellShape* shape = morph::cellShape(type))
    {
      const int size = shape->numberOfNodes < 0 ? 1 + random.below(6) : shape->numberOfNodes;
      std::vector<Index> nodes(size);
      for (Index& node : nodes)
      {
        node = random.below(static_cast<int>(mesh.numberOfNodes()));
      }
      meshes::add(mesh, type, nodes);
    }
  }
  return mesh;
}

/// A box some of whose cells are in eight, and some of these in eight again.
Mesh octree(Choices& choices, int order, Known& known)
{
  Random random = choices.stream("octree");
  const auto length = [&] { return 1 + random.below(2); };
  const meshes::Octree made(
    static_cast<unsigned>(random.bits()), order, { 2, length(), order == 1 ? length() : 1 });
  known.outer = made.outer();
  known.hanging = made.hanging;
  return made.mesh;
}

/// Lets the ends of an edge of a hexahedron be one node, so that cells are hexahedra of seven
/// nodes; perhaps those of the edge across a face, too, of six.
void collapse(Choices& choices, Mesh& mesh)
{
  Random random = choices.stream("mesh.collapsed");
  const Index* cell = mesh.cell(random.below(static_cast<int>(mesh.numberOfCells())));
  const morph::CellShape& shape = *morph::cellShape(morph::Hexahedron);
  const auto& face = shape.faces[random.below(6)].corner;
  std::vector<Index> to(mesh.numberOfNodes());
  std::iota(to.begin(), to.end(), Index{ 0 });
  to[cell[face[0]]] = cell[face[1]];
  if (random.happens(0.5))
  {
    to[cell[face[3]]] = cell[face[2]];
  }
  for (Index& node : mesh.connectivity)
  {
    node = to[node];
  }
}

/// Winds faces at random the other way round.
void wind(Choices& choices, Mesh& mesh)
{
  Random random = choices.stream("mesh.windings");
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (random.happens(0.4))
    {
      const auto first = mesh.connectivity.begin() + mesh.offsets[c];
      const auto middle = first + morph::cellShape(mesh.types[c])->numberOfCorners;
      std::reverse(first + 1, middle);
      std::reverse(middle, mesh.connectivity.begin() + mesh.offsets[c + 1]);
    }
  }
}

enum Sides
{
  Periodic = 1,
  Symmetric,
  Layer ///< front and back of a mesh that is one cell thick
};

/// Makes the sides at the ends of x, or of z, images of each other, or the one at x = 0 a plane of
/// symmetry.
void nameSides(int sides, const Mesh& mesh, Known& known)
{
  const int across = sides == Layer ? 2 : 0, along = 2 - across;
  const std::vector<Index> outer = outerNodes(mesh);
  const double end = mesh.points.col(across).maxCoeff();
  std::map<std::pair<double, double>, Index> image;
  for (const Index n : outer)
  {
    if (mesh.points(n, across) == end)
    {
      image[{ mesh.points(n, 1), mesh.points(n, along) }] = n;
    }
  }
  for (const Index n : outer)
  {
    const auto found = image.find({ mesh.points(n, 1), mesh.points(n, along) });
    if (sides != Symmetric && mesh.points(n, across) == 0 && found != image.end())
    {
      known.images.emplace_back(n, found->second);
    }
    if (sides == Symmetric && mesh.points(n, 0) == 0)
    {
      known.plane.push_back(n);
    }
  }
}

/// Lets nodes on edges lie anywhere in the middle third.
void shiftMiddles(Random random, const Mesh& mesh, Known& known)
{
  std::set<Index> done;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh, c);
    for (int k = shape->numberOfCorners; k < shape->numberOfNodes; ++k)
    {
      double N[8];
      morph::shapeFunctions(
        shape->shape, shape->extraNodes[k - shape->numberOfCorners], N, nullptr);
      std::vector<Index> ends;
      for (int a = 0; a < shape->numberOfCorners; ++a)
      {
        if (N[a] == 0.5)
        {
          ends.push_back(mesh.cell(c)[a]);
        }
      }
      if (ends.size() == 2 && done.insert(mesh.cell(c)[k]).second)
      {
        known.between.push_back(
          { mesh.cell(c)[k], { ends[0], ends[1] }, random.between(1. / 3, 2. / 3) });
      }
    }
  }
}

/// Lets the cells on one side of a node inside have a copy of it, so that faces part there.
void openSlit(Random random, Mesh& mesh, Known& known)
{
  const std::vector<Index> outer = outerNodes(mesh);
  std::vector<Index> inside(mesh.numberOfNodes());
  std::iota(inside.begin(), inside.end(), Index{ 0 });
  inside.erase(std::remove_if(inside.begin(), inside.end(),
                 [&](Index n) { return std::binary_search(outer.begin(), outer.end(), n); }),
    inside.end());
  const Index node = inside[random.below(static_cast<int>(inside.size()))];
  const Index copy = mesh.numberOfNodes();
  mesh.points.conservativeResize(copy + 1, 3);
  mesh.points.row(copy) = mesh.points.row(node);
  known.slit.emplace_back(node, copy);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    if (mesh.points(nodes, 0).mean() > mesh.points(node, 0))
    {
      std::replace(mesh.connectivity.begin() + mesh.offsets[c],
        mesh.connectivity.begin() + mesh.offsets[c + 1], node, copy);
    }
  }
}

/// A rectangle in the plane z = 0, or a saddle on it, of quadrilaterals, triangles or both, linear
/// or quadratic.
Mesh faces(Choices& choices, Known& known)
{
  const int kind =
    choices.pick("faces.cells", { "quadrilaterals", "triangles", "both" }, { 2, 2, 1 });
  const bool isQuadratic = choices.chance("faces.quadratic", 0.2);
  choices.whole("with.order", 0, [isQuadratic](Random&) { return isQuadratic ? 1 : 0; });
  const auto length = [](Random& random) { return 2 + random.below(4); };
  const int nx = choices.whole("mesh.nx", 3, length), ny = choices.whole("mesh.ny", 3, length);
  const int steps = isQuadratic ? 2 : 1; // half a cell
  const int row = steps * ny + 1;
  Random random = choices.stream("mesh.faces");
  const double bend = known.faces == Known::Curved ? random.between(0.05, 0.3) : 0;
  Mesh mesh;
  mesh.points.resize((steps * nx + 1) * row, 3);
  for (int i = 0; i <= steps * nx; ++i)
  {
    for (int j = 0; j < row; ++j)
    {
      const double x = double(i) / steps, y = double(j) / steps;
      mesh.points.row(i * row + j) = Row(x, y, bend * (x * x / nx - 0.7 * y * y / ny + x * y / 9));
      if (i == 0 || j == 0 || i == steps * nx || j == row - 1)
      {
        known.outer.push_back(i * row + j);
      }
    }
  }
  for (int cell = 0; cell < nx * ny; ++cell)
  {
    const auto at = [&](int i, int j) -> Index
    { return (cell / ny * steps + i) * row + cell % ny * steps + j; };
    const Index a = at(0, 0), b = at(steps, 0), c = at(steps, steps), d = at(0, steps);
    const bool isQuad = kind == 0 || (kind == 2 && random.happens(0.5));
    if (!isQuadratic && isQuad)
    {
      meshes::add(mesh, morph::Quad, { a, b, c, d });
    }
    else if (!isQuadratic)
    {
      meshes::add(mesh, morph::Triangle, { a, b, c });
      meshes::add(mesh, morph::Triangle, { a, c, d });
    }
    else if (isQuad)
    {
      meshes::add(
        mesh, morph::QuadraticQuad, { a, b, c, d, at(1, 0), at(2, 1), at(1, 2), at(0, 1) });
    }
    else
    {
      meshes::add(mesh, morph::QuadraticTriangle, { a, b, c, at(1, 0), at(2, 1), at(1, 1) });
      meshes::add(mesh, morph::QuadraticTriangle, { a, c, d, at(1, 1), at(1, 2), at(0, 1) });
    }
  }
  return mesh;
}

Mesh lattice(Choices& choices, Known& known)
{
  known.faces = choices.chance("with.plane", 0.035)   ? Known::Plane
                : choices.chance("with.shell", 0.035) ? Known::Curved
                                                      : Known::None;
  if (known.faces != Known::None)
  {
    Mesh mesh = faces(choices, known);
    if (choices.chance("with.windings", 0.4))
    {
      wind(choices, mesh);
    }
    return mesh;
  }
  if (const int order =
        choices.pick("with.octree", { "none", "linear", "quadratic" }, { 20, 1.2, 0.8 }))
  {
    choices.whole("with.order", 0, [order](Random&) { return order - 1; });
    return octree(choices, order, known);
  }
  const int kind = choices.pick("mesh.cells",
    { "hexahedra", "tetrahedra", "wedges", "hexahedra and pyramids", "hexahedra and wedges",
      "voxels", "pyramids", "block with a fin", "soup" },
    { 6, 6, 3, 2, 2, 1, 1, 1, 0.6 });
  const int order =
    kind == 5 || kind == 8
      ? 0
      : choices.pick("with.order",
          { "linear", "quadratic", "fully quadratic", "quadratic-linear", "any order" },
          { 7, 1, 1, 0.5, 0.5 });
  // Quadratic cells bring many nodes.
  const double large = order == 0 ? 0.15 : 0.03;
  const auto length = [large](Random& random) {
    return random.happens(large) ? 3 + random.below(2) : random.happens(0.05) ? 1 : 2;
  };
  const bool isSlit = kind < 5 && order == 0 && choices.chance("with.slit", 0.05);
  const int nx = isSlit ? 3 : choices.whole("mesh.nx", 2, length);
  const int ny = isSlit ? 3 : choices.whole("mesh.ny", 2, length);
  const bool mayBeLayer = kind == 0 || kind == 2;
  const int sides = kind < 7 && !isSlit
                      ? choices.pick("with.sides", { "none", "periodic", "symmetry", "layer" },
                          { 20, 1, 1, mayBeLayer ? 1. : 0. })
                      : 0;
  const int nz = isSlit ? 3 : sides == Layer ? 1 : choices.whole("mesh.nz", 2, length);
  using Maker = Mesh (*)(int, int, int);
  constexpr Maker makers[] = { meshes::hexes, meshes::tets, meshes::wedges,
    meshes::hexesAndPyramids, meshes::hexesAndWedges, voxels, pyramids, finned };
  Mesh mesh = kind == 8 ? soup(choices.stream("mesh.soup")) : makers[kind](nx, ny, nz);
  // In part: mid-side nodes that the neighbor does not have.
  const double part = order > 0 && choices.chance("mesh.partlyQuadratic", 0.1) ? 0.5 : 1;
  if (isSlit)
  {
    openSlit(choices.stream("mesh.slit"), mesh, known);
  }
  known.isCollapsed = kind == 0 && sides == 0 && !isSlit && choices.chance("with.collapsed", 0.15);
  if (known.isCollapsed)
  {
    collapse(choices, mesh);
  }
  mesh = order == 0 ? mesh : quadratic(mesh, order, part, choices.stream("mesh.quadraticCells"));
  if (order > 0 && order < 4 && sides == 0 && !known.isCollapsed &&
      choices.chance("with.offMiddle", 0.3))
  {
    shiftMiddles(choices.stream("mesh.offMiddle"), mesh, known);
  }
  if (sides != 0 && part == 1)
  {
    nameSides(sides, mesh, known);
  }
  return mesh;
}

Mesh withCells(const Mesh& mesh, const std::vector<Index>& cells)
{
  Mesh result;
  result.points = mesh.points;
  for (const Index c : cells)
  {
    meshes::add(
      result, mesh.types[c], std::vector<Index>(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c)));
  }
  return result;
}

/// Cells that lie elsewhere in the list, are missing or come twice: holes, several bodies, edges
/// with four faces.
/// `isWhole`: none is missing. `isShell`: none of another dimension comes in.
void changeCells(Choices& choices, Mesh& mesh, bool hostile, bool isWhole, bool isShell)
{
  std::vector<Index> cells(mesh.numberOfCells());
  std::iota(cells.begin(), cells.end(), Index{ 0 });
  Random random = choices.stream("cells.random");
  if (const double part = !isWhole && choices.chance("cells.missing", 0.08)
                            ? choices.stream("part").between(0.1, 0.7)
                            : 0)
  {
    std::vector<Index> left;
    for (const Index c : cells)
    {
      if (!random.happens(part))
      {
        left.push_back(c);
      }
    }
    cells = left;
  }
  if (choices.chance("cells.shuffled", 0.1))
  {
    for (std::size_t i = cells.size(); i > 1; --i)
    {
      std::swap(cells[i - 1], cells[random.below(static_cast<int>(i))]);
    }
  }
  if (!isWhole && !hostile && !cells.empty() && choices.chance("with.doubled", 0.05))
  {
    cells.push_back(cells[random.below(static_cast<int>(cells.size()))]);
  }
  if (hostile && choices.chance("cells.twice", 0.06))
  {
    const bool all = random.happens(0.4);
    const std::vector<Index> once = cells;
    for (const Index c : once)
    {
      if (all || random.happens(0.2))
      {
        cells.push_back(c);
      }
    }
  }
  if (hostile && choices.chance("cells.none", 0.02))
  {
    cells.clear();
  }
  mesh = withCells(mesh, cells);
  if (hostile && choices.chance("cells.insideOut", 0.1) && mesh.numberOfCells() > 0)
  {
    const double part = random.happens(0.3) ? 1 : random.between(0, 0.5);
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (mesh.cellSize(c) >= 4 && random.happens(part))
      {
        std::swap(mesh.connectivity[mesh.offsets[c]], mesh.connectivity[mesh.offsets[c] + 1]);
      }
    }
  }
  if (hostile && choices.chance("cells.repeatedNodes", 0.08) && mesh.numberOfCells() > 0)
  {
    const int times = 1 + random.below(3);
    for (int i = 0; i < times; ++i)
    {
      const int c = random.below(static_cast<int>(mesh.numberOfCells()));
      const int size = static_cast<int>(mesh.cellSize(c));
      if (size > 0)
      {
        Index* nodes = mesh.connectivity.data() + mesh.offsets[c];
        nodes[random.below(size)] = nodes[random.below(size)];
      }
    }
  }
  const bool isAttached = !isShell && choices.chance("with.attached", 0.05);
  const bool isAmong = !isShell && choices.chance("cells.lowerDimensions", 0.05);
  if ((isAttached || isAmong) && mesh.numberOfNodes() > 0)
  {
    constexpr std::uint8_t types[] = { morph::Vertex, morph::PolyVertex, morph::Line,
      morph::PolyLine, morph::Triangle, morph::TriangleStrip, morph::Polygon, morph::Pixel,
      morph::Quad, morph::QuadraticEdge, morph::QuadraticTriangle, morph::QuadraticQuad,
      morph::BiquadraticQuad, morph::QuadraticLinearQuad, morph::BiquadraticTriangle,
      morph::EmptyCell };
    const int more = 1 + random.below(5);
    if (isAttached)
    {
      const Index before = mesh.numberOfNodes();
      const Row middle = mesh.points.row(random.below(static_cast<int>(before)));
      mesh.points.conservativeResize(before + 1 + random.below(6), 3);
      for (Index n = before; n < mesh.numberOfNodes(); ++n)
      {
        mesh.points.row(n) = middle + 2 * Row(random.unit(), random.unit(), random.unit());
      }
    }
    for (int i = 0; i < more; ++i)
    {
      const std::uint8_t type = types[random.below(static_cast<int>(std::size(types)))];
      const int given = morph::cellShape(type)->numberOfNodes;
      std::vector<Index> nodes(given < 0 ? 3 + random.below(3) : given);
      for (Index& node : nodes)
      {
        node = random.below(static_cast<int>(mesh.numberOfNodes()));
      }
      meshes::add(mesh, type, nodes);
    }
  }
}

/// Moves nodes at random, in units of a cell.
void jitter(Choices& choices, Mesh& mesh, bool hostile, const Known& known)
{
  const morph::Points before = mesh.points;
  const std::vector<Index> outer = known.outer.empty() ? outerNodes(mesh) : known.outer;
  const std::set<Index> isOuter(outer.begin(), outer.end());
  const double inside = choices.number("jitter.inside", 0,
    [hostile](Random& r)
    { return r.happens(0.3) ? 0 : r.between(0, hostile && r.happens(0.3) ? 3 : 0.2); });
  const double outside = choices.number("jitter.outside", 0,
    [hostile](Random& r)
    { return r.happens(0.7) ? 0 : r.between(0, hostile && r.happens(0.3) ? 2 : 0.15); });
  Random random = choices.stream("jitter");
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    // The smallest cells of an octree are a quarter as wide, and quadratic faces soon fold.
    const bool isSlim = !known.outer.empty() || known.isCollapsed;
    const double amount = (isSlim ? 0.25 : 1) * (isOuter.count(n) ? outside : inside);
    for (int j = 0; j < 3; ++j)
    {
      mesh.points(n, j) += amount * random.between(-1, 1);
    }
  }
  for (const auto& [node, image] : known.images)
  {
    mesh.points.row(image) = before.row(image) + mesh.points.row(node) - before.row(node);
  }
  for (const Index node : known.plane)
  {
    mesh.points(node, 0) = 0;
  }
  if (known.faces == Known::Plane)
  {
    mesh.points.col(2).setZero();
  }
  for (const auto& [node, copy] : known.slit)
  {
    mesh.points.row(copy) = mesh.points.row(node);
  }
  for (const Known::Between& own : known.between)
  {
    mesh.points.row(own.node) =
      (1 - own.at) * mesh.points.row(own.ends[0]) + own.at * mesh.points.row(own.ends[1]);
  }
  // What a node hangs on may hang itself, a level above.
  for (int level = 0; level < 3; ++level)
  {
    for (const auto& own : known.hanging)
    {
      Row place = Row::Zero();
      for (std::size_t k = 0; k < own.masters.size(); ++k)
      {
        place += own.weights[k] * mesh.points.row(own.masters[k]);
      }
      mesh.points.row(own.node) = place;
    }
  }
}

/// Adds a copy beside the mesh, which shares no node and touches it or leaves a gap. Boxes round
/// both have no more than a side in common.
void addTwin(Choices& choices, Mesh& mesh, Known& known)
{
  if (mesh.numberOfNodes() == 0 || !choices.chance("with.twin", 0.05))
  {
    return;
  }
  const double size = mesh.points.col(0).maxCoeff() - mesh.points.col(0).minCoeff();
  const int gap = choices.pick("twin.gap", { "none", "small", "large" }, { 2, 1, 1 });
  Mesh twin = mesh;
  twin.points.col(0).array() += size * (gap == 0 ? 1 : gap == 1 ? 1.01 : 1.5);
  const Index nodes = mesh.numberOfNodes();
  mesh = shapes::together(mesh, twin);
  known.twin.resize(nodes);
  std::iota(known.twin.begin(), known.twin.end(), nodes);
  const auto shifted = [nodes](std::vector<Index> ids)
  {
    std::for_each(ids.begin(), ids.end(), [nodes](Index& id) { id += nodes; });
    return ids;
  };
  const std::vector<Index> outer = shifted(known.outer);
  known.outer.insert(known.outer.end(), outer.begin(), outer.end());
  const std::vector<meshes::Octree::Hanging> hanging = known.hanging;
  for (const auto& own : hanging)
  {
    known.hanging.push_back({ own.node + nodes, shifted(own.masters), own.weights });
  }
  const std::vector<Known::Between> between = known.between;
  for (const Known::Between& own : between)
  {
    known.between.push_back(
      { own.node + nodes, { own.ends[0] + nodes, own.ends[1] + nodes }, own.at });
  }
}

/// Turns, stretches, mirrors, scales and moves the mesh.
void place(Choices& choices, Mesh& mesh, bool hostile)
{
  Random random = choices.stream("place");
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  if (choices.chance("place.turned", 0.3))
  {
    A = Eigen::AngleAxisd(random.between(-3, 3),
      Eigen::Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1.1))
        .normalized())
          .toRotationMatrix();
  }
  const double most = hostile ? 4 : 0.7;
  if (choices.chance("place.stretched", 0.2))
  {
    A = A * Eigen::Vector3d(random.power(-most, most), random.power(-most, most), 1).asDiagonal();
  }
  if (choices.chance("place.mirrored", 0.06))
  {
    A.col(0) *= -1;
  }
  if (hostile && choices.chance("place.flat", 0.04))
  {
    A.row(2).setZero();
  }
  if (hostile && choices.chance("place.onePoint", 0.02))
  {
    A.setZero();
  }
  const double power = choices.number("place.power", 0,
    [hostile](Random& r)
    {
      const double wide = r.between(-6, 6);
      constexpr double far[] = { -30, -45, -60, -110, -200, -310, 30, 45, 60, 110, 160, 200, 300 };
      const double extreme = far[r.below(static_cast<int>(std::size(far)))] + r.between(-3, 3);
      return r.happens(hostile ? 0.3 : 0) ? extreme : r.happens(0.25) ? wide : 0;
    });
  const double away = choices.number("place.away", 0,
    [hostile](Random& r)
    {
      const double sizes = r.between(-10, 10);
      const double far = r.power(1, hostile ? 14 : 3);
      return r.happens(hostile ? 0.3 : 0.1) ? far : r.happens(0.2) ? sizes : 0;
    });
  const double scale = std::pow(10.0, power);
  const Row shift = away * scale * Row(1, -0.7, 0.3);
  mesh.points = (scale * (mesh.points * A.transpose()).array()).matrix();
  mesh.points.rowwise() += shift;
}

/// Coordinates that are not finite, points on one place, points without cells.
void spoilPoints(Choices& choices, Mesh& mesh, bool hostile, Known& known)
{
  Random random = choices.stream("points");
  if (choices.chance("points.unused", 0.08))
  {
    const Index before = mesh.numberOfNodes();
    mesh.points.conservativeResize(before + 1 + random.below(4), 3);
    for (Index n = before; n < mesh.numberOfNodes(); ++n)
    {
      mesh.points.row(n) = Row(random.between(-9, 9), random.between(-9, 9), 5);
    }
  }
  if (choices.chance("points.renumbered", 0.15))
  {
    std::vector<Index> order(mesh.numberOfNodes());
    std::iota(order.begin(), order.end(), Index{ 0 });
    for (std::size_t i = order.size(); i > 1; --i)
    {
      std::swap(order[i - 1], order[random.below(static_cast<int>(i))]);
    }
    mesh = meshes::renumbered(mesh, order);
    const auto rename = [&order](std::vector<Index>& ids)
    { std::for_each(ids.begin(), ids.end(), [&order](Index& id) { id = order[id]; }); };
    for (auto& own : known.hanging)
    {
      own.node = order[own.node];
      rename(own.masters);
    }
    for (auto& [node, image] : known.images)
    {
      node = order[node];
      image = order[image];
    }
    for (auto& [node, copy] : known.slit)
    {
      node = order[node];
      copy = order[copy];
    }
    for (Known::Between& own : known.between)
    {
      own = { order[own.node], { order[own.ends[0]], order[own.ends[1]] }, own.at };
    }
    for (std::vector<Index>* ids : { &known.outer, &known.plane, &known.twin })
    {
      rename(*ids);
      std::sort(ids->begin(), ids->end());
    }
  }
  if (!hostile || mesh.numberOfNodes() == 0)
  {
    return;
  }
  const auto any = [&] { return random.below(static_cast<int>(mesh.numberOfNodes())); };
  const int notFinite = choices.pick("points.value",
    { "as made", "NaN", "infinite", "1e200", "1e80", "1e-200" }, { 40, 1, 1, 1, 1, 1 });
  if (notFinite > 0)
  {
    constexpr double values[] = { 0, NaN, Infinity, 1e200, 1e80, 1e-200 };
    mesh.points(any(), random.below(3)) = values[notFinite];
  }
  if (choices.chance("points.together", 0.06))
  {
    const int times = 1 + random.below(4);
    for (int i = 0; i < times; ++i)
    {
      mesh.points.row(any()) = mesh.points.row(any()).eval();
    }
  }
}
}

std::vector<Index> outerNodes(const Mesh& mesh)
{
  std::map<std::vector<vtkIdType>, std::pair<int, std::vector<vtkIdType>>> faces;
  vtkNew<vtkGenericCell> cell;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
    if (!shape || shape->dimension != 3)
    {
      continue;
    }
    if (shape->shape == morph::Shape::Polyhedron)
    {
      morph::forEachFace(mesh, c,
        [&](const Index* first, Index size)
        {
          const std::vector<vtkIdType> corners(first, first + size);
          const std::set<vtkIdType> ids(first, first + size);
          auto& [uses, all] = faces[{ ids.begin(), ids.end() }];
          ++uses;
          all = corners;
        });
      continue;
    }
    // VTK's faces of third order assert; those of corners are alike.
    const bool isAnyOrder = mesh.types[c] >= morph::LagrangeCurve;
    constexpr std::uint8_t linear[] = { morph::Tetra, morph::Hexahedron, morph::Wedge };
    cell->SetCellType(
      isAnyOrder ? linear[(mesh.types[c] - morph::LagrangeTetrahedron) % 7] : mesh.types[c]);
    for (Index k = 0; k < (isAnyOrder ? shape->numberOfCorners : mesh.cellSize(c)); ++k)
    {
      cell->PointIds->SetId(k, mesh.cell(c)[k]);
    }
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f)
    {
      vtkIdList* ids = cell->GetFace(f)->GetPointIds();
      std::vector<vtkIdType> nodes(ids->begin(), ids->end());
      if (shape->faces[f].size == 4 && (nodes[0] == nodes[2] || nodes[1] == nodes[3]))
      {
        continue; // it goes to a corner and back
      }
      // Corners come first.
      std::set<vtkIdType> corners(
        nodes.begin(), nodes.begin() + std::min<std::size_t>(nodes.size(), shape->faces[f].size));
      // Also those of an edge that has collapsed into a corner.
      for (int k = shape->numberOfCorners; k < mesh.cellSize(c); ++k)
      {
        double N[8], share = 0;
        const morph::CellShape& own = *morph::cellShape(mesh, c);
        morph::shapeFunctions(own.shape, own.extraNodes[k - own.numberOfCorners], N, nullptr);
        for (int a = 0; a < own.numberOfCorners; ++a)
        {
          share += corners.count(mesh.cell(c)[a]) > 0 ? N[a] : 0;
        }
        if (share > 1 - 1e-9)
        {
          nodes.push_back(mesh.cell(c)[k]);
        }
      }
      auto& [uses, all] = faces[std::vector<vtkIdType>(corners.begin(), corners.end())];
      ++uses;
      all = nodes;
    }
  }
  std::set<Index> outer;
  for (const auto& [corners, face] : faces)
  {
    if (face.first == 1 && corners.size() >= 3)
    {
      outer.insert(face.second.begin(), face.second.end());
    }
  }
  return { outer.begin(), outer.end() };
}

std::vector<Index> cellNodes(const Mesh& mesh, const Known& known)
{
  std::set<Index> nodes;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
    if (shape && shape->dimension == (known.faces == Known::None ? 3 : 2))
    {
      nodes.insert(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    }
  }
  return { nodes.begin(), nodes.end() };
}

std::vector<AttachedPart> attachedParts(const Mesh& mesh)
{
  const std::vector<Index> volume = cellNodes(mesh, {});
  const auto isVolume = [&](Index n)
  { return std::binary_search(volume.begin(), volume.end(), n); };
  std::vector<std::pair<std::set<Index>, std::set<Index>>> parts; // nodes, anchors
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
    if (!shape || shape->dimension < 1 || shape->dimension > 2)
    {
      continue;
    }
    std::pair<std::set<Index>, std::set<Index>> part;
    for (const Index* n = mesh.cell(c); n != mesh.cell(c) + mesh.cellSize(c); ++n)
    {
      (isVolume(*n) ? part.second : part.first).insert(*n);
    }
    if (part.first.empty())
    {
      continue;
    }
    for (auto other = parts.begin(); other != parts.end();)
    {
      const bool isJoined = std::any_of(
        other->first.begin(), other->first.end(), [&](Index n) { return part.first.count(n) > 0; });
      if (isJoined)
      {
        part.first.insert(other->first.begin(), other->first.end());
        part.second.insert(other->second.begin(), other->second.end());
      }
      other = isJoined ? parts.erase(other) : other + 1;
    }
    parts.push_back(part);
  }
  std::vector<AttachedPart> result;
  for (const auto& [nodes, anchors] : parts)
  {
    result.push_back({ { nodes.begin(), nodes.end() }, { anchors.begin(), anchors.end() } });
  }
  return result;
}

std::pair<double, Eigen::RowVector3d> planeOf(const morph::Points& nodes)
{
  const morph::Points fromMiddle = nodes.rowwise() - nodes.colwise().mean();
  const double scale = fromMiddle.cwiseAbs().maxCoeff(); // squares of it may be no numbers
  if (!(scale > 0) || !std::isfinite(scale))
  {
    return { 0, Row::Zero() };
  }
  const morph::Points unit = fromMiddle / scale;
  const Eigen::Matrix3d squares = unit.transpose() * unit;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares); // the least comes first
  const Row normal = axes.eigenvectors().col(0).transpose();
  return { scale * (unit * normal.transpose()).cwiseAbs().maxCoeff(), normal };
}

double meshSize(const Mesh& mesh, const std::vector<Index>& nodes)
{
  if (nodes.empty())
  {
    return 0;
  }
  Eigen::AlignedBox3d box;
  for (const Index n : nodes)
  {
    box.extend(mesh.points.row(n).transpose());
  }
  // Halves: the box of a huge mesh may be wider than the largest number.
  return 2 * (box.max() / 2 - box.min() / 2).stableNorm();
}

double Known::gap(const morph::Points& points) const
{
  double most = 0;
  for (const auto& own : this->hanging)
  {
    Row off = points.row(own.node);
    for (std::size_t k = 0; k < own.masters.size(); ++k)
    {
      off -= own.weights[k] * points.row(own.masters[k]);
    }
    most = std::max(most, off.norm());
  }
  return most;
}

double Known::parted(const morph::Points& rest, const morph::Points& moved) const
{
  double most = 0;
  for (const auto& [node, image] : this->images)
  {
    const Row step = moved.row(node) - rest.row(node);
    most = std::max(most, (moved.row(image) - rest.row(image) - step).norm());
  }
  return most;
}

double Known::offPlane(const morph::Points& rest, const morph::Points& moved) const
{
  if (this->plane.empty())
  {
    return 0;
  }
  const morph::Points nodes = rest(this->plane, morph::allColumns);
  const morph::Points steps = moved(this->plane, morph::allColumns) - nodes;
  return (steps * planeOf(nodes).second.transpose()).cwiseAbs().maxCoeff();
}

Mesh randomMesh(Choices& choices, Known& known)
{
  Mesh mesh = lattice(choices, known);
  const bool hostile = choices.chance("hostile.mesh", known.isAny() ? 0 : 0.17);
  changeCells(choices, mesh, hostile, known.isAny(), known.faces != Known::None);
  jitter(choices, mesh, hostile, known);
  addTwin(choices, mesh, known);
  place(choices, mesh, hostile);
  spoilPoints(choices, mesh, hostile, known);
  return mesh;
}
}
