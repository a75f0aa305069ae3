// SPDX-License-Identifier: BSD-3-Clause
#include "Text/NumberText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
using namespace morph::io;

/// Of any size from 1e-30 to 1e30, and of either sign.
double randomNumber(std::mt19937& engine)
{
  std::uniform_real_distribution<double> digits(-10, 10), exponent(-30, 30);
  return digits(engine) * std::pow(10., std::round(exponent(engine)));
}
}

TEST(NumberText, SpellingsOfOneNumber)
{
  for (const char* text : { "1.5e-3", "1.5E-3", "1.5d-3", "1.5-3", "+.0015", "0.0015", "15.-4" })
  {
    EXPECT_EQ(parseNumber(text).value_or(0), 1.5e-3) << text;
  }
  EXPECT_EQ(parseNumber("-7").value_or(0), -7);
  EXPECT_EQ(parseNumber("1e-999").value_or(1), 0);
  for (const char* text :
    { "", "nan", "inf", "-inf", "1e999", "0x10", "1.2.3", "1-2-3", "e5", "1,", "- 1", "--1", "1e" })
  {
    EXPECT_FALSE(parseNumber(text)) << text;
  }
}

TEST(NumberText, ExactNumbersComeBackAndKeepTheManner)
{
  std::mt19937 engine(1);
  for (int i = 0; i < 20000; ++i)
  {
    const double value = randomNumber(engine);
    for (const char* model : { "", "1", "1.", "0.500000", "1.000000000E+00", "1.5d-3" })
    {
      const std::string text = exactNumber(value, model);
      ASSERT_EQ(parseNumber(text).value_or(HUGE_VAL), value) << text << ", seed 1";
      ASSERT_NE(text.find('.'), std::string::npos) << text;
    }
    ASSERT_NE(exactNumber(value, "1.0D+00").find('D'), std::string::npos);
  }
  const double power = std::ldexp(1., -44); // 5.684341886080801e-14 is nearer, and another number
  EXPECT_EQ(parseNumber(exactNumber(power, "1e0")).value_or(0), power);
  EXPECT_EQ(exactNumber(0.25, "1.000000"), "0.250000");
  EXPECT_EQ(exactNumber(0.25, "1.000E+00"), "2.500E-01");
}

/// No number of the same length, one digit up or down, is nearer.
TEST(NumberText, FittingNumbersAreAsNearAsTheirWidthAllows)
{
  std::mt19937 engine(2);
  for (int i = 0; i < 20000; ++i)
  {
    const double value = randomNumber(engine);
    for (const std::size_t width : { 8, 16, 20 })
    {
      const auto text = fittingNumber(value, width, true);
      ASSERT_TRUE(text && text->size() <= width) << value << ", seed 2";
      ASSERT_NE(text->find('.'), std::string::npos) << *text;
      const double error = std::abs(parseNumber(*text).value_or(HUGE_VAL) - value);
      // Sign, point and the exponent "-30" take 5 characters of the field.
      ASSERT_LE(error, std::abs(value) * std::pow(10., 6. - static_cast<double>(width)))
        << value << " as " << *text << ", seed 2";
    }
  }
  EXPECT_EQ(fittingNumber(-123.456789, 8, true).value_or(""), "-123.457");
  EXPECT_EQ(fittingNumber(-0.0123456789, 8, true).value_or(""), "-.012346");
  EXPECT_EQ(fittingNumber(1.23456e-9, 8, true).value_or(""), "1.2346-9");
  EXPECT_EQ(fittingNumber(123456789, 8, true).value_or(""), "1.2346+8");
  EXPECT_FALSE(fittingNumber(123456789, 3, true));
}
