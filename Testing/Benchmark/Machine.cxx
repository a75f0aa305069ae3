// SPDX-License-Identifier: BSD-3-Clause
#include "Machine.h"
#include "Threads.h"
#include "Timing.h"

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace benchmark
{
namespace
{
/// The text after `key` and its colon in a file of "key : value" lines; empty if there is none.
std::string lookUp(const std::string& file, const std::string& key)
{
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line))
  {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos && line.compare(0, key.size(), key) == 0)
    {
      const std::size_t start = line.find_first_not_of(" \t", colon + 1);
      return start == std::string::npos ? std::string() : line.substr(start);
    }
  }
  return {};
}

double peakResidentBytes()
{
  const std::string peak = lookUp("/proc/self/status", "VmHWM");
  if (peak.empty())
  {
    throw std::runtime_error(
      "/proc/self/status has no VmHWM: peak memory cannot be measured here.");
  }
  return 1024.0 * std::stod(peak); // the file counts in kB
}

/// Sets VmHWM back to what is resident now.
void resetPeak()
{
  malloc_trim(0);
  std::ofstream stream("/proc/self/clear_refs");
  stream << "5" << std::flush;
  if (!stream)
  {
    throw std::runtime_error("/proc/self/clear_refs cannot be written: no peak memory here.");
  }
}
}

std::string machineDescription()
{
  const std::string model = lookUp("/proc/cpuinfo", "model name");
  double load[3] = { 0, 0, 0 };
  const bool loadKnown = getloadavg(load, 3) == 3;
  char text[256];
  std::snprintf(text, sizeof(text), "%d cores, %s, last-level cache %.0f MiB, load average ",
    numberOfCores(), model.empty() ? "unknown model" : model.c_str(),
    lastLevelCacheBytes() / (1024 * 1024));
  std::string description = text;
  if (!loadKnown)
  {
    return description + "unknown";
  }
  std::snprintf(text, sizeof(text), "%.2f %.2f %.2f", load[0], load[1], load[2]);
  return description + text;
}

Interference::Interference()
  : start_(now())
{
}

Interference::Seconds Interference::now()
{
  Seconds seconds;
  std::ifstream stream("/proc/stat");
  std::string cpu;
  double user, nice, system, idle, ioWait, interrupts, softInterrupts, stolen;
  if (stream >> cpu >> user >> nice >> system >> idle >> ioWait >> interrupts >> softInterrupts >>
      stolen)
  {
    const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
    seconds.busy = (user + nice + system + interrupts + softInterrupts) / ticks;
    seconds.stolen = stolen / ticks;
    seconds.known = true;
  }
  for (const int who : { RUSAGE_SELF, RUSAGE_CHILDREN })
  {
    rusage usage = {};
    getrusage(who, &usage);
    for (const timeval& time : { usage.ru_utime, usage.ru_stime })
    {
      seconds.own += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  seconds.wall =
    std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return seconds;
}

double Interference::cores() const
{
  const Seconds end = now();
  if (!this->start_.known || !end.known)
  {
    throw std::runtime_error("/proc/stat does not say what the processors do.");
  }
  return (others(this->start_, end) + end.stolen - this->start_.stolen) /
         (end.wall - this->start_.wall);
}

std::string Interference::description() const
{
  const Seconds end = now();
  if (!this->start_.known || !end.known)
  {
    return "unknown";
  }
  const double wall = end.wall - this->start_.wall;
  char text[128];
  std::snprintf(text, sizeof(text), "other processes %.2f cores, host %.2f cores",
    others(this->start_, end) / wall, (end.stolen - this->start_.stolen) / wall);
  return text;
}

double Interference::others(const Seconds& start, const Seconds& end)
{
  return std::max(0.0, end.busy - start.busy - (end.own - start.own));
}

bool settle(double longestWait)
{
  constexpr auto Window = std::chrono::milliseconds(300);
  constexpr double Idle = 0.1; // cores; /proc/stat counts in steps of about 0.03 over the window
  malloc_trim(0);
  if (longestWait <= 0)
  {
    std::this_thread::sleep_for(Window);
    return true;
  }
  const Stopwatch watch;
  while (true)
  {
    const Interference interference;
    std::this_thread::sleep_for(Window);
    if (interference.cores() <= Idle)
    {
      return true;
    }
    if (watch.seconds() > longestWait)
    {
      return false;
    }
  }
}

double lastLevelCacheBytes()
{
  for (const int level : { _SC_LEVEL4_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE, _SC_LEVEL2_CACHE_SIZE })
  {
    const long bytes = sysconf(level);
    if (bytes > 0)
    {
      return static_cast<double>(bytes);
    }
  }
  return 0;
}

double peakMemoryGrowth(const std::function<void()>& setUp, const std::function<void()>& work)
{
  int channel[2];
  if (pipe(channel) != 0)
  {
    throw std::runtime_error("pipe() failed.");
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0)
  {
    close(channel[0]);
    close(channel[1]);
    throw std::runtime_error("fork() failed.");
  }
  if (child == 0)
  {
    close(channel[0]);
    int status = 1;
    try
    {
      setUp();
      resetPeak();
      const double before = peakResidentBytes();
      work();
      const double growth = peakResidentBytes() - before;
      status = write(channel[1], &growth, sizeof(growth)) == sizeof(growth) ? 0 : 1;
    }
    catch (const std::exception& error)
    {
      std::fprintf(stderr, "Measuring memory: %s\n", error.what());
    }
    _exit(status);
  }
  close(channel[1]);
  double growth = 0;
  const bool received = read(channel[0], &growth, sizeof(growth)) == sizeof(growth);
  close(channel[0]);
  int status = 0;
  const bool ended = waitpid(child, &status, 0) == child && WIFEXITED(status);
  if (!received || !ended || WEXITSTATUS(status) != 0)
  {
    throw std::runtime_error("The child process that measures memory failed.");
  }
  return growth;
}
}
