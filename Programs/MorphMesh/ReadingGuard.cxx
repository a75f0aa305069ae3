// SPDX-License-Identifier: BSD-3-Clause
#include "ReadingGuard.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>

namespace morph_mesh
{
namespace
{
constexpr std::array<int, 6> Signals = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF };

/// What the handler needs; it must not allocate.
struct State
{
  std::string crashed, endless;
  int standardError = -1;
  std::array<struct sigaction, Signals.size()> actions;
  stack_t stack;
  rlimit memory;
} state;

/// A reader that has used up its stack leaves none to the handler.
std::array<char, 1 << 16> handlerStack;

void endProgram(int signal)
{
  const std::string& text = signal == SIGPROF ? state.endless : state.crashed;
  const ssize_t written = write(state.standardError, text.data(), text.size());
  static_cast<void>(written); // nothing is left to be done
  _exit(1);
}

void muteStandardError()
{
  state.standardError = dup(STDERR_FILENO);
  const int nothing = open("/dev/null", O_WRONLY);
  if (state.standardError < 0)
  {
    state.standardError = STDERR_FILENO;
  }
  else if (nothing >= 0)
  {
    dup2(nothing, STDERR_FILENO);
  }
  if (nothing >= 0)
  {
    close(nothing);
  }
}

void restoreStandardError()
{
  if (state.standardError != STDERR_FILENO)
  {
    dup2(state.standardError, STDERR_FILENO);
    close(state.standardError);
  }
}

/// Bytes of this process that RLIMIT_DATA counts; 0 where the system does not tell.
std::uintmax_t dataSize()
{
  std::ifstream file("/proc/self/statm");
  std::uintmax_t total = 0, resident, shared, text, libraries, data = 0;
  file >> total >> resident >> shared >> text >> libraries >> data;
  return file ? data * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void limitMemory(std::uintmax_t bytes)
{
  getrlimit(RLIMIT_DATA, &state.memory);
  const std::uintmax_t taken = dataSize();
  rlimit limit = state.memory;
  limit.rlim_cur = static_cast<rlim_t>(taken + (std::uintmax_t(1) << 30) + 1100 * bytes);
  if (taken != 0 && limit.rlim_cur < state.memory.rlim_cur)
  {
    setrlimit(RLIMIT_DATA, &limit);
  }
}

void limitTime(std::uintmax_t seconds)
{
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  setitimer(ITIMER_PROF, &timer, nullptr);
}

void handleSignals()
{
  stack_t stack = {};
  stack.ss_sp = handlerStack.data();
  stack.ss_size = handlerStack.size();
  sigaltstack(&stack, &state.stack);
  struct sigaction action = {};
  action.sa_handler = endProgram;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < Signals.size(); ++i)
  {
    sigaction(Signals[i], &action, &state.actions[i]);
  }
}
}

ReadingGuard::ReadingGuard(const std::string& path, std::uintmax_t bytes)
{
  const std::uintmax_t seconds = 3 + 2 * (bytes / 1000000);
  const std::string start = "morph-mesh: Cannot read " + path + ": its reader ";
  const std::string end = ". The file is damaged, or not what its extension says.\n";
  // Many readers go on without the memory that they did not get, and crash then.
  state.crashed = start + "crashed, or did not get the memory that it asked for" + end;
  state.endless =
    start + "has not ended after computing for " + std::to_string(seconds) + " s" + end;
  muteStandardError();
  limitMemory(bytes);
  handleSignals();
  limitTime(seconds);
}

ReadingGuard::~ReadingGuard()
{
  limitTime(0);
  for (std::size_t i = 0; i < Signals.size(); ++i)
  {
    sigaction(Signals[i], &state.actions[i], nullptr);
  }
  sigaltstack(&state.stack, nullptr);
  setrlimit(RLIMIT_DATA, &state.memory);
  restoreStandardError();
}
}
