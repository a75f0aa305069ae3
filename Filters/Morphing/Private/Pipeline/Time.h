// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkInformation;
class vtkInformationVector;

namespace morph
{
class Monitor;
}

namespace morph::filters
{
/// Gives the undeformed mesh at one time, and the boundary at the time that is asked for.
///
/// If one reader feeds both ports, fetching the boundary leaves the reader's output, which is port
/// 0's data, at the boundary's time. Then the mesh is fetched again, and the boundary once more
/// after a shallow copy of the mesh was taken. If one port of the reader feeds both ports, they can
/// only be asked for one time at once. They are asked for the mesh's time, and the boundary is
/// fetched after the copy.
class Time
{
public:
  /// The output's time steps and range: the boundary's, or none.
  static void CopySteps(vtkInformation* boundary, vtkInformation* output);
  /// The output's data time: the boundary's, or none.
  static void CopyDataTime(vtkDataObject* boundary, vtkDataObject* output);

  /// Sets the time that an input is asked for, or none.
  static void Ask(vtkInformation* input, std::optional<double> time);

  /// For RequestUpdateExtent of a filter with a mesh and no boundary: asks for the last of the
  /// mesh's time steps that is not after `restTime`, or the first. Returns that time, if any.
  static std::optional<double> AskRest(double restTime, vtkInformation* mesh);

  /// Warns of inputs with several time steps that are taken at one. `names`: of each port what it
  /// has; empty for one that is left out. `output`: whose time they follow, if it varies in time;
  /// null where they follow none.
  static void WarnOfSeries(vtkInformationVector** inputVector, vtkInformation* output,
    const std::vector<std::string>& names, morph::Monitor& monitor);

  /// For RequestUpdateExtent: sets the times that the two ports are asked for. The boundary is
  /// asked for `boundaryTime`, or for none. The mesh is asked for the last of its time steps that
  /// is not after `restTime`, or the first.
  void Request(double restTime, std::optional<double> boundaryTime, vtkInformation* mesh,
    vtkInformation* boundary);

  /// Updates an input port, for a time or for none, and returns its data.
  using Fetch = std::function<vtkDataObject*(int port, std::optional<double> time)>;
  /// For RequestData: returns the undeformed mesh, `mesh` itself or, if the mesh varies, a shallow
  /// copy. On several MPI ranks all fetch again, or none. Afterwards the boundary's data are at its
  /// time, and may be another object than before.
  vtkSmartPointer<vtkDataObject> TakeRest(vtkDataObject* mesh, const Fetch& fetch) const;

private:
  bool OnePort = false;
  std::optional<double> RestStep;
  std::optional<double> BoundaryTime;
};
}
