// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkMorphAlgorithm;

/// The morphing methods and their options by name; neither case nor "-", "_" and " " matter.
namespace morph_mesh
{
/// Throws UsageError for a name that is none.
vtkSmartPointer<vtkMorphAlgorithm> makeMethod(const std::string& name);

/// Throws UsageError for an option that the method does not have, and for a value that is none of
/// its.
void setOption(vtkMorphAlgorithm* method, const std::string& name, const std::string& value);

/// What to do about inverted cells: None, Report, SubStep, Repair, Refuse. Throws UsageError for
/// another name.
void setValidity(vtkMorphAlgorithm* method, const std::string& name);

/// For the help text.
std::string methodNames();
std::string optionNames();
}
