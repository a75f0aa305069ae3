# SPDX-License-Identifier: BSD-3-Clause
# Data flows one way, Plugin -> Filters/Morphing -> Filters/Core: no folder includes from one above it.

function (refuse_includes folder pattern what)
  file(GLOB_RECURSE files "${SOURCE_DIR}/${folder}/*.h" "${SOURCE_DIR}/${folder}/*.cxx")
  if (NOT files)
    message(FATAL_ERROR "No sources found in ${SOURCE_DIR}/${folder}")
  endif ()
  foreach (file IN LISTS files)
    file(STRINGS "${file}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]${pattern}")
    if (lines)
      message(SEND_ERROR "${file} includes ${what}: ${lines}")
    endif ()
  endforeach ()
endfunction ()

refuse_includes("Filters/Core" "vtk" "VTK")
# vtkSMPTools and its like are VTK's; other names in vtkSM are ParaView's.
refuse_includes("Filters" "(vtkSM([^P]|P[a-z]|PV)|vtkPV|vtkSI|pq)" "ParaView")
