// SPDX-License-Identifier: BSD-3-Clause
#ifndef DefaultColors_h
#define DefaultColors_h

/// Sets the default colors of arrays named `ScaledJacobian`; called once when the plugin is loaded.
/// The color map is that of Presets/ScaledJacobian.json over [-1, 1], with its break at 0. Settings
/// of the user or the site for that name take precedence.
void MeshMorphingSetDefaultColors();

#endif
