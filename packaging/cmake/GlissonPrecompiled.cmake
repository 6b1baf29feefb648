# glisson_precompile(<target> <set>): the target's sources are compiled behind the precompiled headers of a set. Nothing
# but headers of outside libraries is in them, and each source includes what it uses: preset `clang` and
# GLISSON_PRECOMPILED=OFF compile without them. Targets of one set have the same compiler flags; the first that asks
# compiles the headers, the others, which know at least its definitions, reuse them.
option(GLISSON_PRECOMPILED "Compile the outside libraries' headers once for all sources" ON)

set(glisson_headers_of_all <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map>
  <memory> <mutex> <numbers> <numeric> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <thread> <utility>
  <variant> <vector> <Eigen/Core> <Eigen/Geometry> <Eigen/LU>)
set(glisson_headers_rooms ${glisson_headers_of_all})
set(glisson_headers_dicom ${glisson_headers_of_all} <dcmtk/config/osconfig.h> <dcmtk/dcmdata/dctk.h>)
set(glisson_headers_python ${glisson_headers_of_all} <pybind11/pybind11.h> <pybind11/eigen.h> <pybind11/stl.h> <pybind11/stl/filesystem.h>)
set(glisson_headers_programs ${glisson_headers_of_all} <CLI/CLI.hpp> <nlohmann/json.hpp>)
set(glisson_headers_tests ${glisson_headers_of_all} <gtest/gtest.h> <gmock/gmock.h>)
set(glisson_headers_window ${glisson_headers_of_all} <QCheckBox> <QComboBox> <QHBoxLayout> <QHeaderView> <QLabel> <QPainter>
  <QPushButton> <QSettings> <QString> <QTimer> <QTreeWidget> <QWidget>)
set(glisson_headers_journeys ${glisson_headers_window} <QtTest/QtTest>)

function(glisson_precompile target set)
  if(NOT GLISSON_PRECOMPILED OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  # ccache asks for the first; the second because g++ 12 forgets that a precompiled header is the system's, and then
  # reports its bug 105651 in std::string.
  target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-stringop-overflow
    -Wno-stringop-overread -Wno-array-bounds)
  get_property(owner GLOBAL PROPERTY glisson_precompiled_${set})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${glisson_headers_${set}})
    set_property(GLOBAL PROPERTY glisson_precompiled_${set} ${target})
  endif()
endfunction()

# glisson_unity(<target> <size>): so many of the target's sources are compiled as one, where the same templates cost more than
# the sources themselves. With GLISSON_PRECOMPILED=OFF each is compiled for itself.
function(glisson_unity target size)
  if(GLISSON_PRECOMPILED AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
  endif()
endfunction()
