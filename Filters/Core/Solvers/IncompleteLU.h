// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultiVector.h"

namespace morph
{
/// Incomplete factorisation A = L U without fill-in, as a preconditioner. For an M-matrix all
/// pivots are positive (Meijerink and van der Vorst, Math. Comp. 31 (1977) 148-162); for others a
/// pivot next to zero is replaced by the diagonal entry. Sequential. Cost: 8 bytes an entry; a
/// product of the rows' lengths to make, a pass over the matrix to apply.
class IncompleteLU
{
public:
  /// `matrix`: sorted columns, positive diagonal; must outlive this object.
  explicit IncompleteLU(const CsrMatrix& matrix);
  /// x = (L U)^-1 x.
  void apply(MultiVector& x) const;

private:
  const CsrMatrix* matrix_;
  /// L below the diagonal (its own diagonal is 1), U above, and the inverse of U's diagonal
  std::vector<double> value_;
  std::vector<int> diagonal_; ///< place of each diagonal entry
};
}
