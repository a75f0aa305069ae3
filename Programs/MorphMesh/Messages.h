// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace morph_mesh
{
/// A file cannot be read or written, or a filter has no result.
struct Failure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// As Failure, after the message: nothing is left to be said.
struct Reported : std::exception
{
};

/// From now on what VTK's objects say that nobody listens to (a parser inside a reader) goes to
/// standard error, in this program's form, or to the living ConsoleMessages.
void installConsole();

/// Keeps what VTK's objects say that nobody listens to, while it lives; one object at a time.
class ConsoleMessages
{
public:
  ConsoleMessages();
  ~ConsoleMessages();
  ConsoleMessages(const ConsoleMessages&) = delete;
  ConsoleMessages& operator=(const ConsoleMessages&) = delete;

  /// In their order: the first is the cause of the others.
  std::vector<std::string> errors, warnings;
};

/// Takes the errors and warnings of a VTK algorithm while it lives, instead of VTK's console.
class Messages
{
public:
  explicit Messages(vtkAlgorithm* algorithm);
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  /// Runs the algorithm. Throws Failure with what it reported, `task` first ("Cannot morph x.vtu").
  void update(const std::string& task);
  /// As update(), but errors of a morph that came part of the way are returned, one to a line.
  std::string updatePartly(const std::string& task);
  const std::vector<std::string>& errors() const { return this->errors_; }
  const std::vector<std::string>& warnings() const { return this->warnings_; }

private:
  vtkAlgorithm* algorithm_;
  std::vector<unsigned long> tags_;
  unsigned long executiveTag_ = 0;
  std::vector<std::string> errors_, warnings_;
};
}
