# SPDX-License-Identifier: BSD-3-Clause
# Runs at installation: installs the headers PUBLIC_HEADERS of the folder CORE (Documentation/API.md
# lists them) and those that they include, under DESTINATION. Their #include "Mesh/Mesh.h" becomes
# #include <MeshMorphing/Mesh/Mesh.h>, so that no folder with names like Mesh or Support is on the
# include path of a project that uses them. Copies: the folder COPIES.
cmake_minimum_required(VERSION 3.18)
set(todo ${PUBLIC_HEADERS})
set(done)
file(REMOVE_RECURSE "${COPIES}")
while (todo)
  list(POP_FRONT todo header)
  if (header IN_LIST done)
    continue ()
  endif ()
  list(APPEND done "${header}")
  file(READ "${CORE}/${header}" text)
  file(STRINGS "${CORE}/${header}" includes REGEX "^#include \"")
  foreach (include IN LISTS includes)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${include}")
    if (NOT EXISTS "${CORE}/${include}")
      message(FATAL_ERROR "${header} includes \"${include}\", which is no header of ${CORE}.")
    endif ()
    list(APPEND todo "${include}")
  endforeach ()
  string(REGEX REPLACE "#include \"([^\"\n]+)\"" "#include <MeshMorphing/\\1>" text "${text}")
  file(WRITE "${COPIES}/${header}" "${text}")
  get_filename_component(folder "${header}" DIRECTORY)
  file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/${DESTINATION}/${folder}" TYPE FILE
    FILES "${COPIES}/${header}")
endwhile ()
