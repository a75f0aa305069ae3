# SPDX-License-Identifier: BSD-3-Clause
# The filters as an ordinary VTK module, for C++ applications that link VTK.

vtk_module_scan(
  MODULE_FILES     "${CMAKE_CURRENT_SOURCE_DIR}/Filters/Morphing/vtk.module"
                   "${CMAKE_CURRENT_SOURCE_DIR}/Filters/IO/vtk.module"
  REQUEST_MODULES  MeshMorphing::FiltersMorphing MeshMorphing::FiltersIO
  PROVIDES_MODULES modules
  REQUIRES_MODULES required_modules
  HIDE_MODULES_FROM_CACHE ON)
vtk_module_build(
  MODULES   ${modules}
  PACKAGE   MeshMorphing
  VERSION   "${PROJECT_VERSION}"
  SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
  INSTALL_EXPORT  MeshMorphing
  INSTALL_HEADERS ON
  CMAKE_DESTINATION   "${CMAKE_INSTALL_LIBDIR}/cmake/MeshMorphing"
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/MeshMorphing")
