# SPDX-License-Identifier: BSD-3-Clause
# find_package() tells a project that finds another VTK than the one the package was built with
# (BUILT).
file(REMOVE_RECURSE "${WORK}")
file(WRITE "${WORK}/vtk/vtk-config.cmake" "set(VTK_FOUND 1)\nset(VTK_VERSION 8.2.0)\n")
file(WRITE "${WORK}/vtk/vtk-config-version.cmake"
  "set(PACKAGE_VERSION 8.2.0)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
execute_process(
  COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/build" -G "${GENERATOR}"
          "-DCMAKE_PREFIX_PATH=${PREFIX}" "-DVTK_DIR=${WORK}/vtk"
  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE message)
string(REGEX REPLACE "[ \n]+" " " message "${message}")
foreach (expected "built with VTK ${BUILT}" "found VTK 8.2.0 in ${WORK}/vtk" "set VTK_DIR")
  string(FIND "${message}" "${expected}" at)
  if (result EQUAL 0 OR at EQUAL -1)
    message(FATAL_ERROR "Expected a failure that says '${expected}', got ${result}: ${message}")
  endif ()
endforeach ()
