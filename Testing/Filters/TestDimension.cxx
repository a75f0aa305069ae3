// SPDX-License-Identifier: BSD-3-Clause
// Dimensions of a part: distances, angles, radii and thicknesses are asked for as numbers.
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "vtkListedSurfaces.h"
#include "vtkMorphMesh.h"

#include <vtkNew.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

using grids::Row;

namespace
{
using Is = std::function<bool(const Row&)>;

bool isAt(double value, double wanted)
{
  return std::abs(value - wanted) < 1e-9;
}

double radius(const Row& x)
{
  return std::hypot(x[0], x[1]);
}

bool onHole(const Row& x)
{
  return isAt(radius(x), 1);
}
bool onWall(const Row& x)
{
  return isAt(radius(x), 2);
}
bool onBottom(const Row& x)
{
  return isAt(x[2], 0);
}
bool onTop(const Row& x)
{
  return isAt(x[2], 1);
}
bool onX(const Row& x)
{
  return isAt(x[1], 0);
}
bool onY(const Row& x)
{
  return isAt(x[0], 0);
}

/// A quarter of a pipe about the z axis, of radii 1 and 2 and length 1.
vtkSmartPointer<vtkUnstructuredGrid> quarter()
{
  morph::Mesh mesh = meshes::hexes(3, 5, 3);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const double r = 1 + x[0] / 3, phi = M_PI / 2 * x[1] / 5;
      return Row(r * std::cos(phi), r * std::sin(phi), x[2] / 3);
    });
  return grids::make(mesh);
}

std::string surface(vtkDataObject* grid, const Is& is)
{
  return displaced::surfaceName(displaced::make(grid), is);
}

/// A morph of a quarter of a pipe whose surfaces are to have a dimension.
struct Asked
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid = quarter();
  vtkNew<vtkMorphMesh> Filter;
  grids::Listener Listener{ Filter };

  Asked(std::initializer_list<Is> surfaces, double wanted)
  {
    this->Filter->SetInputData(this->Grid);
    for (const Is& is : surfaces)
    {
      this->Filter->AddSurface(surface(this->Grid, is).c_str());
    }
    this->Filter->SetDisplacementToDimension();
    this->Filter->SetDimension(wanted);
  }

  /// Whether all nodes of a surface are `now` in the morphed mesh.
  bool All(const Is& before, const Is& now)
  {
    this->Filter->Update();
    EXPECT_TRUE(this->Listener.Errors.empty()) << this->Listener.Errors[0];
    const morph::Points x = grids::points(this->Grid), y = grids::points(this->Filter->GetOutput());
    int count = 0;
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      if (before(x.row(i)))
      {
        ++count;
        if (!now(y.row(i)))
        {
          ADD_FAILURE() << x.row(i) << " goes to " << y.row(i);
          return false;
        }
      }
    }
    return count > 0;
  }

  std::string Error()
  {
    this->Filter->Update();
    EXPECT_EQ(this->Listener.Errors.size(), 1u);
    return this->Listener.Errors.empty() ? "" : this->Listener.Errors.back();
  }
};
}

TEST(Dimension, ParallelPlanesHaveADistance)
{
  Asked asked({ onBottom, onTop }, 1.3);
  EXPECT_TRUE(asked.All(onTop, [](const Row& y) { return isAt(y[2], 1.15); }));
  EXPECT_TRUE(asked.All(onBottom, [](const Row& y) { return isAt(y[2], -0.15); }));
  EXPECT_NEAR(asked.Filter->GetPresentDimension(), 1, 1e-12);
  // The first is the one with the lower number.
  const bool isBottomFirst = surface(asked.Grid, onBottom) < surface(asked.Grid, onTop);
  asked.Filter->SetDimensionSide(
    isBottomFirst ? vtkMorphMesh::DIMENSION_SIDE_SECOND : vtkMorphMesh::DIMENSION_SIDE_FIRST);
  EXPECT_TRUE(asked.All(onTop, [](const Row& y) { return isAt(y[2], 1.3); }));
  EXPECT_TRUE(asked.All(onBottom, onBottom));
  asked.Filter->SetDimension(0); // as it is
  EXPECT_TRUE(asked.All(onTop, onTop));
}

TEST(Dimension, OtherPlanesHaveAnAngle)
{
  Asked asked({ onX, onY }, 80);
  const auto isTurned = [](double degrees) {
    return [degrees](const Row& y) { return isAt(std::atan2(y[1], y[0]) * 180 / M_PI, degrees); };
  };
  EXPECT_TRUE(asked.All(onX, isTurned(5)));
  EXPECT_TRUE(asked.All(onY, isTurned(85)));
  EXPECT_NEAR(asked.Filter->GetPresentDimension(), 90, 1e-9);
  EXPECT_TRUE(asked.All(onHole, onHole)); // they slide
  asked.Filter->SetDimension(180);
  EXPECT_NE(asked.Error().find("below 180 degrees"), std::string::npos);
}

TEST(Dimension, CoaxialCylindersHaveAThickness)
{
  Asked asked({ onHole, onWall }, 1.2);
  EXPECT_TRUE(asked.All(onHole, [](const Row& y) { return isAt(radius(y), 0.9); }));
  EXPECT_TRUE(asked.All(onWall, [](const Row& y) { return isAt(radius(y), 2.1); }));
  EXPECT_NEAR(asked.Filter->GetPresentDimension(), 1, 1e-9);
  asked.Filter->SetDimension(3.5);
  EXPECT_NE(asked.Error().find("no radius: it has 1."), std::string::npos);
}

TEST(Dimension, ACylinderHasARadius)
{
  Asked asked({ onHole }, 0.8);
  EXPECT_TRUE(asked.All(onHole, [](const Row& y) { return isAt(radius(y), 0.8); }));
  EXPECT_TRUE(asked.All(onTop, onTop));
  EXPECT_NEAR(asked.Filter->GetPresentDimension(), 1, 1e-9);
}

TEST(Dimension, APlaneHasADistanceFromAnAxis)
{
  Asked asked({ onHole, onX }, 0.1); // the plane y = 0 has the axis
  EXPECT_NE(asked.Error().find("is 0, so that it has no direction"), std::string::npos);
}

TEST(Dimension, AnErrorSaysWhyThereIsNone)
{
  const std::string ofPlanes = Asked({ onHole, onTop }, 1).Error();
  EXPECT_NE(ofPlanes.find("are not, by 90 degrees"), std::string::npos) << ofPlanes;
  const std::string ofOne = Asked({ onTop }, 1).Error();
  EXPECT_NE(ofOne.find("A plane alone has no `Dimension`"), std::string::npos) << ofOne;
  const std::string ofThree = Asked({ onTop, onBottom, onX }, 1).Error();
  EXPECT_NE(ofThree.find("and 3 move"), std::string::npos) << ofThree;
}

TEST(Dimension, ATableSaysItBeforeAnythingMoves)
{
  Asked asked({}, 0);
  asked.Filter->UpdateInformation();
  vtkNew<vtkListedSurfaces> listed;
  EXPECT_STREQ(listed->GetDimension(), "");
  listed->SetFilter(asked.Filter);
  for (const Is& is : { Is(onBottom), Is(onTop) })
  {
    listed->AddSurface(surface(asked.Grid, is).c_str());
  }
  const std::string said = listed->GetDimension();
  EXPECT_EQ(said.find("Distance of Surface "), 0u) << said;
  EXPECT_EQ(said.substr(said.size() - 3), ": 1") << said;
  listed->AddSurface(surface(asked.Grid, onX).c_str());
  EXPECT_NE(std::string(listed->GetDimension()).find("and 3 move"), std::string::npos);
}
