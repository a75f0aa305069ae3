// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

#include <Eigen/Core>

#include <functional>
#include <random>
#include <vector>

/// Quadratic volume cells for the tests, with their shape functions written out apart from the
/// library.
namespace quadratic
{
using Vector = Eigen::Vector3d;
using Cell = std::vector<Vector>;
using Point = Eigen::Matrix<long double, 3, 1>; ///< in parametric coordinates
using Gradients = Eigen::Matrix<long double, Eigen::Dynamic, 3>;

/// A cell type, and how far its nodes between corners move for about half of the cells to be
/// inverted inside.
struct Type
{
  std::uint8_t type;
  double amount;
};
extern const std::vector<Type> Types;

/// Nominal places of all nodes.
Cell parametric(std::uint8_t type);
/// The straight-sided cell of a good shape.
Cell ideal(std::uint8_t type);
/// The ideal cell with its corners moved by up to 0.1 and the others by up to `amount`, until the
/// corner cell's scaled Jacobian and the true determinant at all corners are positive.
Cell random(std::uint8_t type, double amount, std::mt19937& generator);

/// One value a node.
Eigen::Matrix<long double, Eigen::Dynamic, 1> functions(std::uint8_t type, const Point& at);
/// Their derivatives. Of the pyramid those along r and s are divided by 1 - t.
Gradients gradients(std::uint8_t type, const Point& at);
Eigen::Matrix<long double, 3, 3> jacobian(const Cell& cell, const Gradients& gradients);
long double determinant(std::uint8_t type, const Cell& cell, const Point& at);

/// The minimum determinant of cells of one type on a fixed lattice of their domain.
class Sampler
{
public:
  using GradientsAt = std::function<Gradients(const Point& at)>;
  /// `lattice`: intervals along each coordinate, the domain's boundary included.
  Sampler(std::uint8_t type, int lattice, const GradientsAt& gradientsAt);
  double minimum(const Cell& cell, Point& at) const;

private:
  std::vector<Point> points_;
  Eigen::MatrixXd gradients_[3]; ///< #points x #nodes
};

/// The minimum determinant that a search with ever shorter steps finds from `from`.
long double searchedMinimum(std::uint8_t type, const Cell& cell, const Point& from);
}
