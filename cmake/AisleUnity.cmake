# Unity: an installed copy (UNITY_ROOT or the system), or the one tools/setup.sh unpacked into build/deps/unity.
find_path(UNITY_DIR unity.c HINTS ${UNITY_ROOT} $ENV{UNITY_ROOT} ${CMAKE_SOURCE_DIR}/build/deps/unity /usr/src/unity
          /usr/local/src/unity PATH_SUFFIXES src NO_CMAKE_FIND_ROOT_PATH)
if(NOT UNITY_DIR)
  message(FATAL_ERROR "Unity not found: run tools/setup.sh, or set UNITY_ROOT, or configure with -DAISLE_BUILD_TESTS=OFF")
endif()
add_library(unity STATIC ${UNITY_DIR}/unity.c)
target_include_directories(unity SYSTEM PUBLIC ${UNITY_DIR})
target_compile_definitions(unity PUBLIC UNITY_INCLUDE_DOUBLE UNITY_SUPPORT_64)
target_compile_options(unity PRIVATE -w)
# Tests judge by long double; clang, unlike gcc, calls every step from double to it a promotion. Name unity last.
target_compile_options(unity INTERFACE $<$<C_COMPILER_ID:Clang>:-Wno-double-promotion>)
