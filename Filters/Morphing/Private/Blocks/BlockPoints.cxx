// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockPoints.h"

#include "Private/Blocks/BlockArrays.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/DataCheck.h"
#include "Support/Error.h"

#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>
#include <string>

namespace morph::filters::BlockPoints
{
namespace
{
using morph::Index;

/// The data sets that give points, and the place of each of their points.
struct Source
{
  vtkPointSet* Data;
  std::vector<Index> Places;
  morph::Points Points;
};

bool isCopy(const std::vector<Leaves::Leaf>& leaves, const MergedBlocks* mesh)
{
  if (!mesh || leaves.size() != mesh->All.size())
  {
    return false;
  }
  const bool isAnyMesh = std::any_of(mesh->All.begin(), mesh->All.end(),
    [](const MergedBlocks::Block& block) { return block.IsMesh; });
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    auto* set = vtkPointSet::SafeDownCast(leaves[i].Data);
    const MergedBlocks::Block& block = mesh->All[i];
    if (!isAnyMesh && set && set->GetPointData()->HasArray("MorphPointId"))
    {
      return false; // an MPI process with sets alone: pieces of a boundary say what they are
    }
    if (block.IsMesh &&
        (!set || set->GetNumberOfPoints() != static_cast<vtkIdType>(block.Nodes.size())))
    {
      return false;
    }
  }
  return true;
}

std::vector<Source> sourcesOf(
  const std::vector<Leaves::Leaf>& leaves, const MergedBlocks* copied, const std::string& subject)
{
  std::vector<Source> sources;
  Index next = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    auto* set = vtkPointSet::SafeDownCast(leaves[i].Data);
    if (!set || set->GetNumberOfPoints() == 0 || (copied && !copied->All[i].IsMesh))
    {
      continue;
    }
    DataCheck::Require(set, (subject + ": " + leaves[i].Name).c_str());
    Source source = { set, {}, BlockCells::ReadPoints(set) };
    for (vtkIdType p = 0; p < set->GetNumberOfPoints(); ++p)
    {
      source.Places.push_back(copied ? copied->All[i].Nodes[p] : next++);
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

double sizeOf(const std::vector<Source>& sources)
{
  Eigen::RowVector3d low, high;
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const Source& source : sources)
  {
    low = low.cwiseMin(source.Points.colwise().minCoeff());
    high = high.cwiseMax(source.Points.colwise().maxCoeff());
  }
  return (high - low).norm();
}

[[noreturn]] void refuse(
  const std::string& subject, const std::string& what, const std::vector<Index>& nodes)
{
  throw morph::Error(
    subject + " has several " + what + " for one node, at points of different blocks: node ids " +
    morph::listIds(nodes) + ". Make them equal, or keep the blocks apart with `CoincidentPoints`.");
}

/// Whether values at one place differ by more than 1e-6 of the largest one.
std::vector<Index> contradictions(
  const std::vector<Source>& sources, const char* name, Index places)
{
  double largest = 0;
  for (const Source& source : sources)
  {
    vtkDataArray* array = source.Data->GetPointData()->GetArray(name);
    double range[2];
    for (int j = 0; array && j < array->GetNumberOfComponents(); ++j)
    {
      array->GetRange(range, j);
      largest = std::max({ largest, std::abs(range[0]), std::abs(range[1]) });
    }
  }
  std::vector<std::pair<vtkDataArray*, vtkIdType>> first(places);
  std::vector<Index> wrong;
  for (const Source& source : sources)
  {
    vtkDataArray* array = source.Data->GetPointData()->GetArray(name);
    for (std::size_t i = 0; array && i < source.Places.size(); ++i)
    {
      auto& [known, tuple] = first[source.Places[i]];
      if (!known)
      {
        known = array;
        tuple = static_cast<vtkIdType>(i);
        continue;
      }
      const int components =
        std::min(known->GetNumberOfComponents(), array->GetNumberOfComponents());
      for (int j = 0; j < components; ++j)
      {
        if (std::abs(known->GetComponent(tuple, j) -
                     array->GetComponent(static_cast<vtkIdType>(i), j)) > 1e-6 * largest)
        {
          wrong.push_back(source.Places[i]);
          break;
        }
      }
    }
  }
  return wrong;
}
}

vtkSmartPointer<vtkPolyData> Make(
  vtkDataObjectTree* data, const MergedBlocks* mesh, const char* subject, const char* agreeing)
{
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(data);
  const MergedBlocks* copied = isCopy(leaves, mesh) ? mesh : nullptr;
  const std::vector<Source> sources = sourcesOf(leaves, copied, subject);
  Index number = 0;
  for (const Source& source : sources)
  {
    number += static_cast<Index>(source.Places.size());
  }
  if (copied)
  {
    number = copied->Grid->GetNumberOfPoints();
  }
  const double tolerance = copied ? 1e-6 * sizeOf(sources) : 0;
  morph::Points positions(number, 3);
  for (Index i = 0; copied && i < number; ++i)
  {
    copied->Grid->GetPoint(static_cast<vtkIdType>(i), positions.row(i).data());
  }
  std::vector<std::uint8_t> isKnown(number, 0);
  std::vector<Index> torn;
  std::vector<vtkSmartPointer<vtkIdList>> lists;
  std::vector<BlockArrays::Part> parts;
  for (const Source& source : sources)
  {
    const auto from = vtkSmartPointer<vtkIdList>::New(), to = vtkSmartPointer<vtkIdList>::New();
    for (std::size_t i = 0; i < source.Places.size(); ++i)
    {
      const Index place = source.Places[i];
      const auto x = source.Points.row(static_cast<Index>(i));
      if (!isKnown[place])
      {
        isKnown[place] = 1;
        positions.row(place) = x;
        from->InsertNextId(static_cast<vtkIdType>(i));
        to->InsertNextId(static_cast<vtkIdType>(place));
      }
      else if ((x - positions.row(place)).norm() > tolerance)
      {
        torn.push_back(place);
      }
    }
    parts.push_back({ source.Data->GetPointData(), from, to });
    lists.push_back(from);
    lists.push_back(to);
  }
  if (!torn.empty())
  {
    refuse(subject, "positions", torn);
  }
  if (const auto wrong =
        agreeing ? contradictions(sources, agreeing, number) : std::vector<Index>();
      !wrong.empty())
  {
    refuse(subject, std::string("values of '") + agreeing + "'", wrong);
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  auto points = filters::Arrays::MakePoints(VTK_DOUBLE, number);
  for (Index i = 0; i < number; ++i)
  {
    points->SetPoint(i, positions.row(i).data());
  }
  result->SetPoints(points);
  BlockArrays::Merge(parts, number, result->GetPointData());
  if (copied)
  {
    result->GetPointData()->RemoveArray("MorphPointId");
  }
  result->GetFieldData()->ShallowCopy(data->GetFieldData());
  return result;
}
}
