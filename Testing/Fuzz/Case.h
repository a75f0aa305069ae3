// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Properties.h"
#include "RandomBoundary.h"
#include "RandomGrid.h"

#include <vtkAlgorithm.h>

#include <string>
#include <vector>

namespace fuzz
{
/// One filter's input data and properties.
class Case
{
public:
  Case(Choices& choices, const Filter& filter);
  /// A new filter with the inputs and properties of this case. `threads`: 0 for those of the case.
  vtkSmartPointer<vtkAlgorithm> makeFilter(int threads = 0);
  /// The same with other inputs.
  vtkSmartPointer<vtkAlgorithm> makeFilter(
    const std::vector<vtkSmartPointer<vtkDataObject>>& data, int threads);

  Choices& choices;
  const Filter& filter;
  RandomGrid grid;
  RandomBoundary boundary;
  /// of ports 0, 1, ...; of vtkMorphShapes all but the first are of port 1
  std::vector<vtkSmartPointer<vtkDataObject>> inputs;
  vtkSmartPointer<vtkAlgorithm> varying; ///< on port 1 in place of its data; null for none
  double time = -1;                      ///< that is asked for; none if negative
  /// properties are in range, and inputs other than grid and boundary are right
  bool isRegular = true;

  std::string acceptedProperty; ///< see PropertiesSet

private:
  void vary();
  void addShapes();
  void setNames(vtkAlgorithm* algorithm);
};

/// What a filter did and said in an execution.
struct Run
{
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  std::vector<std::string> fromExecutive; ///< errors of the pipeline itself
  std::vector<std::string> fromOthers;    ///< what VTK's other classes said
  std::vector<double> progress;
  std::vector<vtkSmartPointer<vtkDataObject>> outputs;
};

/// Executes the filter; outputs are copies. `time`: as in Case. `abortAt`: progress at which it is
/// told to stop.
Run execute(vtkAlgorithm* filter, double time, double abortAt = 2);
}
