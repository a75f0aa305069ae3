// SPDX-License-Identifier: BSD-3-Clause
#include "Case.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace soak
{
using morph::Index;
using morph::Points;

Case::Case(int cells, unsigned seed)
  : size_(cells)
  , random_(seed)
  , grid_(grids::hexes(cells))
  , rest_(grids::boundary(this->grid_, [](const grids::Row& x) { return x; }))
{
}

double Case::random(double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(this->random_);
}

Points Case::motion()
{
  const double turn = this->random(-.4, .4) / this->size_;
  const double bulge = this->random(-.1, .1) / this->size_;
  const double half = this->size_ / 2;
  return grids::mapped(grids::points(this->rest_),
    [&](const grids::Row& at)
    {
      const double x = at[0] - half, y = at[1] - half;
      const double c = std::cos(turn * at[2]), s = std::sin(turn * at[2]);
      return grids::Row(
        c * x - s * y + half, s * x + c * y + half + bulge * x * x, at[2] + bulge * y * y);
    });
}

vtkSmartPointer<vtkPolyData> Case::boundary()
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(this->rest_);
  result->SetPoints(grids::cloud(this->motion())->GetPoints());
  return result;
}

vtkSmartPointer<vtkPolyData> Case::partOfBoundary()
{
  const Points all = this->motion();
  vtkDataArray* allIds = this->rest_->GetPointData()->GetArray("MorphPointId");
  std::vector<Index> chosen(all.rows());
  std::iota(chosen.begin(), chosen.end(), Index(0));
  std::shuffle(chosen.begin(), chosen.end(), this->random_);
  chosen.resize(chosen.size() * 9 / 10);
  std::vector<Index> ids;
  Points some(static_cast<Index>(chosen.size()), 3);
  for (Index i : chosen)
  {
    some.row(static_cast<Index>(ids.size())) = all.row(i);
    ids.push_back(static_cast<Index>(allIds->GetComponent(i, 0)));
  }
  auto result = grids::cloud(some);
  grids::addIds(result, "MorphPointId", ids);
  return result;
}
}
