// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

/// Meshes for the tests of the core, all on the box [0, nx] x [0, ny] x [0, nz].
namespace meshes
{
using morph::Index;
using morph::Mesh;
using morph::Points;

/// Adds one cell to a mesh.
void add(Mesh& mesh, std::uint8_t type, const std::vector<Index>& nodes);
/// (nx + 1)(ny + 1)(nz + 1) lattice points, x fastest, and one hexahedron a box.
Mesh hexes(int nx, int ny, int nz);
/// Each box in five tets, alternating so that they conform.
Mesh tets(int nx, int ny, int nz);
/// Each box in two wedges.
Mesh wedges(int nx, int ny, int nz);
/// A checkerboard of hexahedra and of boxes cut into six pyramids round their center; pyramids with
/// their base on the outside are cut into two tets.
Mesh hexesAndPyramids(int nx, int ny, int nz);
/// Hexahedra below, wedges above.
Mesh hexesAndWedges(int nx, int ny, int nz);
/// hexes() with mid-side, face and body nodes as asked: quadratic (20) or triquadratic (27).
Mesh quadraticHexes(int nx, int ny, int nz, bool triquadratic);
/// tets() with mid-side nodes.
Mesh quadraticTets(int nx, int ny, int nz);

/// A cell type, and its number of nodes.
struct CellKind
{
  std::uint8_t type;
  Index nodes;
};
/// The linear cells with the nodes between their corners that other types have, which cells share.
/// `kinds`: by linear types; others stay.
Mesh withNodesBetween(const Mesh& linear, const std::map<std::uint8_t, CellKind>& kinds);

/// All of the above at one size, with a name for the message.
std::vector<std::pair<std::string, Mesh>> all(int nx, int ny, int nz);

/// [0, 1]^3: n x n columns of layers, which grow upwards from the height `first`. `box`: hexes,
/// tets, ... above.
Mesh layered(Mesh (*box)(int, int, int), int n, double first, double growth);

/// Hexahedra whose last row of nodes along y, that of y = `around`, is the first one. `open`:
/// hexes(); `place`: where its nodes go.
Mesh closedAlongY(const Mesh& open, int around,
  const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& place);
/// The ring 1 <= r <= 2, `height` layers over 0 <= z <= 0.8, in hexahedra that grow outwards by 1.2
/// from the length `first`.
Mesh ring(int around, int height, double first);

/// Moves the nodes that are not on the box by up to `amount` in each coordinate.
void jitterInterior(Mesh& mesh, double amount, unsigned seed);
/// Applies `map` to every node.
void transform(Mesh& mesh, const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& map);
/// The mesh moved by `by`.
Mesh shifted(Mesh mesh, const Eigen::RowVector3d& by);
/// The same mesh with node i renamed to order[i].
Mesh renumbered(const Mesh& mesh, const std::vector<Index>& order);

/// Rows of `all` at `ids`.
Points rows(const Points& all, const std::vector<Index>& ids);
/// Diagonal of the bounding box.
double size(const Points& points);

/// The seed of random inputs: fixed, or MORPH_TEST_SEED; printed by the first call.
unsigned seed();
/// n x 3, from -1 to 1.
Points randomPoints(Index n, std::mt19937& random);

/// Threads without VTK; counts warnings; can cancel.
struct ThreadedMonitor : morph::Monitor
{
  explicit ThreadedMonitor(int threads = 1);
  int threads() const override { return this->count; }
  void progress(double fraction) override;
  bool cancelled() override;
  void warn(const std::string& message) override;
  void share(Index n, Index grain, const std::function<void(Index, Index)>& body) override;

  int count;           ///< of the threads
  double cancelAt = 2; ///< cancels once progress has come this far
  double lastProgress = 0;
  std::vector<std::string> warnings;
};
}
