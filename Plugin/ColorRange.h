// SPDX-License-Identifier: BSD-3-Clause
#ifndef ColorRange_h
#define ColorRange_h

/// Keeps the range of the color map of `ScaledJacobian` while its AutomaticRescaleRangeMode is
/// Never, as it is by default. ParaView's ColorBy and its buttons rescale a map in any mode. With
/// it the break at 0 would move, and valid cells would have the color of inverted ones. Called once
/// when the plugin is loaded.
void MeshMorphingKeepColorRange();

#endif
