// SPDX-License-Identifier: BSD-3-Clause
// Twists the boundary of a mesh about the z axis, lets the inside follow by FEMWARP, and writes the
// result.
// Usage: twist-grid <in.vtu> <degrees per unit of z> <out.vtk>
#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>

#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::cerr << "Usage: twist-grid <in.vtu> <degrees per unit of z> <out.vtk>\n";
    return 2;
  }
  vtkNew<vtkXMLUnstructuredGridReader> grid;
  grid->SetFileName(argv[1]);
  vtkNew<vtkExtractMorphBoundary> boundary; // its points know which nodes they are
  boundary->SetInputConnection(grid->GetOutputPort());
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
  morph->SetInputConnection(grid->GetOutputPort());
  morph->SetBoundaryData(twisted);
  vtkNew<vtkUnstructuredGridWriter> result;
  result->SetInputConnection(morph->GetOutputPort());
  result->SetFileName(argv[3]);
  result->Write();
  std::cout << "minimum scaled Jacobian " << morph->GetMinScaledJacobian() << ", inverted cells "
            << morph->GetInvertedCells() << "\n";
  return std::string(morph->GetMorphStatus()) == "Valid" ? 0 : 1;
}
