// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkFieldData;

/// The string arrays of field data as one message: what VTK sends of them may not be read again, as
/// the records of an Exodus file.
namespace morph::filters::FieldTexts
{
/// Removes the string arrays and returns them as a message.
std::vector<char> Take(vtkFieldData* data);
/// Adds the arrays of a message.
void Add(const std::vector<char>& message, vtkFieldData* data);
}
