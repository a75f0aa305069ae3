# SPDX-License-Identifier: BSD-3-Clause
# find_package() tells a project what is missing: the VTK that the package was built with (BUILT),
# if there is none or another, and Eigen. SOURCE: the project; PREFIX: where the package is.
file(REMOVE_RECURSE "${WORK}")
file(WRITE "${WORK}/vtk/vtk-config.cmake" "set(VTK_FOUND 1)\nset(VTK_VERSION 8.2.0)\n")
file(WRITE "${WORK}/vtk/vtk-config-version.cmake"
  "set(PACKAGE_VERSION 8.2.0)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n")

function (expect_failure option)
  file(REMOVE_RECURSE "${WORK}/build")
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/build" -G "${GENERATOR}"
            "-DCMAKE_PREFIX_PATH=${PREFIX}" "${option}"
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE message)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  foreach (expected IN LISTS ARGN)
    string(FIND "${message}" "${expected}" at)
    if (result EQUAL 0 OR at EQUAL -1)
      message(FATAL_ERROR
        "Expected a failure that says '${expected}', got ${result}: ${message}")
    endif ()
  endforeach ()
endfunction ()

expect_failure("-DVTK_DIR=${WORK}/vtk"
  "built with VTK ${BUILT}" "found VTK 8.2.0 in ${WORK}/vtk" "set VTK_DIR")
expect_failure(-DCMAKE_DISABLE_FIND_PACKAGE_VTK=ON
  "built with VTK ${BUILT}, which is not found: set VTK_DIR")
expect_failure(-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON "Eigen3")
