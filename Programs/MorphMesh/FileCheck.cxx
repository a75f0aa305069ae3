// SPDX-License-Identifier: BSD-3-Clause
#include "FileCheck.h"

#include "Files.h"
#include "Messages.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

namespace morph_mesh
{
namespace
{
/// What is looked at of a file.
struct Ends
{
  std::string path;
  double size; ///< bytes; all counts here are exact as double, or far too large
  std::string head, tail;
};

Ends endsOf(const std::string& path)
{
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_regular_file(path, error))
  {
    throw Failure(
      "Cannot read " + path +
      (fs::exists(path, error) ? ": it is no regular file." : ": there is no such file."));
  }
  constexpr std::uintmax_t Head = 1 << 16, Tail = 1 << 10;
  const std::uintmax_t size = fs::file_size(path, error);
  Ends ends{ path, static_cast<double>(size), std::string(std::min(size, Head), '\0'),
    std::string(std::min(size, Tail), '\0') };
  std::ifstream file(path, std::ios::binary);
  file.read(ends.head.data(), static_cast<std::streamsize>(ends.head.size()));
  file.seekg(static_cast<std::streamoff>(size - ends.tail.size()));
  file.read(ends.tail.data(), static_cast<std::streamsize>(ends.tail.size()));
  if (!file)
  {
    throw Failure("Cannot read " + path + ": the system does not give its content.");
  }
  return ends;
}

void require(const Ends& ends, bool isOfItsKind)
{
  if (!isOfItsKind)
  {
    throw Failure("Cannot read " + ends.path + ": it does not begin as a " +
                  extensionOf(ends.path) + " file does. Its format is another one.");
  }
}

void requireWhole(const Ends& ends, bool isWhole, const std::string& what)
{
  if (!isWhole)
  {
    throw Failure("Cannot read " + ends.path + ": the file is damaged: " + what + ".");
  }
}

/// `least`: the bytes that the counts of the header ask for.
void requireRoom(const Ends& ends, double least)
{
  requireWhole(ends, least >= 0 && least <= ends.size,
    "its header asks for more than its " + std::to_string(static_cast<std::uint64_t>(ends.size)) +
      " bytes");
}

bool begins(const std::string& text, const std::string& start)
{
  return text.compare(0, start.size(), start) == 0;
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void checkXml(const Ends& ends)
{
  const std::size_t first = ends.head.find('<');
  require(ends,
    first != std::string::npos && first <= 3 && // a byte order mark may come first
      has(ends.head, "<VTKFile"));
  requireWhole(ends, has(ends.tail, "</VTKFile>"), "it ends before </VTKFile>");
  constexpr double Compressed = 1e-3;    // no library packs cells more tightly
  const std::string count = " NumberOf"; // points, cells and the like of the first piece
  for (std::size_t at = ends.head.find(count); at != std::string::npos;
       at = ends.head.find(count, at + 1))
  {
    const std::size_t number = ends.head.find('"', at);
    requireRoom(ends, number == std::string::npos
                        ? -1
                        : Compressed * std::strtod(ends.head.c_str() + number + 1, nullptr));
  }
}

void checkLegacy(const Ends& ends)
{
  const std::string title = "# vtk datafile version ";
  require(ends, begins(lower(ends.head), title));
  const double version = std::strtod(ends.head.c_str() + title.size(), nullptr);
  requireWhole(ends, version >= 1 && version < 100, "it has no version");
  const std::size_t at = ends.head.find("\nPOINTS ");
  if (at == std::string::npos)
  {
    return; // the reader says what is missing
  }
  std::istringstream line(ends.head.substr(at + 7, 100));
  double count = 0;
  std::string type;
  line >> count >> type;
  const bool isBinary = has(lower(ends.head.substr(0, at)), "\nbinary");
  const double bytes = !isBinary ? 2 : type == "double" ? 8 : 4; // a digit and a space at least
  requireRoom(ends, line ? 3 * bytes * count : -1);
}

void checkStl(const Ends& ends)
{
  constexpr std::size_t Header = 84, Triangle = 50;
  std::uint32_t count = 0;
  if (ends.head.size() >= Header)
  {
    std::memcpy(&count, ends.head.data() + Header - sizeof(count), sizeof(count));
  }
  const bool isBinary = has(ends.head, std::string(1, '\0')); // behind each triangle at least
  if (!isBinary && begins(lower(ends.head), "solid"))
  {
    const std::string tail = lower(ends.tail);
    requireWhole(ends, has(tail, "endsolid") || has(tail, "end solid"), "it ends before endsolid");
    return;
  }
  require(ends, isBinary && ends.size >= Header);
  requireRoom(ends, Header + Triangle * static_cast<double>(count));
}

/// The bytes of a value in a binary file, 0 where there is no such type; `type`: PLY's name of it.
double bytesOf(const std::string& type)
{
  static const std::map<std::string, double> all = { { "char", 1 }, { "uchar", 1 }, { "int8", 1 },
    { "uint8", 1 }, { "short", 2 }, { "ushort", 2 }, { "int16", 2 }, { "uint16", 2 }, { "int", 4 },
    { "uint", 4 }, { "int32", 4 }, { "uint32", 4 }, { "float", 4 }, { "float32", 4 },
    { "double", 8 }, { "float64", 8 } };
  const auto found = all.find(type);
  return found == all.end() ? 0 : found->second;
}

void checkPly(const Ends& ends)
{
  require(ends, begins(ends.head, "ply\n") || begins(ends.head, "ply\r"));
  const std::size_t end = ends.head.find("end_header");
  requireWhole(ends, end != std::string::npos, "its header has no end");
  std::istringstream lines(ends.head.substr(0, end));
  bool isText = false;
  double least = static_cast<double>(end), count = -1; // of the element
  std::string line;
  std::getline(lines, line); // "ply"
  while (std::getline(lines, line))
  {
    std::istringstream words(line);
    std::string word, type;
    words >> word >> type;
    bool isKnown = word == "comment" || word == "obj_info";
    if (word == "format")
    {
      isText = type == "ascii";
      isKnown = isText || begins(type, "binary_");
    }
    else if (word == "element")
    {
      words >> count;
      requireRoom(ends, words ? count : -1);
      isKnown = true;
    }
    else if (word == "property")
    {
      std::string ofLength;
      words >> ofLength;
      const double bytes = bytesOf(type == "list" ? ofLength : type);
      least += count * (isText ? 2 : bytes);
      isKnown = bytes > 0 && count >= 0;
    }
    requireWhole(ends, isKnown, "its header has a line that PLY does not know");
  }
  requireRoom(ends, least);
}

void checkObj(const Ends& ends)
{
  const std::string text = "\n" + ends.head;
  require(ends, !has(text, std::string(1, '\0')) && (has(text, "\nv ") || has(text, "\nv\t")));
}

/// The first line that is no comment has the numbers of nodes and of cells.
void checkUcd(const Ends& ends)
{
  constexpr char Binary = 7;
  std::istringstream lines(ends.head);
  std::string line;
  while (std::getline(lines, line) && begins(line, "#"))
  {
  }
  std::istringstream words(line);
  double nodes = 0, cells = 0;
  words >> nodes >> cells;
  const bool isBinary = begins(ends.head, std::string(1, Binary));
  require(ends, words || isBinary);
  if (!isBinary)
  {
    constexpr double Line = 8; // "1 0 0 0\n"
    requireRoom(ends, std::min(nodes, cells) < 0 ? -1 : Line * (nodes + cells));
  }
}

/// The seventh line has the numbers of nodes, elements, groups and sets.
void checkGambit(const Ends& ends)
{
  require(ends, has(ends.head.substr(0, 200), "GAMBIT NEUTRAL FILE"));
  std::istringstream lines(ends.head);
  std::string line;
  for (int i = 0; i < 7; ++i)
  {
    std::getline(lines, line);
  }
  std::istringstream words(line);
  for (const double bytes : { 8, 6, 1, 1 }) // a node has the line "1 0 0 0" at least
  {
    double count = 0;
    words >> count;
    requireRoom(ends, words ? bytes * count : -1);
  }
}

void checkNetCdf(const Ends& ends)
{
  require(ends, begins(ends.head, "CDF") || begins(ends.head, "\x89HDF"));
}
}

void requireWholeFile(const std::string& path)
{
  static const std::vector<std::pair<std::string, void (*)(const Ends&)>> checks = { { ".vtu",
                                                                                       checkXml },
    { ".vtp", checkXml }, { ".pvtp", checkXml }, { ".vts", checkXml }, { ".vti", checkXml },
    { ".vtr", checkXml }, { ".vtk", checkLegacy }, { ".stl", checkStl }, { ".ply", checkPly },
    { ".obj", checkObj }, { ".inp", checkUcd }, { ".neu", checkGambit }, { ".e", checkNetCdf },
    { ".exo", checkNetCdf }, { ".ex2", checkNetCdf }, { ".exii", checkNetCdf } };
  const Ends ends = endsOf(path);
  requireWhole(ends, ends.size > 0, "it is empty");
  const std::string kind = extensionOf(path);
  const auto found =
    std::find_if(checks.begin(), checks.end(), [&](const auto& one) { return one.first == kind; });
  if (found != checks.end())
  {
    found->second(ends);
  }
}
}
