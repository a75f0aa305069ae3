// SPDX-License-Identifier: BSD-3-Clause
#ifndef MorphHelp_h
#define MorphHelp_h

/// Tells ParaView's help of the plugin's help pages, which lie in MeshMorphing.qch beside the
/// plugin. Serves a ParaView that cannot put a plugin's pages into the plugin itself (5.12 to 6.0).
class MorphHelp
{
public:
  void startup();
  void shutdown() {}
};

#endif
