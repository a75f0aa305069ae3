// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Property.h"

#include <vtkObject.h>

#include <cmath>

namespace morph::filters
{
namespace Property
{
bool Accepts(vtkObject* filter, const char* property, double value, double current, double minimum,
  double maximum)
{
  const bool isAccepted = std::isfinite(value) && value >= minimum && value <= maximum;
  if (!isAccepted)
  {
    vtkErrorWithObjectMacro(filter, << property << " cannot be " << value
                                    << ". Give it a number in [" << minimum << ", " << maximum
                                    << "]; it stays " << current << ".");
  }
  return isAccepted;
}

bool Accepts(vtkObject* filter, const char* property, double value, double current)
{
  const bool isAccepted = std::isfinite(value);
  if (!isAccepted)
  {
    vtkErrorWithObjectMacro(filter, << property << " cannot be " << value
                                    << ". Give it a finite number; it stays " << current << ".");
  }
  return isAccepted;
}
}
}
