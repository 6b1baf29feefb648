# What is installed beside the programs: the libraries of core for other projects (component dev), documents, examples and
# what 3D Slicer needs (component app).
include(CMakePackageConfigHelpers)

# The rooms, what they link, and the third-party targets of our own making, as Glisson::<name>.
set(glisson_exported glisson_core glisson_pictures glisson_scene3d glisson_warnings glisson_dcmtk glisson_itk glisson_cholmod
  glisson_openjpeg glisson_openigtlink)
foreach(room ${GLISSON_ROOMS})
  list(APPEND glisson_exported glisson_${room})
endforeach()
foreach(target ${glisson_exported})
  string(REPLACE "glisson_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS ${glisson_exported} EXPORT GlissonTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT dev)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/core/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/glisson" COMPONENT dev
  FILES_MATCHING PATTERN "*.h" PATTERN "*.def" PATTERN detail EXCLUDE)
set(glisson_config "${CMAKE_INSTALL_LIBDIR}/cmake/Glisson")
install(EXPORT GlissonTargets NAMESPACE Glisson:: DESTINATION "${glisson_config}" COMPONENT dev)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/GlissonConfig.cmake.in" "${PROJECT_BINARY_DIR}/GlissonConfig.cmake"
  INSTALL_DESTINATION "${glisson_config}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/GlissonConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/GlissonConfig.cmake" "${PROJECT_BINARY_DIR}/GlissonConfigVersion.cmake"
  DESTINATION "${glisson_config}" COMPONENT dev)

set(glisson_documents "${CMAKE_INSTALL_DATADIR}/doc/glisson")
install(FILES "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${glisson_documents}" COMPONENT app)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/pictures" DESTINATION "${glisson_documents}/resources" COMPONENT app)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/manual" DESTINATION "${glisson_documents}" COMPONENT app OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/examples/" DESTINATION "${glisson_documents}/examples" COMPONENT app OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/cluster" DESTINATION "${glisson_documents}/examples" COMPONENT app)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/schemas" DESTINATION "${CMAKE_INSTALL_DATADIR}/glisson" COMPONENT app)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/resources/slicer" DESTINATION "${CMAKE_INSTALL_DATADIR}/glisson" COMPONENT app
  USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
