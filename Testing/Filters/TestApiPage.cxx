// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include <vtkNew.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

// The program of the page.
#define main apiPageProgram
#include "ApiPageExample.inc" // made from Documentation/API.md
#undef main

TEST(ApiPage, CxxExample)
{
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName("part.vtu");
  writer->SetInputData(grids::make(meshes::hexes(4, 4, 4)));
  writer->SetDataModeToBinary();
  ASSERT_EQ(writer->Write(), 1);

  std::ostringstream printed;
  std::streambuf* screen = std::cout.rdbuf(printed.rdbuf());
  EXPECT_EQ(apiPageProgram(), 0);
  std::cout.rdbuf(screen);
  std::remove("part.vtu");

  std::istringstream numbers(printed.str());
  std::string status;
  double minimum = 0;
  int inverted = -1;
  ASSERT_TRUE(numbers >> status >> minimum >> inverted) << printed.str();
  EXPECT_EQ(status, "Valid");
  // std::cout shows six digits.
  EXPECT_NEAR(minimum, 1 / std::hypot(1, .1), 1e-5);
  EXPECT_EQ(inverted, 0);
}
