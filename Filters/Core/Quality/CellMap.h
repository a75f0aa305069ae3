// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/Bernstein.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the power of two that scales the largest coordinate to [2^299, 2^300). It is 1 where all
/// are 0 or one is not finite. Products of three scaled coordinates do not overflow, and they
/// underflow only below 2^-600 of the largest. Scaling is exact but for coordinates smaller still.
double exactScale(const Eigen::Vector3d* points, int count);

/// VTK's parametric map of a volume cell and its Jacobian determinant, both in Bernstein form.
/// Types: 12 and 13, and the quadratic ones, 24 to 27, 29 and 31 to 33.
///
/// Each map is a polynomial over the simplices of its domain, of degree one or two. The corners are
/// the coefficients of a linear one. The missing nodes of a quadratic cell's full lattice are fixed
/// combinations of the cell's own nodes. All these factors are multiples of 1/64, hence exact.
///
/// - 20 and 24 nodes, wedge with 15: the middle of a square is half the sum of its mid-side nodes
///   less a quarter of the sum of its corners. The hexahedron's middle is that of the square at
///   half its height.
/// - Wedge with 12: nodes at half the height are means.
/// - Pyramid with 13: a hexahedron whose upper nodes are all the apex, by the functions of
///   InterpolateFunctions() (as in VTK 9.2, where InterpolateDerivs() belongs to other functions).
///   Its derivatives along r and s have the factor 1 - t, its determinant (1 - t)^2. Both are
///   divided out here; they do not change the sign.
class CellMap
{
public:
  using Vector = Eigen::Vector3d;
  static constexpr int MostNodes = 27, MostTerms = 20; ///< terms: of one derivative

  /// Returns the map of a type, built once, or null for other types.
  static const CellMap* find(std::uint8_t type);

  /// The derivatives of a cell's map along r, s and t.
  struct Derivatives
  {
    Vector c[3][MostTerms]; ///< Bernstein coefficients times their multinomial coefficients
    double largest[3];      ///< of the Bernstein coefficients' components, by magnitude
    double error[3];        ///< bounds of the components' rounding errors
  };
  /// `x`: the nodes in VTK's order, each coordinate scaled to products that do not overflow.
  Derivatives derivatives(const Vector* x) const;
  /// The sums that give the derivatives' terms, of magnitudes.
  struct Magnitudes
  {
    Vector c[3][MostTerms];
  };
  Magnitudes magnitudes(const Vector* x) const;

  /// Computes the determinant's coefficients. Returns a bound of their errors after up to
  /// `halvings` successive subdivisions.
  double determinant(
    const Derivatives& derivatives, int halvings, BernsteinHalving::Coefficients& c) const;
  /// Computes how the sum of the determinant's coefficients times `weights` changes with the nodes.
  void gradient(const Derivatives& derivatives, const BernsteinHalving::Coefficients& weights,
    Vector* gradient) const;

  /// Returns the derivatives at a parametric point as the columns of a matrix. For pyramids, the
  /// derivatives along r and s lack their factor 1 - t.
  Eigen::Matrix3d jacobian(const Derivatives& derivatives, const double (&at)[3]) const;
  /// Whether the determinant is certainly negative at a point whose coordinates are multiples of a
  /// power of two.
  bool isNegative(
    const Derivatives& derivatives, const Magnitudes& magnitudes, const double (&at)[3]) const;

  const BernsteinHalving& halving() const { return this->halving_; }
  /// Returns the number of the determinant's coefficients.
  int terms() const { return this->volumeTerms_; }
  int numberOfNodes() const { return this->nodes_; }
  /// VTK's parametric coordinates of the nodes, the corners first.
  const double (&node(int i) const)[3] { return this->place_[i]; }

private:
  explicit CellMap(std::uint8_t type);

  struct Weight
  {
    std::uint8_t node, reference; ///< it multiplies x[node] - x[reference]
    double value;
  };
  struct Derivative
  {
    BernsteinTerms terms;
    std::vector<Weight> weights; ///< of all terms, times their multinomial coefficients
    std::vector<int> first;      ///< terms + 1
    std::vector<double> inverseMultinomial;
    double errorFactor; ///< times the longest difference
  };
  struct Rows;

  template <typename Sum>
  void evaluate(const double (&at)[3], Sum&& sum) const;
  void setDerivative(int coordinate, const Rows& rows);
  void setProduct();
  /// Computes the coefficients of the cross product of the first two derivatives, times their
  /// multinomial coefficients.
  void areas(const Derivatives& derivatives, Vector* area) const;

  const BernsteinDomain* domain_;
  bool hasApex_;
  int nodes_;
  double place_[MostNodes][3];
  Derivative derivative_[3];
  /// number of the product of a term along r and one along s
  std::vector<std::uint8_t> areaTerm_;
  std::vector<std::uint8_t> volumeTerm_; ///< number of the product of an area term and one along t
  int areaTerms_, volumeTerms_;
  std::vector<double> inverseMultinomial_; ///< of the determinant's terms
  int roundings_; ///< in one coefficient of the determinant, in addition to the derivatives'
  int roundingsOfHalving_;
  BernsteinHalving halving_;
};
}
