// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/Designs.h"

#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <vtkAbstractArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <cmath>
#include <utility>

namespace morph::filters
{
namespace
{
std::string columnNames(vtkTable* table)
{
  std::string names;
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i)
  {
    const char* name = table->GetColumnName(i);
    names += (names.empty() ? "" : ", ") + std::string(name ? name : "");
  }
  return names.empty() ? "none" : names;
}

double weight(vtkAbstractArray* column, vtkIdType row, const std::string& shape)
{
  bool valid = column->GetNumberOfComponents() == 1 && row < column->GetNumberOfTuples();
  const double value = valid ? column->GetVariantValue(row).ToDouble(&valid) : 0;
  if (!valid || !std::isfinite(value))
  {
    throw morph::Error("The table of designs has no finite number in row " + std::to_string(row) +
                       " of the column '" + shape + "'. Give each design a weight of each shape.");
  }
  return value;
}
}

Designs Designs::Read(
  vtkDataObject* data, const std::vector<std::string>& shapes, const std::vector<double>& others)
{
  auto* table = vtkTable::SafeDownCast(data);
  if (!table || table->GetNumberOfRows() == 0)
  {
    throw morph::Error(table ? "The table of designs has no rows."
                             : "The designs are no table. Read a file of comma-separated values.");
  }
  Designs designs;
  designs.Rows.assign(table->GetNumberOfRows(), others);
  bool isAnyFound = false;
  for (std::size_t i = 0; i < shapes.size(); ++i)
  {
    vtkAbstractArray* column = table->GetColumnByName(shapes[i].c_str());
    isAnyFound = isAnyFound || column;
    for (vtkIdType row = 0; column && row < table->GetNumberOfRows(); ++row)
    {
      designs.Rows[row][i] = weight(column, row, shapes[i]);
    }
  }
  if (!isAnyFound)
  {
    throw morph::Error("No column of the table of designs has the name of a shape; its columns "
                       "are " +
                       columnNames(table) + ". Name the shapes as the columns, or the reverse.");
  }
  return designs;
}

const std::vector<std::size_t>& Designs::Inverted(const ShapeModes& modes, morph::Monitor& monitor)
{
  if (!this->CheckedModes.empty() && this->CheckedModes == modes.Fields() &&
      this->CheckedAngles == modes.Angles())
  {
    return this->Bad;
  }
  this->CheckedModes.clear();
  this->Bad.clear();
  morph::Points moved;
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    monitor.check();
    monitor.progress(static_cast<double>(row) / static_cast<double>(this->Rows.size()));
    morph::blend(modes.GetKept().Mesh().points, modes.Weighted(this->Rows[row]), moved, monitor);
    if (!morph::invertedCells(modes.GetKept().Mesh(), moved, modes.GetKept().Orientation(), monitor)
           .empty())
    {
      this->Bad.push_back(row);
    }
  }
  this->CheckedModes = modes.Fields();
  this->CheckedAngles = modes.Angles();
  return this->Bad;
}

void Designs::KeepAnswer(Designs&& last)
{
  if (last.Rows == this->Rows)
  {
    this->Bad = std::move(last.Bad);
    this->CheckedModes = std::move(last.CheckedModes);
    this->CheckedAngles = std::move(last.CheckedAngles);
  }
}
}
