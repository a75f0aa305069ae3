# SPDX-License-Identifier: BSD-3-Clause
# One MeshMorphing.so: the VTK module and the core are folded in statically, so that no run path can go wrong.

# `cmake --install <dir> --component plugin` leaves out a wrapping archive that ParaView's own rules install.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME plugin)

paraview_plugin_scan(
  PLUGIN_FILES     "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/paraview.plugin"
  PROVIDES_PLUGINS plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
paraview_plugin_build(
  PLUGINS              ${plugins}
  INSTALL_HEADERS      OFF
  ADD_INSTALL_RPATHS   OFF
  LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
  LIBRARY_SUBDIRECTORY "paraview-5.11/plugins")
