# Options with which all targets of the project are compiled and installed, and functions that add
# targets.

include(CheckLinkerFlag)
include(GNUInstallDirs)

# Components are packages; what names none is for developers.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
find_program(SUNDER_CCACHE ccache)
if(SUNDER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(settings CCACHE_SLOPPINESS=locale)
  if(SUNDER_QUICK_BUILD)
    string(APPEND settings ,pch_defines,time_macros)
  endif()
  # Paths within the build folder count relative to it, and the language not at all (Python sets it
  # for the builds that it starts), so that one build compiles nothing that another of the same
  # sources and options has compiled.
  if(NOT DEFINED ENV{CCACHE_BASEDIR})
    list(APPEND settings CCACHE_BASEDIR=${PROJECT_BINARY_DIR})
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env ${settings} ${SUNDER_CCACHE})
endif()

# An older processor stops x86-64-v3 code with "illegal instruction".
message(STATUS "Instruction set SUNDER_ARCH: ${SUNDER_ARCH}")
if(SUNDER_ARCH STREQUAL "x86-64-v3" AND EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo cpu_flags REGEX "^flags.* avx2 .*" LIMIT_COUNT 1)
  if(NOT cpu_flags)
    message(WARNING "This processor cannot run ${SUNDER_ARCH} code. To run Sunder on it, "
      "configure with -DSUNDER_ARCH=x86-64-v2: slower, with the same results.")
  endif()
endif()

# The same bits on every processor: no contraction, no fast math, and no explicit FMA from Eigen's
# own kernels (docs/decisions/001-determinism.md). Users of the library get these options too, because
# its headers have inline functions.
add_library(sunder_options INTERFACE)
target_compile_features(sunder_options INTERFACE cxx_std_20)
target_compile_definitions(sunder_options INTERFACE EIGEN_DONT_VECTORIZE EIGEN_MPL2_ONLY)
target_compile_options(sunder_options INTERFACE -ffp-contract=off)
# GCC 12 fuses products and sums of neighbouring lanes all the same (vfmaddsub), so it may not use
# FMA at all. AVX-512 has FMA of its own, which GCC uses so only where it vectorizes straight code.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-mno-fma>)
  if(SUNDER_ARCH AND NOT SUNDER_ARCH MATCHES "^x86-64(-v[23])?$")
    target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-fno-tree-slp-vectorize>)
  endif()
endif()
# Failed checks name their file from the root on: no installed file has the path of the build.
target_compile_options(sunder_options INTERFACE
  $<BUILD_INTERFACE:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>)
if(SUNDER_ARCH)
  target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-march=${SUNDER_ARCH}>)
endif()
if(SUNDER_STRICT)
  set(shadow -Wshadow)
  if(SUNDER_QUICK_BUILD)  # sources of a batch share their file-local names
    set(shadow -Wshadow=local -Wno-subobject-linkage)
  endif()
  target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic
    ${shadow} -Wnon-virtual-dtor -Wold-style-cast -Wcast-align -Woverloaded-virtual
    -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough>)
  # GCC 12 warns of overlaps and overruns in std::string's operator+ that do not exist (GCC bug
  # 105651), and that wide vectors are passed differently without AVX; only the solver passes them,
  # to itself.
  set(gnu -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-maybe-uninitialized -Wno-psabi)
  target_compile_options(sunder_options INTERFACE
    $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:${gnu}>>)
endif()
if(SUNDER_SANITIZE)
  # Checks of pointers take a third of the compile time; a null pointer stops the program anyway.
  target_compile_options(sunder_options INTERFACE $<BUILD_INTERFACE:-fsanitize=${SUNDER_SANITIZE}
    -fno-sanitize=null,alignment,object-size,vptr -fno-sanitize-recover=all
    -fno-omit-frame-pointer>)
  target_link_options(sunder_options INTERFACE $<BUILD_INTERFACE:-fsanitize=${SUNDER_SANITIZE}>)
endif()
install(TARGETS sunder_options EXPORT sunderTargets)
set_target_properties(sunder_options PROPERTIES EXPORT_NAME options)

# Links a program in C with the sanitizers of the library that it uses, by the compiler of that.
function(sunder_sanitize target)
  if(SUNDER_SANITIZE)
    target_link_options(${target} PRIVATE -fsanitize=${SUNDER_SANITIZE})
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
  endif()
endfunction()

# Marks a shared library with the instruction set that it is compiled for: on a processor without it
# the loader reports "CPU ISA level is lower than required", and runs no code of the library.
function(sunder_mark_processor target)
  if(SUNDER_ARCH MATCHES "^x86-64-v[234]$")
    check_linker_flag(CXX -Wl,-z,${SUNDER_ARCH} SUNDER_LINKER_MARKS_PROCESSOR)
    if(SUNDER_LINKER_MARKS_PROCESSOR)
      target_link_options(${target} PRIVATE -Wl,-z,${SUNDER_ARCH})
    endif()
  endif()
endfunction()

# Precompiles headers once for tests with the same flags, if SUNDER_QUICK_BUILD is on.
function(sunder_precompile target first)
  if(NOT SUNDER_QUICK_BUILD)
    return()
  endif()
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache
  if(target STREQUAL first)
    target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath>
      <cstdint> <functional> <map> <memory> <span> <string> <vector> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${first})
  endif()
endfunction()

# Compiles eight sources in one compiler run if SUNDER_QUICK_BUILD is on, so that their headers are
# parsed once. Tests whose local names conflict with others have a namespace named after their file.
function(sunder_unity target)
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD ${SUNDER_QUICK_BUILD} UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# Embeds files as strings: sunder_embed(OUT HEADER NAMESPACE FILES...) writes OUT, which defines the
# strings that HEADER declares in NAMESPACE; materials.toml becomes materials_toml.
function(sunder_embed out header namespace)
  set(code "#include \"${header}\"\nnamespace ${namespace} {\n")
  foreach(file ${ARGN})
    file(READ ${file} text)
    cmake_path(GET file FILENAME symbol)
    string(REPLACE "." "_" symbol ${symbol})
    string(APPEND code "const char* const ${symbol} = R\"text(${text})text\";\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  string(APPEND code "}\n")
  file(CONFIGURE OUTPUT ${out} CONTENT "@code@" @ONLY)
endfunction()

# Adds the library of a module: sunder_module(name SOURCES ... [LINK ...] [PRIVATE_LINK ...])
function(sunder_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(sunder_${name} STATIC ${MODULE_SOURCES})
  add_library(sunder::${name} ALIAS sunder_${name})
  target_include_directories(sunder_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(sunder_${name} PUBLIC sunder_options Eigen3::Eigen ${MODULE_LINK}
    PRIVATE ${MODULE_PRIVATE_LINK})
  sunder_unity(sunder_${name})
  set_target_properties(sunder_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON EXPORT_NAME ${name})
  install(TARGETS sunder_${name} EXPORT sunderTargets)
endfunction()
