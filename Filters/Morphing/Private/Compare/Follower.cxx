// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Compare/Follower.h"

#include <vtkAlgorithm.h>

namespace morph::filters
{
namespace
{
std::string withoutOrigin(const std::string& message)
{
  const auto end = message.find("): ");
  std::string text = end == std::string::npos ? message : message.substr(end + 3);
  text.erase(text.find_last_not_of(" \n") + 1);
  return text;
}
}

Follower::Follower(vtkAlgorithm* filter, morph::Monitor& monitor)
  : Filter(filter)
  , Monitor(monitor)
{
  filter->SetAbortExecute(0); // of an earlier execution
  this->Command->SetClientData(this);
  this->Command->SetCallback(Follower::Called);
  for (const auto event :
    { vtkCommand::ErrorEvent, vtkCommand::WarningEvent, vtkCommand::ProgressEvent })
  {
    this->Tags.push_back(filter->AddObserver(event, this->Command));
  }
}

Follower::~Follower()
{
  for (const unsigned long tag : this->Tags)
  {
    this->Filter->RemoveObserver(tag);
  }
}

void Follower::Called(vtkObject*, unsigned long event, void* self, void* data)
{
  auto* follower = static_cast<Follower*>(self);
  if (event == vtkCommand::ProgressEvent)
  {
    follower->Monitor.progress(*static_cast<double*>(data));
    follower->Filter->SetAbortExecute(follower->Monitor.cancelled());
  }
  else
  {
    (event == vtkCommand::ErrorEvent ? follower->ErrorTexts : follower->WarningTexts)
      .push_back(withoutOrigin(static_cast<const char*>(data)));
  }
}
}
