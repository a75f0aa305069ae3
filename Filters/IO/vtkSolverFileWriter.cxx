// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverFileWriter.h"

#include "Formats/SolverFile.h"
#include "Support/Error.h"

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <unordered_map>
#include <vector>

namespace
{
/// The data sets of the input: itself, or its blocks that have points.
std::vector<vtkPointSet*> partsOf(vtkDataObject* input)
{
  std::vector<vtkPointSet*> parts;
  const auto add = [&parts](vtkDataObject* data)
  {
    auto* part = vtkPointSet::SafeDownCast(data);
    if (part && part->GetNumberOfPoints() > 0)
    {
      parts.push_back(part);
    }
  };
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(input))
  {
    const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      add(iterator->GetCurrentDataObject());
    }
  }
  else
  {
    add(input);
  }
  return parts;
}

std::string originalOf(
  vtkDataObject* input, const std::vector<vtkPointSet*>& parts, const char* given)
{
  if (given && given[0])
  {
    return given;
  }
  std::vector<vtkDataObject*> all(parts.begin(), parts.end());
  all.insert(all.begin(), input);
  for (vtkDataObject* data : all)
  {
    auto* file = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("SolverFile"));
    if (file && file->GetNumberOfValues() == 1)
    {
      return file->GetValue(0);
    }
  }
  throw morph::Error("No file is named whose coordinates are to be replaced: set "
                     "OriginalFileName.");
}

/// The numbers that vtkSolverFileReader gives; null in a mesh of another reader.
vtkDataArray* ownNumbersOf(vtkPointSet* part)
{
  return part->GetPointData()->GetArray("NodeNumber");
}

vtkDataArray* numbersOf(vtkPointSet* part)
{
  vtkDataArray* numbers = ownNumbersOf(part);
  numbers = numbers ? numbers : part->GetPointData()->GetGlobalIds();
  if (!numbers || numbers->GetNumberOfTuples() != part->GetNumberOfPoints())
  {
    throw morph::Error("The mesh has no node numbers (the point array NodeNumber), which tell its "
                       "points in the file. Read the mesh from that file.");
  }
  return numbers;
}

struct Nodes
{
  std::vector<morph::Index> Numbers;
  std::vector<double> Coordinates; ///< 3 x #nodes
  bool AreOfAnotherReader = false; ///< which may have added displacements
  bool AreMorphed = false;
  /// 3 x #nodes, before the last morph; empty where our reader gave them.
  std::vector<double> Undeformed;
  double Precision = 0; ///< what rounding may have changed of Undeformed
};

/// What the last morph added to the points; null where none did.
vtkDataArray* displacementOf(vtkPointSet* part)
{
  vtkDataArray* moved = part->GetPointData()->GetArray("MorphDisplacement");
  const bool fits = moved && moved->GetNumberOfComponents() == 3 &&
                    moved->GetNumberOfTuples() == part->GetNumberOfPoints();
  return fits ? moved : nullptr;
}

/// The nodes of all parts. Nodes of several parts are one; within a part none is.
Nodes nodesOf(const std::vector<vtkPointSet*>& parts)
{
  Nodes nodes;
  nodes.AreOfAnotherReader =
    std::any_of(parts.begin(), parts.end(), [](vtkPointSet* part) { return !ownNumbersOf(part); });
  std::unordered_map<morph::Index, std::size_t> known; // places of the nodes of earlier parts
  std::vector<morph::Index> apart;
  for (vtkPointSet* part : parts)
  {
    vtkDataArray* numbers = numbersOf(part);
    vtkDataArray* moved = displacementOf(part);
    nodes.AreMorphed = nodes.AreMorphed || moved;
    // A point and its displacement are rounded each.
    const double rounding = part->GetPoints()->GetDataType() == VTK_FLOAT
                              ? double(std::numeric_limits<float>::epsilon())
                              : std::numeric_limits<double>::epsilon();
    const std::size_t first = nodes.Numbers.size();
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i)
    {
      const auto number = static_cast<morph::Index>(numbers->GetComponent(i, 0));
      double x[3];
      part->GetPoint(i, x);
      const auto found = known.find(number);
      if (found == known.end())
      {
        nodes.Numbers.push_back(number);
        nodes.Coordinates.insert(nodes.Coordinates.end(), x, x + 3);
        for (int j = 0; nodes.AreOfAnotherReader && j < 3; ++j)
        {
          const double displacement = moved ? moved->GetComponent(i, j) : 0;
          const double undeformed = x[j] - displacement;
          nodes.Undeformed.push_back(undeformed);
          nodes.Precision = std::max({ nodes.Precision, 8 * rounding * std::abs(x[j]),
            8 * rounding * std::abs(displacement), 8 * rounding * std::abs(undeformed) });
        }
      }
      else if (!std::equal(x, x + 3, nodes.Coordinates.data() + 3 * found->second))
      {
        apart.push_back(number);
      }
    }
    for (std::size_t i = first; parts.size() > 1 && i < nodes.Numbers.size(); ++i)
    {
      known.emplace(nodes.Numbers[i], i);
    }
  }
  if (!apart.empty())
  {
    throw morph::Error(
      "Blocks have different coordinates for the same nodes: " + morph::listIds(apart) +
      ". Move all blocks alike, or write the block \"Mesh\" alone.");
  }
  return nodes;
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
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
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
  this->LargestRounding = this->ChangedCoordinates = -1;
  try
  {
    this->WriteCopy(this->GetInput());
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

void vtkSolverFileWriter::WriteCopy(vtkDataObject* input)
{
  if (!this->FileName || !this->FileName[0])
  {
    throw morph::Error("No file is named that is to be written: set FileName.");
  }
  const std::vector<vtkPointSet*> parts = partsOf(input);
  const std::string original = originalOf(input, parts, this->OriginalFileName);
  morph::io::requireWritable(original, this->FileName);
  Nodes nodes = nodesOf(parts);
  if (nodes.AreOfAnotherReader)
  {
    const std::vector<double> displaced = morph::io::requireOwnCoordinates(
      original, nodes.Numbers, nodes.Undeformed, nodes.Precision, nodes.AreMorphed);
    nodes.Coordinates = displaced.empty() ? nodes.Coordinates : displaced;
  }
  const morph::io::Copied copied =
    morph::io::writeSolverFile(original, nodes.Numbers, nodes.Coordinates, this->FileName,
      this->HandleSignals ? morph::io::Signals::RemoveTemporaries : morph::io::Signals::Leave);
  this->LargestRounding = copied.largestRounding;
  this->ChangedCoordinates = static_cast<vtkIdType>(copied.changed);
}

void vtkSolverFileWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent
     << "OriginalFileName: " << (this->OriginalFileName ? this->OriginalFileName : "(none)") << "\n"
     << indent << "HandleSignals: " << this->HandleSignals << "\n"
     << indent << "LargestRounding: " << this->LargestRounding << "\n"
     << indent << "ChangedCoordinates: " << this->ChangedCoordinates << "\n";
}
