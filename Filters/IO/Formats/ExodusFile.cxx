// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/ExodusFile.h"

#include "Files/ReadFile.h"
#include "Formats/ExodusElements.h"
#include "Formats/JoinedNodes.h"
#include "Formats/NetCdf.h"
#include "Formats/Numbering.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>

namespace morph::io
{
#ifdef MESHMORPHING_HAS_NETCDF
namespace
{
constexpr std::array<const char*, 3> Axes = { "coordx", "coordy", "coordz" };

class ExodusFile : public SolverFile
{
public:
  explicit ExodusFile(const std::string& path)
    : SolverFile(path)
  {
    const NetCdf file(path, path);
    if (file.dimension("num_dim") != 3)
    {
      this->fail(file.dimension("num_dim") == 0
                   ? "it is no file of Exodus II: it has no dimension num_dim."
                   : "its nodes have " + std::to_string(file.dimension("num_dim")) +
                       " coordinates, and three are needed.");
    }
    this->readNodes(file);
    this->readBlocks(file);
    this->readNodeSets(file);
    this->readSideSets(file);
    this->mesh_.displacementName = this->findDisplacements(file);
    this->mesh_.displacements = this->displacementsIn(file, this->steps_ - 1);
  }

  std::vector<double> displacementsAt(Index step) const override
  {
    return this->displacementsIn(NetCdf(this->path(), this->path()), step);
  }
  Index steps() const override { return this->steps_; }

  std::vector<NewFile> withCoordinates(const std::vector<double>& coordinates,
    const std::string& out, double& largestRounding) const override;

private:
  /// The names of `count` blocks or sets, each given once in the file. `ids`: their variable.
  std::vector<std::string> namesOf(const NetCdf& file, Index count, const std::string& names,
    const std::string& ids, const std::string& start);
  void readNodes(const NetCdf& file);
  void readBlocks(const NetCdf& file);
  void addBlock(const NetCdf& file, const std::string& number, const std::string& name,
    const std::vector<Index>& elementNumbers);
  void readNodeSets(const NetCdf& file);
  void readSideSets(const NetCdf& file);
  std::string findDisplacements(const NetCdf& file);
  std::vector<double> displacementsIn(const NetCdf& file, Index step) const;
  std::vector<Index> numbersOf(const NetCdf& file, std::initializer_list<const char*> variables,
    Index count, const char* what) const;

  /// Makes the mesh's nodes of the file's. Nodes of different blocks at the very same position are
  /// one: some programs number the nodes of each block apart.
  void addNodes(
    const NetCdf& file, const std::vector<Index>& numbers, const std::vector<double>& coordinates);
  /// The mesh's node at a position (from 1) in the file; `where`: "the node set wall".
  Index nodeAt(Index position, const std::string& where) const;

  std::vector<Index> nodeOf_;        ///< the mesh's node of each node of the file
  std::vector<Index> cellOf_;        ///< of each element
  Index elements_ = 0;               ///< that were read
  std::vector<Index> displacements_; ///< their three variables, from 1
  Index steps_ = 0;                  ///< of time, that have displacements
  bool isSingle_ = false, isTogether_ = false;
};

std::vector<std::string> ExodusFile::namesOf(const NetCdf& file, Index count,
  const std::string& names, const std::string& ids, const std::string& start)
{
  const std::vector<Index> numbers =
    file.has(ids) ? file.integers(ids, count) : std::vector<Index>();
  std::vector<std::string> result = file.texts(names, count);
  result.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    if (result[i].empty())
    {
      result[i] = start + std::to_string(numbers.empty() ? Index(i + 1) : numbers[i]);
    }
    const auto isTaken = [&](const std::string& name)
    {
      return std::any_of(this->mesh_.sets.begin(), this->mesh_.sets.end(),
        [&](const NamedSet& set) { return set.name == name; });
    };
    if (isTaken(result[i]))
    {
      result[i] += " (" + start + std::to_string(numbers.empty() ? Index(i + 1) : numbers[i]) + ")";
    }
  }
  return result;
}

/// The numbers of nodes or elements, from the first of these variables that the file has.
std::vector<Index> ExodusFile::numbersOf(const NetCdf& file,
  std::initializer_list<const char*> variables, Index count, const char* what) const
{
  for (const char* variable : variables)
  {
    if (file.has(variable))
    {
      std::vector<Index> numbers = file.integers(variable, count);
      Numbering(numbers, what, this->path()); // there is none twice
      if (std::any_of(numbers.begin(), numbers.end(), [](Index n) { return n < 0; }))
      {
        this->fail(std::string("its ") + variable + " has negative numbers.");
      }
      return numbers;
    }
  }
  std::vector<Index> numbers(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    numbers[i] = static_cast<Index>(i + 1);
  }
  return numbers;
}

void ExodusFile::readNodes(const NetCdf& file)
{
  const Index count = file.dimension("num_nodes");
  if (count <= 0)
  {
    this->fail("it has no nodes.");
  }
  std::array<std::vector<double>, 3> x;
  this->isTogether_ = !file.has(Axes[0]);
  this->isSingle_ = file.isSinglePrecision(this->isTogether_ ? "coord" : Axes[0]);
  if (this->isTogether_)
  {
    const std::vector<double> all = file.numbers("coord", 3 * count);
    for (std::size_t j = 0; j < 3; ++j)
    {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(j) * count;
      x[j].assign(begin, begin + count);
    }
  }
  else
  {
    for (std::size_t j = 0; j < 3; ++j)
    {
      x[j] = file.numbers(Axes[j], count);
    }
  }
  const std::vector<Index> numbers =
    this->numbersOf(file, { "node_num_map", "node_map1" }, count, "node");
  std::vector<Index> notFinite;
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < x[0].size(); ++i)
  {
    if (!std::isfinite(x[0][i] + x[1][i] + x[2][i]))
    {
      notFinite.push_back(numbers[i]);
    }
    coordinates.insert(coordinates.end(), { x[0][i], x[1][i], x[2][i] });
  }
  if (!notFinite.empty())
  {
    this->fail("the coordinates of the nodes " + listIds(notFinite) + " are not finite.");
  }
  this->addNodes(file, numbers, coordinates);
}

void ExodusFile::addNodes(
  const NetCdf& file, const std::vector<Index>& numbers, const std::vector<double>& coordinates)
{
  std::vector<Index> blockOf(numbers.size(), -1);
  const Index blocks = file.dimension("num_el_blk");
  for (Index block = 1; block <= blocks; ++block)
  {
    const std::string number = std::to_string(block);
    const Index nodes = file.dimension("num_nod_per_el" + number);
    // A block of other elements is refused below.
    const Index values = nodes > 27 ? 0 : nodes * file.dimension("num_el_in_blk" + number);
    for (const Index node :
      values > 0 ? file.integers("connect" + number, values) : std::vector<Index>())
    {
      if (node >= 1 && node <= static_cast<Index>(blockOf.size()))
      {
        Index& first = blockOf[static_cast<std::size_t>(node - 1)];
        first = first < 0 ? block : first;
      }
    }
  }
  std::vector<Index> first = consecutive(numbers.size());
  if (blocks > 1)
  {
    first = joinedNodes(coordinates, blockOf);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (first[i] != static_cast<Index>(i))
    {
      this->nodeOf_.push_back(this->nodeOf_[static_cast<std::size_t>(first[i])]);
      continue;
    }
    this->nodeOf_.push_back(this->mesh_.nodes());
    const double* x = coordinates.data() + 3 * i;
    this->mesh_.addNode(numbers[i], x[0], x[1], x[2]);
  }
}

Index ExodusFile::nodeAt(Index position, const std::string& where) const
{
  if (position < 1 || position > static_cast<Index>(this->nodeOf_.size()))
  {
    this->fail(
      where + " has the node at position " + std::to_string(position) + ", which does not exist.");
  }
  return this->nodeOf_[static_cast<std::size_t>(position - 1)];
}

void ExodusFile::readBlocks(const NetCdf& file)
{
  const Index count = file.dimension("num_el_blk"), elements = file.dimension("num_elem");
  if (count <= 0 || elements <= 0)
  {
    this->fail("it has no elements.");
  }
  const std::vector<Index> numbers =
    this->numbersOf(file, { "elem_num_map", "elem_map1", "elem_map" }, elements, "element");
  const auto names = this->namesOf(file, count, "eb_names", "eb_prop1", "block_");
  for (Index i = 0; i < count; ++i)
  {
    this->addBlock(file, std::to_string(i + 1), names[static_cast<std::size_t>(i)], numbers);
  }
  if (this->elements_ != elements)
  {
    this->fail("its blocks have " + std::to_string(this->elements_) + " elements, and not the " +
               std::to_string(elements) + " of num_elem.");
  }
  if (std::none_of(this->mesh_.cellTypes.begin(), this->mesh_.cellTypes.end(),
        [](std::uint8_t type) { return dimensionOf(type) >= 2; }))
  {
    this->fail("it has no volume or surface elements.");
  }
}

void ExodusFile::addBlock(const NetCdf& file, const std::string& number, const std::string& name,
  const std::vector<Index>& elementNumbers)
{
  const std::string variable = "connect" + number;
  const Index elements = file.dimension("num_el_in_blk" + number),
              nodes = file.dimension("num_nod_per_el" + number);
  const std::string type = file.attribute(variable, "elem_type");
  if (elements < 0 || elements > static_cast<Index>(elementNumbers.size()) - this->elements_)
  {
    this->fail("its blocks have more elements than num_elem says.");
  }
  const std::uint8_t cellType = exodusCellType(type, nodes);
  if (elements > 0 && cellType == EmptyCell)
  {
    this->fail(
      "the block " + name + " has elements of the type '" + type.substr(0, 40) + "' with " +
      std::to_string(nodes) +
      " nodes, which are not known here. Write it with nodes at corners, or with those and one "
      "on each edge, as TETRA10 and PYRAMID13.");
  }
  NamedSet& set = this->mesh_.set(name);
  const std::vector<Index> connectivity =
    elements > 0 ? file.integers(variable, elements * nodes) : std::vector<Index>();
  for (Index i = 0; i < elements; ++i)
  {
    const auto begin = connectivity.begin() + i * nodes;
    std::vector<Index> one(begin, begin + nodes);
    const Index element = elementNumbers[static_cast<std::size_t>(this->elements_)];
    for (Index& node : one)
    {
      node = this->nodeAt(node, "element " + std::to_string(element));
    }
    exodusToVtkOrder(cellType, one);
    set.cells.push_back(this->mesh_.addCell(cellType, one, element));
    this->cellOf_.push_back(set.cells.back());
    ++this->elements_;
  }
}

void ExodusFile::readNodeSets(const NetCdf& file)
{
  const Index count = file.dimension("num_node_sets");
  const auto names = this->namesOf(file, count, "ns_names", "ns_prop1", "nodelist_");
  for (Index i = 0; i < count; ++i)
  {
    const std::string number = std::to_string(i + 1), variable = "node_ns" + number;
    if (!file.has(variable)) // an empty one
    {
      continue;
    }
    NamedSet& set = this->mesh_.set(names[static_cast<std::size_t>(i)]);
    for (const Index node : file.integers(variable, file.dimension("num_nod_ns" + number)))
    {
      set.nodes.push_back(this->nodeAt(node, "the node set " + set.name));
    }
  }
}

void ExodusFile::readSideSets(const NetCdf& file)
{
  const Index count = file.dimension("num_side_sets");
  const auto names = this->namesOf(file, count, "ss_names", "ss_prop1", "surface_");
  for (Index i = 0; i < count; ++i)
  {
    const std::string number = std::to_string(i + 1);
    if (!file.has("elem_ss" + number)) // an empty one
    {
      continue;
    }
    const Index sides = file.dimension("num_side_ss" + number);
    const std::vector<Index> elements = file.integers("elem_ss" + number, sides),
                             side = file.integers("side_ss" + number, sides);
    NamedSet& set = this->mesh_.set(names[static_cast<std::size_t>(i)]);
    Index edges = 0;
    for (std::size_t k = 0; k < elements.size(); ++k)
    {
      if (elements[k] < 1 || elements[k] > static_cast<Index>(this->cellOf_.size()))
      {
        this->fail("the side set " + set.name + " has the element at position " +
                   std::to_string(elements[k]) + ", which does not exist.");
      }
      const auto cell =
        static_cast<std::size_t>(this->cellOf_[static_cast<std::size_t>(elements[k] - 1)]);
      std::vector<Index> face;
      for (const int corner : exodusSide(this->mesh_.cellTypes[cell], side[k]))
      {
        face.push_back(
          this->mesh_.connectivity[static_cast<std::size_t>(this->mesh_.offsets[cell] + corner)]);
      }
      if (face.empty())
      {
        ++edges;
        continue;
      }
      set.cells.push_back(this->mesh_.addCell(face.size() == 3 ? Triangle : Quad, face, -1));
    }
    if (edges > 0)
    {
      this->mesh_.warnings.push_back(
        this->path() + ": " + std::to_string(edges) + " sides of the side set " + set.name +
        " are no faces. They stay in the file, and are left out of the mesh.");
    }
  }
}

/// Of the variables of nodes: VTK's readers take a vector as displacements whose name begins so.
/// Its three variables differ in the last character. Returns their common name.
std::string ExodusFile::findDisplacements(const NetCdf& file)
{
  std::map<std::string, std::map<char, Index>> vectors; // the variable of each last character
  Index variable = 0;
  for (const std::string& name : file.texts("name_nod_var", file.dimension("num_nod_var")))
  {
    std::string stem = name.substr(0, std::max<std::size_t>(name.size(), 1) - 1);
    std::transform(stem.begin(), stem.end(), stem.begin(),
      [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::map<char, Index>& axes = vectors[stem];
    axes.emplace(name.empty() ? ' ' : name.back(), ++variable);
    if (stem.compare(0, 3, "dis") == 0 && axes.size() == 3)
    {
      for (const auto& axis : axes)
      {
        this->displacements_.push_back(axis.second);
      }
      this->steps_ = file.dimension("time_step");
      return this->steps_ > 0 ? name.substr(0, name.size() - 1) : "";
    }
  }
  return {};
}

std::vector<double> ExodusFile::displacementsIn(const NetCdf& file, Index step) const
{
  if (step < 0 || step >= this->steps_)
  {
    return {};
  }
  const auto time = static_cast<std::size_t>(step);
  std::vector<double> result(this->mesh_.coordinates.size());
  for (std::size_t j = 0; j < 3; ++j)
  {
    const Index variable = this->displacements_[j],
                nodes = static_cast<Index>(this->nodeOf_.size());
    const std::string own = "vals_nod_var" + std::to_string(variable);
    const std::vector<double> values =
      file.has(own)
        ? file.row(own, { time }, nodes)
        : file.row("vals_nod_var", { time, static_cast<std::size_t>(variable - 1) }, nodes);
    for (std::size_t i = values.size(); i-- > 0;) // of joined nodes the first
    {
      result[static_cast<std::size_t>(3 * this->nodeOf_[i]) + j] = values[i];
    }
  }
  return result;
}

std::vector<NewFile> ExodusFile::withCoordinates(
  const std::vector<double>& coordinates, const std::string& out, double& largestRounding) const
{
  std::array<std::vector<double>, 3> x;
  for (const Index node : this->nodeOf_)
  {
    for (std::size_t j = 0; j < 3; ++j)
    {
      const double exact = coordinates[static_cast<std::size_t>(3 * node) + j];
      x[j].push_back(exact);
      if (!this->isSingle_)
      {
        continue;
      }
      const auto value = static_cast<float>(exact);
      if (!std::isfinite(value))
      {
        throw Error("The coordinate " + std::to_string(exact) + " of node " +
                    std::to_string(this->mesh().nodeNumbers[static_cast<std::size_t>(node)]) +
                    " does not fit into single precision.");
      }
      largestRounding = std::max(largestRounding, std::abs(double(value) - exact));
    }
  }
  NewFile copy = { out, readFile(this->path()) };
  copy.edit = [x, out, isTogether = this->isTogether_](const std::string& temporary)
  {
    NetCdf file(temporary, out, NetCdf::Access::Write);
    if (isTogether)
    {
      std::vector<double> all = x[0];
      all.insert(all.end(), x[1].begin(), x[1].end());
      all.insert(all.end(), x[2].begin(), x[2].end());
      file.write("coord", all);
    }
    for (std::size_t j = 0; j < 3 && !isTogether; ++j)
    {
      file.write(Axes[j], x[j]);
    }
    file.close();
  };
  return { copy };
}
}

std::unique_ptr<SolverFile> readExodusFile(const std::string& path)
{
  return std::make_unique<ExodusFile>(path);
}
#else
std::unique_ptr<SolverFile> readExodusFile(const std::string& path)
{
  throw Error("Cannot read or write " + path +
              " as a file of Exodus II: this MeshMorphing was built without netCDF. Build with it "
              "(libnetcdf-dev).");
}
#endif

bool isExodusFile(const std::string& path)
{
  const std::string extension = extensionOf(path);
  for (const char* one : { ".e", ".ex2", ".exo", ".exii", ".g", ".gen" })
  {
    if (extension == one)
    {
      const std::string head = readHead(path, 8); // of a classic file, or of HDF5
      return head.size() == 8 && (head.compare(0, 3, "CDF") == 0 || head == "\x89HDF\r\n\x1a\n");
    }
  }
  return false;
}
}
