# SPDX-License-Identifier: BSD-3-Clause
# The libraries that some formats of Filters/IO need, and that a build may leave out. Each option is
# AUTO (where it is found), ON (an error where it is not) or OFF. At run time a format that was left
# out is an error that names the library.

# morph_solver_library(<option> <what for> <found> <targets or libraries>...) sets <option>_USED.
function (morph_solver_library option purpose found)
  set(${option} AUTO CACHE STRING "${purpose}: AUTO, ON or OFF")
  set_property(CACHE ${option} PROPERTY STRINGS AUTO ON OFF)
  set(${option}_USED OFF PARENT_SCOPE)
  if (${option} STREQUAL "AUTO" OR ${option})
    if (found)
      set(${option}_USED ON PARENT_SCOPE)
    elseif (NOT ${option} STREQUAL "AUTO")
      message(FATAL_ERROR "${option} is ON, and its library is not found.")
    else ()
      message(STATUS "Left out, as its library is not found: ${purpose}")
    endif ()
  endif ()
endfunction ()

find_package(ZLIB QUIET)
morph_solver_library(MESHMORPHING_WITH_ZLIB "packed files of OpenFOAM (zlib)" "${ZLIB_FOUND}")

# morph_find_library(<name> <header> <library>) sets <name>_FOUND.
function (morph_find_library name header library)
  find_path(MESHMORPHING_${name}_INCLUDE_DIR "${header}")
  find_library(MESHMORPHING_${name}_LIBRARY "${library}")
  mark_as_advanced(MESHMORPHING_${name}_INCLUDE_DIR MESHMORPHING_${name}_LIBRARY)
  set(${name}_FOUND OFF PARENT_SCOPE)
  if (MESHMORPHING_${name}_INCLUDE_DIR AND MESHMORPHING_${name}_LIBRARY)
    set(${name}_FOUND ON PARENT_SCOPE)
  endif ()
endfunction ()

morph_find_library(NETCDF netcdf.h netcdf)
morph_solver_library(MESHMORPHING_WITH_NETCDF "files of Exodus II (netCDF)" "${NETCDF_FOUND}")
morph_find_library(CGNS cgns_io.h cgns)
morph_solver_library(MESHMORPHING_WITH_CGNS "files of CGNS (its library)" "${CGNS_FOUND}")
