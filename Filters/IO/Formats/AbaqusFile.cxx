// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusFile.h"

#include "Files/ReadFile.h"
#include "Formats/AbaqusElements.h"
#include "Formats/AbaqusKeyword.h"
#include "Formats/AbaqusSets.h"
#include "Formats/TextFile.h"
#include "Support/Lists.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

namespace morph::io
{
namespace
{
namespace fs = std::filesystem;

constexpr std::size_t LongestNumber = 20; // what CalculiX reads of a field

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
    Surface,
    Coupling,
    MultiPoint,
    System,
    Instance
  };

  /// What is added to the numbers of a part, so that each instance has its own.
  struct Shift
  {
    Index nodes = 0, elements = 0;
  };

  /// The nodes, elements and sets of a part, or of all.
  struct Model
  {
    SolverMesh mesh; ///< nodes alone
    std::vector<NodePlace> places;
    std::vector<std::vector<Index>> elementNodes; ///< node numbers of each cell
    std::vector<std::uint8_t> elementTypes;
    std::vector<std::uint8_t> arePlane; ///< of each element, not a shell's
    std::vector<Index> elementNumbers;
    AbaqusSets sets;
    /// What couplings and rigid bodies tie to each other: numbers of nodes, and names of sets or
    /// surfaces in upper case.
    std::vector<std::pair<std::string, std::string>> links;
    std::size_t instances = 0;
  };

  void parse(std::size_t part, int depth);
  void takeKeyword(std::size_t part, Span span, const AbaqusKeyword& keyword, int depth);
  void takeData(std::size_t part, Span span);
  void takePoints(std::size_t part, Span span);
  void takeNode(std::size_t part);
  void takeElement(std::size_t part);
  void takeSet(std::size_t part);
  void takeSurface(std::size_t part);
  void beginLinks(const AbaqusKeyword& keyword);
  void takeLinks(std::size_t part);
  void include(std::size_t part, Span span, const std::string& name, int depth);
  void beginElements(const AbaqusKeyword& keyword);
  void beginSurface(const AbaqusKeyword& keyword);
  bool takeAssembly(std::size_t part, Span span, const AbaqusKeyword& keyword);
  void beginInstance(std::size_t part, Span span, const AbaqusKeyword& keyword);
  void endInstance(std::size_t part, Span span);
  std::size_t systemOf(std::size_t part, std::size_t at, const AbaqusKeyword& keyword);
  const Shift& ownShift();
  std::string shifted(std::string_view entry, Index own, bool isNodes) const;
  void addLinks(const Numbering& numbering);
  void finish();

  Block block_ = Block::Other;
  bool generates_ = false;
  AbaqusElement element_;
  std::vector<Index> pending_;             ///< numbers of an element, until it has all
  AbaqusSets::Entries* entries_ = nullptr; ///< of the sets that the block adds to
  AbaqusSets::Surface* surface_ = nullptr;
  bool isOfNodes_ = false; ///< the surface
  std::string reference_;  ///< the node of a coupling, see Model::links
  std::vector<Span> fields_;
  Model all_;                           ///< in the assembly, or where there is none
  std::map<std::string, Model> models_; ///< of parts, by their names in upper case
  std::map<std::string, Shift> shifts_; ///< of instances
  std::optional<Shift> own_;            ///< of the assembly's own nodes and elements
  Model* model_ = &all_;                ///< to be added to
  Shift shift_;                         ///< of the block
  std::string instance_;                ///< of the block, in upper case, with a dot
  struct
  {
    std::string name, part;
    Model model;
  } open_;                                  ///< the instance that is being read
  std::vector<double> numbers_, placement_; ///< of *SYSTEM, and of *INSTANCE
  CoordinateFrame system_;                  ///< of the nodes that follow
  std::size_t frame_ = 0;                   ///< of the block's nodes
  std::set<std::string> unknownTypes_;
};

/// What these keywords do to nodes or elements is not in their lines.
void refuseKeyword(const AbaqusKeyword& keyword, std::string& reason)
{
  static const std::set<std::string> generated = { "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN",
    "ELCOPY", "ELMOVE", "SUBMODEL", "IMPORT" };
  if (generated.count(keyword.name) > 0)
  {
    reason = "it has *" + keyword.name +
             ", which defines nodes or elements by others. Write an "
             "input file that lists them all.";
  }
  else if (keyword.name == "NODE" && keyword.value("SYSTEM", true) == "S")
  {
    reason = "its nodes are in spherical coordinates (SYSTEM=S). Write rectangular or cylindrical "
             "ones.";
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
  if (this->takeAssembly(part, span, keyword))
  {
    return;
  }
  if (keyword.name == "NODE")
  {
    this->block_ = Block::Node;
    this->frame_ = this->systemOf(part, span.begin, keyword);
    this->entries_ = this->model_->sets.nodeSet(keyword.value("NSET"));
  }
  else if (keyword.name == "ELEMENT")
  {
    this->beginElements(keyword);
  }
  else if (keyword.name == "NSET" || keyword.name == "ELSET")
  {
    const bool isNodes = keyword.name == "NSET";
    this->block_ = isNodes ? Block::NodeSet : Block::ElementSet;
    AbaqusSets& sets = this->model_->sets;
    this->entries_ =
      isNodes ? sets.nodeSet(keyword.value("NSET")) : sets.elementSet(keyword.value("ELSET"));
    if (isNodes && keyword.has("ELSET")) // the nodes of an element set
    {
      sets.addNodesOf(this->instance_ + keyword.value("ELSET"), keyword.value("NSET"));
    }
  }
  else if (keyword.name == "SURFACE")
  {
    this->beginSurface(keyword);
  }
  else
  {
    this->beginLinks(keyword);
  }
  const bool readsFile = this->block_ == Block::Node || this->block_ == Block::Element;
  if (readsFile && keyword.has("INPUT"))
  {
    this->include(part, span, keyword.value("INPUT"), depth);
  }
}

void AbaqusFile::beginElements(const AbaqusKeyword& keyword)
{
  const std::string type = keyword.value("TYPE", true);
  this->element_ = abaqusElement(type);
  // A set of elements that are left out exists, too.
  this->entries_ = this->model_->sets.elementSet(keyword.value("ELSET"));
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
    this->isOfNodes_ = type == "NODE";
    this->surface_ = this->model_->sets.surface(keyword.value("NAME"), this->isOfNodes_);
  }
}

/// Couplings, rigid bodies and multi-point constraints tie nodes to each other.
void AbaqusFile::beginLinks(const AbaqusKeyword& keyword)
{
  const auto entry = [&](const char* option)
  {
    return keyword.has(option) ? this->shifted(keyword.value(option), this->shift_.nodes, true)
                               : std::string();
  };
  this->reference_ = entry("REF NODE");
  if (keyword.name == "MPC")
  {
    this->block_ = Block::MultiPoint;
  }
  else if (keyword.name == "KINEMATIC COUPLING" && !this->reference_.empty())
  {
    this->block_ = Block::Coupling;
  }
  else if ((keyword.name == "COUPLING" || keyword.name == "RIGID BODY") &&
           !this->reference_.empty())
  {
    for (const char* option : { "SURFACE", "ELSET", "NSET", "TIE NSET", "PIN NSET", "ROT NODE" })
    {
      if (const std::string name = entry(option); !name.empty())
      {
        this->model_->links.emplace_back(this->reference_, name);
      }
    }
  }
}

void AbaqusFile::takeLinks(std::size_t part)
{
  const std::string& text = this->parts_[part].text;
  const auto entry = [&](std::size_t field)
  { return this->shifted(this->fields_[field].of(text), this->shift_.nodes, true); };
  if (this->block_ == Block::Coupling)
  {
    this->model_->links.emplace_back(this->reference_, entry(0));
    return;
  }
  static const std::set<std::string> kinds = { "BEAM", "LINK", "PIN", "TIE" };
  if (this->fields_.size() >= 3 && kinds.count(upperCase(this->fields_[0].of(text))) > 0)
  {
    this->model_->links.emplace_back(entry(2), entry(1));
  }
}

/// Parts, instances and coordinate systems, and what numbers of the block belong to. Returns
/// whether that is all.
bool AbaqusFile::takeAssembly(std::size_t part, Span span, const AbaqusKeyword& keyword)
{
  const std::string& name = keyword.name;
  if (name == "SYSTEM" || name == "PART" || name == "INSTANCE" || name == "ASSEMBLY" ||
      name.rfind("END ", 0) == 0)
  {
    this->numbers_.clear();
    this->system_ = {};
    this->block_ = name == "SYSTEM" ? Block::System : Block::Other;
    if (name == "END INSTANCE")
    {
      this->endInstance(part, span);
    }
    else if (name == "PART")
    {
      this->model_ = &this->models_[keyword.value("NAME", true)];
    }
    else if (name == "INSTANCE")
    {
      this->beginInstance(part, span, keyword);
    }
    else if (name != "SYSTEM")
    {
      this->model_ = &this->all_;
    }
    return true;
  }
  static const std::set<std::string> numbered = { "NODE", "ELEMENT", "NSET", "ELSET", "SURFACE",
    "COUPLING", "KINEMATIC COUPLING", "RIGID BODY", "MPC" };
  this->instance_.clear();
  const bool isOwn = this->model_ == &this->all_ && numbered.count(name) > 0;
  this->shift_ = isOwn ? this->ownShift() : Shift();
  if (keyword.has("INSTANCE") && (name == "NSET" || name == "ELSET"))
  {
    const auto found = this->shifts_.find(keyword.value("INSTANCE", true));
    if (found == this->shifts_.end())
    {
      this->failAt(
        part, span.begin, "there is no instance '" + keyword.value("INSTANCE") + "' before it.");
    }
    this->shift_ = found->second;
    this->instance_ = found->first + ".";
  }
  return false;
}

/// Numbers of the assembly itself come after those of the instances before them.
const AbaqusFile::Shift& AbaqusFile::ownShift()
{
  if (!this->own_)
  {
    this->own_ = this->shifts_.empty() ? Shift() : this->shifts_[""];
  }
  return *this->own_;
}

void AbaqusFile::beginInstance(std::size_t part, Span span, const AbaqusKeyword& keyword)
{
  this->open_ = { keyword.value("NAME"), keyword.value("PART"), {} };
  const auto found = this->models_.find(upperCase(this->open_.part));
  if (found == this->models_.end() || this->open_.name.empty())
  {
    this->failAt(part, span.begin,
      "the instance '" + this->open_.name + "' is of the part '" + this->open_.part +
        "', which is not defined before it.");
  }
  if (++found->second.instances == 2)
  {
    this->sharesPlaces_ = true;
    this->mesh_.warnings.push_back("The part '" + this->open_.part +
                                   "' has several instances, which share its nodes in the file: "
                                   "what moves in one instance moves in all of them.");
  }
  this->open_.model = found->second; // it may have nodes and elements of its own, too
  this->model_ = &this->open_.model;
  this->block_ = Block::Instance;
}

void AbaqusFile::endInstance(std::size_t part, Span span)
{
  Model& model = this->open_.model;
  CoordinateFrame place;
  const auto point = [this](std::size_t at)
  {
    return Eigen::Vector3d(
      this->placement_[at], this->placement_[at + 1], this->placement_[at + 2]);
  };
  this->placement_.resize(this->placement_.size() <= 3 ? 3 : 10, 0);
  if (this->placement_.size() == 10)
  {
    const auto turned = rotationAbout(point(3), point(6), this->placement_[9]);
    if (!turned)
    {
      this->failAt(part, span.begin,
        "the instance '" + this->open_.name + "' turns about an axis of two equal points.");
    }
    place = *turned;
  }
  place.origin = place.toBasic(point(0));
  this->placement_.clear();
  const bool isMoved = !place.origin.isZero(0) || !place.axes.isIdentity(0);
  Shift& next = this->shifts_[""]; // beyond all numbers so far
  const Shift shift = next;
  std::map<std::size_t, std::size_t> frames; // of the assembly, by that of the part
  for (std::size_t i = 0; i < model.places.size(); ++i)
  {
    NodePlace node = model.places[i];
    const auto [frame, isNew] = frames.emplace(node.frame, node.frame);
    if (isNew && isMoved)
    {
      frame->second = this->frames_.size();
      this->frames_.push_back(combined(place, this->frames_[node.frame]));
    }
    node.frame = frame->second;
    const Eigen::Vector3d x =
      place.toBasic(Eigen::Map<const Eigen::Vector3d>(model.mesh.coordinates.data() + 3 * i));
    const Index number = model.mesh.nodeNumbers[i] + shift.nodes;
    this->all_.mesh.addNode(number, x[0], x[1], x[2]);
    this->all_.places.push_back(node);
    next.nodes = std::max(next.nodes, number);
  }
  AbaqusSets::Entries* whole = this->all_.sets.elementSet(this->open_.name);
  for (std::size_t e = 0; e < model.elementNumbers.size(); ++e)
  {
    std::vector<Index> nodes = model.elementNodes[e];
    for (Index& node : nodes)
    {
      node += shift.nodes;
    }
    this->all_.elementNodes.push_back(std::move(nodes));
    this->all_.elementTypes.push_back(model.elementTypes[e]);
    this->all_.arePlane.push_back(model.arePlane[e]);
    this->all_.elementNumbers.push_back(model.elementNumbers[e] + shift.elements);
    whole->numbers.push_back(this->all_.elementNumbers.back());
    next.elements = std::max(next.elements, this->all_.elementNumbers.back());
  }
  this->all_.sets.addInstance(model.sets, this->open_.name, shift.nodes, shift.elements);
  const auto ofInstance = [&](const std::string& entry)
  {
    const auto number = parseInteger(entry);
    return number ? std::to_string(*number + shift.nodes)
                  : upperCase(this->open_.name) + "." + entry;
  };
  for (const auto& [first, second] : model.links)
  {
    this->all_.links.emplace_back(ofInstance(first), ofInstance(second));
  }
  this->shifts_[upperCase(this->open_.name)] = shift;
  this->model_ = &this->all_;
}

/// The coordinate system of the nodes of a block.
std::size_t AbaqusFile::systemOf(std::size_t part, std::size_t at, const AbaqusKeyword& keyword)
{
  CoordinateFrame& system = this->system_;
  const std::vector<double>& x = this->numbers_; // of *SYSTEM
  const auto point = [&x](std::size_t i) { return Eigen::Vector3d(x[i], x[i + 1], x[i + 2]); };
  if (x.size() >= 3)
  {
    system.origin = point(0);
  }
  if (x.size() >= 6)
  {
    // Without a third point the third axis stays.
    const Eigen::Vector3d along = point(3) - point(0);
    const auto axes = axesOf(point(0), point(3),
      x.size() >= 9 ? point(6) : point(0) + Eigen::Vector3d(-along[1], along[0], 0));
    if (!axes)
    {
      this->failAt(part, at, "the points of *SYSTEM before it are on a line.");
    }
    system.axes = *axes;
  }
  system.kind = keyword.value("SYSTEM", true) == "C" ? CoordinateFrame::Kind::Cylindrical
                                                     : CoordinateFrame::Kind::Rectangular;
  if (system.kind == CoordinateFrame::Kind::Rectangular && x.size() < 3)
  {
    return 0;
  }
  this->frames_.push_back(system);
  return this->frames_.size() - 1;
}

/// An entry of a set, in upper case: a number, that of an instance too ("Block-1.7"), or a name.
std::string AbaqusFile::shifted(std::string_view entry, Index own, bool isNodes) const
{
  if (const auto number = parseInteger(entry))
  {
    return std::to_string(*number + own);
  }
  const std::string name = this->instance_ + upperCase(unquoted(entry));
  const std::size_t dot = name.rfind('.');
  const auto found = this->shifts_.find(name.substr(0, std::min(dot, name.size())));
  const bool hasDot = dot != std::string::npos && dot > 0;
  const auto number = hasDot ? parseInteger(name.substr(dot + 1)) : std::nullopt;
  if (found == this->shifts_.end() || !number)
  {
    return name;
  }
  return std::to_string(*number + (isNodes ? found->second.nodes : found->second.elements));
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
    case Block::Coupling:
    case Block::MultiPoint:
      this->takeLinks(part);
      break;
    case Block::System:
    case Block::Instance:
      this->takePoints(part, span);
      break;
    case Block::Other:
      break;
  }
}

/// A line of *SYSTEM or *INSTANCE. What is left out is 0, but for the second point of *SYSTEM.
void AbaqusFile::takePoints(std::size_t part, Span span)
{
  const bool isSystem = this->block_ == Block::System;
  const std::size_t first = isSystem ? 6 : 3, second = isSystem ? 3 : 7;
  std::vector<double>& numbers = isSystem ? this->numbers_ : this->placement_;
  while (!this->fields_.empty() && this->fields_.back().size() == 0) // a comma at the end
  {
    this->fields_.pop_back();
  }
  const std::size_t most = numbers.empty() ? first : numbers.size() == first ? second : 0;
  if (this->fields_.size() > most)
  {
    this->failAt(part, span.begin,
      std::string(isSystem ? "*SYSTEM" : "*INSTANCE") + " has up to " + std::to_string(first) +
        " numbers on its first line and " + std::to_string(second) +
        " on its second. Write the zeros of the first, too.");
  }
  const bool isPoint = isSystem && this->fields_.size() <= 3;
  const std::size_t whole = numbers.size() + (isPoint ? 3 : most);
  for (const Span& field : this->fields_)
  {
    numbers.push_back(field.size() == 0 ? 0 : this->numberAt(part, field));
  }
  numbers.resize(whole, 0);
}

void AbaqusFile::takeNode(std::size_t part)
{
  NodePlace place;
  place.part = part;
  place.rules.longest = LongestNumber;
  place.rules.separator = ',';
  place.frame = this->frame_;
  const Index number = this->integerAt(part, this->fields_[0]) + this->shift_.nodes;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
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
    x[static_cast<Index>(j)] = field.size() == 0 ? 0 : this->numberAt(part, field);
  }
  x = place.frame == 0 ? x : this->frames_[place.frame].toBasic(x);
  this->model_->mesh.addNode(number, x[0], x[1], x[2]);
  this->model_->places.push_back(place);
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
    this->pending_.push_back(this->integerAt(part, field) +
                             (this->pending_.empty() ? this->shift_.elements : this->shift_.nodes));
    if (static_cast<int>(this->pending_.size()) > this->element_.nodes)
    {
      this->model_->elementNumbers.push_back(this->pending_.front());
      this->model_->elementTypes.push_back(this->element_.cellType);
      this->model_->arePlane.push_back(this->element_.isPlane);
      this->model_->elementNodes.emplace_back(this->pending_.begin() + 1, this->pending_.end());
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
  const bool isNodes = this->block_ == Block::NodeSet;
  const Index own = isNodes ? this->shift_.nodes : this->shift_.elements;
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
    constexpr Index Largest = Index(1) << 50; // sums with it do not overflow
    if (step <= 0 || step > Largest || std::min(first, last) < 0 || std::max(first, last) > Largest)
    {
      this->failAt(part, this->fields_[0].begin,
        "GENERATE needs a first and a last number, neither below 0, and a step of 1 or more.");
    }
    this->entries_->ranges.push_back({ first + own, last + own, step });
    return;
  }
  for (const Span& field : this->fields_)
  {
    const std::string entry = this->shifted(field.of(text), own, isNodes);
    if (const auto number = parseInteger(entry))
    {
      this->entries_->numbers.push_back(*number);
    }
    else if (field.size() > 0)
    {
      this->entries_->names.push_back(entry);
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
    const Index own = this->isOfNodes_ ? this->shift_.nodes : this->shift_.elements;
    this->surface_->push_back({ this->shifted(what, own, this->isOfNodes_), face });
  }
}

/// Adds lines between the nodes that are tied: from one to all, or from each to its partner.
void AbaqusFile::addLinks(const Numbering& numbering)
{
  const auto nodesOf = [&](const std::string& entry)
  {
    const auto number = parseInteger(entry);
    if (const Index node = numbering.find(number.value_or(-1)); node >= 0)
    {
      return std::vector<Index>{ node };
    }
    std::vector<Index> nodes;
    for (const NamedSet& set : this->mesh_.sets)
    {
      if (upperCase(set.name) == entry)
      {
        nodes = set.nodes;
        for (const Index cell : set.cells)
        {
          const auto begin = this->mesh_.connectivity.begin();
          nodes.insert(nodes.end(), begin + this->mesh_.offsets[static_cast<std::size_t>(cell)],
            begin + this->mesh_.offsets[static_cast<std::size_t>(cell) + 1]);
        }
      }
    }
    sortUnique(nodes); // faces of a surface share nodes
    return nodes;
  };
  for (const auto& [first, second] : this->all_.links)
  {
    const std::vector<Index> hubs = nodesOf(first), others = nodesOf(second);
    const std::size_t count =
      hubs.size() == 1 ? others.size() : std::min(hubs.size(), others.size());
    for (std::size_t i = 0; i < count; ++i)
    {
      this->mesh_.addCell(Line, { hubs[hubs.size() == 1 ? 0 : i], others[i] }, -1);
    }
  }
}

void AbaqusFile::finish()
{
  if (!this->pending_.empty())
  {
    this->fail("the nodes of element " + std::to_string(this->pending_.front()) +
               " are not complete at the end.");
  }
  std::swap(this->all_.mesh.warnings, this->mesh_.warnings);
  this->mesh_ = std::move(this->all_.mesh);
  this->places_ = std::move(this->all_.places);
  if (this->mesh_.nodes() == 0)
  {
    this->fail(this->models_.empty() ? "it has no *NODE." : "no *INSTANCE has a *NODE.");
  }
  const Numbering numbering(this->mesh_.nodeNumbers, "node", this->path());
  std::vector<Index> nodes;
  for (std::size_t e = 0; e < this->all_.elementNumbers.size(); ++e)
  {
    nodes.clear();
    for (const Index number : this->all_.elementNodes[e])
    {
      nodes.push_back(numbering.find(number));
      if (nodes.back() < 0)
      {
        this->fail("element " + std::to_string(this->all_.elementNumbers[e]) + " has the node " +
                   std::to_string(number) + ", which is not defined.");
      }
    }
    this->mesh_.addCell(this->all_.elementTypes[e], nodes, this->all_.elementNumbers[e]);
  }
  const Numbering elements(this->mesh_.cellNumbers, "element", this->path());
  this->all_.sets.addTo(this->mesh_, numbering, elements, this->all_.arePlane);
  this->addLinks(numbering);
  for (const std::string& type : this->unknownTypes_)
  {
    this->mesh_.warnings.push_back(
      "Elements of the type '" + type + "' are left out of the mesh; they stay in the file.");
  }
}
}

bool isAbaqusFile(const std::string& path)
{
  // CalculiX's preprocessor writes decks as .msh.
  const std::string extension = extensionOf(path);
  if (extension != ".inp" && extension != ".msh")
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
