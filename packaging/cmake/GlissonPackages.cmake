# Debian packages by CPack: glisson (component app), libglisson-dev (component dev) and python3-glisson (component python).
# packaging/deb builds them.
set(CPACK_GENERATOR DEB)
# What they hold, without the tests.
add_custom_target(packaged DEPENDS glisson-cli ${glisson_exported})
foreach(target glisson glisson_python)
  if(TARGET ${target})
    add_dependencies(packaged ${target})
  endif()
endforeach()
set(CPACK_PACKAGE_NAME glisson)
set(GLISSON_CONTACT_MAIL "maintainers@glisson.invalid" CACHE STRING "Address of the packages' maintainer")
set(CPACK_PACKAGE_CONTACT "The Glisson authors <${GLISSON_CONTACT_MAIL}>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL app dev)
if(TARGET glisson_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
# What is made for the packages alone: change logs and copyright, with times of the last commit.
configure_file("${CMAKE_CURRENT_LIST_DIR}/../debian/documents.cmake.in" "${PROJECT_BINARY_DIR}/debian-documents.cmake" @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_BINARY_DIR}/debian-documents.cmake")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_APP_PACKAGE_NAME glisson)
set(CPACK_DEBIAN_APP_PACKAGE_SECTION science)
set(CPACK_DEBIAN_APP_PACKAGE_SHLIBDEPS ON)
# Opened at run time, so that shlibdeps does not see them: drawing without a display, icons.
set(CPACK_DEBIAN_APP_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri, libqt6svg6")
set(CPACK_DEBIAN_APP_PACKAGE_SUGGESTS "paraview, libglisson-dev")
set(CPACK_COMPONENT_APP_DESCRIPTION "Glisson shows where a patient's hepatic vessels end up when the liver is
retracted: with that patient's own stiffness, measured by MR elastography, and
with the usual textbook stiffness.

This package has the workstation (glisson), the command line (glisson-cli), a
module for 3D Slicer and recipes for clusters. Research use only, not for
clinical use.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libglisson-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION "Headers, static libraries and the CMake package of Glisson's core: DICOM, MR
elastography, solid mechanics with contact, rendering and reports.

Use it with find_package(Glisson) and link Glisson::core or single rooms.
Research use only, not for clinical use.")
# The -dev packages that the build itself needs are what a program that links the static libraries needs.
file(STRINGS "${PROJECT_SOURCE_DIR}/packaging/debian-packages.txt" lines)
set(group "")
set(needed "glisson (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
foreach(line ${lines})
  if(line MATCHES "^# \\[(.*)\\]")
    set(group "${CMAKE_MATCH_1}")
  elseif(group STREQUAL "build" AND line MATCHES "-dev$" AND NOT line MATCHES "cli11")
    string(APPEND needed ", ${line}")
  endif()
endforeach()
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${needed}")

# The module fits one version of Python, that of the release; glisson has the programs that it starts and the part that draws.
if(TARGET glisson_python)
  math(EXPR next "${GLISSON_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-glisson)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "glisson (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), python3-numpy, \
python3 (>= 3.${GLISSON_PYTHON_MINOR}), python3 (<< 3.${next})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/debian/python/postinst"
    "${PROJECT_SOURCE_DIR}/packaging/debian/python/prerm")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Glisson's core as a Python module: scan, measure, invert, propose, plan, run,
live and cohort, with the numbers of glisson-cli to the last bit. Arrays are
NumPy's without copies, geometry is an affine, types are in stubs.

Research use only, not for clinical use.")
endif()
include(CPack)
