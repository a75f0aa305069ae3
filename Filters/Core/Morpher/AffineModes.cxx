// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/AffineModes.h"

#include "Support/Error.h"
#include "Support/Parallel.h"

#include <cmath>

namespace morph
{
void AffineModes::prepare(const LinearMorpher& method, const AffineFields& fields, Monitor& monitor)
{
  this->clear();
  // The weight has no unit. In that of p, neither is rounding beside the other.
  const double place =
    method.processes().maximum(fields.rows() > 0 ? fields.rightCols<3>().cwiseAbs().maxCoeff() : 0);
  const double unit = place > 0 && std::isfinite(place) ? std::exp2(std::ilogb(place)) : 1;
  AffineFields scaled = fields;
  scaled.col(0) *= unit;
  this->modes_ = method.fields(scaled, monitor, &this->report_);
  this->modes_.col(0) /= unit;
  this->tolerance_ = method.tolerance();
  this->given_ = fields; // last: what throws above leaves nothing prepared
}

void AffineModes::clear()
{
  this->given_.resize(0, 4);
  this->modes_.resize(0, 4);
}

bool AffineModes::isPreparedFor(const LinearMorpher& method, const AffineFields& fields) const
{
  return this->modes_.rows() > 0 && this->tolerance_ == method.tolerance() &&
         this->given_.rows() == fields.rows() && this->given_ == fields;
}

EvaluateReport AffineModes::evaluate(const LinearMorpher& method, const AffineMotion& motion,
  const ConstPoints& prescribed, Points& moved, Monitor& monitor) const
{
  const Points& rest = method.restPoints();
  const std::vector<Index>& ids = method.partition().prescribed;
  if (this->modes_.rows() != rest.rows() || prescribed.rows() != static_cast<Index>(ids.size()))
  {
    throw Error("The affine modes are of another mesh or boundary: prepare them for this one.");
  }
  moved.resize(rest.rows(), 3);
  parallel(rest.rows(), monitor,
    [&](Index n)
    {
      const Eigen::RowVector3d displacement = affineDisplacement(motion, this->modes_.row(n));
      for (int j = 0; j < 3; ++j)
      {
        // Bit for bit where nothing moves: -0.0 + 0.0 would be 0.0.
        moved(n, j) = displacement[j] != 0 ? rest(n, j) + displacement[j] : rest(n, j);
      }
    });
  moved(ids, allColumns) = prescribed;
  return this->report_;
}
}
