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
const char* const Usage =
  "Usage: morph-mesh [options] <grid> <boundary> <output>\n"
  "       morph-mesh --move <surface> --translate <x,y,z> [options] "
  "<grid> <output>\n"
  "       morph-mesh --target <surface file> [options] <grid> <output>\n"
  "       morph-mesh --handles <csv> | --lattice <csv> [options] <grid> <output>\n"
  "       morph-mesh --displacements <csv> [options] <grid> <output>\n"
  "       morph-mesh --list-surfaces <grid>\n"
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
  "Reads  .vtu .pvtu .vtm .vtk .inp (AVS UCD) .neu (Gambit); boundaries also\n"
  "       .vtp .pvtp .ply .stl .obj; solvers' files .inp (Abaqus, CalculiX)\n"
  "       .bdf .nas .fem .dat (Nastran) .k .key .dyn (LS-DYNA) .cdb (Ansys)\n"
  "       .su2 .msh (Gmsh)\n"
  "       .e .exo .ex2 .exii .g .gen (Exodus II) .cgns, cases of OpenFOAM\n"
  "Writes .vtu .vtk, boundaries .vtp .vtk; with a .pvtu, .vtm or solver's file as grid, "
  "also a copy of it\n"
  "       with nothing but its coordinates changed: <output> has the same "
  "extension\n"
  "\n"
  "Options:\n";

const char* const ExitStatus = "\n"
                               "Exit status: 0 the result is written; 1 an error, nothing is "
                               "written and an old file stays;\n"
                               "2 the command line is wrong;\n"
                               "3 the result is written, but the motion has inverted or "
                               "collapsed cells and --require-valid was\n"
                               "given, or --validity SubStep, Repair or RepairAll came only part "
                               "of the way: the output does not\nfit the boundary.\n";

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

/// From 0 on.
double numberUpTo(const std::string& option, const std::string& text, double most)
{
  const double value = number(option, text);
  if (!(value >= 0 && value <= most))
  {
    throw UsageError(
      option + " needs a number from 0 to " + std::to_string(int(most)) + ", not '" + text + "'.");
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

template <std::size_t Count>
std::array<double, Count> numbers(const std::string& option, const std::string& text)
{
  std::array<double, Count> values = {};
  std::istringstream parts(text);
  std::size_t found = 0;
  for (std::string part; std::getline(parts, part, ','); ++found)
  {
    values[std::min(found, Count - 1)] = number(option, part);
  }
  if (found != Count)
  {
    throw UsageError(option + " needs " + (Count == 3 ? "three" : "six") +
                     " numbers with commas between them, not '" + text + "'.");
  }
  return values;
}

/// A single number stands for all three.
std::array<double, 3> tripleOrOne(const std::string& option, const std::string& text)
{
  if (text.find(',') == std::string::npos)
  {
    const double value = number(option, text);
    return { value, value, value };
  }
  return numbers<3>(option, text);
}

std::array<int, 3> latticeSize(const std::string& text)
{
  const std::array<double, 3> values = numbers<3>("--lattice-size", text);
  std::array<int, 3> size = {};
  for (int i = 0; i < 3; ++i)
  {
    if (!(values[i] >= 2 && values[i] <= 30) || values[i] != std::floor(values[i]))
    {
      throw UsageError("--lattice-size needs whole numbers from 2 to 30, not '" + text + "'.");
    }
    size[i] = static_cast<int>(values[i]);
  }
  return size;
}

/// "z,30": degrees about an axis.
std::array<double, 3> rotation(const std::string& text)
{
  const std::size_t axis = text.empty() ? std::string::npos : std::string("xyz").find(text[0]);
  if (axis == std::string::npos || text.size() < 3 || text[1] != ',')
  {
    throw UsageError(
      "--rotate needs an axis (x, y or z), a comma and degrees, not '" + text + "'.");
  }
  std::array<double, 3> degrees = { 0, 0, 0 };
  degrees[axis] = number("--rotate", text.substr(2));
  return degrees;
}

int wholeNumber(const char* option, const std::string& text)
{
  const double value = number(option, text);
  if (!(value >= 1 && value <= 1000000) || value != static_cast<int>(value))
  {
    throw UsageError(
      std::string(option) + " needs a whole number from 1 to 1000000, not '" + text + "'.");
  }
  return static_cast<int>(value);
}

std::string surfaceMethod(const std::string& text)
{
  if (text != "WeightedResidual" && text != "Smoothing" && text != "MeshSmoothing")
  {
    throw UsageError(
      "--surface-method needs WeightedResidual, Smoothing or MeshSmoothing, not '" + text + "'.");
  }
  return text;
}

void setProjection(const std::string& text, Motion& motion)
{
  const std::string names[] = { "x", "y", "z", "normal" };
  const auto found = std::find(std::begin(names), std::end(names), text);
  motion.projectAlong = 1 + static_cast<int>(found - std::begin(names));
  if (found == std::end(names))
  {
    motion.projectVector = numbers<3>("--project-along", text);
  }
}

/// Throws UsageError where the options of the motion contradict each other.
void checkMotion(const Arguments& arguments)
{
  const Motion& motion = arguments.motion;
  if (!motion.displacements.empty() && motion.isMade())
  {
    throw UsageError(
      "--displacements cannot be combined with --move, --target, --handles or --lattice.");
  }
  const Motion none;
  const bool hasNumbers = motion.isPlaced() || motion.radius;
  if (motion.moving.empty() && hasNumbers)
  {
    throw UsageError("--translate, --rotate, --scale and --radius need --move.");
  }
  if (!motion.isMade() &&
      (!motion.fixed.empty() || !motion.sliding.empty() || !motion.free.empty()))
  {
    throw UsageError("--fix, --slide and --free need --move, --target, --handles or --lattice.");
  }
  if (!motion.isMade() && !motion.surfaceMethod.empty())
  {
    throw UsageError("--surface-method needs --move, --target, --handles or --lattice.");
  }
  if (motion.slideRounds > 0 && motion.sliding.empty())
  {
    throw UsageError("--slide-rounds needs --slide.");
  }
  if (motion.slideRounds > 20)
  {
    throw UsageError("--slide-rounds is at most 20.");
  }
  if (!motion.isMade() &&
      (!motion.frozen.empty() || !motion.rigid.empty() || motion.keepLayers > 0))
  {
    throw UsageError(
      "--freeze, --rigid and --keep-layers need --move, --target, --handles or --lattice.");
  }
  if (!motion.target.empty() && hasNumbers)
  {
    throw UsageError(
      "--target cannot be combined with --translate, --rotate, --scale or --radius.");
  }
  if (motion.align && motion.target.empty())
  {
    throw UsageError("--align needs --target.");
  }
  if ((motion.projectAlong != 0 || motion.targetReach || motion.targetAngle) &&
      motion.target.empty())
  {
    throw UsageError("--project-along, --target-reach and --target-angle need --target.");
  }
  if (motion.isPlaced() && motion.radius)
  {
    throw UsageError("--radius cannot be combined with --translate, --rotate or --scale.");
  }
  if (motion.byControlPoints() && (hasNumbers || !motion.target.empty() ||
                                    (!motion.handles.empty() && !motion.lattice.empty())))
  {
    throw UsageError("Only one of --handles, --lattice, --target, --radius, and --translate, "
                     "--rotate and --scale is possible.");
  }
  if (motion.lattice.empty() &&
      (motion.latticeSize != none.latticeSize || motion.hasLatticeBox || motion.bSplines))
  {
    throw UsageError("--lattice-size, --lattice-box and --b-splines need --lattice.");
  }
  if (!motion.moving.empty() && !hasNumbers && motion.target.empty() && !motion.byControlPoints())
  {
    throw UsageError("--move needs --translate, --rotate, --scale, --radius, --target, --handles "
                     "or --lattice.");
  }
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
  if (result.scaleFactor != 1 || result.postSmooth || result.validity != "Report" ||
      result.results || !result.criteria.empty())
  {
    throw UsageError("--scale-factor, --post-smooth, --validity, --results and --criteria have no "
                     "effect on --shapes: remove them.");
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
  const bool lists = result.task == Arguments::Task::ListSurfaces;
  const bool reads = morphs && !result.motion.any();
  const std::size_t expected = lists ? 1 : reads ? 3 : 2;
  if (files.size() != expected)
  {
    throw UsageError(std::to_string(expected) + (lists ? " file is" : " files are") + " needed (" +
                     (lists     ? "grid"
                       : reads  ? "grid, boundary, output"
                       : morphs ? "grid, output"
                                : "grid, boundary") +
                     "), " + std::to_string(files.size()) +
                     (files.size() == 1 ? " is given." : " are given."));
  }
  result.grid = files.front();
  result.boundary = reads ? files[1] : "";
  result.output = lists ? "" : files.back();
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
      "what to do about cells that the motion inverts, by default\nReport: None, Report (warn), "
      "SubStep, Repair, Refuse (an error);\nRepairAll repairs those that were inverted before, too",
      text(result.validity) },
    { "--criteria", "<name>[=<limit>],...",
      "also report these, with the worst cell and how many are beyond the limit, before and after: "
      "AspectRatio,\nSkewness, Warpage, JacobianRatio, Taper, NonOrthogonality, FaceSkewness, "
      "FacePyramid, FirstHeight;\nFirstHeight:BLADE is that of a surface that the file names",
      text(result.criteria) },
    { "--require-valid", nullptr, "exit status 3 if the motion inverts or collapses a cell",
      flag(result.requireValid) },
    { "--threads", "<number>", "threads to compute with; by default 0, all cores",
      [&](const std::string& value) { result.threads = threadCount(value); } },
    { "--progress", nullptr, "show progress even if standard error is no terminal",
      flag(result.progress) },
    { "--quiet", nullptr, "print nothing but warnings and errors", flag(result.quiet) },
    { "--move", "<surface>",
      "a surface or curve that moves, as --list-surfaces names it; may be repeated",
      [&](const std::string& value) { result.motion.moving.push_back(value); } },
    { "--translate", "<x,y,z>", "how far it moves",
      [&](const std::string& value)
      { result.motion.translation = numbers<3>("--translate", value); } },
    { "--rotate", "<axis,degrees>", "how it turns about its centre: z,30",
      [&](const std::string& value) { result.motion.rotation = rotation(value); } },
    { "--scale", "<factor>|<x,y,z>", "how it is scaled about its centre",
      [&](const std::string& value) { result.motion.scale = tripleOrOne("--scale", value); } },
    { "--center", "<x,y,z>", "another centre",
      [&](const std::string& value)
      {
        result.motion.center = numbers<3>("--center", value);
        result.motion.hasCenter = true;
      } },
    { "--radius", "<change>", "how much the radius of the cylinders grows that move",
      [&](const std::string& value) { result.motion.radius = number("--radius", value); } },
    { "--fix", "<surface>", "a surface that stays; may be repeated",
      [&](const std::string& value) { result.motion.fixed.push_back(value); } },
    { "--slide", "<surface>",
      "a surface whose nodes slide along it, a plane of symmetry; repeatable",
      [&](const std::string& value) { result.motion.sliding.push_back(value); } },
    { "--slide-rounds", "<number>",
      "iterate what slides with the volume, up to so many rounds (20 at most)",
      [&](const std::string& value)
      { result.motion.slideRounds = wholeNumber("--slide-rounds", value); } },
    { "--surface-method", "<name>",
      "how surfaces follow what moves, by default WeightedResidual:\nWeightedResidual, Smoothing, "
      "MeshSmoothing",
      [&](const std::string& value) { result.motion.surfaceMethod = surfaceMethod(value); } },
    { "--free", "<surface>", "a surface whose nodes are solved with the interior; repeatable",
      [&](const std::string& value) { result.motion.free.push_back(value); } },
    { "--freeze", "<zone>",
      "a part of the mesh that stays, inner nodes too: where an array is not 0; repeatable",
      [&](const std::string& value) { result.motion.frozen.push_back(value); } },
    { "--rigid", "<zone>", "a part of the mesh that moves as one body; repeatable",
      [&](const std::string& value) { result.motion.rigid.push_back(value); } },
    { "--keep-layers", "<number>",
      "keep up to so many layers of hexahedra or wedges on what moves: heights and angles",
      [&](const std::string& value)
      { result.motion.keepLayers = wholeNumber("--keep-layers", value); } },
    { "--target", "<file>",
      "a surface onto which the surfaces of --move go; without --move, those that it belongs to",
      text(result.motion.target) },
    { "--align", nullptr, "rotate and shift the target onto what moves first",
      flag(result.motion.align) },
    { "--project-along", "<direction>",
      "x, y, z, normal or dx,dy,dz: how nodes go to the target; by default to the closest point",
      [&](const std::string& value) { setProjection(value, result.motion); } },
    { "--target-reach", "<number>",
      "how far nodes may go to the target, in diagonals of the boundary's box; by default 0.2",
      [&](const std::string& value)
      { result.motion.targetReach = numberUpTo("--target-reach", value, 10); } },
    { "--target-angle", "<degrees>",
      "the largest angle between the normals of target and surface; by default 60",
      [&](const std::string& value)
      { result.motion.targetAngle = numberUpTo("--target-angle", value, 180); } },
    { "--handles", "<csv>",
      "points that take what moves along smoothly (without --move, everything): columns x, y, z, "
      "dx, "
      "dy, dz\nand, optional, radius (0: no limit)",
      text(result.motion.handles) },
    { "--lattice", "<csv>",
      "control points of a box that move what is inside (without --move, everything): columns i, "
      "j, "
      "k,\ndx, dy, dz",
      text(result.motion.lattice) },
    { "--lattice-size", "<l,m,n>", "its control points in each direction, by default 3,3,3",
      [&](const std::string& value) { result.motion.latticeSize = latticeSize(value); } },
    { "--lattice-box", "<xmin,xmax,ymin,ymax,zmin,zmax>", "by default the box around what moves",
      [&](const std::string& value)
      {
        result.motion.latticeBox = numbers<6>("--lattice-box", value);
        result.motion.hasLatticeBox = true;
      } },
    { "--b-splines", nullptr, "cubic B-splines of the lattice, in place of Bernstein's polynomials",
      flag(result.motion.bSplines) },
    { "--displacements", "<csv>",
      "nodes that move: columns id (0-based point id), dx, dy, dz; or pointDisplacement of "
      "OpenFOAM",
      text(result.motion.displacements) },
    { "--node-numbers", nullptr, "ids of --displacements are the node numbers of the grid's file",
      flag(result.motion.nodeNumbers) },
    { "--steps", "<number>",
      "write the equal steps of the motion: <output> with -1, -2, ... before its extension",
      [&](const std::string& value) { result.steps = wholeNumber("--steps", value); } },
    { "--results", nullptr,
      "write the arrays that the morph adds, too: scaled Jacobian and the like; by default the\n"
      "arrays of <grid> alone",
      flag(result.results) },
    { "--list-surfaces", nullptr, "print name, faces, area and centre of each surface, and stop",
      task(Task::ListSurfaces) },
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
  checkMotion(result);
  takeFiles(files, result);
  return result;
}
}
