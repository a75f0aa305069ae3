// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/FieldTexts.h"

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <string>

namespace morph::filters::FieldTexts
{
namespace
{
void put(const std::string& text, std::vector<char>& message)
{
  message.insert(message.end(), text.c_str(), text.c_str() + text.size() + 1);
}

std::string get(std::vector<char>::const_iterator& at, std::vector<char>::const_iterator end)
{
  const auto last = std::find(at, end, '\0');
  const std::string text(at, last);
  at = last == end ? last : last + 1;
  return text;
}
}

std::vector<char> Take(vtkFieldData* data)
{
  std::vector<char> message;
  for (int i = data->GetNumberOfArrays(); i-- > 0;)
  {
    auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(i));
    if (!array)
    {
      continue;
    }
    put(array->GetName() ? array->GetName() : "", message);
    put(std::to_string(array->GetNumberOfComponents()), message);
    put(std::to_string(array->GetNumberOfValues()), message);
    for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k)
    {
      put(array->GetValue(k), message);
    }
    data->RemoveArray(i);
  }
  return message;
}

void Add(const std::vector<char>& message, vtkFieldData* data)
{
  for (auto at = message.begin(); at != message.end();)
  {
    vtkNew<vtkStringArray> array;
    array->SetName(get(at, message.end()).c_str());
    array->SetNumberOfComponents(std::stoi(get(at, message.end())));
    const auto count = static_cast<vtkIdType>(std::stoll(get(at, message.end())));
    for (vtkIdType k = 0; k < count; ++k)
    {
      array->InsertNextValue(get(at, message.end()));
    }
    data->AddArray(array);
  }
}
}
