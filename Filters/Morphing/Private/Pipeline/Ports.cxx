// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Ports.h"

#include "Private/Blocks/BlockPoints.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationIntegerVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace morph::filters
{
int Ports::FillInformation(int port, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  if (port > 0)
  {
    // RequestData has a better message for a missing boundary than the executive has. ParaView's
    // dialog lets users forget it, and asks for the time steps before they can correct that.
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int Ports::FillOutputInformation(int port, vtkInformation* info)
{
  const char* types[] = { "vtkDataObject", "vtkUnstructuredGrid", "vtkPolyData", "vtkPolyData" };
  info->Set(vtkDataObject::DATA_TYPE_NAME(), types[port]);
  return 1;
}

bool Ports::MakeOutput(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const bool isAsked = request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT());
  if (isAsked)
  {
    Blocks::MakeOutput(inputVector, outputVector);
  }
  return isAsked;
}

int Ports::RequestInformation(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (vtkInformation* boundary = inputVector[1]->GetInformationObject(0))
  {
    for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
    {
      Time::CopySteps(boundary, outputVector->GetInformationObject(port));
    }
  }
  return 1;
}

vtkInformation* Ports::Asked(vtkInformation* request, vtkInformationVector* outputVector)
{
  const int port = request->Has(vtkExecutive::FROM_OUTPUT_PORT())
                     ? request->Get(vtkExecutive::FROM_OUTPUT_PORT())
                     : -1;
  return outputVector->GetInformationObject(std::max(0, port));
}

std::optional<double> Ports::AskedTime(vtkInformation* output)
{
  if (!output->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()))
  {
    return std::nullopt;
  }
  return output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
}

void Ports::AskForAll(vtkInformation* input)
{
  Time::Ask(input, std::nullopt);
  if (input->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    input->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
      input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
  }
}

int Ports::RequestUpdateExtent(
  double restTime, std::optional<double> boundaryTime, vtkInformationVector** inputVector)
{
  for (int port = 0; port < this->Filter->GetNumberOfInputPorts(); ++port)
  {
    // The executive asks all ports for the extent of port 0, which may be only a part of a larger
    // image on another port.
    vtkInformation* info = inputVector[port]->GetInformationObject(0);
    if (info && info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
    {
      info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
        info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
    }
  }
  if (vtkInformation* boundary = inputVector[1]->GetInformationObject(0))
  {
    this->Time.Request(restTime, boundaryTime, inputVector[0]->GetInformationObject(0), boundary);
  }
  return 1;
}

vtkDataObject* Ports::Update(int port, std::optional<double> time) const
{
  vtkInformation* info = this->Filter->GetExecutive()->GetInputInformation(port, 0);
  Time::Ask(info, time);
  vtkAlgorithmOutput* source = this->Filter->GetInputConnection(port, 0);
  auto* upstream =
    vtkStreamingDemandDrivenPipeline::SafeDownCast(source->GetProducer()->GetExecutive());
  if (!upstream || !upstream->Update(source->GetIndex()))
  {
    std::ostringstream text;
    text << (port == 0 ? "The mesh" : "The boundary") << " is not available";
    if (time)
    {
      text << " at time " << *time;
    }
    text << ": the pipeline before it failed.";
    throw morph::Error(text.str());
  }
  return vtkDataObject::GetData(info);
}

vtkDataObject* Ports::Fetch(int port, std::optional<double> time) const
{
  vtkDataObject* data = this->Update(port, time);
  return port == 1 ? this->AsOne(data, "The boundary") : data;
}

vtkDataObject* Ports::AsOne(vtkDataObject* data, const char* subject, const char* agreeing) const
{
  auto* tree = Leaves::TreeOf(data);
  if (!tree)
  {
    return data;
  }
  this->Made.emplace_back(BlockPoints::Make(tree, this->Mesh.Merged(), subject, agreeing));
  return this->Made.back();
}

int Ports::RequestData(
  const Task& task, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const auto forOutputs = [outputVector](const auto& action)
  {
    for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
    {
      action(vtkDataObject::GetData(outputVector, port));
    }
  };
  task.Reset();
  CrewMonitor monitor(this->Filter, task.NumberOfThreads);
  vtkSmartPointer<vtkDataObject> input;
  this->Made.clear();
  const auto work = [&]
  {
    vtkSmartPointer<vtkDataObject> given = vtkDataObject::GetData(inputVector[0]);
    input = inputVector[1]->GetInformationObject(0)
              ? this->Time.TakeRest(given,
                  [this](int port, std::optional<double> time) { return this->Update(port, time); })
              : given;
    vtkDataObject* boundary = vtkDataObject::GetData(inputVector[1]);
    const char* name = this->Filter->GetClassName();
    Input::Mesh mesh = Input::TakeMesh(
      input, this->Mesh, task.CoincidentPoints, Input::Use::ToMorph, name, monitor, boundary);
    input = mesh.Data;
    if (!mesh.IsDistributed && Ranks::Count(mesh.IsElsewhere && Input::HasPoints(boundary)) > 0)
    {
      if (!Ranks::TakePieces())
      {
        throw morph::Error(
          std::string("The boundary is on MPI ranks that have no part of the mesh; ") + name +
          " needs both on one rank.");
      }
      mesh.IsDistributed = true;
    }
    mesh.IsDistributed |= task.IsForAll && Ranks::Processes() > 1;
    vtkUnstructuredGrid* grid = nullptr;
    const bool worksHere = mesh.IsDistributed || !mesh.IsElsewhere;
    RankGroup(mesh.IsDistributed)
      .Together(
        [&]
        {
          grid = Input::RequireGrid(input, "The input", this->Checked);
          if (worksHere)
          {
            boundary = this->AsOne(boundary, "The boundary");
          }
        });
    if (worksHere)
    {
      task.Work(grid, boundary, mesh.IsDistributed, monitor);
    }
  };
  const auto clear = [&]
  {
    forOutputs([](vtkDataObject* output) { output->Initialize(); });
    if (vtkUnstructuredGrid* grid = this->Mesh.Output(outputVector))
    {
      grid->Initialize();
    }
    task.Reset();
  };
  const Execution::Outcome outcome = Execution::Run(this->Filter, task.Name, work, clear);
  // After an error too: the warnings may explain it.
  monitor.TellWarnings();
  if (outcome != Execution::Outcome::Done && task.Undone)
  {
    task.Undone(input, outcome == Execution::Outcome::Cancelled ? "Cancelled" : "Failed");
  }
  this->WriteOutput(outputVector);
  if (vtkDataObject* boundary = vtkDataObject::GetData(inputVector[1]))
  {
    forOutputs([boundary](vtkDataObject* output) { Time::CopyDataTime(boundary, output); });
  }
  return 1;
}
}
