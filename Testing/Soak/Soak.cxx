// SPDX-License-Identifier: BSD-3-Clause
// Many morphs through one pipeline, to the end or stopped at random: nothing may grow, and nothing
// may stay behind.
#include "Aborts.h"
#include "Memory.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>

namespace
{
constexpr int Skipped = 77;

int usage()
{
  std::cerr << "Usage: soak memory METHOD [--morphs N] [--cells N] [--seed N]\n"
               "       soak aborts METHOD [--aborts N] [--check-every N] [--cells N] [--seed N]\n"
               "            [--seconds X] [--clock wall|thread]\n"
               "METHOD is all or one of:";
  for (const soak::Method& method : soak::methods())
  {
    std::cerr << ' ' << method.name;
  }
  std::cerr << "\nExits with 0 if nothing grew, or every abort was right; with 77 where memory "
               "cannot be measured.\n";
  return 2;
}
}

int main(int argc, char* argv[])
{
  const std::string what = argc > 1 ? argv[1] : "", name = argc > 2 ? argv[2] : "";
  soak::MemoryOptions memory;
  soak::AbortOptions aborts;
  bool isKnown = (what == "memory" || what == "aborts") && argc % 2 == 1;
  for (int i = 3; isKnown && i < argc; i += 2)
  {
    const std::string option = argv[i];
    const double value = std::atof(argv[i + 1]);
    const int number = static_cast<int>(value);
    isKnown = value > 0 || option == "--clock";
    if (option == "--cells")
    {
      memory.cells = aborts.cells = number;
    }
    else if (option == "--seed")
    {
      memory.seed = aborts.seed = static_cast<unsigned>(number);
    }
    else if (option == "--clock")
    {
      isKnown = std::string(argv[i + 1]) == "wall" || std::string(argv[i + 1]) == "thread";
      soak::Clock::setThreadTime(std::string(argv[i + 1]) == "thread");
    }
    else if (option == "--morphs")
    {
      memory.morphs = number;
    }
    else if (option == "--aborts")
    {
      aborts.aborts = number;
    }
    else if (option == "--check-every")
    {
      aborts.checkEvery = number;
    }
    else if (option == "--seconds")
    {
      aborts.seconds = value;
    }
    else
    {
      isKnown = false;
    }
  }
  if (!isKnown)
  {
    return usage();
  }
  soak::Process now;
  if (what == "memory" && !soak::measure(now))
  {
    std::cout << "Not measured: this system has no /proc, or the address sanitizer keeps what is "
                 "freed.\n";
    return Skipped;
  }
  bool any = false, isRight = true;
  for (const soak::Method& method : soak::methods())
  {
    if (name == "all" || name == method.name)
    {
      any = true;
      isRight =
        (what == "memory" ? soak::staysFlat(method, memory) : soak::stopsRight(method, aborts)) &&
        isRight;
    }
  }
  return !any ? usage() : isRight ? EXIT_SUCCESS : EXIT_FAILURE;
}
