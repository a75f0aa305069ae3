// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

/// The fuzzer: seeded random data through the filters, see MeshMorphingFuzz.cxx.
namespace fuzz
{
/// Random numbers that are the same on every machine.
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : State(seed)
  {
  }
  std::uint64_t bits();
  /// In [0, 1).
  double unit();
  double between(double low, double high) { return low + (high - low) * this->unit(); }
  /// In [0, count).
  int below(int count);
  bool happens(double probability) { return this->unit() < probability; }
  /// 10 to a power between `low` and `high`.
  double power(double low, double high);

private:
  std::uint64_t State;
};

/// The choices that make a case. Each has a name, a plain value, and a random value of its own that
/// follows from the seed and the name alone. So a choice can be made plain, or set to another
/// value, and all others stay.
class Choices
{
public:
  using Values = std::map<std::string, double>;
  /// `set`: values that take the place of the random ones.
  explicit Choices(std::uint64_t seed, Values set = {});

  std::uint64_t seed() const { return this->Seed; }
  /// A number; plain unless `draw` gives another.
  double number(const std::string& name, double plain, const std::function<double(Random&)>& draw);
  int whole(const std::string& name, int plain, const std::function<int(Random&)>& draw);
  /// Plain: false.
  bool chance(const std::string& name, double probability);
  /// The number of one of `options`, 0 being plain. `weights`: as many.
  int pick(const std::string& name, const std::vector<const char*>& options,
    const std::vector<double>& weights);
  /// Random numbers for bulk data, which are no choices.
  Random stream(const std::string& name) const;

  /// The choices that were asked for and are not plain, with what they mean.
  struct Choice
  {
    std::string name;
    double value;
    double plain;
    std::string meaning;
  };
  const std::vector<Choice>& made() const { return this->Made; }
  /// Any choice that was asked for.
  double value(const std::string& name) const;
  /// The names of all that were, and whether they are not plain.
  std::map<std::string, bool> asked() const;

private:
  double take(const std::string& name, double plain, double drawn);

  std::uint64_t Seed;
  Values Set;
  Values Known;
  std::vector<Choice> Made;
};
}
