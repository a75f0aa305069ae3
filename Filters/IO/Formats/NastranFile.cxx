// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/NastranFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusKeyword.h"
#include "Formats/NastranCard.h"
#include "Formats/Numbering.h"
#include "Formats/TextFile.h"
#include "Support/Error.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>

namespace morph::io
{
namespace
{
/// An entry of elements: the cells by the number of its nodes, the first field of its nodes.
struct Kind
{
  std::map<std::size_t, std::uint8_t> cellTypes;
  std::size_t firstNode = 2;
};

const std::map<std::string, Kind>& kinds()
{
  static const std::map<std::string, Kind> table = {
    { "CTETRA", { { { 4, Tetra }, { 10, QuadraticTetra } }, 2 } },
    { "CPYRAM", { { { 5, Pyramid }, { 13, QuadraticPyramid } }, 2 } },
    { "CPYRA", { { { 5, Pyramid }, { 13, QuadraticPyramid } }, 2 } },
    { "CPENTA", { { { 6, Wedge }, { 15, QuadraticWedge } }, 2 } },
    { "CHEXA", { { { 8, Hexahedron }, { 20, QuadraticHexahedron } }, 2 } },
    { "CTRIA3", { { { 3, Triangle } }, 2 } },
    { "CTRIA6", { { { 3, Triangle }, { 6, QuadraticTriangle } }, 2 } },
    { "CTRIAR", { { { 3, Triangle } }, 2 } },
    { "CTRAX3", { { { 3, Triangle } }, 2 } },
    { "CTRAX6", { { { 3, Triangle }, { 6, QuadraticTriangle } }, 2 } },
    { "CPLSTN3", { { { 3, Triangle } }, 2 } },
    { "CPLSTN6", { { { 3, Triangle }, { 6, QuadraticTriangle } }, 2 } },
    { "CPLSTS3", { { { 3, Triangle } }, 2 } },
    { "CPLSTS6", { { { 3, Triangle }, { 6, QuadraticTriangle } }, 2 } },
    { "CQUAD4", { { { 4, Quad } }, 2 } },
    { "CQUADR", { { { 4, Quad } }, 2 } },
    { "CSHEAR", { { { 4, Quad } }, 2 } },
    { "CQUADX4", { { { 4, Quad } }, 2 } },
    { "CPLSTN4", { { { 4, Quad } }, 2 } },
    { "CPLSTS4", { { { 4, Quad } }, 2 } },
    { "CQUAD8", { { { 4, Quad }, { 8, QuadraticQuad } }, 2 } },
    { "CQUADX8", { { { 4, Quad }, { 8, QuadraticQuad } }, 2 } },
    { "CPLSTN8", { { { 4, Quad }, { 8, QuadraticQuad } }, 2 } },
    { "CPLSTS8", { { { 4, Quad }, { 8, QuadraticQuad } }, 2 } },
    { "CBAR", { { { 2, Line } }, 2 } },
    { "CBEAM", { { { 2, Line } }, 2 } },
    { "CROD", { { { 2, Line } }, 2 } },
  };
  return table;
}

/// An entry that ties nodes to each other: the fields of the first node and of the next ones.
struct Link
{
  std::size_t hub, next;
  std::size_t last = 0; ///< of the next ones; 0: all that follow
};

const std::map<std::string, Link>& links()
{
  static const std::map<std::string, Link> table = {
    { "RBE2", { 1, 3 } },
    { "RBE3", { 2, 4 } },
    { "RBAR", { 1, 2, 2 } },
    { "RROD", { 1, 2, 2 } },
    { "CONROD", { 1, 2, 2 } },
    { "PLOTEL", { 1, 2, 2 } },
    { "CTUBE", { 2, 3, 3 } },
    { "CBUSH", { 2, 3, 3 } },
    { "CGAP", { 2, 3, 3 } },
    { "CELAS1", { 2, 4, 4 } },
    { "CELAS2", { 2, 4, 4 } },
    { "CDAMP1", { 2, 4, 4 } },
    { "CDAMP2", { 2, 4, 4 } },
  };
  return table;
}

/// Nastran's nodes between corners go bottom, sides, top; VTK's bottom, top, sides.
void toVtkOrder(std::uint8_t type, std::vector<Index>& nodes)
{
  if (type == QuadraticHexahedron)
  {
    std::rotate(nodes.begin() + 12, nodes.begin() + 16, nodes.end());
  }
  else if (type == QuadraticWedge)
  {
    std::rotate(nodes.begin() + 9, nodes.begin() + 12, nodes.end());
  }
}

class NastranFile : public TextFile
{
public:
  explicit NastranFile(const std::string& path)
    : TextFile(path)
  {
    this->parse(this->addPart(path, ""), 0);
    this->finish();
  }

private:
  struct Element
  {
    Index number = 0, property = 0;
    std::vector<Index> nodes;
    std::uint8_t type = 0;
    bool isLink = false; ///< `nodes` are pairs
    std::size_t part = 0, at = 0;
  };

  void parse(std::size_t part, int depth);
  void takeGrid(std::size_t part, const NastranCard& card);
  void takeElement(std::size_t part, const NastranCard& card, const Kind& kind);
  void takeLink(std::size_t part, const NastranCard& card, const Link& link);
  void addLink(const Element& link);
  void takeSystem(std::size_t part, const NastranCard& card);
  Index integerIn(std::size_t part, const NastranCard& card, std::size_t field) const;
  std::size_t frameOf(Index system, int depth);
  std::deque<CoordinateFrame> framesAt(const std::vector<double>& coordinates) const override;
  Eigen::Vector3d positionOf(std::size_t node, int depth);
  void finish();

  /// A coordinate system: by three points in another one, or by three nodes.
  struct System
  {
    CoordinateFrame::Kind kind = CoordinateFrame::Kind::Rectangular;
    Index reference = 0;
    Eigen::Matrix3d points = Eigen::Matrix3d::Zero(); ///< its columns
    std::array<Index, 3> nodes = {};
    bool isByNodes = false;
    std::size_t part = 0, at = 0;
    std::size_t frame = 0; ///< 0: not yet known
  };

  std::vector<Element> elements_;
  std::map<Index, System> systems_;
  std::vector<Index> systemOf_; ///< of each node; -1: that of GRDSET
  Index defaultSystem_ = 0;
  Numbering nodes_;
  std::set<std::string> unknownTypes_;
};

/// The file that a statement names: INCLUDE 'name', which may go over several lines. `at`: after
/// the statement.
std::string includedName(std::string_view text, std::size_t& at)
{
  const std::size_t begin = text.find_first_not_of(" \t=", at + 7);
  if (begin == std::string_view::npos)
  {
    return "";
  }
  const char quote = text[begin];
  if (quote != '\'' && quote != '"')
  {
    const std::size_t end = std::min(text.find_first_of("\r\n$", begin), text.size());
    at = end;
    return std::string(trimmed(text.substr(begin, end - begin)));
  }
  const std::size_t end = std::min(text.find(quote, begin + 1), text.size());
  std::string name;
  Lines lines(text.substr(0, end), begin + 1);
  while (lines.next())
  {
    name += trimmed(lines.line());
  }
  at = std::min(text.find('\n', end), text.size());
  return name;
}

bool startsWith(const std::string& text, const char* start)
{
  return text.rfind(start, 0) == 0;
}

/// After the line BEGIN BULK, which ends executive and case control; 0 without one.
std::size_t beginOfBulk(std::string_view text)
{
  Lines lines(text);
  std::vector<Span> words;
  while (lines.next())
  {
    splitAtBlanks(text, lines.span(), words);
    if (words.size() >= 2 && upperCase(words[0].of(text)) == "BEGIN" &&
        startsWith(upperCase(words[1].of(text)), "BULK"))
    {
      return lines.at();
    }
  }
  return 0;
}

/// Elements of types that are not read.
bool isUnknownElement(const std::string& name)
{
  for (const char* start : { "CQUAD", "CTRIA", "CTRAX", "CPLST", "CTETRA", "CPYR", "CPENTA", "CHEX",
         "CHAC", "CIF", "CBEND", "CWELD", "CFAST", "CSEAM" })
  {
    if (startsWith(name, start))
    {
      return true;
    }
  }
  return false;
}

void NastranFile::parse(std::size_t part, int depth)
{
  const std::string& text = this->parts_[part].text;
  NastranCards cards(text, part == 0 ? beginOfBulk(text) : 0);
  NastranCard card;
  while (cards.next(card))
  {
    if (startsWith(card.name, "INCLUDE"))
    {
      std::size_t after = card.at;
      const std::string name = includedName(text, after);
      if (name.empty() || depth >= DeepestInclude)
      {
        this->failAt(part, card.at,
          name.empty() ? "the name of the included file is missing."
                       : "files include each other more than 20 levels deep.");
      }
      this->parse(this->addIncluded(part, name), depth + 1);
      cards = NastranCards(text, after);
    }
    else if (startsWith(card.name, "ENDDATA"))
    {
      return;
    }
    else if (!card.name.empty() && card.name[0] == '=')
    {
      this->failAt(part, card.at,
        "it has a replication (=), which defines an entry by the one before it. Write a deck that "
        "lists all entries.");
    }
    else if (card.name == "GRID")
    {
      this->takeGrid(part, card);
    }
    else if (card.name == "GRDSET")
    {
      this->defaultSystem_ = this->integerIn(part, card, 1);
    }
    else if (startsWith(card.name, "CORD1") || startsWith(card.name, "CORD2"))
    {
      this->takeSystem(part, card);
    }
    else if (const auto kind = kinds().find(card.name); kind != kinds().end())
    {
      this->takeElement(part, card, kind->second);
    }
    else if (const auto link = links().find(card.name); link != links().end())
    {
      this->takeLink(part, card, link->second);
    }
    else if (isUnknownElement(card.name))
    {
      this->unknownTypes_.insert(card.name);
    }
  }
}

Index NastranFile::integerIn(std::size_t part, const NastranCard& card, std::size_t field) const
{
  const bool isBlank = field >= card.fields.size() || card.fields[field].span.size() == 0;
  return isBlank ? 0 : this->integerAt(part, card.fields[field].span);
}

void NastranFile::takeGrid(std::size_t part, const NastranCard& card)
{
  if (card.fields.size() < 5)
  {
    this->failAt(part, card.at, "GRID has no third coordinate: a continuation line is missing.");
  }
  const Index number = this->integerIn(part, card, 0);
  const bool hasSystem = card.fields[1].span.size() > 0;
  this->systemOf_.push_back(hasSystem ? this->integerIn(part, card, 1) : -1);
  std::array<double, 3> x;
  this->places_.push_back(
    this->nodePlace(part, card.fields.data() + 2, card.rules(2), x, card.isLarge));
  this->mesh_.addNode(number, x[0], x[1], x[2]);
}

/// CORD1R, CORD1C, CORD1S: one or two systems by nodes; CORD2R, CORD2C, CORD2S: by points.
void NastranFile::takeSystem(std::size_t part, const NastranCard& card)
{
  using Kind = CoordinateFrame::Kind;
  static const std::map<char, Kind> kinds = { { 'R', Kind::Rectangular },
    { 'C', Kind::Cylindrical }, { 'S', Kind::Spherical } };
  const auto kind = card.name.size() == 6 ? kinds.find(card.name[5]) : kinds.end();
  if (kind == kinds.end())
  {
    this->failAt(part, card.at, "the coordinate system " + card.name + " is not known.");
  }
  System system;
  system.kind = kind->second;
  system.part = part;
  system.at = card.at;
  system.isByNodes = card.name[4] == '1';
  for (std::size_t first = 0; system.isByNodes && first < 8; first += 4)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      system.nodes[k] = this->integerIn(part, card, first + 1 + k);
    }
    if (const Index number = this->integerIn(part, card, first); number > 0)
    {
      this->systems_[number] = system;
    }
  }
  if (system.isByNodes)
  {
    return;
  }
  system.reference = this->integerIn(part, card, 1);
  for (std::size_t k = 0; k < 9; ++k)
  {
    const bool isBlank = 2 + k >= card.fields.size() || card.fields[2 + k].span.size() == 0;
    system.points(static_cast<Index>(k % 3), static_cast<Index>(k / 3)) =
      isBlank ? 0 : this->numberAt(part, card.fields[2 + k].span);
  }
  this->systems_[this->integerIn(part, card, 0)] = system;
}

/// Of three points: the second is on the third axis, the last one in the plane of the first and
/// third. Nothing where they are on a line.
std::optional<CoordinateFrame> frameBy(CoordinateFrame::Kind kind, const Eigen::Matrix3d& points)
{
  const auto axes = axesOf(points.col(0), points.col(1), points.col(2));
  if (!axes)
  {
    return {};
  }
  CoordinateFrame frame;
  frame.kind = kind;
  frame.origin = points.col(0);
  frame.axes << axes->col(1), axes->col(2), axes->col(0);
  return frame;
}

/// The frame of a coordinate system. `depth`: of systems that need each other.
std::size_t NastranFile::frameOf(Index id, int depth)
{
  if (id == 0)
  {
    return 0;
  }
  const auto found = this->systems_.find(id);
  if (found == this->systems_.end())
  {
    this->fail("nodes are in the coordinate system " + std::to_string(id) +
               ", which no CORD1R, CORD1C, CORD1S, CORD2R, CORD2C or CORD2S defines.");
  }
  System& system = found->second;
  if (system.frame > 0)
  {
    return system.frame;
  }
  const std::string name = "the coordinate system " + std::to_string(id);
  if (depth > 100)
  {
    this->failAt(system.part, system.at, name + " needs others that need it.");
  }
  Eigen::Matrix3d points;
  for (Index k = 0; k < 3; ++k)
  {
    if (!system.isByNodes)
    {
      const std::size_t reference = this->frameOf(system.reference, depth + 1);
      points.col(k) = this->frames_[reference].toBasic(system.points.col(k));
      continue;
    }
    const Index number = system.nodes[static_cast<std::size_t>(k)];
    const Index node = this->nodes_.find(number);
    if (node < 0)
    {
      this->failAt(system.part, system.at,
        name + " needs the node " + std::to_string(number) + ", which is not defined.");
    }
    points.col(k) = this->positionOf(static_cast<std::size_t>(node), depth + 1);
  }
  const auto frame = frameBy(system.kind, points);
  if (!frame)
  {
    this->failAt(system.part, system.at, "the three points of " + name + " are on a line.");
  }
  system.frame = this->frames_.size();
  this->frames_.push_back(*frame);
  return system.frame;
}

std::deque<CoordinateFrame> NastranFile::framesAt(const std::vector<double>& coordinates) const
{
  // A frame follows those that it needs.
  std::map<std::size_t, std::pair<Index, const System*>> used;
  for (const auto& [id, system] : this->systems_)
  {
    if (system.frame > 0)
    {
      used[system.frame] = { id, &system };
    }
  }
  std::deque<CoordinateFrame> frames = this->frames_;
  for (const auto& [number, one] : used)
  {
    const auto& [id, system] = one;
    const auto reference = this->systems_.find(system->reference);
    Eigen::Matrix3d points;
    for (Index k = 0; k < 3; ++k)
    {
      if (system->isByNodes)
      {
        const Index node = this->nodes_.find(system->nodes[static_cast<std::size_t>(k)]);
        points.col(k) = Eigen::Map<const Eigen::Vector3d>(coordinates.data() + 3 * node);
      }
      else
      {
        const std::size_t outer = system->reference == 0 ? 0 : reference->second.frame;
        points.col(k) = frames[outer].toBasic(system->points.col(k));
      }
    }
    const auto frame = frameBy(system->kind, points);
    if (!frame)
    {
      throw Error("Cannot write the moved nodes of " + this->path() +
                  ": the motion puts the nodes of the coordinate system " + std::to_string(id) +
                  " on a line. Define it by points (CORD2R, CORD2C or CORD2S).");
    }
    frames[number] = *frame;
  }
  return frames;
}

/// Of a node, in the basic system.
Eigen::Vector3d NastranFile::positionOf(std::size_t node, int depth)
{
  const Index system = this->systemOf_[node] < 0 ? this->defaultSystem_ : this->systemOf_[node];
  const Eigen::Map<const Eigen::Vector3d> local(this->mesh_.coordinates.data() + 3 * node);
  const std::size_t frame = this->frameOf(system, depth);
  this->places_[node].frame = frame;
  return this->frames_[frame].toBasic(local);
}

void NastranFile::takeElement(std::size_t part, const NastranCard& card, const Kind& kind)
{
  Element element;
  element.part = part;
  element.at = card.at;
  element.number = this->integerIn(part, card, 0);
  element.property = this->integerIn(part, card, 1);
  const std::size_t most = kind.cellTypes.rbegin()->first;
  const std::size_t corners = kind.cellTypes.begin()->first;
  std::vector<Index> nodes(most);
  for (std::size_t i = 0; i < most; ++i)
  {
    nodes[i] = this->integerIn(part, card, kind.firstNode + i);
  }
  // A blank or 0 stands for a node between corners that is left out.
  const auto middles = nodes.begin() + static_cast<std::ptrdiff_t>(corners);
  if (const auto corner = std::find(nodes.begin(), middles, 0); corner != middles)
  {
    this->failAt(part, card.at,
      card.name + " " + std::to_string(element.number) + " lacks its corner " +
        std::to_string(corner - nodes.begin() + 1) + ".");
  }
  const bool isLinear = std::all_of(middles, nodes.end(), [](Index n) { return n == 0; });
  element.nodes.assign(nodes.begin(), isLinear ? middles : nodes.end());
  element.type = kind.cellTypes.at(element.nodes.size());
  toVtkOrder(element.type, element.nodes);
  this->elements_.push_back(std::move(element));
}

/// Rigid elements, springs and the like: lines from the first node to the others.
void NastranFile::takeLink(std::size_t part, const NastranCard& card, const Link& link)
{
  const std::string& text = this->parts_[part].text;
  Element element;
  element.part = part;
  element.at = card.at;
  element.number = this->integerIn(part, card, 0);
  element.isLink = true;
  const Index hub = this->integerIn(part, card, link.hub);
  const std::size_t end = link.last > 0 ? link.last + 1 : card.fields.size();
  for (std::size_t i = link.next; i < std::min(end, card.fields.size()) && hub > 0; ++i)
  {
    const std::string_view field = card.fields[i].span.of(text);
    if (const auto number = parseInteger(field); number && *number > 0)
    {
      element.nodes.insert(element.nodes.end(), { hub, static_cast<Index>(*number) });
    }
    else if (number || field.empty())
    {
      continue; // to the ground
    }
    else if (!parseNumber(field))
    {
      if (field == "THRU" || field == "thru")
      {
        this->failAt(part, card.at, card.name + " has a range of nodes (THRU). List its nodes.");
      }
      break; // ALPHA or UM
    }
    else if (card.name == "RBE3")
    {
      ++i; // a weight, and its components
    }
  }
  if (!element.nodes.empty())
  {
    this->elements_.push_back(std::move(element));
  }
}

/// Pairs with a scalar point (SPOINT), which has no place, are left out.
void NastranFile::addLink(const Element& link)
{
  for (std::size_t i = 0; i + 1 < link.nodes.size(); i += 2)
  {
    const Index first = this->nodes_.find(link.nodes[i]);
    const Index second = this->nodes_.find(link.nodes[i + 1]);
    if (first >= 0 && second >= 0)
    {
      // Its number may be that of another element.
      this->mesh_.addCell(Line, { first, second }, -1);
    }
  }
}

void NastranFile::finish()
{
  if (this->mesh_.nodes() == 0)
  {
    this->fail("it has no GRID.");
  }
  this->nodes_ = Numbering(this->mesh_.nodeNumbers, "node", this->path());
  std::vector<double> basic;
  for (std::size_t node = 0; node < this->places_.size(); ++node)
  {
    const Eigen::Vector3d x = this->positionOf(node, 0);
    basic.insert(basic.end(), { x[0], x[1], x[2] });
  }
  this->mesh_.coordinates = std::move(basic);
  std::vector<Index> nodes;
  std::map<Index, std::vector<Index>> properties;
  for (const Element& element : this->elements_)
  {
    nodes.clear();
    if (element.isLink)
    {
      this->addLink(element);
      continue;
    }
    for (const Index number : element.nodes)
    {
      nodes.push_back(number == 0 ? -1 : this->nodes_.find(number));
      if (number != 0 && nodes.back() < 0)
      {
        this->failAt(element.part, element.at,
          "element " + std::to_string(element.number) + " has the node " + std::to_string(number) +
            ", which is not defined.");
      }
    }
    properties[element.property].push_back(
      this->mesh_.addCell(element.type, nodes, element.number));
  }
  Numbering(this->mesh_.cellNumbers, "element", this->path()); // there is none twice
  for (auto& [property, cells] : properties)
  {
    this->mesh_.set("PID " + std::to_string(property)).cells = std::move(cells);
  }
  for (const std::string& type : this->unknownTypes_)
  {
    this->mesh_.warnings.push_back(
      "Elements of the type '" + type + "' are left out of the mesh; they stay in the file.");
  }
}
}

bool isNastranFile(const std::string& path)
{
  const std::string extension = extensionOf(path);
  if (extension != ".bdf" && extension != ".nas" && extension != ".fem" && extension != ".dat")
  {
    return false;
  }
  const std::string head = readHead(path, 1 << 20);
  Lines lines(head);
  while (lines.next())
  {
    std::string line(lines.line().substr(0, 10));
    std::transform(line.begin(), line.end(), line.begin(),
      [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (const char* start : { "GRID ", "GRID,", "GRID*", "GRID\t", "BEGIN BULK", "INCLUDE " })
    {
      if (startsWith(line, start))
      {
        return true;
      }
    }
  }
  return false;
}

std::unique_ptr<SolverFile> readNastranFile(const std::string& path)
{
  return std::make_unique<NastranFile>(path);
}
}
