// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre: Input::TakeMesh() refuses meshes on several ranks before this.
#include "Private/Distributed/WholeSurface.h"
#include "Private/Distributed/WholeVolume.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <stdexcept>

namespace morph::filters
{
namespace
{
[[noreturn]] void refuse()
{
  throw std::logic_error("This build has no MPI.");
}
}

class WholeSurface::Internals
{
};

WholeSurface::WholeSurface() = default;

WholeSurface::~WholeSurface() = default;

void WholeSurface::Take(vtkUnstructuredGrid*, morph::Monitor&)
{
  refuse();
}

vtkUnstructuredGrid* WholeSurface::Grid() const
{
  refuse();
}

const morph::Mesh& WholeSurface::Mesh() const
{
  refuse();
}

const morph::BoundaryFaces& WholeSurface::Faces() const
{
  refuse();
}

const std::vector<morph::Index>& WholeSurface::BodyOfNode() const
{
  refuse();
}

const std::vector<std::int8_t>& WholeSurface::Orientation() const
{
  refuse();
}

double WholeSurface::Size() const
{
  refuse();
}

std::size_t WholeSurface::Bytes() const
{
  refuse();
}

const RankMesh& WholeSurface::Pieces() const
{
  refuse();
}

morph::Index WholeSurface::NumberOfBodies() const
{
  refuse();
}

std::vector<morph::Index> WholeSurface::Places() const
{
  refuse();
}

morph::Index WholeSurface::NodeOf(std::int64_t) const
{
  refuse();
}

const std::vector<std::int64_t>& WholeSurface::NodeIds() const
{
  refuse();
}

const std::vector<std::int64_t>& WholeSurface::CellIds() const
{
  refuse();
}

morph::BoundaryTargets WholeSurface::Match(vtkPointSet*, const BoundaryMatch::Options&) const
{
  refuse();
}

void WholeSurface::Together(const std::function<void()>&) const
{
  refuse();
}

std::vector<std::uint8_t> WholeSurface::AnyFlags(const std::vector<std::uint8_t>&) const
{
  refuse();
}

void WholeSurface::KeepOwn(vtkPolyData*) const
{
  refuse();
}

void WholeSurface::MakeIdsGlobal(vtkPolyData*, vtkIdType) const
{
  refuse();
}

vtkSmartPointer<vtkPolyData> WholeSurface::OfPiece(vtkPolyData*) const
{
  refuse();
}

std::vector<std::int64_t> WholeSurface::IdsOfPiece(const std::vector<morph::Index>&) const
{
  refuse();
}

std::pair<double, double> WholeSurface::MaximumAndMean(
  const std::vector<std::int64_t>&, const std::vector<double>&) const
{
  refuse();
}

vtkSmartPointer<vtkPolyData> WholeSurface::Gather(vtkPolyData*)
{
  refuse();
}

WholeVolume::WholeVolume(const WholeSurface& surface)
  : Surface(surface)
{
}

const morph::Mesh& WholeVolume::Piece() const
{
  refuse();
}

WholeVolume::Flags WholeVolume::AnyFlags(const Flags&) const
{
  refuse();
}

std::vector<morph::Index> WholeVolume::OwnInner(const Flags&) const
{
  refuse();
}

void WholeVolume::RequireNoPolyhedra(const char*) const
{
  refuse();
}

WholeVolume::Columns WholeVolume::FindLayers(const Flags&, morph::Index, const Flags&) const
{
  refuse();
}

WholeVolume::Moved WholeVolume::Warp(const Prescribed&, const Flags&, morph::Monitor&) const
{
  refuse();
}

std::vector<morph::NodeSliding::Round> WholeVolume::Slide(const Prescribed&,
  const std::vector<morph::Index>&, const morph::NodeSliding::Surfaces&, int, morph::Points&,
  morph::Monitor&) const
{
  refuse();
}
}
