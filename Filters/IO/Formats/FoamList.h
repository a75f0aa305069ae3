// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"
#include "Text/Lines.h"

#include <array>
#include <string>
#include <vector>

namespace morph::io
{
/// A collated file of a decomposed case: a file of OpenFOAM for each piece, one after the other.
struct FoamBlocks
{
  std::string path;    ///< with ".gz" where it has that
  std::string content; ///< unpacked
  /// Of each block its length, as a number, and its bytes; none where the file is not collated.
  std::vector<Span> lengths, blocks;

  /// Reads `path` or, where there is no such file, `path` with ".gz". Throws Error where neither
  /// can be read, or where a collated file is damaged.
  explicit FoamBlocks(const std::string& path);
  /// The content with other blocks, as many as it has.
  std::string with(const std::vector<std::string>& others) const;
};

/// A file of OpenFOAM, unpacked: its header, and the lists that follow. See "Basic input/output
/// file format" in OpenFOAM's User Guide.
class FoamList
{
public:
  /// Reads `path` or, where there is no such file, `path` with ".gz". Throws Error where neither
  /// can be read, or where it has no header FoamFile.
  explicit FoamList(const std::string& path);
  /// The files that a collated file holds, or the one file that it is.
  static std::vector<FoamList> all(const std::string& path);

  const std::string& path() const { return this->path_; } ///< with ".gz" where it has that
  const std::string& content() const { return this->content_; }
  const std::string& type() const { return this->type_; } ///< its class: "vectorField"
  bool isBinary() const { return this->isBinary_; }
  std::size_t bytesOfScalar() const { return this->bytesOfScalar_; }

  /// The next list, of labels, of coordinates, or of faces. Each throws Error where it is damaged.
  std::vector<Index> labels();
  struct Vectors
  {
    std::vector<double> values; ///< 3 x #vectors
    std::vector<Span> places;   ///< of each number in the content, of a text
    std::size_t first = 0;      ///< where the numbers begin, of a binary file
  };
  Vectors vectors();
  std::vector<std::vector<Index>> faces();

  /// The patches of polyMesh/boundary.
  struct Patch
  {
    std::string name, type;
    std::string neighbour;      ///< of a cyclic patch: the other one
    std::string cyclic;         ///< of a cut through a cyclic patch: that patch
    Index first = 0, count = 0; ///< faces
  };
  std::vector<Patch> patches();

  /// The zones of polyMesh/cellZones, faceZones or pointZones.
  struct Zone
  {
    std::string name;
    std::vector<Index> members;
  };
  std::vector<Zone> zones();

  /// What a field of vectors has for a patch.
  struct PatchVectors
  {
    std::string name; ///< of the patch; a pattern of names where it is quoted in the file
    bool isPattern = false;
    std::string type;
    bool isUniform = false;
    std::vector<double> values; ///< 3 where they are uniform, or 3 for each point; may be empty
  };
  /// The boundaryField of a field of vectors, such as 0/pointDisplacement.
  std::vector<PatchVectors> boundaryField();
  const std::string& dimensions() const { return this->dimensions_; } ///< read by boundaryField()

private:
  FoamList() = default;
  void readHeader();
  /// Goes through a dictionary, from its '{' to behind its '}'. `take`: reads what follows a key,
  /// or returns false to have it skipped.
  template <typename Take>
  void readDictionary(Take take);
  /// A list of dictionaries, each with its name. `take`: as of readDictionary(), with the entry.
  template <typename Entry, typename Take>
  std::vector<Entry> namedEntries(Take take);
  void skipEntry();
  void skipListType();
  void skipFlips();
  std::string name(bool& isQuoted);
  void vector(const std::string& what, Vectors& to);
  std::vector<double> fieldValues(bool& isUniform);
  void skipBlanks();
  char peek();
  void expect(char character);
  Span word();
  Index integer();
  Index count(std::size_t leastBytes);
  const char* bytes(std::size_t size);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_, content_, type_, dimensions_;
  bool isBinary_ = false;
  std::size_t bytesOfLabel_ = 4, bytesOfScalar_ = 8, at_ = 0;
};
}
