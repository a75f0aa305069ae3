// SPDX-License-Identifier: BSD-3-Clause
#include "Workers.h"

#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

namespace fuzz
{
namespace
{
constexpr std::uint64_t SeedsOfProcess = 500;

const Filter& filterFor(std::uint64_t seed, const std::string& name)
{
  const auto found = std::find_if(filters().begin(), filters().end(),
    [&name](const Filter& filter) { return filter.name == name; });
  return found == filters().end() ? filterOf(seed) : *found;
}

/// One line, of fields that a tab parts.
std::string line(std::vector<std::string> fields)
{
  std::string result;
  for (std::string& field : fields)
  {
    std::replace_if(
      field.begin(), field.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
    result += (result.empty() ? "" : "\t") + field;
  }
  return result + "\n";
}

std::vector<std::string> fieldsOf(const std::string& text)
{
  std::vector<std::string> fields(1);
  for (const char c : text)
  {
    if (c == '\t')
    {
      fields.emplace_back();
    }
    else
    {
      fields.back() += c;
    }
  }
  fields.resize(std::max<std::size_t>(fields.size(), 8));
  return fields;
}

std::string number(double value)
{
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Ends this process after so much processor time, whatever else the machine does, or after ten
/// times as long if it waits for something.
void limitTime()
{
  const itimerval time = { {}, { TimeOut, 0 } };
  setitimer(ITIMER_PROF, &time, nullptr);
  alarm(10 * TimeOut);
}

/// A process that runs `work`, which writes lines; each is handed to `read`. Returns what it ended
/// by, "" if well, and what it wrote to its standard error.
std::pair<std::string, std::string> inProcess(
  const std::function<void(const std::function<void(const std::string&)>&)>& work,
  const std::function<void(const std::string&)>& read)
{
  int ends[2];
  std::FILE* errors = std::tmpfile();
  if (!errors || pipe(ends) != 0)
  {
    std::perror("MeshMorphingFuzz");
    std::exit(2);
  }
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    dup2(fileno(errors), 2);
    work(
      [&](const std::string& text)
      {
        if (write(ends[1], text.data(), text.size()) != static_cast<ssize_t>(text.size()))
        {
          _exit(3);
        }
      });
    _exit(0);
  }
  close(ends[1]);
  std::FILE* stream = fdopen(ends[0], "r");
  char* text = nullptr;
  std::size_t size = 0;
  for (ssize_t got; (got = getline(&text, &size, stream)) > 0;)
  {
    // The last line may be cut off.
    if (text[got - 1] == '\n')
    {
      read(std::string(text, static_cast<std::size_t>(got - 1)));
    }
  }
  std::free(text);
  std::fclose(stream);
  int status = 0;
  waitpid(child, &status, 0);
  std::string end;
  if (WIFSIGNALED(status))
  {
    const int signal = WTERMSIG(status);
    end = signal == SIGALRM || signal == SIGPROF ? "time-out"
                                                 : "crash by signal " + std::to_string(signal);
  }
  else if (WEXITSTATUS(status) != 0)
  {
    end = "crash with status " + std::to_string(WEXITSTATUS(status));
  }
  std::string said;
  std::rewind(errors);
  for (int c; said.size() < 6000 && (c = std::fgetc(errors)) != EOF;)
  {
    said += static_cast<char>(c);
  }
  std::fclose(errors);
  return { end, said };
}

std::string lineOf(std::uint64_t seed, const Verdict& verdict)
{
  return line({ "done", std::to_string(seed), verdict.filter, verdict.hasFreeNodes ? "1" : "0",
    verdict.hasError ? "1" : "0", verdict.finding.oracle, verdict.finding.detail,
    verdict.features });
}

Report reportOf(const std::vector<std::string>& fields)
{
  return { std::stoull(fields[1]), fields[2], fields[3] == "1", fields[4] == "1", fields[5],
    fields[6], fields[7] };
}
}

void runSeeds(std::uint64_t from, std::uint64_t count, const std::string& filter,
  const Choices::Values& set, const std::function<bool(const Report&)>& report)
{
  const std::uint64_t end = from + count;
  bool goesOn = true;
  for (std::uint64_t seed = from; goesOn && seed < end;)
  {
    const std::uint64_t last = std::min(end, seed + SeedsOfProcess);
    const auto work = [&](const std::function<void(const std::string&)>& tell)
    {
      for (std::uint64_t s = seed; s < last; ++s)
      {
        limitTime();
        Choices choices(s, set);
        tell(lineOf(s, judge(choices, filterFor(s, filter))));
      }
    };
    std::vector<Report> reports;
    const auto [problem, said] = inProcess(
      work, [&](const std::string& text) { reports.push_back(reportOf(fieldsOf(text))); });
    if (!problem.empty())
    {
      const std::uint64_t at = seed + reports.size();
      reports.push_back({ at, filterFor(at, filter).name, false, true, problem, said, {} });
    }
    for (const Report& each : reports)
    {
      goesOn = goesOn && report(each);
      seed = each.seed + 1;
    }
  }
}

Trial runOne(std::uint64_t seed, const std::string& filter, const Choices::Values& set)
{
  Trial trial;
  trial.report.seed = seed;
  trial.report.filter = filterFor(seed, filter).name;
  const auto work = [&](const std::function<void(const std::string&)>& tell)
  {
    limitTime();
    Choices choices(seed, set);
    const auto tellMade = [&](const std::string& data)
    {
      tell(line({ "data", data }));
      for (const Choices::Choice& choice : choices.made())
      {
        tell(line(
          { "choice", choice.name, number(choice.value), number(choice.plain), choice.meaning }));
      }
    };
    const Verdict verdict = judge(choices, filterFor(seed, filter), tellMade);
    tell(line({ "again" }));
    tellMade("");
    for (const std::string& message : verdict.messages)
    {
      tell(line({ "message", message }));
    }
    tell(lineOf(seed, verdict));
  };
  const auto read = [&trial](const std::string& text)
  {
    const std::vector<std::string> fields = fieldsOf(text);
    if (fields[0] == "choice")
    {
      trial.choices.push_back({ fields[1], std::stod(fields[2]), std::stod(fields[3]), fields[4] });
    }
    else if (fields[0] == "again")
    {
      trial.choices.clear();
    }
    else if (fields[0] == "message")
    {
      trial.messages.push_back(fields[1]);
    }
    else if (fields[0] == "data")
    {
      trial.data += fields[1];
    }
    else
    {
      trial.report = reportOf(fields);
    }
  };
  const auto [problem, said] = inProcess(work, read);
  if (!problem.empty())
  {
    trial.report.oracle = problem;
    trial.report.detail = said;
  }
  return trial;
}

Trial reduce(const Trial& failing, const std::string& filter, Choices::Values& set)
{
  Trial best = failing;
  int trials = 0;
  const int most = failing.report.oracle == "time-out" ? 12 : 250;
  const auto fails = [&](const std::string& name, double value)
  {
    if (++trials > most)
    {
      return false;
    }
    Choices::Values tried = set;
    tried[name] = value;
    const Trial trial = runOne(failing.report.seed, filter, tried);
    if (trial.report.oracle != failing.report.oracle)
    {
      return false;
    }
    best = trial;
    set = tried;
    return true;
  };
  bool isSimpler = true;
  while (isSimpler && trials < most)
  {
    isSimpler = false;
    std::vector<Choices::Choice> choices = best.choices;
    // What allows the most first.
    std::stable_partition(choices.begin(), choices.end(),
      [](const Choices::Choice& choice) { return choice.name.rfind("hostile", 0) == 0; });
    for (const Choices::Choice& choice : choices)
    {
      isSimpler = fails(choice.name, choice.plain) || isSimpler;
    }
  }
  // Lengths below their plain value, which is a usual one.
  for (const char* name : { "mesh.nx", "mesh.ny", "mesh.nz" })
  {
    fails(name, 1);
  }
  return best;
}
}
