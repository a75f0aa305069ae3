// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace benchmark
{
/// What a figure is held against.
struct Target
{
  enum class Kind
  {
    None,
    AtLeast,
    AtMost
  };
  Kind kind = Kind::None;
  double value = 0;

  static Target none() { return {}; }
  static Target atLeast(double value) { return { Kind::AtLeast, value }; }
  static Target atMost(double value) { return { Kind::AtMost, value }; }
};

/// Figures of one run, in the order they were added.
class Report
{
public:
  void add(const std::string& figure, double measured, const std::string& unit,
    Target target = Target::none());

  /// An aligned table of figure, target, measured and met: first those with a target, then the
  /// others.
  std::string table() const;
  /// Columns figure, unit, relation, target, measured, met. Throws std::runtime_error if the file
  /// cannot be written.
  void writeCsv(const std::string& file) const;

private:
  struct Row
  {
    std::string figure;
    double measured;
    std::string unit;
    Target target;
  };
  std::vector<Row> rows_;
};
}
