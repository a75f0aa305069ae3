// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AttachedNodes.h"

#include <utility>
#include <vector>

namespace morph::distributed
{
AttachedNodes attachedNodes(const DistributedMesh& mesh, const NodePartition& partition)
{
  std::vector<AttachedNodes::Link> links;
  std::vector<Index> anchors;
  const Ranks& ranks = mesh.ranks();
  ranks.together(
    [&]
    {
      links = AttachedNodes::linksOf(mesh.mesh(), mesh.isGhost());
      anchors = mesh.idsOfNodes(AttachedNodes::anchorsOf(mesh.mesh(), links, partition.prescribed));
      for (AttachedNodes::Link& link : links)
      {
        link.a = mesh.nodeId(link.a);
        link.b = mesh.nodeId(link.b);
        if (link.a > link.b)
        {
          std::swap(link.a, link.b);
        }
      }
    });
  return AttachedNodes(mesh.mesh(), ranks.gather(links), ranks.gather(anchors),
    { [&mesh](Index id) { return mesh.nodeOf(id); },
      [&mesh](Index node) { return mesh.owns(node); },
      [&ranks](double* values, std::size_t count) { ranks.sum(values, count); } });
}
}
