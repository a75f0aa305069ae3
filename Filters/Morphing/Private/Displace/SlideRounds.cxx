// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/SlideRounds.h"

#include "BoundaryMorphing/MidNodes.h"
#include "Mesh/Polyhedra.h"
#include "Support/Error.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace morph::filters
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;
using Surfaces = std::vector<Index>;

constexpr const char* ChangeName = "SlideChange";
constexpr const char* ForceName = "SlideForce";
/// Of the angle between two surfaces: below it they are one where a node slides.
constexpr double LeastSine = 1e-3;

/// The surfaces of each node that slides, by node id.
std::map<Index, Surfaces> slidingNodes(const BoundaryModel& model, const std::vector<Index>& held,
  const Surfaces& sliding, const Surroundings::Result& result)
{
  std::map<Index, Surfaces> nodes;
  const auto& surfaces = model.geometry.surfaces;
  for (const Index s : sliding)
  {
    for (const Index node : surfaces[s].nodes)
    {
      const signed char role = result.roles[node];
      if (role == Surroundings::Stays || role == Surroundings::Follows ||
          role == Surroundings::IsHeld) // vertices, and surfaces that nothing touches
      {
        nodes[node].push_back(s);
      }
    }
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    if (!std::binary_search(sliding.begin(), sliding.end(), static_cast<Index>(s)))
    {
      for (const Index node : surfaces[s].nodes)
      {
        nodes.erase(node);
      }
    }
  }
  for (const Index node : held)
  {
    nodes.erase(node);
  }
  return nodes;
}

/// The projection onto the directions along all surfaces at `x`.
Eigen::Matrix3d directionsAt(
  const BoundaryModel& model, const Surfaces& surfaces, Surroundings& shapes, const Row& x)
{
  Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
  for (const Index s : surfaces)
  {
    const Eigen::Vector3d across = free * shapes.shapeOf(model, s).normal(x).transpose();
    if (across.norm() > LeastSine)
    {
      const Eigen::Vector3d unit = across.normalized();
      free -= unit * unit.transpose();
    }
  }
  // Three surfaces that meet leave rounding.
  return free.trace() < 0.5 ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : free;
}

/// Moves mid-side and face nodes that slide by what their corners have moved since `before`.
void moveBetween(const BoundaryModel& model, const std::map<Index, Surfaces>& sliding,
  const morph::Points& before, Surroundings& shapes, morph::Points& moved)
{
  const morph::BoundaryFaces& faces = model.faces;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const auto k = static_cast<Index>(i);
    const auto found = sliding.find(faces.nodes[i]);
    if (found == sliding.end())
    {
      continue;
    }
    const Row shift = morph::meanBetween(faces, k, model.points(),
      [&](Index corner) { return Row(moved.row(corner) - before.row(corner)); });
    if (!shift.isZero(0))
    {
      moved.row(found->first) =
        shapes.slid(model, found->second, found->first, before.row(found->first) + shift);
    }
  }
}
}

void SlideRounds::Prepare(const BoundaryModel& model, const std::vector<Index>& nodes,
  const Surroundings::Result& result, morph::Monitor& monitor)
{
  const morph::Mesh& mesh = model.mesh;
  if (mesh.numberOfCells() == 0)
  {
    throw morph::Error("SlideRounds needs the mesh's cells, and the input is a surface. Give the "
                       "volume mesh to this filter, or set SlideRounds to 0.");
  }
  if (morph::hasPolyhedra(mesh))
  {
    throw morph::Error("SlideRounds does not know polyhedra, and the mesh has some. Set it to 0.");
  }
  std::vector<Index> prescribed;
  for (const Index node : InnerNodes::Prescribed(model, result))
  {
    if (!std::binary_search(nodes.begin(), nodes.end(), node))
    {
      prescribed.push_back(node);
    }
  }
  if (!this->Method || this->MethodVersion != model.inputVersion || nodes != this->Sliding ||
      prescribed != this->Prescribed)
  {
    this->Method = nullptr; // in case it throws
    auto method = std::make_unique<morph::SlidingWarp>();
    method->prepare(mesh, prescribed, nodes, monitor);
    this->Method = std::move(method);
    this->MethodVersion = model.inputVersion;
    this->Sliding = nodes;
    this->Prescribed = prescribed;
  }
}

void SlideRounds::Run(const BoundaryModel& model, const std::vector<Index>& held,
  const std::vector<Index>& surfaces, int rounds, Surroundings& shapes, const WholeSurface* whole,
  const InnerNodes& inner, Surroundings::Result& result, morph::Monitor& monitor)
{
  this->Rounds.clear();
  if (surfaces.empty())
  {
    monitor.warn("SlideRounds has no effect: no surface is named that slides.");
    return;
  }
  const std::map<Index, Surfaces> sliding = slidingNodes(model, held, surfaces, result);
  std::vector<Index> nodes;
  for (const auto& [node, on] : sliding)
  {
    nodes.push_back(node);
  }
  const auto along = [&](const std::vector<Index>& numbered) -> morph::NodeSliding::Surfaces
  {
    const auto of = [&](Index i) { return sliding.find(numbered[static_cast<std::size_t>(i)]); };
    return { [&model, &shapes, of](Index i, const Row& x)
      { return directionsAt(model, of(i)->second, shapes, x); },
      [&model, &shapes, of](Index i, const Row& x)
      { return shapes.slid(model, of(i)->second, of(i)->first, x); } };
  };
  const morph::Points before = result.moved;
  if (whole)
  {
    const WholeVolume volume(*whole);
    volume.RequireNoPolyhedra("SlideRounds of vtkBoundaryDisplacement");
    morph::Points places = before(nodes, morph::allColumns);
    this->Rounds = volume.Slide(
      inner.PrescribedOnRanks(model, result, nodes), nodes, along(nodes), rounds, places, monitor);
    result.moved(nodes, morph::allColumns) = places;
  }
  else
  {
    this->Prepare(model, nodes, result, monitor);
    this->Rounds =
      this->Method->slide(along(this->Method->slidingNodes()), rounds, result.moved, monitor);
  }
  moveBetween(model, sliding, before, shapes, result.moved);
  for (const Index node : nodes)
  {
    if (result.moved.row(node) != before.row(node))
    {
      result.roles[node] = Surroundings::Follows;
    }
  }
}

void SlideRounds::Write(double size, vtkFieldData* data) const
{
  vtkNew<vtkDoubleArray> change, force;
  change->SetName(ChangeName);
  force->SetName(ForceName);
  for (const morph::SlidingWarp::Round& round : this->Rounds)
  {
    change->InsertNextValue(round.change / size);
    force->InsertNextValue(round.force);
  }
  data->AddArray(change);
  data->AddArray(force);
}

std::string SlideRounds::Report(double size) const
{
  std::ostringstream text;
  text.precision(3);
  for (std::size_t i = 0; i < this->Rounds.size(); ++i)
  {
    text << (i > 0 ? "; " : "") << "round " << i + 1 << ": moved by "
         << this->Rounds[i].change / size << " of the size, force left " << this->Rounds[i].force;
  }
  return this->Rounds.empty() ? "None" : text.str();
}
}
