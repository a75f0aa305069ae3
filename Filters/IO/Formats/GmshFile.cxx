// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/GmshFile.h"

#include "Files/ReadFile.h"
#include "Formats/GmshElements.h"
#include "Formats/GmshSections.h"
#include "Formats/Numbering.h"
#include "Formats/TextFile.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

namespace morph::io
{
namespace
{
using Group = std::pair<Index, Index>; ///< dimension and tag

class GmshFile : public TextFile
{
public:
  explicit GmshFile(const std::string& path)
    : TextFile(path)
  {
    this->addPart(path, "");
    this->parse();
  }

  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override;

private:
  struct Element
  {
    Index number = 0;
    std::uint8_t type = EmptyCell;
    std::vector<Index> nodes;
  };

  const std::string& content() const { return this->parts_[0].text; }
  void parse();
  void readNames(GmshCursor cursor);
  void readEntities(GmshCursor cursor, bool arePartitioned);
  void readNodes2(
    const GmshSections& sections, const GmshSections::Section& section, bool areParametric);
  void readNodes4(GmshCursor cursor);
  void readElements2(const GmshSections& sections, const GmshSections::Section& section);
  void readElements4(GmshCursor cursor);
  void addNode(GmshCursor& cursor, Index number);
  GmshElement kind(const GmshCursor& cursor, Index type) const;
  void addElement(
    const GmshCursor& cursor, const Element& element, const std::vector<Group>& groups);

  std::map<Group, std::string> names_;
  std::map<Group, std::vector<Group>> groupsOf_; ///< of each entity, by dimension and tag
  Numbering nodes_;
  std::map<std::vector<Index>, Index> cellOf_; ///< by sorted nodes, of version 2
  bool isBinary_ = false, isVersion4_ = false;
};

std::string nameOf(const Group& group)
{
  static const char* const Kinds[] = { "Point", "Curve", "Surface", "Volume" };
  return std::string("Physical ") + Kinds[std::clamp<Index>(group.first, 0, 3)] + " " +
         std::to_string(group.second);
}

void GmshFile::readNames(GmshCursor cursor)
{
  // Text, in binary files too.
  for (Index i = cursor.count(false, 4); i > 0; --i)
  {
    const Index dimension = cursor.integer(), tag = cursor.integer();
    std::string name = cursor.quoted();
    const bool isTaken = std::any_of(this->names_.begin(), this->names_.end(),
      [&](const auto& one) { return one.second == name; });
    const Group group(dimension, tag);
    this->names_[group] = name.empty() ? nameOf(group)
                          : isTaken    ? name + " (" + nameOf(group) + ")"
                                       : name;
  }
}

void GmshFile::readEntities(GmshCursor cursor, bool arePartitioned)
{
  if (arePartitioned)
  {
    cursor.size(); // the number of partitions
    for (Index i = cursor.count(true, 4); i > 0; --i)
    {
      cursor.integer(); // an entity of ghosts
      cursor.integer(); // its partition
    }
  }
  std::array<Index, 4> counts;
  for (Index& count : counts)
  {
    count = cursor.count(true, 16);
  }
  for (Index dimension = 0; dimension < 4; ++dimension)
  {
    for (Index i = counts[static_cast<std::size_t>(dimension)]; i > 0; --i)
    {
      const Index tag = cursor.integer();
      bool isInterface = false; // of partitions: it has the groups of what it cuts
      if (arePartitioned)
      {
        isInterface = cursor.integer() != dimension; // that of the entity it is a part of
        cursor.integer();                            // which has this tag
        for (Index j = cursor.count(true, 4); j > 0; --j)
        {
          cursor.integer(); // a partition
        }
      }
      for (int j = dimension == 0 ? 3 : 6; j > 0; --j)
      {
        cursor.number(); // a point, or a bounding box
      }
      auto& groups = this->groupsOf_[{ dimension, tag }];
      for (Index j = cursor.count(true, 4); j > 0; --j)
      {
        const Group group(dimension, std::abs(cursor.integer()));
        if (!isInterface)
        {
          groups.push_back(group);
        }
      }
      for (Index j = dimension == 0 ? 0 : cursor.count(true, 4); j > 0; --j)
      {
        cursor.integer(); // of its boundary
      }
    }
  }
}

void GmshFile::addNode(GmshCursor& cursor, Index number)
{
  if (number < 0)
  {
    cursor.fail("a node has the negative number " + std::to_string(number) + ".");
  }
  NodePlace place;
  std::array<double, 3> x;
  for (std::size_t j = 0; j < 3; ++j)
  {
    x[j] = cursor.number();
    place.numbers[j] = placeOf(cursor.place());
  }
  this->mesh_.addNode(number, x[0], x[1], x[2]);
  this->places_.push_back(place);
}

void GmshFile::readNodes2(
  const GmshSections& sections, const GmshSections::Section& section, bool areParametric)
{
  Index count = 0;
  GmshCursor cursor = sections.listCursor(section, 28, count);
  for (Index i = 0; i < count; ++i)
  {
    const Index number = cursor.integer();
    this->addNode(cursor, number);
    const Index dimension = areParametric ? cursor.integer() : 0; // of the entity it is on
    if (areParametric)
    {
      cursor.integer(); // the entity's tag
    }
    for (Index j = dimension == 1 || dimension == 2 ? dimension : 0; j > 0; --j)
    {
      cursor.number();
    }
  }
}

void GmshFile::readNodes4(GmshCursor cursor)
{
  const Index blocks = cursor.count(true, 20);
  for (int i = 0; i < 3; ++i)
  {
    cursor.size(); // how many nodes, and their least and greatest number
  }
  std::vector<Index> numbers;
  for (Index block = 0; block < blocks; ++block)
  {
    const Index dimension = cursor.integer();
    cursor.integer(); // the entity's tag
    const Index parameters = cursor.integer() != 0 ? std::clamp<Index>(dimension, 0, 3) : 0;
    numbers.resize(static_cast<std::size_t>(cursor.count(true, 32)));
    for (Index& number : numbers)
    {
      number = cursor.size();
    }
    for (const Index number : numbers)
    {
      this->addNode(cursor, number);
      for (Index i = 0; i < parameters; ++i)
      {
        cursor.number();
      }
    }
  }
}

GmshElement GmshFile::kind(const GmshCursor& cursor, Index type) const
{
  const GmshElement element = gmshElement(type);
  if (element.cellType == EmptyCell)
  {
    cursor.fail("the element type " + std::to_string(type) +
                " is not supported: elements of first and second order are. Set Mesh.ElementOrder "
                "to 2 in Gmsh.");
  }
  return element;
}

void GmshFile::addElement(
  const GmshCursor& cursor, const Element& element, const std::vector<Group>& groups)
{
  std::vector<Index> nodes;
  for (const Index number : element.nodes)
  {
    nodes.push_back(this->nodes_.find(number));
    if (nodes.back() < 0)
    {
      cursor.fail("element " + std::to_string(element.number) + " has the node " +
                  std::to_string(number) + ", which is not defined.");
    }
  }
  Index cell = this->mesh_.cells();
  if (!this->isVersion4_)
  {
    // An element comes again for each further group.
    std::vector<Index> key = nodes;
    std::sort(key.begin(), key.end());
    cell = this->cellOf_.try_emplace(std::move(key), cell).first->second;
  }
  if (cell == this->mesh_.cells())
  {
    gmshToVtkOrder(element.type, nodes);
    this->mesh_.addCell(element.type, nodes, element.number);
  }
  for (const Group& group : groups)
  {
    const auto name = this->names_.try_emplace(group, nameOf(group)).first;
    std::vector<Index>& cells = this->mesh_.set(name->second).cells;
    if (cells.empty() || cells.back() != cell)
    {
      cells.push_back(cell);
    }
  }
}

void GmshFile::readElements2(const GmshSections& sections, const GmshSections::Section& section)
{
  Index count = 0;
  GmshCursor cursor = sections.listCursor(section, 8, count);
  const bool isBinary = cursor.isBinary();
  for (Index done = 0; done < count;)
  {
    Element element;
    Index type = 0, following = 1, tags = 0;
    if (isBinary)
    {
      type = cursor.integer();
      following = cursor.count(false, 4);
      tags = cursor.count(false, 4);
    }
    const std::size_t before = cursor.at();
    for (Index i = 0; i < following; ++i, ++done)
    {
      element.number = cursor.integer();
      if (!isBinary)
      {
        type = cursor.integer();
        tags = cursor.count(false, 4);
      }
      const GmshElement kind = this->kind(cursor, type);
      std::vector<Group> groups;
      for (Index tag = 0; tag < tags; ++tag)
      {
        const Index value = std::abs(cursor.integer());
        if (tag == 0 && value != 0)
        {
          groups.push_back({ dimensionOf(kind.cellType), value });
        }
      }
      element.type = kind.cellType;
      element.nodes.resize(static_cast<std::size_t>(kind.nodes));
      for (Index& node : element.nodes)
      {
        node = cursor.integer();
      }
      this->addElement(cursor, element, groups);
    }
    if (cursor.at() == before)
    {
      cursor.fail("a block of elements is empty.");
    }
  }
}

void GmshFile::readElements4(GmshCursor cursor)
{
  const Index blocks = cursor.count(true, 20);
  for (int i = 0; i < 3; ++i)
  {
    cursor.size();
  }
  const std::vector<Group> none;
  for (Index block = 0; block < blocks; ++block)
  {
    const Index dimension = cursor.integer(), tag = cursor.integer();
    const GmshElement kind = this->kind(cursor, cursor.integer());
    const auto found = this->groupsOf_.find({ dimension, tag });
    Element element;
    element.type = kind.cellType;
    element.nodes.resize(static_cast<std::size_t>(kind.nodes));
    for (Index i = cursor.count(true, 16); i > 0; --i)
    {
      element.number = cursor.size();
      for (Index& node : element.nodes)
      {
        node = cursor.size();
      }
      this->addElement(cursor, element, found == this->groupsOf_.end() ? none : found->second);
    }
  }
}

void GmshFile::parse()
{
  const GmshSections sections(this->content(), this->path());
  this->isBinary_ = sections.isBinary;
  this->isVersion4_ = sections.isVersion4;
  const auto* parametric = sections.isVersion4 ? nullptr : sections.find("ParametricNodes");
  const auto* nodes = parametric ? parametric : sections.find("Nodes");
  const auto* elements = sections.find("Elements");
  if (!nodes || !elements)
  {
    this->fail(std::string("it has no section ") + (nodes ? "$Elements." : "$Nodes."));
  }
  if (const auto* names = sections.find("PhysicalNames"))
  {
    this->readNames(GmshCursor(this->content(), this->path(), names->begin, names->end, false));
  }
  const auto* entities = sections.find("Entities");
  const auto* partitioned = sections.find("PartitionedEntities");
  if (sections.isVersion4 && entities)
  {
    this->readEntities(sections.cursor(*entities), false);
  }
  if (sections.isVersion4 && partitioned)
  {
    this->readEntities(sections.cursor(*partitioned), true);
  }
  sections.isVersion4 ? this->readNodes4(sections.cursor(*nodes))
                      : this->readNodes2(sections, *nodes, parametric != nullptr);
  this->nodes_ = Numbering(this->mesh_.nodeNumbers, "node", this->path());
  sections.isVersion4 ? this->readElements4(sections.cursor(*elements))
                      : this->readElements2(sections, *elements);
  if (std::none_of(this->mesh_.cellTypes.begin(), this->mesh_.cellTypes.end(),
        [](std::uint8_t type) { return dimensionOf(type) >= 2; }))
  {
    this->fail("it has no volume or surface elements.");
  }
  this->cellOf_.clear();
}

std::vector<NewFile> GmshFile::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  if (!this->isBinary_)
  {
    return TextFile::withCoordinates(coordinates, out, largestRounding);
  }
  std::string content = this->content();
  for (std::size_t i = 0; i < coordinates.size(); ++i)
  {
    const std::size_t at = this->places_[i / 3].numbers[i % 3].begin;
    std::memcpy(content.data() + at, &coordinates[i], sizeof(double));
  }
  return { { out, std::move(content) } };
}
}

bool isGmshFile(const std::string& path)
{
  if (extensionOf(path) != ".msh")
  {
    return false;
  }
  const std::string head = readHead(path, 1 << 12);
  return head.rfind("$NOD", 0) == 0 || head.rfind("$MeshFormat", 0) == 0 ||
         head.find("\n$MeshFormat") != std::string::npos;
}

std::unique_ptr<SolverFile> readGmshFile(const std::string& path)
{
  return std::make_unique<GmshFile>(path);
}
}
