// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Unmet.h"

#include "Support/Error.h"

#include <algorithm>
#include <sstream>

namespace morph::filters::Unmet
{
namespace
{
using morph::Index;
using morph::Points;

constexpr double Rounding = 1e-9; // of the boundary's size

/// Nodes, and the largest distance of one.
class Off
{
public:
  explicit Off(double rounding)
    : Rounding(rounding)
  {
  }
  void Add(Index node, double distance)
  {
    if (distance > this->Rounding)
    {
      this->Nodes.push_back(node);
      this->Largest = std::max(this->Largest, distance);
    }
  }
  void Write(const char* what, std::ostream& text)
  {
    if (!this->Nodes.empty())
    {
      std::sort(this->Nodes.begin(), this->Nodes.end());
      text << " " << this->Nodes.size() << " nodes that " << what << " by up to " << this->Largest
           << ": point ids " << morph::listIds(this->Nodes) << ".";
    }
  }

private:
  double Rounding;
  std::vector<Index> Nodes;
  double Largest = 0;
};
}

void Warn(const BoundaryModel& model, const Choice::Result& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  morph::Monitor& monitor)
{
  const double rounding = Rounding * model.Size();
  Off moving(rounding), held(rounding), off(rounding);
  for (std::size_t i = 0; i < choice.Moving.size(); ++i)
  {
    const Index node = choice.Moving[i];
    moving.Add(node, (result.Moved.row(node) - targets.row(static_cast<Index>(i))).norm());
  }
  for (const Index node : choice.Held)
  {
    held.Add(node, (result.Moved.row(node) - model.Points().row(node)).norm());
  }
  for (const Index s : sliding)
  {
    for (const Index node : model.Geometry().surfaces[s].nodes)
    {
      if (result.Roles[node] == Surroundings::IsZone)
      {
        const Eigen::RowVector3d to = result.Moved.row(node);
        off.Add(node, (surroundings.Slid(model, { s }, node, to) - to).norm());
      }
    }
  }
  std::ostringstream text;
  text.precision(3);
  moving.Write("move miss their places", text);
  held.Write("are held move", text);
  off.Write("slide leave their surfaces", text);
  if (!text.str().empty())
  {
    monitor.warn("Zones and sliding surfaces win over what else is asked of the boundary." +
                 text.str() + " Leave these nodes out of one or the other if that is not meant.");
  }
}
}
