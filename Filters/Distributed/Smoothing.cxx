// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Smoothing.h"

#include "Distributed/Methods.h"
#include "Untangling/MotionSmoothing.h"

namespace morph::distributed
{
void Smoothing::takeEvaluateOptions(const Morpher& serial)
{
  this->options_ = static_cast<const morph::Smoothing&>(serial).options();
}

void Smoothing::doPrepare(const Mesh&, Monitor&)
{
  const DistributedMesh& mesh = meshOf(this->processes());
  requirePrescribedBodies(mesh, this->partition());
  this->own_ = std::make_unique<OwnCells>(mesh, this->partition());
  const OwnCells& own = *this->own_;
  this->bodies_ = own.bodies();
  this->followers_.prepare(own.mesh(), own.partition(), own.communicator());
}

EvaluateReport Smoothing::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const OwnCells& own = *this->own_;
  Points displacement = Points::Zero(this->restPoints().rows(), 3);
  displacement(this->partition().prescribed, allColumns) = prescribed;
  const Points ofOwn = own.take(displacement)(own.partition().prescribed, allColumns);
  Points points;
  const MotionSmoothing::Outcome outcome =
    MotionSmoothing(own.mesh(), this->bodies_, own.orientation(), own.partition(), this->followers_,
      this->options_, nullptr, own.communicator())
      .run(ofOwn, points, monitor);
  displacement(own.nodes(), allColumns) = points - own.mesh().points;
  free = displacement(this->partition().free, allColumns);
  Monitor quiet;
  const bool isFirst = meshOf(this->processes()).ranks().rank() == 0;
  return reportSmoothing(outcome, own.gatherIds(outcome.determined), isFirst ? monitor : quiet);
}
}
