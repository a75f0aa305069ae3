// SPDX-License-Identifier: BSD-3-Clause
// What Internals do with zones and layers, which have nodes inside of the mesh.
#include "Private/Displace/Internals.h"

#include "Private/Data/GridMesh.h"
#include "Private/Displace/DisplacedSurface.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkUnstructuredGrid.h>

#include <optional>

namespace filters = morph::filters;

namespace
{
std::vector<std::uint8_t> layerCells(vtkUnstructuredGrid* grid, const std::string& name)
{
  vtkDataArray* array = grid->GetCellData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    throw morph::Error("`LayersArray` names '" + name + "', which is no cell array of the input.");
  }
  return filters::Chosen::Marked(array);
}
}

void vtkDisplacementAlgorithm::vtkInternals::ListZones()
{
  for (const filters::ListedZone& zone : this->Model.Parts())
  {
    this->ZoneList->AddArray(zone.Name.c_str(), false);
    this->ZoneSizes->InsertNextValue(zone.Name);
    for (const morph::Index count : { zone.CellCount, zone.Nodes })
    {
      this->ZoneSizes->InsertNextValue(count > 0 ? std::to_string(count) : "");
    }
  }
}

filters::Zones::Options vtkDisplacementAlgorithm::vtkInternals::ZoneOptions(
  const Options& options, vtkSelection* zone)
{
  filters::Zones::Options zones;
  zones.Fixed = options.FixedZones;
  zones.Rigid = options.RigidZones;
  zones.Region = this->ZoneRegion;
  zones.RegionKind = options.ZoneRegionType;
  zones.SelectionKind = options.ZoneSelectionType;
  if (options.ZoneSelectionType != ZONE_NONE)
  {
    zones.Selection = this->ZoneSelected.OfGrid(this->Blocks, zone, this->Extractor);
  }
  zones.Extractor = this->Extractor;
  return zones;
}

std::vector<filters::Zones::Part> vtkDisplacementAlgorithm::vtkInternals::FindZones(
  filters::Zones::Kind kind, vtkUnstructuredGrid* grid, const filters::Zones::Options& zones) const
{
  const filters::MergedBlocks* blocks = this->Blocks.Merged();
  if (this->Whole)
  {
    return filters::Zones::FindOnRanks(kind, grid, *this->Whole, blocks, zones);
  }
  const bool isMesh = this->Model.mesh.numberOfCells() > 0; // or the faces of a shell
  return filters::Zones::Find(
    kind, grid, isMesh ? this->Model.mesh : filters::GridMesh::FromGrid(grid), blocks, zones);
}

void vtkDisplacementAlgorithm::vtkInternals::FindInner(const Options& options,
  vtkUnstructuredGrid* grid, const filters::Zones::Options& zones,
  morph::BoundaryMover::Options& mover) const
{
  mover.inner.keepLayers = options.KeepLayers;
  mover.inner.layersName = options.LayersArray;
  if (!zones.Any() && mover.inner.keepLayers == 0)
  {
    return;
  }
  if (!grid)
  {
    throw morph::Error(
      "Zones and layers have inner nodes, and the input is a surface, or a shell that goes to its "
      "target as a whole. Give the volume mesh to this filter or, of a shell, tick the edges that "
      "move.");
  }
  const auto find = [&](filters::Zones::Kind kind)
  {
    const std::vector<filters::Zones::Part> parts = this->FindZones(kind, grid, zones);
    return std::vector<morph::Zone>(parts.begin(), parts.end());
  };
  mover.fixedZones = find(filters::Zones::Fixed);
  mover.rigidZones = find(filters::Zones::Rigid);
  if (this->RigidTransform)
  {
    const double factor = options.ScaleFactor;
    std::optional<morph::AffineMotion> part;
    if (const auto whole = filters::Motion::OfTransform(this->RigidTransform); whole && factor != 1)
    {
      part = morph::partOf(*whole, Eigen::RowVector3d::Zero(), factor);
    }
    mover.inner.rigid = [this, factor, part](const Eigen::RowVector3d& x) -> Eigen::RowVector3d
    {
      if (part)
      {
        return x + part->col(0).transpose() + x * part->rightCols<3>().transpose();
      }
      Eigen::RowVector3d to;
      this->RigidTransform->TransformPoint(x.data(), to.data());
      return factor == 1 ? to : Eigen::RowVector3d(x + factor * (to - x));
    };
  }
  const auto takeLayers = [&]
  {
    // Of several processes those without cells have no arrays.
    if (!mover.inner.layersName.empty() && !(this->Whole && grid->GetNumberOfCells() == 0))
    {
      mover.inner.isLayer = layerCells(grid, mover.inner.layersName);
    }
  };
  this->Whole ? filters::Ranks::Together(takeLayers) : takeLayers();
}

void vtkDisplacementAlgorithm::vtkInternals::AppendInner(
  vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  const morph::Surroundings::Result& result = this->Mover.result();
  const std::vector<morph::Index> nodes = morph::InnerNodes::placedInside(this->Model, result);
  std::vector<signed char> roles;
  for (const morph::Index node : nodes)
  {
    roles.push_back(result.roles[node]);
  }
  filters::DisplacedSurface::AppendInner(grid, this->Mover.inner().pointsOf(this->Model, nodes),
    this->Mover.inner().rest(this->Model)(nodes, morph::allColumns),
    result.moved(nodes, morph::allColumns), roles, output);
  if (this->Whole)
  {
    this->Whole->MakeIdsGlobal(output, static_cast<vtkIdType>(nodes.size()));
  }
}
