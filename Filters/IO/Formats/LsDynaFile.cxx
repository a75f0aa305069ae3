// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/LsDynaFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusKeyword.h"
#include "Formats/Numbering.h"
#include "Formats/SolidElements.h"
#include "Formats/TextFile.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace morph::io
{
namespace
{
class LsDynaFile : public TextFile
{
public:
  explicit LsDynaFile(const std::string& path)
    : TextFile(path)
  {
    this->parse(this->addPart(path, ""), 0);
    this->finish();
  }

private:
  /// What the lines of a keyword are.
  enum class Block
  {
    Other,
    Include,
    Node,
    Part,
    Solid,
    ThickShell,
    Shell,
    Beam,
    Discrete,
    RigidBody,
    NodeSet,
    SegmentSet,
    SolidSet,
    ThickShellSet,
    ShellSet,
    BeamSet,
    PartSet,
  };
  struct Element
  {
    Index number = 0, part = 0;
    std::vector<Index> nodes;
    std::size_t file = 0, at = 0;
    Block kind = Block::Solid;
  };
  /// A nodal rigid body: its set of nodes, and a further node or 0.
  struct RigidBody
  {
    Index set, node;
  };
  struct Set
  {
    Block kind;
    Index number;
    std::string name;
    bool isRange; ///< first and last of each range
    std::vector<Index> members;
  };

  void parse(std::size_t part, int depth);
  bool takesBlank() const;
  void takeKeyword(std::size_t part, Span span);
  void takeCard(std::size_t part, Span span);
  void takeElement(std::size_t part, Span span);
  void takeSet(std::size_t part, Span span);
  /// These and the next stay until the next call.
  const std::vector<NumberField>& fieldsOf(
    std::size_t part, Span span, std::initializer_list<std::size_t> widths, std::size_t count);
  /// The first `count` numbers, or all of a line between commas where it is a list.
  std::vector<Index>& integersOf(
    std::size_t part, Span span, std::size_t width, std::size_t count, bool isList = false);
  Index position(Index node, const std::string& what) const;
  void addElements();
  void addSet(const Set& set);
  void addRigidBodies();
  void makeNamesUnique();
  void finish();

  Block block_ = Block::Other;
  bool isLong_ = false, isLongBlock_ = false; ///< all fields have 20 columns
  bool isWide_ = false, isWideBlock_ = false; ///< fields of 8 columns have 10
  bool hasTitle_ = false, isRange_ = false;
  bool isFirstAlone_ = false;     ///< of the cards of rigid bodies
  int line_ = 0;                  ///< of the block, from 0
  bool isOpen_ = false;           ///< the nodes of an element are on the next line
  int extraLines_ = 0, skip_ = 0; ///< of each element, and of the one before
  std::string title_;
  std::vector<NumberField> fields_; ///< of a line
  std::vector<Index> numbers_;      ///< of a line
  std::vector<Element> elements_;
  std::map<Block, Numbering> cells_; ///< each kind of element has its own numbers
  std::vector<Set> sets_;
  std::vector<RigidBody> rigidBodies_;
  std::map<Index, std::string> titles_; ///< of parts
  std::set<std::string> unknown_;
  Numbering nodes_;
  std::map<Index, std::vector<Index>> cellsOfPart_;
};

/// Fields of these widths, the last of them repeated, or between commas.
const std::vector<NumberField>& LsDynaFile::fieldsOf(
  std::size_t part, Span span, std::initializer_list<std::size_t> widths, std::size_t count)
{
  const std::string_view text = this->parts_[part].text;
  if (span.of(text).find(',') != std::string_view::npos)
  {
    freeFields(text, span, count, this->fields_);
    return this->fields_;
  }
  this->fields_.clear();
  for (std::size_t i = 0, column = 0; i < count; ++i)
  {
    const std::size_t own = widths.begin()[std::min(i, widths.size() - 1)];
    const std::size_t width = this->isLongBlock_ ? 20 : this->isWideBlock_ && own == 8 ? 10 : own;
    this->fields_.push_back(fixedField(text, span, column, width));
    column += width;
  }
  return this->fields_;
}

std::vector<Index>& LsDynaFile::integersOf(
  std::size_t part, Span span, std::size_t width, std::size_t count, bool isList)
{
  const std::vector<NumberField>& fields = this->fieldsOf(part, span, { width }, count);
  this->numbers_.resize(isList ? fields.size() : count);
  for (std::size_t i = 0; i < this->numbers_.size(); ++i)
  {
    const Span field = fields[i].span;
    this->numbers_[i] = field.size() == 0 ? 0 : this->integerAt(part, field);
  }
  return this->numbers_;
}

/// Whether a line without content is a title, or one that an element has beside its nodes.
bool LsDynaFile::takesBlank() const
{
  return (this->block_ == Block::Part && this->line_ % 2 == 0) ||
         (this->hasTitle_ && this->line_ == 0) || this->skip_ > 0;
}

/// Up to *END, which ends one file alone.
void LsDynaFile::parse(std::size_t part, int depth)
{
  const std::string& text = this->parts_[part].text;
  Lines lines(text);
  while (lines.next())
  {
    const std::string_view line = lines.line();
    if (trimmed(line).empty() ? !this->takesBlank() : line[0] == '$')
    {
      continue;
    }
    if (!line.empty() && line[0] == '*')
    {
      if (upperCase(trimmed(line)) == "*END")
      {
        return;
      }
      this->takeKeyword(part, lines.span());
    }
    else if (this->block_ == Block::Include)
    {
      const std::size_t at = lines.span().begin;
      std::string name(trimmed(line));
      while (name.size() > 2 && name.compare(name.size() - 2, 2, " +") == 0 && lines.next())
      {
        name = name.substr(0, name.size() - 2) + std::string(trimmed(lines.line()));
      }
      if (depth >= DeepestInclude)
      {
        this->failAt(part, at, "files include each other more than 20 levels deep.");
      }
      this->parse(this->addIncluded(part, name), depth + 1);
      this->block_ = Block::Include;
    }
    else
    {
      this->takeCard(part, lines.span());
    }
  }
}

void LsDynaFile::takeKeyword(std::size_t part, Span span)
{
  static const std::map<std::string, Block> blocks = { { "INCLUDE", Block::Include },
    { "NODE", Block::Node }, { "PART", Block::Part }, { "ELEMENT_SOLID", Block::Solid },
    { "ELEMENT_TSHELL", Block::ThickShell }, { "ELEMENT_SHELL", Block::Shell },
    { "ELEMENT_BEAM", Block::Beam }, { "ELEMENT_DISCRETE", Block::Discrete },
    { "CONSTRAINED_NODAL_RIGID_BODY", Block::RigidBody }, { "SET_NODE", Block::NodeSet },
    { "SET_SEGMENT", Block::SegmentSet }, { "SET_SOLID", Block::SolidSet },
    { "SET_TSHELL", Block::ThickShellSet }, { "SET_SHELL", Block::ShellSet },
    { "SET_BEAM", Block::BeamSet }, { "SET_PART", Block::PartSet } };
  static const std::map<std::string, std::string> refused = {
    { "INCLUDE_", "files that are included by another keyword than *INCLUDE" },
    { "NODE_", "nodes that are transformed, or defined otherwise than by *NODE" },
    { "DEFINE_TRANSFORMATION", "parts that are transformed" },
    { "PART_MOVE", "parts that are transformed" }, { "PARAMETER", "parameters" }
  };
  // The lines that an option of a keyword adds to each element.
  static const std::map<std::string, int> options = { { "_ORTHO", 2 }, { "_DOF", 1 },
    { "_THICKNESS", 1 }, { "_BETA", 1 }, { "_MCID", 1 }, { "_OFFSET", 1 }, { "_ORIENTATION", 1 },
    { "_PID", 1 }, { "_SECTION", 1 } };
  std::string name = upperCase(trimmed(span.of(this->parts_[part].text).substr(1)));
  this->isLong_ = this->isLong_ || name.find("LONG=Y") != std::string::npos;
  this->isWide_ = this->isWide_ || name.find("I10=Y") != std::string::npos;
  this->isWideBlock_ = this->isWide_ || name.find('%') != std::string::npos;
  this->isLongBlock_ = this->isLong_;
  // The sign of long fields, and that of wide ones, may stand behind a blank.
  const std::size_t end = name.find_first_of(" ,%+-");
  const std::size_t sign = end == std::string::npos ? end : name.find_first_not_of(" ,%", end);
  if (sign != std::string::npos && (name[sign] == '+' || name[sign] == '-'))
  {
    this->isLongBlock_ = name[sign] == '+';
  }
  name = name.substr(0, end);
  for (const auto& [start, what] : refused)
  {
    if (name.rfind(start, 0) == 0)
    {
      this->failAt(part, span.begin,
        "it has *" + name + ": " + what + " are not read. Write a deck without them.");
    }
  }
  std::string rest = name;
  const auto drop = [&rest](const std::string& end)
  {
    const bool ends =
      rest.size() > end.size() && rest.compare(rest.size() - end.size(), end.size(), end) == 0;
    rest.resize(rest.size() - (ends ? end.size() : 0));
    return ends;
  };
  const bool isElement = name.rfind("ELEMENT_", 0) == 0, isSet = name.rfind("SET_", 0) == 0;
  this->hasTitle_ = drop("_TITLE");
  this->isRange_ = isSet && drop("_GENERATE");
  this->extraLines_ = 0;
  if (isSet)
  {
    drop("_LIST");
  }
  for (auto option = options.begin(); isElement && option != options.end();)
  {
    const bool has = drop(option->first);
    this->extraLines_ += has ? option->second : 0;
    option = has ? options.begin() : std::next(option);
  }
  const std::string rigid = "CONSTRAINED_NODAL_RIGID_BODY";
  this->isFirstAlone_ = rest.rfind(rigid + "_", 0) == 0; // SPC, INERTIA, OVERRIDE
  rest = this->isFirstAlone_ ? rigid : rest;
  const auto found = blocks.find(rest);
  this->block_ = found == blocks.end() ? Block::Other : found->second;
  this->line_ = this->skip_ = 0;
  this->isOpen_ = false;
  this->title_.clear();
  if (this->block_ == Block::Other && (isElement || isSet))
  {
    this->unknown_.insert(name);
  }
}

void LsDynaFile::takeCard(std::size_t part, Span span)
{
  switch (this->block_)
  {
    case Block::Node:
    {
      const auto& fields = this->fieldsOf(part, span, { 8, 16 }, 4);
      NumberRules rules;
      const bool isFixed = fields[1].width > 0;
      rules.field = isFixed ? NumberRules::Field::Fixed : NumberRules::Field::Free;
      rules.width = fields[1].width;
      rules.longest = 20;
      rules.separator = isFixed ? ' ' : ',';
      std::array<double, 3> x;
      this->places_.push_back(this->nodePlace(part, fields.data() + 1, rules, x));
      this->mesh_.addNode(this->integerAt(part, fields[0].span), x[0], x[1], x[2]);
      return;
    }
    case Block::Solid:
    case Block::ThickShell:
    case Block::Shell:
    case Block::Beam:
    case Block::Discrete:
      this->takeElement(part, span);
      return;
    case Block::RigidBody: // a title, and a card for each, or one and those of options
      if (const int line = this->line_++ - (this->hasTitle_ ? 1 : 0);
          line == 0 || (line > 0 && !this->isFirstAlone_))
      {
        const std::vector<Index>& numbers = this->integersOf(part, span, 10, 4);
        this->rigidBodies_.push_back({ numbers[2], numbers[3] });
      }
      return;
    case Block::Part: // a title and a card
      if (this->line_++ % 2 == 0)
      {
        this->title_ = trimmed(span.of(this->parts_[part].text));
        return;
      }
      this->titles_[this->integersOf(part, span, 10, 1)[0]] = this->title_;
      return;
    case Block::Other:
    case Block::Include:
      return;
    default:
      this->takeSet(part, span);
  }
}

/// On one line, or with its nodes on a second one. Gmsh puts nine of ten nodes on the first.
void LsDynaFile::takeElement(std::size_t part, Span span)
{
  if (this->skip_ > 0)
  {
    --this->skip_;
    return;
  }
  // What follows the two nodes of a beam or spring is its orientation.
  const bool isLine = this->block_ == Block::Beam || this->block_ == Block::Discrete;
  const bool isFirst = !this->isOpen_;
  std::vector<Index>& numbers =
    this->integersOf(part, span, 8, isLine ? 4 : 10, this->block_ == Block::Solid && isFirst);
  if (isFirst)
  {
    this->elements_.push_back({ numbers[0], numbers[1], {}, part, span.begin, this->block_ });
    numbers.erase(numbers.begin(), numbers.begin() + 2);
  }
  numbers.erase(std::find(numbers.begin(), numbers.end(), 0), numbers.end());
  std::vector<Index>& nodes = this->elements_.back().nodes;
  nodes.insert(nodes.end(), numbers.begin(), numbers.end());
  this->isOpen_ = isFirst && (nodes.empty() || nodes.size() == 9);
  this->skip_ = this->isOpen_ ? 0 : this->extraLines_;
}

void LsDynaFile::takeSet(std::size_t part, Span span)
{
  const int line = this->line_++;
  if (this->hasTitle_ && line == 0)
  {
    this->title_ = trimmed(span.of(this->parts_[part].text));
    return;
  }
  if (line == (this->hasTitle_ ? 1 : 0))
  {
    const Index number = this->integersOf(part, span, 10, 1)[0];
    this->sets_.push_back({ this->block_, number, this->title_, this->isRange_, {} });
    return;
  }
  const bool isSegment = this->block_ == Block::SegmentSet;
  std::vector<Index>& numbers = this->integersOf(part, span, 10, isSegment ? 4 : 8, !isSegment);
  if (!isSegment)
  {
    numbers.erase(std::remove(numbers.begin(), numbers.end(), 0), numbers.end());
  }
  std::vector<Index>& members = this->sets_.back().members;
  members.insert(members.end(), numbers.begin(), numbers.end());
}

/// A node's place in the mesh.
Index LsDynaFile::position(Index node, const std::string& what) const
{
  const Index position = this->nodes_.find(node);
  if (position < 0)
  {
    this->fail(what + " has the node " + std::to_string(node) + ", which is not defined.");
  }
  return position;
}

void LsDynaFile::addElements()
{
  std::map<Block, std::vector<Index>> numbers; // of each cell, or -1 where it is of another kind
  for (const Element& element : this->elements_)
  {
    const bool isSolid = element.kind == Block::Solid || element.kind == Block::ThickShell;
    auto [type, nodes] = isSolid ? solidElement(element.nodes) : shellElement(element.nodes);
    if (element.kind == Block::Discrete && element.nodes.size() < 2)
    {
      continue; // to the ground
    }
    if (element.kind == Block::Beam || element.kind == Block::Discrete)
    {
      type = nodes.size() == 2 ? Line : EmptyCell;
    }
    const std::string name = "element " + std::to_string(element.number);
    if (type == EmptyCell)
    {
      this->failAt(element.file, element.at,
        name + " has " + std::to_string(element.nodes.size()) + " nodes, which is not supported.");
    }
    for (Index& node : nodes)
    {
      node = this->position(node, name);
    }
    const Index cell = this->mesh_.addCell(type, nodes, element.number);
    numbers[element.kind].resize(static_cast<std::size_t>(cell), -1);
    numbers[element.kind].push_back(element.number);
    this->cellsOfPart_[element.part].push_back(cell);
  }
  for (const auto& [kind, ofKind] : numbers)
  {
    this->cells_[kind] = Numbering(ofKind, "element of one kind", this->path());
  }
}

void LsDynaFile::addSet(const Set& set)
{
  static const std::map<Block, Block> elements = { { Block::SolidSet, Block::Solid },
    { Block::ThickShellSet, Block::ThickShell }, { Block::ShellSet, Block::Shell },
    { Block::BeamSet, Block::Beam } };
  const std::string what = "the set " + set.name;
  NamedSet& named = this->mesh_.set(set.name);
  if (set.kind == Block::SegmentSet)
  {
    for (auto first = set.members.begin(); first != set.members.end(); first += 4)
    {
      auto [type, nodes] = shellElement({ first, first + 4 });
      for (Index& node : nodes)
      {
        node = this->position(node, what);
      }
      named.cells.push_back(this->mesh_.addCell(type, nodes, -1));
    }
    return;
  }
  // A list has each member, which may be missing in the deck but for nodes; a range has first and
  // last, and those between them that the deck has.
  for (std::size_t i = 0; i < set.members.size(); i += set.isRange ? 2 : 1)
  {
    const Index first = set.members[i];
    const Index last = !set.isRange                 ? first
                       : i + 1 < set.members.size() ? set.members[i + 1]
                                                    : first - 1;
    if (set.kind == Block::NodeSet && !set.isRange)
    {
      named.nodes.push_back(this->position(first, what));
    }
    else if (set.kind == Block::NodeSet)
    {
      this->nodes_.add(first, last, named.nodes);
    }
    else if (set.kind == Block::PartSet)
    {
      for (auto part = this->cellsOfPart_.lower_bound(first);
           part != this->cellsOfPart_.end() && part->first <= last; ++part)
      {
        named.cells.insert(named.cells.end(), part->second.begin(), part->second.end());
      }
    }
    else
    {
      this->cells_[elements.at(set.kind)].add(first, last, named.cells);
    }
  }
}

/// Adds lines from the first node of each to its others.
void LsDynaFile::addRigidBodies()
{
  for (const RigidBody& body : this->rigidBodies_)
  {
    std::vector<Index> nodes;
    if (body.node > 0)
    {
      nodes.push_back(this->position(body.node, "a nodal rigid body"));
    }
    for (const Set& set : this->sets_)
    {
      if (set.kind == Block::NodeSet && set.number == body.set)
      {
        const std::vector<Index>& members = this->mesh_.set(set.name).nodes;
        nodes.insert(nodes.end(), members.begin(), members.end());
      }
    }
    for (std::size_t i = 1; i < nodes.size(); ++i)
    {
      this->mesh_.addCell(Line, { nodes[0], nodes[i] }, -1);
    }
  }
}

/// Parts and sets without a title have their numbers as names, and so have those that share one.
void LsDynaFile::makeNamesUnique()
{
  static const std::map<Block, std::string> kinds = { { Block::NodeSet, "Node set " },
    { Block::SegmentSet, "Segment set " }, { Block::SolidSet, "Solid set " },
    { Block::ThickShellSet, "Thick shell set " }, { Block::ShellSet, "Shell set " },
    { Block::BeamSet, "Beam set " }, { Block::PartSet, "Part set " } };
  std::map<std::string, std::vector<std::pair<std::string*, std::string>>> byTitle;
  for (const auto& [part, cells] : this->cellsOfPart_)
  {
    std::string& title = this->titles_[part];
    byTitle[title].emplace_back(&title, "PID " + std::to_string(part));
  }
  for (Set& set : this->sets_)
  {
    byTitle[set.name].emplace_back(&set.name, kinds.at(set.kind) + std::to_string(set.number));
  }
  for (const auto& [title, owners] : byTitle)
  {
    for (const auto& [name, number] : owners)
    {
      *name = title.empty() ? number : owners.size() > 1 ? title + " (" + number + ")" : title;
    }
  }
}

void LsDynaFile::finish()
{
  if (this->mesh_.nodes() == 0)
  {
    this->fail("it has no *NODE.");
  }
  this->nodes_ = Numbering(this->mesh_.nodeNumbers, "node", this->path());
  this->addElements();
  this->makeNamesUnique();
  for (const auto& [part, cells] : this->cellsOfPart_)
  {
    this->mesh_.set(this->titles_[part]).cells = cells;
  }
  for (const Set& set : this->sets_)
  {
    this->addSet(set);
  }
  this->addRigidBodies();
  for (const std::string& name : this->unknown_)
  {
    this->mesh_.warnings.push_back(
      "What *" + name + " defines is left out of the mesh; it stays in the file.");
  }
}
}

bool isLsDynaFile(const std::string& path)
{
  const std::string extension = extensionOf(path);
  if (extension != ".k" && extension != ".key" && extension != ".dyn")
  {
    return false;
  }
  const std::string head = readHead(path, 1 << 16);
  Lines lines(head);
  while (lines.next())
  {
    const std::string_view line = lines.line();
    if (!trimmed(line).empty() && line[0] != '$')
    {
      return line[0] == '*';
    }
  }
  return false;
}

std::unique_ptr<SolverFile> readLsDynaFile(const std::string& path)
{
  return std::make_unique<LsDynaFile>(path);
}
}
