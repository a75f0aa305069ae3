// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/CondensedSolver.h"
#include "Support/Error.h"

#include <Eigen/SparseCholesky>

#include <gtest/gtest.h>

#include <random>

using namespace meshes;
using namespace morph;

namespace
{
constexpr int Side = 6, Nodes = Side * Side, Cells = (Side - 1) * (Side - 1);

/// A square lattice with diagonals, and in each of its squares a centre, which couples the four
/// corners: random springs, and the lattice's first node held.
CsrMatrix lattice(bool hasSingularCentre = false)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> stiffness(0.5, 2);
  std::vector<Eigen::Triplet<double>> entries = { { 0, 0, 1. } };
  const auto spring = [&](int a, int b)
  {
    const double k = stiffness(random);
    entries.insert(entries.end(), { { a, a, k }, { b, b, k }, { a, b, -k }, { b, a, -k } });
  };
  for (int i = 0; i + 1 < Side; ++i)
  {
    for (int j = 0; j + 1 < Side; ++j)
    {
      const int corners[] = { i * Side + j, i * Side + j + 1, (i + 1) * Side + j + 1,
        (i + 1) * Side + j };
      const int centre = Nodes + i * (Side - 1) + j;
      for (int k = 0; k < 4; ++k)
      {
        spring(corners[k], corners[(k + 1) % 4]);
        if (!hasSingularCentre || centre != Nodes + 3)
        {
          spring(centre, corners[k]);
        }
      }
    }
  }
  if (hasSingularCentre)
  {
    entries.emplace_back(Nodes + 3, Nodes + 3, 0.);
  }
  CsrMatrix matrix(Nodes + Cells, Nodes + Cells);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<bool> centres()
{
  std::vector<bool> removable(Nodes + Cells, false);
  std::fill(removable.begin() + Nodes, removable.end(), true);
  return removable;
}
}

TEST(CondensedSolver, AgreesWithADirectSolver)
{
  CsrMatrix matrix = lattice();
  const Eigen::SparseMatrix<double> copy = matrix;
  const Points b = Points::Random(matrix.rows(), 3);
  ThreadedMonitor monitor(2);
  CondensedSolver solver;
  solver.prepare(matrix, centres(), Points::Random(copy.rows(), 3), monitor);
  const Eigen::MatrixXd rest = solver.remaining().matrix();
  EXPECT_EQ(rest.rows(), Nodes);
  EXPECT_EQ((rest - rest.transpose()).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(solver.components().count, 1);

  const Points expected = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(copy).solve(b);
  Points x = Points::Zero(copy.rows(), 3);
  solver.solve(b, x, 1e-12, 500, monitor);
  EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
}

TEST(CondensedSolver, RowsThatAreNotRemovableStay)
{
  CsrMatrix matrix = lattice();
  ThreadedMonitor monitor;
  CondensedSolver solver;
  solver.prepare(
    matrix, std::vector<bool>(Nodes + Cells, false), Points::Random(Nodes + Cells, 3), monitor);
  EXPECT_EQ(solver.remaining().matrix().rows(), Nodes + Cells);
}

TEST(CondensedSolver, SingularRowsAreThoseOfTheWholeMatrix)
{
  CsrMatrix matrix = lattice(true);
  ThreadedMonitor monitor;
  CondensedSolver solver;
  try
  {
    solver.prepare(matrix, centres(), Points::Random(Nodes + Cells, 3), monitor);
    ADD_FAILURE() << "no error";
  }
  catch (const SingularRows& error)
  {
    EXPECT_EQ(error.rows(), std::vector<std::int64_t>{ Nodes + 3 });
  }
}
