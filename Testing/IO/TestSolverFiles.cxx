// SPDX-License-Identifier: BSD-3-Clause
// Reader and writer as VTK filters; Testing/Programs/solver_files.py tests the formats.
#include "Formats/SolverMesh.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkCallbackCommand.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArraySelection.h>
#include <vtkFEMWarpMorph.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSolverFileReader.h>
#include <vtkSolverFileWriter.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace
{
namespace fs = std::filesystem;

const char* const Deck = "*NODE, NSET=All\n"
                         "7, 0., 0., 0.\n3, 1., 0., 0.\n9, 0., 1., 0.\n4, 0., 0., 1.\n"
                         "5, 1., 1., 1.\n8, 9., 9., 9.\n" // of no element
                         "*ELEMENT, TYPE=C3D4, ELSET=Solid\n11, 7, 3, 9, 4\n12, 3, 5, 9, 4\n"
                         "*SURFACE, NAME=Bottom\n11, S1\n"
                         "*NSET, NSET=Corner\n5\n";

class SolverFiles : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    // Another run of the same test may be under way.
    this->Folder = fs::temp_directory_path() /
                   (std::string("morph-io-") + test->name() + "-" + std::to_string(getpid()));
    fs::create_directories(this->Folder);
    std::ofstream(this->Path("a.inp")) << Deck;
    this->Reader->SetFileName(this->Path("a.inp").c_str());
    this->Reader->Update();
  }
  void TearDown() override { fs::remove_all(this->Folder); }

  std::string Path(const char* name) const { return (this->Folder / name).string(); }
  std::string Content(const char* name) const
  {
    std::ifstream file(this->Path(name));
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
  }

  /// The error of writing a grid; nothing may be written then.
  std::string ErrorOf(vtkDataObject* grid, const char* original = "a.inp")
  {
    vtkNew<vtkSolverFileWriter> writer;
    std::string message;
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(&message);
    command->SetCallback([](vtkObject*, unsigned long, void* client, void* text)
      { *static_cast<std::string*>(client) += static_cast<const char*>(text); });
    writer->AddObserver(vtkCommand::ErrorEvent, command);
    writer->SetInputData(grid);
    writer->SetOriginalFileName(this->Path(original).c_str());
    writer->SetFileName(this->Path("b.inp").c_str());
    const int written = writer->Write();
    EXPECT_EQ(written, message.empty() ? 1 : 0);
    EXPECT_EQ(writer->GetLargestRounding(), message.empty() ? 0 : -1);
    EXPECT_EQ(writer->GetChangedCoordinates() >= 0, message.empty());
    EXPECT_EQ(fs::exists(this->Path("b.inp")), message.empty());
    return message;
  }

  fs::path Folder;
  vtkNew<vtkSolverFileReader> Reader;
};

TEST_F(SolverFiles, GridHasNumbersAndNames)
{
  vtkUnstructuredGrid* grid = this->Reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), 6);
  EXPECT_EQ(grid->GetNumberOfCells(), 3); // two tetrahedra and the face of Bottom
  EXPECT_EQ(grid->GetCellType(2), VTK_TRIANGLE);
  const vtkIdType numbers[] = { 7, 3, 9, 4, 5, 8 };
  for (vtkIdType i = 0; i < 6; ++i)
  {
    EXPECT_EQ(grid->GetPointData()->GetGlobalIds()->GetComponent(i, 0), numbers[i]);
  }
  EXPECT_EQ(vtkSolverFileReader::FormatOf(this->Path("a.inp").c_str()), "Abaqus or CalculiX");
  EXPECT_FALSE(vtkSolverFileReader::CanReadFile(this->Path("none.inp").c_str()));
}

TEST_F(SolverFiles, NamesAreSurfacesOfBoundaryDisplacement)
{
  vtkNew<vtkBoundaryDisplacement> displacement;
  displacement->SetInputConnection(this->Reader->GetOutputPort());
  displacement->SetMovingToSurfaces();
  displacement->AddSurface("Bottom");
  displacement->SetDisplacementToVector();
  displacement->SetVector(0, 0, -0.5);
  displacement->Update();
  EXPECT_EQ(displacement->GetMovingPoints(), 3);
  for (const char* name : { "All", "Solid", "Bottom", "Corner", "Surface 0" })
  {
    EXPECT_TRUE(displacement->GetSurfaceList()->ArrayExists(name)) << name;
  }
}

TEST_F(SolverFiles, MovedPointsAreWrittenAndNothingElse)
{
  vtkNew<vtkUnstructuredGrid> grid;
  grid->DeepCopy(this->Reader->GetOutput());
  EXPECT_EQ(this->ErrorOf(grid), "");
  EXPECT_EQ(this->Content("b.inp"), Deck);
  fs::remove(this->Path("b.inp"));
  grid->GetPoints()->SetPoint(1, 1.25, 0, -0.5);
  EXPECT_EQ(this->ErrorOf(grid), "");
  std::string expected = Deck;
  expected.replace(expected.find("3, 1., 0., 0."), 13, "3, 1.25, 0., -0.5");
  EXPECT_EQ(this->Content("b.inp"), expected);
}

TEST_F(SolverFiles, PointsMayComeInAnotherOrder)
{
  vtkUnstructuredGrid* grid = this->Reader->GetOutput();
  vtkNew<vtkPolyData> moved;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName("NodeNumber");
  for (vtkIdType i = 6; i-- > 0;)
  {
    points->InsertNextPoint(grid->GetPoint(i));
    numbers->InsertNextValue(
      static_cast<vtkIdType>(grid->GetPointData()->GetGlobalIds()->GetComponent(i, 0)));
  }
  moved->SetPoints(points);
  moved->GetPointData()->AddArray(numbers);
  EXPECT_EQ(this->ErrorOf(moved), "");
  EXPECT_EQ(this->Content("b.inp"), Deck);
}

TEST_F(SolverFiles, WrongGridsAreRefused)
{
  const auto expectError = [&](vtkPointSet* grid, const char* part)
  {
    const std::string message = this->ErrorOf(grid);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  vtkNew<vtkUnstructuredGrid> grid;
  const auto reset = [&] { grid->DeepCopy(this->Reader->GetOutput()); };
  reset();
  grid->GetPoints()->SetPoint(2, 0, std::nan(""), 0);
  expectError(grid, "not finite (NaN or infinite) at the nodes 9");
  reset();
  grid->GetPointData()->GetGlobalIds()->SetComponent(0, 0, 3);
  expectError(grid, "has them twice: 3");
  reset();
  grid->GetPointData()->GetGlobalIds()->SetComponent(0, 0, 77);
  expectError(grid, "that the file lacks, or has them twice: 77");
  reset();
  grid->GetPointData()->Initialize();
  expectError(grid, "no node numbers");
  std::ofstream(this->Path("a.inp")) << Deck << "*NODE\n20, 1., 2., 3.\n";
  reset();
  expectError(grid, "the file has 7 nodes, and the mesh 6");
  std::ofstream(this->Path("a.inp")) << "*PART\n" << Deck;
  expectError(grid, "no *INSTANCE has a *NODE");
  fs::remove(this->Path("a.inp"));
  expectError(grid, "there is no such file");
}

/// Name and grid of each block.
std::map<std::string, vtkUnstructuredGrid*> blocksOf(vtkDataObject* data)
{
  std::map<std::string, vtkUnstructuredGrid*> result;
  auto* blocks = vtkPartitionedDataSetCollection::SafeDownCast(data);
  for (unsigned int i = 0; blocks && i < blocks->GetNumberOfPartitionedDataSets(); ++i)
  {
    result[blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME())] =
      vtkUnstructuredGrid::SafeDownCast(blocks->GetPartition(i, 0));
  }
  return result;
}

TEST_F(SolverFiles, SetsAsBlocks)
{
  this->Reader->SetsAsBlocksOn();
  this->Reader->Update();
  EXPECT_EQ(this->Reader->GetOutput(), nullptr);
  const auto blocks = blocksOf(this->Reader->GetOutputDataObject(0));
  // Points, cells and the type of the first cell.
  const std::map<std::string, std::array<vtkIdType, 3>> expected = { { "Mesh",
                                                                       { 6, 2, VTK_TETRA } },
    { "All", { 6, 6, VTK_VERTEX } }, { "Solid", { 5, 2, VTK_TETRA } },
    { "Bottom", { 3, 1, VTK_TRIANGLE } }, { "Corner", { 1, 1, VTK_VERTEX } } };
  ASSERT_EQ(blocks.size(), expected.size());
  for (const auto& [name, size] : expected)
  {
    SCOPED_TRACE(name);
    ASSERT_EQ(blocks.count(name), 1U);
    vtkUnstructuredGrid* block = blocks.at(name);
    EXPECT_EQ(block->GetNumberOfPoints(), size[0]);
    EXPECT_EQ(block->GetNumberOfCells(), size[1]);
    EXPECT_EQ(block->GetCellType(0), size[2]);
    vtkDataArray* numbers = block->GetPointData()->GetGlobalIds();
    vtkUnstructuredGrid* mesh = blocks.at("Mesh");
    for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
    {
      const vtkIdType place =
        mesh->GetPointData()->GetGlobalIds()->LookupValue(numbers->GetComponent(i, 0));
      ASSERT_GE(place, 0);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_EQ(block->GetPoint(i)[k], mesh->GetPoint(place)[k]);
      }
    }
  }
  this->Reader->SetsAsBlocksOff();
  this->Reader->Update();
  EXPECT_EQ(this->Reader->GetOutput()->GetNumberOfCells(), 3);
}

TEST(PartOfSolverMesh, KeepsPolyhedraAndSets)
{
  morph::io::SolverMesh mesh;
  for (const morph::Index number : { 10, 11, 12, 13, 14 })
  {
    mesh.addNode(number, 0.5 * number, 0, 0);
  }
  mesh.addCell(VTK_TRIANGLE, { 0, 1, 2 }, -1);
  mesh.addPolyhedron({ { 1, 3, 2 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 1, 4 } }, 7);
  mesh.addCell(VTK_TETRA, { 0, 1, 2, 3 }, 8);
  mesh.set("wall").cells = { 0 };
  mesh.set("core").cells = { 1, 2 };
  mesh.set("core").nodes = { 0, 4 };

  const morph::io::SolverMesh part = morph::io::partOf(mesh, { 1, 2, 3, 4 }, { 1 });
  EXPECT_EQ(part.nodeNumbers, (std::vector<morph::Index>{ 11, 12, 13, 14 }));
  EXPECT_EQ(part.coordinates[3], 6);
  EXPECT_EQ(part.cellNumbers, std::vector<morph::Index>{ 7 });
  EXPECT_EQ(part.connectivity, (std::vector<morph::Index>{ 0, 1, 2, 3 }));
  EXPECT_EQ(
    part.faces, (std::vector<morph::Index>{ 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3 }));
  EXPECT_EQ(part.faceOffsets, (std::vector<morph::Index>{ 0, 16 }));
  ASSERT_EQ(part.sets.size(), 2U);
  EXPECT_TRUE(part.sets[0].cells.empty());
  EXPECT_EQ(part.sets[1].cells, std::vector<morph::Index>{ 0 });
  EXPECT_EQ(part.sets[1].nodes, std::vector<morph::Index>{ 3 });
}

TEST_F(SolverFiles, BlocksMoveByNameAndAreWrittenAsTheGridIs)
{
  std::string written[2];
  for (const bool asBlocks : { false, true })
  {
    this->Reader->SetSetsAsBlocks(asBlocks);
    vtkNew<vtkBoundaryDisplacement> displacement;
    displacement->SetInputConnection(this->Reader->GetOutputPort());
    displacement->SetMovingToSurfaces();
    displacement->AddSurface("Bottom");
    displacement->SetDisplacementToVector();
    displacement->SetVector(0, 0, -0.5);
    vtkNew<vtkFEMWarpMorph> morph;
    morph->SetInputConnection(this->Reader->GetOutputPort());
    morph->SetBoundaryConnection(displacement->GetOutputPort());
    morph->Update();
    EXPECT_EQ(displacement->GetMovingPoints(), 3);
    for (const char* name : { "All", "Solid", "Bottom", "Corner" })
    {
      EXPECT_TRUE(displacement->GetSurfaceList()->ArrayExists(name)) << name;
    }
    vtkDataObject* moved = morph->GetOutputDataObject(0);
    if (asBlocks)
    {
      EXPECT_EQ(blocksOf(moved).at("Bottom")->GetPoint(0)[2], -0.5);
    }
    EXPECT_EQ(this->ErrorOf(moved), "");
    written[asBlocks] = this->Content("b.inp");
    fs::remove(this->Path("b.inp"));
  }
  EXPECT_NE(written[0], Deck);
  EXPECT_EQ(written[0], written[1]);
}

TEST_F(SolverFiles, BlocksThatDisagreeAreRefused)
{
  this->Reader->SetsAsBlocksOn();
  this->Reader->Update();
  vtkDataObject* data = this->Reader->GetOutputDataObject(0);
  blocksOf(data).at("Corner")->GetPoints()->SetPoint(0, 1, 1, 2);
  EXPECT_NE(
    this->ErrorOf(data).find("different coordinates for the same nodes: 5."), std::string::npos);
  EXPECT_EQ(this->ErrorOf(blocksOf(data).at("Mesh")), "");
}

TEST_F(SolverFiles, NodesOfNoElementStay)
{
  vtkNew<vtkBoundaryDisplacement> displacement;
  displacement->SetInputConnection(this->Reader->GetOutputPort());
  displacement->SetMovingToEverything();
  displacement->SetDisplacementToVector();
  displacement->SetVector(0.5, 0, 0);
  vtkNew<vtkFEMWarpMorph> morph;
  morph->SetInputConnection(this->Reader->GetOutputPort());
  morph->SetBoundaryConnection(displacement->GetOutputPort());
  morph->Update();
  EXPECT_EQ(this->ErrorOf(morph->GetOutput()), "");
  const std::string content = this->Content("b.inp");
  EXPECT_NE(content.find("8, 9., 9., 9.\n"), std::string::npos) << content;
  EXPECT_NE(content.find("7, 0.5, 0., 0.\n"), std::string::npos) << content;
}
}
