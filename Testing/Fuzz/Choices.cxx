// SPDX-License-Identifier: BSD-3-Clause
#include "Choices.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fuzz
{
std::uint64_t Random::bits()
{
  // S. Vigna's splitmix64, in the public domain: G. L. Steele et al., OOPSLA 2014.
  std::uint64_t z = (this->State += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::unit()
{
  return static_cast<double>(this->bits() >> 11) * 0x1p-53;
}

int Random::below(int count)
{
  return static_cast<int>(this->unit() * count);
}

double Random::power(double low, double high)
{
  return std::pow(10.0, this->between(low, high));
}

Choices::Choices(std::uint64_t seed, Values set)
  : Seed(seed)
  , Set(std::move(set))
{
}

Random Choices::stream(const std::string& name) const
{
  // FNV-1a, then mixed with the seed.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  Random mix(hash + 0x9e3779b97f4a7c15u * this->Seed);
  return Random(mix.bits());
}

double Choices::take(const std::string& name, double plain, double drawn)
{
  if (const auto known = this->Known.find(name); known != this->Known.end())
  {
    return known->second;
  }
  const auto set = this->Set.find(name);
  const double value = set == this->Set.end() ? drawn : set->second;
  this->Known[name] = value;
  if (!(value == plain))
  {
    this->Made.push_back({ name, value, plain, {} });
  }
  return value;
}

double Choices::number(
  const std::string& name, double plain, const std::function<double(Random&)>& draw)
{
  Random random = this->stream(name);
  return this->take(name, plain, draw(random));
}

int Choices::whole(const std::string& name, int plain, const std::function<int(Random&)>& draw)
{
  Random random = this->stream(name);
  return static_cast<int>(this->take(name, plain, draw(random)));
}

bool Choices::chance(const std::string& name, double probability)
{
  Random random = this->stream(name);
  return this->take(name, 0, random.happens(probability) ? 1 : 0) != 0;
}

int Choices::pick(const std::string& name, const std::vector<const char*>& options,
  const std::vector<double>& weights)
{
  Random random = this->stream(name);
  double left = random.unit() * std::accumulate(weights.begin(), weights.end(), 0.0);
  const int last = static_cast<int>(options.size()) - 1;
  int drawn = 0;
  while (drawn < last && (left -= weights[drawn]) >= 0)
  {
    ++drawn;
  }
  const std::size_t before = this->Made.size();
  const int taken = std::clamp(static_cast<int>(this->take(name, 0, drawn)), 0, last);
  if (this->Made.size() > before)
  {
    this->Made.back().meaning = options[taken];
  }
  return taken;
}

std::map<std::string, bool> Choices::asked() const
{
  std::map<std::string, bool> result;
  for (const auto& [name, value] : this->Known)
  {
    result[name] = false;
  }
  for (const Choice& choice : this->Made)
  {
    result[choice.name] = true;
  }
  return result;
}

double Choices::value(const std::string& name) const
{
  const auto known = this->Known.find(name);
  return known == this->Known.end() ? 0 : known->second;
}
}
