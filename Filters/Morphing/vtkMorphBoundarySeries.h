// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkMorphBoundarySeries_h
#define vtkMorphBoundarySeries_h

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <vector>

class vtkDataObject;

/// A source that hands out boundaries kept in memory, each at its time.
class vtkMorphBoundarySeries : public vtkAlgorithm
{
public:
  static vtkMorphBoundarySeries* New();
  vtkTypeMacro(vtkMorphBoundarySeries, vtkAlgorithm);

  /// Ascending times, and as many boundaries, of one class; a single one has no time.
  void SetBoundaries(
    std::vector<double> times, std::vector<vtkSmartPointer<vtkDataObject>> boundaries);

protected:
  vtkMorphBoundarySeries();
  ~vtkMorphBoundarySeries() override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;

private:
  vtkMorphBoundarySeries(const vtkMorphBoundarySeries&) = delete;
  void operator=(const vtkMorphBoundarySeries&) = delete;

  void WriteTimes(vtkInformation* output) const;
  void WriteBoundary(vtkInformation* output) const;

  std::vector<double> Times;
  std::vector<vtkSmartPointer<vtkDataObject>> Boundaries;
};

#endif
