// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP with and without its centers eliminated.
#include "LinearMethods/CenterStars.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>

using namespace meshes;
using namespace morph;

namespace
{
/// A mesh cut to pieces, its boundary prescribed, and FEMWARP on them.
struct Cut
{
  explicit Cut(const Mesh& whole)
    : pieces(whole, monitor, true)
    , partition(pieces.extend(motions::outerPartition(whole)))
    , firstCenter(whole.numberOfNodes())
  {
  }

  std::unique_ptr<FemWarp> prepared(bool eliminates, CellStiffness stiffness = {})
  {
    auto method = std::make_unique<FemWarp>();
    method->setTolerance(1e-13);
    if (eliminates)
    {
      method->setFirstCenter(this->firstCenter);
    }
    method->setStiffness(std::move(stiffness));
    method->prepare(this->pieces.mesh(), this->partition, this->monitor);
    return method;
  }

  ThreadedMonitor monitor{ 2 };
  PolyhedronPieces pieces;
  NodePartition partition;
  Index firstCenter;
};

std::vector<std::pair<std::string, Mesh>> wholeMeshes()
{
  std::vector<std::pair<std::string, Mesh>> result = polyhedral();
  result.emplace_back("cut brick", asPolyhedra(hexes(4, 4, 4)));
  return result;
}

double largest(const Eigen::Ref<const Eigen::MatrixXd>& values)
{
  return values.cwiseAbs().maxCoeff();
}
}

TEST(CenterStars, ShareNoCellAndAreSmall)
{
  for (const auto& [name, whole] : wholeMeshes())
  {
    SCOPED_TRACE(name);
    Cut cut(whole);
    const Mesh& mesh = cut.pieces.mesh();
    const Adjacency around = nodeToCells(mesh);
    const CenterStars stars(mesh, cut.partition.free, cut.firstCenter, around);
    ASSERT_GT(stars.size(), 0);
    EXPECT_TRUE(std::is_sorted(stars.centers().begin(), stars.centers().end()));
    std::set<Index> taken;
    for (Index s = 0; s < stars.size(); ++s)
    {
      EXPECT_GE(stars.center(s), cut.firstCenter);
      std::set<Index> nodes;
      for (const Index* c = around.begin(stars.center(s)); c != around.end(stars.center(s)); ++c)
      {
        EXPECT_TRUE(taken.insert(*c).second) << "cell " << *c;
        EXPECT_EQ(stars.ofCell()[*c], s);
        nodes.insert(mesh.cell(*c), mesh.cell(*c) + mesh.cellSize(*c));
      }
      EXPECT_EQ(nodes.erase(stars.center(s)), 1u);
      EXPECT_TRUE(
        std::equal(nodes.begin(), nodes.end(), stars.nodes().begin(s), stars.nodes().end(s)));
      EXPECT_LE(nodes.size(), 16u);
    }
    EXPECT_EQ(std::count_if(
                stars.ofCell().begin(), stars.ofCell().end(), [](int star) { return star >= 0; }),
      static_cast<std::ptrdiff_t>(taken.size()));
  }
}

TEST(CenterStars, AreTheSolutionWithCenters)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(0.5, 2);
  for (const auto& [name, whole] : wholeMeshes())
  {
    SCOPED_TRACE(name);
    Cut cut(whole);
    const auto kept = cut.prepared(false), gone = cut.prepared(true);
    EXPECT_LT(gone->rows().size(), kept->rows().size());
    const Eigen::MatrixXd matrix = gone->solver().matrix();
    EXPECT_EQ(largest(matrix - matrix.transpose()), 0);

    FourFields given(static_cast<Index>(cut.partition.prescribed.size()), 4);
    given = given.unaryExpr([&](double) { return number(random); });
    const FourFields expected = kept->fields(given, cut.monitor);
    EXPECT_LT(largest(gone->fields(given, cut.monitor) - expected), 1e-11);

    Points gradient(cut.pieces.mesh().numberOfNodes(), 3), one, other;
    gradient = gradient.unaryExpr([&](double) { return number(random) - 1; });
    kept->applyTranspose(gradient, one, cut.monitor);
    gone->applyTranspose(gradient, other, cut.monitor);
    EXPECT_LT(largest(one - other), 1e-11 * largest(one));
  }
}

TEST(CenterStars, StayWhereTheStiffnessVaries)
{
  Cut cut(honeycomb(3));
  CellStiffness graded;
  graded.kind = CellStiffness::Kind::InverseVolume;
  EXPECT_EQ(cut.prepared(true, graded)->rows().size(), cut.partition.free.size());
}

TEST(CenterStars, OneCellWhoseNodesAreAllPrescribed)
{
  Cut cut(asPolyhedra(hexes(1, 1, 1)));
  ASSERT_EQ(cut.partition.free.size(), 1u);
  const auto method = cut.prepared(true);
  EXPECT_EQ(method->rows().size(), 1u); // a matrix needs a row
  Points target(static_cast<Index>(cut.partition.prescribed.size()), 3), moved;
  for (Index i = 0; i < target.rows(); ++i)
  {
    target.row(i) = 2 * cut.pieces.mesh().points.row(cut.partition.prescribed[i]);
  }
  method->evaluate(target, moved, cut.monitor);
  EXPECT_LT(largest(moved - 2 * cut.pieces.mesh().points), 1e-13);
  Points gradient = Points::Zero(moved.rows(), 3), given;
  gradient.row(cut.partition.free[0]).setOnes();
  method->applyTranspose(gradient, given, cut.monitor);
  EXPECT_LT(largest(given.colwise().sum() - Eigen::RowVector3d::Ones()), 1e-13);
}

TEST(CenterStars, ACenterWithoutVolumeIsNamed)
{
  Cut cut(honeycomb(3));
  Mesh mesh = cut.pieces.mesh();
  const CenterStars stars(mesh, cut.partition.free, cut.firstCenter, nodeToCells(mesh));
  const Index star = stars.size() / 2;
  for (const Index* n = stars.nodes().begin(star); n != stars.nodes().end(star); ++n)
  {
    mesh.points.row(*n) = mesh.points.row(stars.center(star));
  }
  FemWarp method;
  method.setFirstCenter(cut.firstCenter);
  try
  {
    method.prepare(mesh, cut.partition, cut.monitor);
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.kind(), Error::Kind::Singular);
    EXPECT_NE(std::string(error.what()).find(std::to_string(stars.center(star))), std::string::npos)
      << error.what();
  }
}
