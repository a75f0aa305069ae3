// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Property.h"

#include <cmath>
#include <sstream>

namespace morph::filters
{
bool Property::Accepts(vtkObject* filter, const char* property, double value, double current,
  double minimum, double maximum)
{
  const bool isAccepted = std::isfinite(value) && value >= minimum && value <= maximum;
  if (!isAccepted)
  {
    std::ostringstream range;
    range << "a finite number";
    if (minimum > -Any)
    {
      range.str("");
      range << "a number in [" << minimum << ", " << maximum << "]";
    }
    vtkErrorWithObjectMacro(filter, << property << " cannot be " << value << ". Give it "
                                    << range.str() << "; it stays " << current << ".");
  }
  return isAccepted;
}
}
