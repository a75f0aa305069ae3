// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

class vtkAlgorithm;

namespace morph_mesh
{
/// A line on standard error that shows the progress of an algorithm, from half a second on. It is
/// erased when the object is destroyed.
class ProgressBar
{
public:
  /// `always`: show it from the start, and even if standard error is no terminal.
  ProgressBar(vtkAlgorithm* algorithm, const std::string& label, bool always);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

private:
  void show(double fraction);

  vtkAlgorithm* algorithm_;
  std::string label_;
  bool always_;
  std::chrono::steady_clock::time_point start_;
  unsigned long tag_ = 0;
  int shown_ = -1; ///< per cent
};
}
