// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkMorphTime_h
#define vtkMorphTime_h

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <optional>

class vtkDataObject;
class vtkInformation;

/// The rest mesh at one time, the boundary at the time that is asked for.
///
/// If both ports hang on one reader, fetching the boundary leaves the reader's output, which is
/// port 0's data, at the boundary's time. Such an execution is repeated: once with both ports at
/// rest, when a shallow copy of the mesh is taken, and once more with the boundary at its time. If
/// both ports are fed by one port of the reader, they can only be asked for one time at once, and
/// the second half of that is done from the start.
class vtkMorphTime
{
public:
  /// The output's time steps and range: the boundary's, or none.
  static void CopySteps(vtkInformation* boundary, vtkInformation* output);
  /// The output's data time: the boundary's, or none.
  static void CopyDataTime(vtkDataObject* boundary, vtkDataObject* output);

  /// For RequestUpdateExtent: sets the times that the two ports are asked for, the boundary
  /// `boundaryTime`, or none. The rest step is the last of the mesh's time steps that is not after `restTime`,
  /// or the first. `meshTime`: when the pipeline behind the mesh was last modified.
  void Request(double restTime, vtkMTimeType meshTime, std::optional<double> boundaryTime,
    vtkInformation* mesh, vtkInformation* boundary);

  /// For RequestData: the mesh at rest, `mesh` itself as a rule; or null where the execution has to
  /// be repeated, which `request` then says. On several MPI ranks all repeat, or none.
  vtkSmartPointer<vtkDataObject> TakeRest(vtkDataObject* mesh, vtkInformation* request);

private:
  bool HasRestStep = false;
  double RestStep = 0;
  vtkMTimeType MeshTime = 0;
  bool BothAtRest = false;             ///< the pass under way
  vtkSmartPointer<vtkDataObject> Rest; ///< for the pass to come
};

#endif
