// SPDX-License-Identifier: BSD-3-Clause
#include "vtkScaledJacobian.h"

#include "Mesh/CellShape.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Data/Version.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Options.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkObjectFactory.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkScaledJacobian);

class vtkScaledJacobian::vtkInternals
{
public:
  filters::Blocks Blocks;
  filters::Results Results{ filters::ResultTables::vtkScaledJacobian() };
};

namespace
{
std::string typeName(std::uint8_t type)
{
  const morph::CellShape* shape = morph::cellShape(type);
  return shape ? shape->name : filters::Version::CellClass(type);
}

/// Warns of cells of the highest dimension without a value. `unmeasured`: by cell type.
void reportUnmeasured(
  vtkScaledJacobian* filter, const std::vector<morph::Index>& unmeasured, filters::Results& results)
{
  std::string list;
  for (std::size_t type = 0; type < unmeasured.size(); ++type)
  {
    if (unmeasured[type] > 0)
    {
      list += (list.empty() ? "" : ", ") + std::to_string(unmeasured[type]) + " " +
              typeName(static_cast<std::uint8_t>(type));
    }
  }
  if (!list.empty())
  {
    vtkWarningWithObjectMacro(
      filter, "Cells that have no scaled Jacobian here, marked NaN: " << list << ".");
  }
  results.SetInteger(
    "UnmeasuredCells", std::accumulate(unmeasured.begin(), unmeasured.end(), vtkIdType(0)));
}
}

vtkScaledJacobian::vtkScaledJacobian()
  : Internals(new vtkInternals)
  , Options(std::make_unique<morph::ScaledJacobianOptions>())
{
  morph::Quality none;
  none.minimum = none.mean = vtkMath::Nan();
  this->Internals->Results.Set(none);
}

vtkScaledJacobian::~vtkScaledJacobian() = default;

vtkTypeBool vtkScaledJacobian::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkScaledJacobian::FillInputPortInformation(int, vtkInformation* info)
{
  // Otherwise the executive would loop over the blocks of composite data.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkScaledJacobian::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkScaledJacobian::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  filters::Blocks& blocks = this->Internals->Blocks;
  vtkUnstructuredGrid* output = blocks.Output(outputVector);
  const auto clear = [&]
  {
    output->Initialize();
    this->Internals->Results.Reset();
  };
  clear();
  filters::Monitor monitor(this, this->Options->NumberOfThreads);
  bool isEmpty = false;
  const filters::Execution::Outcome outcome = filters::Execution::Run(
    this, "measure this mesh",
    [&]
    {
      const filters::Input::Mesh mesh =
        filters::Input::TakeMesh(input, blocks, this->Options->CoincidentPoints,
          filters::Input::Use::ToMeasure, this->GetClassName(), monitor);
      isEmpty = mesh.IsEmpty;
      const bool takesPieces = mesh.IsDistributed && filters::Ranks::TakePieces();
      vtkUnstructuredGrid* grid = nullptr;
      filters::RankGroup(takesPieces)
        .Together([&] { grid = filters::Input::RequireGrid(mesh.Data, "The input"); });
      this->Measure(grid, takesPieces, output, monitor);
    },
    clear);
  monitor.TellWarnings();
  if (outcome != filters::Execution::Outcome::Done)
  {
    this->Internals->Results.Write(output);
  }
  else if (isEmpty)
  {
    vtkWarningMacro("The input has no cells, so nothing is measured.");
  }
  blocks.Scatter(outputVector);
  return 1;
}

void vtkScaledJacobian::Measure(
  vtkUnstructuredGrid* input, bool isPiece, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  std::vector<filters::Quality::OfCriterion> criteria =
    filters::Quality::ReadCriteria(this->Options->Criteria);
  const bool certified = this->Options->Certify;
  const auto [measured, mirroredBodies] =
    isPiece ? filters::OnRanks::Measure(input, certified, criteria, output, monitor)
            : filters::Quality::MeasureAlone(input, certified, criteria, output, monitor);
  filters::Results& results = this->Internals->Results;
  results.Set(measured.Whole);
  results.SetInteger("MeasuredCells", measured.Whole.measured);
  if (certified)
  {
    results.Set(measured.Certificates);
  }
  results.SetInteger("MirroredBodies", mirroredBodies);
  results.Write(output);
  reportUnmeasured(this, measured.Unmeasured, results);
}

double vtkScaledJacobian::GetNumber(const char* name) const
{
  return this->Internals->Results.Number(name);
}

vtkIdType vtkScaledJacobian::GetInteger(const char* name) const
{
  return this->Internals->Results.Integer(name);
}

void vtkScaledJacobian::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  this->Internals->Results.Print(os, indent);
}
