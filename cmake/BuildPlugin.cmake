# SPDX-License-Identifier: BSD-3-Clause
# One MeshMorphing.so: the VTK module and the core are linked into it statically, so that no run
# path can go wrong.

# `cmake --install <dir> --component plugin` leaves out a wrapping archive that ParaView's own rules
# install.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME plugin)

paraview_plugin_scan(
  PLUGIN_FILES     "${CMAKE_CURRENT_SOURCE_DIR}/paraview.plugin"
  PROVIDES_PLUGINS plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)

# ParaView adds the folder of the file that it has scanned, which would be this project again: the
# plugin's own is Plugin/. A copy of the file in the build tree would not do: what ParaView builds
# from it lies outside that tree, where the build tree is not below the sources.
set(scanned "_paraview_plugin_MeshMorphing_file")
get_property(is_scanned GLOBAL PROPERTY "${scanned}" SET)
if (NOT is_scanned)
  message(FATAL_ERROR
    "This ParaView keeps the place of a plugin's file elsewhere than in the property ${scanned}: "
    "see ParaViewPlugin.cmake.")
endif ()
set_property(GLOBAL PROPERTY "${scanned}" "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/CMakeLists.txt")
paraview_plugin_build(
  PLUGINS              ${plugins}
  INSTALL_HEADERS      OFF
  ADD_INSTALL_RPATHS   OFF
  LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}")
# ParaView's wrappers of the classes, of which each includes little more than its class.
foreach (wrappers IN ITEMS vtkMeshMorphingFiltersMorphingCS vtkMeshMorphingFiltersIOCS)
  if (TARGET ${wrappers})
    set_target_properties(${wrappers} PROPERTIES UNITY_BUILD "${MESHMORPHING_UNITY_BUILD}")
  endif ()
endforeach ()
