// SPDX-License-Identifier: BSD-3-Clause
#ifndef DefaultColors_h
#define DefaultColors_h

/// Sets the default colors of arrays named `ScaledJacobian` and `Role`; called once when the plugin
/// is loaded. The color map of the first is that of Presets/ScaledJacobian.json over [-1, 1], with
/// its break at 0. The second is categories: Stays, Moves, Held, Follows. Settings of the user or
/// the site for these names take precedence.
void MeshMorphingSetDefaultColors();

#endif
