// SPDX-License-Identifier: BSD-3-Clause
#include "Messages.h"

#include "Properties.h"
#include "Report.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <iostream>

namespace morph_mesh
{
namespace
{
/// Without "ERROR: In vtkX.cxx, line 1\nvtkX (0x1): " and the empty lines at the end, and with
/// options for properties.
std::string bare(const char* message)
{
  std::string text = message ? message : "";
  const std::size_t object = text.find("): ");
  if (object != std::string::npos)
  {
    text.erase(0, object + 3);
  }
  else if (text.rfind("Generic Warning: In ", 0) == 0) // no object said it
  {
    text.erase(0, text.find('\n') + 1);
  }
  text.erase(text.find_last_not_of(" \n") + 1);
  return inOptions(text);
}

void keep(vtkObject*, unsigned long, void* list, void* message)
{
  static_cast<std::vector<std::string>*>(list)->push_back(bare(static_cast<const char*>(message)));
}

ConsoleMessages* listener = nullptr;

class Console : public vtkOutputWindow
{
public:
  static Console* New();
  vtkTypeMacro(Console, vtkOutputWindow);
  void DisplayText(const char* text) override
  {
    // VTK has generic warnings, as of a number that it cannot read, where no object could err.
    const bool warning = this->GetCurrentMessageType() == MESSAGE_TYPE_WARNING;
    if (listener)
    {
      (warning ? listener->warnings : listener->errors).push_back(bare(text));
    }
    else
    {
      std::cerr << "morph-mesh: " << (warning ? "warning: " : "") << bare(text) << "\n";
    }
  }
};

vtkStandardNewMacro(Console);

void ignore(vtkObject*, unsigned long, void*, void*)
{
}
}

void installConsole()
{
  vtkOutputWindow::SetInstance(vtkNew<Console>());
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF); // would say it once more
}

ConsoleMessages::ConsoleMessages()
{
  listener = this;
}

ConsoleMessages::~ConsoleMessages()
{
  listener = nullptr;
}

Messages::Messages(vtkAlgorithm* algorithm)
  : algorithm_(algorithm)
{
  const auto observe = [&](unsigned long event, std::vector<std::string>& list)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(keep);
    command->SetClientData(&list);
    this->tags_.push_back(algorithm->AddObserver(event, command));
  };
  observe(vtkCommand::ErrorEvent, this->errors_);
  observe(vtkCommand::WarningEvent, this->warnings_);
  // After an error of a reader the executive only repeats that it failed.
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(ignore);
  this->executiveTag_ = algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, command);
}

Messages::~Messages()
{
  for (const unsigned long tag : this->tags_)
  {
    this->algorithm_->RemoveObserver(tag);
  }
  this->algorithm_->GetExecutive()->RemoveObserver(this->executiveTag_);
}

void Messages::update(const std::string& task)
{
  this->algorithm_->Update();
  if (!this->errors_.empty())
  {
    throw Failure(task + ": " + this->errors_.front());
  }
}

std::string Messages::updatePartly(const std::string& task)
{
  this->algorithm_->Update();
  // After any other error the output is the undeformed mesh.
  const std::string status = outcomeOf(this->algorithm_).status;
  const bool isPart = status == "Partial" || status == "Inverted";
  if (!this->errors_.empty() && !isPart)
  {
    throw Failure(task + ": " + this->errors_.front());
  }
  std::string text;
  for (const std::string& error : this->errors_)
  {
    text += (text.empty() ? "" : "\n") + error;
  }
  return text;
}
}
