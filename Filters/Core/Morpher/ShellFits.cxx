// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/ShellFits.h"

#include "Mesh/Topology.h"

#include <algorithm>
#include <iterator>

namespace morph
{
ShellFits::ShellFits(
  const Mesh& rest, const NodePartition& partition, const Communicator& processes)
{
  if (!rest.layer.isCurved())
  {
    return;
  }
  Monitor serial;
  const ConnectedComponents bodies = connectedComponents(rest, serial, processes);
  const std::vector<Index> bodyOf = bodyOfNodes(rest, bodies);
  this->bodies_.resize(bodies.count);
  const auto sort = [&](const std::vector<Index>& nodes, std::vector<Index> Body::*list)
  {
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      // Nodes between front and back are where their images are put.
      if (bodyOf[nodes[i]] >= 0 && nodes[i] < 2 * rest.layer.nodes)
      {
        (this->bodies_[bodyOf[nodes[i]]].*list).push_back(static_cast<Index>(i));
      }
    }
  };
  sort(partition.prescribed, &Body::prescribed);
  sort(partition.free, &Body::free);
  const auto placesOf = [&](const std::vector<Index>& nodes, const std::vector<Index>& rows)
  {
    Points places(static_cast<Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      places.row(static_cast<Index>(i)) = rest.points.row(rest.layer.frontOf(nodes[rows[i]]));
    }
    return places;
  };
  for (Body& body : this->bodies_)
  {
    body.processes = &processes;
    std::copy_if(body.prescribed.begin(), body.prescribed.end(), std::back_inserter(body.counted),
      [&](Index i) { return processes.owns(partition.prescribed[i]); });
    body.prescribedPlaces = placesOf(partition.prescribed, body.prescribed);
    body.freePlaces = placesOf(partition.free, body.free);
    body.leastSquares =
      AffineLeastSquares(placesOf(partition.prescribed, body.counted), body.freePlaces, processes);
  }
}

std::vector<AffineFit> ShellFits::takeOff(Points& prescribed) const
{
  std::vector<AffineFit> fits;
  for (const Body& body : this->bodies_)
  {
    fits.push_back(body.leastSquares.fit(prescribed(body.counted, allColumns), *body.processes));
    for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    {
      prescribed.row(body.prescribed[i]) -=
        fits.back().displacement(body.prescribedPlaces.row(static_cast<Index>(i)));
    }
  }
  return fits;
}

void ShellFits::addTo(const std::vector<AffineFit>& fits, Points& free) const
{
  for (std::size_t b = 0; b < fits.size(); ++b)
  {
    const Body& body = this->bodies_[b];
    for (std::size_t i = 0; i < body.free.size(); ++i)
    {
      free.row(body.free[i]) += fits[b].displacement(body.freePlaces.row(static_cast<Index>(i)));
    }
  }
}

void ShellFits::transpose(const Points& free, Points& prescribed) const
{
  for (const Body& body : this->bodies_)
  {
    // u = F_x U + M (U - F_b U), hence the adjoint F_x^T g + (I - F_b^T) M^T g.
    const Points ofRest = prescribed(body.prescribed, allColumns);
    Points result = prescribed(body.counted, allColumns);
    body.leastSquares.fitTranspose(
      body.freePlaces, free(body.free, allColumns), result, *body.processes);
    body.leastSquares.fitTranspose(body.prescribedPlaces, -ofRest, result, *body.processes);
    prescribed(body.counted, allColumns) = result;
  }
}

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
