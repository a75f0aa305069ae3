// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"

#include <vtkMorphAlgorithm.h>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <sstream>

namespace morph_mesh
{
namespace
{
/// What comes first on a command line. Without one it is "move".
struct Command
{
  const char* name;
  Arguments::Task task;
  const char* what;
  const char* usage;
  const char* examples;
  std::vector<std::string> options; ///< that have an effect, beside those of all commands
  std::vector<std::string> groups;  ///< whose options have an effect
};

constexpr const char* Files = "Files and tasks";
const std::vector<std::string> OfAll = { "--region", "--threads", "--version", "--help" };
const std::vector<std::string> Blending = { "Method", "Method's options", "Computation",
  "Boundary" };
const std::vector<std::string> Repairing = { "Method", "Method's options", "Computation",
  "Rest of the boundary", "Zones and layers" };
const std::vector<std::string> Moving = { "Method", "Method's options", "Computation",
  "Rest of the boundary", "Zones and layers", "What moves", "How it moves", "Center of rotation",
  "Fit", "Lattice box", "Boundary" };
const std::vector<Command> Commands = {
  { "move", Arguments::Task::Morph, "move surfaces, or take a moved boundary; the inside follows",
    "[options] <grid> <output> | <grid> <boundary> <output>",
    "move --move inlet --translate 0,0,0.1 duct.vtu longer.vtu\n"
    "move --move 'Surface 3' --radius 0.2 --slide SYMMETRY part.inp wider.inp\n"
    "move --method radial-basis part.vtu moved.vtp morphed.vtu",
    { "--output", "--criteria", "--report", "--require-valid", "--progress", "--quiet", "--target",
      "--handles", "--lattice", "--field", "--displacements", "--node-numbers", "--time-step",
      "--steps", "--results" },
    Moving },
  { "fit", Arguments::Task::Morph, "move surfaces onto a target, such as an STL file",
    "--target <surface file> [options] <grid> <output>",
    "fit --target scan.stl part.vtu fitted.vtu\n"
    "fit --target scan.stl --align --move WALL part.inp fitted.inp\n"
    "fit --target terrain.stl --project-along z case case-on-terrain",
    { "--output", "--criteria", "--report", "--require-valid", "--progress", "--quiet", "--target",
      "--steps", "--results" },
    Moving },
  { "bake", Arguments::Task::Morph, "make the displacements in a file its coordinates",
    "--displacement-array <name> [options] <grid> <output>",
    "bake --displacement-array disp_ box.exo deformed.exo\n"
    "bake --displacement-array disp_ --time-step 3 box.exo third.exo\n"
    "bake --displacement-array U solved.vtu deformed.vtu",
    { "--output", "--criteria", "--report", "--require-valid", "--progress", "--quiet",
      "--displacement-array", "--time-step" },
    Blending },
  { "list", Arguments::Task::ListSurfaces, "print name, faces, area and center of each surface",
    "<grid>", "list part.vtu\nlist part.inp\nlist case", { "--list-surfaces" }, {} },
  { "check", Arguments::Task::Check, "measure the quality of a grid, without a morph",
    "[--criteria <name>,...] [--require-valid] <grid>",
    "check part.vtu\ncheck --criteria NonOrthogonality=70,Skewness case\n"
    "check --require-valid part.inp",
    { "--criteria", "--require-valid", "--quiet" }, {} },
  { "repair", Arguments::Task::Repair, "untangle inverted cells; the boundary stays",
    "[options] <grid> <output>",
    "repair tangled.vtu valid.vtu\nrepair --free-surfaces WALL tangled.inp valid.inp\n"
    "repair --effort thorough --method inversion-free tangled.vtu better.vtu",
    { "--output", "--criteria", "--report", "--require-valid", "--progress", "--quiet",
      "--results" },
    Repairing },
  { "extract", Arguments::Task::ExtractBoundary, "write the boundary, to be moved elsewhere",
    "<grid> <boundary>",
    "extract part.vtu boundary.vtp\nextract part.inp boundary.vtp\n"
    "extract case boundary.vtk",
    { "--output", "--quiet" }, {} },
  { "shapes", Arguments::Task::WriteDesigns, "make a mesh for each row of a table of designs",
    "--shapes <boundary>... --table <table> -o <folder> <grid>",
    "shapes part.vtu --shapes wide.vtp long.vtp --table designs.csv -o designs\n"
    "shapes part.vtu --method lbwarp --shapes wide.vtp --table designs.csv -o designs\n"
    "shapes part.vtu --shapes wide.vtp turn.vtp --as-rotation turn --table t.csv -o designs",
    { "--shapes", "--table", "--output", "--as-rotation", "--require-valid", "--progress",
      "--quiet", "--displacement-array" },
    Blending },
};

bool has(const std::vector<std::string>& list, const std::string& one)
{
  return std::find(list.begin(), list.end(), one) != list.end();
}

const char* const About =
  "Moves the nodes of a volume mesh so that it fits its displaced boundary, writes it, and prints "
  "its quality.\n\n";

const char* const Formats =
  "The boundary is what extract writes, with its points moved by any program that keeps the point\n"
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
  "extension\n";

const char* const ExitStatus = "\n"
                               "Exit status: 0 the result is written; 1 an error, nothing is "
                               "written and an old file stays;\n"
                               "2 the command line is wrong;\n"
                               "3 the result is written, but the motion inverts or collapses "
                               "cells or makes the boundary\n"
                               "cross itself, or came only part of the way: the output does not "
                               "fit the boundary.\n";

int wholeNumber(const char* option, const std::string& text, int least)
{
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || errno == ERANGE || value < least || value > 1000000)
  {
    throw UsageError(std::string(option) + " needs a whole number from " + std::to_string(least) +
                     " to 1000000, not '" + text + "'.");
  }
  return static_cast<int>(value);
}

/// Throws UsageError where the options of a motion do not go together.
void checkMotion(const Arguments& arguments)
{
  const GivenProperties& given = arguments.properties;
  const bool hasControl = !arguments.handles.empty() || !arguments.lattice.empty();
  const bool isMade = given.has("Moving") || given.has("Displacement");
  if (!arguments.boundary.empty() || !arguments.displacements.empty())
  {
    const std::string how = arguments.boundary.empty() ? "--displacements" : "a boundary's file";
    if (isMade && given.text("Displacement") != "Array")
    {
      throw UsageError("Give either " + how +
                       " or options by which the boundary moves, such as --move or --target.");
    }
    return;
  }
  if (!given.has("Moving") && !hasControl && arguments.target.empty())
  {
    throw UsageError("Nothing says what moves: give --move, and how, or --target, --handles, "
                     "--lattice, --displacements or a boundary.");
  }
  if (!given.has("Displacement"))
  {
    throw UsageError(
      "Nothing says how it moves: give --translate, --rotate, --scale, --radius, "
      "--distance, --displacement-array, --target, --handles, --lattice or --field.");
  }
  if (given.text("Displacement") == "Target" && arguments.target.empty())
  {
    throw UsageError(given.giver("Displacement") + " needs --target.");
  }
  if (given.text("Displacement") == "Field" && arguments.field.empty())
  {
    throw UsageError(given.giver("Displacement") + " needs --field.");
  }
  if (given.text("Displacement") == "Lattice" && arguments.lattice.empty())
  {
    throw UsageError(given.giver("Displacement") + " needs --lattice.");
  }
  if (given.hasZero("Scale"))
  {
    throw UsageError("--scale 0 makes what moves flat: give another factor than 0.");
  }
  if (given.has("Center") && !given.has("Rotation") && !given.has("Scale"))
  {
    throw UsageError("--center has no effect without --rotate or --scale: remove it.");
  }
  if (given.has("SlideRounds") && !given.has("SlidingSurfaces"))
  {
    throw UsageError("--slide-rounds needs --slide.");
  }
}

/// Throws UsageError unless all that a table of designs needs is given, and nothing else.
void takeDesigns(const std::vector<std::string>& files, Arguments& result)
{
  if (result.shapes.empty() || result.table.empty() || result.output.empty())
  {
    throw UsageError("Designs need --shapes, --table and --output, all three.");
  }
  if (files.size() != 1)
  {
    throw UsageError("With --shapes one more file is needed, the grid; " +
                     std::to_string(files.size()) + " are given.");
  }
  result.grid = files.front();
}

/// `bakes`: the grid is its own boundary.
void takeFiles(std::vector<std::string> files, bool bakes, Arguments& result)
{
  using Task = Arguments::Task;
  if (result.task == Task::WriteDesigns)
  {
    takeDesigns(files, result);
    return;
  }
  const bool hasOutput = result.task != Task::ListSurfaces && result.task != Task::Check;
  if (!result.output.empty() && hasOutput)
  {
    files.push_back(result.output);
  }
  const bool morphs = result.task == Task::Morph && !bakes;
  const bool reads = morphs && files.size() == 3;
  if (!reads && files.size() != (hasOutput ? 2u : 1u))
  {
    throw UsageError(std::string(!hasOutput ? "1 file is needed (grid), "
                                 : morphs   ? "2 or 3 files are needed (grid, output; or grid, "
                                              "boundary, output), "
                                            : "2 files are needed (grid, output), ") +
                     std::to_string(files.size()) +
                     (files.size() == 1 ? " is given." : " are given."));
  }
  result.grid = files.front();
  result.boundary = reads ? files[1] : bakes ? result.grid : "";
  result.output = hasOutput ? files.back() : "";
  if (result.task == Task::Morph)
  {
    checkMotion(result);
  }
}

struct Option
{
  std::string name;
  std::string value; ///< how the help calls it; empty for an option without one
  std::string help;
  std::string group; ///< of the help
  std::function<void(const std::string& value)> take;
};

std::vector<Option> optionsOf(Arguments& result)
{
  using Task = Arguments::Task;
  const auto text = [](std::string& target)
  { return [&target](const std::string& value) { target = value; }; };
  const auto none = [](const std::string& value)
  {
    if (!value.empty())
    {
      throw UsageError("'" + value + "' is given to an option that takes no value.");
    }
  };
  const auto flag = [none](bool& target)
  {
    return [none, &target](const std::string& value)
    {
      none(value);
      target = true;
    };
  };
  const auto task = [none, &result](Task task)
  {
    return [none, &result, task](const std::string& value)
    {
      none(value);
      result.task = task;
    };
  };
  const auto whole = [](const char* name, int& target, int least)
  {
    return [name, &target, least](const std::string& value)
    { target = wholeNumber(name, value, least); };
  };
  const auto moving = [&result](std::string& file, const char* displacement, const char* option)
  {
    return [&result, &file, displacement, option](const std::string& value)
    {
      file = value;
      result.properties.imply("Displacement", displacement, option);
    };
  };
  std::vector<Option> options = {
    { "--shapes", "<boundary>...",
      "shapes, one displaced boundary each, whose motions are added with weights; up to the next "
      "option",
      Files, [&](const std::string& value) { result.shapes.push_back(value); } },
    { "--table", "<file>",
      "the weights, comma-separated values: a column for each shape, named as its file without "
      "extension,\nand a line for each design",
      Files, text(result.table) },
    { "--output", "<file or folder>",
      "the output, in place of the last file; of designs a folder, in which a run that was stopped "
      "continues",
      Files, text(result.output) },
    { "--as-rotation", "<shape>",
      "the weight of this shape is the factor of its angle; may be repeated", Files,
      [&](const std::string& value) { result.rotations.push_back(value); } },
    { "--criteria", "<name>[=<limit>],...",
      "also report these, with the worst cell and how many are beyond the limit, before and after: "
      "AspectRatio,\nSkewness, Warpage, JacobianRatio, Taper, NonOrthogonality, FaceSkewness, "
      "FacePyramid, FirstHeight;\nFirstHeight:BLADE is that of a surface that the file names",
      Files, text(result.criteria) },
    { "--report", "<json>",
      "also write status, counts, quality before and after, and messages as JSON; with --steps "
      "one\n"
      "file a step, as of the output",
      Files, text(result.report) },
    { "--require-valid", "",
      "with --validity none or report: exit status 3 all the same if the motion inverts or "
      "collapses\n"
      "a cell, or the boundary crosses itself; with check: if a cell is inverted or collapsed",
      Files, flag(result.requireValid) },
    { "--threads", "<number>", "threads to compute with; by default 0, all cores", Files,
      whole("--threads", result.threads, 0) },
    { "--progress", "", "show progress even if standard error is no terminal", Files,
      flag(result.progress) },
    { "--quiet", "", "print nothing but warnings and errors", Files, flag(result.quiet) },
    { "--target", "<file>",
      "a surface onto which the surfaces of --move go; without --move, those that it belongs to",
      Files, moving(result.target, "Target", "--target") },
    { "--handles", "<csv>",
      "points that take what moves along smoothly (without --move, everything): columns x, y, z, "
      "dx, "
      "dy, dz\nand, optional, radius (0: no limit)",
      Files, moving(result.handles, "Handles", "--handles") },
    { "--lattice", "<csv>",
      "control points of a box that move what is inside (without --move, everything): columns i, "
      "j, "
      "k,\ndx, dy, dz",
      Files, moving(result.lattice, "Lattice", "--lattice") },
    { "--field", "<file>",
      "another mesh or an image with the displacements --field-array, or a table with the columns "
      "x, y, z,\ndx, dy, dz: what moves takes the values there",
      Files, moving(result.field, "Field", "--field") },
    { "--displacements", "<csv>",
      "nodes that move: columns id (0-based point id), dx, dy, dz; or pointDisplacement of "
      "OpenFOAM",
      Files, text(result.displacements) },
    { "--node-numbers", "", "ids of --displacements are the node numbers of the grid's file", Files,
      flag(result.nodeNumbers) },
    { "--region", "<name>",
      "the region of a case of OpenFOAM that is read and written; by default all of them", Files,
      text(result.region) },
    { "--time-step", "<number>",
      "the step of the displacements in a file of Exodus II or CGNS, from 0 on; by default the "
      "last",
      Files, whole("--time-step", result.timeStep, 0) },
    { "--steps", "<number>",
      "write the equal steps of the motion: <output> with -1, -2, ... before its extension", Files,
      whole("--steps", result.steps, 1) },
    { "--results", "",
      "write the arrays that the morph adds, too: scaled Jacobian and the like; by default the\n"
      "arrays of <grid> alone",
      Files, flag(result.results) },
    { "--list-surfaces", "", "print name, faces, area and center of each surface, and stop", Files,
      task(Task::ListSurfaces) },
    { "--version", "", "print the version and stop", Files, task(Task::ShowVersion) },
    { "--help", "", "print this and stop", Files, task(Task::ShowHelp) },
  };
  std::vector<std::string> groups = { Files }; // in the order of the table
  const auto rank = [&](const std::string& group)
  {
    const auto found = std::find(groups.begin(), groups.end(), group);
    return found - groups.begin();
  };
  for (const Property& property : properties())
  {
    if (rank(property.group) == static_cast<std::ptrdiff_t>(groups.size()))
    {
      groups.push_back(property.group);
    }
    if (!property.option.empty())
    {
      const std::string value = valueName(property);
      const std::string words =
        value == "<name>" && !property.words.empty()
          ? " One of " + vtksys::SystemTools::Join(property.words, ", ") + "."
          : "";
      options.push_back({ property.option, value, property.help + words, property.group,
        [&](const std::string& value) { result.properties.add(property, value); } });
    }
  }
  std::stable_sort(options.begin(), options.end(),
    [&](const Option& a, const Option& b) { return rank(a.group) < rank(b.group); });
  return options;
}

/// The words with line breaks before column 100, after the first line's start.
std::string wrapped(const std::vector<std::string>& words, const std::string& start)
{
  std::string result, line = start;
  for (const std::string& word : words)
  {
    if (line.size() + word.size() > 98)
    {
      result += line + "\n";
      line = "     ";
    }
    line += " " + word;
  }
  return result + line + "\n";
}

std::string wrapped(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
  {
    words.push_back(word);
  }
  return wrapped(words, "     ");
}

const std::vector<std::pair<std::string, std::string>> Letters = { { "-h", "--help" },
  { "-V", "--version" }, { "-o", "--output" }, { "-q", "--quiet" } };

/// "-o, --output"
std::string namesOf(const Option& option)
{
  for (const auto& [letter, name] : Letters)
  {
    if (option.name == name)
    {
      return letter + ", " + name;
    }
  }
  return option.name;
}

bool hasEffect(const Option& option, const Command& command)
{
  return has(OfAll, option.name) || has(command.options, option.name) ||
         has(command.groups, option.group);
}

/// On one screen: what a command does, examples, and its options without their texts.
std::string helpOf(const std::vector<Option>& options, const Command& command)
{
  std::ostringstream text;
  text << "Usage: morph-mesh " << command.name << " " << command.usage << "\n"
       << wrapped(command.what) << "\n";
  std::istringstream examples(command.examples);
  for (std::string line; std::getline(examples, line);)
  {
    text << "  morph-mesh " << line << "\n";
  }
  text << "\nOptions, which morph-mesh --help explains:\n";
  for (auto first = options.begin(); first != options.end();)
  {
    const auto isOther = [&](const Option& one) { return one.group != first->group; };
    const auto last = std::find_if(first, options.end(), isOther);
    std::vector<std::string> names;
    for (auto option = first; option != last; ++option)
    {
      if (hasEffect(*option, command))
      {
        const bool isChoice = option->value.find('|') != std::string::npos;
        names.push_back(" " + namesOf(*option) + (option->value.empty() ? "" : " ") +
                        (isChoice ? "<word>" : option->value));
      }
    }
    text << (names.empty() ? "" : wrapped(names, "  " + first->group + ":"));
    first = last;
  }
  return text.str();
}

/// All commands and options.
std::string helpOf(const std::vector<Option>& options)
{
  std::ostringstream text;
  text << "Usage: morph-mesh <command> [options] <files>\n\n";
  for (const Command& one : Commands)
  {
    text << "  " << one.name << std::string(10 - std::string(one.name).size(), ' ') << one.what
         << "\n";
  }
  text << "\nmorph-mesh <command> --help has the files, options and examples of one. Without a "
          "command it is move.\n\n"
       << About << Formats;
  std::string group;
  for (const Option& option : options)
  {
    if (option.group != group)
    {
      group = option.group;
      text << "\n" << group << ":\n";
    }
    text << "  " << namesOf(option) << (option.value.empty() ? "" : " ") << option.value << "\n"
         << wrapped(option.help);
  }
  text << ExitStatus;
  return text.str();
}

/// The full name of an option of one letter.
std::string longName(const std::string& name)
{
  const auto found = std::find_if(
    Letters.begin(), Letters.end(), [&](const auto& one) { return one.first == name; });
  return found == Letters.end() ? name : found->second;
}

template <typename List>
std::vector<std::string> namesOfAll(const List& list)
{
  std::vector<std::string> names;
  std::transform(list.begin(), list.end(), std::back_inserter(names),
    [](const auto& one) { return std::string(one.name); });
  return names;
}

const Option* findOption(const std::vector<Option>& options, const std::string& argument)
{
  const std::string name = longName(argument.substr(0, argument.find('=')));
  const auto found = std::find_if(
    options.begin(), options.end(), [&](const Option& one) { return one.name == name; });
  return found == options.end() ? nullptr : &*found;
}

/// Takes `argument` as option, with its value from `next` where it has one.
template <typename Next>
const Option* takeOption(const std::vector<Option>& options, const std::string& argument, Next next)
{
  const std::size_t equals = argument.find('=');
  const Option* option = findOption(options, argument);
  if (!option)
  {
    const std::string name = argument.substr(0, equals);
    throw UsageError("There is no option " + name + "." + didYouMean(name, namesOfAll(options), 3));
  }
  // A flag of the table may be --certify=off.
  option->take(equals != std::string::npos ? argument.substr(equals + 1)
               : option->value.empty()     ? std::string()
                                           : next(option->name));
  return option;
}

/// The command that the first argument is; null if that is no command.
const Command* findCommand(int argc, char* argv[])
{
  const auto found = std::find_if(Commands.begin(), Commands.end(),
    [&](const Command& one) { return argc > 1 && one.name == std::string(argv[1]); });
  return found == Commands.end() ? nullptr : &*found;
}

/// Throws UsageError if the first argument is no command, no option, and by its name no file.
void requireCommandOrFile(int argc, char* argv[])
{
  const std::string known =
    " The commands are " + vtksys::SystemTools::Join(namesOfAll(Commands), ", ") + ".";
  if (argc < 2)
  {
    throw UsageError("No command and no file is given." + known);
  }
  const std::string first = argv[1];
  const std::string meant = didYouMean(first, namesOfAll(Commands), 2);
  const bool isWord = first.find_first_of("./") == std::string::npos;
  if (first[0] != '-' && (isWord || !meant.empty()) && !std::filesystem::exists(first))
  {
    throw UsageError(
      "There is no command and no file " + first + "." + (meant.empty() ? known : meant));
  }
}

/// Throws UsageError for options that have no effect.
void requireEffect(const std::vector<const Option*>& given, const Command& command)
{
  std::string names;
  for (const Option* option : given)
  {
    names += hasEffect(*option, command) ? "" : (names.empty() ? "" : ", ") + option->name;
  }
  if (!names.empty())
  {
    throw UsageError("These have no effect with " + std::string(command.name) + ": " + names + ".");
  }
}
}

bool Arguments::wantsValid() const
{
  const int validity = static_cast<int>(
    this->properties.number("Validity", double(vtkMorphAlgorithm::VALIDITY_REPAIR)));
  return this->requireValid || vtkMorphAlgorithm::VALIDITY_REPORT < validity;
}

std::string helpCommand(int argc, char* argv[])
{
  const Command* command = findCommand(argc, argv);
  return "morph-mesh " + (command ? command->name + std::string(" ") : "") + "--help";
}

Arguments parseArguments(int argc, char* argv[])
{
  Arguments result;
  const std::vector<Option> options = optionsOf(result);
  std::vector<std::string> files;
  std::vector<const Option*> given;
  bool onlyFiles = false;
  bool isAfterShapes = false; // the option with more than one value
  const Command* command = findCommand(argc, argv);
  if (!command)
  {
    requireCommandOrFile(argc, argv);
  }
  result.task = command ? command->task : result.task;
  for (int i = command ? 2 : 1; i < argc; ++i)
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
      given.push_back(takeOption(options, argument,
        [&](const std::string& name) -> std::string
        {
          if (++i == argc || findOption(options, argv[i]))
          {
            throw UsageError(name + " needs a value.");
          }
          return argv[i];
        }));
    }
    if (result.task == Arguments::Task::ShowHelp || result.task == Arguments::Task::ShowVersion)
    {
      result.help = command ? helpOf(options, *command) : helpOf(options);
      return result;
    }
  }
  const std::string name = command ? command->name : "";
  if (name == "fit" && result.target.empty())
  {
    throw UsageError("fit needs --target.");
  }
  if (name == "bake" && !result.properties.has("DisplacementArray"))
  {
    throw UsageError("bake needs --displacement-array.");
  }
  if (result.task == Arguments::Task::Morph &&
      !(result.shapes.empty() && result.table.empty() && result.rotations.empty()))
  {
    result.task = Arguments::Task::WriteDesigns;
  }
  const bool isCommand = command && command->task == result.task;
  requireEffect(given, isCommand ? *command
                                 : *std::find_if(Commands.begin(), Commands.end(),
                                     [&](const Command& one) { return one.task == result.task; }));
  takeFiles(files, name == "bake", result);
  return result;
}
}
