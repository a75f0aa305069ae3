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

# ParaView 5.12 to 6.0 leave the help of plugins out where Qt is newer than 5. Their own functions
# can make it. morph_separate_help(<variable>) tells whether this is such a ParaView: the pages are
# then a file beside the plugin, and MorphHelp registers it in the window.
function (morph_separate_help result)
  set(${result} OFF PARENT_SCOPE)
  if (PARAVIEW_USE_QT AND PARAVIEW_QT_MAJOR_VERSION GREATER 5 AND ParaView_VERSION VERSION_LESS 6.1)
    find_program(qt_xmlpatterns_executable NAMES xmlpatterns-qt5 xmlpatterns
      DOC "Path to xmlpatterns of Qt 5, which makes help pages")
    if (qt_xmlpatterns_executable)
      set(${result} ON PARENT_SCOPE)
    else ()
      message(WARNING
        "The plugin gets no help pages: xmlpatterns is missing (qtxmlpatterns5-dev-tools).")
    endif ()
  endif ()
endfunction ()

# Makes the file from the XML files, and installs it beside the plugin.
function (morph_add_separate_help)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/paraview_help")
  paraview_client_documentation(
    TARGET     MeshMorphing_doc
    OUTPUT_DIR "${folder}"
    XMLS       ${ARGN})
  paraview_client_generate_help(
    NAME        MeshMorphing
    OUTPUT_PATH pages
    OUTPUT_DIR  "${folder}"
    TARGET      MeshMorphing_qch
    DEPENDS     MeshMorphing_doc
    PATTERNS    "*.html" "*.css" "*.png" "*.jpg" "*.js")
  add_custom_target(MeshMorphingHelp ALL
    COMMAND "${CMAKE_COMMAND}" -E copy_if_different
            "${pages}" "$<TARGET_FILE_DIR:MeshMorphing>/MeshMorphing.qch"
    VERBATIM)
  add_dependencies(MeshMorphingHelp MeshMorphing_qch MeshMorphing)
  find_package(Qt${PARAVIEW_QT_MAJOR_VERSION} REQUIRED COMPONENTS Help)
  target_link_libraries(MeshMorphing PRIVATE Qt${PARAVIEW_QT_MAJOR_VERSION}::Help)
  install(FILES "${pages}"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/MeshMorphing"
    COMPONENT   plugin)
endfunction ()
