// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that stay images of each other.
#include "DisplacedBoundaries.h"

#include "vtkFEMWarpMorph.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr double Angle = 0.7; // of the sector
constexpr int Around = 6;

/// A passage between two curved sides, each the other one turned about an axis along z through
/// (3, -2): hub at radius 1, casing at 2.
Row passage(const Row& x)
{
  const double r = 1 + x[0] / 4, angle = Angle * x[1] / Around + 0.2 * std::sin(x[2] + r);
  return Row(3 + r * std::cos(angle), -2 + r * std::sin(angle), x[2] / 2);
}

/// `box`: whose points have the coordinates 0 to 4, 0 to Around, 0 to 4.
vtkSmartPointer<vtkUnstructuredGrid> mapped(morph::Mesh box, const grids::Map& map)
{
  meshes::transform(box, map);
  return grids::make(box);
}

/// Some nodes of the surface x = 0 beside the side y = 0 move by `by`.
vtkSmartPointer<vtkBoundaryDisplacement> moved(vtkUnstructuredGrid* grid, const Row& by)
{
  auto filter = displaced::make(grid);
  filter->SetMovingToSelection();
  const Points box = meshes::hexes(4, Around, 4).points;
  std::vector<Index> ids;
  for (Index i = 0; i < box.rows(); ++i)
  {
    if (box(i, 0) == 0 && box(i, 1) < 2 && box(i, 2) > 0.5 && box(i, 2) < 3.5)
    {
      ids.push_back(i);
    }
  }
  filter->SetSelectionData(displaced::indices(vtkSelectionNode::POINT, ids));
  grids::moveBy(filter, by[0], by[1], by[2]);
  return filter;
}

/// "Surface 2 = Surface 4": the two whose nodes have the coordinate 0 and `end` in the box.
std::string pair(vtkBoundaryDisplacement* filter, const grids::Map& map, int axis, double end)
{
  const Points box = meshes::hexes(4, Around, 4).points;
  const auto name = [&](double at)
  {
    return displaced::surfaceName(filter,
      [&](const Row& x)
      {
        for (Index i = 0; i < box.rows(); ++i)
        {
          if ((map(box.row(i)) - x).norm() < 1e-9)
          {
            return box(i, axis) == at;
          }
        }
        return false;
      });
  };
  return name(0) + " = " + name(end);
}

/// How far displacements u of nodes with coordinate 0 and of their images are from R u.
double deviation(vtkBoundaryDisplacement* filter, int axis, double end, const Eigen::Matrix3d& R)
{
  grids::update(filter);
  const Points box = meshes::hexes(4, Around, 4).points;
  const Points step =
    grids::points(filter->GetOutput()) - displaced::restPositions(filter->GetOutput());
  vtkDataArray* ids = filter->GetOutput()->GetPointData()->GetArray("MorphPointId");
  std::map<Index, Index> places;
  for (Index i = 0; i < step.rows(); ++i)
  {
    places[static_cast<Index>(ids->GetTuple1(i))] = i;
  }
  double most = 0, largest = 0;
  for (const auto& [id, place] : places)
  {
    if (box(id, axis) != 0)
    {
      continue;
    }
    Row image = box.row(id);
    image[axis] = end;
    for (Index other = 0; other < box.rows(); ++other)
    {
      if (box.row(other) == image)
      {
        most =
          std::max(most, (step.row(places.at(other)) - step.row(place) * R.transpose()).norm());
        largest = std::max(largest, step.row(place).norm());
      }
    }
  }
  EXPECT_GT(largest, 0.01);
  return most;
}
}

TEST(PeriodicSides, StayImagesByARotation)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(Angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int method = 0; method < 3; ++method)
  {
    auto filter = moved(mapped(meshes::hexes(4, Around, 4), passage), Row(-0.1, 0.05, 0.03));
    filter->SetSurfaceMethod(method);
    EXPECT_GT(deviation(filter, 1, Around, turn), 0.01) << "nothing ties them";
    filter->SetPeriodicSurfaces(pair(filter, passage, 1, Around).c_str());
    EXPECT_LT(deviation(filter, 1, Around, turn), 1e-12);
  }
}

TEST(PeriodicSides, TwoPairsOfABoxMoveAllCornersAlike)
{
  const grids::Map skewed = [](const Row& x) -> Row {
    return { x[0] + 0.2 * x[1], x[1], x[2] + 0.1 * std::sin(x[2]) };
  };
  auto filter = moved(mapped(meshes::hexes(4, Around, 4), skewed), Row(0, 0.1, 0.2));
  filter->SetPeriodicSurfaces(
    (pair(filter, skewed, 0, 4) + "; " + pair(filter, skewed, 1, Around)).c_str());
  EXPECT_LT(deviation(filter, 0, 4, Eigen::Matrix3d::Identity()), 1e-12);
  EXPECT_LT(deviation(filter, 1, Around, Eigen::Matrix3d::Identity()), 1e-12);
}

TEST(PeriodicSides, AMorphKeepsThemImages)
{
  const auto grid = mapped(meshes::hexes(4, Around, 4), passage);
  auto filter = moved(grid, Row(-0.1, 0.05, 0.03));
  filter->SetPeriodicSurfaces(pair(filter, passage, 1, Around).c_str());
  auto morph = grids::of<vtkFEMWarpMorph>(grid);
  morph->SetBoundaryConnection(filter->GetOutputPort());
  morph->Update();
  const Points points = grids::points(morph->GetOutput()), box = meshes::hexes(4, Around, 4).points;
  const Eigen::Isometry3d turn = Eigen::Translation3d(3, -2, 0) *
                                 Eigen::AngleAxisd(Angle, Eigen::Vector3d::UnitZ()) *
                                 Eigen::Translation3d(-3, 2, 0);
  const Index row = 5, layer = 5 * (Around + 1); // of the box's numbers
  for (Index k = 0; k < 5; ++k)
  {
    for (Index i = 0; i < 5; ++i)
    {
      const Index left = i + layer * k, right = left + row * Around;
      ASSERT_EQ(box.row(right), box.row(left) + Row(0, Around, 0));
      const Eigen::Vector3d image = turn * points.row(left).transpose();
      EXPECT_LT((image.transpose() - points.row(right)).norm(), 1e-12);
    }
  }
}

TEST(PeriodicSides, WhatCannotBeIsSaid)
{
  const auto grid = mapped(meshes::hexes(4, Around, 4), passage);
  const std::string sides = pair(moved(grid, Row(0, 0, 0)), passage, 1, Around),
                    rims = pair(moved(grid, Row(0, 0, 0)), passage, 0, 4);
  const auto error = [&](const std::string& text, bool isFree = false)
  {
    auto filter = moved(grid, Row(-0.1, 0, 0));
    filter->SetPeriodicSurfaces(text.c_str());
    if (isFree)
    {
      filter->AddFreeSurface(sides.substr(0, sides.find(" =")).c_str());
    }
    const grids::Run listener(filter);
    return listener.Errors.empty() ? std::string() : listener.Errors[0];
  };
  EXPECT_NE(error("Surface 0").find("is no pair of names"), std::string::npos);
  EXPECT_NE(error("Surface 0 = Nowhere").find("'Nowhere'"), std::string::npos);
  EXPECT_NE(error(rims).find("no images of each other"), std::string::npos);
  EXPECT_NE(error(sides, true).find("are free"), std::string::npos);
  EXPECT_EQ(error("none"), "");
}

TEST(PeriodicSides, MotionsOfBothSidesThatAreNoImagesTakeTheMean)
{
  const auto grid = mapped(meshes::hexes(4, Around, 4), passage);
  auto filter = moved(grid, Row(0, 0, 0));
  const std::string hub = pair(filter, passage, 0, 4);
  filter->SetMovingToSurfaces();
  filter->AddSurface(hub.substr(0, hub.find(" =")).c_str());
  filter->SetPeriodicSurfaces(pair(filter, passage, 1, Around).c_str());
  const auto warnings = [&](const Row& by)
  {
    filter->SetVector(by[0], by[1], by[2]);
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    std::string all;
    for (const std::string& warning : listener.Warnings)
    {
      all += warning;
    }
    return all;
  };
  EXPECT_EQ(warnings(Row(0, 0, 0.1)).find("win over"), std::string::npos); // along the axis
  EXPECT_NE(
    warnings(Row(0.1, 0, 0)).find("10 nodes that move miss their places"), std::string::npos);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(Angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT(deviation(filter, 1, Around, turn), 1e-12);
}
