// SPDX-License-Identifier: BSD-3-Clause
#ifndef DefaultColors_h
#define DefaultColors_h

/// Called once when the plugin is loaded: from then on arrays named `ScaledJacobian` get the color
/// map of Presets/ScaledJacobian.json over [-1, 1], with its break at 0, unless the user's or the
/// site's settings hold another default for that name.
void MeshMorphingSetDefaultColors();

#endif
