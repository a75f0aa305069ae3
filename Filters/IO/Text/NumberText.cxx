// SPDX-License-Identifier: BSD-3-Clause
#include "Text/NumberText.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace morph::io
{
namespace
{
constexpr std::string_view Letters = "eEdDqQ";

std::string text(double value, std::chars_format format, int precision)
{
  std::array<char, 400> buffer;
  const auto result =
    std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
  return result.ec == std::errc() ? std::string(buffer.data(), result.ptr) : std::string();
}

std::string shortest(double value, std::chars_format format)
{
  std::array<char, 400> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format);
  return std::string(buffer.data(), result.ptr);
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

/// With a point, which makes it a real number where that matters.
std::string withPoint(std::string number)
{
  if (number.find('.') == std::string::npos)
  {
    const std::size_t exponent = number.find('e');
    number.insert(exponent == std::string::npos ? number.size() : exponent, ".");
  }
  return number;
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
    if (!number.empty() && number.size() <= width)
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
  double value = 0;
  const auto result = std::from_chars(plain.data(), plain.data() + length, value);
  if (result.ptr != plain.data() + length)
  {
    return std::nullopt;
  }
  if (result.ec == std::errc::result_out_of_range)
  {
    // Too small or too large: an exponent tells.
    const std::string_view whole(plain.data(), length);
    const bool isTiny = whole.find("e-") != std::string_view::npos;
    return isTiny ? std::optional<double>(0) : std::nullopt;
  }
  return result.ec == std::errc() && std::isfinite(value) ? std::optional<double>(value)
                                                          : std::nullopt;
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
  const std::size_t letter = model.find_first_of(Letters);
  const int asked = std::min(decimals(model), 17);
  if (letter == std::string_view::npos)
  {
    std::string number = shortest(value, std::chars_format::fixed);
    if (decimals(number) < asked)
    {
      number = text(value, std::chars_format::fixed, asked);
    }
    if (number.size() <= 24)
    {
      return withPoint(number);
    }
  }
  std::string number = shortest(value, std::chars_format::scientific);
  if (letter != std::string_view::npos && decimals(number) < asked)
  {
    number = text(value, std::chars_format::scientific, std::min(asked, 16));
  }
  number = withPoint(number);
  if (letter != std::string_view::npos)
  {
    number[number.find('e')] = model[letter];
  }
  return number;
}

std::optional<std::string> fittingNumber(double value, std::size_t width, bool shortExponent)
{
  const auto fixed = mostPrecise(width,
    [&](int precision)
    {
      std::string number = withPoint(text(value, std::chars_format::fixed, precision));
      if (number.size() > width)
      {
        dropLeadingZero(number);
      }
      return number;
    });
  const auto scientific = mostPrecise(width, [&](int precision)
    { return shortened(text(value, std::chars_format::scientific, precision), shortExponent); });
  const auto error = [&](const std::optional<std::string>& number)
  { return number ? std::abs(parseNumber(*number).value_or(HUGE_VAL) - value) : HUGE_VAL; };
  return error(fixed) <= error(scientific) ? fixed : scientific;
}
}
