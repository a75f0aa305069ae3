# SPDX-License-Identifier: BSD-3-Clause
# Makes from Filters/Morphing/Properties.ini what properties.py says: `kind` is cxx, xml or json,
# `output` a folder or file. It runs again where the table, a template or the script changes.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function (morph_properties kind output)
  set(script "${PROJECT_SOURCE_DIR}/cmake/properties.py")
  file(GLOB inputs CONFIGURE_DEPENDS
    "${PROJECT_SOURCE_DIR}/Filters/Morphing/vtk*.h.in"
    "${PROJECT_SOURCE_DIR}/Plugin/*.xml.in"
    "${PROJECT_SOURCE_DIR}/Plugin/Properties/*.xml")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    "${script}" "${PROJECT_SOURCE_DIR}/Filters/Morphing/Properties.ini" ${inputs})
  execute_process(
    COMMAND "${Python3_EXECUTABLE}" -B "${script}" "${kind}" "${output}"
    RESULT_VARIABLE result)
  if (NOT result EQUAL 0)
    message(FATAL_ERROR "${script} ${kind} has failed.")
  endif ()
endfunction ()
