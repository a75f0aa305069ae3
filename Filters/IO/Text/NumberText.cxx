// SPDX-License-Identifier: BSD-3-Clause
#include "Text/NumberText.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace morph::io
{
namespace
{
constexpr std::string_view Letters = "eEdDqQ";

std::string withDecimals(double value, int decimals)
{
  return fmt::format("{:.{}f}", value, decimals);
}

std::string withExponent(double value, int decimals)
{
  return fmt::format("{:.{}e}", value, decimals);
}

/// The digits between the point and the exponent.
int decimals(std::string_view number)
{
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos)
  {
    return 0;
  }
  const std::size_t end = number.find_first_not_of("0123456789", point + 1);
  return static_cast<int>(std::min(end, number.size()) - point - 1);
}

/// With a point, which makes it a real number where that matters, and so many digits after it at
/// least.
std::string withPoint(std::string number, int digits = 0)
{
  const std::size_t end = std::min(number.find('e'), number.size());
  number.insert(end, static_cast<std::size_t>(std::max(0, digits - decimals(number))), '0');
  if (number.find('.') == std::string::npos)
  {
    number.insert(end, ".");
  }
  return number;
}

/// How many digits there are from the first that is not 0 to the last.
std::size_t significantDigits(std::string_view number)
{
  std::string digits(number.substr(0, number.find('e')));
  digits.erase(std::remove(digits.begin(), digits.end(), '.'), digits.end());
  return 1 + digits.find_last_of("123456789") - digits.find_first_of("123456789");
}

/// "-0.5" as "-.5".
void dropLeadingZero(std::string& number)
{
  const std::size_t sign = number[0] == '-' ? 1 : 0;
  if (number.size() > sign + 2 && number[sign] == '0' && number[sign + 1] == '.')
  {
    number.erase(sign, 1);
  }
}

/// "1.5e-03" as "1.5e-3" or, with `shortExponent`, "1.5-3".
std::string shortened(std::string number, bool shortExponent)
{
  const std::size_t letter = number.find('e');
  std::string exponent = number.substr(letter + 1);
  const char sign = exponent[0];
  exponent.erase(0, std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  number.erase(letter);
  number = withPoint(number);
  if (shortExponent)
  {
    return number + sign + exponent;
  }
  return number + (sign == '-' ? "e-" : "e") + exponent;
}

/// The most precise number that `write(precision)` fits into the width.
template <typename Write>
std::optional<std::string> mostPrecise(std::size_t width, Write write)
{
  for (int precision = std::min<int>(17, static_cast<int>(width)); precision >= 0; --precision)
  {
    std::string number = write(precision);
    if (number.size() <= width)
    {
      return number;
    }
  }
  return std::nullopt;
}
}

std::optional<double> parseNumber(std::string_view number)
{
  std::array<char, 64> plain;
  std::size_t length = 0;
  if (!number.empty() && number[0] == '+')
  {
    number.remove_prefix(1);
  }
  if (number.empty() || number.size() + 2 > plain.size())
  {
    return std::nullopt;
  }
  bool hasExponent = false;
  for (std::size_t i = 0; i < number.size(); ++i)
  {
    const char c = number[i];
    if (Letters.find(c) != std::string_view::npos)
    {
      if (hasExponent || i == 0)
      {
        return std::nullopt;
      }
      hasExponent = true;
      plain[length++] = 'e';
    }
    else if (c == '+' || c == '-')
    {
      if (i > 0 && !hasExponent) // the exponent of Nastran
      {
        hasExponent = true;
        plain[length++] = 'e';
      }
      if (c == '-')
      {
        plain[length++] = c;
      }
    }
    else if ((c >= '0' && c <= '9') || c == '.')
    {
      plain[length++] = c;
    }
    else
    {
      return std::nullopt; // "nan", "inf" and hexadecimal numbers too
    }
  }
  double value = HUGE_VAL;
  const char* const end = plain.data() + length;
  const bool isNumber = fast_float::from_chars(plain.data(), end, value).ptr == end;
  return isNumber && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<long long> parseInteger(std::string_view number)
{
  if (!number.empty() && number[0] == '+')
  {
    number.remove_prefix(1);
  }
  long long value = 0;
  const auto result = std::from_chars(number.data(), number.data() + number.size(), value);
  return !number.empty() && result.ec == std::errc() && result.ptr == number.data() + number.size()
           ? std::optional<long long>(value)
           : std::nullopt;
}

std::string exactNumber(double value, std::string_view model)
{
  const int asked = std::min(decimals(model), 17);
  const std::size_t letter = model.find_first_of(Letters);
  std::string number = fmt::format("{}", value); // the shortest that gives back the value
  auto digits = static_cast<int>(significantDigits(number)) - 1;
  if (letter == std::string_view::npos)
  {
    if (const std::size_t exponent = number.find('e'); exponent != std::string::npos)
    {
      number = withDecimals(value, std::max(0, digits - std::stoi(number.substr(exponent + 1))));
    }
    number = withPoint(number, asked);
    if (number.size() <= 24)
    {
      return number;
    }
  }
  // Beside a power of two, the nearest number of so many digits may give back another one.
  do
  {
    number = withExponent(value, digits++);
  } while (digits <= 17 && parseNumber(number) != value);
  number = withPoint(number, std::min(asked, 16));
  number[number.find('e')] = letter == std::string_view::npos ? 'e' : model[letter];
  return number;
}

std::optional<std::string> fittingNumber(double value, std::size_t width, bool shortExponent)
{
  const auto fixed = mostPrecise(width,
    [&](int precision)
    {
      std::string number = withPoint(withDecimals(value, precision));
      if (number.size() > width)
      {
        dropLeadingZero(number);
      }
      return number;
    });
  const auto scientific = mostPrecise(
    width, [&](int precision) { return shortened(withExponent(value, precision), shortExponent); });
  const auto error = [&](const std::optional<std::string>& number)
  { return number ? std::abs(parseNumber(*number).value_or(HUGE_VAL) - value) : HUGE_VAL; };
  return error(fixed) <= error(scientific) ? fixed : scientific;
}
}
