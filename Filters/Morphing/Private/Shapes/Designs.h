// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkTable;

namespace morph
{
class Monitor;
}

namespace morph::filters
{
class RankGroup;
class ShapeModes;

/// A table of designs: a weight for each shape in each row.
class Designs
{
public:
  /// Reads a vtkTable. A shape's weights are in the column of its name; a shape without a column
  /// has its weight of `others` in every row. Both #shapes. Throws morph::Error for other data than
  /// a table, and for a table without rows or without a column of any shape. Values that are no
  /// finite numbers are errors that name row and column. `processes`: all of them get the rows of
  /// the first whose table has some, as where one alone has read the file.
  static Designs Read(vtkDataObject* table, const std::vector<std::string>& shapes,
    const std::vector<double>& others, const RankGroup& processes);

  std::size_t Number() const { return this->Rows.size(); }
  const std::vector<double>& operator[](std::size_t row) const { return this->Rows[row]; }

  /// The rows that make inverted or degenerate cells. The last answer is kept for the same rows
  /// and shapes. Cost: a blend and a measure of quality for each row.
  const std::vector<std::size_t>& Inverted(const ShapeModes& modes, morph::Monitor& monitor);
  /// Takes over the answer of `last` where that is for the same rows.
  void KeepAnswer(Designs&& last);

private:
  void Take(
    vtkTable* table, const std::vector<std::string>& shapes, const std::vector<double>& others);

  std::vector<std::vector<double>> Rows;
  std::vector<std::size_t> Bad; ///< of CheckedModes
  std::vector<std::shared_ptr<const morph::Points>> CheckedModes;
  std::vector<double> CheckedAngles;
};
}
