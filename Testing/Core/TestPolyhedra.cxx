// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Polyhedra.h"

#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace meshes;
using namespace morph;

namespace
{
/// The faces as sets of edges with their direction.
std::multiset<std::set<std::pair<Index, Index>>> directedFaces(const BoundaryFaces& faces)
{
  std::multiset<std::set<std::pair<Index, Index>>> result;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    std::set<std::pair<Index, Index>> edges;
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    for (Index k = 0; k < size; ++k)
    {
      edges.insert({ faces.connectivity[faces.offsets[f] + k],
        faces.connectivity[faces.offsets[f] + (k + 1) % size] });
    }
    result.insert(edges);
  }
  return result;
}

/// The message of the error that validate() throws; empty if it throws none.
std::string flawOf(const Mesh& mesh)
{
  try
  {
    validate(mesh);
    return {};
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

/// Two hexahedra; the faces of the second, a polyhedron, are these.
Mesh withFaces(const std::vector<std::vector<Index>>& faces)
{
  const Mesh hexahedra = meshes::hexes(2, 1, 1);
  Mesh mesh;
  mesh.points = hexahedra.points;
  add(mesh, Hexahedron, { hexahedra.cell(0), hexahedra.cell(0) + 8 });
  addPolyhedron(mesh, faces);
  return mesh;
}

/// The faces of the second hexahedron of hexes(2, 1, 1).
std::vector<std::vector<Index>> goodFaces()
{
  return { { 1, 7, 10, 4 }, { 2, 5, 11, 8 }, { 1, 2, 8, 7 }, { 4, 10, 11, 5 }, { 1, 4, 5, 2 },
    { 7, 8, 11, 10 } };
}
}

TEST(Polyhedra, OuterFacesAreThoseOfTheStandardCells)
{
  Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(3, 3, 3))
  {
    if (cellShape(mesh.types[0])->numberOfNodes != cellShape(mesh.types[0])->numberOfCorners)
    {
      continue; // quadratic
    }
    const BoundaryFaces expected = boundaryFaces(mesh, monitor);
    for (const auto& chosen : { std::function<bool(Index)>(),
           std::function<bool(Index)>([](Index cell) { return cell % 3 == 1; }) })
    {
      const Mesh polyhedra = asPolyhedra(mesh, chosen);
      EXPECT_EQ(flawOf(polyhedra), "");
      const BoundaryFaces faces = boundaryFaces(polyhedra, monitor);
      EXPECT_EQ(faces.nodes, expected.nodes) << name;
      EXPECT_EQ(faces.cells, expected.cells) << name;
      EXPECT_EQ(directedFaces(faces), directedFaces(expected)) << name;
      EXPECT_EQ(connectedComponents(polyhedra).ofNode, connectedComponents(mesh).ofNode);
      EXPECT_EQ(partitionNodes(polyhedra, { 0, 1 }).free, partitionNodes(mesh, { 0, 1 }).free);
      EXPECT_EQ(nodeToCells(polyhedra).values, nodeToCells(mesh).values);
    }
  }
}

TEST(Polyhedra, HexagonsAndFacesOfFiveNodesAreOuterFaces)
{
  Monitor monitor;
  const BoundaryFaces comb = boundaryFaces(honeycomb(2), monitor);
  EXPECT_EQ(std::count(comb.cells.begin(), comb.cells.end(), 0), 2 + 6 - 3);
  const Mesh layer = refinedLayer(1);
  EXPECT_EQ(flawOf(layer), "");
  const BoundaryFaces outer = boundaryFaces(layer, monitor);
  EXPECT_EQ(std::count(outer.cells.begin(), outer.cells.end(), 0), 5) << "its top is inside";
}

TEST(Polyhedra, VolumeIsThatOfTheBoxAndSigned)
{
  Mesh layer = refinedLayer(1);
  EXPECT_NEAR(polyhedronVolume(layer, 0, layer.points), 8, 1e-14);
  Mesh comb = honeycomb(2);
  comb.points.col(1) *= -1;
  EXPECT_NEAR(polyhedronVolume(comb, 3, comb.points), -1.5 * std::sqrt(3.), 1e-14);
  EXPECT_EQ(cellSigns(comb, connectedComponents(comb)), std::vector<std::int8_t>(8, -1));
  // One cell that is inverted among valid neighbors stays so, and so does a single one.
  layer.points.col(1) *= -1;
  EXPECT_EQ(cellSigns(layer, connectedComponents(layer)).front(), 1);
}

TEST(Polyhedra, FacesInAnyDirectionAreTurnedAlike)
{
  std::mt19937 random(seed());
  for (const auto& [name, mesh] : polyhedral())
  {
    Mesh turned = mesh;
    for (Index at = 0; at < static_cast<Index>(turned.faces.size()); at += turned.faces[at] + 1)
    {
      if (random() % 2 == 1)
      {
        std::reverse(
          turned.faces.begin() + at + 1, turned.faces.begin() + at + 1 + turned.faces[at]);
      }
    }
    ASSERT_EQ(flawOf(turned), "") << name;
    orientPolyhedra(turned);
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (isPolyhedron(mesh, c))
      {
        // A cell whose faces all happened to be turned is a consistent one, inside out.
        EXPECT_NEAR(std::abs(polyhedronVolume(turned, c, turned.points)),
          polyhedronVolume(mesh, c, mesh.points), 1e-12)
          << name << " cell " << c;
      }
    }
    Mesh again = mesh;
    orientPolyhedra(again);
    EXPECT_EQ(again.faces, mesh.faces) << name;
  }
}

TEST(Polyhedra, HostileFacesAreNamedByTheirCell)
{
  EXPECT_EQ(flawOf(withFaces(goodFaces())), "");
  const auto expect = [](const Mesh& mesh, const std::string& words)
  {
    const std::string flaw = flawOf(mesh);
    EXPECT_NE(flaw.find(words), std::string::npos) << flaw;
    EXPECT_NE(flaw.find("cell ids 1"), std::string::npos) << flaw;
  };
  auto faces = goodFaces();
  faces.pop_back();
  expect(withFaces(faces), "not closed");
  faces = goodFaces();
  faces.push_back(faces.front());
  expect(withFaces(faces), "not closed");
  faces = goodFaces();
  faces[0] = { 1, 7 };
  expect(withFaces(faces), "fewer than three nodes");
  faces = goodFaces();
  faces[0] = { 1, 7, 10, 7 };
  expect(withFaces(faces), "a node twice");
  expect(withFaces({ { 1, 2, 8, 7 }, { 7, 8, 2, 1 } }), "fewer than four faces");
  expect(withFaces({}), "fewer than four faces");
  // Two tetrahedra without a common node, and a sphere pinched together at an edge.
  expect(withFaces({ { 0, 1, 3 }, { 0, 3, 6 }, { 0, 6, 1 }, { 1, 6, 3 }, { 2, 4, 5 }, { 2, 5, 8 },
           { 2, 8, 4 }, { 4, 8, 5 } }),
    "not closed");
  expect(withFaces({ { 0, 1, 3 }, { 0, 3, 6 }, { 0, 6, 1 }, { 1, 6, 3 }, { 0, 1, 5 }, { 0, 5, 8 },
           { 0, 8, 1 }, { 1, 8, 5 } }),
    "not closed");

  Mesh mesh = withFaces(goodFaces());
  mesh.connectivity.back() = 12;
  EXPECT_NE(flawOf(mesh).find("outside 0 to 11"), std::string::npos) << flawOf(mesh);
  mesh = withFaces(goodFaces());
  mesh.faces[3] = 99; // a node that the cell does not have
  expect(mesh, "other nodes");
  mesh = withFaces(goodFaces());
  mesh.faces[0] = 40;
  expect(mesh, "do not add up");
  mesh = withFaces(goodFaces());
  mesh.faceOffsets.clear();
  expect(mesh, "no faces");
  mesh = withFaces(goodFaces());
  mesh.faceOffsets.back() += 7;
  EXPECT_NE(flawOf(mesh).find("do not match"), std::string::npos) << flawOf(mesh);
}
