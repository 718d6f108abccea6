# How every target of the project is compiled.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
find_program(SUNDER_CCACHE ccache)
if(SUNDER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SUNDER_CCACHE})
endif()

# Same bits everywhere: no contraction, no fast math, and no explicit FMA from Eigen's own kernels
# (docs/decisions/001-same-bits.md).
add_library(sunder_options INTERFACE)
target_compile_features(sunder_options INTERFACE cxx_std_20)
target_compile_definitions(sunder_options INTERFACE EIGEN_DONT_VECTORIZE EIGEN_MPL2_ONLY)
target_compile_options(sunder_options INTERFACE
  $<BUILD_INTERFACE:-ffp-contract=off -march=${SUNDER_ARCH}>)
if(SUNDER_STRICT)
  target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic
    -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align -Woverloaded-virtual
    -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough -Werror>)
endif()

# One library a room: sunder_room(name SOURCES ... [LINK ...] [PRIVATE_LINK ...])
function(sunder_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(sunder_${name} STATIC ${ROOM_SOURCES})
  add_library(sunder::${name} ALIAS sunder_${name})
  target_include_directories(sunder_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(sunder_${name} PUBLIC sunder_options Eigen3::Eigen ${ROOM_LINK}
    PRIVATE ${ROOM_PRIVATE_LINK})
  set_target_properties(sunder_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON EXPORT_NAME ${name})
endfunction()
