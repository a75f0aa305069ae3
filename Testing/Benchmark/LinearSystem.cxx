// SPDX-License-Identifier: BSD-3-Clause
// Writes FEMWARP's linear system for a mesh whose boundary is twisted, and our solution, in PETSc's
// binary format: the matrix, three right-hand sides and three columns of the solution. Prints what
// Eigen's LDL^T takes for the same system.
#include "LinearMethods/FemWarp.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/GridMesh.h"
#include "Support/Monitor.h"

#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <string>

namespace
{
using morph::Index;
using morph::Points;

/// Displacements of meshes.py's motion.
Points twist(const Points& rest, const Points& mesh)
{
  constexpr double RightAngle = 1.5707963267948966;
  const Eigen::RowVector3d low = mesh.colwise().minCoeff(), high = mesh.colwise().maxCoeff();
  Points result(rest.rows(), 3);
  for (Index i = 0; i < rest.rows(); ++i)
  {
    const Eigen::RowVector3d x = rest.row(i) - (low + high) / 2;
    const double angle = RightAngle * (x[2] / (high[2] - low[2]) + 0.5);
    const double c = std::cos(angle), s = std::sin(angle);
    result.row(i) << c * x[0] - s * x[1] - x[0], s * x[0] + c * x[1] - x[1], 0;
  }
  return result;
}

/// Numbers with their most significant byte first.
class Writer
{
public:
  explicit Writer(const std::string& path)
    : file_(path, std::ios::binary)
  {
    this->file_.exceptions(std::ios::failbit | std::ios::badbit);
  }
  template <typename Number>
  void write(Number number)
  {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &number, sizeof(Number));
    std::reverse(bytes, bytes + sizeof(Number));
    this->file_.write(bytes, sizeof(Number));
  }
  void write(const morph::CsrMatrix& matrix)
  {
    constexpr std::int32_t MatrixId = 1211216;
    this->write(MatrixId);
    this->write(static_cast<std::int32_t>(matrix.rows()));
    this->write(static_cast<std::int32_t>(matrix.cols()));
    this->write(static_cast<std::int32_t>(matrix.nonZeros()));
    for (Index row = 0; row < matrix.rows(); ++row)
    {
      this->write(
        static_cast<std::int32_t>(matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row]));
    }
    std::for_each(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(),
      [&](int column) { this->write(static_cast<std::int32_t>(column)); });
    std::for_each(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
      [&](double value) { this->write(value); });
  }
  void write(const Points& columns)
  {
    constexpr std::int32_t VectorId = 1211214;
    for (int d = 0; d < 3; ++d)
    {
      this->write(VectorId);
      this->write(static_cast<std::int32_t>(columns.rows()));
      for (Index row = 0; row < columns.rows(); ++row)
      {
        this->write(columns(row, d));
      }
    }
  }

private:
  std::ofstream file_;
};

void solveByEigen(const morph::CsrMatrix& matrix, const Points& rightHandSide, const Points& ours)
{
  const Eigen::SparseMatrix<double> copy = matrix;
  const morph::Stopwatch cold;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(copy);
  Eigen::MatrixXd x = factors.solve(Eigen::MatrixXd(rightHandSide));
  const double first = cold.seconds();
  const morph::Stopwatch warm;
  x = factors.solve(Eigen::MatrixXd(rightHandSide));
  std::printf("{\"first\": %.6g, \"later\": %.6g, \"difference\": %.3g}\n", first, warm.seconds(),
    (x - ours).cwiseAbs().maxCoeff() / ours.cwiseAbs().maxCoeff());
}

void writeSystem(const morph::Mesh& mesh, const std::string& path, bool withEigen)
{
  morph::Monitor monitor;
  const std::vector<Index> outer = morph::boundaryFaces(mesh, monitor).nodes;
  std::unique_ptr<morph::Morpher> morpher = std::make_unique<morph::FemWarp>();
  if (morph::needsPieces(mesh, {}))
  {
    morpher = morph::morpherForPolyhedra(std::move(morpher));
  }
  morpher->prepare(mesh, morph::partitionNodes(mesh, outer), monitor);
  const auto& method = static_cast<const morph::FemWarp&>(morph::methodOf(*morpher));
  const Points& rest = method.restPoints();
  const Points prescribed =
    twist(rest(method.partition().prescribed, morph::allColumns), mesh.points);
  const Points rightHandSide = -(method.coupling() * prescribed);
  Points moved;
  method.evaluate(
    rest(method.partition().prescribed, morph::allColumns) + prescribed, moved, monitor);
  const Points ours = (moved - rest)(method.rows(), morph::allColumns);
  const morph::CsrMatrix matrix = method.solver().matrix();
  Writer writer(path);
  writer.write(matrix);
  writer.write(rightHandSide);
  writer.write(ours);
  if (withEigen)
  {
    solveByEigen(matrix, rightHandSide, ours);
  }
}
}

int main(int argc, char** argv)
{
  if (argc < 3 || argc > 4 || (argc == 4 && std::string(argv[3]) != "--eigen"))
  {
    std::fprintf(stderr, "Usage: linear-system MESH.vtu OUTPUT [--eigen]\n");
    return 2;
  }
  try
  {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(argv[1]);
    reader->Update();
    writeSystem(morph::filters::GridMesh::FromGrid(reader->GetOutput()), argv[2], argc == 4);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
