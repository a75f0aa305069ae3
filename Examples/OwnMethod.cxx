// SPDX-License-Identifier: BSD-3-Clause
// A morphing method of one's own: a free node follows all prescribed nodes, each weighted by its
// inverse distance to the third power. Morphs a mesh with it so that it fits a boundary, which is
// Extract Morph Boundary's with its points moved.
// Usage: own-method <in.vtu> <boundary.vtp> <out.vtu>
#include <MeshMorphing/Morpher/Morpher.h>
#include <vtkMorphAlgorithm.h>

#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <iostream>
#include <memory>
#include <string>

/// u(x) = sum of w_k U_k / sum of w_k, with w_k = |x - x_k|^-3. It is linear in the displacements
/// U_k of the prescribed nodes x_k, so that it has an adjoint. Source: D. Shepard, "A
/// two-dimensional interpolation function for irregularly-spaced data", ACM (1968) 517-524.
class InverseDistance : public morph::LinearMorpher
{
protected:
  /// What depends on the undeformed mesh alone: here only where the nodes are.
  void doPrepare(const morph::Mesh&, morph::Monitor&) override
  {
    this->From = this->restPoints()(this->partition().prescribed, morph::allColumns);
    this->To = this->restPoints()(this->partition().free, morph::allColumns);
  }

  /// The rows of `prescribed` and `free` are displacements, in the order of the partition.
  morph::EvaluateReport displace(
    const morph::Points& prescribed, morph::Points& free, morph::Monitor& monitor) const override
  {
    monitor.parallelFor(free.rows(), 64,
      [&](morph::Index first, morph::Index last)
      {
        for (morph::Index i = first; i < last; ++i)
        {
          free.row(i) = this->Weights(i).transpose() * prescribed;
        }
      });
    return {};
  }

  /// The same weights the other way, added to `prescribed`.
  morph::EvaluateReport displaceTranspose(
    const morph::Points& free, morph::Points& prescribed, morph::Monitor& monitor) const override
  {
    for (morph::Index i = 0; i < free.rows(); ++i)
    {
      monitor.check(); // throws where the user has cancelled
      prescribed += this->Weights(i) * free.row(i);
    }
    return {};
  }

private:
  Eigen::VectorXd Weights(morph::Index i) const
  {
    const Eigen::ArrayXd squares = (this->From.rowwise() - this->To.row(i)).rowwise().squaredNorm();
    const Eigen::ArrayXd weights = squares.max(1e-30).pow(-1.5);
    return weights / weights.sum();
  }

  morph::Points From, To;
};

/// The method as a filter: inputs, steps, quality, validity and the adjoint are the superclass's.
class InverseDistanceMorph : public vtkMorphAlgorithm
{
public:
  static InverseDistanceMorph* New();
  vtkTypeMacro(InverseDistanceMorph, vtkMorphAlgorithm);

protected:
  std::unique_ptr<morph::Morpher> CreateMorpher() override
  {
    return std::make_unique<InverseDistance>();
  }
};
vtkStandardNewMacro(InverseDistanceMorph);

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::cerr << "Usage: own-method <in.vtu> <boundary.vtp> <out.vtu>\n";
    return 2;
  }
  vtkNew<vtkXMLUnstructuredGridReader> grid;
  grid->SetFileName(argv[1]);
  vtkNew<vtkXMLPolyDataReader> boundary;
  boundary->SetFileName(argv[2]);
  vtkNew<InverseDistanceMorph> morph;
  morph->SetInputConnection(grid->GetOutputPort());
  morph->SetBoundaryConnection(boundary->GetOutputPort());
  vtkNew<vtkXMLUnstructuredGridWriter> result;
  result->SetInputConnection(morph->GetOutputPort());
  result->SetFileName(argv[3]);
  result->SetDataModeToBinary(); // Debian's ParaView reads no appended data
  result->Write();
  std::cout << "own method " << morph->GetMinScaledJacobian() << "\n";
  return std::string(morph->GetMorphStatus()) == "Valid" ? 0 : 1;
}
