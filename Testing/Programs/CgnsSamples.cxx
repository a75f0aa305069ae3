// SPDX-License-Identifier: BSD-3-Clause
#include "CgnsSamples.h"

#include <cgnslib.h>

#include <array>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace
{
constexpr int Nodes = 4; // along each edge of the cube

void check(int status)
{
  if (status != CG_OK)
  {
    throw std::runtime_error(std::string("Cannot write CGNS: ") + cg_get_error());
  }
}

/// Layers of the cube from `first` to `last`, with nodes of their own.
class Zone
{
public:
  Zone(int file, int first, int last, bool isSingle)
    : file_(file)
    , layers_(last - first)
  {
    const int nodes = Nodes * Nodes * (this->layers_ + 1), cells = 9 * this->layers_;
    const cgsize_t sizes[] = { nodes, cells, 0 };
    check(cg_zone_write(
      file, 1, first == 0 ? "lower" : "upper", sizes, CGNS_ENUMV(Unstructured), &this->zone_));
    for (int axis = 0; axis < 3; ++axis)
    {
      std::vector<double> x;
      for (int i = 0; i < nodes; ++i)
      {
        x.push_back(axis == 0   ? i % Nodes
                    : axis == 1 ? i / Nodes % Nodes
                                : first + i / (Nodes * Nodes));
      }
      const std::vector<float> single(x.begin(), x.end());
      const char* const names[] = { "CoordinateX", "CoordinateY", "CoordinateZ" };
      int coordinate = 0;
      check(cg_coord_write(file, 1, this->zone_,
        isSingle ? CGNS_ENUMV(RealSingle) : CGNS_ENUMV(RealDouble), names[axis],
        isSingle ? static_cast<const void*>(single.data()) : x.data(), &coordinate));
    }
  }

  void writeCells(bool isMixed) const
  {
    std::vector<cgsize_t> list, offsets = { 0 };
    for (int z = 0; z < this->layers_; ++z)
    {
      for (int y = 0; y < Nodes - 1; ++y)
      {
        for (int x = 0; x < Nodes - 1; ++x)
        {
          if (isMixed)
          {
            list.push_back(CGNS_ENUMV(HEXA_8));
          }
          for (const int up : { 0, 1 })
          {
            list.insert(list.end(), { node(x, y, z + up), node(x + 1, y, z + up),
                                      node(x + 1, y + 1, z + up), node(x, y + 1, z + up) });
          }
          offsets.push_back(static_cast<cgsize_t>(list.size()));
        }
      }
    }
    this->writeSection("body", isMixed ? CGNS_ENUMV(MIXED) : CGNS_ENUMV(HEXA_8), 1,
      9 * this->layers_, list, offsets);
  }

  /// The faces at x = 0, and a condition on them.
  void writeWall() const
  {
    std::vector<cgsize_t> list;
    for (int z = 0; z < this->layers_; ++z)
    {
      for (int y = 0; y < Nodes - 1; ++y)
      {
        list.insert(list.end(),
          { node(0, y, z), node(0, y, z + 1), node(0, y + 1, z + 1), node(0, y + 1, z) });
      }
    }
    const cgsize_t range[] = { 9 * this->layers_ + 1, 12 * this->layers_ };
    this->writeSection("faces", CGNS_ENUMV(QUAD_4), range[0], range[1], list, {});
    int condition = 0;
    check(cg_boco_write(this->file_, 1, this->zone_, "wall", CGNS_ENUMV(BCWall),
      CGNS_ENUMV(PointRange), 2, range, &condition));
    check(
      cg_boco_gridlocation_write(this->file_, 1, this->zone_, condition, CGNS_ENUMV(FaceCenter)));
  }

  /// Displacements of two steps: (0.125 + step, 0, 0.25 z), and values of cells beside them.
  void writeSteps(int first) const
  {
    for (int step = 0; step < 3; ++step)
    {
      const bool isOfCells = step == 2;
      const int layer = isOfCells ? 9 : Nodes * Nodes;
      const int count = layer * (this->layers_ + (isOfCells ? 0 : 1));
      int solution = 0, field = 0;
      check(cg_sol_write(this->file_, 1, this->zone_, ("Step" + std::to_string(step)).c_str(),
        isOfCells ? CGNS_ENUMV(CellCenter) : CGNS_ENUMV(Vertex), &solution));
      std::vector<double> x(count, 0.125 + step), y(count, 0), z;
      for (int i = 0; i < count; ++i)
      {
        z.push_back(0.25 * (first + i / layer));
      }
      const std::vector<double>* values[] = { &x, &y, &z };
      const char* const names[] = { "DisplacementX", "DisplacementY", "DisplacementZ" };
      for (int axis = 0; axis < 3; ++axis)
      {
        check(cg_field_write(this->file_, 1, this->zone_, solution, CGNS_ENUMV(RealDouble),
          names[axis], values[axis]->data(), &field));
      }
    }
  }

  /// A condition on the uppermost nodes.
  void writeTop() const
  {
    std::vector<cgsize_t> list;
    for (int i = 0; i < Nodes * Nodes; ++i)
    {
      list.push_back(node(i % Nodes, i / Nodes, this->layers_));
    }
    int condition = 0;
    check(cg_boco_write(this->file_, 1, this->zone_, "outflow", CGNS_ENUMV(BCOutflow),
      CGNS_ENUMV(PointList), Nodes * Nodes, list.data(), &condition));
    check(cg_goto(this->file_, 1, "Zone_t", this->zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
    check(cg_famname_write("top"));
  }

private:
  static cgsize_t node(int x, int y, int z) { return 1 + x + Nodes * (y + Nodes * z); }

  void writeSection(const char* name, CGNS_ENUMT(ElementType_t) type, cgsize_t first, cgsize_t last,
    const std::vector<cgsize_t>& list, [[maybe_unused]] const std::vector<cgsize_t>& offsets) const
  {
    int section = 0;
#if CGNS_VERSION >= 3400
    if (type == CGNS_ENUMV(MIXED))
    {
      check(cg_poly_section_write(this->file_, 1, this->zone_, name, type, first, last, 0,
        list.data(), offsets.data(), &section));
      return;
    }
#endif
    check(cg_section_write(
      this->file_, 1, this->zone_, name, type, first, last, 0, list.data(), &section));
  }

  int file_, layers_, zone_ = 0;
};

int open(const std::string& path, int type)
{
  int file = 0, base = 0;
  check(cg_set_file_type(type));
  check(cg_open(path.c_str(), CG_MODE_WRITE, &file));
  check(cg_base_write(file, "Base", 3, 3, &base));
  return file;
}

void writeCube(const std::string& path, int type, bool isSingle, bool hasSteps = false)
{
  const int file = open(path, type);
  int family = 0;
  check(cg_family_write(file, 1, "top", &family));
  const Zone lower(file, 0, 1, isSingle), upper(file, 1, Nodes - 1, isSingle);
  lower.writeCells(false);
  upper.writeCells(true);
  lower.writeWall();
  upper.writeWall();
  upper.writeTop();
  if (hasSteps)
  {
    lower.writeSteps(0);
    upper.writeSteps(1);
  }
  check(cg_close(file));
}

void writeStructured(const std::string& path)
{
  const int file = open(path, CG_FILE_HDF5);
  const cgsize_t sizes[] = { 2, 2, 2, 1, 1, 1, 0, 0, 0 };
  int zone = 0;
  check(cg_zone_write(file, 1, "block", sizes, CGNS_ENUMV(Structured), &zone));
  check(cg_close(file));
}

/// A square in the plane, in one quadrilateral.
void writePlanar(const std::string& path)
{
  int file = 0, base = 0, zone = 0, id = 0;
  check(cg_set_file_type(CG_FILE_HDF5));
  check(cg_open(path.c_str(), CG_MODE_WRITE, &file));
  check(cg_base_write(file, "Plane", 2, 2, &base));
  const cgsize_t sizes[] = { 4, 1, 0 };
  check(cg_zone_write(file, base, "zone", sizes, CGNS_ENUMV(Unstructured), &zone));
  const double x[] = { 0, 1, 1, 0 }, y[] = { 0, 0, 1, 1 };
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateX", x, &id));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateY", y, &id));
  const cgsize_t corners[] = { 1, 2, 3, 4 };
  check(cg_section_write(file, base, zone, "faces", CGNS_ENUMV(QUAD_4), 1, 1, 0, corners, &id));
  check(cg_close(file));
}

/// One element of second order. `corners`: their positions; `between`: the corners in whose middle
/// each further node lies, in the order of CGNS.
void writeElement(const std::string& path, CGNS_ENUMT(ElementType_t) type,
  const std::vector<std::array<double, 3>>& corners, const std::vector<std::vector<int>>& between)
{
  std::vector<std::array<double, 3>> nodes = corners;
  for (const std::vector<int>& these : between)
  {
    std::array<double, 3> middle = { 0, 0, 0 };
    for (const int corner : these)
    {
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        middle[axis] +=
          corners[static_cast<std::size_t>(corner)][axis] / static_cast<double>(these.size());
      }
    }
    nodes.push_back(middle);
  }
  const int file = open(path, CG_FILE_HDF5);
  const auto count = static_cast<cgsize_t>(nodes.size());
  const cgsize_t sizes[] = { count, 1, 0 };
  int zone = 0, id = 0;
  check(cg_zone_write(file, 1, "zone", sizes, CGNS_ENUMV(Unstructured), &zone));
  const char* const names[] = { "CoordinateX", "CoordinateY", "CoordinateZ" };
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    std::vector<double> x;
    for (const auto& node : nodes)
    {
      x.push_back(node[axis]);
    }
    check(cg_coord_write(file, 1, zone, CGNS_ENUMV(RealDouble), names[axis], x.data(), &id));
  }
  std::vector<cgsize_t> list(nodes.size());
  std::iota(list.begin(), list.end(), cgsize_t(1));
  check(cg_section_write(file, 1, zone, "one", type, 1, 1, 0, list.data(), &id));
  check(cg_close(file));
}

/// The order of the nodes: SIDS, "Unstructured Grid Element Numbering Conventions".
void writeElements(const std::string& folder)
{
  const std::vector<std::array<double, 3>> box = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 },
    { 0, 2, 0 }, { 0, 0, 2 }, { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 } };
  std::vector<std::vector<int>> edges = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 },
    { 1, 5 }, { 2, 6 }, { 3, 7 }, { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 } };
  writeElement(folder + "/hexa_20.cgns", CGNS_ENUMV(HEXA_20), box, edges);
  for (const std::vector<int>& face :
    std::vector<std::vector<int>>{ { 0, 3, 2, 1 }, { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 },
      { 0, 4, 7, 3 }, { 4, 5, 6, 7 }, { 0, 1, 2, 3, 4, 5, 6, 7 } })
  {
    edges.push_back(face);
  }
  writeElement(folder + "/hexa_27.cgns", CGNS_ENUMV(HEXA_27), box, edges);
  writeElement(folder + "/penta_15.cgns", CGNS_ENUMV(PENTA_15),
    { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, { 0, 0, 2 }, { 2, 0, 2 }, { 0, 2, 2 } },
    { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 4 }, { 2, 5 }, { 3, 4 }, { 4, 5 }, { 5, 3 } });
}
}

void writeCgnsSamples(const std::string& folder)
{
  writeElements(folder);
  writeCube(folder + "/cube.cgns", CG_FILE_HDF5, false);
  writeCube(folder + "/cube_adf.cgns", CG_FILE_ADF, false);
  writeCube(folder + "/cube_single.cgns", CG_FILE_HDF5, true);
  writeCube(folder + "/steps.cgns", CG_FILE_HDF5, false, true);
  writeStructured(folder + "/structured.cgns");
  writePlanar(folder + "/planar.cgns");
}
