// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Files.h"
#include "Messages.h"

#include "Files/ReadFile.h"
#include "Files/ReplaceFile.h"

#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <unordered_map>

namespace morph_mesh
{
namespace
{
namespace fs = std::filesystem;
namespace io = morph::io;

/// A piece's file, and the name of its block in a .vtm, or empty.
struct Source
{
  std::string file, block;
};

/// Of an element and those below it.
void collectSources(vtkXMLDataElement* element, std::vector<Source>& sources)
{
  const bool isPiece = std::strcmp(element->GetName(), "Piece") == 0;
  const bool isDataSet = std::strcmp(element->GetName(), "DataSet") == 0;
  const char* source = isPiece     ? element->GetAttribute("Source")
                       : isDataSet ? element->GetAttribute("file")
                                   : nullptr;
  if (source)
  {
    const char* name = element->GetAttribute("name");
    sources.push_back({ source, isDataSet && name ? name : "" });
  }
  for (int i = 0; i < element->GetNumberOfNestedElements(); ++i)
  {
    collectSources(element->GetNestedElement(i), sources);
  }
}

std::vector<Source> sourcesOf(const std::string& path)
{
  const std::string text = io::readFile(path);
  ConsoleMessages inner; // the parser's
  const auto root =
    vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(text.c_str()));
  std::vector<Source> sources;
  if (root)
  {
    collectSources(root, sources);
  }
  if (sources.empty())
  {
    throw Failure("Cannot read " + path +
                  ": the file is damaged, or not what its extension says: it names no piece.");
  }
  for (const auto& [file, block] : sources)
  {
    if (isListOfPieces(file))
    {
      throw Failure(
        "Cannot read " + path + ": it names " + file + ", a list of pieces again. Give that file.");
    }
  }
  return sources;
}

std::string beside(const std::string& path, const std::string& source)
{
  return (fs::path(path).parent_path() / source).string();
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
  {
    text.replace(at, from.size(), to);
  }
  return text;
}

bool isSameFile(const std::string& a, const std::string& b)
{
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

/// What a copy of a list writes: the name of each piece in the list, old and new.
struct Renaming
{
  std::vector<std::string> from, to;
};

/// A piece that has the name of the list in its own gets the new one: part_0.vtu, moved_0.vtu.
Renaming renamingOf(const std::string& original, const std::string& path)
{
  Renaming result;
  for (const Source& source : sourcesOf(original))
  {
    result.from.push_back(source.file);
  }
  const std::string oldStem = fs::path(original).stem().string(),
                    newStem = fs::path(path).stem().string();
  for (const std::string& source : result.from)
  {
    result.to.push_back(replaced(source, oldStem, newStem));
    if (fs::path(source).is_absolute() || source.find("..") != std::string::npos)
    {
      throw Failure("Cannot write " + path + ": the original names the piece " + source +
                    ", which is not below its folder.");
    }
    if (!isSameFile(original, path) && fs::exists(beside(original, source)) &&
        isSameFile(beside(original, source), beside(path, result.to.back())))
    {
      throw Failure("Cannot write " + path + ": the original names the piece " + source +
                    ", which would be overwritten. Give another folder.");
    }
  }
  return result;
}

/// Tells a merged grid's points by their undeformed coordinates.
class PointsByPlace
{
public:
  explicit PointsByPlace(vtkUnstructuredGrid* grid)
  {
    this->Ids.reserve(static_cast<std::size_t>(grid->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      this->Ids.emplace(key(grid->GetPoint(i)), i);
    }
  }

  /// -1 where there is none.
  vtkIdType Find(const double x[3]) const
  {
    const auto found = this->Ids.find(key(x));
    return found == this->Ids.end() ? -1 : found->second;
  }

private:
  using Key = std::array<double, 3>;
  struct Hash
  {
    std::size_t operator()(const Key& key) const
    {
      return std::hash<std::string_view>()(
        { reinterpret_cast<const char*>(key.data()), sizeof(Key) });
    }
  };
  /// A zero with a sign equals one without.
  static Key key(const double x[3]) { return { x[0] + 0., x[1] + 0., x[2] + 0. }; }

  std::unordered_map<Key, vtkIdType, Hash> Ids;
};

/// The piece's points at their new places, and how many are no point of the mesh; `rounding` grows.
vtkSmartPointer<vtkPoints> movedPoints(vtkDataSet* piece, const PointsByPlace& places,
  vtkUnstructuredGrid* moved, int type, vtkIdType& strangers, double& rounding)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  points->SetNumberOfPoints(piece->GetNumberOfPoints());
  for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
  {
    double x[3];
    piece->GetPoint(i, x);
    const vtkIdType id = places.Find(x);
    strangers += id < 0;
    if (id >= 0)
    {
      moved->GetPoint(id, x);
    }
    points->SetPoint(i, x);
    double written[3];
    points->GetPoint(i, written);
    for (int axis = 0; axis < 3; ++axis)
    {
      rounding = std::max(rounding, std::abs(written[axis] - x[axis]));
    }
  }
  return points;
}

std::string contentOf(vtkDataSet* piece, const std::string& path)
{
  if (piece->IsA("vtkUnstructuredGrid"))
  {
    return xmlOf<vtkXMLUnstructuredGridWriter>(piece, path);
  }
  return piece->IsA("vtkPolyData") ? xmlOf<vtkXMLPolyDataWriter>(piece, path)
                                   : xmlOf<vtkXMLStructuredGridWriter>(piece, path);
}
}

bool isListOfPieces(const std::string& path)
{
  const std::string kind = extensionOf(path);
  return kind == ".pvtu" || kind == ".vtm";
}

std::vector<std::string> piecesOf(const std::string& path)
{
  std::vector<std::string> pieces;
  for (const Source& source : sourcesOf(path))
  {
    pieces.push_back(beside(path, source.file));
  }
  return pieces;
}

namespace
{
/// Marks the cells of a block by an array of its name; those of the other blocks by 0.
void markBlock(vtkDataSet* piece, const std::string& own, const std::vector<std::string>& all)
{
  for (const std::string& name : all)
  {
    vtkNew<vtkUnsignedCharArray> array;
    array->SetName(name.c_str());
    array->SetNumberOfValues(piece->GetNumberOfCells());
    array->FillValue(name == own ? 1 : 0);
    piece->GetCellData()->AddArray(array);
  }
}

/// The names of blocks, each once, but those of the pieces' own arrays.
std::vector<std::string> blocksOf(
  const std::vector<Source>& sources, const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  std::vector<std::string> names;
  for (const Source& source : sources)
  {
    const char* name = source.block.c_str();
    const bool isTaken = std::any_of(pieces.begin(), pieces.end(),
      [name](vtkDataObject* piece)
      {
        auto* data = vtkDataSet::SafeDownCast(piece);
        return data &&
               (data->GetCellData()->HasArray(name) || data->GetPointData()->HasArray(name));
      });
    const bool isNew = std::find(names.begin(), names.end(), source.block) == names.end();
    if (isNew && !source.block.empty() && !isTaken)
    {
      names.push_back(source.block);
    }
  }
  return names;
}
}

vtkSmartPointer<vtkUnstructuredGrid> mergedPieces(const std::string& path, const Part& part)
{
  vtkNew<vtkAppendFilter> append;
  append->MergePointsOn();
  append->AddInputData(vtkNew<vtkUnstructuredGrid>()); // a rank may have no piece
  const std::vector<Source> sources = sourcesOf(path);
  std::vector<vtkSmartPointer<vtkDataObject>> pieces(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    if (part.has(i, sources.size()))
    {
      pieces[i] = readFile(beside(path, sources[i].file));
    }
  }
  const std::vector<std::string> blocks = blocksOf(sources, pieces);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    vtkDataObject* data = pieces[i];
    if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
    {
      grid->RemoveGhostCells();
    }
    if (auto* piece = vtkDataSet::SafeDownCast(data))
    {
      markBlock(piece, sources[i].block, blocks);
      append->AddInputDataObject(piece);
    }
  }
  Messages messages(append);
  messages.update("Cannot read " + path);
  vtkSmartPointer<vtkUnstructuredGrid> merged = append->GetOutput();
  if (!blocks.empty())
  {
    vtkNew<vtkStringArray> names;
    names->SetName("SurfaceNames");
    for (const std::string& name : blocks)
    {
      names->InsertNextValue(name);
    }
    merged->GetFieldData()->AddArray(names);
  }
  return merged;
}

void requireWritablePieces(const std::string& original, const std::string& path)
{
  if (extensionOf(original) != extensionOf(path))
  {
    throw Failure("Cannot write " + path + ": a copy of " + original + " with moved points is " +
                  extensionOf(original) + " too; a single grid is written as .vtu or .vtk.");
  }
  for (const std::string& target : renamingOf(original, path).to)
  {
    io::requireReplaceable(beside(path, target), true);
  }
  io::requireReplaceable(path);
}

namespace
{
std::string renamedList(const std::string& original, const Renaming& names)
{
  std::string list = io::readFile(original);
  for (std::size_t i = 0; i < names.from.size(); ++i)
  {
    list = replaced(list, '"' + names.from[i] + '"', '"' + names.to[i] + '"');
  }
  return list;
}
}

double writePieces(vtkUnstructuredGrid* moved, const std::string& original, const std::string& path,
  const Part& part)
{
  const Renaming names = renamingOf(original, path);
  const vtkSmartPointer<vtkUnstructuredGrid> merged = mergedPieces(original, part);
  if (merged->GetNumberOfPoints() != moved->GetNumberOfPoints())
  {
    throw Failure("Cannot write " + path + ": " + original + " has changed since it was read.");
  }
  const PointsByPlace places(merged);
  std::vector<io::NewFile> files;
  vtkIdType strangers = 0;
  bool hasNormals = false;
  double rounding = 0;
  for (std::size_t i = 0; i < names.from.size(); ++i)
  {
    if (!part.has(i, names.from.size()))
    {
      continue;
    }
    const std::string source = beside(original, names.from[i]), target = beside(path, names.to[i]);
    const vtkSmartPointer<vtkDataObject> data = readFile(source);
    io::NewFile file;
    file.path = target;
    file.makeFolder = true;
    auto* piece = vtkPointSet::SafeDownCast(data);
    if (piece && piece->GetPoints())
    {
      const auto points =
        movedPoints(piece, places, moved, piece->GetPoints()->GetDataType(), strangers, rounding);
      piece->SetPoints(points);
      hasNormals =
        hasNormals || piece->GetPointData()->GetNormals() || piece->GetCellData()->GetNormals();
      file.content = contentOf(piece, target);
    }
    else
    {
      auto* image = vtkDataSet::SafeDownCast(data);
      if (image && image->GetNumberOfPoints() > 0 && image->GetNumberOfCells() > 0 && !piece)
      {
        throw Failure("Cannot write " + path + ": " + source + " is a " + data->GetClassName() +
                      ", whose points cannot be moved one by one.");
      }
      file.content = io::readFile(source);
    }
    files.push_back(std::move(file));
  }
  if (strangers > 0 && part.ranks > 1)
  {
    throw Failure("Cannot write " + path + ": " + std::to_string(strangers) +
                  " points of this rank's pieces are in ghost cells, or no nodes of the volume "
                  "mesh. Write the pieces without ghost cells, or run on one MPI rank.");
  }
  if (part.ranks == 1)
  {
    files.push_back({ path, renamedList(original, names) });
  }
  if (strangers > 0)
  {
    std::cerr << "morph-mesh: warning: " << original << ": " << strangers
              << " points of its pieces are no nodes of the volume mesh, and stay.\n";
  }
  if (hasNormals)
  {
    // A list of pieces names their arrays, so that they stay.
    std::cerr << "morph-mesh: warning: " << path
              << ": the normals of its pieces are those of the undeformed mesh. Make them again.\n";
  }
  io::replaceFiles(files, io::Signals::RemoveTemporaries);
  return rounding;
}

void writeListOfPieces(const std::string& original, const std::string& path)
{
  io::replaceFile(
    path, renamedList(original, renamingOf(original, path)), io::Signals::RemoveTemporaries);
}
}
