# glisson_room(<name> SOURCES ... [ROOMS ...] [PRIVATE_LIBRARIES ...])
# One static library per room: glisson_<name>, alias Glisson::<name>. ROOMS are the rooms it may include (public);
# PRIVATE_LIBRARIES are third-party libraries seen only by its .cpp files.
function(glisson_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ROOMS;PRIVATE_LIBRARIES" ${ARGN})
  add_library(glisson_${name} STATIC ${ARG_SOURCES})
  add_library(Glisson::${name} ALIAS glisson_${name})
  target_include_directories(glisson_${name} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/core>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/glisson>")
  target_link_libraries(glisson_${name} PUBLIC Eigen3::Eigen PRIVATE glisson_warnings ${ARG_PRIVATE_LIBRARIES})
  if(name STREQUAL "dicom")
    glisson_precompile(glisson_${name} dicom)
  else()
    glisson_precompile(glisson_${name} rooms)
  endif()
  foreach(room ${ARG_ROOMS})
    target_link_libraries(glisson_${name} PUBLIC Glisson::${room})
  endforeach()
endfunction()

# glisson_unit_test(<room> SOURCES ... [LIBRARIES ...]): one GoogleTest program per room, each test known to ctest.
function(glisson_unit_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${ARG_LIBRARIES} glisson_test_support glisson_warnings GTest::gmock GTest::gtest_main)
  # Qt's flags for position-independent code are not those of the other tests.
  if(NOT "${ARG_LIBRARIES}" MATCHES "ui_(session|views)")
    glisson_precompile(test_${name} tests)
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()
