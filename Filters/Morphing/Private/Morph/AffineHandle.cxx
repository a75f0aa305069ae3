// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/AffineHandle.h"

#include "Private/Data/AffineArrays.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>

#include <algorithm>

namespace morph::filters
{
std::optional<AffineHandle> AffineHandle::Of(vtkPointSet* boundary,
  const BoundaryMatch::Result& match, const morph::Mesh& rest, double scale, bool isFloat)
{
  const auto found = AffineArrays::Read(boundary);
  if (!found || match.Ids.empty())
  {
    return {};
  }
  AffineHandle handle;
  handle.Motion = scale * found->Motion;
  handle.Fields = morph::AffineFields::Zero(match.Targets.rows(), 4);
  double size = match.Targets.cwiseAbs().maxCoeff(), before = 0;
  for (const morph::Index node : match.Ids)
  {
    before = std::max(before, rest.points.row(node).cwiseAbs().maxCoeff());
  }
  size += before;
  const bool isSingle = isFloat && boundary->GetPoints()->GetDataType() == VTK_FLOAT;
  const double tolerance = AffineArrays::Rounding(size, isSingle);
  auto* doubles = vtkDoubleArray::FastDownCast(found->Fields);
  const double* fields = doubles ? doubles->GetPointer(0) : nullptr;
  for (morph::Index i = 0; i < handle.Fields.rows(); ++i)
  {
    if (match.Sources[i] >= 0 && fields)
    {
      std::copy_n(fields + 4 * match.Sources[i], 4, handle.Fields.row(i).data());
    }
    else if (match.Sources[i] >= 0)
    {
      found->Fields->GetTuple(match.Sources[i], handle.Fields.row(i).data());
    }
    const Eigen::RowVector3d place = rest.points.row(match.Ids[i]) +
                                     morph::affineDisplacement(handle.Motion, handle.Fields.row(i));
    if (!((place - match.Targets.row(i)).cwiseAbs().maxCoeff() <= tolerance)) // NaN, too
    {
      return {};
    }
  }
  return handle;
}
}
