// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/InputBoundary.h"

#include <vtkAlgorithm.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>

#include <set>
#include <string>
#include <vector>

class vtkDataSet;
class vtkExtractSelection;
class vtkPolyData;

namespace morph::filters
{
class Blocks;

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

/// From a selection in a view to surfaces, and from surfaces to what a view shows of them.
namespace morph::filters::Pick
{
/// The numbers of the surfaces that a selection lies on, ascending. `shown`: the data that the
/// selection is of: the mesh, undeformed or morphed, or its boundary as a grid or as polygons. Its
/// points are the mesh's, or have MorphPointId.
///
/// A selected volume cell lies on the surfaces of its boundary faces, a selected face on its own,
/// and a selected point on those of its faces. At an edge that is more than one. Surfaces are
/// therefore taken one by one, the one first on which most of what is left lies, until each
/// selected item on the boundary lies on one of them. Of equal ones the first is that with more
/// selected faces, then that with the lower number. Throws morph::Error as Selection::Evaluate()
/// does. Cost: that of the extractor, a pass over the faces and, for selected faces, their sort.
std::vector<morph::Index> Surfaces(vtkDataSet* shown, vtkSelection* selection,
  vtkExtractSelection* extractor, const InputBoundary& model);

/// Writes into `names` all names of surfaces and curves, and enables those of Surfaces(). Nothing
/// is enabled where there is no selection. `blocks`: of composite data, which `shown` then is too.
/// Throws as that does and as Selection::Translate(), where `shown` has no points, and where the
/// model is empty.
void Find(vtkDataObject* shown, vtkSelection* selection, vtkExtractSelection* extractor,
  const Blocks& blocks, const InputBoundary& model, vtkDataArraySelection* names);

/// See vtkDisplacementAlgorithm::DescribeDimension().
std::string DimensionOf(const InputBoundary& model, vtkDataArraySelection* names);

/// The names of patches that are enabled.
std::set<std::string> Enabled(const InputBoundary& model, vtkDataArraySelection* names);

/// Makes `output` the polygons of the surfaces and the lines of the curves that `names` enables;
/// unknown names are left out. Its points are those of model.Surface(), at `positions` if that has
/// as many. Cost: a pass over the faces.
void Write(const InputBoundary& model, vtkDataArraySelection* names, vtkPolyData* positions,
  vtkPolyData* output);
}
