# SPDX-License-Identifier: BSD-3-Clause
# The CMake package MeshMorphing: find_package(MeshMorphing) gives the targets MeshMorphing::Core,
# MeshMorphing::FiltersMorphing and MeshMorphing::FiltersIO; the last two are static libraries
# beside the plugin, shared ones with plain VTK.
include(CMakePackageConfigHelpers)
set(package_destination "${CMAKE_INSTALL_LIBDIR}/cmake/MeshMorphing")
set(headers_destination "${CMAKE_INSTALL_INCLUDEDIR}/MeshMorphing")

# The interface. Documentation/API.md has the same list, and Testing/Install/Headers.cmake compiles
# it.
set(core_headers
  Boundary/Classification.h
  BoundaryMorphing/BoundaryMotion.h
  BoundaryMover/BoundaryModel.h
  BoundaryMover/BoundaryMover.h
  BoundaryMover/Patches.h
  LinearMethods/FemWarp.h
  LinearMethods/LogBarrierWarp.h
  LinearMethods/RadialBasis.h
  LinearMethods/SimplexLinear.h
  LinearMethods/SimplexNaturalNeighbor.h
  LinearMethods/WeightedResidual.h
  Mesh/CellShape.h
  Mesh/Mesh.h
  Mesh/NodePartition.h
  Mesh/Topology.h
  Morpher/Blend.h
  Morpher/Morpher.h
  Quality/ScaledJacobian.h
  Quality/ValidRange.h
  Session/Session.h
  Support/Error.h
  Support/Monitor.h
  Support/Types.h
  Untangling/InversionFree.h
  Untangling/Smoothing.h)
install(CODE "
  set(PUBLIC_HEADERS \"${core_headers}\")
  set(CORE \"${CMAKE_CURRENT_SOURCE_DIR}/Filters/Core\")
  set(DESTINATION \"${headers_destination}\")
  set(COPIES \"${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/headers\")"
  COMPONENT sdk)
install(SCRIPT "${CMAKE_CURRENT_LIST_DIR}/InstallHeaders.cmake" COMPONENT sdk)
set_target_properties(morph_core PROPERTIES EXPORT_NAME Core)
target_include_directories(morph_core
  PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(morph_io PROPERTIES EXPORT_NAME SolverFiles)
set(archives morph_core morph_io)
set(morph_parallel_component)
if (morph_has_mpi AND MESHMORPHING_BUILD_PARAVIEW_PLUGIN)
  # The static libraries of the filters need it; a shared one has it inside.
  set_target_properties(morph_distributed PROPERTIES EXPORT_NAME Distributed)
  list(APPEND archives morph_distributed)
  set(morph_parallel_component "IOXML ParallelMPI")
endif ()
install(TARGETS ${archives}
  EXPORT  MeshMorphing
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT sdk)

if (MESHMORPHING_BUILD_PARAVIEW_PLUGIN)
  # ParaView's build installs the plugin alone; with plain VTK vtk_module_build() does what follows.
  foreach (module IN ITEMS FiltersMorphing FiltersIO)
    get_target_property(module_headers ${module} INTERFACE_vtk_module_headers)
    # VTK after 9.3 leaves the header with the export macro out of its list.
    get_target_property(module_folder ${module} BINARY_DIR)
    list(APPEND module_headers "${module_folder}/vtkMeshMorphing${module}Module.h")
    list(REMOVE_DUPLICATES module_headers)
    install(FILES ${module_headers} DESTINATION "${headers_destination}" COMPONENT sdk)
    target_include_directories(${module} PUBLIC $<INSTALL_INTERFACE:${headers_destination}>)
    install(TARGETS ${module}
      EXPORT  MeshMorphing
      ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT sdk)
  endforeach ()
  install(EXPORT MeshMorphing
    NAMESPACE   MeshMorphing::
    FILE        MeshMorphing-targets.cmake
    DESTINATION "${package_destination}"
    COMPONENT   sdk)
endif ()

configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/MeshMorphingConfig.cmake.in"
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/MeshMorphingConfig.cmake"
  INSTALL_DESTINATION "${package_destination}")
write_basic_package_version_file(
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/MeshMorphingConfigVersion.cmake"
  COMPATIBILITY SameMajorVersion)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/MeshMorphingConfig.cmake"
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/MeshMorphingConfigVersion.cmake"
  "${CMAKE_CURRENT_LIST_DIR}/DebianParaView.cmake"
  DESTINATION "${package_destination}"
  COMPONENT   sdk)
install(FILES LICENSE README.md CHANGELOG.md
  DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)

if (MESHMORPHING_BUILD_PARAVIEW_PLUGIN)
  # Debian's ParaView looks for plugins in the folder "plugins" beside its programs and nowhere else
  # (PV_PLUGIN_PATH apart), though its own plugins lie in the library folder. Where this is
  # installed beside ParaView, a link makes it listed and loaded.
  find_program(MESHMORPHING_PVPYTHON pvpython)
  get_filename_component(paraview_programs "${MESHMORPHING_PVPYTHON}" DIRECTORY)
  install(CODE "
    if (\"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\" STREQUAL \"${paraview_programs}\")
      set(link \"${paraview_programs}/plugins/MeshMorphing/MeshMorphing.so\")
      set(plugin ${PARAVIEW_PLUGIN_SUBDIR}/MeshMorphing/MeshMorphing.so)
      file(RELATIVE_PATH target \"${paraview_programs}/plugins/MeshMorphing\"
        \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/\${plugin}\")
      message(STATUS \"Linking: \${link}\")
      file(MAKE_DIRECTORY \"\$ENV{DESTDIR}${paraview_programs}/plugins/MeshMorphing\")
      file(CREATE_LINK \"\${target}\" \"\$ENV{DESTDIR}\${link}\" SYMBOLIC)
      list(APPEND CMAKE_INSTALL_MANIFEST_FILES \"\${link}\")
    endif ()"
    COMPONENT plugin)
endif ()
