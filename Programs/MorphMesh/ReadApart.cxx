// SPDX-License-Identifier: BSD-3-Clause
#include "ReadApart.h"

#include "Messages.h"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkPolyDataWriter.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <iostream>
#include <string_view>

namespace morph_mesh
{
namespace
{
using Read = std::function<vtkSmartPointer<vtkPolyData>()>;

void writeAll(int descriptor, std::string_view content)
{
  while (!content.empty())
  {
    const ssize_t count = write(descriptor, content.data(), content.size());
    if (count < 0 && errno != EINTR)
    {
      _exit(1);
    }
    content.remove_prefix(count < 0 ? 0 : static_cast<std::size_t>(count));
  }
}

/// The child: sends the surface and ends with status 0, or says why not and ends with status 1.
[[noreturn]] void sendSurface(int descriptor, const Read& read)
{
  try
  {
    const vtkSmartPointer<vtkPolyData> surface = read();
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO); // what the C library says of its memory
    vtkNew<vtkPolyDataWriter> writer;
    writer->SetInputData(surface);
    writer->SetFileTypeToBinary();
    writer->WriteToOutputStringOn();
    writer->Write();
    const auto length = static_cast<std::size_t>(writer->GetOutputStringLength());
    writeAll(descriptor, { writer->GetOutputString(), length });
    _exit(0);
  }
  catch (const std::exception& error)
  {
    std::cerr << "morph-mesh: " << error.what() << std::endl;
  }
  _exit(1);
}

std::string receive(int descriptor)
{
  std::string result;
  std::array<char, 1 << 16> part;
  for (;;)
  {
    const ssize_t count = read(descriptor, part.data(), part.size());
    if (count > 0)
    {
      result.append(part.data(), static_cast<std::size_t>(count));
    }
    else if (count == 0 || errno != EINTR)
    {
      return result;
    }
  }
}
}

vtkSmartPointer<vtkPolyData> readApart(const std::string& path, const Read& read)
{
  std::array<int, 2> ends;
  const pid_t child = pipe(ends.data()) == 0 ? fork() : -1;
  if (child < 0)
  {
    throw Failure("Cannot read " + path + ": there is no process to read it in.");
  }
  if (child == 0)
  {
    close(ends[0]);
    sendSurface(ends[1], read);
  }
  close(ends[1]);
  const std::string content = receive(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  if (!WIFEXITED(status))
  {
    throw Failure("Cannot read " + path +
                  ": VTK's reader crashed. The file is damaged, or not what its extension says.");
  }
  if (WEXITSTATUS(status) != 0)
  {
    throw Reported();
  }
  vtkNew<vtkPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetBinaryInputString(content.data(), static_cast<int>(content.size()));
  reader->Update();
  return reader->GetOutput();
}
}
