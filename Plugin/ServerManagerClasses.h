// SPDX-License-Identifier: BSD-3-Clause
#ifndef ServerManagerClasses_h
#define ServerManagerClasses_h

/// Registers this plugin's own server-manager classes with ParaView, under their names in the XML.
/// Called once when the plugin is loaded, before its XML is read.
void MeshMorphingRegisterServerManagerClasses();

#endif
