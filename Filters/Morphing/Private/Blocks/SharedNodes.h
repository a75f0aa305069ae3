// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace morph::filters
{
/// Numbers the nodes of blocks, whose points at one place are one node.
class SharedNodes
{
public:
  struct Points
  {
    const morph::Points& Places;
    /// A number for each point that is the same for all points of one node, or nothing.
    std::vector<Index> Ids;
    /// Whether points of this block among themselves may be one node. Off, a crack inside the block
    /// stays open.
    bool MergesWithin = false;
    /// Points of different groups are never one node, wherever they are.
    Index Group = 0;
  };

  /// Adds the points of one block and returns the node of each. Points with numbers are one node
  /// where these are equal; all others where their coordinates are, bit by bit (0 and -0 are
  /// equal). Cost: one look-up a point.
  std::vector<Index> Add(const Points& block);

  /// The node at the place of each point, -1 where there is none. Of several nodes at one place:
  /// the one with the point's number, or the first.
  std::vector<Index> Find(const Points& block) const;

  Index Number() const { return static_cast<Index>(this->Nodes.size()); }
  /// A number that two points at different places have: farther apart than `tolerance`.
  std::optional<Index> Contradiction(double tolerance) const;
  /// How many nodes are at the place of another block's node, with another number.
  Index Coinciding() const { return this->Parted; }
  /// The first node at the place of each node. `isSplit`: becomes 1 for nodes at a place that has
  /// several, none of them with a number.
  std::vector<Index> Places(std::vector<std::uint8_t>& isSplit) const;
  /// The nodes in ascending order of their numbers; empty where a node has none.
  std::vector<Index> Order() const;

private:
  struct Place
  {
    double X[3];
    bool operator==(const Place& other) const
    {
      return this->X[0] == other.X[0] && this->X[1] == other.X[1] && this->X[2] == other.X[2];
    }
  };
  struct Hash
  {
    std::size_t operator()(const Place& place) const;
  };
  struct Node
  {
    Index Id = -1; ///< or -1
    Index Group = 0;
    Index Block = -1; ///< the last one that has it
    Index Next = -1;  ///< at the same place
  };
  /// The nodes at one place, as a list, and how far the present block has used them.
  struct List
  {
    Index First, Last, Cursor, Block;
  };

  static Place PlaceOf(const morph::Points& points, Index row);
  Index NewNode(const Place& place, List& list, Index group, Index id);
  /// The first node of the list that the present block may share, or -1.
  Index Sharable(List& list, const Points& block, bool needsFree);

  Index Block = -1; ///< the present one
  std::vector<Node> Nodes;
  std::vector<Place> Spots; ///< of the nodes
  std::unordered_map<Place, List, Hash> Lists;
  std::unordered_map<Index, Index> ById;
  struct Difference
  {
    Index Id;
    double Distance;
  };
  Index Parted = 0;
  std::optional<Difference> Worst; ///< of points with one number
};
}
