// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/SolverFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusFile.h"
#include "Formats/AnsysFile.h"
#include "Formats/CgnsFile.h"
#include "Formats/ExodusFile.h"
#include "Formats/GmshFile.h"
#include "Formats/LsDynaFile.h"
#include "Formats/NastranFile.h"
#include "Formats/Numbering.h"
#include "Formats/OpenFoamMesh.h"
#include "Formats/Su2File.h"
#include "Support/Error.h"
#include "Text/Printable.h"

#include <algorithm>
#include <cmath>

namespace morph::io
{
namespace
{
struct Format
{
  const char* name;
  bool (*matches)(const std::string& path);
  std::unique_ptr<SolverFile> (*read)(const std::string& path);
  /// The files that are meant by the path of a copy. Throws Error for another format.
  std::vector<std::string> (*targets)(const std::string& original, const std::string& out);
  bool makesFolder = false; ///< where the copy's folder is missing
  bool isBuilt = true;      ///< its library was there
};

/// The copy has the extension of the original.
std::vector<std::string> sameExtension(const std::string& original, const std::string& out)
{
  const std::string extension = extensionOf(original);
  if (extensionOf(out) != extension)
  {
    throw Error("Cannot write " + out + ": a copy of " + original + " with other coordinates is " +
                extension + " too.");
  }
  return { out };
}

#ifdef MESHMORPHING_HAS_NETCDF
constexpr bool HasNetCdf = true;
#else
constexpr bool HasNetCdf = false;
#endif
#ifdef MESHMORPHING_HAS_CGNS
constexpr bool HasCgns = true;
#else
constexpr bool HasCgns = false;
#endif

constexpr Format Formats[] = {
  { "Abaqus or CalculiX", isAbaqusFile, readAbaqusFile, sameExtension },
  { "Ansys", isAnsysFile, readAnsysFile, sameExtension },
  { "CGNS", isCgnsFile, readCgnsFile, sameExtension, false, HasCgns },
  { "Exodus II", isExodusFile, readExodusFile, sameExtension, false, HasNetCdf },
  { "Gmsh", isGmshFile, readGmshFile, sameExtension },
  { "LS-DYNA", isLsDynaFile, readLsDynaFile, sameExtension },
  { "Nastran", isNastranFile, readNastranFile, sameExtension },
  { "OpenFOAM", isOpenFoamMesh, readOpenFoamMesh, openFoamTargets, true },
  { "SU2", isSu2File, readSu2File, sameExtension },
};

const Format* formatOf(const std::string& path)
{
  for (const Format& format : Formats)
  {
    if (format.matches(path))
    {
      return &format;
    }
  }
  return nullptr;
}

const Format& requireFormat(const std::string& path)
{
  const Format* format = formatOf(path);
  if (!format)
  {
    readFile(path); // says where there is none
    throw Error("Cannot read " + path + ": it is no file of a solver that is known here." +
                converterOf(path));
  }
  return *format;
}

/// `coordinates` in the order of the file's nodes.
std::vector<double> inOrder(
  const SolverFile& file, const std::vector<Index>& numbers, const std::vector<double>& coordinates)
{
  const SolverMesh& mesh = file.mesh();
  const std::string start = "Cannot write the coordinates into a copy of " + file.path() + ": ";
  if (static_cast<Index>(numbers.size()) != mesh.nodes())
  {
    throw Error(start + "the file has " + std::to_string(mesh.nodes()) + " nodes, and the mesh " +
                std::to_string(numbers.size()) + ". Give the mesh that was read from it.");
  }
  const Numbering nodes(mesh.nodeNumbers, "node", file.path());
  std::vector<double> result(coordinates.size());
  std::vector<std::uint8_t> isGiven(numbers.size(), 0);
  std::vector<Index> wrong, notFinite;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const Index node = nodes.find(numbers[i]);
    if (node < 0 || isGiven[static_cast<std::size_t>(node)])
    {
      wrong.push_back(numbers[i]);
      continue;
    }
    const auto position = static_cast<std::size_t>(node);
    isGiven[position] = 1;
    for (std::size_t j = 0; j < 3; ++j)
    {
      result[3 * position + j] = coordinates[3 * i + j];
      if (!std::isfinite(coordinates[3 * i + j]))
      {
        notFinite.push_back(numbers[i]);
        break;
      }
    }
  }
  if (!wrong.empty())
  {
    throw Error(start + "the mesh has node numbers that the file lacks, or has them twice: " +
                listIds(wrong) + ".");
  }
  if (!notFinite.empty())
  {
    throw Error(
      start + "they are not finite (NaN or infinite) at the nodes " + listIds(notFinite) + ".");
  }
  return result;
}
}

void SolverFile::fail(const std::string& reason) const
{
  throw Error(printable("Cannot read " + this->path() + ": " + reason));
}

void SolverFile::takeStep(Index step)
{
  this->mesh_.displacements = this->displacementsAt(step);
  if (this->mesh_.displacements.empty())
  {
    this->fail(this->steps() == 0 ? "it has no displacements of which `TimeStep` could be one."
                                  : "it has displacements of " + std::to_string(this->steps()) +
                                      " time steps, which count from 0; `TimeStep` is " +
                                      std::to_string(step) + ".");
  }
}

std::string solverFormat(const std::string& path)
{
  const Format* format = formatOf(path);
  return format && format->isBuilt ? format->name : "";
}

std::string converterOf(const std::string& path)
{
  const std::string extension = extensionOf(path);
  if (extension == ".unv" || extension == ".med")
  {
    return " Gmsh converts it: gmsh " + path + " -save -o model.msh";
  }
  if (extension == ".msh" && readHead(path, 1) == "(")
  {
    return " It is of Fluent, and meshio converts it: meshio convert --input-format ansys " + path +
           " model.vtu";
  }
  return {};
}

std::unique_ptr<SolverFile> readSolverFile(const std::string& path)
{
  return requireFormat(path).read(path);
}

Copied writeSolverFile(const std::string& original, const std::vector<Index>& numbers,
  const std::vector<double>& coordinates, const std::string& out, Signals signals)
{
  const Format& format = requireFormat(original);
  format.targets(original, out); // throws
  const std::unique_ptr<SolverFile> file = format.read(original);
  const std::vector<double> all = inOrder(*file, numbers, coordinates);
  Copied copied;
  replaceFiles(file->withCoordinates(all, out, copied.largestRounding), signals);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    copied.changed += all[i] != file->mesh().coordinates[i];
  }
  return copied;
}

std::vector<double> requireOwnCoordinates(const std::string& original,
  const std::vector<Index>& numbers, const std::vector<double>& coordinates, double precision,
  bool isMorphed)
{
  const std::unique_ptr<SolverFile> file = requireFormat(original).read(original);
  const SolverMesh& mesh = file->mesh();
  if (mesh.displacementName.empty())
  {
    return {};
  }
  const std::vector<double> given = inOrder(*file, numbers, coordinates);
  // The nodes that are not at the file's own coordinates plus these displacements.
  const auto elsewhere = [&](const std::vector<double>& displacements)
  {
    std::vector<Index> nodes;
    for (std::size_t i = 0; i < given.size(); ++i)
    {
      const double expected = mesh.coordinates[i] + displacements[i];
      if (!(std::abs(given[i] - expected) <= precision) &&
          (nodes.empty() || nodes.back() != mesh.nodeNumbers[i / 3]))
      {
        nodes.push_back(mesh.nodeNumbers[i / 3]);
      }
    }
    return nodes;
  };
  const std::vector<Index> other = elsewhere(std::vector<double>(given.size(), 0));
  if (other.empty())
  {
    return {};
  }
  std::vector<double> added;
  for (Index step = 0; !isMorphed && !(added = file->displacementsAt(step)).empty(); ++step)
  {
    if (elsewhere(added).empty())
    {
      const Numbering nodes(mesh.nodeNumbers, "node", original);
      std::vector<double> exact;
      for (const Index number : numbers)
      {
        const auto first = static_cast<std::size_t>(3 * nodes.find(number));
        for (std::size_t i = first; i < first + 3; ++i)
        {
          exact.push_back(mesh.coordinates[i] + added[i]);
        }
      }
      return exact;
    }
  }
  throw Error(printable(
    "Cannot write the coordinates into a copy of " + original +
    ": before the morph, nodes were not at the file's own coordinates: " + listIds(other) +
    ". The displacements '" + mesh.displacementName +
    "' of the file were added, or filters moved the mesh more than once. If the reader has Apply "
    "Displacements on, switch it off, or read the file with Solver File Reader, which takes its "
    "own coordinates. To keep such displacements, first write them alone into a copy."));
}

void requireWritable(const std::string& original, const std::string& out)
{
  const Format& format = requireFormat(original);
  if (!format.isBuilt)
  {
    format.read(original); // says what is missing
  }
  for (const std::string& target : format.targets(original, out))
  {
    requireReplaceable(target, format.makesFolder);
  }
}
}
