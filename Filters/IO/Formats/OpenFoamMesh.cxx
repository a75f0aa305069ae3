// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/OpenFoamMesh.h"

#include "Files/Gzip.h"
#include "Files/ReadFile.h"
#include "Formats/FoamCells.h"
#include "Formats/FoamList.h"
#include "Support/Error.h"
#include "Text/NumberPlaces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace morph::io
{
namespace
{
namespace fs = std::filesystem;

bool isPointsFile(const fs::path& path)
{
  return path.filename() == "points" || path.filename() == "points.gz";
}

bool isThere(const fs::path& path)
{
  std::error_code error;
  return fs::exists(path, error);
}

bool hasFile(const fs::path& folder, const char* name)
{
  return isThere(folder / name) || isThere(folder / (std::string(name) + ".gz"));
}

/// The folder that a path means: itself, or that of a marker or a file of points.
fs::path folderOf(const fs::path& path)
{
  std::error_code error;
  if (!fs::is_regular_file(path, error))
  {
    return path;
  }
  const bool isKnown = isPointsFile(path) || extensionOf(path.string()) == ".foam";
  return !isKnown ? fs::path() : path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// The folder polyMesh with the points that a path means; empty where it means none.
fs::path pointsFolder(const fs::path& path)
{
  const fs::path folder = folderOf(path);
  for (const fs::path& candidate :
    { folder / "constant" / "polyMesh", folder / "polyMesh", folder })
  {
    if (!folder.empty() && hasFile(candidate, "points"))
    {
      return candidate;
    }
  }
  return {};
}

/// The folders of a case that have a mesh each, where the case itself has none: those of its
/// regions, or else the pieces of a decomposed case. In the order of their names.
std::vector<std::string> meshesIn(const fs::path& path)
{
  std::vector<std::string> regions, pieces;
  const fs::path folder = folderOf(path);
  for (const fs::path& parent : { folder / "constant", folder })
  {
    std::error_code error;
    for (fs::directory_iterator it(parent, error), end; !error && it != end; it.increment(error))
    {
      const bool isPiece = it->path().filename().string().rfind("processor", 0) == 0;
      if (hasFile(it->path() / "polyMesh", "points"))
      {
        regions.push_back(it->path().string());
      }
      else if (isPiece && isThere(it->path() / "constant"))
      {
        pieces.push_back(it->path().string());
      }
    }
  }
  std::vector<std::string>& meshes = regions.empty() ? pieces : regions;
  std::sort(meshes.begin(), meshes.end());
  return meshes;
}

/// As pointsFolder(). Throws Error with what to give where the path means several meshes.
fs::path onePointsFolder(const std::string& path)
{
  fs::path found = pointsFolder(path);
  const std::vector<std::string> meshes =
    found.empty() ? meshesIn(path) : std::vector<std::string>();
  if (meshes.empty())
  {
    return found;
  }
  if (fs::path(meshes.front()).filename().string().rfind("processor", 0) == 0)
  {
    throw Error("Cannot read " + path + ": it is a decomposed case, whose pieces are " +
                meshes.front() + " and so on. Join them with OpenFOAM's reconstructParMesh.");
  }
  std::string list;
  for (const std::string& mesh : meshes)
  {
    list += (list.empty() ? "" : ", ") + mesh;
  }
  throw Error("Cannot read " + path +
              ": it has no mesh of its own, but one for each region. Give "
              "one of these in its place: " +
              list + ".");
}

/// The folder with the faces: that of the points, or that of constant/ for a time's points.
fs::path facesFolder(const fs::path& points)
{
  if (hasFile(points, "faces"))
  {
    return points;
  }
  // <time>/polyMesh, or <time>/<region>/polyMesh.
  const fs::path name = points.filename(), up = fs::absolute(points).parent_path();
  const fs::path candidates[] = { up.parent_path() / "constant" / name,
    up.parent_path().parent_path() / "constant" / up.filename() / name };
  for (const fs::path& candidate : candidates)
  {
    if (hasFile(candidate, "faces"))
    {
      return candidate;
    }
  }
  return points;
}

class OpenFoamMesh : public SolverFile
{
public:
  explicit OpenFoamMesh(const std::string& path)
    : SolverFile(path)
    , list_((onePointsFolder(path) / "points").string())
    , points_(list_.vectors())
  {
    for (std::size_t i = 0; 3 * i < this->points_.values.size(); ++i)
    {
      const double* x = this->points_.values.data() + 3 * i;
      this->mesh_.addNode(static_cast<Index>(i), x[0], x[1], x[2]);
    }
    this->readCells(facesFolder(pointsFolder(path)));
  }

  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override
  {
    std::string content = this->list_.isBinary() ? this->asBytes(coordinates, largestRounding)
                                                 : this->asText(coordinates, largestRounding);
    if (fs::path(out).extension() == ".gz")
    {
      content = gzip(content, out);
    }
    std::vector<NewFile> files = { { out, std::move(content) } };
    files.front().makeFolder = true; // of a new time
    return files;
  }

private:
  void readCells(const fs::path& folder);
  using Faces = std::vector<std::vector<Index>>;
  /// Adds the faces of patches as cells, and returns the cell of each face, or -1.
  std::vector<Index> addPatches(const fs::path& folder, const Faces& faces, Index inner);
  void addZones(
    const fs::path& folder, const Faces& faces, Index cells, std::vector<Index> cellOfFace);
  Index addFace(const std::vector<Index>& face);
  std::string asText(const std::vector<double>& coordinates, double& largestRounding) const;
  std::string asBytes(const std::vector<double>& coordinates, double& largestRounding) const;

  FoamList list_;
  FoamList::Vectors points_;
};

void OpenFoamMesh::readCells(const fs::path& folder)
{
  const auto faces = FoamList((folder / "faces").string()).faces();
  const auto owner = FoamList((folder / "owner").string()).labels();
  const auto neighbour = FoamList((folder / "neighbour").string()).labels();
  if (owner.size() != faces.size() || neighbour.size() > faces.size())
  {
    this->fail("faces, owner and neighbour do not belong together: they have " +
               std::to_string(faces.size()) + ", " + std::to_string(owner.size()) + " and " +
               std::to_string(neighbour.size()) + " entries.");
  }
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    for (const Index node : faces[f])
    {
      if (node < 0 || node >= this->mesh_.nodes())
      {
        this->fail("face " + std::to_string(f) + " has the point " + std::to_string(node) +
                   ", which does not exist.");
      }
    }
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
  for (std::size_t c = 0; c < facesOfCell.size(); ++c)
  {
    const FoamCell cell = foamCell(facesOfCell[c]);
    if (cell.type == 0)
    {
      this->mesh_.addPolyhedron(facesOfCell[c], static_cast<Index>(c));
      continue;
    }
    this->mesh_.addCell(cell.type, cell.nodes, static_cast<Index>(c));
  }
  std::vector<Index> cellOfFace =
    this->addPatches(folder, faces, static_cast<Index>(neighbour.size()));
  this->addZones(folder, faces, static_cast<Index>(facesOfCell.size()), std::move(cellOfFace));
}

Index OpenFoamMesh::addFace(const std::vector<Index>& face)
{
  const std::uint8_t type = face.size() == 3   ? std::uint8_t(Triangle)
                            : face.size() == 4 ? std::uint8_t(Quad)
                                               : std::uint8_t(Polygon);
  return this->mesh_.addCell(type, face, -1);
}

std::vector<Index> OpenFoamMesh::addPatches(const fs::path& folder, const Faces& faces, Index inner)
{
  std::vector<Index> cellOfFace(faces.size(), -1);
  for (const FoamList::Patch& patch : FoamList((folder / "boundary").string()).patches())
  {
    if (patch.first < 0 || patch.count < 0 ||
        patch.first + patch.count > static_cast<Index>(faces.size()) ||
        (patch.count > 0 && patch.first < inner))
    {
      this->fail("the faces of the patch " + patch.name + " are out of range.");
    }
    if (patch.type.rfind("processor", 0) == 0) // processorCyclic too
    {
      this->fail("it is a piece of a decomposed case (its patch " + patch.name + " is of type " +
                 patch.type +
                 "), whose cuts would be outer walls. Join the pieces with OpenFOAM's "
                 "reconstructParMesh, and give the whole mesh.");
    }
    for (Index f = patch.first; f < patch.first + patch.count; ++f)
    {
      const auto at = static_cast<std::size_t>(f);
      cellOfFace[at] = this->addFace(faces[at]);
      this->mesh_.set(patch.name).cells.push_back(cellOfFace[at]);
    }
  }
  return cellOfFace;
}

/// `cells`: the first ones of the mesh.
void OpenFoamMesh::addZones(
  const fs::path& folder, const Faces& faces, Index cells, std::vector<Index> cellOfFace)
{
  const auto add = [&](const char* file, Index size, const auto& take)
  {
    const auto zones = hasFile(folder, file) ? FoamList((folder / file).string()).zones()
                                             : std::vector<FoamList::Zone>();
    for (const FoamList::Zone& zone : zones)
    {
      const auto isTaken = [&](const std::string& name)
      {
        return std::any_of(this->mesh_.sets.begin(), this->mesh_.sets.end(),
          [&](const NamedSet& set) { return set.name == name; });
      };
      std::string name = zone.name;
      while (isTaken(name)) // a patch, or a zone of another kind
      {
        name += " (" + std::string(file) + ")";
      }
      NamedSet& set = this->mesh_.set(name);
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
  add("cellZones", cells, [](NamedSet& set, Index cell) { set.cells.push_back(cell); });
  add("pointZones", this->mesh_.nodes(),
    [](NamedSet& set, Index node) { set.nodes.push_back(node); });
  add("faceZones", static_cast<Index>(faces.size()),
    [&](NamedSet& set, Index face)
    {
      Index& cell = cellOfFace[static_cast<std::size_t>(face)];
      cell = cell < 0 ? this->addFace(faces[static_cast<std::size_t>(face)]) : cell;
      set.cells.push_back(cell);
    });
}

std::string OpenFoamMesh::asText(
  const std::vector<double>& coordinates, double& largestRounding) const
{
  std::vector<NumberChange> changes;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
  {
    if (coordinates[i] != this->points_.values[i])
    {
      NumberChange change;
      change.place.begin = this->points_.places[i].begin;
      change.place.length = static_cast<std::uint32_t>(this->points_.places[i].size());
      change.value = coordinates[i];
      changes.push_back(change);
    }
  }
  return withNumbers(this->list_.content(), changes, largestRounding);
}

std::string OpenFoamMesh::asBytes(
  const std::vector<double>& coordinates, double& largestRounding) const
{
  std::string content = this->list_.content();
  const std::size_t size = this->list_.bytesOfScalar();
  for (std::size_t i = 0; i < coordinates.size(); ++i)
  {
    char* to = content.data() + this->points_.first + i * size;
    if (size == sizeof(double))
    {
      std::memcpy(to, &coordinates[i], size);
      continue;
    }
    const auto value = static_cast<float>(coordinates[i]);
    if (!std::isfinite(value))
    {
      throw Error("The coordinate " + std::to_string(coordinates[i]) + " of point " +
                  std::to_string(i / 3) + " does not fit into single precision.");
    }
    std::memcpy(to, &value, size);
    largestRounding = std::max(largestRounding, std::abs(double(value) - coordinates[i]));
  }
  return content;
}
}

bool isOpenFoamMesh(const std::string& path)
{
  return !pointsFolder(path).empty() || !meshesIn(path).empty();
}

std::unique_ptr<SolverFile> readOpenFoamMesh(const std::string& path)
{
  return std::make_unique<OpenFoamMesh>(path);
}

std::string openFoamTarget(const std::string& original, const std::string& out)
{
  fs::path file = out;
  std::error_code error;
  if (fs::is_directory(file, error) || extensionOf(out) == ".foam")
  {
    // ParaView's marker of a case, which need not be there yet.
    const bool isMarker = extensionOf(out) == ".foam";
    const fs::path folder = pointsFolder(isMarker ? (file.parent_path() / ".").string() : out);
    if (folder.empty())
    {
      throw Error("Cannot write " + out +
                  ": there is no mesh of OpenFOAM in it. Name the file to "
                  "write, as in case/0.1/polyMesh/points.");
    }
    file = folder / (isThere(folder / "points") ? "points" : "points.gz");
  }
  if (!isPointsFile(file))
  {
    throw Error("Cannot write " + out + ": a copy of the points of " + original +
                " is called points or points.gz, as in case/0.1/polyMesh/points.");
  }
  const bool isPacked = file.extension() == ".gz";
  const fs::path twin = file.parent_path() / (isPacked ? "points" : "points.gz");
  if (isThere(twin))
  {
    throw Error("Cannot write " + file.string() + ": " + twin.string() +
                " lies beside it, and OpenFOAM would read either. Name that one, or remove it.");
  }
  return file.string();
}
}
