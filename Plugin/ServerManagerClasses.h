// SPDX-License-Identifier: BSD-3-Clause
#ifndef ServerManagerClasses_h
#define ServerManagerClasses_h

/// Called once when the plugin is loaded, before its XML is read: lets ParaView make this plugin's
/// own server-manager classes by the names that the XML gives them.
void MeshMorphingRegisterServerManagerClasses();

#endif
