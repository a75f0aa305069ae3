// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Gradient.h"

#include "Private/Data/GridMesh.h"
#include "Support/Error.h"

#include <vtkDoubleArray.h>

#include <string>

namespace morph::filters
{
namespace Gradient
{
morph::Points Require(
  vtkDataArray* gradient, vtkIdType nodes, const std::function<bool(morph::Index node)>& counts)
{
  if (!gradient)
  {
    throw morph::Error(
      "There is no gradient: a point array is needed with three components, the derivatives of "
      "the objective with respect to the position of each node.");
  }
  if (gradient->GetNumberOfComponents() != 3 || gradient->GetNumberOfTuples() != nodes)
  {
    throw morph::Error("The gradient has " + std::to_string(gradient->GetNumberOfTuples()) +
                       " tuples of " + std::to_string(gradient->GetNumberOfComponents()) +
                       "; the mesh needs " + std::to_string(nodes) + " of 3, one for each node.");
  }
  morph::Points result = GridMesh::FromVectors(gradient);
  std::vector<morph::Index> notFinite;
  for (morph::Index n = 0; n < result.rows(); ++n)
  {
    if (!counts(n))
    {
      result.row(n).setZero();
    }
    else if (!result.row(n).allFinite())
    {
      notFinite.push_back(n);
    }
  }
  if (!notFinite.empty())
  {
    throw morph::Error("The gradient is not finite (NaN or infinite) at node ids " +
                       morph::listIds(notFinite) + ".");
  }
  return result;
}

void Gather(const morph::Points& prescribed, const std::vector<morph::Index>& sources,
  vtkIdType points, vtkDoubleArray* result)
{
  if (!prescribed.allFinite())
  {
    throw morph::Error("The gradient with respect to the boundary is not finite. Scale the "
                       "objective, so that its derivatives are smaller.");
  }
  result->SetNumberOfComponents(3);
  result->SetNumberOfTuples(points);
  result->Fill(0);
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    if (sources[k] < 0)
    {
      continue;
    }
    double* sum = result->GetPointer(3 * sources[k]);
    for (int j = 0; j < 3; ++j)
    {
      sum[j] += prescribed(static_cast<morph::Index>(k), j);
    }
  }
}
}
}
