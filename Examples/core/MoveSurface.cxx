// SPDX-License-Identifier: BSD-3-Clause
// A solver's file without VTK: lists its surfaces, or moves one, repairs the mesh, and writes the
// file again with other coordinates.
//   move-surface part.inp
//   move-surface part.inp BORE 0.1 0 0 moved.inp
#include "BoundaryMover/BoundaryMover.h"
#include "BoundaryMover/Patches.h"
#include "Formats/SolverFile.h"
#include "LinearMethods/FemWarp.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"
#include "Support/Error.h"

#include <iostream>

namespace
{
struct Warnings : morph::Monitor
{
  void warn(const std::string& message) override { std::cerr << "Warning: " << message << "\n"; }
};

/// The boundary with the names of the file.
morph::BoundaryModel boundaryOf(
  const morph::Mesh& mesh, const morph::io::SolverMesh& file, morph::Monitor& monitor)
{
  const auto marks = [](const std::vector<morph::Index>& ids, morph::Index size)
  {
    std::vector<std::uint8_t> flags(ids.empty() ? 0 : size, 0);
    for (const morph::Index id : ids)
    {
      flags[id] = 1;
    }
    return flags;
  };
  std::vector<morph::Index> named;
  for (const morph::io::NamedSet& set : file.sets)
  {
    named.insert(named.end(), set.cells.begin(), set.cells.end());
  }
  morph::BoundaryModel model;
  model.mesh = mesh;
  std::vector<std::uint8_t> isNamed = marks(named, file.cells());
  isNamed.resize(file.cells(), 0);
  model.findFaces(isNamed, monitor);
  morph::ClassificationOptions options;
  options.sheets = model.sheetNumbers();
  model.geometry = morph::classify(mesh, model.faces, options, monitor);
  std::vector<morph::NamedSet> sets;
  for (const morph::io::NamedSet& set : file.sets)
  {
    sets.push_back(morph::boundarySet(set.name, mesh, model.faces, model.inner.size(),
      marks(set.nodes, file.nodes()), marks(set.cells, file.cells())));
  }
  model.takeSets(std::move(sets));
  return model;
}
}

int main(int count, char** words)
try
{
  if (count != 2 && count != 7)
  {
    std::cerr << "move-surface FILE [SURFACE DX DY DZ OUT]\n";
    return 2;
  }
  Warnings monitor;
  const auto file = morph::io::readSolverFile(words[1]);
  const morph::Mesh mesh = morph::io::coreMesh(file->mesh());
  const morph::BoundaryModel model = boundaryOf(mesh, file->mesh(), monitor);
  if (count == 2)
  {
    for (const morph::PatchSize& patch : morph::patchSizes(model))
    {
      std::cout << patch.name << ": " << patch.count << ", " << patch.measure << "\n";
    }
    return 0;
  }
  const Eigen::RowVector3d by(std::stod(words[3]), std::stod(words[4]), std::stod(words[5]));
  const morph::Choice choice = morph::choosePatches(model, { words[2] }, {});
  morph::BoundaryMover mover;
  const morph::Surroundings::Result& boundary = mover.move(model, choice,
    model.points()(choice.moving, morph::allColumns).rowwise() + by, {}, nullptr, monitor);

  morph::Session session;
  session.setMesh(mesh, monitor);
  morph::Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  options.validity = morph::Validity::Mode::Repair;
  morph::BoundaryTargets targets;
  targets.ids = morph::InnerNodes::prescribed(model, boundary);
  targets.targets = boundary.moved(targets.ids, morph::allColumns);
  const auto step = session.morph(targets, options, monitor);

  const auto print = [&](const char* when, const morph::Points& points)
  {
    const morph::Quality quality =
      morph::measureQuality(mesh, points, session.mesh().orientation(), {}, monitor);
    std::cout << when << ": minimum scaled Jacobian " << quality.minimum << ", inverted "
              << quality.inverted << "\n";
  };
  print("before", mesh.points);
  print("after", step->moved);
  std::cout << step->valid.status << " " << step->valid.error << "\n";
  const std::vector<double> moved(step->moved.data(), step->moved.data() + step->moved.size());
  morph::io::writeSolverFile(words[1], file->mesh().nodeNumbers, moved, words[6]);
  return step->valid.error.empty() ? 0 : 3;
}
catch (const std::exception& error)
{
  std::cerr << error.what() << "\n";
  return 1;
}
