// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/OpenFoamMesh.h"

#include "Files/Gzip.h"
#include "Formats/FoamCells.h"
#include "Formats/FoamFolders.h"
#include "Formats/FoamList.h"
#include "Formats/JoinedNodes.h"
#include "Support/Error.h"
#include "Text/NumberPlaces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

namespace morph::io
{
namespace
{
namespace fs = std::filesystem;

class OpenFoamMesh : public SolverFile
{
public:
  explicit OpenFoamMesh(const std::string& path)
    : SolverFile(path)
    , folders_(FoamFolders::of(path))
  {
    for (const FoamFolder& folder : this->folders_.parts)
    {
      this->readPoints(folder);
    }
    this->arePieces_ =
      this->folders_.arePieces || this->parts_.size() > this->folders_.parts.size();
    this->joinNodes();
    std::size_t part = 0;
    for (const FoamFolder& folder : this->folders_.parts)
    {
      part = this->readFolder(folder, part);
    }
    if (!this->cuts_.empty())
    {
      this->fail("the pieces of this decomposed case do not fit together: " +
                 std::to_string(this->cuts_.size()) +
                 " faces of their cuts have no face on the other side. Is a piece missing?");
    }
    for (const auto& [kind, names] : this->flat_)
    {
      if (names.size() == 2 || (names.size() == 1 && kind.second == "empty"))
      {
        this->mesh_.periodic.emplace(*names.begin(), *names.rbegin());
      }
    }
    if (!this->folders_.warning.empty())
    {
      this->mesh_.warnings.push_back(this->folders_.warning);
    }
  }

  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override;

private:
  /// A mesh of its own in the files: the whole, or a region or piece of it.
  struct Part
  {
    Part(FoamList list, std::string of)
      : points(std::move(list))
      , vectors(points.vectors())
      , region(std::move(of))
    {
    }
    FoamList points;
    FoamList::Vectors vectors;
    std::string region;      ///< empty where there is but one
    std::vector<Index> node; ///< the mesh's node of each point
    std::vector<Index>
      original; ///< of a piece: the point of the whole mesh, where the file says it
  };
  using Faces = std::vector<std::vector<Index>>;

  void readPoints(const FoamFolder& folder);
  void joinNodes();
  std::size_t readFolder(const FoamFolder& folder, std::size_t part);
  /// Returns the faces of a part, with the mesh's nodes.
  Faces facesOf(const Part& part, FoamList& list) const;
  void readCells(const Part& part, const Faces& faces, FoamList& owner, FoamList& neighbour,
    FoamList& boundary, const fs::path& folder, std::size_t block);
  /// Adds the faces of patches as cells, and returns the cell of each face, or -1.
  std::vector<Index> addPatches(
    const Part& part, const Faces& faces, const std::vector<FoamList::Patch>& patches, Index inner);
  void addZones(const fs::path& folder, std::size_t block, const Part& part, const Faces& faces,
    Index firstCell, Index cells, std::vector<Index> cellOfFace);
  Index addFace(const std::vector<Index>& face);
  /// The name of a set of a part: "fluid/inlet" where there are several regions.
  static std::string nameIn(const Part& part, const std::string& name)
  {
    return part.region.empty() ? name : part.region + "/" + name;
  }
  std::string asText(
    const Part& part, const std::vector<double>& coordinates, double& largestRounding) const;
  std::string asBytes(
    const Part& part, const std::vector<double>& coordinates, double& largestRounding) const;

  FoamFolders folders_;
  bool arePieces_ = false;
  std::vector<Part> parts_;
  Index cells_ = 0; ///< of the parts before
  /// Faces of one part alone, so far: of cuts between pieces, and the cells of interfaces between
  /// regions. By their nodes, sorted.
  ///@{
  std::set<std::vector<Index>> cuts_;
  std::map<std::vector<Index>, Index> interfaces_;
  ///@}
  std::map<std::pair<std::string, std::string>, std::string> zones_; ///< the set of each, by file
  /// Patches of the types empty and wedge, of each region: front and back.
  std::map<std::pair<std::string, std::string>, std::set<std::string>> flat_;
};

void OpenFoamMesh::readPoints(const FoamFolder& folder)
{
  const fs::path points = fs::path(folder.points) / "points",
                 addressing = fs::path(folder.faces) / "pointProcAddressing";
  std::vector<FoamList> lists = FoamList::all(points.string());
  const bool isPiece = this->folders_.arePieces || lists.size() > 1;
  std::vector<FoamList> originals = isPiece && hasFile(folder.faces, "pointProcAddressing")
                                      ? FoamList::all(addressing.string())
                                      : std::vector<FoamList>();
  for (std::size_t i = 0; i < lists.size(); ++i)
  {
    Part& part = this->parts_.emplace_back(std::move(lists[i]), folder.region);
    if (i < originals.size())
    {
      part.original = originals[i].labels();
      if (3 * part.original.size() != part.vectors.values.size())
      {
        this->fail(addressing.string() + " has " + std::to_string(part.original.size()) +
                   " entries for " + std::to_string(part.vectors.values.size() / 3) + " points.");
      }
    }
  }
}

/// Nodes of pieces are one by pointProcAddressing, where all have it and there is one region; else
/// nodes of several parts at the very same position are.
void OpenFoamMesh::joinNodes()
{
  std::vector<double> coordinates;
  std::vector<Index> partOf, original;
  bool hasOriginals = true;
  for (std::size_t p = 0; p < this->parts_.size(); ++p)
  {
    const Part& part = this->parts_[p];
    coordinates.insert(coordinates.end(), part.vectors.values.begin(), part.vectors.values.end());
    partOf.resize(coordinates.size() / 3, static_cast<Index>(p));
    original.insert(original.end(), part.original.begin(), part.original.end());
    hasOriginals = hasOriginals && part.region.empty() && original.size() == partOf.size();
  }
  std::vector<Index> first(partOf.size());
  std::map<Index, Index> firstOf;
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    first[i] = hasOriginals ? firstOf.emplace(original[i], static_cast<Index>(i)).first->second
                            : static_cast<Index>(i);
  }
  if (!hasOriginals && this->parts_.size() > 1)
  {
    first = joinedNodes(coordinates, partOf);
  }
  std::vector<Index> node(first.size());
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    if (first[i] == static_cast<Index>(i))
    {
      node[i] = this->mesh_.nodes();
      const double* x = coordinates.data() + 3 * i;
      this->mesh_.addNode(hasOriginals ? original[i] : node[i], x[0], x[1], x[2]);
    }
    else
    {
      node[i] = node[static_cast<std::size_t>(first[i])];
    }
    this->parts_[static_cast<std::size_t>(partOf[i])].node.push_back(node[i]);
  }
}

/// Reads the parts of a folder from `part` on; returns the one behind them.
std::size_t OpenFoamMesh::readFolder(const FoamFolder& folder, std::size_t part)
{
  const auto all = [&](const char* name)
  { return FoamList::all((fs::path(folder.faces) / name).string()); };
  std::vector<FoamList> faces = all("faces"), owner = all("owner"), neighbour = all("neighbour"),
                        boundary = all("boundary");
  if (owner.size() != faces.size() || neighbour.size() != faces.size() ||
      boundary.size() != faces.size() || part + faces.size() > this->parts_.size())
  {
    this->fail("the files of " + folder.faces + " do not have the same number of pieces.");
  }
  for (std::size_t i = 0; i < faces.size(); ++i, ++part)
  {
    const Part& one = this->parts_[part];
    this->readCells(
      one, this->facesOf(one, faces[i]), owner[i], neighbour[i], boundary[i], folder.faces, i);
  }
  return part;
}

OpenFoamMesh::Faces OpenFoamMesh::facesOf(const Part& part, FoamList& list) const
{
  Faces faces = list.faces();
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    for (Index& node : faces[f])
    {
      if (node < 0 || node >= static_cast<Index>(part.node.size()))
      {
        this->fail("face " + std::to_string(f) + " has the point " + std::to_string(node) +
                   ", which does not exist.");
      }
      node = part.node[static_cast<std::size_t>(node)];
    }
  }
  return faces;
}

void OpenFoamMesh::readCells(const Part& part, const Faces& faces, FoamList& owners,
  FoamList& neighbours, FoamList& boundary, const fs::path& folder, std::size_t block)
{
  const auto owner = owners.labels(), neighbour = neighbours.labels();
  if (owner.size() != faces.size() || neighbour.size() > faces.size())
  {
    this->fail("faces, owner and neighbour do not belong together: they have " +
               std::to_string(faces.size()) + ", " + std::to_string(owner.size()) + " and " +
               std::to_string(neighbour.size()) + " entries.");
  }
  std::vector<std::vector<std::vector<Index>>> facesOfCell;
  const auto add = [&](Index cell, std::vector<Index> face, std::size_t number)
  {
    if (cell < 0 || cell > static_cast<Index>(faces.size()))
    {
      this->fail("face " + std::to_string(number) + " has the cell " + std::to_string(cell) +
                 ", which is out of range.");
    }
    const auto at = static_cast<std::size_t>(cell);
    facesOfCell.resize(std::max(facesOfCell.size(), at + 1));
    facesOfCell[at].push_back(std::move(face));
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    add(owner[f], faces[f], f);
    if (f < neighbour.size() && neighbour[f] >= 0)
    {
      add(neighbour[f], { faces[f].rbegin(), faces[f].rend() }, f);
    }
  }
  const Index firstCell = this->mesh_.cells();
  for (std::size_t c = 0; c < facesOfCell.size(); ++c)
  {
    const FoamCell cell = foamCell(facesOfCell[c]);
    const Index number = this->cells_ + static_cast<Index>(c);
    cell.type == 0 ? this->mesh_.addPolyhedron(facesOfCell[c], number)
                   : this->mesh_.addCell(cell.type, cell.nodes, number);
    if (!part.region.empty())
    {
      this->mesh_.set(part.region).cells.push_back(firstCell + static_cast<Index>(c));
    }
  }
  this->cells_ += static_cast<Index>(facesOfCell.size());
  std::vector<Index> cellOfFace =
    this->addPatches(part, faces, boundary.patches(), static_cast<Index>(neighbour.size()));
  this->addZones(folder, block, part, faces, firstCell, static_cast<Index>(facesOfCell.size()),
    std::move(cellOfFace));
}

Index OpenFoamMesh::addFace(const std::vector<Index>& face)
{
  const std::uint8_t type = face.size() == 3   ? std::uint8_t(Triangle)
                            : face.size() == 4 ? std::uint8_t(Quad)
                                               : std::uint8_t(Polygon);
  return this->mesh_.addCell(type, face, -1);
}

std::vector<Index> OpenFoamMesh::addPatches(
  const Part& part, const Faces& faces, const std::vector<FoamList::Patch>& patches, Index inner)
{
  std::vector<Index> cellOfFace(faces.size(), -1);
  std::map<std::vector<Index>, Index> added; // to interfaces_, for the parts behind
  for (const FoamList::Patch& patch : patches)
  {
    if (patch.first < 0 || patch.count < 0 ||
        patch.first + patch.count > static_cast<Index>(faces.size()) ||
        (patch.count > 0 && patch.first < inner))
    {
      this->fail("the faces of the patch " + patch.name + " are out of range.");
    }
    // A cut through a cyclic patch is a part of that patch.
    const std::string name = nameIn(part, patch.cyclic.empty() ? patch.name : patch.cyclic);
    if (patch.type.rfind("processor", 0) == 0 && !this->arePieces_)
    {
      this->fail("it is a piece of a decomposed case (its patch " + patch.name + " is of type " +
                 patch.type +
                 "), whose cuts would be outer walls. Give the folder of the case, whose pieces "
                 "are read and written together.");
    }
    if (patch.type == "cyclic" && patch.count > 0)
    {
      this->mesh_.periodic.insert(std::minmax(name, nameIn(part, patch.neighbour)));
    }
    else if ((patch.type == "empty" || patch.type == "wedge") && patch.count > 0)
    {
      this->flat_[{ part.region, patch.type }].insert(name);
    }
    else if ((patch.type == "symmetryPlane" || patch.type == "symmetry") && patch.count > 0)
    {
      this->mesh_.symmetry.insert(name);
    }
    for (Index f = patch.first; f < patch.first + patch.count; ++f)
    {
      const auto at = static_cast<std::size_t>(f);
      std::vector<Index> nodes = faces[at];
      std::sort(nodes.begin(), nodes.end());
      if (patch.type == "processor")
      {
        if (!this->cuts_.insert(nodes).second)
        {
          this->cuts_.erase(nodes);
        }
        continue;
      }
      Index& cell = cellOfFace[at];
      const auto other = this->interfaces_.find(nodes);
      // The other region's face is the same: the interface is a sheet, and no baffle.
      cell = other != this->interfaces_.end() ? other->second : this->addFace(faces[at]);
      if (!part.region.empty())
      {
        added.emplace(std::move(nodes), cell);
      }
      this->mesh_.set(name).cells.push_back(cell);
    }
  }
  this->interfaces_.merge(added);
  return cellOfFace;
}

/// `cells`: those of the part, from `firstCell` on.
void OpenFoamMesh::addZones(const fs::path& folder, std::size_t block, const Part& part,
  const Faces& faces, Index firstCell, Index cells, std::vector<Index> cellOfFace)
{
  const auto add = [&](const char* file, Index size, const auto& take)
  {
    std::vector<FoamList> lists =
      hasFile(folder, file) ? FoamList::all((folder / file).string()) : std::vector<FoamList>();
    for (const FoamList::Zone& zone :
      block < lists.size() ? lists[block].zones() : std::vector<FoamList::Zone>())
    {
      std::string name = nameIn(part, zone.name);
      std::string& known = this->zones_[{ file, name }]; // of another piece
      const auto isTaken = [&](const std::string& one)
      {
        return std::any_of(this->mesh_.sets.begin(), this->mesh_.sets.end(),
          [&](const NamedSet& set) { return set.name == one; });
      };
      while (known.empty() && isTaken(name)) // a patch, or a zone of another kind
      {
        name += " (" + std::string(file) + ")";
      }
      known = known.empty() ? name : known;
      NamedSet& set = this->mesh_.set(known);
      for (const Index member : zone.members)
      {
        if (member < 0 || member >= size)
        {
          this->fail("the zone " + zone.name + " of " + file + " has the entry " +
                     std::to_string(member) + ", which does not exist.");
        }
        take(set, member);
      }
    }
  };
  add(
    "cellZones", cells, [&](NamedSet& set, Index cell) { set.cells.push_back(firstCell + cell); });
  add("pointZones", static_cast<Index>(part.node.size()),
    [&](NamedSet& set, Index point)
    { set.nodes.push_back(part.node[static_cast<std::size_t>(point)]); });
  add("faceZones", static_cast<Index>(faces.size()),
    [&](NamedSet& set, Index face)
    {
      Index& cell = cellOfFace[static_cast<std::size_t>(face)];
      cell = cell < 0 ? this->addFace(faces[static_cast<std::size_t>(face)]) : cell;
      set.cells.push_back(cell);
    });
}

std::vector<NewFile> OpenFoamMesh::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  const std::vector<std::string> targets = foamTargets(this->folders_, out);
  std::vector<NewFile> files;
  std::size_t part = 0;
  for (std::size_t i = 0; i < targets.size(); ++i)
  {
    const FoamBlocks original((fs::path(this->folders_.parts[i].points) / "points").string());
    std::vector<std::string> contents;
    for (std::size_t k = 0; k < std::max<std::size_t>(original.blocks.size(), 1); ++k, ++part)
    {
      if (part >= this->parts_.size())
      {
        throw Error("Cannot write " + out + ": " + original.path + " was changed meanwhile.");
      }
      const Part& one = this->parts_[part];
      contents.push_back(one.points.isBinary() ? this->asBytes(one, coordinates, largestRounding)
                                               : this->asText(one, coordinates, largestRounding));
    }
    std::string content =
      original.blocks.empty() ? std::move(contents.front()) : original.with(contents);
    if (fs::path(targets[i]).extension() == ".gz")
    {
      content = gzip(content, targets[i]);
    }
    files.push_back({ targets[i], std::move(content) });
    files.back().makeFolder = true; // of a new time
  }
  return files;
}

std::string OpenFoamMesh::asText(
  const Part& part, const std::vector<double>& coordinates, double& largestRounding) const
{
  std::vector<NumberChange> changes;
  for (std::size_t i = 0; i < part.vectors.values.size(); ++i)
  {
    const double x = coordinates[static_cast<std::size_t>(3 * part.node[i / 3]) + i % 3];
    if (x != part.vectors.values[i])
    {
      NumberChange change;
      change.place.begin = part.vectors.places[i].begin;
      change.place.length = static_cast<std::uint32_t>(part.vectors.places[i].size());
      change.value = x;
      changes.push_back(change);
    }
  }
  return withNumbers(part.points.content(), changes, largestRounding);
}

std::string OpenFoamMesh::asBytes(
  const Part& part, const std::vector<double>& coordinates, double& largestRounding) const
{
  std::string content = part.points.content();
  const std::size_t size = part.points.bytesOfScalar();
  for (std::size_t i = 0; i < part.vectors.values.size(); ++i)
  {
    const double x = coordinates[static_cast<std::size_t>(3 * part.node[i / 3]) + i % 3];
    char* to = content.data() + part.vectors.first + i * size;
    if (size == sizeof(double))
    {
      std::memcpy(to, &x, size);
      continue;
    }
    const auto value = static_cast<float>(x);
    if (!std::isfinite(value))
    {
      throw Error("The coordinate " + std::to_string(x) + " of point " + std::to_string(i / 3) +
                  " does not fit into single precision.");
    }
    std::memcpy(to, &value, size);
    largestRounding = std::max(largestRounding, std::abs(double(value) - x));
  }
  return content;
}
}

bool isOpenFoamMesh(const std::string& path)
{
  return !FoamFolders::of(path).parts.empty();
}

std::unique_ptr<SolverFile> readOpenFoamMesh(const std::string& path)
{
  return std::make_unique<OpenFoamMesh>(path);
}

std::vector<std::string> openFoamTargets(const std::string& original, const std::string& out)
{
  return foamTargets(FoamFolders::of(original), out);
}
}
