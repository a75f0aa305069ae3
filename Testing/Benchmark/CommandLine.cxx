// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include "Machine.h"

#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace benchmark
{
namespace
{
constexpr int WrongResult = 1;
constexpr int WrongUsage = 2;
constexpr int Failed = 3;

constexpr const char* Choices =
  "  --csv FILE    write the figures to FILE as well\n"
  "  --repeat N    repetitions whose medians are reported, 1 to 100 (default 3)\n"
  "  --wait-idle S wait up to S seconds before each measurement, 0 to 3600, until other\n"
  "                processes are idle (default 0)\n"
  "  --skip-klu    leave out KLU, which takes about a minute\n"
  "  --klu-limit S stop KLU after S seconds, 1 to 86400 (default 600)\n"
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

int commandLine(int argc, char** argv, const std::string& name, const std::string& about,
  const std::string& libraries, Measure measure, const std::string& files)
{
  const std::string usage =
    "Usage: " + name + " [options]" + (files.empty() ? "" : " " + files) + "\n" + about + Choices;
  const option longOptions[] = { { "csv", required_argument, nullptr, 'c' },
    { "repeat", required_argument, nullptr, 'r' }, { "wait-idle", required_argument, nullptr, 'w' },
    { "skip-klu", no_argument, nullptr, 'k' }, { "klu-limit", required_argument, nullptr, 'l' },
    { "quick", no_argument, nullptr, 'q' }, { "help", no_argument, nullptr, 'h' },
    { nullptr, 0, nullptr, 0 } };
  Options options;
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
      case 'l':
        if (!parse(optarg, 1, 86400, number))
        {
          std::fprintf(stderr, "--klu-limit takes seconds from 1 to 86400, not \"%s\".\n", optarg);
          return WrongUsage;
        }
        options.kluLimit = static_cast<double>(number);
        break;
      case 'q':
        options.quick = true;
        break;
      case 'h':
        std::fputs(usage.c_str(), stdout);
        return 0;
      default:
        std::fputs(usage.c_str(), stderr);
        return WrongUsage;
    }
  }
  options.files.assign(argv + optind, argv + argc);
  if (options.files.empty() != files.empty())
  {
    std::fprintf(stderr, "%s\n%s",
      files.empty() ? ("Unexpected argument \"" + options.files[0] + "\".").c_str()
                    : "A file is needed.",
      usage.c_str());
    return WrongUsage;
  }

  try
  {
    std::printf("Before: %s\n%s", machineDescription().c_str(), libraries.c_str());
    std::fflush(stdout);
    const Interference interference;
    bool correct = false;
    const Report report = measure(options, correct);
    std::printf("After: %s\nBeside the benchmark ran: %s\n\n%s", machineDescription().c_str(),
      interference.description().c_str(), report.table().c_str());
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
}
