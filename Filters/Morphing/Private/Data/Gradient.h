// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <vtkType.h>

#include <functional>
#include <vector>

class vtkDataArray;
class vtkDoubleArray;

/// Conversion of an objective's derivatives between VTK's arrays and the core.
namespace morph::filters::Gradient
{
/// The array as #nodes x 3, with zeros where a node does not count. Throws morph::Error where it is
/// null or of another size, or holds values that are not finite, naming their node ids.
morph::Points Require(
  vtkDataArray* gradient, vtkIdType nodes,
  const std::function<bool(morph::Index node)>& counts = [](morph::Index) { return true; });

/// Sums the derivatives of prescribed nodes for each boundary point. `prescribed`: #prescribed x 3.
/// `sources`: #prescribed, each node's boundary point, or -1. `result`: becomes #points tuples,
/// each the sum over the nodes that follow the point. Throws morph::Error where `prescribed` is not
/// finite.
void Gather(const morph::Points& prescribed, const std::vector<morph::Index>& sources,
  vtkIdType points, vtkDoubleArray* result);
}
