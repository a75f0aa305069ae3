// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressBar.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>

#include <unistd.h>

#include <cmath>
#include <iostream>

namespace morph_mesh
{
ProgressBar::ProgressBar(vtkAlgorithm* algorithm, const std::string& label, bool always)
  : algorithm_(algorithm)
  , label_(label)
  , always_(always)
  , start_(std::chrono::steady_clock::now())
{
  if (!always && !isatty(STDERR_FILENO))
  {
    return;
  }
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(this);
  command->SetCallback([](vtkObject*, unsigned long, void* bar, void* fraction)
    { static_cast<ProgressBar*>(bar)->show(*static_cast<double*>(fraction)); });
  this->tag_ = algorithm->AddObserver(vtkCommand::ProgressEvent, command);
}

ProgressBar::~ProgressBar()
{
  if (this->tag_ != 0)
  {
    this->algorithm_->RemoveObserver(this->tag_);
  }
  if (this->shown_ >= 0)
  {
    std::cerr << "\r" << std::string(this->label_.size() + 50, ' ') << "\r" << std::flush;
  }
}

void ProgressBar::show(double fraction)
{
  const int percent = static_cast<int>(std::lround(100 * fraction));
  const bool early =
    std::chrono::steady_clock::now() - this->start_ < std::chrono::milliseconds(500);
  if (percent == this->shown_ || (early && !this->always_))
  {
    return;
  }
  this->shown_ = percent;
  const int width = 40, done = percent * width / 100;
  std::cerr << "\r" << this->label_ << " [" << std::string(done, '#')
            << std::string(width - done, '.') << "] " << percent << "%" << std::flush;
}
}
