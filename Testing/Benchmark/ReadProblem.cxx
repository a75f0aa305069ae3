// SPDX-License-Identifier: BSD-3-Clause
#include "ReadProblem.h"

#include "Mesh/Extent.h"
#include "Mesh/Topology.h"
#include "Private/Data/GridMesh.h"

#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <stdexcept>

namespace benchmark
{
namespace
{
constexpr const char* Motion = "FinalDisplacement";
}

Problem readProblem(const std::string& file)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  if (!reader->CanReadFile(file.c_str()))
  {
    throw std::runtime_error("There is no mesh " + file + ", or it is not a .vtu file.");
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  vtkDataArray* motion = grid->GetPointData()->GetArray(Motion);
  if (!motion || motion->GetNumberOfComponents() != 3)
  {
    throw std::runtime_error(
      file + " has no point vectors " + Motion + ": Data/generate.py writes them.");
  }

  Problem problem;
  problem.name = file.substr(file.find_last_of('/') + 1);
  problem.mesh = morph::filters::GridMesh::FromGrid(grid);
  morph::Monitor monitor;
  problem.partition =
    morph::partitionNodes(problem.mesh, morph::boundaryFaces(problem.mesh, monitor).nodes);
  problem.size = morph::meshSize(problem.mesh);
  const morph::Points moved = problem.mesh.points + morph::filters::GridMesh::FromVectors(motion);
  const std::vector<morph::Index>& prescribed = problem.partition.prescribed;
  problem.target.resize(static_cast<morph::Index>(prescribed.size()), 3);
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    problem.target.row(static_cast<morph::Index>(i)) = moved.row(prescribed[i]);
  }
  return problem;
}
}
