// SPDX-License-Identifier: BSD-3-Clause
#include "Designs.h"

#include "Arguments.h"
#include "DesignTable.h"
#include "Files.h"
#include "Messages.h"
#include "NumberColumns.h"
#include "ProgressBar.h"

#include "Files/ReplaceFile.h"

#include <vtkMorphShapes.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <set>
#include <sstream>

namespace morph_mesh
{
namespace
{
namespace fs = std::filesystem;
namespace io = morph::io;

std::string contentOf(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

/// A number that tells two files apart: FNV-1a, 64 bits.
std::string hashOf(const std::string& path)
{
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : contentOf(path))
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  std::ostringstream text;
  text << std::hex << hash;
  return text.str();
}

std::string number(double value)
{
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

std::vector<std::string> namesOf(const std::vector<std::string>& files)
{
  std::vector<std::string> names;
  for (const std::string& file : files)
  {
    names.push_back(fs::path(file).stem().string());
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() != names.size())
  {
    throw UsageError("Two files of --shapes have the same name; a shape is called as its file.");
  }
  return names;
}

/// What the designs of a folder were made from: a run continues only where this is the same.
std::string descriptionOf(const Arguments& arguments)
{
  std::string text = "morph-mesh " MESHMORPHING_VERSION "\noptions" + arguments.properties.all() +
                     "\nmesh " + hashOf(arguments.grid) + "\n";
  for (const std::string& shape : arguments.shapes)
  {
    text += "shape " + fs::path(shape).stem().string() + " " + hashOf(shape) + "\n";
  }
  for (const std::string& shape : arguments.rotations)
  {
    text += "rotation " + shape + "\n";
  }
  return text;
}

/// The folder of the designs.
class Folder
{
public:
  Folder(const Arguments& arguments, const std::vector<std::string>& shapes)
    : folder_(arguments.output)
    , header_("Design")
  {
    for (const std::string& shape : shapes)
    {
      this->header_ += ",\"" + shape + "\"";
    }
    this->header_ +=
      ",MinScaledJacobian,MeanScaledJacobian,InvertedCells,DegenerateCells,NewInvertedCells";
    std::error_code error;
    fs::create_directories(this->folder_, error);
    if (!fs::is_directory(this->folder_))
    {
      throw Failure("Cannot make the folder " + this->folder_.string() + ": " + error.message());
    }
    this->requireSameRun(descriptionOf(arguments));
    this->readQuality();
  }

  std::string fileOf(std::size_t design) const
  {
    std::ostringstream name;
    name << "design_" << std::setw(4) << std::setfill('0') << design << ".vtu";
    return (this->folder_ / name.str()).string();
  }

  /// The line of the table of quality up to the weights.
  static std::string key(std::size_t design, const std::vector<double>& weights)
  {
    std::string text = std::to_string(design);
    for (const double weight : weights)
    {
      text += "," + number(weight);
    }
    return text + ",";
  }

  /// The line of a design that is there already; empty where it is not.
  std::string lineOf(std::size_t design, const std::vector<double>& weights) const
  {
    const std::string begin = key(design, weights);
    const auto found = std::find_if(this->lines_.begin(), this->lines_.end(),
      [&](const std::string& line) { return line.compare(0, begin.size(), begin) == 0; });
    return found != this->lines_.end() && fs::exists(this->fileOf(design)) ? *found : "";
  }

  /// Writes the table with these lines, in the place of all others. Empty ones are left out.
  void writeQuality(const std::vector<std::string>& lines)
  {
    std::string content = this->header_ + "\n";
    for (const std::string& line : lines)
    {
      content += line + (line.empty() ? "" : "\n");
    }
    io::replaceFile(
      (this->folder_ / "quality.csv").string(), content, io::Signals::RemoveTemporaries);
  }

private:
  void requireSameRun(const std::string& description) const
  {
    const fs::path file = this->folder_ / "run.txt";
    if (fs::exists(file) && contentOf(file) != description)
    {
      throw Failure(this->folder_.string() +
                    " holds designs of another mesh, other shapes or other options (run.txt). "
                    "Choose another folder, or delete this one.");
    }
    io::replaceFile(file.string(), description, io::Signals::RemoveTemporaries);
  }

  void readQuality()
  {
    std::istringstream content(contentOf(this->folder_ / "quality.csv"));
    for (std::string line; std::getline(content, line);)
    {
      if (!content.eof()) // else the line was cut off
      {
        this->lines_.push_back(line);
      }
    }
  }

  fs::path folder_;
  std::string header_;
  std::vector<std::string> lines_;
};

vtkSmartPointer<vtkMorphShapes> makeFilter(
  const Arguments& arguments, const std::vector<std::string>& names)
{
  auto filter = vtkSmartPointer<vtkMorphShapes>::New();
  if (arguments.properties.number("Method", 0) > vtkMorphShapes::METHOD_RADIAL_BASIS)
  {
    throw UsageError("--shapes needs a linear method, which " + arguments.method() + " is not.");
  }
  filter->SetMethod(static_cast<int>(arguments.properties.number("Method", 0)));
  arguments.properties.apply({ filter }, "on --shapes");
  filter->SetNumberOfThreads(arguments.threads);
  filter->FindValidRangesOff();
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    filter->SetShapeName(static_cast<int>(i), names[i].c_str());
    filter->AddShapeData(readPoints(arguments.shapes[i]));
  }
  for (const std::string& shape : arguments.rotations)
  {
    const auto found = std::find(names.begin(), names.end(), shape);
    if (found == names.end())
    {
      throw UsageError("--as-rotation names '" + shape + "', which is no file of --shapes.");
    }
    filter->SetMotion(static_cast<int>(found - names.begin()), vtkMorphShapes::MOTION_AS_ROTATION);
  }
  filter->SetInputData(readGrid(arguments.grid));
  return filter;
}

/// Makes one design and returns its line of the table of quality.
std::string makeDesign(vtkMorphShapes* filter, const std::vector<double>& weights,
  std::size_t design, const Folder& folder, const std::string& label, const Arguments& arguments)
{
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    filter->SetWeight(static_cast<int>(i), weights[i]);
  }
  Messages messages(filter);
  {
    const ProgressBar bar(filter, label, arguments.progress && !arguments.quiet);
    messages.update("Cannot make design " + std::to_string(design));
  }
  for (const std::string& warning : messages.warnings())
  {
    std::cerr << "morph-mesh: warning: " << warning << "\n";
  }
  writeGrid(filter->GetOutput(), folder.fileOf(design));
  return Folder::key(design, weights) + number(filter->GetMinScaledJacobian()) + "," +
         number(filter->GetMeanScaledJacobian()) + "," +
         std::to_string(filter->GetInvertedCells()) + "," +
         std::to_string(filter->GetDegenerateCells()) + "," +
         std::to_string(filter->GetNewInvertedCells());
}

bool hasBadCells(const std::string& line)
{
  return splitLine(line).back() != "0";
}
}

int writeDesigns(const Arguments& arguments)
{
  const std::vector<std::string> names = namesOf(arguments.shapes);
  const DesignTable table = readTable(arguments.table, names);
  for (const std::string& column : table.ignored)
  {
    std::cerr << "morph-mesh: warning: the column '" << column << "' of " << arguments.table
              << " is no shape's, and has no effect.\n";
  }
  const vtkSmartPointer<vtkMorphShapes> filter = makeFilter(arguments, names);
  Folder folder(arguments, names);
  std::vector<std::string> lines; // empty where a design is still to be made
  for (std::size_t design = 0; design < table.rows.size(); ++design)
  {
    lines.push_back(folder.lineOf(design, table.rows[design]));
  }
  folder.writeQuality(lines);
  const auto there = lines.size() - std::count(lines.begin(), lines.end(), "");
  for (std::size_t design = 0; design < lines.size(); ++design)
  {
    if (lines[design].empty())
    {
      const std::string label =
        "design " + std::to_string(design + 1) + " of " + std::to_string(lines.size());
      lines[design] = makeDesign(filter, table.rows[design], design, folder, label, arguments);
      folder.writeQuality(lines);
    }
  }
  const auto bad = std::count_if(lines.begin(), lines.end(), hasBadCells);
  if (!arguments.quiet)
  {
    std::cout << lines.size() << " designs, " << there << " of them there already; " << bad
              << " with inverted or collapsed cells\n";
  }
  return arguments.requireValid && bad > 0 ? 3 : 0;
}
}
