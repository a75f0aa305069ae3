# SPDX-License-Identifier: BSD-3-Clause
# Include before find_package(ParaView) or find_package(VTK). Debian's paraview-dev 5.13 and 6.1
# export Python modules by names that the package does not hold: vtkCommonCore.so where the file is
# vtkCommonCore.cpython-313-x86_64-linux-gnu.so. CMake refuses the whole package for that, though
# nothing here links to a Python module. It leaves a target unchecked where this variable of its own
# names a folder (CMake 3.28 and later, which these Debians have).
foreach (folder IN ITEMS "" "vtk/")
  file(GLOB exports
    "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/paraview-*/${folder}*Python*-targets-*.cmake")
  foreach (export IN LISTS exports)
    file(STRINGS "${export}" lines REGEX "_cmake_import_check_files_for_")
    foreach (line IN LISTS lines)
      string(REGEX MATCH "check_files_for_([^ ]+) \"[$]{_IMPORT_PREFIX}([^\"]+)\"" line "${line}")
      if (line AND NOT EXISTS "/usr${CMAKE_MATCH_2}")
        set("_cmake_import_check_xcframework_for_${CMAKE_MATCH_1}" "${CMAKE_CURRENT_LIST_DIR}")
      endif ()
    endforeach ()
  endforeach ()
endforeach ()
