// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>

namespace morph::filters
{
/// A selection in a window, whose surfaces a user wants to add to a list.
struct Picker
{
  vtkSmartPointer<vtkAlgorithm> Selection; ///< its first output is the selection; may be null
  int Port = -1;                           ///< of the filter's output that is selected; -1: input
  vtkNew<vtkDataArraySelection> Names;     ///< all, with those enabled that were found

  /// The data of `filter` that are selected, which may be null.
  vtkDataObject* Shown(vtkAlgorithm* filter) const
  {
    if (this->Port < 0)
    {
      return filter->GetInputDataObject(0, 0);
    }
    return this->Port < filter->GetNumberOfOutputPorts() ? filter->GetOutputDataObject(this->Port)
                                                         : nullptr;
  }

  /// The selection, up to date; null for none.
  vtkSelection* Update() const
  {
    if (!this->Selection)
    {
      return nullptr;
    }
    this->Selection->Update();
    return vtkSelection::SafeDownCast(this->Selection->GetOutputDataObject(0));
  }
};
}
