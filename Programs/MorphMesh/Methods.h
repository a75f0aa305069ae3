// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <utility>
#include <vector>

class vtkMorphAlgorithm;
class vtkMorphShapes;

/// The morphing methods and their options by name; neither case nor "-", "_" and " " matter.
namespace morph_mesh
{
/// Makes the method of that name. Throws UsageError for an unknown name.
vtkSmartPointer<vtkMorphAlgorithm> makeMethod(const std::string& name);

/// Sets an option. Throws UsageError for an option that the method does not have, and for a value
/// that the option does not accept.
void setOption(vtkMorphAlgorithm* method, const std::string& name, const std::string& value);

/// Sets the method of a blend of shapes, and its options. Throws UsageError for a method that is
/// not linear, and for other options than Tolerance.
void setShapesMethod(vtkMorphShapes* filter, const std::string& name,
  const std::vector<std::pair<std::string, std::string>>& options);

/// Sets the treatment of inverted cells: None, Report, SubStep, Repair, Refuse, RepairAll. Throws
/// UsageError for another name.
void setValidity(vtkMorphAlgorithm* method, const std::string& name);

/// For the help text.
std::string methodNames();
std::string optionNames();
}
