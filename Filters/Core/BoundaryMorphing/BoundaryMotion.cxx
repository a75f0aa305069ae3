// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/BoundaryMotion.h"

#include "Support/Error.h"

#include <algorithm>

namespace morph
{
Index BoundaryMotion::count(State wanted) const
{
  return std::count(this->state.begin(), this->state.end(), wanted);
}

std::vector<Index> BoundaryMotion::known() const
{
  std::vector<Index> ids;
  for (std::size_t n = 0; n < this->state.size(); ++n)
  {
    if (this->state[n] != Unknown)
    {
      ids.push_back(static_cast<Index>(n));
    }
  }
  return ids;
}

Points BoundaryMotion::moved() const
{
  Points result = this->rest;
  for (Index n = 0; n < result.rows(); ++n)
  {
    if (!this->displacement.row(n).isZero(0))
    {
      result.row(n) += this->displacement.row(n);
    }
  }
  result(this->givenIds, allColumns) = this->givenTargets;
  return result;
}

namespace
{
void validate(Index numberOfNodes, const BoundaryFaces& faces, const std::vector<Index>& ids,
  const ConstPoints& targets)
{
  if (ids.empty())
  {
    throw Error("No node of the boundary is given a new position, so nothing says where it goes. "
                "Give its vertices at least, or nodes on its curves or surfaces.");
  }
  if (static_cast<Index>(ids.size()) != targets.rows())
  {
    throw Error("There are " + std::to_string(ids.size()) + " nodes with " +
                std::to_string(targets.rows()) + " new positions; each needs one.");
  }
  std::vector<Index> wrong, inside, twice, notFinite;
  std::vector<std::uint8_t> seen(numberOfNodes, 0), isOuter(numberOfNodes, 0);
  for (const Index node : faces.nodes)
  {
    isOuter[node] = 1;
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const Index id = ids[i];
    if (id < 0 || id >= numberOfNodes)
    {
      wrong.push_back(id);
      continue;
    }
    if (!isOuter[id])
    {
      inside.push_back(id);
    }
    if (seen[id]++)
    {
      twice.push_back(id);
    }
    if (!targets.row(static_cast<Index>(i)).allFinite())
    {
      notFinite.push_back(id);
    }
  }
  const auto refuse = [](const std::vector<Index>& nodes, const char* text)
  {
    if (!nodes.empty())
    {
      throw Error(text + listIds(nodes) + ".");
    }
  };
  refuse(wrong, "Nodes are given that do not exist: ids ");
  refuse(inside, "Nodes are given that are not on the boundary; it is the boundary that is moved "
                 "here. Leave them out, ids ");
  refuse(twice, "Nodes are given more than once: ids ");
  refuse(notFinite, "New positions that are not finite (NaN or infinite) at node ids ");
}
}

BoundaryMotion beginMotion(const Mesh& rest, const BoundaryFaces& faces,
  const Classification& geometry, const std::vector<Index>& ids, const ConstPoints& targets)
{
  return beginMotion(rest.points, connectedComponents(rest).ofNode, faces, geometry, ids, targets);
}

BoundaryMotion beginMotion(const ConstPoints& rest, const std::vector<Index>& bodyOfNode,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<Index>& ids,
  const ConstPoints& targets)
{
  validate(rest.rows(), faces, ids, targets);
  BoundaryMotion motion;
  motion.rest = rest;
  motion.displacement = Points::Zero(rest.rows(), 3);
  motion.state.assign(rest.rows(), BoundaryMotion::Unknown);
  motion.bodyOfNode = bodyOfNode;
  motion.givenIds = ids;
  motion.givenTargets = targets;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    motion.state[ids[i]] = BoundaryMotion::Given;
    motion.displacement.row(ids[i]) = targets.row(static_cast<Index>(i)) - rest.row(ids[i]);
  }
  for (const GeometryVertex& vertex : geometry.vertices)
  {
    std::uint8_t& state = motion.state[vertex.node];
    state = state == BoundaryMotion::Unknown ? std::uint8_t(BoundaryMotion::Held) : state;
  }
  return motion;
}
}
