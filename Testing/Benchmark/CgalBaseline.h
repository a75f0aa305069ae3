// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <memory>
#include <vector>

namespace benchmark
{
/// CGAL by itself, on one thread, as a program without this library would use it.
class CgalBaseline
{
public:
  /// Tessellates the sites, #sites x 3.
  explicit CgalBaseline(const morph::Points& sites);
  ~CgalBaseline();

  double delaunaySeconds() const;
  /// Locates the places one after another, each walk from the last cell; returns the seconds.
  double locate(const morph::Points& places) const;

  struct Sibson
  {
    double seconds = 0;              ///< of CGAL's function alone
    std::vector<morph::Index> sites; ///< natural neighbors
    std::vector<double> weights;     ///< their normalized coordinates
  };
  /// sibson_natural_neighbor_coordinates_3. Throws std::runtime_error where it finds none.
  Sibson sibson(const Eigen::RowVector3d& x) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
