// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/CgnsFile.h"

#include "Files/ReadFile.h"
#include "Formats/CgnsElements.h"
#include "Formats/CgnsTree.h"
#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

namespace morph::io
{
#ifdef MESHMORPHING_HAS_CGNS
namespace
{
constexpr std::array<const char*, 3> Axes = { "CoordinateX", "CoordinateY", "CoordinateZ" };

class CgnsFile : public SolverFile
{
public:
  explicit CgnsFile(const std::string& path)
    : SolverFile(path)
  {
    const CgnsTree tree(path, path);
    const CgnsNode base = this->baseOf(tree);
    for (const CgnsNode& node : tree.children(base))
    {
      if (node.label == "Zone_t")
      {
        this->readZone(tree, base, node);
      }
    }
    if (std::none_of(this->mesh_.cellTypes.begin(), this->mesh_.cellTypes.end(),
          [](std::uint8_t type) { return dimensionOf(type) == 3; }))
    {
      this->fail("it has no volume elements: surfaces alone are not morphed.");
    }
    this->nodeAt_.clear();
    if (this->steps() > 0)
    {
      this->mesh_.displacementName = this->zones_.front().displacementName;
      this->mesh_.displacements = this->displacementsAt(this->steps() - 1);
    }
  }

  std::vector<double> displacementsAt(Index step) const override;
  Index steps() const override
  {
    std::size_t steps = this->zones_.empty() ? 0 : this->zones_.front().solutions.size();
    for (const Zone& zone : this->zones_)
    {
      steps = std::min(steps, zone.solutions.size());
    }
    return static_cast<Index>(steps);
  }

  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override;

private:
  struct Zone
  {
    std::string path;        ///< of its coordinates
    std::vector<Index> node; ///< the mesh's node of each of its nodes
    std::array<bool, 3> isSingle = { false, false, false };
    /// The three arrays of displacements of each solution at vertices that has them.
    std::vector<std::array<std::string, 3>> solutions;
    std::string displacementName;
  };

  CgnsNode baseOf(const CgnsTree& tree) const;
  void readZone(const CgnsTree& tree, const CgnsNode& base, const CgnsNode& node);
  void readNodes(const CgnsTree& tree, const CgnsNode& grid, Index count, const std::string& path);
  void readSection(const CgnsTree& tree, const CgnsNode& section);
  void addElement(const CgnsNode& section, Index type, const Index* nodes, Index number);
  void readSolution(const CgnsTree& tree, const CgnsNode& solution, const std::string& path);
  void readConditions(const CgnsTree& tree, const CgnsNode& zone);
  void addCondition(const CgnsTree& tree, const CgnsNode& condition);

  std::vector<Zone> zones_;
  std::map<std::array<double, 3>, Index> nodeAt_; ///< of the zones before
  std::unordered_map<Index, Index> cellOf_;       ///< by element number, of the last zone
  Index elementsBefore_ = 0;                      ///< of the zones before
};

CgnsNode CgnsFile::baseOf(const CgnsTree& tree) const
{
  std::vector<CgnsNode> bases;
  for (const CgnsNode& node : tree.roots())
  {
    if (node.label == "CGNSBase_t")
    {
      bases.push_back(node);
    }
  }
  if (bases.size() != 1)
  {
    this->fail(bases.empty() ? "it is no file of CGNS: it has no base."
                             : "it has several bases. Write each into a file of its own.");
  }
  const std::vector<Index> dimensions = tree.integers(bases[0]);
  if (dimensions.size() != 2 || dimensions[0] != 3 || dimensions[1] != 3)
  {
    this->fail("its base " + bases[0].name + " is not three-dimensional.");
  }
  return bases[0];
}

void CgnsFile::readZone(const CgnsTree& tree, const CgnsNode& base, const CgnsNode& node)
{
  const std::string kind = tree.text(tree.child(node, "ZoneType_t"));
  if (kind != "Unstructured")
  {
    this->fail("its zone " + node.name + " is structured. Unstructured zones alone are morphed.");
  }
  const std::vector<Index> sizes = tree.integers(node);
  const CgnsNode grid = tree.child(node, "GridCoordinates_t", "GridCoordinates");
  if (sizes.size() != 3 || sizes[0] < 1 || grid.id < 0)
  {
    this->fail("its zone " + node.name + " has no coordinates.");
  }
  if (tree.isLink(node) || tree.isLink(grid))
  {
    this->fail("the coordinates of its zone " + node.name +
               " are a link, perhaps to another file. Write them into the file itself.");
  }
  this->readNodes(tree, grid, sizes[0], "/" + base.name + "/" + node.name + "/GridCoordinates/");
  this->cellOf_.clear();
  for (const CgnsNode& section : tree.children(node))
  {
    if (section.label == "Elements_t")
    {
      this->readSection(tree, section);
    }
    if (section.label == "FlowSolution_t")
    {
      this->readSolution(
        tree, section, "/" + base.name + "/" + node.name + "/" + section.name + "/");
    }
  }
  this->readConditions(tree, node);
  Index last = this->elementsBefore_;
  for (const auto& [number, cell] : this->cellOf_)
  {
    last = std::max(last, this->elementsBefore_ + number);
  }
  this->elementsBefore_ = last;
}

void CgnsFile::readNodes(
  const CgnsTree& tree, const CgnsNode& grid, Index count, const std::string& path)
{
  Zone zone;
  zone.path = path;
  std::array<std::vector<double>, 3> x;
  for (std::size_t j = 0; j < 3; ++j)
  {
    const CgnsNode axis = tree.child(grid, "DataArray_t", Axes[j]);
    if (axis.id < 0 || tree.isLink(axis))
    {
      this->fail(path + " has no " + Axes[j] + " of its own: other coordinates and links are not " +
                 "supported.");
    }
    x[j] = tree.numbers(axis);
    zone.isSingle[j] = tree.isSinglePrecision(axis);
    if (static_cast<Index>(x[j].size()) != count)
    {
      this->fail(path + Axes[j] + " does not have " + std::to_string(count) + " values.");
    }
  }
  std::map<std::array<double, 3>, Index> added;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
  {
    const std::array<double, 3> at = { x[0][i] + 0., x[1][i] + 0., x[2][i] + 0. }; // no -0
    if (!std::isfinite(at[0] + at[1] + at[2]))
    {
      this->fail(path + " is not finite at the node " + std::to_string(i + 1) + ".");
    }
    const auto before = this->nodeAt_.find(at);
    if (before != this->nodeAt_.end())
    {
      zone.node.push_back(before->second);
      continue;
    }
    zone.node.push_back(this->mesh_.nodes());
    added.try_emplace(at, this->mesh_.nodes());
    this->mesh_.addNode(this->mesh_.nodes() + 1, x[0][i], x[1][i], x[2][i]);
  }
  this->nodeAt_.merge(added);
  this->zones_.push_back(std::move(zone));
}

/// Displacements are a vector whose name begins with "dis", as those of Exodus II.
void CgnsFile::readSolution(const CgnsTree& tree, const CgnsNode& solution, const std::string& path)
{
  const CgnsNode location = tree.child(solution, "GridLocation_t");
  if (location.id >= 0 && tree.text(location) != "Vertex")
  {
    return;
  }
  Zone& zone = this->zones_.back();
  std::map<std::string, std::array<std::string, 3>> vectors; // by name without the axis
  for (const CgnsNode& array : tree.children(solution))
  {
    const std::size_t axis =
      array.name.empty()
        ? 3
        : std::string("XYZ").find(static_cast<char>(std::toupper(array.name.back())));
    std::string stem = array.name.substr(0, std::max<std::size_t>(array.name.size(), 1) - 1);
    std::string start = stem.substr(0, 3);
    std::transform(start.begin(), start.end(), start.begin(),
      [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (array.label == "DataArray_t" && axis < 3 && start == "dis" && !tree.isLink(array))
    {
      vectors[stem][axis] = path + array.name;
    }
  }
  for (const auto& [name, arrays] : vectors)
  {
    if (std::none_of(arrays.begin(), arrays.end(), [](const auto& one) { return one.empty(); }))
    {
      zone.displacementName = name;
      zone.solutions.push_back(arrays);
      return;
    }
  }
}

std::vector<double> CgnsFile::displacementsAt(Index step) const
{
  if (step < 0 || step >= this->steps())
  {
    return {};
  }
  const CgnsTree tree(this->path(), this->path());
  std::vector<double> result(this->mesh_.coordinates.size());
  for (const Zone& zone : this->zones_)
  {
    for (std::size_t j = 0; j < 3; ++j)
    {
      const std::string& path = zone.solutions[static_cast<std::size_t>(step)][j];
      const std::vector<double> values = tree.numbers(tree.at(path));
      if (values.size() != zone.node.size())
      {
        this->fail(path + " does not have " + std::to_string(zone.node.size()) + " values.");
      }
      for (std::size_t i = values.size(); i-- > 0;) // of joined nodes the first
      {
        result[static_cast<std::size_t>(3 * zone.node[i]) + j] = values[i];
      }
    }
  }
  return result;
}

void CgnsFile::addElement(const CgnsNode& section, Index type, const Index* nodes, Index number)
{
  const CgnsElement kind = cgnsElement(type);
  const std::vector<Index>& nodeOf = this->zones_.back().node;
  std::vector<Index> one(nodes, nodes + kind.nodes);
  for (Index& node : one)
  {
    if (node < 1 || node > static_cast<Index>(nodeOf.size()))
    {
      this->fail("element " + std::to_string(number) + " of the section " + section.name +
                 " has the node " + std::to_string(node) + ", which does not exist.");
    }
    node = nodeOf[static_cast<std::size_t>(node - 1)];
  }
  cgnsToVtkOrder(kind.cellType, one);
  const Index cell = this->mesh_.addCell(kind.cellType, one, this->elementsBefore_ + number);
  if (!this->cellOf_.emplace(number, cell).second)
  {
    this->fail("there are two elements with the number " + std::to_string(number) + ".");
  }
  this->mesh_.set(section.name).cells.push_back(cell);
}

void CgnsFile::readSection(const CgnsTree& tree, const CgnsNode& section)
{
  const std::vector<Index> head = tree.integers(section);
  const CgnsNode range = tree.child(section, "IndexRange_t", "ElementRange"),
                 list = tree.child(section, "DataArray_t", "ElementConnectivity");
  if (head.empty() || range.id < 0 || list.id < 0)
  {
    this->fail("the section " + section.name + " has no elements.");
  }
  constexpr Index Mixed = 20;
  const Index type = head[0];
  if (type != Mixed && cgnsElement(type).cellType == EmptyCell)
  {
    this->fail("the section " + section.name + " has elements of the type " + std::to_string(type) +
               ": polyhedra and elements of third order and more are not " + "supported.");
  }
  const std::vector<Index> ends = tree.integers(range), nodes = tree.integers(list);
  const auto size = static_cast<Index>(nodes.size());
  if (ends.size() != 2 || ends[0] < 1 || ends[1] < ends[0] || ends[1] - ends[0] >= size)
  {
    this->fail("the numbers of elements of the section " + section.name + " are out of range.");
  }
  Index at = 0;
  for (Index number = ends[0]; number <= ends[1]; ++number)
  {
    const Index own = type == Mixed && at < size ? nodes[static_cast<std::size_t>(at++)] : type;
    const CgnsElement kind = cgnsElement(own);
    if (kind.cellType == EmptyCell || size - at < kind.nodes)
    {
      this->fail("element " + std::to_string(number) + " of the section " + section.name +
                 (kind.cellType == EmptyCell ? " is of a type that is not supported."
                                             : " is not complete."));
    }
    this->addElement(section, own, nodes.data() + at, number);
    at += kind.nodes;
  }
  if (at != size)
  {
    this->fail("the section " + section.name + " has more nodes than its elements.");
  }
}

void CgnsFile::readConditions(const CgnsTree& tree, const CgnsNode& zone)
{
  for (const CgnsNode& conditions : tree.children(zone))
  {
    if (conditions.label != "ZoneBC_t")
    {
      continue;
    }
    for (const CgnsNode& condition : tree.children(conditions))
    {
      if (condition.label == "BC_t")
      {
        this->addCondition(tree, condition);
      }
    }
  }
}

void CgnsFile::addCondition(const CgnsTree& tree, const CgnsNode& condition)
{
  std::vector<Index> numbers;
  bool isOfElements = false;
  for (const CgnsNode& node : tree.children(condition))
  {
    isOfElements = isOfElements || node.name == "ElementList" || node.name == "ElementRange";
    if (node.label == "GridLocation_t")
    {
      isOfElements = isOfElements || tree.text(node) != "Vertex";
    }
    if (node.label == "IndexArray_t" && (node.name == "PointList" || node.name == "ElementList"))
    {
      numbers = tree.integers(node);
    }
    if (node.label == "IndexRange_t" && (node.name == "PointRange" || node.name == "ElementRange"))
    {
      const std::vector<Index> ends = tree.integers(node);
      const auto most =
        static_cast<Index>(std::max(this->zones_.back().node.size(), this->mesh_.cellTypes.size()));
      if (ends.size() != 2 || ends[0] < 1 || ends[1] < ends[0] || ends[1] - ends[0] > most)
      {
        this->fail("the range of the boundary condition " + condition.name + " is wrong.");
      }
      for (Index i = ends[0]; i <= ends[1]; ++i)
      {
        numbers.push_back(i);
      }
    }
  }
  std::vector<Index> members, unknown;
  const std::vector<Index>& nodeOf = this->zones_.back().node;
  for (const Index number : numbers)
  {
    const auto cell = this->cellOf_.find(number);
    if (isOfElements ? cell == this->cellOf_.end()
                     : number < 1 || number > static_cast<Index>(nodeOf.size()))
    {
      unknown.push_back(number);
      continue;
    }
    members.push_back(isOfElements ? cell->second : nodeOf[static_cast<std::size_t>(number - 1)]);
  }
  if (!unknown.empty())
  {
    this->fail("the boundary condition " + condition.name + " has the " +
               (isOfElements ? "elements " : "nodes ") + listIds(unknown) +
               ", which do not exist.");
  }
  for (const std::string& name :
    { condition.name, tree.text(tree.child(condition, "FamilyName_t")) })
  {
    if (!name.empty())
    {
      NamedSet& set = this->mesh_.set(name);
      std::vector<Index>& of = isOfElements ? set.cells : set.nodes;
      of.insert(of.end(), members.begin(), members.end());
    }
  }
}

std::vector<NewFile> CgnsFile::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  for (const Zone& zone : this->zones_)
  {
    for (std::size_t i = 0; i < 3 * zone.node.size(); ++i)
    {
      const Index node = zone.node[i / 3];
      const double x = coordinates[static_cast<std::size_t>(3 * node) + i % 3];
      if (zone.isSingle[i % 3])
      {
        const auto value = static_cast<float>(x);
        if (!std::isfinite(value))
        {
          throw Error("The coordinate " + std::to_string(x) + " of node " +
                      std::to_string(node + 1) + " does not fit into single precision.");
        }
        largestRounding = std::max(largestRounding, std::abs(double(value) - x));
      }
    }
  }
  NewFile copy = { out, readFile(this->path()) };
  copy.edit = [zones = this->zones_, coordinates, out](const std::string& temporary)
  {
    CgnsTree tree(temporary, out, CgnsTree::Access::Write);
    for (const Zone& zone : zones)
    {
      for (std::size_t j = 0; j < 3; ++j)
      {
        std::vector<double> values;
        for (const Index node : zone.node)
        {
          values.push_back(coordinates[static_cast<std::size_t>(3 * node) + j]);
        }
        tree.write(tree.at(zone.path + Axes[j]), values);
      }
    }
    tree.close();
  };
  return { copy };
}
}

std::unique_ptr<SolverFile> readCgnsFile(const std::string& path)
{
  return std::make_unique<CgnsFile>(path);
}
#else
std::unique_ptr<SolverFile> readCgnsFile(const std::string& path)
{
  throw Error("Cannot read or write " + path +
              ": this MeshMorphing was built without the library of CGNS. Build with it "
              "(libcgns-dev).");
}
#endif

bool isCgnsFile(const std::string& path)
{
  if (extensionOf(path) != ".cgns")
  {
    return false;
  }
  const std::string head = readHead(path, 32);
  return head.rfind("\x89HDF\r\n\x1a\n", 0) == 0 || head.find("ADF Database") != std::string::npos;
}
}
