// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/ElementStiffness.h"

#include "Geometry/NearestNodes.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double LeastRatio = 1e-10;   // to the stiffest cell; beyond it the solver loses digits
constexpr double LeastDistance = 1e-3; // of the mean one
constexpr double LeastVolume = 1e-12;  // of the mean one: a flat cell has a finite stiffness

/// Returns for each volume cell value(cell), and 0 for the others.
template <typename Value>
std::vector<double> ofCells(const Mesh& mesh, Monitor& monitor, const Value& value)
{
  std::vector<double> result(mesh.numberOfCells(), 0);
  parallel(mesh.numberOfCells(), Grain, monitor,
    [&](Index c)
    {
      if (hasCorners(mesh, c))
      {
        result[c] = value(c);
      }
    });
  return result;
}

std::vector<double> volumes(const Mesh& mesh, Monitor& monitor)
{
  return ofCells(mesh, monitor,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh, c);
      double corners[8][3];
      copyCorners(mesh, c, shape, mesh.points, corners[0]);
      return std::abs(signedVolume(shape.shape, corners));
    });
}

std::vector<double> wallDistances(const Mesh& mesh, const Points& walls, Monitor& monitor)
{
  const NearestNodes nearest(walls);
  return ofCells(mesh, monitor,
    [&](Index c)
    {
      const CellShape& shape = *cellShape(mesh, c);
      double corners[8][3] = {};
      copyCorners(mesh, c, shape, mesh.points, corners[0]);
      return nearest.distance(
        Eigen::Map<const Points>(corners[0], shape.numberOfCorners, 3).colwise().mean());
    });
}

/// Returns 1 / value^exponent; values below `least` of the mean count as this.
std::vector<double> inversePower(const Mesh& mesh, std::vector<double> value, double exponent,
  double least, const Communicator& processes)
{
  double sum = 0, count = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!processes.isCopy(c))
    {
      sum += value[c];
      count += hasCorners(mesh, c);
    }
  }
  sum = processes.sum(sum);
  count = processes.sum(count);
  const double floor = count > 0 ? least * sum / count : 0;
  for (double& v : value)
  {
    v = floor > 0 ? std::pow(std::max(v, floor), -exponent) : 1;
  }
  return value;
}

void requireExponent(double exponent)
{
  if (!(exponent >= 0 && exponent <= 4))
  {
    throw Error(
      "The exponent of the stiffness must lie in [0, 4]; it is " + std::to_string(exponent) + ".");
  }
}

/// The positions of the walls of all processes.
Points wallsOf(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, const Communicator& processes)
{
  const bool isNamed = !processes.all(stiffness.walls.empty());
  if (!isNamed && !stiffness.noWalls.empty())
  {
    throw Error(stiffness.noWalls);
  }
  std::vector<Index> walls = isNamed ? stiffness.walls : prescribed, wrong;
  if (isNamed && stiffness.areWallsGlobal)
  {
    walls = processes.nodesOf(walls); // the boundary may be on another process than its nodes
  }
  std::copy_if(walls.begin(), walls.end(), std::back_inserter(wrong),
    [&](Index node) { return node < 0 || node >= mesh.numberOfNodes(); });
  if (!wrong.empty())
  {
    throw Error("The walls of the stiffness name nodes that do not exist: ids " + listIds(wrong) +
                ". The mesh has nodes 0 to " + std::to_string(mesh.numberOfNodes() - 1) + ".");
  }
  return processes.gather(mesh.points, walls);
}

void requireValues(
  const Mesh& mesh, const std::vector<double>& values, const Communicator& processes)
{
  if (static_cast<Index>(values.size()) != mesh.numberOfCells())
  {
    throw Error("The stiffness has " + std::to_string(values.size()) + " values; the mesh has " +
                std::to_string(mesh.numberOfCells()) + " cells.");
  }
  std::vector<Index> wrong;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (hasCorners(mesh, c) && !(values[c] > 0 && std::isfinite(values[c])))
    {
      wrong.push_back(c);
    }
  }
  wrong = processes.gatherCells(wrong);
  if (!wrong.empty())
  {
    throw Error("The stiffness is not positive and finite at cell ids " + listIds(wrong) +
                ". Give each volume cell a positive number.");
  }
}

/// Divides by the largest of the volume cells, and limits the ratios.
void normalize(const Mesh& mesh, const Communicator& processes, std::vector<double>& factors)
{
  double largest = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    largest = hasCorners(mesh, c) ? std::max(largest, factors[c]) : largest;
  }
  largest = processes.maximum(largest);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    factors[c] = hasCorners(mesh, c) ? std::max(factors[c] / largest, LeastRatio) : 1;
  }
}
}

std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor, const Communicator& processes)
{
  const bool hasValues = !processes.all(stiffness.values.empty());
  if (stiffness.kind == CellStiffness::Kind::Uniform && !hasValues)
  {
    return {};
  }
  requireExponent(stiffness.exponent);
  std::vector<double> factors(mesh.numberOfCells(), 1);
  if (stiffness.kind == CellStiffness::Kind::InverseVolume)
  {
    factors =
      inversePower(mesh, volumes(mesh, monitor), stiffness.exponent, LeastVolume, processes);
  }
  else if (stiffness.kind == CellStiffness::Kind::WallDistance)
  {
    const Points walls = wallsOf(mesh, prescribed, stiffness, processes);
    factors = inversePower(
      mesh, wallDistances(mesh, walls, monitor), stiffness.exponent, LeastDistance, processes);
  }
  if (hasValues)
  {
    std::vector<double> values = stiffness.values;
    processes.completeCells(values);
    requireValues(mesh, values, processes);
    std::transform(
      factors.begin(), factors.end(), values.begin(), factors.begin(), std::multiplies<>());
  }
  normalize(mesh, processes, factors);
  return factors;
}

namespace
{
using Vector = Eigen::Map<const Eigen::Vector3d>;

// A Jacobian determinant below this share of the product of its columns' lengths counts as zero.
constexpr double Vanishing = 1e-8;
// A cell without a usable volume gets at least this share of (largest face)^2 / size: stiff, but
// not singular.
constexpr double VolumeFloor = 1e-3;

double size(const double (*corners)[3], int n)
{
  Eigen::Vector3d low = Vector(corners[0]), high = low;
  for (int a = 1; a < n; ++a)
  {
    low = low.cwiseMin(Vector(corners[a]));
    high = high.cwiseMax(Vector(corners[a]));
  }
  return (high - low).norm();
}

/// Returns 0 if the determinant vanishes relative to the product of the columns' lengths.
int signOf(double determinant, double lengths)
{
  return determinant > Vanishing * lengths ? 1 : determinant < -Vanishing * lengths ? -1 : 0;
}

/// Computes doubled inward area vectors; grad N_a = normal_a / (6 volume). Returns 6 x volume, and
/// its sign, or 0, in `sign`.
double tetNormals(const double (*corners)[3], const int c[4], Eigen::Vector3d normal[4], int& sign)
{
  const Vector origin(corners[c[0]]);
  const Eigen::Vector3d e1 = Vector(corners[c[1]]) - origin, e2 = Vector(corners[c[2]]) - origin,
                        e3 = Vector(corners[c[3]]) - origin;
  normal[1] = e2.cross(e3);
  normal[2] = e3.cross(e1);
  normal[3] = e1.cross(e2);
  normal[0] = -(normal[1] + normal[2] + normal[3]);
  const double det = e1.dot(normal[1]);
  sign = signOf(det, e1.norm() * e2.norm() * e3.norm());
  return det;
}

/// Computes the stiffness by tetrahedra: for tets, pyramids, and cells that quadrature cannot
/// treat.
int simplicialStiffness(Shape shape, const double (*corners)[3], double* K)
{
  const int n = numberOfCorners(shape);
  const SimplicialDecomposition split = simplicialDecomposition(shape);
  int positive = 0, negative = 0;
  Eigen::Vector3d normals[12][4];
  double determinants[12];
  for (int t = 0; t < split.count; ++t)
  {
    int sign = 0;
    determinants[t] = tetNormals(corners, split.tets[t].corner, normals[t], sign);
    positive += sign > 0;
    negative += sign < 0;
  }
  const int sign = positive == split.count ? 1 : negative == split.count ? -1 : 0;
  const double extent = size(corners, n);

  std::fill(K, K + triangleSize(n), 0.);
  for (int t = 0; t < split.count; ++t)
  {
    double det = std::abs(determinants[t]);
    if (sign == 0)
    {
      double face2 = 0;
      for (const Eigen::Vector3d& normal : normals[t])
      {
        face2 = std::max(face2, normal.squaredNorm());
      }
      det = std::max(det, VolumeFloor * face2 / extent);
    }
    if (!(det > 0))
    {
      continue; // all corners are on one line
    }
    const int* c = split.tets[t].corner;
    const double factor = split.tets[t].weight / (6 * det);
    for (int i = 0; i < 4; ++i)
    {
      for (int j = i; j < 4; ++j)
      {
        K[triangleIndex(n, c[i], c[j])] += factor * normals[t][i].dot(normals[t][j]);
      }
    }
  }
  return sign;
}

/// Integrates at the eight Gauss points at once. grad N_a = C_a / det with C_a = cofactor(J) dN_a,
/// so K_ab = sum_q C_a . C_b / (8 det). Each column of J depends on only two of the parametric
/// coordinates.
int hexStiffness(const double (*x)[3], double* K)
{
  constexpr double P = 0.78867513459481288225; // (1 + 1/sqrt(3)) / 2
  constexpr double M = 0.21132486540518711775;
  constexpr double Share[2] = { P, M }; // weights of the near and far corner, or of far and near
  // Parametric gradients of the shape functions at the Gauss points q = u + 2 v + 4 w.
  static const auto gradients = []
  {
    std::array<std::array<std::array<double, 3>, 8>, 8> table;
    for (int q = 0; q < 8; ++q)
    {
      const double xi[3] = { q & 1 ? P : M, q & 2 ? P : M, q & 4 ? P : M };
      double N[8], dN[8][3];
      shapeFunctions(Shape::Hex, xi, N, dN);
      for (int n = 0; n < 8; ++n)
      {
        std::copy(dN[n], dN[n] + 3, table[q][n].begin());
      }
    }
    return table;
  }();

  // column[d][u + 2 v][j]: derivative along direction d at the Gauss points u, v of the other two.
  double column[3][4][3];
  for (int d = 0; d < 3; ++d)
  {
    double edge[4][3];
    for (int e = 0; e < 4; ++e)
    {
      for (int j = 0; j < 3; ++j)
      {
        edge[e][j] = x[HexAxisEdges[d][e][1]][j] - x[HexAxisEdges[d][e][0]][j];
      }
    }
    for (int u = 0; u < 2; ++u)
    {
      for (int v = 0; v < 2; ++v)
      {
        const double su = Share[u], tu = Share[1 - u], sv = Share[v], tv = Share[1 - v];
        for (int j = 0; j < 3; ++j)
        {
          column[d][u + 2 * v][j] =
            sv * (su * edge[0][j] + tu * edge[1][j]) + tv * (su * edge[2][j] + tu * edge[3][j]);
        }
      }
    }
  }

  int positive = 0, negative = 0;
  double C[8][24], CoverDet[8][24]; // per corner: 8 Gauss points x 3
  for (int q = 0; q < 8; ++q)
  {
    const int g[3] = { q & 1, (q >> 1) & 1, q >> 2 };
    const double* a = column[0][g[1] + 2 * g[2]];
    const double* b = column[1][g[0] + 2 * g[2]];
    const double* c = column[2][g[0] + 2 * g[1]];
    // Rows of the cofactor matrix: gradients of the parametric coordinates times the determinant.
    const double cof[3][3] = { { b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                                 b[0] * c[1] - b[1] * c[0] },
      { c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0] },
      { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
    const double det = a[0] * cof[0][0] + a[1] * cof[0][1] + a[2] * cof[0][2];
    const auto length2 = [](const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    const int signHere = signOf(det, std::sqrt(length2(a) * length2(b) * length2(c)));
    positive += signHere > 0;
    negative += signHere < 0;
    const double weight = 1 / (8 * std::abs(det));
    for (int n = 0; n < 8; ++n)
    {
      const double* dN = gradients[q][n].data();
      for (int j = 0; j < 3; ++j)
      {
        const double gradient = dN[0] * cof[0][j] + dN[1] * cof[1][j] + dN[2] * cof[2][j];
        C[n][3 * q + j] = gradient;
        CoverDet[n][3 * q + j] = weight * gradient;
      }
    }
  }
  const int sign = positive == 8 ? 1 : negative == 8 ? -1 : 0;
  if (sign == 0)
  {
    simplicialStiffness(Shape::Hex, x, K);
    return 0;
  }

  using Row = Eigen::Map<const Eigen::Matrix<double, 24, 1>>;
  for (int n = 0, k = 0; n < 8; ++n)
  {
    for (int m = n; m < 8; ++m, ++k)
    {
      K[k] = Row(C[n]).dot(Row(CoverDet[m]));
    }
  }
  return sign;
}

int wedgeStiffness(const double (*x)[3], double* K)
{
  constexpr double Triangle[3][2] = { { 1. / 6, 1. / 6 }, { 2. / 3, 1. / 6 }, { 1. / 6, 2. / 3 } };
  constexpr double Line[2] = { 0.21132486540518711775, 0.78867513459481288225 };
  Eigen::Matrix<double, 6, 3, Eigen::RowMajor> X =
    Eigen::Map<const Eigen::Matrix<double, 6, 3, Eigen::RowMajor>>(x[0]);
  X.rowwise() -= X.row(0).eval(); // far from the origin, rounding would exceed the cell's size
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  int positive = 0, negative = 0;
  for (const auto& at : Triangle)
  {
    for (double t : Line)
    {
      const double xi[3] = { at[0], at[1], t };
      double N[6], dN[6][3];
      shapeFunctions(Shape::Wedge, xi, N, dN);
      const Eigen::Map<const Eigen::Matrix<double, 6, 3, Eigen::RowMajor>> D(dN[0]);
      const Eigen::Matrix3d J = X.transpose() * D;
      const double det = J.determinant();
      const int signHere = signOf(det, J.colwise().norm().prod());
      positive += signHere > 0;
      negative += signHere < 0;
      Eigen::Matrix3d cofactor;
      cofactor.col(0) = J.col(1).cross(J.col(2));
      cofactor.col(1) = J.col(2).cross(J.col(0));
      cofactor.col(2) = J.col(0).cross(J.col(1));
      const Eigen::Matrix<double, 6, 3> C = D * cofactor.transpose();
      sum.noalias() += C * C.transpose() / (12 * std::abs(det));
    }
  }
  const int sign = positive == 6 ? 1 : negative == 6 ? -1 : 0;
  if (sign == 0)
  {
    simplicialStiffness(Shape::Wedge, x, K);
    return 0;
  }
  for (int a = 0, k = 0; a < 6; ++a)
  {
    for (int b = a; b < 6; ++b, ++k)
    {
      K[k] = sum(a, b);
    }
  }
  return sign;
}
}

int elementStiffness(Shape shape, const double (*corners)[3], double* K)
{
  switch (shape)
  {
    case Shape::Hex:
      return hexStiffness(corners, K);
    case Shape::Wedge:
      return wedgeStiffness(corners, K);
    default:
      return simplicialStiffness(shape, corners, K);
  }
}
}
