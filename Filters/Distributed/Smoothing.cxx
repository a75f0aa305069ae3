// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Smoothing.h"

#include "Support/Error.h"
#include "Untangling/MotionSmoothing.h"

namespace morph::distributed
{
void Smoothing::takeEvaluateOptions(const Morpher& serial)
{
  this->options_ = static_cast<const morph::Smoothing&>(serial).options();
}

void Smoothing::doPrepare(Monitor&)
{
  const DistributedMesh& mesh = this->mesh();
  requirePrescribedBodies(mesh, this->partition());
  mesh.ranks().together(
    [&]
    {
      this->own_ = std::make_unique<OwnCells>(mesh, this->partition());
      this->bodies_ = this->own_->bodies();
    });
  const OwnCells& own = *this->own_;
  own.communicator().run(
    [&] { this->followers_.prepare(own.mesh(), own.partition(), own.communicator()); });
}

EvaluateReport Smoothing::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const OwnCells& own = *this->own_;
  Points displacement = Points::Zero(mesh.mesh().numberOfNodes(), 3);
  displacement(this->partition().prescribed, allColumns) = prescribed;
  MotionSmoothing::Outcome outcome;
  own.communicator().run(
    [&]
    {
      const Points ofOwn = own.take(displacement)(own.partition().prescribed, allColumns);
      Points points;
      outcome = MotionSmoothing(own.mesh(), this->bodies_, own.orientation(), own.partition(),
        this->followers_, this->options_, own.communicator())
                  .run(ofOwn, points, monitor);
      displacement(own.nodes(), allColumns) = points - own.mesh().points;
    });
  free = displacement(this->ownFree(), allColumns);
  Monitor quiet;
  return reportSmoothing(
    outcome, own.gatherIds(outcome.determined), mesh.ranks().rank() == 0 ? monitor : quiet);
}

EvaluateReport Smoothing::displaceTranspose(const Points&, Points&, Monitor&) const
{
  throw Error("Smoothing is not linear, so it has no adjoint that is the same for all motions. Use "
              "a method that is, FEMWARP for instance.");
}
}
