# SPDX-License-Identifier: BSD-3-Clause
# A build from nothing takes a fifth less time where common headers are compiled once a target.
# ccache shares less then, and a missing #include goes unseen: so it is off where people develop.
option(MESHMORPHING_PRECOMPILE_HEADERS "Compile headers of Eigen, GTest and VTK once a target" OFF)

# Precompiles headers for the C++ sources of a target of this folder: of the standard library, and
# of the libraries named by EIGEN, GTEST and VTK.
function (morph_precompile target)
  if (NOT MESHMORPHING_PRECOMPILE_HEADERS)
    return ()
  endif ()
  set(headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numeric>
    <sstream> <string> <utility> <vector>)
  if ("EIGEN" IN_LIST ARGN)
    list(APPEND headers <Eigen/Core> <Eigen/Geometry>)
  endif ()
  if ("GTEST" IN_LIST ARGN)
    list(APPEND headers <gtest/gtest.h>)
  endif ()
  if ("VTK" IN_LIST ARGN)
    list(APPEND headers <vtkCellArray.h> <vtkCellData.h> <vtkDoubleArray.h> <vtkFieldData.h>
      <vtkIdList.h> <vtkIdTypeArray.h> <vtkInformation.h> <vtkInformationVector.h> <vtkNew.h>
      <vtkPointData.h> <vtkPoints.h> <vtkPolyData.h> <vtkSmartPointer.h> <vtkStringArray.h>
      <vtkUnstructuredGrid.h>)
  endif ()
  target_precompile_headers(${target} PRIVATE ${headers})

  # Compiled otherwise, they cannot take it.
  get_target_property(sources ${target} SOURCES)
  foreach (source IN LISTS sources)
    get_source_file_property(options "${source}" COMPILE_OPTIONS)
    get_source_file_property(definitions "${source}" COMPILE_DEFINITIONS)
    if (options OR definitions)
      set_source_files_properties("${source}" PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif ()
  endforeach ()
endfunction ()
