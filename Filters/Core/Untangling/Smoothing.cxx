// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Smoothing.h"

namespace morph
{
void Smoothing::doPrepare(const Mesh& rest, Monitor& monitor)
{
  this->bodies_ = connectedComponents(rest);
  requirePrescribedBodies(rest, this->bodies_, this->partition());
  this->orientation_ = cellSigns(rest, this->bodies_);
  this->mesh_ = rest;
  this->followers_.prepare(rest, this->partition(), Communicator::alone());
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
  Points points;
  const MotionSmoothing::Outcome outcome = MotionSmoothing(this->mesh_, this->bodies_,
    this->orientation_, this->partition(), this->followers_, this->options_, this->membrane_.get())
                                             .run(prescribed, points, monitor);
  for (Index i = 0; i < free.rows(); ++i)
  {
    const Index node = this->partition().free[i];
    free.row(i) = points.row(node) - this->mesh_.points.row(node);
  }
  return reportSmoothing(outcome, outcome.determined, monitor);
}
}
