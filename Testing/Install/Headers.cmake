# SPDX-License-Identifier: BSD-3-Clause
# Checks the headers that are installed in PREFIX: vtk classes and folders alone at the top, so that
# no project gets a bare Mesh.h or Error.h; no private ones; every one that Documentation/API.md
# (API) lists; and these compile in a project of their own, made in WORK, which links the core
# alone. So do those of the filters, and of the reader and the writer, in a second target.
cmake_minimum_required(VERSION 3.18)
set(root "${PREFIX}/${INCLUDE}/MeshMorphing")
file(GLOB top RELATIVE "${root}" LIST_DIRECTORIES false "${root}/*")
foreach (file IN LISTS top)
  if (NOT file MATCHES "^vtk")
    message(SEND_ERROR "${file} is installed without a folder.")
  endif ()
endforeach ()
file(GLOB_RECURSE private RELATIVE "${root}" "${root}/Private/*" "${root}/Core/*")
if (private)
  message(SEND_ERROR "Private files, or the core's old folder, are installed: ${private}")
endif ()

file(READ "${API}" api)
string(REGEX MATCHALL "`[A-Za-z]+/[A-Za-z0-9]+\\.h`" listed "${api}")
list(LENGTH listed number)
if (number LESS 15)
  message(FATAL_ERROR "${API} lists ${number} headers of the core.")
endif ()
# Macros that wingdi.h defines on Windows.
set(macros "#define ABSOLUTE 1\n#define RELATIVE 2\n")
set(code "${macros}
#if __has_include(<Mesh.h>) || __has_include(<Error.h>) || __has_include(<Mesh/Mesh.h>)
#error a core header is on the include path
#endif
")
foreach (header IN LISTS listed)
  string(REPLACE "`" "" header "${header}")
  if (NOT EXISTS "${root}/${header}")
    message(SEND_ERROR "${header}, which the page of the interface lists, is not installed.")
  endif ()
  string(APPEND code "#include <MeshMorphing/${header}>\n")
endforeach ()
string(APPEND code "int main() { return morph::Mesh().numberOfCells() == 0 ? 0 : 1; }\n")

foreach (header vtkMorphMesh.h vtkSolverFileReader.h vtkSolverFileWriter.h)
  if (NOT header IN_LIST top)
    message(SEND_ERROR "${header} is not installed.")
  endif ()
endforeach ()
set(filters "${macros}")
foreach (header IN LISTS top)
  string(APPEND filters "#include <${header}>\n")
endforeach ()

file(REMOVE_RECURSE "${WORK}")
file(WRITE "${WORK}/All.cxx" "${code}")
file(WRITE "${WORK}/Filters.cxx" "${filters}")
file(WRITE "${WORK}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.18)
project(Headers LANGUAGES CXX)
find_package(MeshMorphing REQUIRED)
add_library(filters-headers OBJECT Filters.cxx)
target_link_libraries(filters-headers
  PRIVATE MeshMorphing::FiltersMorphing MeshMorphing::FiltersIO)
add_executable(all-headers All.cxx)
target_link_libraries(all-headers PRIVATE MeshMorphing::Core)
")
set(configure -S "${WORK}" -B "${WORK}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${PREFIX}"
  "-DCMAKE_BUILD_TYPE=${TYPE}" "-DCMAKE_EXE_LINKER_FLAGS=${LINKER_FLAGS}"
  "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
set(build --build "${WORK}/build")
foreach (step configure build)
  execute_process(COMMAND "${CMAKE_COMMAND}" ${${step}}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if (result)
    message(FATAL_ERROR "The headers do not compile on their own:\n${output}")
  endif ()
endforeach ()
