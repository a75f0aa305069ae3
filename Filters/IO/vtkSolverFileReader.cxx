// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverFileReader.h"

#include "Formats/SolverFile.h"
#include "SolverGrids.h"

#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <exception>

vtkStandardNewMacro(vtkSolverFileReader);

vtkSolverFileReader::vtkSolverFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSolverFileReader::~vtkSolverFileReader()
{
  this->SetFileName(nullptr);
}

int vtkSolverFileReader::CanReadFile(const char* name)
{
  return FormatOf(name).empty() ? 0 : 1;
}

std::string vtkSolverFileReader::FormatOf(const char* name)
{
  try
  {
    return name ? morph::io::solverFormat(name) : "";
  }
  catch (const std::exception&)
  {
    return "";
  }
}

int vtkSolverFileReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkSolverFileReader::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->Superclass::ProcessRequest(request, inputVector, outputVector);
  }
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  const char* type = this->SetsAsBlocks ? "vtkPartitionedDataSetCollection" : "vtkUnstructuredGrid";
  if (!output || !output->IsA(type))
  {
    vtkSmartPointer<vtkDataObject> fresh;
    if (this->SetsAsBlocks)
    {
      fresh = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
    }
    else
    {
      fresh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    }
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  return 1;
}

int vtkSolverFileReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  if (!this->FileName || !this->FileName[0])
  {
    vtkErrorMacro("No file is named that is to be read: set FileName.");
    return 1;
  }
  try
  {
    const auto file = morph::io::readSolverFile(this->FileName);
    if (this->TimeStep >= 0)
    {
      file->takeStep(this->TimeStep);
    }
    if (auto* blocks = vtkPartitionedDataSetCollection::SafeDownCast(output))
    {
      morph::io::fillBlocks(file->mesh(), this->FileName, blocks);
    }
    else
    {
      morph::io::fillGrid(file->mesh(), this->FileName, vtkUnstructuredGrid::SafeDownCast(output));
    }
    for (const std::string& warning : file->mesh().warnings)
    {
      vtkWarningMacro(<< warning);
    }
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Cannot read " << this->FileName << ": there is not enough memory.");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
  return 1;
}

void vtkSolverFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "SetsAsBlocks: " << this->SetsAsBlocks << "\n"
     << indent << "TimeStep: " << this->TimeStep << "\n";
}
