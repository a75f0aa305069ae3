// SPDX-License-Identifier: BSD-3-Clause
// The extension module meshmorphing._core: arrays in, arrays out. Shapes, types and coordinates are
// checked in Python (Python/_arrays.py), ids here and in the core.
#include "Boundary/Classification.h"
#include "Boundary/FaceAreas.h"
#include "LinearMethods/AttachedNodes.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/CellShape.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/InvertedBefore.h"
#include "Quality/ScaledJacobian.h"
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
#include <exception>
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

  void parallelFor(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body) override
  {
    const Index most = std::min<Index>(numberOfThreads(), n / std::max<Index>(grain, 1));
    if (most <= 1)
    {
      if (n > 0)
      {
        body(0, n);
      }
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

/// An undeformed mesh, and what follows from it.
struct Mesh
{
  std::shared_ptr<const morph::Mesh> cells;
  morph::BoundaryFaces boundary;
  std::vector<std::int8_t> signs;

  const Points& points() const { return this->cells->points; }
};

void requireNodes(const Mesh& mesh, const Ids& nodes)
{
  Ids wrong;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(wrong),
    [&](Index node) { return node < 0 || node >= mesh.points().rows(); });
  if (!wrong.empty())
  {
    throw morph::Error("The mesh has no nodes " + morph::listIds(wrong) + ": ids go from 0 to " +
                       std::to_string(mesh.points().rows() - 1) + ".");
  }
}

Mesh makeMesh(const ConstPoints& points, const py::array_t<std::uint8_t>& types,
  const IdArray& offsets, const IdArray& connectivity)
{
  morph::Mesh mesh;
  mesh.types.assign(types.data(), types.data() + types.size());
  mesh.offsets = idsOf(offsets);
  mesh.connectivity = idsOf(connectivity);
  return unlocked(
    [&](Monitor& monitor)
    {
      mesh.points = points;
      morph::validate(mesh);
      morph::replaceCollapsedCells(mesh);
      const morph::ConnectedComponents bodies = morph::connectedComponents(mesh, monitor);
      if (bodies.count == 0)
      {
        throw morph::Error("The mesh has no volume cells. Give tetrahedra, hexahedra, wedges or "
                           "pyramids, linear or quadratic.");
      }
      Mesh made;
      made.signs = morph::cellSigns(mesh, bodies, monitor);
      made.boundary = morph::boundaryFaces(mesh, monitor);
      made.cells = std::make_shared<const morph::Mesh>(std::move(mesh));
      return made;
    });
}

/// Of each surface: its id, faces, nodes and area.
py::list surfacesOf(const Mesh& mesh, double featureAngle, double cornerAngle)
{
  morph::Classification geometry;
  Eigen::VectorXd areas;
  unlocked(
    [&](Monitor& monitor)
    {
      morph::ClassificationOptions options;
      options.featureAngle = featureAngle;
      options.cornerAngle = cornerAngle;
      geometry = morph::classify(*mesh.cells, mesh.boundary, options, monitor);
      areas = morph::faceAreas(mesh.points(), mesh.boundary).rowwise().norm();
    });
  py::list result;
  for (const morph::GeometrySurface& surface : geometry.surfaces)
  {
    double area = 0;
    for (const Index face : surface.faces)
    {
      area += areas[face];
    }
    result.append(py::make_tuple(surface.id, arrayOf(surface.faces), arrayOf(surface.nodes), area));
  }
  return result;
}

morph::Quality measure(const Mesh& mesh, const ConstPoints& points)
{
  return unlocked([&](Monitor& monitor)
    { return morph::measureQuality(*mesh.cells, points, mesh.signs, {}, monitor); });
}

// ----------------------------------------------------------------------------------- methods

/// The method of this name, with options by the names of the properties; choices are numbers. As
/// the filters make it.
std::unique_ptr<morph::Morpher> makeMethod(
  const std::string& name, const py::dict& options, const Mesh& mesh)
{
  const auto number = [&](const char* option) { return options[option].cast<double>(); };
  const auto integer = [&](const char* option) { return options[option].cast<int>(); };
  if (name == "FEMWARP")
  {
    morph::CellStiffness stiffness;
    stiffness.kind = static_cast<morph::CellStiffness::Kind>(integer("stiffness"));
    stiffness.exponent = number("stiffness_exponent");
    if (!options["stiffness_array"].is_none())
    {
      stiffness.values = options["stiffness_array"].cast<std::vector<double>>();
    }
    if (!options["wall_array"].is_none())
    {
      const auto marks = options["wall_array"].cast<py::array_t<bool>>();
      for (Index node = 0; node < marks.size(); ++node)
      {
        if (marks.at(node))
        {
          stiffness.walls.push_back(node);
        }
      }
      stiffness.areWallsGlobal = false;
      stiffness.noWalls = "wall_array is zero at all nodes.";
      if (marks.size() != mesh.points().rows())
      {
        throw morph::Error("wall_array has " + std::to_string(marks.size()) +
                           " values; one for each of " + std::to_string(mesh.points().rows()) +
                           " nodes is needed.");
      }
    }
    auto method = std::make_unique<morph::FemWarp>();
    method->setStiffness(std::move(stiffness));
    method->setTolerance(number("tolerance"));
    return method;
  }
  if (name == "LBWARP")
  {
    auto method = std::make_unique<morph::LogBarrierWarp>();
    method->setOutsideHull(
      static_cast<morph::LogBarrierWarp::OutsideHull>(integer("outside_hull")));
    method->setTolerance(number("tolerance"));
    return method;
  }
  if (name == "WeightedResidual")
  {
    auto method = std::make_unique<morph::WeightedResidual>();
    method->setNumberOfNeighbors(integer("number_of_neighbors"));
    return method;
  }
  if (name == "SimplexLinear")
  {
    return std::make_unique<morph::SimplexLinear>();
  }
  if (name == "SimplexNaturalNeighbor")
  {
    auto method = std::make_unique<morph::SimplexNaturalNeighbor>();
    method->setMemoryLimit(static_cast<std::size_t>(1e6 * number("memory_limit")));
    return method;
  }
  if (name == "RadialBasis")
  {
    auto method = std::make_unique<morph::RadialBasis>();
    method->setKernel(static_cast<morph::RadialKernel::Kind>(integer("kernel")));
    method->setSupportRadius(number("support_radius"));
    const Index centers = integer("number_of_centers");
    method->setNumberOfCenters(
      centers > 0 ? std::max<Index>(centers, morph::RadialBasis::FewestCenters) : 0);
    return method;
  }
  if (name == "Smoothing")
  {
    morph::SmoothingOptions smoothing;
    smoothing.target = static_cast<morph::SmoothingTarget>(integer("target_shape"));
    smoothing.objective = static_cast<morph::SmoothingObjective>(integer("objective"));
    smoothing.iterationLimit = integer("iteration_limit");
    smoothing.stopMove = number("stop_move");
    auto method = std::make_unique<morph::Smoothing>();
    method->setOptions(smoothing);
    return method;
  }
  if (name == "InversionFree")
  {
    using Steps = morph::RaisingSteps;
    constexpr int steps[] = { Steps::Quick, Steps::Default, Steps::Thorough };
    auto method = std::make_unique<morph::InversionFree>();
    method->setSteps(steps[integer("effort")]);
    return method;
  }
  throw morph::Error("There is no method " + name + ".");
}

/// The nodes of the boundary that stay beside `named` ones. A node between corners follows its
/// cell if one of them is named: edges would bend where corners alone are.
Ids heldNodes(const morph::BoundaryFaces& faces, const std::vector<bool>& isNamed)
{
  Ids held;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const auto k = static_cast<Index>(i);
    if (!isNamed[faces.nodes[i]] && std::none_of(faces.between.begin(k), faces.between.end(k),
                                      [&](Index corner) { return isNamed[corner]; }))
    {
      held.push_back(faces.nodes[i]);
    }
  }
  return held;
}

/// A partition whose first rows, of the nodes that were named, are the caller's.
class Prescribed
{
public:
  Prescribed(const Mesh& mesh, Ids named, bool fixesOthers)
    : named_(std::move(named))
  {
    requireNodes(mesh, this->named_);
    std::vector<bool> isNamed(mesh.points().rows());
    for (const Index node : this->named_)
    {
      isNamed[node] = true;
    }
    Ids all = this->named_;
    if (fixesOthers)
    {
      const Ids held = heldNodes(mesh.boundary, isNamed);
      all.insert(all.end(), held.begin(), held.end());
    }
    this->partition_ =
      std::make_shared<const morph::NodePartition>(morph::partitionNodes(*mesh.cells, all));
    const Ids& sorted = this->partition_->prescribed;
    for (const Index node : this->named_)
    {
      this->rows_.push_back(std::lower_bound(sorted.begin(), sorted.end(), node) - sorted.begin());
    }
  }

  const std::shared_ptr<const morph::NodePartition>& partition() const { return this->partition_; }
  const Ids& rows() const { return this->rows_; }
  const Ids& named() const { return this->named_; }

private:
  std::shared_ptr<const morph::NodePartition> partition_;
  Ids named_;
  Ids rows_; ///< #named, its row among all prescribed nodes
};

/// A method prepared for a mesh and the nodes that move it.
class Prepared
{
public:
  Prepared(const Mesh& mesh, std::unique_ptr<morph::Morpher> method, const Ids& nodes,
    bool fixesOthers, Monitor& monitor)
    : mesh_(mesh.cells)
    , prescribed_(mesh, nodes, fixesOthers)
    , method_(std::move(method))
    , attached_(*this->mesh_, *this->prescribed_.partition())
  {
    this->method_->prepare(this->mesh_, this->prescribed_.partition(), monitor);
  }

  /// `positions`: of the nodes, #named x 3; displacements if `isRelative`.
  Points evaluate(const ConstPoints& positions, bool isRelative, Monitor& monitor) const
  {
    const Points& rest = this->mesh_->points;
    Points targets = rest(this->prescribed_.partition()->prescribed, morph::allColumns);
    const Ids& rows = this->prescribed_.rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      auto target = targets.row(rows[i]);
      const auto given = positions.row(static_cast<Index>(i));
      target = isRelative ? Eigen::RowVector3d(target + given) : Eigen::RowVector3d(given);
    }
    Points moved;
    this->method_->evaluate(targets, moved, monitor);
    this->attached_.apply(moved);
    return moved;
  }

  Points adjoint(const ConstPoints& gradient, Monitor& monitor) const
  {
    const auto* linear = dynamic_cast<const morph::LinearMorpher*>(this->method_.get());
    if (!linear)
    {
      throw morph::Error("The method is not linear, so it has no adjoint that is the same for all "
                         "motions. Use one that is, FEMWARP for instance.");
    }
    Points all;
    if (this->attached_.nodes().empty())
    {
      linear->applyTranspose(gradient, all, monitor);
    }
    else
    {
      Points nodes = gradient;
      this->attached_.applyTranspose(nodes);
      linear->applyTranspose(nodes, all, monitor);
    }
    return all(this->prescribed_.rows(), morph::allColumns);
  }

  py::array_t<Index> nodes() const { return arrayOf(this->prescribed_.named()); }

private:
  std::shared_ptr<const morph::Mesh> mesh_;
  Prescribed prescribed_;
  std::unique_ptr<morph::Morpher> method_;
  morph::AttachedNodes attached_;
};

// ------------------------------------------------------------------------------------ repair

struct Repaired
{
  Points points;
  Ids inverted;   ///< by the motion
  Ids determined; ///< those of them that the prescribed nodes alone invert
};

/// The cells that a motion inverts, ascending. Those that were inverted before, and are no worse,
/// do not count.
class Inverted
{
public:
  Inverted(const Mesh& mesh, Monitor& monitor)
    : mesh_(mesh)
    , monitor_(monitor)
    , before_(*mesh.cells, mesh.signs, this->measure(mesh.points()))
  {
  }

  Ids at(const ConstPoints& points) const
  {
    return this->before_.added(points, morph::invertedCells(this->measure(points)));
  }
  const morph::InvertedBefore& before() const { return this->before_; }

private:
  morph::Quality measure(const ConstPoints& points) const
  {
    return morph::measureQuality(*this->mesh_.cells, points, this->mesh_.signs, {}, this->monitor_);
  }

  const Mesh& mesh_;
  Monitor& monitor_;
  morph::InvertedBefore before_;
};

/// Near the inverted cells at first, then in the whole mesh.
Repaired repair(
  const Mesh& mesh, const ConstPoints& points, const Ids& nodes, bool fixesOthers, Monitor& monitor)
{
  const Prescribed prescribed(mesh, nodes, fixesOthers);
  const Inverted bad(mesh, monitor);
  Repaired result;
  result.points = points;
  result.inverted = bad.at(result.points);
  for (const bool nearOnly : { true, false })
  {
    if (result.inverted.empty())
    {
      break;
    }
    morph::InversionFree method;
    method.setNearOnly(nearOnly);
    method.prepare(mesh.cells, prescribed.partition(), monitor);
    Points trial = result.points;
    method.repair(trial, monitor);
    Ids left = bad.at(trial);
    if (left.size() < result.inverted.size())
    {
      result.points.swap(trial);
      result.inverted.swap(left);
    }
  }
  if (!result.inverted.empty())
  {
    result.determined = bad.before().without(morph::boundaryDeterminedInversions(
      *mesh.cells, *prescribed.partition(), mesh.signs, result.points));
  }
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

  py::class_<Mesh>(module, "Mesh")
    .def(py::init(&makeMesh))
    .def_property_readonly("points", &Mesh::points, py::return_value_policy::reference_internal)
    .def_property_readonly("types", [](const Mesh& mesh) { return arrayOf(mesh.cells->types); })
    .def("_boundary",
      [](const Mesh& mesh)
      {
        const morph::BoundaryFaces& faces = mesh.boundary;
        return py::make_tuple(arrayOf(faces.offsets), arrayOf(faces.connectivity),
          arrayOf(faces.cells), arrayOf(faces.nodes));
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
      [](const Mesh& mesh, const ConstPoints& points) {
        return arrayOf(
          unlocked([&](Monitor& monitor) { return Inverted(mesh, monitor).at(points); }));
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
      [](const Mesh& mesh, const std::string& name, const py::dict& options, const IdArray& nodes,
        bool fixesOthers)
      {
        std::unique_ptr<morph::Morpher> method = makeMethod(name, options, mesh);
        const Ids ids = idsOf(nodes);
        return unlocked(
          [&](Monitor& monitor) {
            return std::make_unique<Prepared>(mesh, std::move(method), ids, fixesOthers, monitor);
          });
      }))
    .def_property_readonly("nodes", &Prepared::nodes)
    .def("_evaluate",
      [](const Prepared& prepared, const ConstPoints& positions, bool isRelative)
      {
        return unlocked(
          [&](Monitor& monitor) { return prepared.evaluate(positions, isRelative, monitor); });
      })
    .def("_adjoint", [](const Prepared& prepared, const ConstPoints& gradient)
      { return unlocked([&](Monitor& monitor) { return prepared.adjoint(gradient, monitor); }); });
}
