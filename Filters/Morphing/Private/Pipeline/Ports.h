// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/Blocks.h"
#include "Private/Data/Unchanged.h"
#include "Private/Pipeline/Time.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkUnstructuredGrid;

namespace morph::filters
{
class Monitor;

/// The pipeline passes of a filter with the undeformed mesh on port 0 and the moved boundary on
/// port 1. It checks types, asks for times, and frames the filter's work.
class Ports
{
public:
  /// `filter`: the owner of this object.
  explicit Ports(vtkAlgorithm* filter)
    : Filter(filter)
  {
  }

  static int FillInformation(int port, vtkInformation* info);
  /// The mesh, of the input's type, its bad cells, its surface, and control points, which are
  /// polygonal data.
  static int FillOutputInformation(int port, vtkInformation* info);
  /// For ProcessRequest of a filter whose output 0 is of that type: answers REQUEST_DATA_OBJECT.
  /// Returns whether `request` is that.
  static bool MakeOutput(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector);
  static int RequestInformation(
    vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  /// For RequestUpdateExtent: the information of the output port that `request` comes from.
  static vtkInformation* Asked(vtkInformation* request, vtkInformationVector* outputVector);
  /// The time that an output port is asked for.
  static std::optional<double> AskedTime(vtkInformation* output);
  /// For RequestUpdateExtent of a filter that takes an input at the input's own time: asks for all
  /// of it. The executive would ask for the extent of port 0's.
  static void AskForAll(vtkInformation* input);
  /// `restTime`, `boundaryTime`: see Time.
  int RequestUpdateExtent(
    double restTime, std::optional<double> boundaryTime, vtkInformationVector** inputVector);

  struct Task
  {
    const char* Name; ///< the words after "not enough memory to" ("morph this mesh")
    int NumberOfThreads;
    int CoincidentPoints; ///< of the blocks of a composite mesh, Blocks::CoincidentPoints
    /// Resets the filter's results to those of no result.
    std::function<void()> Reset;
    /// Fills the output from the undeformed mesh and the boundary, which may be null, and which
    /// AsOne() has made one data set. `isDistributed`: several MPI processes have pieces. It is
    /// then called on all of them, communicates, and throws on all of them alike.
    std::function<void(
      vtkUnstructuredGrid* grid, vtkDataObject* boundary, bool isDistributed, Monitor&)>
      Work;
    /// May be empty. Called after an error or abort, with the undeformed mesh and "Failed" or
    /// "Cancelled"; the outputs are empty. The mesh is unchecked, of any type, null where it is not
    /// available, and one grid where its blocks could be merged.
    std::function<void(vtkDataObject* input, const char* status)> Undone = {};
    /// Whether the mesh counts as distributed on several processes, wherever it is, so that all of
    /// them do the work.
    bool IsForAll = false;
  };
  /// The grid that the work of a task fills for output 0, which may be composite.
  vtkUnstructuredGrid* Output(vtkInformationVector* outputVector)
  {
    return this->Mesh.Output(outputVector);
  }
  /// Gives Output() to output 0. RequestData() does it, too.
  void WriteOutput(vtkInformationVector* outputVector) { this->Mesh.Scatter(outputVector); }

  /// Calls `task.Work`: on the one MPI process with cells or, if several have cells or others than
  /// that one have a boundary, on all.
  /// After an exception the outputs are empty; errors and warnings are the filter's. Returns the
  /// result of RequestData.
  int RequestData(
    const Task& task, vtkInformationVector** inputVector, vtkInformationVector* outputVector);

  /// For the work of a task: composite data of another port than the mesh's as one data set, which
  /// this object keeps until the next execution; see BlockPoints. Other data are returned as they
  /// are. `agreeing`: see there.
  vtkDataObject* AsOne(
    vtkDataObject* data, const char* subject, const char* agreeing = nullptr) const;

  /// For the work of a task: updates an input port to another time and returns its data; no time
  /// means the input's own choice. A boundary goes through AsOne(). Repeating the execution instead
  /// would not do: VTK's executive never ends where the input fails in a repetition. Throws Error
  /// where the input fails.
  vtkDataObject* Fetch(int port, std::optional<double> time) const;

private:
  vtkDataObject* Update(int port, std::optional<double> time) const;

  vtkAlgorithm* Filter;
  filters::Time Time;
  Blocks Mesh;
  Unchanged Checked;                                        ///< the mesh, as one grid
  mutable std::vector<vtkSmartPointer<vtkDataObject>> Made; ///< by AsOne()
};
}
