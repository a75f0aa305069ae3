// SPDX-License-Identifier: BSD-3-Clause
// Damaged files of the formats that are read here without a library: each is a mesh in range, or
// one Error. MORPH_TEST_SEED sets another seed, MORPH_TEST_CASES the number of cases a format.
#include "Files/ReadFile.h"
#include "Formats/FoamList.h"
#include "Formats/SolverFile.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>

namespace
{
namespace fs = std::filesystem;
using morph::Index;

/// A number from the environment.
int setting(const char* name, int otherwise)
{
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

template <typename Value>
void append(std::string& to, std::initializer_list<Value> values)
{
  for (const Value value : values)
  {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

const char* const Abaqus =
  "*HEADING\nA tetrahedron\n*NODE, NSET=All\n"
  "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n5, 1., 1., 1.\n"
  "*ELEMENT, TYPE=C3D4, ELSET=Solid\n1, 1, 2, 3, 4\n2, 2, 5, 3, 4\n"
  "*ELEMENT, TYPE=CPS3, ELSET=Wall\n3, 1, 2, 3\n"
  "*NSET, NSET=Some, GENERATE\n1, 3, 2\n*ELSET, ELSET=Both\nSolid, 2\n"
  "*SURFACE, NAME=Bottom\nSolid, S1\n*STEP\n*END STEP\n";
const char* const Assembly =
  "*PART, NAME=P\n*SYSTEM\n1., 0., 0., 1., 1., 0.\n0., 0., 0.\n*NODE, SYSTEM=C\n"
  "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 90., 0.\n4, 0., 0., 1.\n"
  "*ELEMENT, TYPE=C3D4, ELSET=Solid\n1, 1, 2, 3, 4\n*NSET, NSET=Some\n1, 2\n*END PART\n"
  "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1., 2., 3.\n0., 0., 0., 0., 0., 1., 30.\n"
  "*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n1., 2., 9.\n0., 0., 0., 0., 0., 1., 30.\n*END "
  "INSTANCE\n*NODE\n1, 5., 5., 5.\n"
  "*NSET, NSET=Lid, INSTANCE=J, GENERATE\n1, 3, 1\n*NSET, NSET=All\nI.1, J.Some\n"
  "*ELSET, ELSET=S, INSTANCE=I\n1\n*SURFACE, NAME=W\nS, S1\n*END ASSEMBLY\n";
const char* const Nastran =
  "SOL 101\nCEND\nBEGIN BULK\n"
  "GRID    1               0.0     0.0     0.0\n"
  "GRID*                  2                              1.              0.\n"
  "*                     0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.0+0\n"
  "CTETRA  1       7       1       2       3       4\nCTRIA3,2,8,1,2,3\n"
  "CTETRA,3,9,1,2,3,4,,,,,,\nGRDSET,,0\nCORD1C,5,1,4,2\nGRID,9,5,1.,30.,2.\nGRID,10,6,1.,2.,3.\n"
  "CORD2S,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
  "ENDDATA\n";
const char* const Ansys =
  "/PREP7\nET,1,185\nET,2,SHELL181\nNBLOCK,6,SOLID,4,4\n(3i8,6e16.9e3)\n"
  "       1       0       0\n       2       0       0 1.000000000E+000\n"
  "       3       0       0                 1.000000000E+000\n"
  "       4       0       0                                 1.000000000E+000\n"
  "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,2,2\n(19i4)\n"
  "   1   1   1   1   0   0   0   0   8   0   1   1   2   3   3   4   4   4   4\n"
  "   2   2   1   1   0   0   0   0   4   0   2   1   2   3   3\n  -1\n"
  "CMBLOCK,SOME,NODE,3\n(8i10)\n         1        -3         4\nFINISH\n";
const char* const Unblocked =
  "/PREP7\nET,1,185\nET,2,SHELL181\nN,R5.3,LOC,       1,       0,       0, 0.0, 0.0, 0.0\n"
  "N,UNBL,LOC,2,,,1.\nN,R5.3,ANG,2,0,0,30.\nN,3,0.,1. ! typed\nN,4,,,1\nN,R5.3,LOC,-1,\n"
  "EN,R5.5,ATTR,8,1,1,1,1,0,7,0,0,0\nEN,R5.5,NODE,1,2,3,3,4,4,4,4,\nTYPE,2\nMAT,3\nCSYS,0\n"
  "EN,8,1,2,3\nEMORE,3\nEN,R5.5,ATTR,-1\nCMBLOCK,SOME,NODE,1\n(8i10)\n         1\nFINISH\n";
const char* const LsDyna =
  "$ a deck\n*KEYWORD\n*NODE\n       1             0.0             0.0             0.0\n"
  "2,1.,0.,0.\n3,0.,1.,0.\n4,0.,0.,1.\n*ELEMENT_SOLID\n1,7,1,2,3,4,4,4,4,4\n2,7\n1,2,3,4\n"
  "*ELEMENT_SHELL_THICKNESS\n       1       8       1       2       3       3\n0.1,0.1\n*PART\n"
  "A part\n8,1,1\n*SET_NODE_LIST_TITLE\nSome\n1,0.,0.\n1,2,3\n*SET_SEGMENT\n2\n1,2,3,3\n"
  "*SET_PART_LIST\n3\n7,8\n*SET_SHELL\n4\n1\n*ELEMENT_BEAM_PID\n3,9,1,2,3\n0,0\n"
  "*SET_NODE_LIST_GENERATE\n5\n1,3\n*SET_BEAM_GENERATE\n6\n1,9\n*SET_NODE_GENERAL\n*END\n";
const char* const Su2 = "NDIME= 3\nNELEM= 1\n10 0 1 2 3 0\nNPOIN= 4\n0 0 0 0\n1. 0 0 1\n0 1 0 2\n"
                        "0 0 1e0 3\nNMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 1 2\n";
const char* const Gmsh2 =
  "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"wall\"\n3 2 \"body\"\n"
  "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n2\n"
  "1 2 2 1 1 1 2 3\n2 4 2 2 1 1 2 3 4\n$EndElements\n";
const char* const Gmsh4 =
  "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"wall\"\n$EndPhysicalNames\n"
  "$Entities\n0 0 1 1\n1 0 0 0 1 1 1 1 1 0\n1 0 0 0 1 1 1 0 1 1\n$EndEntities\n$Nodes\n1 4 1 4\n"
  "3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n2 2 1 2\n2 1 2 1\n"
  "1 1 2 3\n3 1 4 1\n2 1 2 3 4\n$EndElements\n";

const char* const Parametric =
  "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n"
  "3 0 1 0 2 1 0.5 0.25\n4 0 0 1 3 1\n$EndParametricNodes\n$Elements\n1\n1 4 2 2 1 1 2 3 4\n"
  "$EndElements\n";
const char* const Partitioned =
  "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 7 0\n$EndEntities\n"
  "$PartitionedEntities\n2\n1\n9 1\n0 0 1 2\n5 3 1 2 1 2 0 0 0 1 1 1 1 7 0\n"
  "2 3 1 1 1 0 0 0 1 1 1 1 7 0\n3 3 1 1 2 0 0 0 1 1 1 1 7 1 5\n$EndPartitionedEntities\n$Nodes\n"
  "1 5 1 5\n3 2 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n$Elements\n"
  "3 3 1 3\n2 5 2 1\n1 2 3 4\n3 2 4 1\n2 1 2 3 4\n3 3 4 1\n3 2 3 4 5\n$EndElements\n";

std::string binaryGmsh(bool isVersion4)
{
  std::string text = isVersion4 ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n2.2 1 8\n";
  append<std::int32_t>(text, { 1 });
  text += "\n$EndMeshFormat\n$Nodes\n";
  if (isVersion4)
  {
    append<std::int64_t>(text, { 1, 4, 1, 4 });
    append<std::int32_t>(text, { 3, 1, 0 });
    append<std::int64_t>(text, { 4, 1, 2, 3, 4 });
    append<double>(text, { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 });
    text += "\n$EndNodes\n$Elements\n";
    append<std::int64_t>(text, { 1, 1, 1, 1 });
    append<std::int32_t>(text, { 3, 1, 4 });
    append<std::int64_t>(text, { 1, 1, 1, 2, 3, 4 });
    return text + "\n$EndElements\n";
  }
  text += "4\n";
  for (const std::int32_t node : { 1, 2, 3, 4 })
  {
    append<std::int32_t>(text, { node });
    append<double>(text, { node == 2 ? 1. : 0., node == 3 ? 1. : 0., node == 4 ? 1. : 0. });
  }
  text += "\n$EndNodes\n$Elements\n1\n";
  append<std::int32_t>(text, { 4, 1, 2, 1, 5, 5, 1, 2, 3, 4 });
  return text + "\n$EndElements\n";
}

/// Cut, or with bytes that are changed, removed, doubled or moved.
std::string broken(const std::string& whole, std::mt19937& engine)
{
  const auto below = [&](std::size_t most)
  { return std::uniform_int_distribution<std::size_t>(0, most - 1)(engine); };
  std::string text = whole;
  for (std::size_t i = 1 + below(3); i > 0 && !text.empty(); --i)
  {
    const std::size_t at = below(text.size()),
                      length = 1 + below(std::min<std::size_t>(40, text.size()));
    static const char* const Words[] = { "-1", "0", "1e999", "99999999999", "nan", ",", "\n", " ",
      "4294967295", "-9223372036854775808", "*", "$", "'", "\"", "." };
    switch (below(7))
    {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(below(text.size()), text.substr(at, length));
        break;
      case 4:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 5:
        text.replace(
          at, std::min<std::size_t>(1, text.size() - at), Words[below(std::size(Words))]);
        break;
      default:
        text.insert(at, Words[below(std::size(Words))]);
    }
  }
  return text;
}

void expectInRange(const morph::io::SolverMesh& mesh)
{
  ASSERT_EQ(mesh.coordinates.size(), 3 * mesh.nodeNumbers.size());
  ASSERT_EQ(mesh.offsets.size(), mesh.cellTypes.size() + 1);
  ASSERT_EQ(mesh.cellNumbers.size(), mesh.cellTypes.size());
  ASSERT_EQ(mesh.offsets.back(), static_cast<Index>(mesh.connectivity.size()));
  ASSERT_TRUE(std::is_sorted(mesh.offsets.begin(), mesh.offsets.end()));
  const auto isNode = [&](Index node) { return node >= 0 && node < mesh.nodes(); };
  const auto isCell = [&](Index cell) { return cell >= 0 && cell < mesh.cells(); };
  ASSERT_TRUE(std::all_of(mesh.connectivity.begin(), mesh.connectivity.end(), isNode));
  ASSERT_TRUE(std::all_of(
    mesh.coordinates.begin(), mesh.coordinates.end(), [](double x) { return std::isfinite(x); }));
  for (const morph::io::NamedSet& set : mesh.sets)
  {
    ASSERT_TRUE(std::all_of(set.nodes.begin(), set.nodes.end(), isNode)) << set.name;
    ASSERT_TRUE(std::all_of(set.cells.begin(), set.cells.end(), isCell)) << set.name;
  }
}

class BrokenSolverFiles : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    this->Folder = fs::temp_directory_path() /
                   (std::string("morph-broken-") + test->name() + std::to_string(getpid()));
    fs::create_directories(this->Folder);
  }
  void TearDown() override { fs::remove_all(this->Folder); }

  void Write(const fs::path& path, const std::string& content) const
  {
    std::ofstream(path, std::ios::binary) << content;
  }

  /// Reads the mesh at `path`, and asks for a copy of it. `whole`: it must be read.
  bool Try(const fs::path& path, bool whole = false)
  {
    try
    {
      const auto file = morph::io::readSolverFile(path.string());
      expectInRange(file->mesh());
      double rounding = 0;
      std::vector<double> coordinates = file->mesh().coordinates;
      for (const auto& copy : file->withCoordinates(
             coordinates, (path.parent_path() / "copy" / path.filename()).string(), rounding))
      {
        if (fs::path(copy.path).filename() == path.filename())
        {
          EXPECT_EQ(copy.content, morph::io::readFile(path.string()));
        }
      }
      for (double& x : coordinates)
      {
        x += 0.375;
      }
      file->withCoordinates(coordinates, path.string(), rounding);
      return true;
    }
    catch (const morph::Error& error)
    {
      EXPECT_FALSE(std::string(error.what()).empty());
      EXPECT_FALSE(whole) << error.what();
    }
    return false;
  }

  /// Breaks `broken` many times, and reads the mesh at `path`.
  void Break(const fs::path& brokenFile, const fs::path& path, const std::string& what)
  {
    const int cases = setting("MORPH_TEST_CASES", 2000), seed = setting("MORPH_TEST_SEED", 1);
    const std::string whole = morph::io::readFile(brokenFile.string());
    int read = 0;
    ASSERT_TRUE(this->Try(path, true)) << what;
    for (int i = 0; i < cases && !this->HasFailure(); ++i)
    {
      std::mt19937 engine(static_cast<std::mt19937::result_type>(seed + 1000003 * i));
      this->Write(brokenFile, broken(whole, engine));
      SCOPED_TRACE(what + ", seed " + std::to_string(seed) + ", case " + std::to_string(i));
      read += this->Try(path);
    }
    this->Write(brokenFile, whole);
    std::cout << what << ": seed " << seed << ", " << cases << " cases, " << read << " read\n";
    EXPECT_LT(read, cases);
  }

  fs::path Folder;
};

TEST_F(BrokenSolverFiles, OneFile)
{
  const std::pair<const char*, std::string> samples[] = { { "a.inp", Abaqus },
    { "b.inp", Assembly }, { "a.bdf", Nastran }, { "a.k", LsDyna }, { "a.cdb", Ansys },
    { "b.cdb", Unblocked }, { "p2.msh", Parametric }, { "p4.msh", Partitioned }, { "a.su2", Su2 },
    { "a2.msh", Gmsh2 }, { "a4.msh", Gmsh4 }, { "b2.msh", binaryGmsh(false) },
    { "b4.msh", binaryGmsh(true) } };
  for (const auto& [name, content] : samples)
  {
    this->Write(this->Folder / name, content);
    this->Break(this->Folder / name, this->Folder / name, name);
  }
}

TEST_F(BrokenSolverFiles, OpenFoam)
{
  const auto header = [](const char* type)
  { return "FoamFile\n{\n version 2.0;\n format ascii;\n class " + std::string(type) + ";\n}\n"; };
  const fs::path mesh = this->Folder / "case" / "constant" / "polyMesh";
  fs::create_directories(mesh);
  this->Write(mesh / "points", header("vectorField") + "4\n((0 0 0)\n(1 0 0)\n(0 1 0)\n(0 0 1))\n");
  this->Write(mesh / "faces", header("faceList") + "4\n(3(0 2 1)\n3(0 1 3)\n3(1 2 3)\n3(2 0 3))\n");
  this->Write(mesh / "owner", header("labelList") + "4\n(0 0 0 0)\n");
  this->Write(mesh / "neighbour", header("labelList") + "0\n()\n");
  this->Write(mesh / "boundary",
    header("polyBoundaryMesh") + "1\n(\nwall\n{\n type wall;\n nFaces 4;\n startFace 0;\n}\n)\n");
  for (const char* name : { "points", "faces", "owner", "neighbour", "boundary" })
  {
    this->Break(mesh / name, mesh / "points", name);
  }
}

TEST_F(BrokenSolverFiles, CollatedFilesOfOpenFoam)
{
  const auto header = [](const std::string& type)
  { return "FoamFile\n{\n version 2.0;\n format ascii;\n class " + type + ";\n}\n"; };
  const fs::path mesh = this->Folder / "case" / "processors2" / "constant" / "polyMesh";
  fs::create_directories(mesh);
  // Two tetrahedra with a face in common.
  const auto write = [&](const char* name, const char* type, std::string first, std::string second)
  {
    first = header(type) + first;
    std::string content = header("decomposedBlockData");
    for (const auto& [number, block] : { std::pair("0", first), std::pair("1", second) })
    {
      content += std::string("\n// Processor") + number + "\n\n" + std::to_string(block.size()) +
                 "\n(" + block + ")\n";
    }
    this->Write(mesh / name, content);
  };
  const auto patches = [](const std::string& other)
  {
    return "2\n(\nwall\n{\n type wall;\n nFaces 3;\n startFace 0;\n}\nprocBoundary" + other +
           "\n{\n type processor;\n nFaces 1;\n startFace 3;\n}\n)\n";
  };
  write("points", "vectorField", "4\n((0 0 0)\n(1 0 0)\n(0 1 0)\n(0 0 1))\n",
    "4\n((1 0 0)\n(0 1 0)\n(0 0 1)\n(1 1 1))\n");
  write("faces", "faceList", "4\n(3(0 2 1)\n3(0 1 3)\n3(2 0 3)\n3(1 2 3))\n",
    "4\n(3(0 1 3)\n3(1 2 3)\n3(2 0 3)\n3(0 2 1))\n");
  write("owner", "labelList", "4\n(0 0 0 0)\n", "4\n(0 0 0 0)\n");
  write("neighbour", "labelList", "0\n()\n", "0\n()\n");
  write("boundary", "polyBoundaryMesh", patches("0to1"), patches("1to0"));
  write("pointProcAddressing", "labelList", "4\n(0 1 2 3)\n", "4\n(1 2 3 4)\n");
  const fs::path path = this->Folder / "case";
  fs::create_directories(this->Folder / "copy");
  fs::copy(path, this->Folder / "copy" / "case", fs::copy_options::recursive);
  EXPECT_EQ(morph::io::readSolverFile(path.string())->mesh().nodes(), 5);
  for (const char* name :
    { "points", "faces", "owner", "neighbour", "boundary", "pointProcAddressing" })
  {
    this->Break(mesh / name, path, name);
  }
}

TEST_F(BrokenSolverFiles, PointDisplacementOfOpenFoam)
{
  const std::string whole =
    "FoamFile { version 2.0; format ascii; class pointVectorField; }\n"
    "dimensions [0 1 0 0 0 0 0];\ninternalField uniform (0 0 0);\nboundaryField\n{\n"
    "\"(in|out)let\" { type fixedValue; value nonuniform List<vector> 2((0 0 1) (1 0 0)); }\n"
    "wall { type fixedValue; value uniform (0 0 0.5); list (1 (2)); a { b c; } }\n"
    "rest { type slip; }\n}\n";
  const std::string path = (this->Folder / "pointDisplacement").string();
  this->Write(path, whole);
  const auto field = morph::io::FoamList(path).boundaryField();
  ASSERT_EQ(field.size(), 3U);
  EXPECT_TRUE(field[0].isPattern && !field[0].isUniform);
  EXPECT_EQ(field[0].values, (std::vector<double>{ 0, 0, 1, 1, 0, 0 }));
  EXPECT_EQ(field[1].values, (std::vector<double>{ 0, 0, 0.5 }));
  EXPECT_EQ(field[2].type, "slip");
  for (int i = 0; i < setting("MORPH_TEST_CASES", 2000); ++i)
  {
    std::mt19937 engine(static_cast<std::mt19937::result_type>(1 + i));
    this->Write(path, broken(whole, engine));
    try
    {
      for (const auto& patch : morph::io::FoamList(path).boundaryField())
      {
        EXPECT_EQ(patch.values.size() % 3, 0U);
      }
    }
    catch (const morph::Error& error)
    {
      EXPECT_FALSE(std::string(error.what()).empty());
    }
  }
}
}
