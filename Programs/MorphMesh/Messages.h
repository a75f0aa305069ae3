// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace morph_mesh
{
/// The error of a file that cannot be read or written, or of a filter without a result.
struct Failure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Sends VTK's unobserved messages (of a parser inside a reader, for instance) to standard error,
/// in this program's form, or to the current ConsoleMessages.
void installConsole();

/// Collects VTK's unobserved messages during its lifetime; one object at a time.
class ConsoleMessages
{
public:
  ConsoleMessages();
  ~ConsoleMessages();
  ConsoleMessages(const ConsoleMessages&) = delete;
  ConsoleMessages& operator=(const ConsoleMessages&) = delete;

  /// The messages in their order: the first is the cause of the others.
  std::vector<std::string> errors, warnings;
};

/// Collects the errors and warnings of a VTK algorithm during its lifetime, in place of VTK's
/// console.
class Messages
{
public:
  explicit Messages(vtkAlgorithm* algorithm);
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  /// Runs the algorithm. Throws Failure with what it reported, `task` first ("Cannot morph x.vtu").
  void update(const std::string& task);
  /// As update(), but errors of a morph that has a mesh all the same, which came part of the way or
  /// has inverted cells, are returned, one to a line.
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
