// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/Followers.h"

#include <algorithm>
#include <iterator>

namespace morph
{
void Followers::prepare(
  const Mesh& rest, const NodePartition& partition, const Communicator& processes)
{
  this->nodes_.prepare(rest, partition);
  this->moved_ = {};
  this->fits_ = {};
  if (rest.layer.isCurved() && !processes.all(this->empty()))
  {
    this->moved_.prescribed = partition.prescribed;
    this->moved_.higherOrderNodes = partition.higherOrderNodes;
    std::merge(partition.free.begin(), partition.free.end(), partition.higherOrderNodes.begin(),
      partition.higherOrderNodes.end(), std::back_inserter(this->moved_.free));
    this->fits_ = ShellFits(rest, this->moved_, processes);
  }
}

void Followers::apply(Points& displacement) const
{
  if (this->fits_.empty())
  {
    this->nodes_.apply(displacement);
    return;
  }
  const std::vector<Index>&prescribed = this->moved_.prescribed, &free = this->moved_.free;
  const Points given = displacement(prescribed, allColumns);
  Points rest = given, affine = Points::Zero(static_cast<Index>(free.size()), 3);
  this->fits_.addTo(this->fits_.takeOff(rest), affine);
  displacement(prescribed, allColumns) = rest;
  displacement(free, allColumns) -= affine;
  this->nodes_.apply(displacement);
  displacement(free, allColumns) += affine;
  displacement(prescribed, allColumns) = given;
}

void Followers::applyTranspose(Points& gradient) const
{
  const Points given = gradient;
  this->nodes_.applyTranspose(gradient);
  if (this->fits_.empty())
  {
    return;
  }
  const std::vector<Index>&prescribed = this->moved_.prescribed, &free = this->moved_.free;
  const Points ofAffine = given(free, allColumns) - gradient(free, allColumns);
  Points ofRest = gradient(prescribed, allColumns) - given(prescribed, allColumns);
  this->fits_.transpose(ofAffine, ofRest);
  gradient(prescribed, allColumns) = given(prescribed, allColumns) + ofRest;
}
}
