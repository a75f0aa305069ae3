// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/CutMesh.h"

#include "Morpher/CellStiffness.h"
#include "Morpher/Morpher.h"

#include <memory>

namespace morph::distributed
{
/// A method on a distributed mesh with polyhedra, or with nodes that hang: another method on the
/// pieces of cells, as morph::morpherForPolyhedra() has it. It has an adjoint if that has one.
class PolyhedralMethod : public LinearMorpher
{
public:
  /// `method`: with the options that prepare() reads, not prepared.
  explicit PolyhedralMethod(std::unique_ptr<Morpher> method);

  void takeEvaluateOptions(const Morpher& serial) override;
  void setReference(Points reference) override;
  int layers() const override { return 1; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  std::unique_ptr<Morpher> method_;
  CellStiffness stiffness_; ///< with values of the cells that the pieces are cut from
  Points reference_;
  std::unique_ptr<CutMesh> cut_;
};
}
