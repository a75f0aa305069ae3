// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Numbers as solvers' files spell them.
namespace morph::io
{
/// The value of a number: "1", "-.5", "+1.5e-3", "1.5D-3" and, as Nastran writes it, "1.5-3".
/// Nothing for a text that is no number, for an infinite one, and for NaN.
std::optional<double> parseNumber(std::string_view text);

/// The value of a whole number; nothing for another text.
std::optional<long long> parseInteger(std::string_view text);

/// Writes `value` in the manner of `model`, a number of the same file: with an exponent or
/// without, its letter, and at least as many digits. parseNumber() gives back exactly `value`.
std::string exactNumber(double value, std::string_view model);

/// Writes `value` as precisely as `width` characters allow, with a decimal point. `shortExponent`:
/// exponents have no letter, as Nastran allows ("1.5-3"). Nothing where no number is that short.
std::optional<std::string> fittingNumber(double value, std::size_t width, bool shortExponent);
}
