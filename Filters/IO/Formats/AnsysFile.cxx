// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AnsysFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusKeyword.h"
#include "Formats/Numbering.h"
#include "Formats/SolidElements.h"
#include "Formats/TextFile.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace morph::io
{
namespace
{
/// See "Mesh Information File" and CDWRITE in the Mechanical APDL documentation.
class AnsysFile : public TextFile
{
public:
  explicit AnsysFile(const std::string& path)
    : TextFile(path)
  {
    this->addPart(path, "");
    this->parse();
    this->finish();
  }

private:
  struct Element
  {
    Index number = 0, material = 0, type = 0;
    std::vector<Index> nodes;
    std::size_t at = 0;
  };
  struct Component
  {
    std::string name;
    bool isOfNodes = false;
    std::vector<std::pair<Index, Index>> ranges; ///< first and last number
  };

  std::string_view text() const { return this->parts_[0].text; }
  void parse();
  void readWidths(Lines& lines);
  bool nextOfBlock(Lines& lines, const char* block) const;
  const std::vector<NumberField>& fieldsOf(Span line);
  const std::vector<Index>& integersOf(Span line);
  void readNodes(Lines& lines);
  void readElements(Lines& lines);
  void readComponent(Lines& lines, const std::vector<Span>& command);
  void readTypes(Lines& lines);
  void readNodeCommand(Span line);
  void readElementCommand(Span line);
  void finish();

  std::vector<std::size_t> widths_; ///< of the fields of the block
  std::size_t integers_ = 0;        ///< of these, which come first
  std::vector<NumberField> fields_; ///< of a line
  std::vector<Index> numbers_;      ///< of a line
  std::map<Index, Index> types_;    ///< element type of each number of ET
  std::vector<Element> elements_;
  std::vector<Component> components_;
  /// What commands have set for the elements and nodes after them.
  ///@{
  Index type_ = 1, material_ = 1, system_ = 0;
  ///@}
  std::size_t missing_ = 0; ///< nodes of the last element, which further commands give
};

/// Commands that make or change nodes or elements, or read other files.
bool isRefused(const std::string& command)
{
  static const std::set<std::string> commands = { "NGEN", "NSYM", "NSCALE", "NMODIF", "FILL", "E",
    "EGEN", "ENGEN", "ESYM", "ENSYM", "EMODIF", "TRANSFER", "CDREAD", "NREAD", "EREAD", "/INPUT" };
  return commands.count(command) > 0;
}

/// Whether a type has volume elements (1), shells or plane elements (2), lines of two nodes and one
/// that orients them (3), or is left out (0).
int kindOf(Index type)
{
  static const std::set<Index> solids = { 45, 64, 65, 70, 87, 90, 92, 95, 185, 186, 187, 226, 227,
    278, 279, 285, 291 };
  static const std::set<Index> shells = { 2, 25, 35, 41, 42, 55, 57, 63, 75, 77, 78, 82, 83, 93,
    131, 132, 157, 181, 182, 183, 223, 281, 292, 293 };
  static const std::set<Index> lines = { 4, 8, 14, 44, 180, 184, 188 };
  return solids.count(type) > 0 ? 1 : shells.count(type) > 0 ? 2 : lines.count(type) > 0 ? 3 : 0;
}

/// The format of a block, on the line after its command: "(3i9,6e21.13e3)".
void AnsysFile::readWidths(Lines& lines)
{
  this->widths_.clear();
  this->integers_ = 0;
  const std::size_t at = lines.at();
  std::string format = lines.next() ? upperCase(trimmed(lines.line())) : "";
  const bool isFormat = format.size() > 2 && format.front() == '(' && format.back() == ')';
  std::vector<Span> parts;
  splitAtCommas(format, { 1, std::max<std::size_t>(format.size(), 2) - 1 }, parts);
  for (std::size_t i = 0; isFormat && i < parts.size(); ++i)
  {
    const std::string part(parts[i].of(format));
    const std::size_t letter = part.find_first_of("IEFG");
    const int count = std::atoi(part.c_str());
    const int width = letter < part.size() ? std::atoi(part.c_str() + letter + 1) : 0;
    if (width < 1 || width > 100 || count < 0 || count > 100)
    {
      break;
    }
    this->widths_.insert(
      this->widths_.end(), static_cast<std::size_t>(std::max(count, 1)), std::size_t(width));
    this->integers_ = part[letter] == 'I' ? this->widths_.size() : this->integers_;
  }
  if (this->widths_.empty() || this->integers_ == 0)
  {
    this->failAt(0, at, "the format of the block is missing, as in (3i9,6e21.13e3).");
  }
}

/// Moves to the next line of a block. False at its end, which is a command or -1.
bool AnsysFile::nextOfBlock(Lines& lines, const char* block) const
{
  if (!lines.next())
  {
    this->fail(std::string("it ends inside of ") + block + ".");
  }
  const std::string_view line = trimmed(lines.line());
  return !line.empty() && line != "-1" && line[0] != 'N' && line[0] != 'n';
}

/// Those of a line, which stay until the next call.
const std::vector<NumberField>& AnsysFile::fieldsOf(Span line)
{
  this->fields_.clear();
  std::size_t column = 0;
  for (const std::size_t width : this->widths_)
  {
    this->fields_.push_back(fixedField(this->text(), line, column, width));
    column += width;
  }
  return this->fields_;
}

/// Those of a line, up to its end, which stay until the next call.
const std::vector<Index>& AnsysFile::integersOf(Span line)
{
  this->numbers_.clear();
  for (const NumberField& field : this->fieldsOf(line))
  {
    if (field.span.size() > 0)
    {
      this->numbers_.push_back(this->integerAt(0, field.span));
    }
  }
  return this->numbers_;
}

void AnsysFile::readNodes(Lines& lines)
{
  this->readWidths(lines);
  if (this->widths_.size() < this->integers_ + 3)
  {
    this->failAt(0, lines.span().begin, "the format of NBLOCK has less than three coordinates.");
  }
  while (this->nextOfBlock(lines, "NBLOCK"))
  {
    const std::vector<NumberField>& fields = this->fieldsOf(lines.span());
    NumberRules rules;
    rules.field = NumberRules::Field::Fixed;
    rules.width = fields[this->integers_].width;
    std::array<double, 3> x;
    this->places_.push_back(this->nodePlace(0, fields.data() + this->integers_, rules, x));
    this->mesh_.addNode(this->integerAt(0, fields[0].span), x[0], x[1], x[2]);
  }
}

/// The number of each element type, and that of its kind: 1, 185.
void AnsysFile::readTypes(Lines& lines)
{
  this->readWidths(lines);
  while (this->nextOfBlock(lines, "ETBLOCK"))
  {
    if (const std::vector<Index>& numbers = this->integersOf(lines.span()); numbers.size() >= 2)
    {
      this->types_[numbers[0]] = numbers[1];
    }
  }
}

/// Of the form SOLID: material, type, and so on, the number of nodes (9th), the element's number
/// (11th), its nodes.
void AnsysFile::readElements(Lines& lines)
{
  this->readWidths(lines);
  while (this->nextOfBlock(lines, "EBLOCK"))
  {
    const std::vector<Index>& head = this->integersOf(lines.span());
    if (head.size() < 12 || head[8] < 1 || head[8] > 100)
    {
      this->failAt(0, lines.span().begin, "an element of EBLOCK needs 11 numbers and its nodes.");
    }
    Element element{ head[10], head[0], head[1], { head.begin() + 11, head.end() },
      lines.span().begin };
    const auto count = static_cast<std::size_t>(head[8]);
    while (element.nodes.size() < count && this->nextOfBlock(lines, "EBLOCK"))
    {
      const std::vector<Index>& more = this->integersOf(lines.span());
      element.nodes.insert(element.nodes.end(), more.begin(), more.end());
    }
    if (element.nodes.size() != count)
    {
      this->failAt(0, element.at,
        "element " + std::to_string(element.number) + " should have " + std::to_string(count) +
          " nodes, and has " + std::to_string(element.nodes.size()) + ".");
    }
    this->elements_.push_back(std::move(element));
  }
}

/// A number below zero ends a range that begins with the number before it.
void AnsysFile::readComponent(Lines& lines, const std::vector<Span>& command)
{
  const auto word = [&](std::size_t i)
  { return std::string(i < command.size() ? command[i].of(this->text()) : std::string_view()); };
  Component component;
  component.name = word(1);
  const std::string kind = upperCase(word(2)).substr(0, 4);
  component.isOfNodes = kind == "NODE";
  const std::string countText = word(3).substr(0, word(3).find('!'));
  const int count = std::atoi(countText.c_str());
  this->readWidths(lines);
  for (int found = 0; found < count;)
  {
    const std::size_t at = lines.at();
    const std::vector<Index> numbers =
      lines.next() ? this->integersOf(lines.span()) : std::vector<Index>();
    if (numbers.empty())
    {
      this->failAt(0, at, "the component " + component.name + " has fewer numbers than it says.");
    }
    for (const Index number : numbers)
    {
      std::vector<std::pair<Index, Index>>& ranges = component.ranges;
      if (number >= 0)
      {
        ranges.emplace_back(number, number);
      }
      else if (ranges.empty() || number > -ranges.back().first)
      {
        this->failAt(0, at, "the range to " + std::to_string(number) + " has no beginning.");
      }
      else
      {
        ranges.back().second = -number;
      }
      ++found;
    }
  }
  if (kind == "NODE" || kind == "ELEM") // others are of the geometry
  {
    this->components_.push_back(std::move(component));
  }
}

/// "N,R5.3,LOC,number,,,x,y,z", as CDWRITE has it unblocked, or "N,number,x,y,z". A number of -1
/// ends the nodes.
void AnsysFile::readNodeCommand(Span line)
{
  const std::vector<NumberField>& fields = this->fields_;
  freeFields(this->text(), line, 9, this->fields_);
  const auto word = [&](std::size_t i) { return upperCase(fields[i].span.of(this->text())); };
  const bool isCoded = !parseInteger(word(1)) && !word(2).empty();
  if (isCoded && word(2) != "LOC")
  {
    return; // the angles of a node
  }
  const std::size_t at = isCoded ? 3 : 1, first = isCoded ? 6 : 2;
  const Index number = this->integerAt(0, fields[at].span);
  if (number == -1)
  {
    return;
  }
  if (!isCoded && this->system_ != 0)
  {
    this->failAt(0, line.begin,
      "the node " + std::to_string(number) + " is in the coordinate system " +
        std::to_string(this->system_) + " (CSYS). Write it in the global Cartesian one.");
  }
  NumberRules rules;
  rules.longest = 32;
  rules.separator = ',';
  std::array<double, 3> x;
  this->places_.push_back(this->nodePlace(0, fields.data() + first, rules, x));
  this->mesh_.addNode(number, x[0], x[1], x[2]);
}

/// "EN,R5.5,ATTR,nodes,material,type,real,section,system,number" and "EN,R5.5,NODE,..." for each
/// eight nodes, as CDWRITE has them unblocked; or "EN,number,..." and "EMORE,...".
void AnsysFile::readElementCommand(Span line)
{
  const std::vector<NumberField>& fields = this->fields_;
  freeFields(this->text(), line, 10, this->fields_);
  const auto word = [&](std::size_t i) { return upperCase(fields[i].span.of(this->text())); };
  const bool isMore = word(0) == "EMORE", isAttributes = word(2) == "ATTR";
  const bool isCoded = isAttributes || word(2) == "NODE";
  if (isAttributes)
  {
    const Index nodes = this->integerAt(0, fields[3].span);
    if (nodes == -1)
    {
      return; // the end
    }
    if (nodes < 1 || nodes > 100)
    {
      this->failAt(0, line.begin, "an element has " + std::to_string(nodes) + " nodes.");
    }
    this->missing_ = static_cast<std::size_t>(nodes);
    this->elements_.push_back({ this->integerAt(0, fields[9].span),
      this->integerAt(0, fields[4].span), this->integerAt(0, fields[5].span), {}, line.begin });
    return;
  }
  if (!isCoded && !isMore)
  {
    this->missing_ = 0;
    this->elements_.push_back(
      { this->integerAt(0, fields[1].span), this->material_, this->type_, {}, line.begin });
  }
  if (this->elements_.empty() || (isCoded && this->missing_ == 0))
  {
    this->failAt(0, line.begin, "nodes are given of no element.");
  }
  for (std::size_t i = isCoded ? 3 : isMore ? 1 : 2; i < fields.size(); ++i)
  {
    if (fields[i].span.size() > 0 && (!isCoded || this->missing_ > 0))
    {
      this->elements_.back().nodes.push_back(this->integerAt(0, fields[i].span));
      this->missing_ -= isCoded ? 1 : 0;
    }
  }
}

void AnsysFile::parse()
{
  Lines lines(this->text());
  std::vector<Span> fields;
  while (lines.next())
  {
    Span line = lines.span();
    line.end = line.begin + std::min(lines.line().find('!'), line.size()); // a comment
    splitAtCommas(this->text(), line, fields);
    const auto word = [&](std::size_t i)
    { return i < fields.size() ? upperCase(fields[i].of(this->text())) : std::string(); };
    const std::string command = word(0);
    if (command == "NBLOCK")
    {
      this->readNodes(lines);
    }
    else if (command == "EBLOCK" && word(2) == "SOLID")
    {
      this->readElements(lines);
    }
    else if (command == "EBLOCK")
    {
      this->mesh_.warnings.push_back(
        "An EBLOCK without SOLID is left out of the mesh; it stays in the file.");
    }
    else if (command == "CMBLOCK")
    {
      this->readComponent(lines, fields);
    }
    else if (command == "ETBLOCK")
    {
      this->readTypes(lines);
    }
    else if (command == "ET" && fields.size() > 2)
    {
      const std::string name = word(2);
      const std::size_t digits = std::min(name.find_first_of("0123456789"), name.size());
      this->types_[std::atoi(word(1).c_str())] = std::atoi(name.c_str() + digits);
    }
    else if (command == "N")
    {
      this->readNodeCommand(line);
    }
    else if (command == "EN" || command == "EMORE")
    {
      this->readElementCommand(line);
    }
    else if (command == "TYPE" || command == "MAT" || command == "CSYS")
    {
      Index& value = command == "TYPE"  ? this->type_
                     : command == "MAT" ? this->material_
                                        : this->system_;
      value = parseInteger(word(1)).value_or(0);
    }
    else if (isRefused(command))
    {
      this->failAt(0, line.begin,
        "the command " + command +
          " is not supported. Write an archive of all nodes and elements (CDWRITE).");
    }
  }
}

void AnsysFile::finish()
{
  if (this->mesh_.nodes() == 0)
  {
    this->fail("it has no nodes, in NBLOCK or in commands N.");
  }
  if (this->missing_ > 0)
  {
    this->failAt(0, this->elements_.back().at,
      "element " + std::to_string(this->elements_.back().number) + " lacks " +
        std::to_string(this->missing_) + " of its nodes.");
  }
  const Numbering nodesOf(this->mesh_.nodeNumbers, "node", this->path());
  std::set<Index> unknown;
  std::map<Index, std::vector<Index>> materials;
  for (const Element& element : this->elements_)
  {
    const auto defined = this->types_.find(element.type);
    if (defined == this->types_.end())
    {
      this->failAt(0, element.at,
        "element " + std::to_string(element.number) + " is of type " +
          std::to_string(element.type) + ", which no ET or ETBLOCK defines.");
    }
    const Index type = defined->second;
    const int kind = kindOf(type);
    if (kind == 0)
    {
      unknown.insert(type);
      continue;
    }
    auto [cellType, nodes] = kind == 1 ? solidElement(element.nodes) : shellElement(element.nodes);
    if (kind == 3 && nodes.size() >= 2)
    {
      cellType = Line;
      nodes.resize(2);
    }
    if (cellType == EmptyCell)
    {
      this->failAt(0, element.at,
        "element " + std::to_string(element.number) + " of type " + std::to_string(type) + " has " +
          std::to_string(element.nodes.size()) + " nodes, which is not supported.");
    }
    const CellShape* shape = cellShape(cellType);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      Index& node = nodes[i];
      if (node == 0 && static_cast<int>(i) >= shape->numberOfCorners)
      {
        node = -1; // between corners, left out
        continue;
      }
      const Index position = nodesOf.find(node);
      if (position < 0)
      {
        this->failAt(0, element.at,
          "element " + std::to_string(element.number) + " has the node " + std::to_string(node) +
            ", which is not defined.");
      }
      node = position;
    }
    materials[element.material].push_back(this->mesh_.addCell(cellType, nodes, element.number));
  }
  for (auto& [material, members] : materials)
  {
    this->mesh_.set("Material " + std::to_string(material)).cells = std::move(members);
  }
  const Numbering cellsOf(this->mesh_.cellNumbers, "element", this->path());
  for (const Component& component : this->components_)
  {
    NamedSet& set = this->mesh_.set(component.name);
    for (const auto& [first, last] : component.ranges) // of elements that are left out, too
    {
      component.isOfNodes ? nodesOf.add(first, last, set.nodes)
                          : cellsOf.add(first, last, set.cells);
    }
  }
  for (const Index type : unknown)
  {
    this->mesh_.warnings.push_back("Elements of the type " + std::to_string(type) +
                                   " are left out of the mesh; they stay in the file.");
  }
}
}

bool isAnsysFile(const std::string& path)
{
  return extensionOf(path) == ".cdb" && !readHead(path, 1).empty();
}

std::unique_ptr<SolverFile> readAnsysFile(const std::string& path)
{
  return std::make_unique<AnsysFile>(path);
}
}
