// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverFileWriter.h"

#include "Formats/SolverFile.h"
#include "Support/Error.h"

#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkStringArray.h>

#include <exception>

namespace
{
std::string originalOf(vtkPointSet* input, const char* given)
{
  if (given && given[0])
  {
    return given;
  }
  auto* file = vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray("SolverFile"));
  if (!file || file->GetNumberOfValues() != 1)
  {
    throw morph::Error("No file is named whose coordinates are to be replaced: set "
                       "OriginalFileName.");
  }
  return file->GetValue(0);
}

std::vector<morph::Index> numbersOf(vtkPointSet* input)
{
  vtkPointData* arrays = input->GetPointData();
  vtkDataArray* numbers = arrays->GetArray("NodeNumber");
  numbers = numbers ? numbers : arrays->GetGlobalIds();
  if (!numbers || numbers->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw morph::Error("The mesh has no node numbers (the point array NodeNumber), which tell its "
                       "points in the file. Read the mesh from that file.");
  }
  std::vector<morph::Index> result(static_cast<std::size_t>(input->GetNumberOfPoints()));
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    result[i] = static_cast<morph::Index>(numbers->GetComponent(static_cast<vtkIdType>(i), 0));
  }
  return result;
}
}

vtkStandardNewMacro(vtkSolverFileWriter);

vtkSolverFileWriter::vtkSolverFileWriter() = default;

vtkSolverFileWriter::~vtkSolverFileWriter()
{
  this->SetFileName(nullptr);
  this->SetOriginalFileName(nullptr);
}

int vtkSolverFileWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

std::string vtkSolverFileWriter::WhyNot(const char* original, const char* name)
{
  try
  {
    morph::io::requireWritable(original ? original : "", name ? name : "");
    return "";
  }
  catch (const std::exception& error)
  {
    return error.what();
  }
}

void vtkSolverFileWriter::WriteData()
{
  this->LargestRounding = -1;
  try
  {
    this->WriteCopy(vtkPointSet::SafeDownCast(this->GetInput()));
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Cannot write " << this->FileName << ": there is not enough memory.");
    this->SetErrorCode(vtkErrorCode::UnknownError);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
  }
}

void vtkSolverFileWriter::WriteCopy(vtkPointSet* input)
{
  if (!this->FileName || !this->FileName[0])
  {
    throw morph::Error("No file is named that is to be written: set FileName.");
  }
  const std::string original = originalOf(input, this->OriginalFileName);
  morph::io::requireWritable(original, this->FileName);
  const std::vector<morph::Index> numbers = numbersOf(input);
  std::vector<double> coordinates(3 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    input->GetPoint(static_cast<vtkIdType>(i), coordinates.data() + 3 * i);
  }
  this->LargestRounding = morph::io::writeSolverFile(original, numbers, coordinates, this->FileName,
    this->HandleSignals ? morph::io::Signals::RemoveTemporaries : morph::io::Signals::Leave);
}

void vtkSolverFileWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent
     << "OriginalFileName: " << (this->OriginalFileName ? this->OriginalFileName : "(none)") << "\n"
     << indent << "HandleSignals: " << this->HandleSignals << "\n"
     << indent << "LargestRounding: " << this->LargestRounding << "\n";
}
