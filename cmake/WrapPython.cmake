# SPDX-License-Identifier: BSD-3-Clause
# `import meshmorphing`: the filters in the Python that VTK was built with.
vtk_module_python_default_destination(python_destination)
vtk_module_wrap_python(
  MODULES             MeshMorphing::FiltersMorphing MeshMorphing::FiltersIO
  TARGET              MeshMorphing::Python
  PYTHON_PACKAGE      meshmorphing
  MODULE_DESTINATION  "${python_destination}"
  LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  INSTALL_HEADERS     OFF
  COMPONENT           runtime)
configure_file(Python/__init__.py.in
  "${CMAKE_BINARY_DIR}/${python_destination}/meshmorphing/__init__.py" @ONLY)
configure_file(Python/_morph.py
  "${CMAKE_BINARY_DIR}/${python_destination}/meshmorphing/_morph.py" COPYONLY)
install(FILES "${CMAKE_BINARY_DIR}/${python_destination}/meshmorphing/__init__.py" Python/_morph.py
  DESTINATION "${python_destination}/meshmorphing"
  COMPONENT   runtime)
