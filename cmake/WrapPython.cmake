# SPDX-License-Identifier: BSD-3-Clause
# `import meshmorphing.vtk`: the filters in the Python that VTK was built with.
vtk_module_python_default_destination(python_destination)
vtk_module_wrap_python(
  MODULES             MeshMorphing::FiltersMorphing MeshMorphing::FiltersIO
  TARGET              MeshMorphing::Python
  PYTHON_PACKAGE      meshmorphing.vtk
  MODULE_DESTINATION  "${python_destination}"
  LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  INSTALL_HEADERS     OFF
  COMPONENT           runtime)
set(package "${python_destination}/meshmorphing")
configure_file(Python/vtk/__init__.py.in "${CMAKE_BINARY_DIR}/${package}/vtk/__init__.py" @ONLY)
configure_file(Python/vtk/_morph.py "${CMAKE_BINARY_DIR}/${package}/vtk/_morph.py" COPYONLY)
install(FILES "${CMAKE_BINARY_DIR}/${package}/vtk/__init__.py" Python/vtk/_morph.py
  DESTINATION "${package}/vtk"
  COMPONENT   runtime)
# That of Python/CMakeLists.txt, which imports without the extension module, too.
install(FILES "${CMAKE_BINARY_DIR}/${package}/__init__.py"
  DESTINATION "${package}"
  COMPONENT   runtime)
