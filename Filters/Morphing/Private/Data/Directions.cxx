// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Directions.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Dense>

#include <atomic>
#include <cmath>
#include <string>

namespace morph::filters
{
namespace
{
constexpr morph::Index Grain = 1024;

bool giveDirections(vtkDataArray* array)
{
  const int components = array->GetNumberOfComponents();
  if (components != 3 && components != 9)
  {
    return false;
  }
  bool any = false;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    double values[9];
    array->GetTuple(i, values);
    for (int first = 0; first < components; first += 3)
    {
      const double length = std::hypot(values[first], values[first + 1], values[first + 2]);
      if (length > 0 && std::abs(length - 1) > 1e-3)
      {
        return false;
      }
      any = any || length > 0;
    }
  }
  return any;
}

/// The names of such arrays, for a message.
std::string namesOf(vtkUnstructuredGrid* input)
{
  std::string names;
  for (vtkDataSetAttributes* data : { static_cast<vtkDataSetAttributes*>(input->GetPointData()),
         static_cast<vtkDataSetAttributes*>(input->GetCellData()) })
  {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = data->GetArray(i);
      if (array && array->GetName() && array != data->GetNormals() && giveDirections(array))
      {
        names += (names.empty() ? "'" : ", '") + std::string(array->GetName()) + "'";
      }
    }
  }
  return names;
}

/// Whether the rotation R of the deformation gradient F = R U is by more than a degree. Cells
/// without volume before or after have none.
bool turns(vtkIdList* nodes, const morph::Points& rest, const morph::Points& moved)
{
  const auto count = static_cast<double>(nodes->GetNumberOfIds());
  Eigen::RowVector3d from = Eigen::RowVector3d::Zero(), to = from;
  for (vtkIdType i = 0; i < nodes->GetNumberOfIds(); ++i)
  {
    from += rest.row(nodes->GetId(i)) / count;
    to += moved.row(nodes->GetId(i)) / count;
  }
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero(), cross = square;
  for (vtkIdType i = 0; i < nodes->GetNumberOfIds(); ++i)
  {
    const Eigen::RowVector3d before = rest.row(nodes->GetId(i)) - from;
    square += before.transpose() * before;
    cross += (moved.row(nodes->GetId(i)) - to).transpose() * before;
  }
  if (!(std::abs(square.determinant()) > 1e-20 * std::pow(square.trace(), 3)))
  {
    return false;
  }
  const Eigen::Matrix3d gradient = cross * square.inverse();
  // R is the rotation nearest to F, so that |R - 1| <= 2 |F - 1|; of a degree it is 0.0247.
  if (!((gradient - Eigen::Matrix3d::Identity()).norm() > 0.012) || !(gradient.determinant() > 0))
  {
    return false;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(gradient, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double trace = (svd.matrixU() * svd.matrixV().transpose()).trace();
  return trace < 1 + 2 * std::cos(std::acos(-1.) / 180);
}

bool anyTurns(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  morph::Monitor& monitor)
{
  std::atomic<bool> any = false;
  monitor.parallelFor(input->GetNumberOfCells(), Grain,
    [&](morph::Index first, morph::Index last)
    {
      vtkNew<vtkIdList> nodes;
      for (morph::Index c = first; c < last && !any; ++c)
      {
        input->GetCellPoints(c, nodes);
        any = any || turns(nodes, rest, moved);
      }
    });
  return any;
}
}

void Directions::RemoveNormals(vtkDataSet* moved)
{
  moved->GetPointData()->SetNormals(nullptr);
  moved->GetCellData()->SetNormals(nullptr);
}

void Directions::Warn(vtkUnstructuredGrid* input, const morph::Points& rest,
  const morph::Points& moved, morph::Monitor& monitor)
{
  const std::string names = namesOf(input);
  if (!names.empty() && anyTurns(input, rest, moved, monitor))
  {
    monitor.warn("Arrays hold vectors of unit length, such as normals or fibers, and stay as they "
                 "were, though cells turn by more than a degree: " +
                 names + ". Make them again for the morphed mesh.");
  }
}
}
