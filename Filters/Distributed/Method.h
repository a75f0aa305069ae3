// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/NodePartition.h"
#include "Morpher/Morpher.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph::distributed
{
/// A morphing method on a distributed mesh: morph::Morpher's contract, where all functions are
/// collective. The free nodes that a rank owns are its unknowns.
class Method
{
public:
  virtual ~Method();

  /// The layers of ghost cells that the method reads.
  virtual int layers() const { return 1; }

  /// Takes the options that evaluate() reads from the serial method of the same name. It sets no
  /// option that prepare() reads.
  virtual void takeEvaluateOptions(const Morpher& serial) = 0;

  /// See morph::Morpher::setReference(). #local nodes x 3.
  virtual void setReference(Points) {}

  /// Prepares the method. `partition`: of mesh.mesh(), with the owner's choice at ghosts. `mesh`
  /// has to outlive this object's use. Throws Error on all ranks.
  void prepare(const DistributedMesh& mesh, const NodePartition& partition, Monitor& monitor);

  /// Moves the mesh. `prescribed`: #prescribed x 3 new positions of the local partition's nodes.
  /// `moved`: becomes #local nodes x 3, ghosts as their owners have them. Throws Error on all
  /// ranks. The counts in the report are those of the whole mesh.
  EvaluateReport evaluate(const Points& prescribed, Points& moved, Monitor& monitor) const;

  /// The displacement of each node, as LinearMorpher::basis() has it. `prescribed`: #prescribed x 3
  /// displacements. `field`: becomes #local nodes x 3, ghosts as their owners have them. Throws
  /// Error on all ranks.
  EvaluateReport mode(const Points& prescribed, Points& field, Monitor& monitor) const;

  /// morph::LinearMorpher::applyTranspose(). `gradient`: #local nodes x 3, read at the nodes that
  /// this rank owns. `prescribed`: becomes #prescribed x 3, the derivatives at the nodes that this
  /// rank owns, and zero at the others. Throws Error on all ranks.
  EvaluateReport applyTranspose(const Points& gradient, Points& prescribed, Monitor& monitor) const;

  const NodePartition& partition() const { return this->partition_; }

protected:
  virtual void doPrepare(Monitor& monitor) = 0;
  /// `prescribed`: #prescribed x 3 displacements of local nodes; `free`: #ownFree x 3, receives
  /// displacements.
  virtual EvaluateReport displace(
    const Points& prescribed, Points& free, Monitor& monitor) const = 0;

  /// Adds M^T free to rows of `prescribed`, #prescribed x 3: those of ghosts are added to their
  /// owners' afterwards. `free`: #ownFree x 3.
  virtual EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const = 0;

  const DistributedMesh& mesh() const { return *this->mesh_; }
  /// The free nodes that this rank owns, ascending.
  const std::vector<Index>& ownFree() const { return this->ownFree_; }

private:
  const DistributedMesh* mesh_ = nullptr;
  NodePartition partition_;
  std::vector<Index> ownFree_;
  HigherOrderNodes higherOrderNodes_;
};

/// Throws Error on all ranks unless each body of the mesh has a prescribed corner. Collective.
void requirePrescribedBodies(const DistributedMesh& mesh, const NodePartition& partition);
}
