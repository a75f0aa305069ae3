// SPDX-License-Identifier: BSD-3-Clause
// Meshes far from the origin, compared with their size: every method works there to rounding.
#include "LinearMethods.h"
#include "Meshes.h"
#include "Motions.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace morph;
using motions::Row;

namespace
{
struct Method
{
  std::string name;
  std::function<std::unique_ptr<Morpher>()> make;
  double affineTolerance = 1e-10; ///< of the mesh's size
};

std::ostream& operator<<(std::ostream& stream, const Method& method)
{
  return stream << method.name;
}

std::vector<Method> methods()
{
  std::vector<Method> result;
  for (const meshes::LinearMethod& linear : meshes::linearMethods())
  {
    result.push_back({ linear.name, linear.make, 1e-10 });
  }
  result.push_back({ "Smoothing",
    []
    {
      auto method = std::make_unique<Smoothing>();
      SmoothingOptions options;
      options.target = SmoothingTarget::Initial;
      options.stopMove = 1e-12;
      method->setOptions(options);
      return method;
    },
    1e-4 }); // it ends where the mean measure hardly falls
  result.push_back({ "InversionFree",
    []
    {
      auto method = std::make_unique<InversionFree>();
      method->setSteps(InversionFree::NoSteps);
      method->setTolerance(1e-12);
      return method;
    },
    1e-10 });
  return result;
}

/// To a multiple of 2^-20: such coordinates of a few units are moved by up to 2^32 without
/// rounding.
double coarse(double x)
{
  return std::round(std::ldexp(x, 20)) / std::ldexp(1, 20);
}

Row coarse(const Row& x)
{
  return x.unaryExpr([](double value) { return coarse(value); });
}

std::vector<std::pair<std::string, Mesh>> coarseMeshes()
{
  std::vector<std::pair<std::string, Mesh>> result;
  for (auto [name, mesh] : motions::jittered())
  {
    if (name.find("uadratic") == std::string::npos)
    {
      meshes::transform(mesh, [](const Row& x) { return coarse(x); });
      result.emplace_back(name, mesh);
    }
  }
  return result;
}

struct Result
{
  Points moved;
  EvaluateReport report;
};

class FarFromOrigin : public testing::TestWithParam<std::tuple<Method, int>>
{
protected:
  /// 1e5 to 1e8 sizes away, on different sides of the coordinate planes.
  Row offset(const Mesh& mesh) const
  {
    const double sizes = std::pow(10., std::get<1>(GetParam()));
    return (sizes * meshes::size(mesh.points) * Row(1, -.5, .25)).array().round();
  }

  Result morphed(const Mesh& mesh, const Points& target) const
  {
    meshes::ThreadedMonitor monitor;
    const auto method = std::get<0>(GetParam()).make();
    method->prepare(mesh, motions::outerPartition(mesh), monitor);
    Result result;
    result.report = method->evaluate(target, result.moved, monitor);
    EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
    return result;
  }
};

/// What rounding makes of coordinates this far out, beside what holds everywhere.
double tolerance(const Points& points, double size, double relative = 1e-10)
{
  return relative * size +
         16 * std::numeric_limits<double>::epsilon() * points.cwiseAbs().maxCoeff();
}
}

TEST_P(FarFromOrigin, AffineMotionsComeOutToRounding)
{
  for (const auto& [name, near] : coarseMeshes())
  {
    SCOPED_TRACE(name);
    const Row by = this->offset(near);
    const Mesh far = meshes::shifted(near, by);
    const motions::Map map = [&](const Row& x) { return Row(motions::affine(x - by) + by); };
    const Points expected = motions::mapped(far.points, map);
    const Result result =
      this->morphed(far, motions::targets(far, motions::outerPartition(far), map));
    EXPECT_LT(motions::difference(result.moved, expected),
      tolerance(expected, meshes::size(near.points), std::get<0>(GetParam()).affineTolerance));
  }
}

TEST_P(FarFromOrigin, NoMotionIsTheIdentityBitForBit)
{
  for (const auto& [name, near] : coarseMeshes())
  {
    SCOPED_TRACE(name);
    const Mesh far = meshes::shifted(near, this->offset(near));
    const Result result =
      this->morphed(far, meshes::rows(far.points, motions::outerPartition(far).prescribed));
    EXPECT_TRUE(motions::identical(result.moved, far.points));
  }
}

TEST_P(FarFromOrigin, ResultsAreThoseAtTheOriginMoved)
{
  for (const auto& [name, near] : coarseMeshes())
  {
    SCOPED_TRACE(name);
    const Row by = this->offset(near);
    const Mesh far = meshes::shifted(near, by);
    const Points target = motions::targets(near, motions::outerPartition(near),
      [](const Row& x) { return coarse(motions::twist(x, 4, 4, .3)); });
    const Result expected = this->morphed(near, target);
    const Result result = this->morphed(far, target.rowwise() + by);
    EXPECT_LT(motions::difference(result.moved.rowwise() - by, expected.moved),
      tolerance(far.points, meshes::size(near.points)));
    // The meshless methods take the same ways: none falls back where rounding is all that changed.
    if (std::get<0>(GetParam()).name.rfind("Simplex", 0) == 0)
    {
      ASSERT_EQ(result.report.statistics.size(), expected.report.statistics.size());
      for (std::size_t i = 0; i < expected.report.statistics.size(); ++i)
      {
        EXPECT_EQ(result.report.statistics[i].value, expected.report.statistics[i].value)
          << expected.report.statistics[i].name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FarFromOrigin,
  testing::Combine(testing::ValuesIn(methods()), testing::Values(5, 6, 7, 8)),
  [](const testing::TestParamInfo<FarFromOrigin::ParamType>& info)
  { return std::get<0>(info.param).name + "1e" + std::to_string(std::get<1>(info.param)); });
