// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Choice.h"

#include "BoundaryMover/Patches.h"
#include "Mesh/ShellLayer.h"

#include <algorithm>
#include <utility>

namespace morph
{
namespace
{
void addNodesBetween(const BoundaryFaces& faces, std::vector<std::uint8_t>& isChosen)
{
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index *begin = faces.between.begin(static_cast<Index>(i)),
                *end = faces.between.end(static_cast<Index>(i));
    if (begin != end && std::all_of(begin, end, [&](Index n) { return isChosen[n] != 0; }))
    {
      isChosen[faces.nodes[i]] = 1;
    }
  }
}

std::vector<std::uint8_t> facesWithin(
  const BoundaryFaces& faces, const std::vector<std::uint8_t>& isChosen)
{
  std::vector<std::uint8_t> isWithin(faces.offsets.size() - 1);
  for (std::size_t f = 0; f < isWithin.size(); ++f)
  {
    isWithin[f] = std::all_of(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1], [&](Index n) { return isChosen[n] != 0; });
  }
  return isWithin;
}

Choice choose(const BoundaryModel& model, const std::vector<std::uint8_t>& isMoving,
  const std::set<std::string>& heldNames)
{
  const PatchPart held = findPatches(model, heldNames, "FixedSurfaces");
  Choice result;
  for (const Index node : model.faces.nodes)
  {
    if (isMoving[node])
    {
      result.moving.push_back(node);
    }
    else if (held.hasNode[node])
    {
      result.held.push_back(node);
    }
  }
  return result;
}
}

TargetOfNode targetsOf(const Choice& choice, const Points& targets)
{
  TargetOfNode moving;
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    moving[choice.moving[i]] = targets.row(static_cast<Index>(i));
  }
  return moving;
}

void setMoving(const TargetOfNode& moving, Choice& choice, Points& targets)
{
  choice.moving.clear();
  targets.resize(static_cast<Index>(moving.size()), 3);
  for (const auto& [node, to] : moving)
  {
    targets.row(static_cast<Index>(choice.moving.size())) = to;
    choice.moving.push_back(node);
  }
}

void markMovingFaces(const BoundaryFaces& faces, Choice& choice)
{
  const auto corner = faces.connectivity.begin();
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    choice.isMovingFace[f] =
      choice.isMovingFace[f] ||
      std::all_of(corner + faces.offsets[f], corner + faces.offsets[f + 1],
        [&](Index node)
        { return std::binary_search(choice.moving.begin(), choice.moving.end(), node); });
  }
}

bool Choice::operator==(const Choice& other) const
{
  return this->moving == other.moving && this->held == other.held &&
         this->isMovingFace == other.isMovingFace;
}

Choice choosePatches(const BoundaryModel& model, const std::set<std::string>& moving,
  const std::set<std::string>& held)
{
  PatchPart part = findPatches(model, moving, "Surfaces");
  addNodesBetween(model.faces, part.hasNode);
  Choice result = choose(model, part.hasNode, held);
  result.isMovingFace = std::move(part.hasFace);
  return result;
}

Choice chooseNodes(
  const BoundaryModel& model, std::vector<std::uint8_t> isMoving, const std::set<std::string>& held)
{
  markImages(model.mesh.layer, isMoving);
  const std::vector<std::uint8_t> isOnSheet = model.nodesOnlyOn(model.sheets());
  for (std::size_t n = 0; n < isOnSheet.size(); ++n)
  {
    isMoving[n] = isMoving[n] && !isOnSheet[n];
  }
  addNodesBetween(model.faces, isMoving);
  Choice result = choose(model, isMoving, held);
  result.isMovingFace = facesWithin(model.faces, isMoving);
  return result;
}
}
