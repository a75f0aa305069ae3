// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Smoothing.h"

namespace morph
{
void Smoothing::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Communicator& processes = this->processes();
  const ConnectedComponents bodies = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(bodies, this->partition(), processes);
  this->own_ = std::make_unique<OwnCells>(
    rest, this->partition(), cellSigns(rest, bodies, monitor, processes), processes);
  const OwnCells& own = *this->own_;
  this->bodies_ = own.bodies(bodies);
  this->followers_.prepare(own.mesh(), own.partition(), own.communicator());
  this->membrane_.reset();
  if (rest.layer.isCurved())
  {
    this->membrane_ = std::make_unique<Membrane>();
    this->membrane_->warp.prepare(rest, this->partition(), monitor);
    this->membrane_->fits = ShellFits(rest, this->partition());
  }
}

EvaluateReport Smoothing::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const OwnCells& own = *this->own_;
  Points displacement = Points::Zero(this->restPoints().rows(), 3), points;
  displacement(this->partition().prescribed, allColumns) = prescribed;
  const Points ofOwn = own.take(displacement)(own.partition().prescribed, allColumns);
  const MotionSmoothing::Outcome outcome =
    MotionSmoothing(own.mesh(), this->bodies_, own.orientation(), own.partition(), this->followers_,
      this->options_, this->membrane_.get(), own.communicator())
      .run(ofOwn, points, monitor);
  displacement(own.nodes(), allColumns) = points - own.mesh().points;
  free = displacement(this->partition().free, allColumns);
  return reportSmoothing(outcome, own.gatherIds(outcome.determined), monitor);
}
}
