// SPDX-License-Identifier: BSD-3-Clause
#include "Session/UndeformedMesh.h"

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/SharedCorners.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Morpher/SiteMethod.h"
#include "Quality/Certificate.h"
#include "Support/Error.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

namespace morph
{
UndeformedMesh::UndeformedMesh(Mesh given, const UndeformedMesh* sameCells, Monitor& monitor)
  : mesh_(std::make_shared<Mesh>(std::move(given)))
{
  const Mesh& mesh = *this->mesh_;
  requireVolumeCells(mesh);
  this->findBodies(monitor);
  // Where nodes hang depends on the points.
  const bool hasOuter = sameCells && sameCells->hanging_.empty();
  this->outer_ = hasOuter ? sameCells->outer_ : boundaryFaces(mesh, this->hanging_, monitor);
  this->needsPieces_ = morph::needsPieces(mesh, this->hanging_);
  if (sameCells)
  {
    this->repeated_ = sameCells->repeated_;
    this->unmapped_ = sameCells->unmapped_;
    this->touching_ = sameCells->touching_;
  }
  else
  {
    if (std::find(mesh.types.begin(), mesh.types.end(), PolyVertex) != mesh.types.end())
    {
      this->repeated_ = morph::repeatedCells(mesh, monitor);
    }
    this->unmapped_ = morph::unmappedCells(mesh);
    this->findTouching(this->outer_);
  }
  this->size_ = meshSize(mesh);
}

UndeformedMesh::UndeformedMesh(Part part, Monitor& monitor)
  : mesh_(std::move(part.mesh))
  , processes_(std::move(part.processes))
  , hanging_(std::move(part.hanging))
  , size_(part.size)
  , needsPieces_(part.needsPieces)
{
  const Mesh& mesh = *this->mesh_;
  const Communicator& processes = *this->processes_;
  this->findBodies(monitor);
  BoundaryFaces faces;
  processes.together(
    [&]
    {
      faces = facesOfOneCell(mesh, monitor);
      if (!this->hanging_.empty())
      {
        faces = boundaryFaces(mesh, faces, this->hanging_);
      }
      this->repeated_ = morph::repeatedCells(mesh, monitor);
      this->unmapped_ = morph::unmappedCells(mesh);
      this->findTouching(faces);
    });
  this->repeated_ = processes.gatherCells(this->repeated_);
  this->unmapped_ = processes.gatherCells(this->unmapped_);
  this->touching_.erase(std::remove_if(this->touching_.begin(), this->touching_.end(),
                          [&](Index node) { return !processes.owns(node); }),
    this->touching_.end());
  this->touching_ = processes.gatherNodes(this->touching_);
  std::vector<std::uint8_t> isOwn(mesh.numberOfCells(), 0), isOfOwn(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    isOwn[c] = !processes.isCopy(c);
    for (Index k = 0; k < mesh.cellSize(c) && isOwn[c] != 0; ++k)
    {
      isOfOwn[mesh.cell(c)[k]] = 1;
    }
  }
  this->outer_ = facesOfCells(mesh, faces, isOwn);
  this->hanging_.divideEdges(this->outer_);
  // All cells around a node of own cells are here, so that its faces are known.
  Adjacency& between = this->outerNodes_.between;
  between.offsets = { 0 };
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i);
    if (isOfOwn[faces.nodes[i]] != 0)
    {
      this->outerNodes_.nodes.push_back(faces.nodes[i]);
      between.add(faces.between.begin(k), faces.between.end(k));
    }
  }
}

void UndeformedMesh::findBodies(Monitor& monitor)
{
  const Mesh& mesh = *this->mesh_;
  const Communicator& processes = this->all();
  const ConnectedComponents bodies = connectedComponents(mesh, monitor, processes);
  this->orientation_ = cellSigns(mesh, bodies, monitor, processes);
  this->mirrored_ = morph::mirroredBodies(bodies, this->orientation_, processes);
  if (this->mirrored_ > 0)
  {
    std::vector<Index> mirrored;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (this->orientation_[c] < 0 && !processes.isCopy(c))
      {
        mirrored.push_back(c);
      }
    }
    mirrored = processes.idsOfCells(mirrored);
    constexpr double Most = 9e15; // above all ids
    this->firstMirrored_ =
      static_cast<Index>(processes.minimum(std::accumulate(mirrored.begin(), mirrored.end(), Most,
        [](double least, Index id) { return std::min(least, static_cast<double>(id)); })));
  }
  if (bodies.count > 1 && !this->processes_)
  {
    this->bodyOfNode_ = bodyOfNodes(mesh, bodies);
  }
}

void UndeformedMesh::findTouching(const BoundaryFaces& faces)
{
  const Mesh& mesh = *this->mesh_;
  this->touching_ = this->hanging_.empty()
                      ? morph::touchingNodes(mesh, faces)
                      : morph::touchingNodes(this->hanging_.conforming(mesh), faces);
}

std::vector<Index> UndeformedMesh::prescribedFor(const std::vector<Index>& ids) const
{
  if (!ids.empty() && (ids.front() < 0 || ids.back() >= this->mesh_->numberOfNodes()))
  {
    return ids; // partitionNodes() names those that do not exist
  }
  std::vector<Index> result = this->hanging_.without(ids);
  if (this->bodyOfNode_.empty())
  {
    return result;
  }
  std::vector<std::uint8_t> isAsked(this->bodyOfNode_.size(), 0); // there are fewer bodies
  for (const Index id : ids)
  {
    if (this->bodyOfNode_[id] >= 0)
    {
      isAsked[this->bodyOfNode_[id]] = 1;
    }
  }
  const auto known = static_cast<std::ptrdiff_t>(result.size());
  for (std::size_t n = 0; n < this->bodyOfNode_.size(); ++n)
  {
    if (this->bodyOfNode_[n] >= 0 && isAsked[this->bodyOfNode_[n]] == 0)
    {
      result.push_back(static_cast<Index>(n));
    }
  }
  std::inplace_merge(result.begin(), result.begin() + known, result.end());
  return result;
}

std::unique_ptr<Morpher> UndeformedMesh::fitted(std::unique_ptr<Morpher> method) const
{
  if (this->processes_)
  {
    method = onProcesses(std::move(method));
    if (!method)
    {
      throw Error("The method needs one MPI rank, and the mesh is distributed over several.");
    }
  }
  else if (!this->bodyOfNode_.empty() && method->copyWithoutCells())
  {
    method = std::make_unique<BodyByBody>(std::move(method));
  }
  return this->needsPieces_ ? morpherForPolyhedra(std::move(method), false, this->hanging_)
                            : std::move(method);
}

const InvertedBefore& UndeformedMesh::before(Monitor& monitor) const
{
  if (!this->before_)
  {
    const Mesh& mesh = *this->mesh_;
    std::vector<std::uint8_t> skip(this->processes_ ? mesh.numberOfCells() : 0);
    for (std::size_t c = 0; c < skip.size(); ++c)
    {
      const CellShape* shape = cellShape(mesh.types[c]);
      skip[c] = !shape || shape->dimension < 3; // a part may have no volume cells
    }
    this->before_.emplace(mesh, this->orientation_,
      measureQuality(mesh, mesh.points, this->orientation_, skip, monitor));
  }
  return *this->before_;
}

const std::vector<Index>& UndeformedMesh::onLinearEdges() const
{
  if (!this->onLinearEdges_)
  {
    this->onLinearEdges_ = nodesOnLinearEdges(*this->mesh_, this->outer_);
  }
  return *this->onLinearEdges_;
}

const WholeBoundary& UndeformedMesh::boundary() const
{
  if (!this->boundary_)
  {
    this->boundary_.emplace(*this->mesh_, this->outer_, this->orientation_, this->all());
  }
  return *this->boundary_;
}

void warnOfMirrored(Index bodies, Index first, Monitor& monitor)
{
  if (bodies > 0)
  {
    monitor.warn("The mesh has mirrored bodies (" + std::to_string(bodies) +
                 "): in VTK's order of nodes all their cells of a type are inverted, the first is "
                 "cell " +
                 std::to_string(first) +
                 ". They are morphed and measured as if they were not. Reverse their order of "
                 "nodes if a solver expects VTK's.");
  }
}

void warnOfShared(const std::vector<Index>& repeatedCells, const std::vector<Index>& touchingNodes,
  Monitor& monitor)
{
  if (!repeatedCells.empty())
  {
    monitor.warn("Cells are there twice: cell ids " + listIds(repeatedCells) +
                 ". The first of each counts. Remove the others.");
  }
  if (!touchingNodes.empty())
  {
    monitor.warn(std::to_string(touchingNodes.size()) +
                 " nodes belong to parts of the mesh that share no face there, and so move as one: "
                 "point ids " +
                 listIds(touchingNodes) +
                 ". Give each part a node of its own if they only touch by chance.");
  }
}

void warnOfUnrecognized(const std::vector<Index>& cells, Monitor& monitor)
{
  if (!cells.empty())
  {
    monitor.warn("Cells name a node more than once in a way that makes no cell of a known type: "
                 "cell ids " +
                 listIds(cells) +
                 ". They count as degenerate, however they move, and methods see them "
                 "approximately. Divide them into other cells.");
  }
}

void warnOfParting(const Parting& parting, Monitor& monitor)
{
  if (!parting.nodes.empty())
  {
    std::ostringstream largest;
    largest << parting.largest;
    monitor.warn("Quadratic cells part from linear ones beside them by up to " + largest.str() +
                 ": what moves takes nodes between corners off edges that are straight on the "
                 "other side. Point ids " +
                 listIds(parting.nodes) + ". Make the cells on both sides linear or quadratic.");
  }
}

void warnOfUnmapped(const std::vector<Index>& cells, Monitor& monitor)
{
  if (!cells.empty())
  {
    monitor.warn("Quality is that of the corners in " + std::to_string(cells.size()) +
                 " cells of higher order, whose validity between them is undecided: cell ids " +
                 listIds(cells) + ".");
  }
}

std::vector<Index> droppedTargets(
  const BoundaryTargets& boundary, const HangingNodes& hanging, const Points& moved, double size)
{
  std::vector<Index> nodes;
  for (std::size_t k = 0; k < boundary.ids.size() && !hanging.nodes().empty(); ++k)
  {
    const Index node = boundary.ids[k];
    const auto target = boundary.targets.row(static_cast<Index>(k));
    if (hanging.hangs(node) && (moved.row(node) - target).norm() > 1e-6 * size)
    {
      nodes.push_back(node);
    }
  }
  return nodes;
}

std::string noteOfDropped(const std::vector<Index>& ids)
{
  if (ids.empty())
  {
    return {};
  }
  return std::to_string(ids.size()) +
         " nodes of the boundary are not where it puts them: they hang on faces that are divided "
         "on "
         "one side alone, and follow these, so that no gap opens. Point ids " +
         listIds(ids) + ". Refine both sides alike where the boundary moves so.";
}

void warnOfLoose(const std::vector<Index>& nodes, Monitor& monitor)
{
  if (!nodes.empty())
  {
    monitor.warn(std::to_string(nodes.size()) +
                 " nodes stay: they belong to cells of lower dimension that share no node with a "
                 "volume cell, directly or by others of their kind. Point ids " +
                 listIds(nodes) + ". Give them nodes of the volume where they are attached to it.");
  }
}
}
