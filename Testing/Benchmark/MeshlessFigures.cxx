// SPDX-License-Identifier: BSD-3-Clause
#include "MeshlessFigures.h"

#include "CgalBaseline.h"
#include "FigureRun.h"
#include "RootRate.h"
#include "Threads.h"

#include "Geometry/SpatialOrder.h"
#include "Interpolation/InterpolationSites.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"

#include <algorithm>

namespace benchmark
{
namespace
{
constexpr int AxisX = 0;
constexpr int AxisZ = 2;
// Seconds of an absolute step on the canister's 136,462 nodes: Table 4 of Staten et al., IMR 2011,
// on two Intel X5570.
constexpr double PaperWeightedResidual = 74.86, PaperSimplexLinear = 0.83,
                 PaperNaturalNeighbor = 52.88;
constexpr double SibsonDifference = 1e-8; // of the mesh's size

class Run : public FigureRun
{
public:
  using FigureRun::FigureRun;

  void cube(const Problem& problem);
  void radialBasis(const Problem& problem);
  template <typename Method>
  void series(const std::string& name, const std::vector<Problem>& problems);

private:
  template <typename Method>
  void time(const Problem& problem, MethodTimes& times, morph::Points& moved) const
  {
    this->settleDown();
    timeConfigured<Method>(
      problem, [](Method&) {}, *makeMonitor(this->cores_), times, moved);
  }
  void addStreaming(
    const Problem& problem, const std::string& name, const MethodTimes& times, double paper);
  void againstSibson(const Problem& problem, const morph::InterpolationSites& sites,
    const CgalBaseline& cgal, const morph::Points& moved, double cold);
};

void Run::addStreaming(
  const Problem& problem, const std::string& name, const MethodTimes& times, double paper)
{
  const std::string tail = withThreads(this->cores_);
  this->add(problem, name + ": prepare" + tail, median(times.prepare), "s");
  this->add(problem, name + ": cold" + tail, median(times.cold), "s");
  this->add(problem, name + ": warm" + tail, median(times.warm), "s");
  if (!this->options_.quick)
  {
    this->add(
      problem, name + ": a step on the paper's canister, 136,462 nodes (its Table 4)", paper, "s");
  }
}

/// Two scales: 2,000 centers, and compact kernels on the other sites.
void Run::radialBasis(const Problem& problem)
{
  const std::string tail = withThreads(this->cores_);
  MethodTimes times;
  morph::Points moved;
  std::unique_ptr<morph::RadialBasis> method;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", radial basis, repetition " + std::to_string(i + 1));
    this->settleDown();
    method = timeConfigured<morph::RadialBasis>(
      problem, [&](morph::RadialBasis& m) { m.setNumberOfCenters(this->options_.quick ? 200 : 0); },
      *makeMonitor(this->cores_), times, moved);
  }
  const double nodes = static_cast<double>(problem.partition.free.size());
  const double pairs = nodes * static_cast<double>(method->centers());
  const double rate = measureRootRate(*makeMonitor(this->cores_));
  const auto sites = static_cast<double>(problem.partition.prescribed.size());
  const Target prepare = this->options_.quick ? Target::none() : Target::atMost(3);
  const Target warm = this->options_.quick ? Target::none() : Target::atMost(0.3);
  this->add(problem, "radial basis: centers", static_cast<double>(method->centers()), "");
  this->add(problem, "radial basis: prepare" + tail, median(times.prepare), "s", prepare);
  this->add(problem, "radial basis: warm" + tail, median(times.warm), "s", warm);
  this->add(problem, "radial basis: bytes of a matrix of sites by nodes", 8 * sites * nodes, "B");
  this->add(problem, "radial basis: kernels a second in a warm step, 17 operations each" + tail,
    pairs / median(times.warm), "1/s");
  this->add(problem, "the limit, square roots a second" + tail, rate, "1/s");
  this->add(problem, "radial basis: warm / one square root a center and free node",
    median(times.warm) * rate / pairs, "", Target::atMost(3));
}

/// On nodes spread evenly over the free ones.
void Run::againstSibson(const Problem& problem, const morph::InterpolationSites& sites,
  const CgalBaseline& cgal, const morph::Points& moved, double cold)
{
  say(problem.name + ", CGAL's Sibson coordinates");
  constexpr morph::Index Samples = 20;
  const std::vector<morph::Index>& free = problem.partition.free;
  const auto n = static_cast<morph::Index>(free.size());
  const morph::Points targets = sites.average(problem.target, *makeMonitor(this->cores_));
  double seconds = 0, difference = 0;
  for (morph::Index i = 0; i < Samples; ++i)
  {
    const morph::Index node = free[(2 * i + 1) * n / (2 * Samples)];
    const CgalBaseline::Sibson sibson = cgal.sibson(problem.mesh.points.row(node));
    seconds += sibson.seconds;
    Eigen::RowVector3d x = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < sibson.sites.size(); ++k)
    {
      x += sibson.weights[k] * targets.row(sibson.sites[k]);
    }
    difference = std::max(difference, (x - moved.row(node)).norm());
  }
  this->check(problem, "natural neighbor: difference from CGAL's, of the size",
    difference / problem.size, SibsonDifference);
  this->add(problem, "CGAL's Sibson coordinates of a node, 1 thread", seconds / Samples, "s");
  this->add(problem, "natural neighbor: cold a node" + withThreads(this->cores_),
    cold / static_cast<double>(n), "s");
  this->add(problem, "natural neighbor: CGAL's time a node / cold time a node",
    seconds / Samples * static_cast<double>(n) / cold, "", Target::atLeast(500));
}

void Run::cube(const Problem& problem)
{
  MethodTimes linear, natural, residual;
  morph::Points moved, movedByNatural;
  std::vector<double> delaunay, locate;
  const morph::InterpolationSites sites(problem.mesh.points, problem.partition.prescribed);
  const std::vector<morph::Index> order =
    morph::spatialOrder(problem.mesh.points, problem.partition.free);
  morph::Points places(static_cast<morph::Index>(order.size()), 3);
  for (morph::Index i = 0; i < places.rows(); ++i)
  {
    places.row(i) = problem.mesh.points.row(order[i]);
  }
  std::unique_ptr<CgalBaseline> cgal;
  for (int i = 0; i < this->options_.repeat; ++i)
  {
    say(problem.name + ", repetition " + std::to_string(i + 1));
    this->settleDown();
    cgal = std::make_unique<CgalBaseline>(sites.coordinates());
    delaunay.push_back(cgal->delaunaySeconds());
    locate.push_back(cgal->locate(places));
    this->time<morph::SimplexLinear>(problem, linear, moved);
    this->time<morph::WeightedResidual>(problem, residual, moved);
    if (i == 0) // as long as all the others
    {
      this->time<morph::SimplexNaturalNeighbor>(problem, natural, movedByNatural);
    }
  }
  this->add(problem, "CGAL's Delaunay tessellation, 1 thread", median(delaunay), "s");
  this->add(problem, "CGAL's point location, 1 thread", median(locate), "s");
  this->add(problem, "simplex-linear: cold / CGAL's tessellation and location",
    median(linear.cold) / (median(delaunay) + median(locate)), "", Target::atMost(1.5));
  this->add(problem, "weighted residual: cold / simplex-linear's cold",
    median(residual.cold) / median(linear.cold), "", Target::atMost(15));
  this->addStreaming(problem, "simplex-linear", linear, PaperSimplexLinear);
  this->addStreaming(problem, "weighted residual", residual, PaperWeightedResidual);
  this->addStreaming(problem, "natural neighbor", natural, PaperNaturalNeighbor);
  this->againstSibson(problem, sites, *cgal, movedByNatural, median(natural.cold));
}

template <typename Method>
void Run::series(const std::string& name, const std::vector<Problem>& problems)
{
  std::vector<MethodTimes> times(problems.size());
  const int repeat =
    std::is_same<Method, morph::SimplexNaturalNeighbor>::value ? 1 : this->options_.repeat;
  for (int i = 0; i < repeat; ++i)
  {
    say("series, " + name + ", repetition " + std::to_string(i + 1));
    for (std::size_t p = 0; p < problems.size(); ++p)
    {
      morph::Points moved;
      this->time<Method>(problems[p], times[p], moved);
    }
  }
  std::vector<double> nodes, cold;
  for (std::size_t p = 0; p < problems.size(); ++p)
  {
    nodes.push_back(static_cast<double>(problems[p].mesh.numberOfNodes()));
    cold.push_back(median(times[p].cold));
    this->add(problems[p], name + ": series, cold" + withThreads(this->cores_), cold.back(), "s");
  }
  this->add(problems.back(),
    name + ": exponent of cold time against nodes, series of " + std::to_string(problems.size()),
    logLogSlope(nodes, cold), "", Target::atMost(1.1));
}
}

Report measureMeshlessFigures(const Options& options, bool& correct)
{
  const int side = options.quick ? 12 : 50;
  const int across = options.quick ? 6 : 20;
  const int shortest = options.quick ? 18 : 60;
  const int longest = options.quick ? 42 : 260;
  const int step = options.quick ? 12 : 40;

  Run run(options);
  run.cube(twistedBrick(side, side, side, AxisZ));
  run.radialBasis(twistedBrick(side, side, side, AxisZ));
  std::vector<Problem> bricks;
  for (int length = shortest; length <= longest; length += step)
  {
    bricks.push_back(twistedBrick(length, across, across, AxisX));
  }
  run.series<morph::SimplexLinear>("simplex-linear", bricks);
  run.series<morph::WeightedResidual>("weighted residual", bricks);
  run.series<morph::SimplexNaturalNeighbor>("natural neighbor", bricks);
  correct = run.correct;
  return run.report;
}
}
