// SPDX-License-Identifier: BSD-3-Clause
#include "RandomMeshes.h"

#include "Meshes.h"

namespace meshes
{
morph::Points noise(morph::Index rows, double amount, std::mt19937& random)
{
  std::uniform_real_distribution<double> one(-1, 1);
  morph::Points result(rows, 3);
  for (morph::Index i = 0; i < rows; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      result(i, j) = amount * one(random);
    }
  }
  return result;
}

morph::Mesh randomMesh(const std::string& kind, int number, std::mt19937& random)
{
  morph::Mesh mesh = kind == "hexes"             ? hexes(2, 1, 1)
                     : kind == "tets"            ? tets(1, 1, 1)
                     : kind == "wedges"          ? wedges(1, 1, 1)
                     : kind == "quadratic hexes" ? quadraticHexes(1, 1, 1, number % 2)
                     : kind == "quadratic tets"  ? quadraticTets(1, 1, 1)
                                                 : hexesAndPyramids(2, 1, 1);
  mesh.points += noise(mesh.points.rows(), kind.find("quadratic") == 0 ? .03 : .1, random);
  if (number % 3 == 0)
  {
    mesh.points.col(1) *= -1;
  }
  return mesh;
}
}
