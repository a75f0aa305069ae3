// SPDX-License-Identifier: BSD-3-Clause
// The core without VTK: eight hexahedra in a cube whose outer nodes are stretched in x; prints
// where the inner node goes.
#include <MeshMorphing/LinearMethods/FemWarp.h>
#include <MeshMorphing/Mesh/Topology.h>
#include <MeshMorphing/Support/Error.h>

#include <iostream>

namespace
{
/// A unit cube of 2 x 2 x 2 hexahedra; node i + 3 j + 9 k lies at (i, j, k) / 2.
morph::Mesh cube()
{
  morph::Mesh mesh;
  mesh.points.resize(27, 3);
  for (int n = 0; n < 27; ++n)
  {
    mesh.points.row(n) << 0.5 * (n % 3), 0.5 * (n / 3 % 3), 0.5 * (n / 9);
  }
  for (int first : { 0, 1, 3, 4, 9, 10, 12, 13 })
  {
    for (int corner : { 0, 1, 4, 3, 9, 10, 13, 12 })
    {
      mesh.connectivity.push_back(first + corner);
    }
    mesh.types.push_back(12); // VTK_HEXAHEDRON
    mesh.offsets.push_back(static_cast<morph::Index>(mesh.connectivity.size()));
  }
  return mesh;
}
}

int main()
try
{
  const morph::Mesh mesh = cube();
  morph::Monitor monitor;
  std::vector<morph::Index> outer;
  for (morph::Index n = 0; n < 27; ++n)
  {
    if (n != 13)
    {
      outer.push_back(n);
    }
  }
  morph::FemWarp femWarp;
  femWarp.prepare(mesh, morph::partitionNodes(mesh, outer), monitor);

  morph::Points prescribed(26, 3), moved;
  for (std::size_t i = 0; i < outer.size(); ++i)
  {
    prescribed.row(i) = mesh.points.row(outer[i]);
  }
  prescribed.col(0) *= 1.5;
  femWarp.evaluate(prescribed, moved, monitor);
  std::cout << moved.row(13) << "\n";
  return 0;
}
catch (const morph::Error& error)
{
  std::cerr << error.what() << "\n";
  return 1;
}
