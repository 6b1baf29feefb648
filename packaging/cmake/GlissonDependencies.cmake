# Order matters: Eigen before ITK (ITK's own Eigen configuration would hide Eigen3::Eigen otherwise).
# Components are named, never "all": VTK's HDF5 (MPI) and ITK's HDF5 (serial) must not meet in one process.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)

set(GLISSON_VTK_COMPONENTS
  CommonCore CommonDataModel CommonExecutionModel CommonColor CommonMath CommonTransforms
  FiltersCore FiltersGeneral FiltersGeometry FiltersModeling FiltersSources
  ImagingCore IOImage IOXML IOLegacy IOGeometry
  InteractionStyle InteractionWidgets RenderingCore RenderingOpenGL2 RenderingFreeType RenderingAnnotation
  RenderingContext2D RenderingContextOpenGL2 ChartsCore ViewsContext2D)
set(GLISSON_ITK_COMPONENTS
  ITKCommon ITKIOImageBase ITKIONIFTI ITKIONRRD ITKIOMeta ITKImageFeature ITKSmoothing ITKImageIntensity ITKThresholding
  ITKDistanceMap ITKMathematicalMorphology ITKConnectedComponents ITKRegionGrowing ITKImageGrid ITKBiasCorrection)
find_package(VTK 9.1 REQUIRED COMPONENTS ${GLISSON_VTK_COMPONENTS})
find_package(ITK 5.2 REQUIRED COMPONENTS ${GLISSON_ITK_COMPONENTS})

# DCMTK's package sets plain variables; one INTERFACE target makes them look like the rest.
find_package(DCMTK REQUIRED)
add_library(glisson_dcmtk INTERFACE)
target_include_directories(glisson_dcmtk SYSTEM INTERFACE ${DCMTK_INCLUDE_DIRS})
target_link_libraries(glisson_dcmtk INTERFACE ${DCMTK_LIBRARIES})

# ITK as one INTERFACE target, headers as SYSTEM: our warnings are for our code.
add_library(glisson_itk INTERFACE)
target_include_directories(glisson_itk SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
target_link_libraries(glisson_itk INTERFACE ${ITK_LIBRARIES})
# ITK's headers would bring their own, older Eigen, which cannot share a source file with ours.
target_compile_definitions(glisson_itk INTERFACE ITK_USE_SYSTEM_EIGEN)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_options(glisson_itk INTERFACE "$<BUILD_INTERFACE:SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/itk_under_clang.h>")
endif()

find_package(OpenGL REQUIRED COMPONENTS EGL OpenGL)

# Videos of a retraction: encoders and containers. Debian's VTK depends on the same packages.
find_package(PkgConfig REQUIRED)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavcodec libavformat libavutil)

# SuiteSparse ships no CMake package in Debian 12.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(OPENBLAS_LIBRARY openblas REQUIRED)
add_library(glisson_cholmod INTERFACE)
target_include_directories(glisson_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(glisson_cholmod INTERFACE ${CHOLMOD_LIBRARY} ${OPENBLAS_LIBRARY})

if(GLISSON_BUILD_UI)
  find_package(Qt6 6.4 REQUIRED COMPONENTS Core Gui Widgets OpenGL OpenGLWidgets)
endif()
if(GLISSON_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
  if(GLISSON_BUILD_UI)
    find_package(Qt6 6.4 REQUIRED COMPONENTS Test)
  endif()
endif()
if(GLISSON_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
