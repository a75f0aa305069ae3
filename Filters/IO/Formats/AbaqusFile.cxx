// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusElements.h"
#include "Formats/AbaqusKeyword.h"
#include "Formats/AbaqusSets.h"
#include "Formats/TextFile.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace morph::io
{
namespace
{
namespace fs = std::filesystem;

constexpr std::size_t LongestNumber = 20; // what CalculiX reads of a field
constexpr int DeepestInclude = 20;

class AbaqusFile : public TextFile
{
public:
  explicit AbaqusFile(const std::string& path)
    : TextFile(path)
  {
    this->parse(this->addPart(path, ""), 0);
    this->finish();
  }

private:
  enum class Block
  {
    Other,
    Node,
    Element,
    NodeSet,
    ElementSet,
    Surface
  };

  void parse(std::size_t part, int depth);
  void takeKeyword(std::size_t part, Span span, const AbaqusKeyword& keyword, int depth);
  void takeData(std::size_t part, Span span);
  void takeNode(std::size_t part);
  void takeElement(std::size_t part);
  void takeSet(std::size_t part);
  void takeSurface(std::size_t part);
  void include(std::size_t part, Span span, const std::string& name, int depth);
  void beginElements(std::size_t part, Span span, const AbaqusKeyword& keyword);
  void beginSurface(const AbaqusKeyword& keyword);
  void finish();

  Block block_ = Block::Other;
  bool generates_ = false;
  AbaqusElement element_;
  std::vector<Index> pending_;             ///< numbers of an element, until it has all
  AbaqusSets::Entries* entries_ = nullptr; ///< of the sets that the block adds to
  AbaqusSets::Surface* surface_ = nullptr;
  std::vector<Span> fields_;
  std::vector<std::vector<Index>> elementNodes_; ///< node numbers of each cell
  std::vector<std::uint8_t> elementTypes_;
  std::vector<Index> elementNumbers_;
  std::set<std::string> unknownTypes_;
  struct
  {
    std::string type;
    std::size_t part = 0, at = 0;
  } planar_;              ///< the first keyword of elements of a planar model
  bool hasDepth_ = false; ///< a node has a third coordinate
  AbaqusSets sets_;
};

/// What these keywords do to nodes or elements is not in their lines.
void refuseKeyword(const AbaqusKeyword& keyword, std::string& reason)
{
  static const std::set<std::string> assembled = { "PART", "INSTANCE", "ASSEMBLY" };
  static const std::set<std::string> generated = { "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN",
    "ELCOPY", "ELMOVE", "PARAMETER", "SUBMODEL", "IMPORT" };
  if (assembled.count(keyword.name) > 0)
  {
    reason = "it is made of parts and instances (*" + keyword.name +
             "). Write a flat input file, without parts and assemblies.";
  }
  else if (generated.count(keyword.name) > 0)
  {
    reason = "it has *" + keyword.name +
             ", which defines nodes or elements by others. Write an "
             "input file that lists them all.";
  }
  else if (keyword.name == "SYSTEM" || (keyword.name == "NODE" && keyword.has("SYSTEM") &&
                                         keyword.value("SYSTEM", true) != "R"))
  {
    reason = "its nodes are in another coordinate system (SYSTEM). Write them in the global "
             "rectangular one.";
  }
}

void AbaqusFile::parse(std::size_t part, int depth)
{
  Lines lines(this->parts_[part].text);
  while (lines.next())
  {
    const std::string_view line = lines.line();
    if (line.rfind("**", 0) == 0 || trimmed(line).empty())
    {
      continue;
    }
    if (line[0] != '*')
    {
      this->takeData(part, lines.span());
      continue;
    }
    const Span span = lines.span();
    std::string whole(trimmed(line.substr(1)));
    while (!whole.empty() && whole.back() == ',' && lines.next())
    {
      whole += lines.line().rfind("**", 0) == 0 ? "" : trimmed(lines.line());
    }
    this->takeKeyword(part, span, parseAbaqusKeyword(whole), depth);
  }
}

void AbaqusFile::include(std::size_t part, Span span, const std::string& name, int depth)
{
  if (name.empty() || depth >= DeepestInclude)
  {
    this->failAt(part, span.begin,
      name.empty() ? "the name of the included file (INPUT=) is missing."
                   : "files include each other more than 20 levels deep.");
  }
  // Abaqus looks in the folder of the job's file.
  const fs::path file = fs::path(this->path()).parent_path() / name;
  this->parse(this->addPart(file.string(), name), depth + 1);
}

void AbaqusFile::takeKeyword(std::size_t part, Span span, const AbaqusKeyword& keyword, int depth)
{
  if (keyword.name == "INCLUDE")
  {
    this->include(part, span, keyword.value("INPUT"), depth); // in the block of the including file
    return;
  }
  if (!this->pending_.empty())
  {
    this->failAt(part, span.begin,
      "the nodes of element " + std::to_string(this->pending_.front()) + " are not complete.");
  }
  std::string reason;
  refuseKeyword(keyword, reason);
  if (!reason.empty())
  {
    this->failAt(part, span.begin, reason);
  }
  this->block_ = Block::Other;
  this->entries_ = nullptr;
  this->generates_ = keyword.has("GENERATE");
  if (keyword.name == "NODE")
  {
    this->block_ = Block::Node;
    this->entries_ = this->sets_.nodeSet(keyword.value("NSET"));
  }
  else if (keyword.name == "ELEMENT")
  {
    this->beginElements(part, span, keyword);
  }
  else if (keyword.name == "NSET" || keyword.name == "ELSET")
  {
    const bool isNodes = keyword.name == "NSET";
    this->block_ = isNodes ? Block::NodeSet : Block::ElementSet;
    this->entries_ = isNodes ? this->sets_.nodeSet(keyword.value("NSET"))
                             : this->sets_.elementSet(keyword.value("ELSET"));
    if (isNodes && keyword.has("ELSET")) // the nodes of an element set
    {
      this->sets_.addNodesOf(keyword.value("ELSET"), keyword.value("NSET"));
    }
  }
  else if (keyword.name == "SURFACE")
  {
    this->beginSurface(keyword);
  }
  const bool readsFile = this->block_ == Block::Node || this->block_ == Block::Element;
  if (readsFile && keyword.has("INPUT"))
  {
    this->include(part, span, keyword.value("INPUT"), depth);
  }
}

void AbaqusFile::beginElements(std::size_t part, Span span, const AbaqusKeyword& keyword)
{
  const std::string type = keyword.value("TYPE", true);
  this->element_ = abaqusElement(type);
  if (this->element_.isPlanar && this->planar_.type.empty())
  {
    this->planar_ = { type, part, span.begin };
  }
  // A set of elements that are left out exists, too.
  this->entries_ = this->sets_.elementSet(keyword.value("ELSET"));
  if (this->element_.cellType == 0)
  {
    this->unknownTypes_.insert(type);
    return;
  }
  this->block_ = Block::Element;
}

void AbaqusFile::beginSurface(const AbaqusKeyword& keyword)
{
  // Combined, cut and analytical surfaces have no faces of their own.
  const std::string type = keyword.value("TYPE", true);
  if ((type.empty() || type == "ELEMENT" || type == "NODE") && !keyword.has("COMBINE"))
  {
    this->block_ = Block::Surface;
    this->surface_ = this->sets_.surface(keyword.value("NAME"), type == "NODE");
  }
}

void AbaqusFile::takeData(std::size_t part, Span span)
{
  if (this->block_ == Block::Other)
  {
    return;
  }
  splitAtCommas(this->parts_[part].text, span, this->fields_);
  switch (this->block_)
  {
    case Block::Node:
      this->takeNode(part);
      break;
    case Block::Element:
      this->takeElement(part);
      break;
    case Block::NodeSet:
    case Block::ElementSet:
      this->takeSet(part);
      break;
    case Block::Surface:
      this->takeSurface(part);
      break;
    case Block::Other:
      break;
  }
}

void AbaqusFile::takeNode(std::size_t part)
{
  NodePlace place;
  place.part = part;
  place.rules.longest = LongestNumber;
  place.rules.separator = ',';
  const Index number = this->integerAt(part, this->fields_[0]);
  std::array<double, 3> x = { 0, 0, 0 };
  for (std::size_t j = 0; j < 3; ++j)
  {
    if (j + 1 >= this->fields_.size())
    {
      place.numbers[j] = placeOf({ this->fields_.back().end, this->fields_.back().end });
      place.numbers[j].missing = 1;
      continue;
    }
    const Span field = this->fields_[j + 1];
    place.numbers[j] = placeOf(field);
    x[j] = field.size() == 0 ? 0 : this->numberAt(part, field);
    this->hasDepth_ = this->hasDepth_ || (j == 2 && field.size() > 0);
  }
  this->mesh_.addNode(number, x[0], x[1], x[2]);
  this->places_.push_back(place);
  if (this->entries_)
  {
    this->entries_->numbers.push_back(number);
  }
}

void AbaqusFile::takeElement(std::size_t part)
{
  for (const Span& field : this->fields_)
  {
    if (field.size() == 0)
    {
      continue; // after the last comma of a line
    }
    this->pending_.push_back(this->integerAt(part, field));
    if (static_cast<int>(this->pending_.size()) > this->element_.nodes)
    {
      this->elementNumbers_.push_back(this->pending_.front());
      this->elementTypes_.push_back(this->element_.cellType);
      this->elementNodes_.emplace_back(this->pending_.begin() + 1, this->pending_.end());
      if (this->entries_)
      {
        this->entries_->numbers.push_back(this->pending_.front());
      }
      this->pending_.clear();
      return; // other numbers on this line are no nodes
    }
  }
}

void AbaqusFile::takeSet(std::size_t part)
{
  if (!this->entries_)
  {
    return;
  }
  const std::string& text = this->parts_[part].text;
  if (this->generates_)
  {
    if (this->fields_.size() < 2)
    {
      this->failAt(part, this->fields_[0].begin, "GENERATE needs a first and a last number.");
    }
    const Index first = this->integerAt(part, this->fields_[0]);
    const Index last = this->integerAt(part, this->fields_[1]);
    const bool hasStep = this->fields_.size() > 2 && this->fields_[2].size() > 0;
    const Index step = hasStep ? this->integerAt(part, this->fields_[2]) : 1;
    if (step <= 0)
    {
      this->failAt(part, this->fields_[0].begin, "the step of GENERATE must be 1 or more.");
    }
    this->entries_->ranges.push_back({ first, last, step });
    return;
  }
  for (const Span& field : this->fields_)
  {
    const std::string_view entry = field.of(text);
    if (const auto number = parseInteger(entry))
    {
      this->entries_->numbers.push_back(*number);
    }
    else if (!entry.empty())
    {
      this->entries_->names.push_back(upperCase(entry));
    }
  }
}

void AbaqusFile::takeSurface(std::size_t part)
{
  const std::string& text = this->parts_[part].text;
  const std::string_view what = this->fields_[0].of(text);
  const std::string face = this->fields_.size() > 1 ? upperCase(this->fields_[1].of(text)) : "";
  if (this->surface_ && !what.empty())
  {
    this->surface_->push_back({ upperCase(what), face });
  }
}

void AbaqusFile::finish()
{
  if (!this->pending_.empty())
  {
    this->fail("the nodes of element " + std::to_string(this->pending_.front()) +
               " are not complete at the end.");
  }
  if (this->mesh_.nodes() == 0)
  {
    this->fail("it has no *NODE.");
  }
  if (!this->hasDepth_)
  {
    this->fail("its nodes have two coordinates: planar models are not morphed.");
  }
  // Beside volume elements they are faces: mesh generators have no other name for these.
  const bool hasVolume = std::any_of(this->elementTypes_.begin(), this->elementTypes_.end(),
    [](std::uint8_t type) { return dimensionOf(type) == 3; });
  if (!this->planar_.type.empty() && !hasVolume)
  {
    this->failAt(this->planar_.part, this->planar_.at,
      "its elements " + this->planar_.type +
        " make a planar model; volume meshes alone are morphed.");
  }
  const auto positions = positionsOf(this->mesh_.nodeNumbers, "node", this->path());
  positionsOf(this->elementNumbers_, "element", this->path());
  std::vector<Index> nodes;
  for (std::size_t e = 0; e < this->elementNumbers_.size(); ++e)
  {
    nodes.clear();
    for (const Index number : this->elementNodes_[e])
    {
      const auto found = positions.find(number);
      if (found == positions.end())
      {
        this->fail("element " + std::to_string(this->elementNumbers_[e]) + " has the node " +
                   std::to_string(number) + ", which is not defined.");
      }
      nodes.push_back(found->second);
    }
    this->mesh_.addCell(this->elementTypes_[e], nodes, this->elementNumbers_[e]);
  }
  this->sets_.addTo(this->mesh_, positions);
  for (const std::string& type : this->unknownTypes_)
  {
    this->mesh_.warnings.push_back(
      "Elements of the type '" + type + "' are left out of the mesh; they stay in the file.");
  }
}
}

bool isAbaqusFile(const std::string& path)
{
  if (extensionOf(path) != ".inp")
  {
    return false;
  }
  const std::string head = readHead(path, 1 << 16);
  Lines lines(head);
  while (lines.next())
  {
    const std::string_view line = lines.line();
    if (!trimmed(line).empty() && line.rfind("**", 0) != 0)
    {
      return line[0] == '*';
    }
  }
  return !head.empty() && head[0] == '*'; // comments alone, as far as they were read
}

std::unique_ptr<SolverFile> readAbaqusFile(const std::string& path)
{
  return std::make_unique<AbaqusFile>(path);
}
}
