// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Chosen.h"

#include "Private/Displace/Selection.h"
#include "Support/Error.h"

#include <vtkDataArray.h>
#include <vtkImplicitFunction.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <tuple>
#include <utility>

namespace morph::filters
{
namespace
{
using Chosen::By;
using Chosen::Options;
using morph::Error;
using morph::Index;

std::vector<std::uint8_t> insideRegion(const BoundaryModel& model, vtkImplicitFunction* region)
{
  if (!region)
  {
    throw Error("No region is given in which nodes move: set `Region`, a box for instance.");
  }
  std::vector<std::uint8_t> isInside(model.points().rows(), 0);
  for (Index node : model.faces.nodes)
  {
    const Eigen::RowVector3d x = model.points().row(node);
    isInside[node] = region->FunctionValue(x[0], x[1], x[2]) <= 0;
  }
  return isInside;
}

std::vector<std::uint8_t> markedBy(vtkPointSet* input, const std::string& name)
{
  if (name.empty())
  {
    throw Error(
      "No array is named that marks what moves: set `MovingArray` to a point array of the "
      "input. Nodes move where it is not zero.");
  }
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw Error("`MovingArray` names '" + name + "', which is " +
                (array ? "not as long as the input has points." : "no point array of the input."));
  }
  return Chosen::Marked(array);
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
    throw Error("`MovingArray` is zero at all nodes of the boundary, so nothing would move.");
  }
  throw Error("No node of the boundary is inside the region that is to move. Make it larger, or "
              "move it to the boundary.");
}
}

namespace Chosen
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
    return std::tie(
      o.How, o.SelectionTime, o.Extractor, o.Surfaces, o.RegionTime, o.ArrayName, o.FixedSurfaces);
  };
  return all(*this) == all(other);
}

morph::Choice Choose(vtkPointSet* input, const BoundaryModel& model, const Options& options)
{
  if (options.How == By::Surfaces && options.Surfaces.empty())
  {
    throw Error(
      "No surface is chosen that is to move. Choose one in `Surfaces` (Apply once, and the "
      "list has their names), or choose in another way what moves.");
  }
  const auto all = [&](std::uint8_t value)
  { return std::vector<std::uint8_t>(model.points().rows(), value); };
  std::vector<std::uint8_t> isMoving;
  switch (options.How)
  {
    case By::Surfaces:
      return morph::choosePatches(model, options.Surfaces, options.FixedSurfaces);
    case By::Selection:
      isMoving = options.IsSelected
                   ? *options.IsSelected
                   : Selection::Points(input, options.Selection, options.Extractor);
      break;
    case By::Region:
      isMoving = insideRegion(model, options.Region);
      break;
    case By::Array:
      isMoving = markedBy(input, options.ArrayName);
      break;
    case By::Nothing:
      isMoving = all(0);
      break;
    case By::Everything:
      isMoving = all(1);
      break;
  }
  morph::Choice result = morph::chooseNodes(model, std::move(isMoving), options.FixedSurfaces);
  if (result.moving.empty() && options.How != By::Nothing)
  {
    refuseNone(options.How);
  }
  return result;
}
}
}
