# SPDX-License-Identifier: BSD-3-Clause
# Most of a build's time goes into headers and templates, which sources of one unit share.
option(MESHMORPHING_UNITY_BUILD
  "Compile sources by tens: a build from nothing takes half the time, one after a change more" OFF)

# Compiles the C++ sources of a target of this folder in units of up to ten. Sources that define
# the same name for themselves go to different units.
function (morph_unity target)
  if (NOT MESHMORPHING_UNITY_BUILD)
    return ()
  endif ()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes the unnamed namespace of a source for that of a header.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  set(last 0)
  set(names_0 "")
  set(free_0 10)
  foreach (source IN LISTS sources)
    if (NOT source MATCHES "\\.cxx$")
      continue ()
    endif ()
    get_filename_component(file "${source}" ABSOLUTE)
    string(FIND "${file}" "${CMAKE_BINARY_DIR}" generated)
    if (generated EQUAL 0)
      continue ()
    endif ()
    file(READ "${file}" text)
    if (text MATCHES "windows\\.h")
      continue () # its macros, such as `near`, would reach the other sources
    endif ()
    string(REGEX REPLACE "[];[]" " " text "${text}")
    # What stands at the start of a line: a type, an alias, a macro, a constant, a function.
    set(word "[A-Za-z0-9_]+")
    string(REGEX MATCHALL "\n(struct|class|enum class|enum|#define) ${word}|\nusing ${word} *=\
|\n(constexpr|const) [^\n={(]*[ *&]${word} *[={]\
|\n[A-Za-z][A-Za-z0-9_:<>,*& ]*[ *&]${word}\\(" names "${text}")
    list(TRANSFORM names REPLACE "^.*[ *&]([A-Za-z0-9_]+) *[={(]?$" "\\1")
    set(unit "")
    foreach (candidate RANGE ${last})
      set(common FALSE)
      foreach (name IN LISTS names)
        if (name IN_LIST names_${candidate})
          set(common TRUE)
          break ()
        endif ()
      endforeach ()
      if (NOT common AND free_${candidate} GREATER 0)
        set(unit ${candidate})
        break ()
      endif ()
    endforeach ()
    if (unit STREQUAL "")
      math(EXPR last "${last} + 1")
      set(unit ${last})
      set(names_${unit} "")
      set(free_${unit} 10)
    endif ()
    list(APPEND names_${unit} ${names})
    math(EXPR free_${unit} "${free_${unit}} - 1")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "unit${unit}")
  endforeach ()
endfunction ()
