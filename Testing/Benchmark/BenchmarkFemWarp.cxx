// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP against direct solvers, the memory's bandwidth and the size of the mesh, in one run.
#include "Baselines.h"
#include "Figures.h"
#include "Machine.h"

#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace
{
constexpr int WrongResult = 1;
constexpr int WrongUsage = 2;
constexpr int Failed = 3;

constexpr const char* Usage =
  "Usage: benchmark-femwarp [options]\n"
  "Measures FEMWARP on twisted bricks of hexahedra and prints figures beside their targets.\n"
  "Cold: prepare and evaluate of a fresh morpher at relative residual 1e-8. Warm: evaluate alone.\n"
  "  --csv FILE    write the figures to FILE as well\n"
  "  --repeat N    repetitions whose medians are reported, 1 to 100 (default 3)\n"
  "  --wait-idle S wait up to S seconds before each measurement, 0 to 3600, until other\n"
  "                processes are idle (default 0)\n"
  "  --skip-klu    leave out KLU, which takes about a minute\n"
  "  --quick       small meshes: checks the answers, holds no figure against a target\n"
  "  --help        print this\n"
  "Exit status: 0 all results correct (targets missed or not), 1 a result is wrong,\n"
  "2 wrong usage, 3 something could not be measured.\n";

/// True if `text` is a whole number in the range.
bool parse(const char* text, long least, long most, long& value)
{
  char* end = nullptr;
  value = std::strtol(text, &end, 10);
  return end != text && *end == '\0' && value >= least && value <= most;
}
}

int main(int argc, char** argv)
{
  const option longOptions[] = { { "csv", required_argument, nullptr, 'c' },
    { "repeat", required_argument, nullptr, 'r' }, { "wait-idle", required_argument, nullptr, 'w' },
    { "skip-klu", no_argument, nullptr, 'k' }, { "quick", no_argument, nullptr, 'q' },
    { "help", no_argument, nullptr, 'h' }, { nullptr, 0, nullptr, 0 } };
  benchmark::Options options;
  std::string csv;
  long number = 0;
  int choice = 0;
  while ((choice = getopt_long(argc, argv, "h", longOptions, nullptr)) != -1)
  {
    switch (choice)
    {
      case 'c':
        csv = optarg;
        break;
      case 'r':
        if (!parse(optarg, 1, 100, number))
        {
          std::fprintf(stderr, "--repeat takes a number from 1 to 100, not \"%s\".\n", optarg);
          return WrongUsage;
        }
        options.repeat = static_cast<int>(number);
        break;
      case 'w':
        if (!parse(optarg, 0, 3600, number))
        {
          std::fprintf(stderr, "--wait-idle takes seconds from 0 to 3600, not \"%s\".\n", optarg);
          return WrongUsage;
        }
        options.waitIdle = static_cast<double>(number);
        break;
      case 'k':
        options.skipKlu = true;
        break;
      case 'q':
        options.quick = true;
        break;
      case 'h':
        std::fputs(Usage, stdout);
        return 0;
      default:
        std::fputs(Usage, stderr);
        return WrongUsage;
    }
  }
  if (optind != argc)
  {
    std::fprintf(stderr, "Unexpected argument \"%s\".\n%s", argv[optind], Usage);
    return WrongUsage;
  }

  try
  {
    std::printf("Before: %s\nBLAS: %s\n", benchmark::machineDescription().c_str(),
      benchmark::blasDescription().c_str());
    std::fflush(stdout);
    const benchmark::Interference interference;
    bool correct = false;
    const benchmark::Report report = benchmark::measureFigures(options, correct);
    std::printf("After: %s\nBeside the benchmark ran: %s\n\n%s",
      benchmark::machineDescription().c_str(), interference.description().c_str(),
      report.table().c_str());
    if (!csv.empty())
    {
      report.writeCsv(csv);
    }
    if (!correct)
    {
      std::fprintf(stderr, "A result is wrong: see the differences and residuals above.\n");
      return WrongResult;
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return Failed;
  }
  return 0;
}
