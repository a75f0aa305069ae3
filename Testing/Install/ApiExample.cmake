# SPDX-License-Identifier: BSD-3-Clause
# Builds the program of the page PAGE as the page says, with the package of PREFIX, and runs it on
# the mesh MODEL. It has to print what the page says.
file(READ "${PAGE}" page)
if (NOT page MATCHES "```c\\+\\+\n([^`]*)```")
  message(FATAL_ERROR "${PAGE} has no C++ example.")
endif ()
file(WRITE "${WORK}/main.cxx" "${CMAKE_MATCH_1}")
if (NOT page MATCHES "```cmake\n([^`]*)```")
  message(FATAL_ERROR "${PAGE} has no CMakeLists.txt.")
endif ()
file(WRITE "${WORK}/CMakeLists.txt" "${CMAKE_MATCH_1}")
if (NOT page MATCHES "the program prints `([^`]*)`")
  message(FATAL_ERROR "${PAGE} does not say what its C++ example prints.")
endif ()
set(said "${CMAKE_MATCH_1}")
configure_file("${MODEL}" "${WORK}/part.vtu" COPYONLY)

function (run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${WORK}" COMMAND_ECHO STDOUT
    OUTPUT_VARIABLE output RESULT_VARIABLE result)
  if (result)
    message(FATAL_ERROR "${ARGN}: ${result}\n${output}")
  endif ()
  set(output "${output}" PARENT_SCOPE)
endfunction ()
run("${CMAKE_COMMAND}" -S . -B build -G "${GENERATOR}" -D "CMAKE_PREFIX_PATH=${PREFIX}"
    -D "CMAKE_BUILD_TYPE=${TYPE}")
run("${CMAKE_COMMAND}" --build build)
run(build/shear)
if (NOT output STREQUAL "${said}\n")
  message(FATAL_ERROR "The program prints ${output} and the page says ${said}.")
endif ()
