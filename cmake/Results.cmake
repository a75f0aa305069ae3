# SPDX-License-Identifier: BSD-3-Clause
# The results of the filters, as Filters/Morphing/Results.txt lists them.
set(morph_result_groups Result Fit Effort Solver Method Quality)
set(morph_result_row
  "([A-Za-z]+) +" # CMAKE_MATCH_1: name
  "(double|int|id|text|counts?) +"
  "([^ ]+) +"     # 3: value without a result
  "([0-9]+|-)"    # 4: place in the field data
  "([*]?) +"
  "([A-Z][a-z]+|-) +" # 6: group
  "(default|advanced|-) +"
  "(.+)") # 8: documentation
string(CONCAT morph_result_row "^" ${morph_result_row} "$")

# Labels in the panel, where the name in words is not what a user would call it.
set(morph_label_MorphStatus "Status")
set(morph_label_MinScaledJacobian "Minimum scaled Jacobian")
set(morph_label_MeanScaledJacobian "Mean scaled Jacobian")
set(morph_label_WorstMeanScaledJacobian "Mean of the worst 1 %")
set(morph_label_BoundaryMinimum "Minimum that the boundary sets")
set(morph_label_WorstCellId "Worst cell")
set(morph_label_LargestValidStep "Part of the motion reached")
set(morph_label_InvertedBefore "Inverted before")
set(morph_label_NewInvertedCells "Inverted by the morph")
set(morph_label_BoundaryInvertedCells "Cells that the boundary inverts")
set(morph_label_PrepareSeconds "Seconds to prepare")
set(morph_label_EvaluateSeconds "Seconds to move the nodes")
set(morph_label_PresentDimension "Dimension before")
set(morph_label_MaxTargetDistanceBefore "Largest distance before")
set(morph_label_MeanTargetDistanceBefore "Mean distance before")
set(morph_label_MaxTargetDistance "Largest distance after")
set(morph_label_MeanTargetDistance "Mean distance after")

# A class of Plugin/Widgets that adds to a result in the panel.
set(morph_decorator_BestMethod "TakeBest")

# What the title of a closed group says of a result, %1 being its value (Plugin/Widgets/Fold.h).
set(morph_told_MorphStatus "%1")
set(morph_told_MinScaledJacobian "minimum %1")
set(morph_told_InvertedCells "%1 inverted")
set(morph_told_BestMethod "%1")
set(morph_told_FoldedFaces "%1 folded")
set(morph_told_MaxTargetDistance "distance %1")
set(morph_told_MovingPoints "%1 nodes move")
set(morph_told_FollowingPoints "%1 follow")
set(morph_told_NumberOfSurfaces "%1 surfaces")

# morph_results(SECTION ...) reads these sections and sets, in the caller's scope,
#   ResultRows         their rows as C++ (Private/Data/Results.h),
#   <group>Properties  for each group: the information properties of ParaView's XML,
#   <group>Group       and their names for a PropertyGroup. Both are empty for a group without rows.
function (morph_results)
  set(table "${PROJECT_SOURCE_DIR}/Filters/Morphing/Results.txt")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${table}")
  foreach (group IN LISTS morph_result_groups)
    set(${group}Properties)
    set(${group}Group)
  endforeach ()
  set(ResultRows)
  set(section)
  file(STRINGS "${table}" lines REGEX "^[^#]")
  foreach (line IN LISTS lines)
    if (line MATCHES "^.(vtk[A-Za-z]+).$")
      set(section "${CMAKE_MATCH_1}")
    elseif (NOT line MATCHES "${morph_result_row}")
      message(FATAL_ERROR "Results.txt: this is no row: ${line}")
    elseif (section IN_LIST ARGV)
      set(name "${CMAKE_MATCH_1}")
      set(kind "${CMAKE_MATCH_2}")
      set(none "${CMAKE_MATCH_3}")
      set(group "${CMAKE_MATCH_6}")
      set(panel "${CMAKE_MATCH_7}")
      set(documentation "${CMAKE_MATCH_8}")
      morph_result_cxx("${name}" "${kind}" "${none}" "${CMAKE_MATCH_4}" "${CMAKE_MATCH_5}")
      string(APPEND ResultRows "${row}")
      if (group IN_LIST morph_result_groups)
        morph_result_xml("${name}" "${kind}" "${none}" "${panel}" "${documentation}")
        string(APPEND ${group}Properties "${property}")
        string(APPEND ${group}Group "        <Property name=\"${name}\"/>\n")
      elseif (NOT group STREQUAL "-")
        message(FATAL_ERROR "Results.txt: ${name} has no group of morph_result_groups: ${group}")
      endif ()
    endif ()
  endforeach ()
  foreach (variable IN LISTS morph_result_groups)
    set(${variable}Properties "${${variable}Properties}" PARENT_SCOPE)
    set(${variable}Group "${${variable}Group}" PARENT_SCOPE)
  endforeach ()
  set(ResultRows "${ResultRows}" PARENT_SCOPE)
endfunction ()

# Sets `row` to the row in C++.
function (morph_result_cxx name kind none place always)
  string(SUBSTRING "${kind}" 0 1 initial)
  string(TOUPPER "${initial}" initial)
  string(SUBSTRING "${kind}" 1 -1 others)
  set(without "\"${none}\"")
  if (none STREQUAL "kept")
    set(without "nullptr")
  endif ()
  string(REPLACE "-" "0" place "${place}")
  set(is_always "false")
  if (always STREQUAL "*")
    set(is_always "true")
  endif ()
  set(columns "\"${name}\", ResultKind::${initial}${others}, ${without}, ${place}, ${is_always}")
  set(row "    { ${columns} },\n" PARENT_SCOPE)
endfunction ()

# Sets `property` to the property in XML.
function (morph_result_xml name kind none panel documentation)
  set(type "Double")
  set(default " default_values=\"${none}\"")
  set(widget)
  if (none STREQUAL "kept")
    set(default " default_values=\"0\"")
  elseif (none STREQUAL "nan") # which ParaView cannot hold; see vtkSMReportingSourceProxy
    set(default " default_values=\"-1\"")
  endif ()
  if (kind STREQUAL "text")
    set(type "String")
    set(default)
  elseif (NOT kind STREQUAL "double")
    set(type "IdType")
    set(widget " panel_widget=\"WholeNumber\"")
  endif ()
  set(hints)
  if (morph_label_${name})
    set(hints
      "          <PropertyWidgetDecorator type=\"PanelLabel\" text=\"${morph_label_${name}}\"/>\n")
  endif ()
  if (none MATCHES "^(nan|-1)$")
    string(APPEND hints "          <PropertyWidgetDecorator type=\"KnownResult\"/>\n")
  endif ()
  if (morph_decorator_${name})
    string(APPEND hints
      "          <PropertyWidgetDecorator type=\"${morph_decorator_${name}}\"/>\n")
  endif ()
  if (morph_told_${name})
    string(APPEND hints "          <Told text=\"${morph_told_${name}}\"/>\n")
  endif ()
  if (hints)
    string(CONCAT hints "        <Hints>\n" "${hints}" "        </Hints>\n")
  endif ()
  string(CONCAT property
    "      <${type}VectorProperty name=\"${name}\" command=\"Get${name}\"\n"
    "                            information_only=\"1\" number_of_elements=\"1\"${default}\n"
    "                            panel_visibility=\"${panel}\"${widget}>\n"
    "        <Simple${type}InformationHelper/>\n"
    "        <Documentation>\n${documentation}\n        </Documentation>\n${hints}"
    "      </${type}VectorProperty>\n")
  set(property "${property}" PARENT_SCOPE)
endfunction ()
