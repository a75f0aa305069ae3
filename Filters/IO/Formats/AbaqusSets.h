// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/Numbering.h"
#include "Formats/SolverMesh.h"

#include <array>
#include <list>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace morph::io
{
/// The sets and surfaces of an Abaqus or CalculiX input file while it is read. Sets may name
/// others, and elements that come later. Names are compared without case.
class AbaqusSets
{
public:
  struct Entries
  {
    std::vector<Index> numbers;
    std::vector<std::array<Index, 3>> ranges; ///< first, last, step
    std::vector<std::string> names;           ///< of other sets, in upper case
  };
  /// Element number or set name, and face: "S3".
  using Surface = std::vector<std::pair<std::string, std::string>>;

  /// The entries to add to; null for an empty name. They stay where they are.
  Entries* nodeSet(const std::string& name) { return entriesOf(this->nodeSets_, name); }
  Entries* elementSet(const std::string& name) { return entriesOf(this->elementSets_, name); }
  Surface* surface(const std::string& name, bool ofNodes);
  /// Adds the sets of a part as those of an instance of it: "Block-1.Top". `nodes`, `elements`:
  /// what is added to its numbers.
  void addInstance(const AbaqusSets& part, const std::string& name, Index nodes, Index elements);
  /// A node set gets the nodes of an element set.
  void addNodesOf(const std::string& elementSet, const std::string& nodeSet);

  /// Adds all sets to a mesh, with the faces of surfaces as cells. `nodes`, `elements`: those of
  /// the mesh. `arePlane`: see AbaqusElement, of each cell. Numbers of elements that the file does
  /// not define are left out, as they may be of a type that is. So are numbers of nodes, surfaces
  /// with a side that its element lacks, and sets and surfaces that name a set that the file does
  /// not define; a warning of the mesh says so.
  void addTo(SolverMesh& mesh, const Numbering& nodes, const Numbering& elements,
    const std::vector<std::uint8_t>& arePlane) const;

private:
  struct NamedEntries
  {
    std::string name; ///< as written first
    Entries entries;
    std::vector<std::string> elementSets; ///< whose nodes belong to it
  };
  using Sets = std::map<std::string, NamedEntries>;
  struct NamedSurface
  {
    std::string name;
    bool ofNodes;
    Surface lines;
  };

  static Entries* entriesOf(Sets& sets, const std::string& name);
  /// The set of that name and all that it names, directly or not. `missing`: where it is empty, it
  /// becomes the first name that is not defined.
  static std::vector<const NamedEntries*> reached(
    const Sets& sets, const std::string& name, std::string& missing);
  /// The positions in a set and in those that it names.
  static std::vector<Index> positions(
    const Sets& sets, const std::string& name, const Numbering& numbering);
  /// The first name that is not defined among those that a set or surface names; or empty.
  std::string missing(const Sets& sets, const std::string& name) const;
  std::string missing(const NamedSurface& surface) const;
  std::vector<Index> nodesOf(const std::string& name, const SolverMesh& mesh,
    const Numbering& nodes, const Numbering& elements) const;
  void addSurface(const NamedSurface& surface, SolverMesh& mesh, const Numbering& nodes,
    const Numbering& elements, const std::vector<std::uint8_t>& arePlane) const;

  Sets nodeSets_, elementSets_;
  std::list<NamedSurface> surfaces_;
};
}
