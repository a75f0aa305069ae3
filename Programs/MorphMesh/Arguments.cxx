// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"

#include "Methods.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <sstream>

namespace morph_mesh
{
namespace
{
const char* const Usage = "Usage: morph-mesh [options] <grid> <boundary> <output>\n"
                          "       morph-mesh --extract-boundary <grid> <boundary>\n"
                          "       morph-mesh [options] <grid> --shapes <boundary>... --table "
                          "<table> --output <folder>\n"
                          "\n"
                          "Moves the nodes of a volume mesh so that it fits its displaced "
                          "boundary, writes it, and prints its quality.\n"
                          "The boundary is what --extract-boundary writes, with its points moved "
                          "by any program that keeps the point\n"
                          "array MorphPointId; or points with --boundary-id-array; or "
                          "undeformed points with --displacement-array.\n"
                          "\n"
                          "Reads  .vtu .pvtu .vtk .inp (AVS UCD) .neu (Gambit) .e .exo .ex2 .exii "
                          "(Exodus II); boundaries also\n"
                          "       .vtp .pvtp .ply .stl .obj\n"
                          "Writes .vtu .vtk, boundaries .vtp .vtk\n"
                          "\n"
                          "Options:\n";

const char* const ExitStatus = "\n"
                               "Exit status: 0 the result is written; 1 an error, nothing is "
                               "written and an old file stays;\n"
                               "2 the command line is wrong;\n"
                               "3 the result is written, but has inverted or collapsed cells and "
                               "--require-valid was given, or\n"
                               "--validity SubStep or Repair came only part of the way: the "
                               "output does not fit the boundary.\n";

double number(const std::string& option, const std::string& text)
{
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || errno == ERANGE || !std::isfinite(value))
  {
    throw UsageError(option + " needs a number, not '" + text + "'.");
  }
  return value;
}

int threadCount(const std::string& text)
{
  const double value = number("--threads", text);
  if (!(value >= 0 && value <= INT_MAX) || value != static_cast<int>(value))
  {
    throw UsageError("--threads needs a whole number from 0, not '" + text + "'.");
  }
  return static_cast<int>(value);
}

std::pair<std::string, std::string> nameAndValue(const std::string& text)
{
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
  {
    throw UsageError("--set needs <name>=<value>, not '" + text + "'.");
  }
  return { text.substr(0, equals), text.substr(equals + 1) };
}

/// Throws UsageError unless all that a table of designs needs is given, and nothing else.
void takeDesigns(const std::vector<std::string>& files, Arguments& result)
{
  if (result.shapes.empty() || result.table.empty() || result.output.empty())
  {
    throw UsageError("Designs need --shapes, --table and --output, all three.");
  }
  if (files.size() != 1 || result.task == Arguments::Task::ExtractBoundary)
  {
    throw UsageError("With --shapes one more file is needed, the grid; " +
                     std::to_string(files.size()) + " are given.");
  }
  if (result.scaleFactor != 1 || result.postSmooth || result.validity != "Report")
  {
    throw UsageError(
      "--scale-factor, --post-smooth and --validity have no effect on --shapes: remove them.");
  }
  result.grid = files.front();
  result.task = Arguments::Task::WriteDesigns;
}

void takeFiles(const std::vector<std::string>& files, Arguments& result)
{
  if (!result.shapes.empty() || !result.table.empty() || !result.output.empty() ||
      !result.rotations.empty())
  {
    takeDesigns(files, result);
    return;
  }
  const bool morphs = result.task == Arguments::Task::Morph;
  const std::size_t expected = morphs ? 3 : 2;
  if (files.size() != expected)
  {
    throw UsageError(std::to_string(expected) + " files are needed (" +
                     (morphs ? "grid, boundary, output" : "grid, boundary") + "), " +
                     std::to_string(files.size()) + " are given.");
  }
  result.grid = files.front();
  result.boundary = morphs ? files[1] : "";
  result.output = files.back();
}

struct Option
{
  std::string name;
  const char* value; ///< how the help calls it; null for an option without one
  std::string help;
  std::function<void(const std::string& value)> take;
};

std::vector<Option> optionsOf(Arguments& result)
{
  using Task = Arguments::Task;
  const auto text = [](std::string& target)
  { return [&target](const std::string& value) { target = value; }; };
  const auto flag = [](bool& target) { return [&target](const std::string&) { target = true; }; };
  const auto task = [&result](Task task)
  { return [&result, task](const std::string&) { result.task = task; }; };
  return {
    { "--method", "<name>", "the method, by default FEMWARP:\n" + methodNames(),
      text(result.method) },
    { "--set", "<name>=<value>", "an option of the method; may be repeated:\n" + optionNames(),
      [&](const std::string& value) { result.options.push_back(nameAndValue(value)); } },
    { "--shapes", "<boundary>...",
      "shapes, one displaced boundary each, whose motions are added with weights; up to the next "
      "option",
      [&](const std::string& value) { result.shapes.push_back(value); } },
    { "--table", "<file>",
      "the weights, comma-separated values: a column for each shape, named as its file without "
      "extension,\nand a line for each design",
      text(result.table) },
    { "--output", "<folder>",
      "of design_0000.vtu and so on, and quality.csv; a run that was stopped continues there",
      text(result.output) },
    { "--as-rotation", "<shape>",
      "the weight of this shape is the factor of its angle; may be repeated",
      [&](const std::string& value) { result.rotations.push_back(value); } },
    { "--boundary-id-array", "<name>", "point array of the boundary that holds node ids",
      text(result.boundaryIdArray) },
    { "--displacement-array", "<name>", "point vectors of the boundary by which its nodes move",
      text(result.displacementArray) },
    { "--scale-factor", "<number>", "the factor of the motion; by default 1",
      [&](const std::string& value) { result.scaleFactor = number("--scale-factor", value); } },
    { "--free-unnamed-boundary", nullptr,
      "let the outer nodes move that the boundary does not name; by default they stay",
      flag(result.freeUnnamedBoundary) },
    { "--post-smooth", nullptr, "smooth the method's result, before --validity checks it",
      flag(result.postSmooth) },
    { "--validity", "<name>",
      "what to do about inverted cells, by default Report:\nNone, Report (warn), SubStep, Repair, "
      "Refuse (an error)",
      text(result.validity) },
    { "--require-valid", nullptr, "exit status 3 if a cell is inverted or collapsed",
      flag(result.requireValid) },
    { "--threads", "<number>", "threads to compute with; by default 0, all cores",
      [&](const std::string& value) { result.threads = threadCount(value); } },
    { "--progress", nullptr, "show progress even if standard error is no terminal",
      flag(result.progress) },
    { "--quiet", nullptr, "print nothing but warnings and errors", flag(result.quiet) },
    { "--extract-boundary", nullptr, "write the grid's boundary, to be moved, and stop",
      task(Task::ExtractBoundary) },
    { "--version", nullptr, "print the version and stop", task(Task::ShowVersion) },
    { "--help", nullptr, "print this and stop", task(Task::ShowHelp) },
  };
}

std::string helpOf(const std::vector<Option>& options)
{
  std::string result = Usage;
  for (const Option& option : options)
  {
    result += "  " + option.name + (option.value ? std::string(" ") + option.value : "") + "\n";
    std::istringstream lines(option.help);
    for (std::string line; std::getline(lines, line);)
    {
      result += "      " + line + "\n";
    }
  }
  return result + ExitStatus;
}

/// Takes `argument` as option, with its value from `next` where it has one.
template <typename Next>
void takeOption(const std::vector<Option>& options, const std::string& argument, Next next)
{
  const std::size_t equals = argument.find('=');
  const std::string name = argument.substr(0, equals);
  const auto option = std::find_if(
    options.begin(), options.end(), [&](const Option& one) { return one.name == name; });
  if (option == options.end())
  {
    throw UsageError("There is no option " + name + ".");
  }
  if (!option->value && equals != std::string::npos)
  {
    throw UsageError(name + " takes no value.");
  }
  option->take(!option->value                ? std::string()
               : equals != std::string::npos ? argument.substr(equals + 1)
                                             : next(name));
}
}

Arguments parseArguments(int argc, char* argv[])
{
  Arguments result;
  const std::vector<Option> options = optionsOf(result);
  std::vector<std::string> files;
  bool onlyFiles = false;
  bool isAfterShapes = false; // the option with more than one value
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (onlyFiles || argument[0] != '-')
    {
      (isAfterShapes ? result.shapes : files).push_back(argument);
    }
    else if (argument == "--")
    {
      onlyFiles = true;
    }
    else
    {
      isAfterShapes = argument == "--shapes";
      takeOption(options, argument,
        [&](const std::string& name) -> std::string
        {
          if (++i == argc)
          {
            throw UsageError(name + " needs a value.");
          }
          return argv[i];
        });
    }
    if (result.task == Arguments::Task::ShowHelp || result.task == Arguments::Task::ShowVersion)
    {
      result.help = helpOf(options);
      return result;
    }
  }
  takeFiles(files, result);
  return result;
}
}
