// SPDX-License-Identifier: BSD-3-Clause
// SlideRounds: surfaces that slide, iterated with the volume.
#include "DisplacedBoundaries.h"

#include "../Core/Meshes.h"
#include "../Core/Motions.h"
#include "../Core/Octree.h"
#include "../Core/PolyhedralMeshes.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr int Side = 6;

bool isAt(double value, double wanted)
{
  return std::abs(value - wanted) < 1e-9;
}

/// Where the bottom z = 0 of the block goes: nowhere at its outer edges, and symmetric to x = 0.
Row push(const Row& x)
{
  const double s = (Side - std::abs(x[0])) * (Side - std::abs(x[1])) / (Side * Side);
  return isAt(x[2], 0) ? Row(0.3 * s * x[0], 0, s) : Row(0, 0, 0);
}

/// The nodes at z = 0 move by `push`.
void configure(vtkMorphMesh* filter, vtkUnstructuredGrid* grid, const grids::Map& motion = push)
{
  grids::addVectors(grid, "Push", grids::mapped(grids::points(grid), motion));
  grids::mark(grid, "Bottom", [](const Row& x) { return isAt(x[2], 0); });
  filter->SetInputData(grid);
  filter->SetMoving(vtkMorphMesh::MOVING_ARRAY);
  filter->SetMovingArray("Bottom");
  filter->SetDisplacementToArray();
  filter->SetDisplacementArray("Push");
  filter->SetSurroundings(vtkMorphMesh::SURROUNDINGS_STAY);
  filter->SetValidity(0);
  vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
}

std::vector<double> ofRounds(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

std::string surface(vtkUnstructuredGrid* grid, const std::function<bool(const Row&)>& is)
{
  auto filter = displaced::make(grid);
  return displaced::surfaceName(filter, is);
}

bool onPlane(const Row& x)
{
  return isAt(x[0], 0);
}

/// A quarter of a pipe about the z axis, of radius 1 to 2 and length 3, in hexahedra.
morph::Mesh quarterPipe()
{
  morph::Mesh mesh = meshes::hexes(4, 8, 8);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double r = 1 + x[0] / 4, phi = M_PI / 2 * x[1] / 8;
      return Row(r * std::cos(phi), r * std::sin(phi), 3 * x[2] / 8);
    });
  return mesh;
}

/// A cylinder of two polyhedra, each as high as it is: three rings of nodes make two of faces.
/// The face between them is a chord, whole or in two quadrilaterals.
morph::Mesh cylinder(bool isWhole)
{
  constexpr int Around = 24;
  morph::Mesh mesh;
  mesh.points.resize(3 * Around, 3);
  for (int i = 0; i < 3 * Around; ++i)
  {
    const double phi = 2 * M_PI * (i % Around) / Around;
    mesh.points.row(i) << std::cos(phi), std::sin(phi), i / Around;
  }
  const auto arc = [](Index first, Index last)
  {
    std::vector<Index> nodes;
    for (Index i = first; i <= last; ++i)
    {
      nodes.push_back(i % Around);
    }
    return nodes;
  };
  using Faces = std::vector<std::vector<Index>>;
  for (const std::vector<Index>& ring : { arc(0, 9), arc(9, Around) })
  {
    Faces faces = { { ring.rbegin(), ring.rend() }, ring };
    for (Index& node : faces[1])
    {
      node += 2 * Around;
    }
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      const Index a = ring[k], b = ring[(k + 1) % ring.size()];
      const bool isChord = k + 1 == ring.size();
      if (isChord && isWhole)
      {
        faces.push_back({ a, b, b + Around, b + 2 * Around, a + 2 * Around, a + Around });
        continue;
      }
      for (const Index up : { 0, Around })
      {
        faces.push_back({ a + up, b + up, b + up + Around, a + up + Around });
      }
    }
    meshes::addPolyhedron(mesh, faces);
  }
  return mesh;
}
}

// Else its center would have to be put back onto the surface, which leaves a force.
TEST(SlideRounds, AFaceInsideWhoseNodesAreAllOnTheSurfaceDoesNotSlide)
{
  double force[2];
  for (const bool isWhole : { false, true })
  {
    auto grid = grids::make(cylinder(isWhole));
    vtkNew<vtkMorphMesh> filter;
    configure(filter, grid,
      [](const Row& x)
      {
        const double phi = std::atan2(x[1], x[0]), to = phi + 0.3 * std::sin(phi);
        return isAt(x[2], 0) ? Row(std::cos(to) - x[0], std::sin(to) - x[1], 0) : Row(0, 0, 0);
      });
    const auto isOfOneFace = [](const Row& x) { return x[1] > 1e-9 && x[1] < 0.51 && x[0] > 0; };
    filter->AddSlidingSurface(surface(grid, isOfOneFace).c_str());
    filter->SetSlideRounds(1);
    grids::update(filter);
    force[isWhole] = ofRounds(filter->GetOutput(), "SlideForce").at(0);
  }
  EXPECT_LT(force[true], 2 * force[false]);
}

TEST(SlideRounds, APlaneOfSymmetryGivesHalfOfTheWholeMesh)
{
  morph::Mesh half = meshes::hexes(Side, Side, Side), whole = meshes::hexes(2 * Side, Side, Side);
  meshes::transform(whole, [](const Row& x) { return Row(x[0] - Side, x[1], x[2]); });
  auto grid = grids::make(half), both = grids::make(whole);
  vtkNew<vtkMorphMesh> filter, expected;
  configure(expected, both);
  expected->Update();
  std::map<std::array<double, 3>, Row> placeOf;
  const Points rest = grids::points(both), wanted = grids::points(expected->GetOutput());
  for (Index n = 0; n < rest.rows(); ++n)
  {
    placeOf[{ rest(n, 0), rest(n, 1), rest(n, 2) }] = wanted.row(n);
  }

  configure(filter, grid);
  filter->AddSlidingSurface(surface(grid, onPlane).c_str());
  const Points from = grids::points(grid);
  double errors[2] = { 0, 0 };
  for (const int rounds : { 0, 3 })
  {
    filter->SetSlideRounds(rounds);
    grids::updateQuietly(filter);
    const Points moved = grids::points(filter->GetOutput());
    for (Index n = 0; n < from.rows(); ++n)
    {
      const Row to = placeOf.at({ from(n, 0), from(n, 1), from(n, 2) });
      errors[rounds > 0] = std::max(errors[rounds > 0], (moved.row(n) - to).norm());
      EXPECT_TRUE(!onPlane(from.row(n)) || std::abs(moved(n, 0)) < 1e-12) << moved(n, 0);
    }
  }
  EXPECT_GT(errors[0], 0.1); // the plane stays
  EXPECT_LT(errors[1], 1e-8);
  const std::vector<double> force = ofRounds(filter->GetOutput(), "SlideForce");
  const std::vector<double> change = ofRounds(filter->GetOutput(), "SlideChange");
  ASSERT_FALSE(force.empty());
  ASSERT_EQ(change.size(), force.size());
  EXPECT_LT(force[0], 1e-7);
  EXPECT_GT(change[0], 0.01);
  EXPECT_NE(std::string(filter->GetSlideReport()).find("round 1: moved by 0."), std::string::npos)
    << filter->GetSlideReport();
  filter->SetSlideRounds(0);
  filter->Update();
  EXPECT_STREQ(filter->GetSlideReport(), "None");
}

TEST(SlideRounds, NodesStayOnACylinderAndTheForceFalls)
{
  auto grid = grids::make(quarterPipe());
  // One end turns and stretches radially by nothing: its nodes stay on the cylinders.
  const auto turn = [](const Row& x)
  {
    const double r = std::hypot(x[0], x[1]), phi = std::atan2(x[1], x[0]);
    const double to = phi + 0.25 * std::sin(2 * phi);
    return isAt(x[2], 0) ? Row(r * std::cos(to) - x[0], r * std::sin(to) - x[1], 0.2)
                         : Row(0, 0, 0);
  };
  vtkNew<vtkMorphMesh> filter;
  configure(filter, grid, turn);
  const Points rest = grids::points(grid);
  const auto radius = [](const Row& x) { return std::hypot(x[0], x[1]); };
  for (const double r : { 1., 2. })
  {
    filter->AddSlidingSurface(
      surface(grid, [&](const Row& x) { return isAt(radius(x), r); }).c_str());
  }
  for (const int c : { 0, 1 })
  {
    filter->AddSlidingSurface(surface(grid, [&](const Row& x) { return isAt(x[c], 0); }).c_str());
  }
  filter->SetSlideRounds(3);
  grids::update(filter);
  const Points moved = grids::points(filter->GetOutput());
  double slid = 0;
  for (Index n = 0; n < rest.rows(); ++n)
  {
    for (const double r : { 1., 2. })
    {
      EXPECT_TRUE(!isAt(radius(rest.row(n)), r) || std::abs(radius(moved.row(n)) - r) < 1e-11)
        << radius(moved.row(n));
    }
    for (const int c : { 0, 1 })
    {
      EXPECT_TRUE(!isAt(rest(n, c), 0) || std::abs(moved(n, c)) < 1e-11) << moved(n, c);
    }
    slid = isAt(rest(n, 2), 0) ? slid : std::max(slid, (moved.row(n) - rest.row(n)).norm());
  }
  EXPECT_GT(slid, 0.1);
  const std::vector<double> force = ofRounds(filter->GetOutput(), "SlideForce");
  const std::vector<double> change = ofRounds(filter->GetOutput(), "SlideChange");
  ASSERT_EQ(force.size(), 3u) << filter->GetSlideReport();
  for (std::size_t i = 0; i < force.size(); ++i)
  {
    EXPECT_LT(force[i], i > 0 ? force[i - 1] : 1);
    EXPECT_TRUE(i == 0 || change[i] < change[i - 1]);
  }
  EXPECT_LT(force[2], 1e-2) << filter->GetSlideReport();
}

TEST(SlideRounds, MidSideNodesStayInThePlaneWithTheirCorners)
{
  auto grid = grids::make(meshes::quadraticHexes(Side, Side, Side, false));
  vtkNew<vtkMorphMesh> filter;
  configure(filter, grid);
  filter->AddSlidingSurface(surface(grid, onPlane).c_str());
  filter->SetSlideRounds(2);
  grids::update(filter);
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  int midSides = 0;
  for (Index n = 0; n < rest.rows(); ++n)
  {
    if (onPlane(rest.row(n)))
    {
      EXPECT_LT(std::abs(moved(n, 0)), 1e-12);
      const bool isMidSide = std::floor(rest(n, 1)) != rest(n, 1);
      midSides += isMidSide && isAt(rest(n, 2), 1) && moved(n, 2) > rest(n, 2) + 0.05;
    }
  }
  EXPECT_GT(midSides, 3);
}

TEST(SlideRounds, WithoutMotionKeepsTheBitsAndSaysSo)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  auto filter = displaced::moving(grid, [](const Row& x) { return isAt(x[2], 0); });
  filter->AddSlidingSurface(surface(grid, onPlane).c_str());
  filter->SetSlideRounds(3);
  filter->Update();
  EXPECT_STREQ(filter->GetSlideReport(), "None");
  EXPECT_TRUE(grids::points(filter->GetOutput()) == displaced::restPositions(filter->GetOutput()));
}

TEST(SlideRounds, AMeshWithoutAFreeNodeHasNothingToSlide)
{
  auto grid = grids::make(meshes::hexes(Side, Side, 1));
  auto filter = grids::of<vtkMorphMesh>(grid);
  grids::moveBy(filter, .1, .05, 0);
  filter->AddSurface(surface(grid, onPlane).c_str());
  filter->AddSlidingSurface(surface(grid, [](const Row& x) { return isAt(x[0], Side); }).c_str());
  filter->SetSurroundings(vtkMorphMesh::SURROUNDINGS_STAY);
  filter->SetSlideRounds(2);
  grids::update(filter);
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  for (Index n = 0; n < rest.rows(); ++n)
  {
    EXPECT_LE((moved.row(n) - rest.row(n)).norm(), std::hypot(.1, .05) * (1 + 1e-12));
  }
}

TEST(SlideRounds, RefusesWhatItDoesNotKnow)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  const std::string bottom = surface(grid, [](const Row& x) { return isAt(x[2], 0); });
  const std::string side = surface(grid, onPlane);
  const auto message = [&](vtkDataObject* input, bool slides)
  {
    auto filter = displaced::make(input);
    filter->SetMovingToSurfaces();
    filter->AddSurface(bottom.c_str());
    grids::moveBy(filter, 0, 0, 0.1);
    if (slides)
    {
      filter->AddSlidingSurface(side.c_str());
    }
    filter->SetSlideRounds(3);
    const grids::Run listener(filter);
    EXPECT_EQ(listener.Errors.size() + listener.Warnings.size(), 1u);
    return listener.Errors.empty() ? listener.Warnings.at(0) : listener.Errors.at(0);
  };
  EXPECT_NE(message(grid, false).find("no surface is named that slides"), std::string::npos);
  auto boundary = displaced::make(grid);
  boundary->SetMovingToNothing();
  boundary->Update();
  EXPECT_NE(message(boundary->GetOutput(), true).find("the input is a surface"), std::string::npos);
}

TEST(SlideRounds, NodesOfPolyhedraStayOnTwoObliquePlanes)
{
  // Sheared, so that sides at x = 0 and y = 0 meet at an angle of 56 degrees.
  morph::Mesh sheared = meshes::asPolyhedra(meshes::hexes(Side, Side, Side));
  sheared.points.col(0) += sheared.points.col(1) / 1.5;
  auto grid = grids::make(sheared);
  const auto across = [](const Row& x) { return x[0] - x[1] / 1.5; };
  vtkNew<vtkMorphMesh> filter;
  configure(filter, grid,
    [&](const Row& x) { return Row(0, 0, isAt(x[2], 0) ? .1 * (across(x) + x[1]) : 0); });
  filter->AddSlidingSurface(
    surface(grid, [&](const Row& x) { return isAt(across(x), 0); }).c_str());
  filter->AddSlidingSurface(surface(grid, [](const Row& x) { return isAt(x[1], 0); }).c_str());
  filter->SetSlideRounds(3);
  grids::update(filter);
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  for (Index i = 0; i < rest.rows(); ++i)
  {
    if (isAt(across(rest.row(i)), 0))
    {
      EXPECT_NEAR(across(moved.row(i)), 0, 1e-9) << i;
    }
    if (isAt(rest(i, 1), 0))
    {
      EXPECT_NEAR(moved(i, 1), 0, 1e-9) << i;
    }
  }
}

TEST(SlideRounds, ReproduceAffineMotionsOfPolyhedraAndOctrees)
{
  const morph::Mesh pyramids = meshes::hexesAndPyramids(Side, Side, Side);
  for (const morph::Mesh& mesh : { meshes::asPolyhedra(pyramids), meshes::refinedLayer(3),
         meshes::Octree(meshes::seed(), 1, { 3, 3, 3 }).mesh })
  {
    auto grid = grids::make(mesh);
    const Points rest = grids::points(grid);
    const auto isSide = [&](const Row& x)
    {
      return onPlane(x) && !isAt(x[1], 0) && !isAt(x[1], rest.col(1).maxCoeff()) &&
             !isAt(x[2], 0) && !isAt(x[2], rest.col(2).maxCoeff());
    };
    const grids::Map motion = [](const Row& x) { return Row(.1 * x[0], .2 * x[1], .1 * x[1]); };
    vtkNew<vtkMorphMesh> filter;
    configure(filter, grid, motion);
    grids::mark(grid, "Bottom", [&](const Row& x) { return !isSide(x); });
    filter->AddSlidingSurface(surface(grid, onPlane).c_str());
    filter->SetSlideRounds(1);

    grids::update(filter);

    const Points wanted = rest + grids::mapped(rest, motion);
    EXPECT_LT(motions::difference(grids::points(filter->GetOutput()), wanted), 1e-9);
  }
}
