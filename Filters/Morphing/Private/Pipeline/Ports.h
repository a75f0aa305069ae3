// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Pipeline/Time.h"

#include <functional>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkUnstructuredGrid;

namespace morph::filters
{
class Monitor;

/// The pipeline passes of a filter with the undeformed mesh on port 0 and the moved boundary on
/// port 1: types, time, the frame round its work.
class Ports
{
public:
  /// `filter`: whose member this is.
  explicit Ports(vtkAlgorithm* filter)
    : Filter(filter)
  {
  }

  static int FillInformation(int port, vtkInformation* info);
  static int RequestInformation(
    vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  /// For RequestUpdateExtent: what the output port is asked for that `request` comes from.
  static vtkInformation* Asked(vtkInformation* request, vtkInformationVector* outputVector);
  /// The time that an output port is asked for.
  static std::optional<double> AskedTime(vtkInformation* output);
  /// `restTime`, `boundaryTime`: see Time.
  int RequestUpdateExtent(
    double restTime, std::optional<double> boundaryTime, vtkInformationVector** inputVector);

  struct Task
  {
    const char* Name; ///< what there may be too little memory for ("morph this mesh")
    int NumberOfThreads;
    /// Takes the filter's results back to those of no result.
    std::function<void()> Reset;
    /// Fills the output from the undeformed mesh and the boundary, which may be null.
    std::function<void(vtkUnstructuredGrid* grid, vtkDataObject* boundary, Monitor&)> Work;
    /// May be empty. Called after an error or abort, with the undeformed mesh (unchecked, of any
    /// type, null where it could not be had) and "Failed" or "Cancelled"; the outputs are empty.
    std::function<void(vtkDataObject* input, const char* status)> Undone = {};
  };
  /// Calls `task.Work`, on the one MPI process with cells if there are several. After what it
  /// throws the outputs are empty; errors and warnings are the filter's. Returns what RequestData
  /// has to.
  int RequestData(
    const Task& task, vtkInformationVector** inputVector, vtkInformationVector* outputVector);

  /// For the work of a task: what the input port has at another time, none for that of its own
  /// choice. A repeated execution would not do: VTK's executive goes on for ever where the input
  /// fails in one that continues another. Throws Error where it fails.
  vtkDataObject* Fetch(int port, std::optional<double> time) const;

private:
  vtkAlgorithm* Filter;
  filters::Time Time;
};
}
