// SPDX-License-Identifier: BSD-3-Clause
// The extension module meshmorphing._core: arrays in, arrays out. Shapes, types and coordinates are
// checked in Python (Python/_arrays.py), ids here and in the core.
#include "Boundary/Classification.h"
#include "Boundary/FaceQuality.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/CellShape.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/NodePartition.h"
#include "Mesh/ShellLayer.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"
#include "Session/UndeformedMesh.h"
#include "Session/Validity.h"
#include "Support/Error.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace
{
using morph::ConstPoints;
using morph::Index;
using morph::Points;
using Ids = std::vector<Index>;
using IdArray = py::array_t<Index, py::array::c_style | py::array::forcecast>;

std::atomic<int> threads{ 0 };

int numberOfThreads()
{
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return threads > 0 ? threads.load() : all;
}

/// Threads, warnings and Ctrl-C for a computation that has released the interpreter's lock.
class Monitor : public morph::Monitor
{
public:
  bool cancelled() override
  {
    constexpr auto Pause = std::chrono::milliseconds(50); // the lock may be another thread's
    const auto now = std::chrono::steady_clock::now();
    if (now - this->asked_ > Pause)
    {
      const py::gil_scoped_acquire lock;
      this->isInterrupted_ = this->isInterrupted_ || PyErr_CheckSignals() != 0;
      this->asked_ = std::chrono::steady_clock::now();
    }
    return this->isInterrupted_;
  }

  void warn(const std::string& message) override
  {
    const py::gil_scoped_acquire lock;
    const py::object kind = py::module_::import("meshmorphing").attr("MorphWarning");
    constexpr int Caller = 2; // the line that called the package
    if (PyErr_WarnEx(kind.ptr(), message.c_str(), Caller) != 0)
    {
      throw py::error_already_set(); // warnings are errors
    }
  }

  int threads() const override { return numberOfThreads(); }

protected:
  void share(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body) override
  {
    const Index most = std::min<Index>(this->threads(), n / std::max<Index>(grain, 1));
    if (most <= 1)
    {
      body(0, n);
      return;
    }
    const Index length = std::max(grain, n / (4 * most));
    const Index count = n / length; // the last one takes what is left
    std::atomic<Index> next{ 0 };
    std::exception_ptr thrown;
    std::mutex mutex;
    const auto work = [&]
    {
      try
      {
        for (Index i = next++; i < count; i = next++)
        {
          body(i * length, i + 1 < count ? (i + 1) * length : n);
        }
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        thrown = std::current_exception();
      }
    };
    std::vector<std::thread> helpers;
    for (Index t = 1; t < most; ++t)
    {
      helpers.emplace_back(work);
    }
    work();
    for (std::thread& helper : helpers)
    {
      helper.join();
    }
    if (thrown)
    {
      std::rethrow_exception(thrown);
    }
  }

private:
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  bool isInterrupted_ = false;
};

/// Calls compute(monitor) without the interpreter's lock.
template <typename Compute>
auto unlocked(const Compute& compute)
{
  Monitor monitor;
  const py::gil_scoped_release released;
  return compute(monitor);
}

Ids idsOf(const IdArray& array)
{
  return Ids(array.data(), array.data() + array.size());
}

template <typename Value>
py::array_t<Value> arrayOf(const std::vector<Value>& values)
{
  return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
}

using Mesh = morph::UndeformedMesh;

/// The nodes that the caller knows: those of the front of a layer, which faces are made into.
Index nodesOf(const Mesh& mesh)
{
  const morph::ShellLayer& layer = mesh.mesh().layer;
  return layer.nodes > 0 ? layer.nodes : mesh.mesh().numberOfNodes();
}

/// The others left out.
Ids knownOf(const Mesh& mesh, Ids nodes)
{
  const Index count = nodesOf(mesh);
  nodes.erase(
    std::remove_if(nodes.begin(), nodes.end(), [count](Index node) { return node >= count; }),
    nodes.end());
  return nodes;
}

/// Calls use(all points) where those that the caller knows are `points`.
template <typename Use>
auto withAll(const Mesh& mesh, const ConstPoints& points, const Use& use)
{
  return mesh.mesh().layer.nodes > 0 ? use(morph::layerBehind(mesh.mesh(), points)) : use(points);
}

void requireNodes(const Mesh& mesh, const Ids& nodes)
{
  Ids wrong;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(wrong),
    [&](Index node) { return node < 0 || node >= nodesOf(mesh); });
  if (!wrong.empty())
  {
    throw morph::Error("The mesh has no nodes " + morph::listIds(wrong) + ": ids go from 0 to " +
                       std::to_string(nodesOf(mesh) - 1) + ".");
  }
  Ids sorted = nodes, twice;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
  {
    if (sorted[i] == sorted[i - 1])
    {
      twice.push_back(sorted[i]);
    }
  }
  if (!twice.empty())
  {
    throw morph::Error("Nodes are named more than once: " + morph::listIds(twice) + ".");
  }
}

/// `faceOffsets`, `faces`: as of morph::Mesh, empty without polyhedra.
std::shared_ptr<Mesh> makeMesh(const ConstPoints& points, const py::array_t<std::uint8_t>& types,
  const IdArray& offsets, const IdArray& connectivity, const IdArray& faceOffsets,
  const IdArray& faces)
{
  morph::Mesh mesh;
  mesh.types.assign(types.data(), types.data() + types.size());
  mesh.offsets = idsOf(offsets);
  mesh.connectivity = idsOf(connectivity);
  mesh.faceOffsets = idsOf(faceOffsets);
  mesh.faces = idsOf(faces);
  return unlocked(
    [&](Monitor& monitor)
    {
      mesh.points = points;
      morph::validate(mesh);
      const auto has = [&](int dimension)
      {
        return std::any_of(mesh.types.begin(), mesh.types.end(),
          [&](std::uint8_t type) { return morph::cellShape(type)->dimension == dimension; });
      };
      if (has(2) && !has(3))
      {
        mesh = morph::thicken(mesh);
      }
      morph::recognizeCells(mesh, monitor);
      auto made = std::make_shared<Mesh>(std::move(mesh), nullptr, monitor);
      made->before(monitor); // found once, while no other thread has the mesh
      morph::Session session;
      session.setMesh(made);
      morph::Session::Options options;
      options.validity = morph::Validity::Mode::None; // quality() is for that
      session.reportMesh(options, monitor);
      return made;
    });
}

/// The faces of the boundary; of a plane mesh or shell its edges. Offsets, and the nodes.
std::pair<Ids, Ids> facesOf(const Mesh& mesh)
{
  const morph::BoundaryFaces& faces = mesh.outerFaces();
  std::pair<Ids, Ids> result{ { 0 }, {} };
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const Ids known = knownOf(mesh, Ids(faces.connectivity.begin() + faces.offsets[f],
                                      faces.connectivity.begin() + faces.offsets[f + 1]));
    result.second.insert(result.second.end(), known.begin(), known.end());
    result.first.push_back(static_cast<Index>(result.second.size()));
  }
  return result;
}

/// Their areas, or lengths.
Eigen::VectorXd sizesOf(const Mesh& mesh)
{
  const Points& points = mesh.mesh().points;
  if (mesh.mesh().layer.nodes == 0)
  {
    return morph::faceAreas(points, mesh.outerFaces()).rowwise().norm();
  }
  const auto [offsets, ends] = facesOf(mesh);
  Eigen::VectorXd lengths(offsets.size() - 1);
  for (Index edge = 0; edge < lengths.size(); ++edge)
  {
    lengths[edge] =
      (points.row(ends[offsets[edge]]) - points.row(ends[offsets[edge + 1] - 1])).norm();
  }
  return lengths;
}

/// Of each surface: its id, faces, nodes and area.
py::list surfacesOf(const Mesh& mesh, double featureAngle, double cornerAngle)
{
  morph::Classification geometry;
  Eigen::VectorXd sizes;
  unlocked(
    [&](Monitor& monitor)
    {
      morph::ClassificationOptions options;
      options.featureAngle = featureAngle;
      options.cornerAngle = cornerAngle;
      geometry = morph::classify(mesh.mesh(), mesh.outerFaces(), options, monitor);
      sizes = sizesOf(mesh);
    });
  py::list result;
  for (const morph::GeometrySurface& surface : geometry.surfaces)
  {
    double area = 0;
    for (const Index face : surface.faces)
    {
      area += sizes[face];
    }
    result.append(py::make_tuple(
      surface.id, arrayOf(surface.faces), arrayOf(knownOf(mesh, surface.nodes)), area));
  }
  return result;
}

morph::Quality measure(const Mesh& mesh, const ConstPoints& points)
{
  return unlocked(
    [&](Monitor& monitor)
    {
      return withAll(mesh, points,
        [&](const ConstPoints& all)
        { return morph::measureQuality(mesh.mesh(), all, mesh.orientation(), {}, monitor); });
    });
}

// ----------------------------------------------------------------------------------- methods

using MakeMethod = std::function<std::unique_ptr<morph::Morpher>()>;

template <typename Method, typename SetUp>
MakeMethod maker(const SetUp& setUp)
{
  return [=]
  {
    auto method = std::make_unique<Method>();
    setUp(*method);
    return method;
  };
}

/// FEMWARP's stiffness, by the options' names.
morph::CellStiffness stiffnessOf(const py::dict& options, const Mesh& mesh)
{
  const Index nodes = nodesOf(mesh);
  morph::CellStiffness stiffness;
  stiffness.kind = static_cast<morph::CellStiffness::Kind>(options["stiffness"].cast<int>());
  stiffness.exponent = options["stiffness_exponent"].cast<double>();
  if (!options["stiffness_array"].is_none())
  {
    stiffness.values = options["stiffness_array"].cast<std::vector<double>>();
  }
  if (!options["wall_array"].is_none())
  {
    const auto marks = options["wall_array"].cast<py::array_t<double>>();
    if (marks.size() != nodes)
    {
      throw morph::Error("wall_array has " + std::to_string(marks.size()) +
                         " values; one for each of " + std::to_string(nodes) + " nodes is needed.");
    }
    for (Index node = 0; node < nodes; ++node)
    {
      if (std::isnan(marks.at(node)))
      {
        throw morph::Error("wall_array is NaN at node " + std::to_string(node) +
                           ". Give 0, or another number for a wall.");
      }
      if (marks.at(node) != 0)
      {
        stiffness.walls.push_back(node);
      }
    }
    const std::size_t known = mesh.mesh().layer.nodes > 0 ? stiffness.walls.size() : 0;
    for (std::size_t k = 0; k < known; ++k)
    {
      stiffness.walls.push_back(stiffness.walls[k] + nodes);
    }
    stiffness.areWallsGlobal = false;
    stiffness.noWalls = "wall_array is zero at all nodes.";
  }
  return stiffness;
}

/// Makes the method of this name, with options by the names of the properties; choices are numbers.
/// As the filters make it.
MakeMethod makerOf(const std::string& name, const py::dict& options, const Mesh& mesh)
{
  const auto number = [&](const char* option) { return options[option].cast<double>(); };
  const auto integer = [&](const char* option) { return options[option].cast<int>(); };
  if (name == "FEMWARP")
  {
    return maker<morph::FemWarp>(
      [stiffness = stiffnessOf(options, mesh), tolerance = number("tolerance")](auto& method)
      {
        method.setStiffness(stiffness);
        method.setTolerance(tolerance);
      });
  }
  if (name == "LBWARP")
  {
    using Outside = morph::LogBarrierWarp::OutsideHull;
    return maker<morph::LogBarrierWarp>(
      [outside = static_cast<Outside>(integer("outside_hull")), tolerance = number("tolerance")](
        auto& method)
      {
        method.setOutsideHull(outside);
        method.setTolerance(tolerance);
      });
  }
  if (name == "WeightedResidual")
  {
    return maker<morph::WeightedResidual>([count = integer("number_of_neighbors")](auto& method)
      { method.setNumberOfNeighbors(count); });
  }
  if (name == "SimplexLinear")
  {
    return maker<morph::SimplexLinear>([](auto&) {});
  }
  if (name == "SimplexNaturalNeighbor")
  {
    return maker<morph::SimplexNaturalNeighbor>(
      [bytes = static_cast<std::size_t>(1e6 * number("memory_limit"))](auto& method)
      { method.setMemoryLimit(bytes); });
  }
  if (name == "RadialBasis")
  {
    const Index centers = integer("number_of_centers");
    return maker<morph::RadialBasis>(
      [kernel = static_cast<morph::RadialKernel::Kind>(integer("kernel")),
        radius = number("support_radius"),
        most = centers > 0 ? std::max<Index>(centers, morph::RadialBasis::FewestCenters) : 0](
        auto& method)
      {
        method.setKernel(kernel);
        method.setSupportRadius(radius);
        method.setNumberOfCenters(most);
      });
  }
  if (name == "Smoothing")
  {
    morph::SmoothingOptions smoothing;
    smoothing.target = static_cast<morph::SmoothingTarget>(integer("target_shape"));
    smoothing.objective = static_cast<morph::SmoothingObjective>(integer("objective"));
    smoothing.iterationLimit = integer("iteration_limit");
    smoothing.stopMove = number("stop_move");
    return maker<morph::Smoothing>([=](auto& method) { method.setOptions(smoothing); });
  }
  if (name == "InversionFree")
  {
    using Method = morph::InversionFree;
    constexpr int Efforts[] = { Method::QuickSteps, Method::DefaultSteps, Method::ThoroughSteps };
    return maker<Method>(
      [steps = Efforts[integer("effort")]](auto& method) { method.setSteps(steps); });
  }
  throw morph::Error("There is no method " + name + ".");
}

/// The nodes of the boundary that stay beside `named` ones. A node between corners follows its
/// cell if one of them is named: edges would bend where corners alone are.
Ids heldNodes(const Mesh& mesh, const std::vector<std::uint8_t>& isNamed)
{
  const morph::BoundaryFaces& faces = mesh.outerFaces();
  Ids held;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const auto k = static_cast<Index>(i);
    const bool isAcross = mesh.mesh().layer.nodes > 0 && faces.nodes[i] >= 2 * nodesOf(mesh);
    if (isNamed[faces.nodes[i]] == 0 && !isAcross &&
        std::none_of(faces.between.begin(k), faces.between.end(k),
          [&](Index corner) { return isNamed[corner] != 0; }))
    {
      held.push_back(faces.nodes[i]);
    }
  }
  return held;
}

/// The nodes that the caller names and, with `fixesOthers`, the rest of the boundary. In a layer
/// their images, too.
struct Prescribed
{
  Ids named;
  Ids all; ///< ascending

  Prescribed(const Mesh& mesh, Ids ids, bool fixesOthers)
    : named(std::move(ids))
    , all(named)
  {
    requireNodes(mesh, this->named);
    std::vector<std::uint8_t> isNamed(mesh.mesh().numberOfNodes());
    for (const Index node : this->named)
    {
      isNamed[node] = 1;
    }
    if (mesh.mesh().layer.nodes > 0)
    {
      morph::markImages(mesh.mesh().layer, isNamed);
      std::transform(this->named.begin(), this->named.end(), std::back_inserter(this->all),
        [&](Index node) { return node + nodesOf(mesh); });
    }
    if (fixesOthers)
    {
      const Ids held = heldNodes(mesh, isNamed);
      this->all.insert(this->all.end(), held.begin(), held.end());
    }
    std::sort(this->all.begin(), this->all.end());
  }
};

/// A method prepared for a mesh and the nodes that move it. Threads that call it at once take
/// turns; each computation has all threads.
class Prepared
{
public:
  Prepared(const std::shared_ptr<const Mesh>& mesh, const std::string& name, MakeMethod make,
    const Ids& nodes, bool fixesOthers, Monitor& monitor)
    : prescribed_(*mesh, nodes, fixesOthers)
  {
    this->options_.createMorpher = std::move(make);
    this->options_.method = name;
    this->options_.validity = morph::Validity::Mode::None;
    this->options_.measureAll = false;
    this->session_.setMesh(mesh);
    this->session_.prepare(this->prescribed_.all, this->options_, monitor);
  }

  /// `positions`: of the nodes, #named x 3; displacements if `isRelative`.
  Points evaluate(const ConstPoints& positions, bool isRelative, Monitor& monitor)
  {
    const Mesh& mesh = this->session_.mesh();
    morph::NamedPoints named;
    for (std::size_t i = 0; i < this->prescribed_.named.size(); ++i)
    {
      named.pairs.emplace_back(static_cast<Index>(i), this->prescribed_.named[i]);
    }
    named.positions = positions;
    if (isRelative)
    {
      named.displacements = positions;
    }
    morph::TargetOptions options;
    options.fixUnnamedBoundary = false; // they are in prescribed_.all
    morph::BoundaryTargets boundary =
      morph::findTargets(std::move(named), mesh.mesh(), mesh.outerFaces(), mesh.size(), options);
    Points places = mesh.mesh().points;
    places(boundary.ids, morph::allColumns) = boundary.targets;
    boundary.ids = this->prescribed_.all;
    boundary.targets = places(boundary.ids, morph::allColumns);
    const std::lock_guard<std::mutex> turn(this->mutex_);
    const auto step = this->session_.morph(boundary, this->options_, monitor);
    morph::warnOfLoose(step->loose, monitor);
    step->moved.conservativeResize(nodesOf(mesh), 3);
    return std::move(step->moved);
  }

  Points adjoint(const ConstPoints& gradient, Monitor& monitor)
  {
    const Mesh& mesh = this->session_.mesh();
    const Index count = nodesOf(mesh);
    Points own = Points::Zero(mesh.mesh().numberOfNodes(), 3), all = own;
    own.topRows(count) = gradient;
    const Ids &ids = this->prescribed_.all, &named = this->prescribed_.named;
    const std::lock_guard<std::mutex> turn(this->mutex_);
    all(ids, morph::allColumns) =
      this->session_.transpose(ids, std::move(own), this->options_, monitor);
    if (mesh.mesh().layer.nodes > 0) // both images of a node move alike
    {
      all.topRows(count) += all.middleRows(count, count).eval();
    }
    return all(named, morph::allColumns);
  }

  py::array_t<Index> nodes() const { return arrayOf(this->prescribed_.named); }

private:
  Prescribed prescribed_;
  morph::Session::Options options_;
  morph::Session session_;
  std::mutex mutex_;
};

// ------------------------------------------------------------------------------------ repair

/// The cells that a motion inverts, ascending. `points`: of all nodes.
Ids invertedBy(const Mesh& mesh, const ConstPoints& points, Monitor& monitor)
{
  return mesh.before(monitor).added(
    points, morph::invertedCells(mesh.mesh(), points, mesh.orientation(), monitor));
}

struct Repaired
{
  Points points;
  Ids inverted;   ///< by the motion
  Ids determined; ///< those of them that the prescribed nodes alone invert
};

Repaired repair(
  const Mesh& mesh, const ConstPoints& points, const Ids& nodes, bool fixesOthers, Monitor& monitor)
{
  const Ids ids = mesh.hanging().without(Prescribed(mesh, nodes, fixesOthers).all);
  const bool leaves = morph::leavesPlane(mesh.mesh(), points);
  const morph::Mesh curved = leaves ? morph::bent(mesh.mesh()) : morph::Mesh();
  const morph::Mesh& rest = leaves ? curved : mesh.mesh();
  const morph::NodePartition partition = morph::partitionNodes(rest, mesh.hanging(), ids);
  Repaired result;
  result.points = withAll(mesh, points, [](const ConstPoints& all) { return Points(all); });
  const Points targets = result.points(ids, morph::allColumns);
  const morph::Validity validity{ morph::Validity::Mode::Repair, 0, rest, rest.points,
    mesh.before(monitor), partition, mesh.orientation(), targets, mesh.outerFaces(), mesh.hanging(),
    false, {} };
  if (!validity.repair(result.points, monitor))
  {
    result.inverted = invertedBy(mesh, result.points, monitor);
    result.determined = validity.before.without(
      morph::boundaryDeterminedInversions(rest, partition, mesh.orientation(), result.points));
  }
  morph::keepInPlane(rest, partition.free, result.points);
  result.points.conservativeResize(nodesOf(mesh), 3);
  return result;
}

/// The core's errors as Python's: an interrupt stays what it is.
void translate(std::exception_ptr thrown)
{
  try
  {
    std::rethrow_exception(thrown);
  }
  catch (const morph::Error& error)
  {
    if (!PyErr_Occurred())
    {
      const bool isInput = error.kind() == morph::Error::Kind::InvalidInput;
      PyErr_SetString(isInput ? PyExc_ValueError : PyExc_RuntimeError, error.what());
    }
  }
}
}

PYBIND11_MODULE(_core, module)
{
  py::register_exception_translator(translate);
  module.def("set_threads", [](int count) { threads = count; });
  module.def("threads", numberOfThreads);
  module.def("number_of_nodes",
    [](std::uint8_t type)
    {
      const morph::CellShape* shape = morph::cellShape(type);
      return shape ? shape->numberOfNodes : 0;
    });

  py::class_<Mesh, std::shared_ptr<Mesh>>(module, "Mesh")
    .def(py::init(&makeMesh))
    .def_property_readonly(
      "points",
      [](const Mesh& mesh) { return ConstPoints(mesh.mesh().points.topRows(nodesOf(mesh))); },
      py::return_value_policy::reference_internal)
    .def("_boundary",
      [](const Mesh& mesh)
      {
        const auto [offsets, connectivity] = facesOf(mesh);
        return py::make_tuple(arrayOf(offsets), arrayOf(connectivity),
          arrayOf(mesh.outerFaces().cells), arrayOf(knownOf(mesh, mesh.outerFaces().nodes)));
      })
    .def("_surfaces", &surfacesOf)
    .def("_quality",
      [](const Mesh& mesh, const ConstPoints& points)
      {
        const morph::Quality quality = measure(mesh, points);
        return py::make_tuple(arrayOf(quality.scaledJacobian), quality.minimum, quality.mean,
          quality.inverted, quality.degenerate, quality.worstCell);
      })
    .def("_inverted",
      [](const Mesh& mesh, const ConstPoints& points)
      {
        return arrayOf(unlocked(
          [&](Monitor& monitor)
          {
            return withAll(
              mesh, points, [&](const ConstPoints& all) { return invertedBy(mesh, all, monitor); });
          }));
      })
    .def("_repair",
      [](const Mesh& mesh, const ConstPoints& points, const IdArray& nodes, bool fixesOthers)
      {
        const Ids ids = idsOf(nodes);
        Repaired repaired = unlocked(
          [&](Monitor& monitor) { return repair(mesh, points, ids, fixesOthers, monitor); });
        return py::make_tuple(
          std::move(repaired.points), arrayOf(repaired.inverted), arrayOf(repaired.determined));
      });

  py::class_<Prepared>(module, "Prepared")
    .def(py::init(
      [](const std::shared_ptr<Mesh>& mesh, const std::string& name, const py::dict& options,
        const IdArray& nodes, bool fixesOthers)
      {
        MakeMethod make = makerOf(name, options, *mesh);
        const Ids ids = idsOf(nodes);
        return unlocked(
          [&](Monitor& monitor) {
            return std::make_unique<Prepared>(
              mesh, name, std::move(make), ids, fixesOthers, monitor);
          });
      }))
    .def_property_readonly("nodes", &Prepared::nodes)
    .def("_evaluate",
      [](Prepared& prepared, const ConstPoints& positions, bool isRelative)
      {
        return unlocked(
          [&](Monitor& monitor) { return prepared.evaluate(positions, isRelative, monitor); });
      })
    .def("_adjoint", [](Prepared& prepared, const ConstPoints& gradient)
      { return unlocked([&](Monitor& monitor) { return prepared.adjoint(gradient, monitor); }); });
}
