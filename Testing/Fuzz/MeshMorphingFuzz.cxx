// SPDX-License-Identifier: BSD-3-Clause
/// Runs seeded random grids, boundaries and properties through all public filters, and asks of each
/// case more than that it does not crash: see Oracles.h. A case is one data set through one filter,
/// executed twice.
#include "Workers.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <sstream>
#include <utility>

namespace
{
constexpr const char* Usage =
  R"(Usage: MeshMorphingFuzz [--from SEED] [--count N] [--filter NAME] [--stop] [--no-reduce]
       MeshMorphingFuzz --seed SEED [--filter NAME] [--set CHOICE=VALUE ...] [--reduce]
The first runs N cases from SEED on, and prints each that fails and a reduced form of it.
The status is 0 if none fails and if the filters get the shares that they are to have.
  --stop       end at the first finding
  --no-reduce  do not reduce
The second runs one case, and prints what it is made of.
  --set        take this value for a choice that the case prints, 0 mostly being the plain one
  --reduce     print a reduced form
)";

struct Options
{
  std::uint64_t from = 0;
  std::uint64_t count = 1000;
  bool isOne = false;
  bool stops = false;
  bool reduces = true;
  std::string filter;
  fuzz::Choices::Values set;
};

Options read(int argc, char** argv)
{
  Options options;
  const auto fail = [](const std::string& why)
  {
    std::cerr << why << "\n" << Usage;
    std::exit(2);
  };
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string
    {
      if (i + 1 == argc)
      {
        fail(word + " needs a value.");
      }
      return argv[++i];
    };
    if (word == "--from" || word == "--seed")
    {
      options.from = std::stoull(value());
      if (word == "--seed")
      {
        options.isOne = true;
        options.reduces = false;
      }
    }
    else if (word == "--count")
    {
      options.count = std::stoull(value());
    }
    else if (word == "--filter")
    {
      options.filter = value();
      bool known = false;
      for (const fuzz::Filter& filter : fuzz::filters())
      {
        known = known || filter.name == options.filter;
      }
      if (!known)
      {
        fail("There is no filter " + options.filter + ".");
      }
    }
    else if (word == "--set")
    {
      const std::string text = value();
      const std::size_t at = text.find('=');
      if (at == std::string::npos)
      {
        fail("--set needs CHOICE=VALUE.");
      }
      options.set[text.substr(0, at)] = std::stod(text.substr(at + 1));
    }
    else if (word == "--stop")
    {
      options.stops = true;
    }
    else if (word == "--no-reduce" || word == "--reduce")
    {
      options.reduces = word == "--reduce";
    }
    else
    {
      fail("Unknown option " + word + ".");
    }
  }
  return options;
}

void print(const fuzz::Trial& trial)
{
  const fuzz::Report& report = trial.report;
  std::cout << "  filter " << report.filter << ", "
            << (report.oracle.empty() ? "nothing found" : report.oracle + ": " + report.detail)
            << "\n";
  std::cout << "  data: " << trial.data << "\n";
  for (const fuzz::Choices::Choice& choice : trial.choices)
  {
    std::cout << "    " << choice.name << " = " << choice.value;
    std::cout << (choice.meaning.empty() ? "" : " (" + choice.meaning + ")") << "\n";
  }
  for (const std::string& message : trial.messages)
  {
    std::cout << "    said: " << message << "\n";
  }
}

void printReduced(const fuzz::Trial& found, const Options& options)
{
  fuzz::Choices::Values set = options.set;
  const fuzz::Trial reduced = fuzz::reduce(found, options.filter, set);
  std::cout << "Reduced: --seed " << found.report.seed;
  std::cout.precision(17);
  for (const auto& [name, value] : set)
  {
    std::cout << " --set " << name << "=" << value;
  }
  std::cout.precision(6);
  std::cout << "\n";
  print(reduced);
}

struct Share
{
  std::uint64_t cases = 0;
  std::uint64_t useful = 0; ///< with free nodes and without an error
};

/// Of the cases that could have it, how many have a property, or something else by name.
using Features = std::map<std::string, std::pair<std::uint64_t, std::uint64_t>>;

void add(const std::string& features, Features& to)
{
  std::istringstream words(features);
  for (std::string word; words >> word;)
  {
    auto& [has, all] = to[word.substr(0, word.size() - 1)];
    has += word.back() == '+';
    ++all;
  }
}

/// Whether a share of cases is below the demanded one by more than chance explains: by three
/// standard deviations of a sample of this size.
bool isRare(std::uint64_t has, std::uint64_t all, double demanded)
{
  const double n = static_cast<double>(all);
  const double spread = std::sqrt(n * demanded * (1 - demanded));
  return static_cast<double>(has) < n * demanded - 3 * spread;
}

/// Each is to be in 2 % of these cases.
bool printFeatures(const Features& features, bool isChecked)
{
  bool good = true;
  for (const auto& [name, counts] : features)
  {
    const auto [has, all] = counts;
    const bool isEnough = !isRare(has, all, 0.02);
    good = good && isEnough;
    std::cout << "  " << name << ": " << 1000 * has / all / 10. << " % of " << all << " cases"
              << (isEnough ? "" : ", too few") << "\n";
  }
  return good || !isChecked;
}

/// Each filter is to have 2 % of all cases, and 60 % are to be useful.
bool printShares(const std::map<std::string, Share>& shares, bool isChecked)
{
  Share all;
  bool good = true;
  for (const auto& [name, share] : shares)
  {
    all.cases += share.cases;
    all.useful += share.useful;
  }
  for (const auto& [name, share] : shares)
  {
    const bool isEnough = !isRare(share.cases, all.cases, 0.02);
    std::cout << "  " << name << ": " << share.cases << " cases, "
              << 100 * share.useful / share.cases << " % with free nodes and without an error"
              << (isEnough ? "" : ", too few cases") << "\n";
    good = good && isEnough;
  }
  std::cout << "  all: " << all.cases << " cases, " << 100 * all.useful / all.cases
            << " % with free nodes and without an error\n";
  return !isChecked ||
         (good && shares.size() == fuzz::filters().size() && !isRare(all.useful, all.cases, 0.6));
}
}

int main(int argc, char** argv)
{
  const Options options = read(argc, argv);
  if (options.isOne)
  {
    const fuzz::Trial trial = fuzz::runOne(options.from, options.filter, options.set);
    std::cout << "Seed " << options.from << "\n";
    print(trial);
    if (options.reduces && !trial.report.oracle.empty())
    {
      printReduced(trial, options);
    }
    return trial.report.oracle.empty() ? 0 : 1;
  }

  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, Share> shares;
  std::map<std::string, int> findings;
  Features features;
  int found = 0;
  fuzz::runSeeds(options.from, options.count, options.filter, options.set,
    [&](const fuzz::Report& report)
    {
      Share& share = shares[report.filter];
      ++share.cases;
      add(report.features, features);
      share.useful += report.hasFreeNodes && !report.hasError;
      if (report.oracle.empty())
      {
        return true;
      }
      ++found;
      // One fault shows in many seeds.
      const int alike = findings[report.filter + ": " + report.oracle]++;
      std::cout << "FINDING seed " << report.seed << ", " << report.filter << ", " << report.oracle;
      std::cout << ": " << report.detail.substr(0, alike < 2 ? 3000 : 120) << std::endl;
      if (options.reduces && alike < 2)
      {
        printReduced(fuzz::runOne(report.seed, options.filter, options.set), options);
      }
      return !options.stops;
    });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const bool isChecked = options.filter.empty() && options.set.empty() && options.count >= 1000 &&
                         !(options.stops && found);
  const bool areCovered = printFeatures(features, isChecked);
  const bool good = printShares(shares, isChecked) && areCovered;
  std::cout << "Seeds " << options.from << " to " << options.from + options.count - 1 << ": "
            << found << " findings, " << seconds.count() << " s\n";
  for (const auto& [name, count] : findings)
  {
    std::cout << "  " << name << ": " << count << "\n";
  }
  if (!good)
  {
    std::cout << "The shares above are not what they are to be.\n";
  }
  return found == 0 && good ? 0 : 1;
}
