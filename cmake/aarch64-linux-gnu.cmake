# Toolchain: compiles for 64-bit ARM on another machine, by Debian's g++-aarch64-linux-gnu. Programs
# of the build run under QEMU. The libraries are those that cmake/arm64_packages.sh unpacked.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static;-L;/usr/aarch64-linux-gnu)

set(SUNDER_ARM64_PACKAGES ${CMAKE_CURRENT_LIST_DIR}/../build-arm64/packages CACHE PATH
  "Folder with the unpacked packages for arm64")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SUNDER_ARM64_PACKAGES)
cmake_path(ABSOLUTE_PATH SUNDER_ARM64_PACKAGES NORMALIZE OUTPUT_VARIABLE packages)
if(NOT EXISTS ${packages}/usr/lib/aarch64-linux-gnu)
  message(FATAL_ERROR "No packages for arm64 in ${packages}. "
    "Run cmake/arm64_packages.sh, or set SUNDER_ARM64_PACKAGES.")
endif()
set(CMAKE_FIND_ROOT_PATH ${packages} /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${packages})
set(ENV{PKG_CONFIG_LIBDIR}
  ${packages}/usr/lib/aarch64-linux-gnu/pkgconfig:${packages}/usr/share/pkgconfig)
