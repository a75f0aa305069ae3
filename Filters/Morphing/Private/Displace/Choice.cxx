// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Choice.h"

#include "Private/Displace/Selection.h"
#include "Support/Error.h"

#include <vtkDataArray.h>
#include <vtkImplicitFunction.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <tuple>

namespace morph::filters
{
namespace
{
using Choice::By;
using Choice::Options;
using morph::Error;
using morph::Index;
using Patches::Part;

Part patches(const BoundaryModel& model, const Options& options)
{
  if (options.Surfaces.empty())
  {
    throw Error("No surface is chosen that is to move. Choose one in Surfaces (Apply once, and the "
                "list has their names), or choose in another way what moves.");
  }
  return Patches::Find(model, options.Surfaces, "Surfaces");
}

std::vector<std::uint8_t> insideRegion(const BoundaryModel& model, vtkImplicitFunction* region)
{
  if (!region)
  {
    throw Error("No region is given in which nodes move: set Region, a box for instance.");
  }
  std::vector<std::uint8_t> isInside(model.Points().rows(), 0);
  for (Index node : model.Faces().nodes)
  {
    const Eigen::RowVector3d x = model.Points().row(node);
    isInside[node] = region->FunctionValue(x[0], x[1], x[2]) <= 0;
  }
  return isInside;
}

std::vector<std::uint8_t> markedBy(vtkPointSet* input, const std::string& name)
{
  if (name.empty())
  {
    throw Error("No array is named that marks what moves: set MovingArray to a point array of the "
                "input. Nodes move where it is not zero.");
  }
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw Error("MovingArray names '" + name + "', which is " +
                (array ? "not as long as the input has points." : "no point array of the input."));
  }
  return Choice::Marked(array);
}

void addNodesBetween(const morph::BoundaryFaces& faces, std::vector<std::uint8_t>& isChosen)
{
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index *begin = faces.between.begin(static_cast<Index>(i)),
                *end = faces.between.end(static_cast<Index>(i));
    if (begin != end && std::all_of(begin, end, [&](Index n) { return isChosen[n] != 0; }))
    {
      isChosen[faces.nodes[i]] = 1;
    }
  }
}

std::vector<std::uint8_t> facesWithin(
  const morph::BoundaryFaces& faces, const std::vector<std::uint8_t>& isChosen)
{
  std::vector<std::uint8_t> isWithin(faces.offsets.size() - 1);
  for (std::size_t f = 0; f < isWithin.size(); ++f)
  {
    isWithin[f] = std::all_of(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1], [&](Index n) { return isChosen[n] != 0; });
  }
  return isWithin;
}

[[noreturn]] void refuseNone(By how)
{
  if (how == By::Selection)
  {
    throw Error("None of the selected points, or of the points of the selected cells, is on the "
                "boundary of the input. Select something on its surface.");
  }
  if (how == By::Array)
  {
    throw Error("MovingArray is zero at all nodes of the boundary, so nothing would move.");
  }
  throw Error("No node of the boundary is inside the region that is to move. Make it larger, or "
              "move it to the boundary.");
}
}

namespace Choice
{
std::vector<std::uint8_t> Marked(vtkDataArray* array)
{
  std::vector<std::uint8_t> isMarked(array->GetNumberOfTuples(), 0);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int j = 0; j < array->GetNumberOfComponents(); ++j)
    {
      const double value = array->GetComponent(i, j);
      isMarked[i] = isMarked[i] || value < 0 || value > 0;
    }
  }
  return isMarked;
}

bool Options::operator==(const Options& other) const
{
  const auto all = [](const Options& o)
  {
    return std::tie(o.How, o.SelectionTime, o.Surfaces, o.RegionTime, o.ArrayName, o.FixedSurfaces);
  };
  return all(*this) == all(other);
}

bool Result::operator==(const Result& other) const
{
  return this->Moving == other.Moving && this->Held == other.Held &&
         this->IsMovingFace == other.IsMovingFace;
}

Result Choose(vtkPointSet* input, const BoundaryModel& model, const Options& options)
{
  const morph::BoundaryFaces& faces = model.Faces();
  Part part;
  switch (options.How)
  {
    case By::Surfaces:
      part = patches(model, options);
      break;
    case By::Selection:
      part.HasNode = options.IsSelected
                       ? *options.IsSelected
                       : Selection::Points(input, options.Selection, options.Extractor);
      break;
    case By::Region:
      part.HasNode = insideRegion(model, options.Region);
      break;
    case By::Array:
      part.HasNode = markedBy(input, options.ArrayName);
      break;
    case By::Nothing:
      part.HasNode.assign(model.Points().rows(), 0);
      break;
    case By::Everything:
      part.HasNode.assign(model.Points().rows(), 1);
      break;
  }
  if (options.How != By::Surfaces)
  {
    // Sheets inside move by their names alone.
    const std::vector<std::uint8_t> isOnSheet = model.NodesOnlyOn(model.Sheets());
    for (std::size_t n = 0; n < isOnSheet.size(); ++n)
    {
      part.HasNode[n] = part.HasNode[n] && !isOnSheet[n];
    }
  }
  addNodesBetween(faces, part.HasNode);
  const Part held = Patches::Find(model, options.FixedSurfaces, "FixedSurfaces");
  Result result;
  for (Index node : faces.nodes)
  {
    if (part.HasNode[node])
    {
      result.Moving.push_back(node);
    }
    else if (held.HasNode[node])
    {
      result.Held.push_back(node);
    }
  }
  if (result.Moving.empty() && options.How != By::Nothing)
  {
    refuseNone(options.How);
  }
  result.IsMovingFace =
    options.How == By::Surfaces ? std::move(part.HasFace) : facesWithin(faces, part.HasNode);
  return result;
}
}
}
