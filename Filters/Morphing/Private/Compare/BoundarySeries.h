// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <vector>

class vtkDataObject;

namespace morph::filters
{
/// A source of boundaries that are kept in memory, each for its time.
class BoundarySeries : public vtkAlgorithm
{
public:
  static BoundarySeries* New();
  vtkTypeMacro(BoundarySeries, vtkAlgorithm);

  /// `times`: ascending, one for each boundary; none for a single boundary. All boundaries are of
  /// one class.
  void SetBoundaries(
    std::vector<double> times, std::vector<vtkSmartPointer<vtkDataObject>> boundaries);

protected:
  BoundarySeries();
  ~BoundarySeries() override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;

private:
  BoundarySeries(const BoundarySeries&) = delete;
  void operator=(const BoundarySeries&) = delete;

  void WriteTimes(vtkInformation* output) const;
  void WriteBoundary(vtkInformation* output) const;

  std::vector<double> Times;
  std::vector<vtkSmartPointer<vtkDataObject>> Boundaries;
};
}
