// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Quality.h"

#include "Mesh/CellShape.h"
#include "Mesh/SharedCorners.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/WrittenPoints.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMeshQuality.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>
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
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c) // the array may be longer
  {
    skip[c] |= ghosts->GetValue(c) &
               (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL);
  }
}

/// Replaces the values of cells for which Verdict has the criterion.
void takeVerdict(const char* criterion, vtkUnstructuredGrid* grid, std::vector<double>& values)
{
  const bool isTaper = std::strcmp(criterion, "Taper") == 0;
  if (!isTaper && std::strcmp(criterion, "AspectRatio") != 0)
  {
    return;
  }
  vtkNew<vtkUnstructuredGrid> cells;
  cells->CopyStructure(grid);
  vtkNew<vtkMeshQuality> verdict;
  verdict->SetInputData(cells);
  verdict->SetTriangleQualityMeasureToAspectRatio();
  verdict->SetTetQualityMeasureToAspectRatio();
  isTaper ? verdict->SetQuadQualityMeasureToTaper() : verdict->SetQuadQualityMeasureToAspectRatio();
  verdict->SetHexQualityMeasureToTaper();
  verdict->Update();
  vtkDataArray* found = verdict->GetOutput()->GetCellData()->GetArray("Quality");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    const int type = grid->GetCellType(c);
    if (type == VTK_QUAD ||
        (isTaper ? type == VTK_HEXAHEDRON : type == VTK_TRIANGLE || type == VTK_TETRA))
    {
      values[c] = found->GetComponent(c, 0);
    }
  }
}

/// Marks the nodes of the walls, as the arrays of named sets do: the point array of that name, or
/// the cell array on two-dimensional cells. Empty where all boundary is wall.
std::vector<std::uint8_t> wallNodes(
  const std::string& name, const morph::Mesh& mesh, vtkUnstructuredGrid* grid)
{
  std::vector<std::uint8_t> isWall;
  if (name.empty())
  {
    return isWall;
  }
  isWall.resize(mesh.numberOfNodes(), 0);
  if (vtkDataArray* marks = grid->GetPointData()->GetArray(name.c_str()))
  {
    for (morph::Index i = 0; i < mesh.numberOfNodes(); ++i)
    {
      isWall[i] = marks->GetComponent(i, 0) != 0;
    }
    return isWall;
  }
  vtkDataArray* marks = grid->GetCellData()->GetArray(name.c_str());
  if (!marks)
  {
    throw morph::Error("FirstHeight:" + name + ": the mesh has no point or cell array '" + name +
                       "' that marks a surface.");
  }
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh, c);
    for (morph::Index i = 0; shape && shape->dimension == 2 && i < mesh.cellSize(c); ++i)
    {
      isWall[mesh.cell(c)[i]] |= marks->GetComponent(c, 0) != 0;
    }
  }
  return isWall;
}

template <typename Array, typename Value>
void addColumn(vtkUnstructuredGrid* output, const char* name,
  const std::vector<Quality::OfCriterion>& rows, const Value& value)
{
  output->GetFieldData()->AddArray(Arrays::MakeOf<Array>(name, rows, value));
}
}

namespace Quality
{
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor)
{
  skipGhosts(mesh, output, skip);
  return withPoints(output, [&](const morph::ConstPoints& written)
    { return morph::measureQuality(mesh, written, orientation, skip, monitor); });
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
  const morph::Communicator& processes, morph::Monitor& monitor)
{
  morph::CertificateReport report;
  processes.together(
    [&]
    {
      skipGhosts(mesh, output, skip);
      report = withPoints(output, [&](const morph::ConstPoints& written)
        { return morph::certify(mesh, written, orientation, skip, monitor); });
    });
  for (morph::Index* count : { &report.certified, &report.inverted, &report.undecided })
  {
    *count = processes.sum(*count);
  }
  return report;
}

void Write(const morph::Quality& quality, vtkUnstructuredGrid* output)
{
  Arrays::Add(Arrays::MakeOf<vtkDoubleArray>(
                "ScaledJacobian", quality.scaledJacobian, [](double value) { return value; }),
    output->GetCellData());
  output->GetCellData()->SetActiveScalars("ScaledJacobian");
  // Viewers prefer active point scalars to active cell scalars.
  output->GetPointData()->SetActiveScalars(nullptr);
}

void Write(const morph::CertificateReport& report, vtkUnstructuredGrid* output)
{
  Arrays::Add(Arrays::MakeOf<vtkSignedCharArray>("JacobianCertificate", report.cells,
                [](morph::Certificate found) { return static_cast<signed char>(found); }),
    output->GetCellData());
}

std::vector<OfCriterion> ReadCriteria(const std::string& text)
{
  std::vector<OfCriterion> result;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');)
  {
    // A name of walls may have spaces inside.
    const std::size_t begin = part.find_first_not_of(' ');
    part =
      begin == std::string::npos ? "" : part.substr(begin, part.find_last_not_of(' ') + 1 - begin);
    const std::string label = part.substr(0, part.find('='));
    const std::string limit = label == part ? "" : part.substr(label.size() + 1);
    const std::string name = label.substr(0, label.find(':'));
    const std::string walls = name == label ? "" : label.substr(name.size() + 1);
    const auto& all = morph::criteria();
    const auto found = std::find_if(
      all.begin(), all.end(), [&](const morph::Criterion& one) { return one.name == name; });
    char* end = nullptr;
    const double number = std::strtod(limit.c_str(), &end);
    if (found == all.end() || *end != '\0' || (label != part && limit.empty()) ||
        (name != label && (walls.empty() || name != "FirstHeight")))
    {
      std::string names;
      for (const morph::Criterion& one : all)
      {
        names += (names.empty() ? "" : ", ") + std::string(one.name);
      }
      throw morph::Error("'" + part +
                         "' is not a criterion, or a criterion with a limit like "
                         "NonOrthogonality=70, or FirstHeight with the name of a surface like "
                         "FirstHeight:BLADE=1e-5. There are " +
                         names + ".");
    }
    result.push_back({ &*found, limit.empty() ? found->limit : number, label, walls });
  }
  return result;
}

void Measure(OfCriterion& criterion, const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  const std::vector<std::int64_t>& cellIds, morph::Monitor& monitor)
{
  skip.resize(mesh.numberOfCells(), 0);
  skipGhosts(mesh, output, skip);
  const morph::Criterion& measure = *criterion.Criterion;
  std::vector<double> values = morph::measureCriterion(measure, mesh, mesh.points, orientation,
    skip, wallNodes(criterion.Walls, mesh, output), monitor);
  takeVerdict(measure.name, output, values);
  auto array = Arrays::Make<vtkDoubleArray>(criterion.Label.c_str());
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    const double value = skip[c] ? std::numeric_limits<double>::quiet_NaN() : values[c];
    array->InsertNextValue(value);
    if (std::isnan(value))
    {
      continue;
    }
    const morph::Index id = cellIds.empty() ? c : cellIds[c];
    const double worse = criterion.Sign() * (value - criterion.Worst);
    criterion.Beyond += measure.isBeyond(value, criterion.Limit);
    if (criterion.WorstCell < 0 || worse > 0 || (worse == 0 && id < criterion.WorstCell))
    {
      criterion.Worst = value;
      criterion.WorstCell = id;
    }
  }
  Arrays::Add(array, output->GetCellData());
}

void Write(const std::vector<OfCriterion>& criteria, vtkUnstructuredGrid* output)
{
  if (criteria.empty())
  {
    return;
  }
  addColumn<vtkStringArray>(
    output, "Criterion", criteria, [](const OfCriterion& row) { return row.Label; });
  addColumn<vtkDoubleArray>(
    output, "CriterionLimit", criteria, [](const OfCriterion& row) { return row.Limit; });
  addColumn<vtkDoubleArray>(
    output, "CriterionWorst", criteria, [](const OfCriterion& row) { return row.Worst; });
  addColumn<vtkIdTypeArray>(
    output, "CriterionWorstCellId", criteria, [](const OfCriterion& row) { return row.WorstCell; });
  addColumn<vtkIdTypeArray>(
    output, "CriterionCellsBeyond", criteria, [](const OfCriterion& row) { return row.Beyond; });
}

namespace
{
/// Takes what all processes found.
void reduce(OfCriterion& criterion, const morph::Communicator& processes)
{
  constexpr double None = std::numeric_limits<double>::infinity();
  const double own = criterion.WorstCell >= 0 ? criterion.Sign() * criterion.Worst : -None;
  const double worst = processes.maximum(own);
  const double cell = processes.minimum(
    own == worst && criterion.WorstCell >= 0 ? static_cast<double>(criterion.WorstCell) : None);
  criterion.Beyond = processes.sum(criterion.Beyond);
  if (cell < None)
  {
    criterion.WorstCell = static_cast<morph::Index>(cell);
    criterion.Worst = criterion.Sign() * worst;
  }
}
}

Measured MeasureAll(const Part& part, bool certified, std::vector<OfCriterion>& criteria,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  const morph::Communicator& processes = part.Processes;
  Measured result;
  morph::Quality mine;
  processes.together(
    [&]
    {
      output->ShallowCopy(grid);
      mine = Measure(part.Grid, output, part.Orientation, part.Skip, monitor);
      Remove(output);
      Write(mine, output);
      result.Unmeasured = Unmeasured(part.Grid, mine, part.Skip, grid);
    });
  for (morph::Index& count : result.Unmeasured)
  {
    count = processes.sum(count);
  }
  result.Whole = morph::ofAll(mine, processes);
  const std::vector<morph::Index> cells =
    processes.idsOfCells(morph::consecutive(criteria.empty() ? 0 : part.Mesh.types.size()));
  for (OfCriterion& criterion : criteria)
  {
    processes.together(
      [&] { Measure(criterion, part.Mesh, output, part.Orientation, part.Skip, cells, monitor); });
    reduce(criterion, processes);
  }
  Write(criteria, output);
  if (certified)
  {
    result.Certificates = Certify(part.Grid, output, part.Orientation,
      part.Dimension == 3 ? part.Skip : std::vector<std::uint8_t>(part.Skip.size(), 1), processes,
      monitor);
    Write(result.Certificates, output);
  }
  return result;
}

std::pair<Measured, morph::Index> MeasureAlone(vtkUnstructuredGrid* grid, bool certified,
  std::vector<OfCriterion>& criteria, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  const morph::Mesh mesh = GridMesh::FromGrid(grid, GridMesh::UnknownCells::Keep);
  const morph::ConnectedComponents bodies = morph::connectedComponents(mesh);
  const std::vector<std::int8_t> orientation = morph::cellSigns(mesh, bodies);

  // A mesh of unknown volume cells must not be judged by its boundary triangles.
  std::array<int, 256> dimension;
  dimension.fill(-1);
  for (const std::uint8_t type : mesh.types)
  {
    if (dimension[type] < 0)
    {
      dimension[type] = GridMesh::Dimension(type);
    }
  }
  const int highest = *std::max_element(dimension.begin(), dimension.end());
  std::vector<std::uint8_t> skip(mesh.types.size());
  std::transform(mesh.types.begin(), mesh.types.end(), skip.begin(),
    [&](std::uint8_t type) { return dimension[type] < highest; });
  const Part part = { mesh, mesh, orientation, skip, highest, morph::Communicator::alone() };
  return { MeasureAll(part, certified, criteria, grid, output, monitor),
    morph::mirroredBodies(bodies, orientation) };
}

void Remove(vtkDataSet* output)
{
  // A user's own array may have the name of a criterion.
  auto* criteria =
    vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("Criterion"));
  for (vtkIdType i = 0; criteria && i < criteria->GetNumberOfValues(); ++i)
  {
    output->GetCellData()->RemoveArray(criteria->GetValue(i).c_str());
  }
  output->GetCellData()->RemoveArray("ScaledJacobian");
  output->GetCellData()->RemoveArray("JacobianCertificate");
  for (const char* name : { "CertifiedCells", "UncertifiedCells", "UndecidedCells", "Criterion",
         "CriterionLimit", "CriterionWorst", "CriterionWorstCellId", "CriterionCellsBeyond" })
  {
    output->GetFieldData()->RemoveArray(name);
  }
}
}
}
