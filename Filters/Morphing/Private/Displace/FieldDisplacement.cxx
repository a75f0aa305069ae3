// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/FieldDisplacement.h"

#include "BoundaryMorphing/SurfaceResidual.h"
#include "Geometry/NearestNodes.h"
#include "Mesh/Mesh.h"
#include "Private/Data/DataCheck.h"
#include "Private/Displace/ControlPoints.h"
#include "Support/Error.h"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkGenericCell.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkTable.h>

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace morph::filters::FieldDisplacement
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;
using Row = Eigen::RowVector3d;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr Index Grain = 256;

/// The values nearest to the places, and how far away they are: infinite for none.
struct Nearest
{
  explicit Nearest(Index places)
    : Distance(places, Infinity)
    , Value(Points::Constant(places, 3, std::numeric_limits<double>::quiet_NaN()))
  {
  }
  void Take(Index place, double distance, const Row& value)
  {
    if (distance < this->Distance[place] && value.allFinite())
    {
      this->Distance[place] = distance;
      this->Value.row(place) = value;
    }
  }
  std::vector<double> Distance;
  Points Value;
};

/// Six numbers a point: its place and its displacement.
using Cloud = std::vector<double>;

vtkDataArray* vectorsOf(vtkDataSet* data, const std::string& name)
{
  vtkAbstractArray* any = data->GetPointData()->GetAbstractArray(name.c_str());
  auto* array = vtkDataArray::SafeDownCast(any);
  if (any && (!array || array->GetNumberOfComponents() != 3))
  {
    throw Error("`FieldArray` names '" + name + "', which " +
                (array ? "has " + std::to_string(array->GetNumberOfComponents()) +
                           " components; a displacement has three."
                       : "is not numeric."));
  }
  return array;
}

/// The cells of each type.
std::array<vtkIdType, 256> cellsOfTypes(vtkDataSet* data)
{
  std::array<vtkIdType, 256> count = {};
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    ++count[static_cast<unsigned char>(data->GetCellType(c))];
  }
  return count;
}

/// Whether the cells are points alone.
bool isCloud(const std::array<vtkIdType, 256>& types, vtkDataSet* data)
{
  return types[VTK_EMPTY_CELL] + types[VTK_VERTEX] + types[VTK_POLY_VERTEX] ==
         data->GetNumberOfCells();
}

/// VTK's cells read as many points as their type has, whether they are there or not.
void requireKnownCells(const std::array<vtkIdType, 256>& types, vtkDataSet* data)
{
  if (types[VTK_TRIANGLE_STRIP] > 0)
  {
    // VTK has no place on one whose triangles have no area, and reads beyond it.
    throw Error("The field has triangle strips. Apply Triangulate to it.");
  }
  std::array<vtkIdType, 256> sizes = {};
  for (int type = 0; type < 256; ++type)
  {
    const auto cell = vtkSmartPointer<vtkCell>::Take(
      types[type] > 0 ? vtkGenericCell::InstantiateCell(type) : nullptr);
    if (types[type] > 0 && !cell)
    {
      throw Error("The field has cells of the type " + std::to_string(type) +
                  ", which VTK does not know. Remove them.");
    }
    sizes[type] = cell ? cell->GetNumberOfPoints() : 0;
  }
  std::vector<Index> wrong;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    const vtkIdType size = sizes[static_cast<unsigned char>(data->GetCellType(c))];
    if (size > 0 && data->GetCellSize(c) != size)
    {
      wrong.push_back(c);
    }
  }
  if (!wrong.empty())
  {
    throw Error("The field has cells with too few or too many points for their type: cell ids " +
                morph::listIds(wrong) + ". Correct or remove them.");
  }
}

void requireFinitePoints(vtkDataSet* data)
{
  std::vector<Index> wrong;
  Row x;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    data->GetPoint(i, x.data());
    if (!morph::isModerate(x))
    {
      wrong.push_back(i);
    }
  }
  if (!wrong.empty())
  {
    throw Error("The field has points that are not finite or beyond 1e50: point ids " +
                morph::listIds(wrong) + ". Correct or remove them.");
  }
}

/// The cells of a data set, which VTK searches and evaluates.
class Cells
{
public:
  Cells(vtkDataSet* data, vtkDataArray* vectors)
    : Data(data)
    , Vectors(vectors)
    , Mask(data->GetPointData()->GetArray(DataCheck::MaskName))
    , Most(std::max(1, data->GetMaxCellSize()))
    , Rounding(1e-12 * data->GetLength())
  {
    if (!this->IsRegular())
    {
      this->Locator->SetDataSet(data);
      this->Locator->BuildLocator();
    }
    vtkNew<vtkGenericCell> first;
    data->GetCell(0, first); // what VTK makes of a first call, several threads would all make
  }

  void Find(const Points& places, double reach, Nearest& result, morph::Monitor& monitor) const
  {
    monitor.parallelFor(places.rows(), Grain,
      [&](Index first, Index last)
      {
        vtkNew<vtkGenericCell> cell;
        std::vector<double> weights(this->Most);
        for (Index i = first; i < last; ++i)
        {
          At at{ places.row(i), 0, { 0, 0, 0 } };
          if (this->IsRegular() ? !this->Clamp(at, cell, weights)
                                : !this->Search(at, reach, cell, weights))
          {
            continue;
          }
          const double distance = (places.row(i) - at.Place).norm();
          if (distance <= reach + this->Rounding)
          {
            result.Take(i, distance, this->Value(cell, at, weights));
          }
        }
      });
  }

private:
  /// A place in a cell.
  struct At
  {
    Row Place;
    int Part; ///< of the cell, as VTK numbers them
    double Parameters[3];
  };

  bool IsRegular() const
  {
    return vtkImageData::SafeDownCast(this->Data) || vtkRectilinearGrid::SafeDownCast(this->Data);
  }

  /// Moves the place to the nearest one of the data's box, and takes the cell there.
  bool Clamp(At& at, vtkGenericCell* cell, std::vector<double>& weights) const
  {
    if (auto* image = vtkImageData::SafeDownCast(this->Data))
    {
      double index[3]; // whose axes are those of the cells
      image->TransformPhysicalPointToContinuousIndex(at.Place.data(), index);
      const int* extent = image->GetExtent();
      for (int k = 0; k < 3; ++k)
      {
        index[k] = std::clamp(index[k], double(extent[2 * k]), double(extent[2 * k + 1]));
      }
      image->TransformContinuousIndexToPhysicalPoint(index, at.Place.data());
    }
    else
    {
      double bounds[6];
      this->Data->GetBounds(bounds);
      for (int k = 0; k < 3; ++k)
      {
        at.Place[k] = std::clamp(at.Place[k], bounds[2 * k], bounds[2 * k + 1]);
      }
    }
    const vtkIdType found = this->Data->FindCell(at.Place.data(), nullptr, -1,
      this->Rounding * this->Rounding, at.Part, at.Parameters, weights.data());
    if (found >= 0)
    {
      this->Data->GetCell(found, cell);
    }
    return found >= 0;
  }

  /// Moves the place to the nearest one of the cells, and takes that cell.
  bool Search(At& at, double reach, vtkGenericCell* cell, std::vector<double>& weights) const
  {
    Row x = at.Place;
    vtkIdType id = this->Locator.Get()->FindCell(
      x.data(), this->Rounding * this->Rounding, cell, at.Part, at.Parameters, weights.data());
    if (id >= 0 && cell->GetCellDimension() == 3)
    {
      return true; // which is sooner found than the nearest of all
    }
    int inside = 0;
    double square = 0;
    return this->Locator.Get()->FindClosestPointWithinRadius(x.data(), reach + this->Rounding,
             at.Place.data(), cell, id, at.Part, square, inside) != 0 &&
           cell->EvaluatePosition(
             at.Place.data(), nullptr, at.Part, at.Parameters, square, weights.data()) >= 0;
  }

  /// VTK's inverse of the shape functions ends at some 1e-6 of a cell's size. One more step does
  /// the rest, so that affine fields are exact: by the smallest change of the parameters, which
  /// there is in a collapsed cell, too.
  Row Value(vtkGenericCell* cell, const At& at, const std::vector<double>& weights) const
  {
    Row value = Row::Zero(), place = Row::Zero();
    Points values(cell->GetNumberOfPoints(), 3), corners(cell->GetNumberOfPoints(), 3);
    // The weights of polyhedra and points are exact, and points have no parameters.
    bool isInexact = cell->GetCellType() != VTK_POLYHEDRON && cell->GetCellDimension() > 0;
    for (Index k = 0; k < values.rows(); ++k)
    {
      const vtkIdType point = cell->GetPointId(k);
      this->Vectors->GetTuple(point, values.row(k).data());
      if (DataCheck::IsMissing(values.row(k), this->Mask, point))
      {
        if (std::abs(weights[k]) > 1e-12)
        {
          return Row::Constant(std::numeric_limits<double>::quiet_NaN());
        }
        isInexact = false;
        continue;
      }
      cell->GetPoints()->GetPoint(k, corners.row(k).data());
      value += weights[k] * values.row(k);
      place += weights[k] * corners.row(k);
    }
    if (isInexact && (at.Place - place).norm() > this->Rounding)
    {
      Points slopes = Points::Zero(values.rows(), 3); // a row of all nodes for each parameter
      cell->InterpolateDerivs(at.Parameters, slopes.data());
      const Eigen::Map<const Matrix> byParameter(
        slopes.data(), cell->GetCellDimension(), values.rows());
      const Matrix map = byParameter * corners;
      const Row step = at.Place - place;
      value +=
        map.transpose().completeOrthogonalDecomposition().solve(step.transpose()).transpose() *
        (byParameter * values);
    }
    return value;
  }

  vtkDataSet* Data;
  vtkDataArray *Vectors, *Mask;
  std::size_t Most; ///< points of a cell
  double Rounding;  ///< a place in a cell may be as far from it
  vtkNew<vtkStaticCellLocator> Locator;
};

void addCloud(vtkDataSet* data, vtkDataArray* vectors, Cloud& cloud)
{
  vtkDataArray* mask = data->GetPointData()->GetArray(DataCheck::MaskName);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    Row x, value;
    data->GetPoint(i, x.data());
    vectors->GetTuple(i, value.data());
    if (!DataCheck::IsMissing(value, mask, i))
    {
      cloud.insert(cloud.end(), x.data(), x.data() + 3);
      cloud.insert(cloud.end(), value.data(), value.data() + 3);
    }
  }
}

void findInCloud(
  const Cloud& cloud, const Points& places, double reach, Nearest& result, morph::Monitor& monitor)
{
  const auto count = static_cast<Index>(cloud.size() / 6);
  if (count == 0)
  {
    return;
  }
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> all(
    cloud.data(), count, 6);
  const Points at = all.leftCols<3>(), values = all.rightCols<3>();
  const morph::NearestNodes tree(at);
  std::vector<Index> near;
  std::vector<double> distances;
  for (Index i = 0; i < places.rows(); ++i)
  {
    const double distance = tree.distance(places.row(i));
    if (distance <= reach)
    {
      near.push_back(i);
      distances.push_back(distance);
    }
  }
  if (near.empty())
  {
    return;
  }
  morph::SurfaceResidual interpolation;
  interpolation.prepare(at, places(near, morph::allColumns), {}, monitor);
  Points moved;
  interpolation.evaluateLinear(values, moved, monitor);
  for (std::size_t k = 0; k < near.size(); ++k)
  {
    result.Take(near[k], distances[k], moved.row(static_cast<Index>(k)));
  }
}

/// The data sets of a field on this process.
std::vector<vtkDataSet*> leavesOf(vtkDataObject* field)
{
  std::vector<vtkDataSet*> leaves;
  const auto add = [&leaves](vtkDataObject* data)
  {
    auto* leaf = vtkDataSet::SafeDownCast(data);
    if (leaf && leaf->GetNumberOfPoints() > 0)
    {
      leaves.push_back(leaf);
    }
  };
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(field))
  {
    const auto block = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (block->InitTraversal(); !block->IsDoneWithTraversal(); block->GoToNextItem())
    {
      add(block->GetCurrentDataObject());
    }
    return leaves;
  }
  add(field);
  return leaves;
}

/// The names of the vector arrays, for a message; empty without data.
std::string namesIn(const std::vector<vtkDataSet*>& leaves)
{
  if (leaves.empty())
  {
    return {};
  }
  std::string names;
  for (int i = 0; i < leaves.front()->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = leaves.front()->GetPointData()->GetArray(i);
    if (array && array->GetNumberOfComponents() == 3 && array->GetName())
    {
      names += (names.empty() ? "" : ", ") + std::string(array->GetName());
    }
  }
  return names.empty() ? "The field has no vectors at points; ParaView's Cell Data to Point Data "
                         "makes them of those of cells."
                       : "The field's vectors at points are " + names + ".";
}
}

Points At(vtkDataObject* field, const std::string& name, const Points& places, double reach,
  const RankGroup& processes, morph::Monitor& monitor)
{
  std::string array = name;
  vtkSmartPointer<vtkDataObject> kept = field;
  Nearest nearest(places.rows());
  Cloud cloud;
  bool hasData = false, hasArray = false;
  std::string names;
  processes.Together(
    [&]
    {
      if (auto* table = vtkTable::SafeDownCast(field))
      {
        kept = ControlPoints::AsHandles(table, "The field's");
        array = "Displacement";
      }
      const std::vector<vtkDataSet*> leaves = leavesOf(kept);
      hasData = !leaves.empty();
      names = namesIn(leaves);
      for (vtkDataSet* leaf : leaves)
      {
        DataCheck::Require(leaf, "The field");
        vtkDataArray* vectors = vectorsOf(leaf, array);
        if (!vectors)
        {
          continue;
        }
        hasArray = true;
        requireFinitePoints(leaf);
        const auto types = cellsOfTypes(leaf);
        if (isCloud(types, leaf))
        {
          addCloud(leaf, vectors, cloud);
          continue;
        }
        requireKnownCells(types, leaf);
        Cells(leaf, vectors).Find(places, reach, nearest, monitor);
        monitor.check();
      }
    });
  if (!processes.Any(hasData))
  {
    throw Error("There is no field to take displacements from, or it has no points. Set one "
                "(`Field`): a mesh, an image or a table with displacements.");
  }
  processes.Share(names);
  if (!processes.Any(hasArray))
  {
    throw Error((name.empty() ? "No array is named that holds the field's displacements: set "
                                "`FieldArray`. "
                              : "`FieldArray` names '" + name +
                                  "', which the field does not have as a point array. ") +
                names);
  }
  const std::vector<double> everywhere = processes.Gather(cloud);
  processes.Together([&] { findInCloud(everywhere, places, reach, nearest, monitor); });

  // Row, distance and value of what this process has.
  std::vector<double> mine;
  for (Index i = 0; i < places.rows(); ++i)
  {
    if (nearest.Distance[i] < Infinity)
    {
      const Row value = nearest.Value.row(i);
      mine.insert(
        mine.end(), { static_cast<double>(i), nearest.Distance[i], value[0], value[1], value[2] });
    }
  }
  const std::vector<double> all = processes.Gather(mine);
  Nearest result(places.rows());
  for (std::size_t k = 0; k < all.size(); k += 5)
  {
    result.Take(static_cast<Index>(all[k]), all[k + 1], Row(all[k + 2], all[k + 3], all[k + 4]));
  }
  return result.Value;
}
}
