# SPDX-License-Identifier: BSD-3-Clause
# Include before paraview_add_plugin. ParaView makes a help page of each proxy from its XML, but
# knows the elements of its own proxies alone. It gets copies in which ours have the name that it
# knows, and without the proxies that users never see. CMake keeps the function that this one
# replaces under its name after an underscore.
function (paraview_client_documentation)
  cmake_parse_arguments(help "" "TARGET;OUTPUT_DIR" "XMLS" ${ARGN})
  set(copies)
  foreach (xml IN LISTS help_XMLS)
    file(READ "${xml}" text)
    string(REPLACE "ReportingSourceProxy" "SourceProxy" text "${text}")
    string(FIND "${text}" "<ProxyGroup name=\"internal_filters\">" first)
    if (first GREATER -1)
      set(end "</ProxyGroup>")
      string(FIND "${text}" "${end}" last)
      string(LENGTH "${end}" length)
      math(EXPR last "${last} + ${length}")
      string(SUBSTRING "${text}" 0 ${first} before)
      string(SUBSTRING "${text}" ${last} -1 after)
      set(text "${before}${after}")
    endif ()
    get_filename_component(name "${xml}" NAME)
    set(copy "${CMAKE_CURRENT_BINARY_DIR}/HelpPages/${name}")
    file(GENERATE OUTPUT "${copy}" CONTENT "${text}")
    list(APPEND copies "${copy}")
  endforeach ()
  _paraview_client_documentation(
    TARGET     "${help_TARGET}"
    OUTPUT_DIR "${help_OUTPUT_DIR}"
    XMLS       ${copies})
endfunction ()
