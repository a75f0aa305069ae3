// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "BoundaryMover/Surroundings.h"
#include "Private/Project/Target.h"

#include <vtkType.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkPolyData;

namespace morph::filters
{
/// Moves a part of a boundary onto a target surface. The target is kept while it, the mesh and the
/// options are the same.
class FitToTarget
{
public:
  enum class Project
  {
    Closest,
    Along
  };

  struct Options
  {
    bool Align = false;       ///< the target rigidly onto the mesh first
    double FeatureAngle = 25; ///< degrees, for the target's feature edges
    double Angle = 60;        ///< degrees, largest between normals of mesh and target
    double Reach = 0;         ///< how far a node may go, in the unit of the points
    Project How = Project::Closest;
    /// of Along; zero: each node's normal
    Eigen::RowVector3d Direction = Eigen::RowVector3d::Zero();
  };

  /// The nodes on vertices and curves of what moves that are on sliding surfaces, too.
  class Rim
  {
  public:
    using Row = Eigen::RowVector3d;
    Rim(const BoundaryModel& model, const Choice& choice, const std::vector<morph::Index>& sliding,
      Surroundings& surroundings);

    bool Has(morph::Index node) const { return this->Nodes.count(node) > 0; }
    /// Whether surfaces that move meet there.
    bool IsOnEdge(morph::Index node) const { return this->Nodes.at(node).Moving > 1; }
    /// The direction nearest to that one in which a node stays on its sliding surfaces, of unit
    /// length.
    Row Along(morph::Index node, const Row& direction) const;
    /// Finds the point near `x` on the sliding surfaces and where `find`(x, y) leads to, by
    /// alternating projections. Returns false where that leads nowhere. Several threads may call
    /// it.
    template <typename Find>
    bool Meet(morph::Index node, const Row& x, const Find& find, Row& y) const
    {
      constexpr int Rounds = 100;
      y = x;
      for (int round = 0; round < Rounds; ++round)
      {
        Row there;
        if (!find(y, there))
        {
          return false;
        }
        y = this->Surfaces.slid(this->Model, this->Nodes.at(node).Sliding, node, there);
        if ((y - there).norm() <= 1e-14 * this->Model.size)
        {
          break;
        }
      }
      return true;
    }

  private:
    struct Node
    {
      std::vector<morph::Index> Sliding; ///< surfaces
      int Moving = 0;                    ///< surfaces with faces that move
    };
    const BoundaryModel& Model;
    Surroundings& Surfaces;
    std::map<morph::Index, Node> Nodes;
  };

  /// Takes the target. `choice`: what moves, onto which it is aligned; null for the whole boundary.
  /// Throws morph::Error as Target does.
  void Update(vtkPolyData* target, const BoundaryModel& model, const Choice* choice,
    const Options& options, morph::Monitor& monitor);

  /// Names of the surfaces that the target belongs to. Each is the nearest one for an area of the
  /// target of at least half its own. Throws morph::Error where there is none.
  std::set<std::string> NearestSurfaces(const BoundaryModel& model) const;

  /// The positions of choice.moving on the target, #Moving x 3. Closest: vertices go to vertices of
  /// the target, then curves to its feature edges, then surfaces follow and go to the target, as in
  /// vtkMorphBoundary. What has no such place within reach goes to the nearest place of the target.
  /// Along: each node goes to the nearest place of the target along the direction; what has none
  /// follows the others, but for vertices, which stay. Nodes on surfaces that slide, by their
  /// numbers in `sliding`, go to places that are on both. A warning names nodes that do not reach
  /// the target. Throws morph::Error where none does.
  morph::Points Targets(const BoundaryModel& model, const Choice& choice,
    const std::vector<morph::Index>& sliding, Surroundings& surroundings, morph::Monitor& monitor);

  /// The triangles that nodes go to: the target as aligned.
  vtkPolyData* Surface() const { return this->Place ? this->Place->Surface() : nullptr; }

private:
  void MoveAlong(const BoundaryModel& model, const Choice& choice, const Rim& rim,
    morph::BoundaryMotion& motion, std::vector<morph::Index>& missed);

  const vtkPolyData* Input = nullptr; ///< compared, never used
  vtkMTimeType InputTime = 0;
  vtkIdType MotionVersion = -1;
  Options Made;
  std::vector<morph::Index> AlignedOnto;
  std::unique_ptr<Target> Place;
};
}
