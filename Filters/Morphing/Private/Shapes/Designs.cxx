// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/Designs.h"

#include "Mesh/CellShape.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <vtkAbstractArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
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

Designs Designs::Read(vtkDataObject* data, const std::vector<std::string>& shapes,
  const std::vector<double>& others, const RankGroup& processes)
{
  Designs designs;
  std::vector<double> values;
  processes.Together(
    [&]
    {
      auto* table = vtkTable::SafeDownCast(data);
      if (!table)
      {
        throw morph::Error("The designs are no table. Read a file of comma-separated values.");
      }
      if (table->GetNumberOfRows() > 0)
      {
        designs.Take(table, shapes, others);
      }
      for (const std::vector<double>& row : designs.Rows)
      {
        values.insert(values.end(), row.begin(), row.end());
      }
    });
  processes.Share(values);
  if (values.empty())
  {
    throw morph::Error("The table of designs has no rows.");
  }
  designs.Rows.clear();
  const auto width = static_cast<std::ptrdiff_t>(others.size());
  for (auto row = values.begin(); row != values.end(); row += width)
  {
    designs.Rows.emplace_back(row, row + width);
  }
  return designs;
}

void Designs::Take(
  vtkTable* table, const std::vector<std::string>& shapes, const std::vector<double>& others)
{
  this->Rows.assign(table->GetNumberOfRows(), others);
  bool isAnyFound = false;
  for (std::size_t i = 0; i < shapes.size(); ++i)
  {
    vtkAbstractArray* column = table->GetColumnByName(shapes[i].c_str());
    isAnyFound = isAnyFound || column;
    for (vtkIdType row = 0; column && row < table->GetNumberOfRows(); ++row)
    {
      this->Rows[row][i] = weight(column, row, shapes[i]);
    }
  }
  if (!isAnyFound)
  {
    throw morph::Error("No column of the table of designs has the name of a shape; its columns "
                       "are " +
                       columnNames(table) + ". Name the shapes as the columns, or the reverse.");
  }
}

const std::vector<std::size_t>& Designs::Inverted(const ShapeModes& modes, morph::Monitor& monitor)
{
  const RankGroup& processes = modes.Group();
  const bool isKnown = !this->CheckedModes.empty() && this->CheckedModes == modes.Fields() &&
                       this->CheckedAngles == modes.Angles();
  if (!processes.Any(!isKnown))
  {
    return this->Bad;
  }
  this->CheckedModes.clear();
  this->Bad.clear();
  const morph::Mesh& mesh = modes.Mesh();
  std::vector<std::uint8_t> skip(mesh.numberOfCells());
  for (std::size_t c = 0; c < skip.size(); ++c)
  {
    skip[c] = morph::cellShape(mesh.types[c])->dimension < 3; // a process may have faces alone
  }
  std::vector<morph::Index> bad(this->Rows.size());
  const morph::InvertedBefore& before = modes.GetSolver()->Before(monitor);
  processes.Together(
    [&]
    {
      morph::Points moved;
      for (std::size_t row = 0; row < bad.size(); ++row)
      {
        monitor.check();
        monitor.progress(static_cast<double>(row) / static_cast<double>(bad.size()));
        morph::blend(mesh.points, modes.Weighted(this->Rows[row]), moved, monitor);
        morph::placeImages(mesh, moved);
        const morph::Quality quality =
          morph::measureQuality(mesh, moved, modes.Orientation(), skip, monitor);
        bad[row] =
          static_cast<morph::Index>(before.added(moved, morph::invertedCells(quality)).size());
      }
    });
  processes.Sum(bad.data(), bad.size());
  for (std::size_t row = 0; row < bad.size(); ++row)
  {
    if (bad[row] > 0)
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
