// SPDX-License-Identifier: BSD-3-Clause
// TwistGrid on MPI ranks: each has some pieces of the mesh, and the filters do the rest.
// Usage: mpiexec -n 2 morph-on-ranks <in.pvtu> <degrees per unit of z> <out.pvtu>
#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>

#include <vtkMPIController.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPUnstructuredGridWriter.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

namespace
{
int twist(vtkMPIController* controller, char* argv[])
{
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  vtkNew<vtkXMLPUnstructuredGridReader> grid;
  grid->SetFileName(argv[1]);
  grid->UpdateInformation();
  grid->UpdatePiece(rank, ranks, 0);
  vtkNew<vtkExtractMorphBoundary> boundary; // without the cuts between pieces
  boundary->SetInputData(grid->GetOutput());
  boundary->Update();

  vtkNew<vtkPolyData> twisted;
  twisted->DeepCopy(boundary->GetOutput());
  const double rate = vtkMath::RadiansFromDegrees(std::atof(argv[2]));
  for (vtkIdType i = 0; i < twisted->GetNumberOfPoints(); ++i)
  {
    double x[3];
    twisted->GetPoint(i, x);
    const double c = std::cos(rate * x[2]), s = std::sin(rate * x[2]);
    twisted->GetPoints()->SetPoint(i, c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]);
  }

  vtkNew<vtkFEMWarpMorph> morph;
  morph->SetInputData(grid->GetOutput());
  morph->SetBoundaryData(twisted);
  morph->Update();
  vtkNew<vtkXMLPUnstructuredGridWriter> result;
  result->SetController(controller);
  result->SetInputConnection(morph->GetOutputPort());
  result->SetFileName(argv[3]);
  result->SetNumberOfPieces(ranks);
  result->SetStartPiece(rank);
  result->SetEndPiece(rank);
  result->Write();
  if (rank == 0) // the numbers of the whole mesh are the same on each rank
  {
    std::cout << "minimum scaled Jacobian " << morph->GetMinScaledJacobian() << ", inverted cells "
              << morph->GetInvertedCells() << "\n";
  }
  return std::string(morph->GetMorphStatus()) == "Valid" ? 0 : 1;
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller); // the filters ask it for the ranks
  int status = 2;
  if (argc == 4)
  {
    status = twist(controller, argv);
  }
  else
  {
    std::cerr << "Usage: mpiexec -n 2 morph-on-ranks <in.pvtu> <degrees per unit of z> "
                 "<out.pvtu>\n";
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return status;
}
