// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Unmet.h"

#include "Support/Error.h"

#include <algorithm>
#include <sstream>

namespace morph
{
namespace
{
constexpr double Rounding = 1e-9; // of the boundary's size

/// Nodes, and the largest distance of one.
class Off
{
public:
  explicit Off(double rounding)
    : rounding_(rounding)
  {
  }
  void add(Index node, double distance)
  {
    if (distance > this->rounding_)
    {
      this->nodes_.push_back(node);
      this->largest_ = std::max(this->largest_, distance);
    }
  }
  void write(const char* what, std::ostream& text)
  {
    if (!this->nodes_.empty())
    {
      std::sort(this->nodes_.begin(), this->nodes_.end());
      text << " " << this->nodes_.size() << " nodes that " << what << " by up to " << this->largest_
           << ": point ids " << listIds(this->nodes_) << ".";
    }
  }

private:
  double rounding_;
  std::vector<Index> nodes_;
  double largest_ = 0;
};
}

void warnOfUnmet(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  Monitor& monitor)
{
  const double rounding = Rounding * model.size;
  Off moving(rounding), held(rounding), off(rounding);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    const Index node = choice.moving[i];
    moving.add(node, (result.moved.row(node) - targets.row(static_cast<Index>(i))).norm());
  }
  for (const Index node : choice.held)
  {
    held.add(node, (result.moved.row(node) - model.points().row(node)).norm());
  }
  for (const Index s : sliding)
  {
    for (const Index node : model.geometry.surfaces[s].nodes)
    {
      if (result.roles[node] == Surroundings::IsZone)
      {
        const Eigen::RowVector3d to = result.moved.row(node);
        off.add(node, (surroundings.slid(model, { s }, node, to) - to).norm());
      }
    }
  }
  std::ostringstream text;
  text.precision(3);
  moving.write("move miss their places", text);
  held.write("are held move", text);
  off.write("slide leave their surfaces", text);
  if (!text.str().empty())
  {
    monitor.warn(
      "Zones, sliding and periodic surfaces win over what else is asked of the boundary." +
      text.str() + " Leave these nodes out of one or the other if that is not meant.");
  }
}
}
