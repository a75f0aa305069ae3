// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/FoamFolders.h"

#include "Files/ReadFile.h"
#include "Support/Error.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <filesystem>
#include <map>

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

}

bool hasFile(const fs::path& folder, const char* name)
{
  return isThere(folder / name) || isThere(folder / (std::string(name) + ".gz"));
}

namespace
{
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

/// The folder polyMesh with the points of one mesh; empty where there is none.
fs::path pointsFolder(const fs::path& folder)
{
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

/// The folders in `parent`, by name.
std::vector<fs::path> foldersIn(const fs::path& parent)
{
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(parent, error), end; !error && it != end; it.increment(error))
  {
    folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// The regions with a mesh in a folder constant/, or only the one of that name.
std::vector<FoamFolder> regionsIn(const fs::path& constant, const std::string& only = "")
{
  std::vector<FoamFolder> regions;
  for (const fs::path& folder : foldersIn(constant))
  {
    const std::string name = folder.filename().string(), mesh = (folder / "polyMesh").string();
    if (hasFile(mesh, "points") && (only.empty() || name == only))
    {
      regions.push_back({ mesh, mesh, only.empty() ? name : "" });
    }
  }
  return regions;
}

/// The folders of a decomposed case: processor0 and so on, by number, or processors4, collated.
std::vector<fs::path> pieceFolders(const fs::path& root)
{
  std::map<std::pair<long long, std::string>, fs::path> pieces;
  for (const fs::path& folder : foldersIn(root))
  {
    const std::string name = folder.filename().string();
    if (name.rfind("processor", 0) == 0 && isThere(folder / "constant"))
    {
      const auto number = parseInteger(name.substr(std::string("processor").size()));
      pieces[{ number ? *number : -1, name }] = folder;
    }
  }
  std::vector<fs::path> folders;
  for (const auto& piece : pieces)
  {
    folders.push_back(piece.second);
  }
  return folders;
}

/// `region`: the only one to take; empty: all.
void addPieces(const fs::path& root, const std::string& region, FoamFolders& found)
{
  for (const fs::path& piece : pieceFolders(root))
  {
    const fs::path mesh = piece / "constant" / "polyMesh";
    std::vector<FoamFolder> parts = regionsIn(piece / "constant", region);
    if (hasFile(mesh, "points") && region.empty() && parts.empty())
    {
      parts.push_back({ mesh.string(), mesh.string(), "" });
    }
    found.parts.insert(found.parts.end(), parts.begin(), parts.end());
  }
  found.arePieces = !found.parts.empty();
  found.root = root.string();
}

std::string namesOf(const std::vector<FoamFolder>& regions)
{
  std::string names;
  for (const FoamFolder& region : regions)
  {
    names += (names.empty() ? "" : ", ") + region.region;
  }
  return names;
}

bool isTime(const fs::path& path)
{
  return parseNumber(path.filename().string()).has_value();
}

/// A part's folder in another case, or in a time of it.
fs::path folderIn(
  const fs::path& root, const fs::path& time, const FoamFolders& original, const FoamFolder& part)
{
  fs::path result = root;
  for (const fs::path& name : fs::path(part.points).lexically_relative(original.root))
  {
    result /= name == "constant" && !time.empty() ? time : name;
  }
  return result;
}

/// Throws Error where OpenFOAM would have a choice of two files.
void requireNoTwin(const fs::path& file)
{
  const bool isPacked = file.extension() == ".gz";
  const fs::path twin = file.parent_path() / (isPacked ? "points" : "points.gz");
  if (isThere(twin))
  {
    throw Error("Cannot write " + file.string() + ": " + twin.string() +
                " lies beside it, and OpenFOAM would read either. Name that one, or remove it.");
  }
}

/// Whether a case has all parts of the original.
bool hasAll(const fs::path& root, const FoamFolders& original)
{
  return std::all_of(original.parts.begin(), original.parts.end(),
    [&](const FoamFolder& part) { return hasFile(folderIn(root, {}, original, part), "points"); });
}

/// The files of a copy of the case or, with `time`, of a time of it.
std::vector<std::string> filesIn(
  const fs::path& root, const fs::path& time, const FoamFolders& original)
{
  std::vector<std::string> files;
  for (const FoamFolder& part : original.parts)
  {
    const fs::path folder = folderIn(root, time, original, part);
    const bool isPacked =
      !isThere(folder / "points") && isThere(folderIn(root, {}, original, part) / "points.gz");
    files.push_back((folder / (isPacked ? "points.gz" : "points")).string());
  }
  return files;
}

/// As foamTargets().
std::vector<std::string> filesMeantBy(const FoamFolders& original, const fs::path& out)
{
  const bool isOne = original.parts.size() == 1 && !original.arePieces;
  if (isOne && isPointsFile(out))
  {
    return { out.string() };
  }
  // ParaView's marker of a case need not be there yet.
  const bool isMarker = extensionOf(out.string()) == ".foam";
  const fs::path root = isMarker ? out.parent_path() / "." : out;
  if (hasAll(root, original))
  {
    return filesIn(root, {}, original);
  }
  const fs::path folder = isOne ? pointsFolder(root) : fs::path();
  if (!folder.empty())
  {
    return { (folder / (isThere(folder / "points") ? "points" : "points.gz")).string() };
  }
  const fs::path above = out.has_parent_path() ? out.parent_path() : fs::path(".");
  if (isTime(out) && hasAll(above, original))
  {
    return filesIn(above, out.filename(), original);
  }
  std::error_code error;
  const bool isFile = isOne && !isMarker && !fs::is_directory(out, error);
  throw Error("Cannot write " + out.string() + ": " +
              (isFile ? "a copy of the points of " + original.parts.front().points +
                          " is called points or points.gz"
                      : "there is no mesh in it as in " + original.root) +
              ". Name the folder of a copy of the case, or of a time in it, as case/0.1" +
              (isOne ? ", or the file to write, as case/0.1/polyMesh/points." : "."));
}
}

FoamFolders FoamFolders::of(const std::string& path)
{
  FoamFolders found;
  const fs::path folder = folderOf(path), constant = folder / "constant";
  const fs::path single = pointsFolder(folder);
  found.root = folder.string();
  if (folder.empty())
  {
    return found;
  }
  const std::vector<FoamFolder> regions = regionsIn(constant);
  const bool isOfRegions = hasFile(constant, "regionProperties");
  if (!single.empty() && (regions.empty() || !isOfRegions))
  {
    found.parts = { { single.string(), facesFolder(single).string(), "" } };
    if (single == folder / "polyMesh" && folder.parent_path().filename() == "constant")
    {
      found.root = (folder.parent_path().parent_path() / ".").string(); // a region
    }
    found.warning = regions.empty()
                      ? ""
                      : path + " has a mesh of its own and regions: " + namesOf(regions) +
                          ". Its own mesh alone is read and written.";
    return found;
  }
  found.parts = regions.empty() ? regionsIn(folder) : regions;
  if (found.parts.size() == 1)
  {
    found.parts.front().region.clear();
  }
  if (!single.empty())
  {
    found.warning = path + " has regions, as its regionProperties says, and a mesh of its own in " +
                    single.string() + ", which is neither read nor written.";
  }
  if (found.parts.empty())
  {
    addPieces(folder, "", found);
  }
  if (found.parts.empty() && folder.parent_path().filename() == "constant")
  {
    addPieces(folder.parent_path().parent_path(), folder.filename().string(), found);
  }
  return found;
}

std::vector<std::string> foamTargets(const FoamFolders& original, const std::string& out)
{
  const std::vector<std::string> files = filesMeantBy(original, out);
  std::for_each(files.begin(), files.end(), requireNoTwin);
  return files;
}
}
