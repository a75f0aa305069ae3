// SPDX-License-Identifier: BSD-3-Clause
// The properties of all filters that are one number, as the table of properties has them: defaults,
// ranges, and what is refused.
#include "TestGrids.h"

#include "PropertyRows.h"

#include <vtkNew.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using property_rows::Any;
using property_rows::Kind;
using property_rows::Row;

class Properties : public testing::TestWithParam<Row>
{
protected:
  const Row& Of = GetParam();
  vtkSmartPointer<vtkAlgorithm> Filter = Of.make();
  grids::Listener Listener{ Filter };

  /// A value in the range that is not the default.
  double Other() const
  {
    return this->Of.usual != this->Of.least && this->Of.least > -Any ? this->Of.least
           : this->Of.most < Any                                     ? this->Of.most
                                                                     : 1 - this->Of.usual;
  }
  double Set(double value)
  {
    this->Of.set(this->Filter, value);
    return this->Of.get(this->Filter);
  }
};
}

INSTANTIATE_TEST_SUITE_P(Table, Properties, testing::ValuesIn(property_rows::Rows),
  [](const auto& info) { return std::string(info.param.filter) + info.param.name; });

TEST_P(Properties, HaveTheirDefaultAndSayWhenTheyChange)
{
  EXPECT_EQ(this->Of.get(this->Filter), this->Of.usual);
  const vtkMTimeType time = this->Filter->GetMTime();
  this->Set(this->Of.usual);
  EXPECT_EQ(this->Filter->GetMTime(), time);

  EXPECT_EQ(this->Set(this->Other()), this->Other());

  EXPECT_GT(this->Filter->GetMTime(), time);
  EXPECT_TRUE(this->Listener.Errors.empty());
  std::ostringstream printed;
  this->Filter->Print(printed);
  EXPECT_NE(printed.str().find(std::string(this->Of.name) + ": "), std::string::npos);
}

TEST_P(Properties, AcceptTheEndsOfTheirRangeAndNothingBeyond)
{
  const double good = this->Set(this->Other());
  const bool isNumber = this->Of.kind == Kind::Number;
  std::vector<double> wrong = { this->Of.most < Any ? this->Of.most * 1.001 + 1e-3 : INFINITY,
    this->Of.least > -Any ? this->Of.least * 0.999 - 1e-3 : -INFINITY, NAN };
  if (!isNumber) // the nearest bound, as usual in VTK
  {
    EXPECT_EQ(this->Set(std::min(this->Of.most + 1, double(VTK_INT_MAX))), this->Of.most);
    EXPECT_EQ(this->Set(std::max(this->Of.least - 1, double(VTK_INT_MIN))),
      this->Of.kind == Kind::Flag ? 1 : this->Of.least);
    return;
  }
  for (const double value : wrong)
  {
    this->Listener.Errors.clear();
    EXPECT_EQ(this->Set(value), good) << value;
    ASSERT_EQ(this->Listener.Errors.size(), 1u) << value;
    EXPECT_NE(
      this->Listener.Errors[0].find(std::string(this->Of.name) + " cannot be "), std::string::npos);
    EXPECT_NE(this->Listener.Errors[0].find(this->Of.filter), std::string::npos);
  }
}

TEST(Vectors, AreRefusedAsAWhole)
{
  vtkNew<vtkBoundaryDisplacement> filter;
  filter->SetVector(1, 2, 3);
  grids::Listener listener(filter);
  const vtkMTimeType time = filter->GetMTime();
  const double wrong[3] = { 4, 5, NAN };
  filter->SetVector(wrong);
  filter->SetVector(INFINITY, 5, 6);
  filter->SetVector(1, 2, 3);
  EXPECT_EQ(filter->GetMTime(), time);
  EXPECT_EQ(grids::Row(filter->GetVector()), grids::Row(1, 2, 3));
  ASSERT_EQ(listener.Errors.size(), 2u);
  EXPECT_NE(listener.Errors[0].find("Vector cannot be nan"), std::string::npos);
}
