// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Quality.h"

#include "Private/Data/GridMesh.h"
#include "Quality/ScaledJacobian.h"

#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace morph::filters
{
namespace
{
/// Marks the ghost cells in `skip`, which stays empty where there are none.
void skipGhosts(
  const morph::Mesh& mesh, vtkUnstructuredGrid* output, std::vector<std::uint8_t>& skip)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    output->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  if (!ghosts)
  {
    return;
  }
  skip.resize(mesh.numberOfCells(), 0);
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    skip[c] |= ghosts->GetValue(c) &
               (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL);
  }
}

/// Calls body with the grid's points, copied only where they are not double.
template <typename Body>
auto withPoints(vtkUnstructuredGrid* grid, Body&& body)
{
  vtkPoints* points = grid->GetPoints();
  if (auto* doubles = points ? vtkDoubleArray::FastDownCast(points->GetData()) : nullptr)
  {
    return body(
      Eigen::Map<const morph::Points>(doubles->GetPointer(0), doubles->GetNumberOfTuples(), 3));
  }
  return body(GridMesh::FromPoints(points));
}
}

namespace Quality
{
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, morph::Monitor& monitor)
{
  return Measure(mesh, output, orientation, std::vector<std::uint8_t>(), monitor);
}

morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor)
{
  skipGhosts(mesh, output, skip);
  return withPoints(output, [&](const morph::ConstPoints& written)
    { return morph::measureQuality(mesh, written, orientation, skip, monitor); });
}

morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, const std::vector<morph::Index>& cells,
  morph::Monitor& monitor)
{
  std::vector<std::uint8_t> skip(mesh.types.size(), 1);
  for (const morph::Index cell : cells)
  {
    skip[cell] = 0;
  }
  return Measure(mesh, output, orientation, std::move(skip), monitor);
}

std::vector<morph::Index> Unmeasured(const morph::Mesh& mesh, const morph::Quality& quality,
  std::vector<std::uint8_t> skip, vtkUnstructuredGrid* grid)
{
  skip.resize(mesh.types.size(), 0);
  skipGhosts(mesh, grid, skip);
  std::vector<morph::Index> count(256, 0);
  for (std::size_t c = 0; c < mesh.types.size(); ++c)
  {
    count[mesh.types[c]] += skip[c] == 0 && std::isnan(quality.scaledJacobian[c]);
  }
  return count;
}

morph::Index MirroredBodies(
  const morph::ConnectedComponents& bodies, const std::vector<std::int8_t>& orientation)
{
  std::vector<bool> mirrored(bodies.count, false);
  for (std::size_t c = 0; c < orientation.size(); ++c)
  {
    if (orientation[c] < 0)
    {
      mirrored[bodies.ofCell[c]] = true;
    }
  }
  return std::count(mirrored.begin(), mirrored.end(), true);
}

Judged Judge(
  const morph::InvertedBefore& before, const morph::Quality& quality, vtkUnstructuredGrid* output)
{
  Judged judged;
  const auto cells = static_cast<morph::Index>(quality.scaledJacobian.size()); // ghosts come behind
  judged.Before = std::count_if(before.cells().begin(), before.cells().end(),
    [&](morph::Index cell) { return cell < cells && !std::isnan(quality.scaledJacobian[cell]); });
  const std::vector<morph::Index> inverted = morph::invertedCells(quality);
  if (!inverted.empty())
  {
    judged.Added = withPoints(output, [&](const morph::ConstPoints& written)
      { return static_cast<morph::Index>(before.added(written, inverted).size()); });
  }
  return judged;
}

bool IsThatOfComputed(vtkUnstructuredGrid* output)
{
  return output->GetPoints()->GetDataType() == VTK_DOUBLE &&
         !output->GetCellData()->HasArray(vtkDataSetAttributes::GhostArrayName());
}

morph::CertificateReport Certify(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor)
{
  skipGhosts(mesh, output, skip);
  return withPoints(output, [&](const morph::ConstPoints& written)
    { return morph::certify(mesh, written, orientation, skip, monitor); });
}

void Write(const morph::Quality& quality, vtkUnstructuredGrid* output)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("ScaledJacobian");
  values->SetNumberOfValues(static_cast<vtkIdType>(quality.scaledJacobian.size()));
  std::copy(quality.scaledJacobian.begin(), quality.scaledJacobian.end(), values->GetPointer(0));
  output->GetCellData()->AddArray(values);
  output->GetCellData()->SetActiveScalars("ScaledJacobian");
  // Viewers prefer active point scalars to active cell scalars.
  output->GetPointData()->SetActiveScalars(nullptr);
}

void Write(const morph::CertificateReport& report, vtkUnstructuredGrid* output)
{
  vtkNew<vtkSignedCharArray> values;
  values->SetName("JacobianCertificate");
  values->SetNumberOfValues(static_cast<vtkIdType>(report.cells.size()));
  std::transform(report.cells.begin(), report.cells.end(), values->GetPointer(0),
    [](morph::Certificate found) { return static_cast<signed char>(found); });
  output->GetCellData()->AddArray(values);
}

void Remove(vtkDataSet* output)
{
  output->GetCellData()->RemoveArray("ScaledJacobian");
  output->GetCellData()->RemoveArray("JacobianCertificate");
  for (const char* name : { "CertifiedCells", "UncertifiedCells", "UndecidedCells" })
  {
    output->GetFieldData()->RemoveArray(name);
  }
}
}
}
