# SPDX-License-Identifier: BSD-3-Clause
# `cpack -G DEB` in a build that was configured for the prefix /usr, as preset deb is
# (Utilities/package.sh).
set(CPACK_PACKAGE_NAME "meshmorphing")
set(CPACK_PACKAGE_VENDOR "MeshMorphing")
set(CPACK_PACKAGE_CONTACT "The MeshMorphing developers <meshmorphing@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Mesh morphing filters for ParaView and VTK")
string(CONCAT CPACK_PACKAGE_DESCRIPTION
  "Moves the nodes of an existing hexahedral, tetrahedral or mixed mesh so that it fits a changed "
  "boundary: a ParaView plugin, VTK filters for C++ programs, and the command-line tool "
  "morph-mesh.")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What the libraries need is read off them, ParaView's very series included.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libgmp-dev, libmpfr-dev")
if (MESHMORPHING_BUILD_PARAVIEW_PLUGIN)
  # ParaView's own rules put an archive that only its own build can use into the component
  # development.
  set(CPACK_INSTALL_CMAKE_PROJECTS "")
  foreach (component plugin runtime sdk)
    list(APPEND CPACK_INSTALL_CMAKE_PROJECTS
      "${CMAKE_BINARY_DIR}" "${PROJECT_NAME}" "${component}" "/")
  endforeach ()
else ()
  set(CPACK_PACKAGE_NAME "meshmorphing-vtk")
endif ()
include(CPack)
