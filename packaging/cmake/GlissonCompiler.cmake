# One INTERFACE target carries the language level, the warnings and the hardening of every room.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # What ccache asks for where headers are precompiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
    "CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime" "${CCACHE_PROGRAM}")
  set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(glisson_warnings INTERFACE)
target_compile_options(glisson_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
# g++ 12 sees overlaps that are not there in `"text" + std::string` (its bug 105651).
target_compile_options(glisson_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(GLISSON_WERROR)
  target_compile_options(glisson_warnings INTERFACE -Werror)
endif()
target_compile_definitions(glisson_warnings INTERFACE _GLIBCXX_ASSERTIONS)
target_compile_options(glisson_warnings INTERFACE -fstack-protector-strong)
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_options(glisson_warnings INTERFACE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
endif()
target_link_options(glisson_warnings INTERFACE -Wl,-z,relro,-z,now)
if(GLISSON_SANITIZE)
  target_compile_options(glisson_warnings INTERFACE -fsanitize=${GLISSON_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(glisson_warnings INTERFACE -fsanitize=${GLISSON_SANITIZE})
endif()
