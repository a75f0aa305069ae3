// SPDX-License-Identifier: BSD-3-Clause
#include "MeshKinds.h"

#include "Octree.h"
#include "PolyhedralMeshes.h"

#include <ostream>

namespace meshes
{
using namespace morph;

std::ostream& operator<<(std::ostream& stream, const Kind& kind)
{
  return stream << kind.name;
}

namespace
{
/// Tetrahedra that are hexahedra I J K K M M M M.
Mesh asHexahedra(const Mesh& tets)
{
  Mesh mesh;
  mesh.points = tets.points;
  for (Index c = 0; c < tets.numberOfCells(); ++c)
  {
    const Index* n = tets.cell(c);
    mesh.add(Hexahedron, { n[0], n[1], n[2], n[2], n[3], n[3], n[3], n[3] });
  }
  return mesh;
}

/// A box with a beam that stands on its top.
Mesh withBeam()
{
  Mesh mesh = hexes(3, 3, 3);
  const Index tip = mesh.numberOfNodes();
  mesh.points.conservativeResize(tip + 1, 3);
  mesh.points.row(tip) << 1, 1, 4;
  mesh.add(Line, { 53, tip }); // from (1, 1, 3)
  return mesh;
}
}

std::vector<Kind> kinds()
{
  const Mesh tet = tets(3, 3, 3), hex = hexes(3, 3, 3), wedge = wedges(3, 3, 3);
  const auto between = [](const Mesh& mesh, std::uint8_t type, Index nodes) {
    return withNodesBetween(mesh, { { mesh.types[0], { type, nodes } } });
  };
  return { { "TetrahedraAsHexahedra", asHexahedra(tet) },
    { "SevenCorners", collapsed({ Hexahedron, 8 }) },
    { "SevenCornersOf20", collapsed({ QuadraticHexahedron, 20 }) },
    { "SevenCornersOf27", collapsed({ TriquadraticHexahedron, 27 }) },
    { "AttachedBeam", withBeam(), 1 }, { "OneLayer", hexes(3, 3, 1) },
    { "Octree", Octree(5, 1).mesh }, { "QuadraticOctree", Octree(5, 2).mesh },
    { "Hexahedra20", between(hex, QuadraticHexahedron, 20) },
    { "Hexahedra27", between(hex, TriquadraticHexahedron, 27) },
    { "Wedges18", between(wedge, BiquadraticQuadraticWedge, 18) },
    { "Tetrahedra10", between(tet, QuadraticTetra, 10) },
    { "Tetrahedra15", between(tet, LagrangeTetrahedron, 15) },
    { "Lagrange", between(hex, LagrangeHexahedron, 64) },
    { "Bezier", between(wedge, BezierWedge, 18) } };
}
}
