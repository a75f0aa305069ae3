# SPDX-License-Identifier: BSD-3-Clause
# Installs the build tree BUILD into an empty PREFIX. No file left there, or in EXAMPLES, can help a
# test.
file(REMOVE_RECURSE "${PREFIX}" "${EXAMPLES}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}"
  RESULT_VARIABLE result)
if (result)
  message(FATAL_ERROR "cmake --install failed: ${result}")
endif ()
file(GLOB_RECURSE installed LIST_DIRECTORIES false "${PREFIX}/*.cmake")
foreach (file IN LISTS installed)
  file(STRINGS "${file}" lines)
  if (lines MATCHES "${PREFIX}")
    message(FATAL_ERROR "${file} holds the prefix: the package could not be moved.")
  endif ()
endforeach ()
