// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Meshes.h"
#include "Morpher/Morpher.h"
#include "Support/Error.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

/// Motions of the outer boundary, for the tests of the morphing methods.
namespace motions
{
using Row = Eigen::RowVector3d;
using Map = std::function<Row(const Row&)>;

/// Shear, stretch and shift.
Row affine(const Row& x);
/// Not affine: a twist about the z axis through the middle of a box of width `w` and height `h`,
/// stretched along z.
Row twist(const Row& x, double w, double h, double angle);
/// That of a cube of `size`.
Map twistOf(double size, double angle = 1.2);
/// Far from affine.
Row bend(const Row& x);

/// `map` applied to each row.
morph::Points mapped(const morph::Points& points, const Map& map);
/// The mesh's outer nodes are prescribed.
morph::NodePartition outerPartition(const morph::Mesh& mesh);
/// Where `map` takes the prescribed nodes.
morph::Points targets(
  const morph::Mesh& mesh, const morph::NodePartition& partition, const Map& map);
/// meshes::all() at 4 x 4 x 4, their inner nodes jittered.
std::vector<std::pair<std::string, morph::Mesh>> jittered();
/// meshes::all() at 4 x 4 x 4, every node moved a little, those on the outside as well: no four
/// nodes of a plane, no five of a sphere.
std::vector<std::pair<std::string, morph::Mesh>> inGeneralPosition();
/// Quarter turns about the axes and a reflection, which take a cube about the origin to itself.
const std::vector<Eigen::Matrix3d>& symmetries();
/// Of a symmetric set of points, the one to which `symmetry` takes each.
std::vector<morph::Index> images(const morph::Points& points, const Eigen::Matrix3d& symmetry);
/// 0, 1, ... n - 1 in random order.
std::vector<morph::Index> shuffledNumbers(morph::Index n);

/// The mesh as a prepared method moves it. `target`: #prescribed x 3.
morph::Points moved(
  const morph::Morpher& method, const morph::ConstPoints& target, morph::Monitor& monitor);
/// The same, after preparing the method.
morph::Points morphed(morph::Morpher& method, const morph::Mesh& mesh,
  const morph::NodePartition& partition, const morph::ConstPoints& target, morph::Monitor& monitor);

/// The largest absolute difference of two sets of points.
double difference(const morph::Points& a, const morph::Points& b);
/// Equal to the last bit, signs of zeros included.
bool identical(const morph::Points& a, const morph::Points& b);

/// What the report counts under that name. Fails the test where there is none.
morph::Index count(const morph::EvaluateReport& report, const std::string& name);

/// Expects that `call` throws a morph::Error, of that kind, that has this part.
///@{
void expectError(const std::function<void()>& call, const std::string& part);
void expectError(
  morph::Error::Kind kind, const std::function<void()>& call, const std::string& part);
///@}
/// The kind of the morph::Error that `call` throws, and its message. Fails the test where it throws
/// none.
morph::Error::Kind kindOf(const std::function<void()>& call, std::string& message);
std::string messageOf(const std::function<void()>& call);
}
