# Installs the build into an empty prefix, then configures, builds and runs the consumer there,
# without the path of the checkout; then the example in C, by a project without C++. Called by ctest
# with ROOT (the checkout), BUILD (the build directory), COMPILER and C_COMPILER.
function(run)
  list(JOIN ARGN " " command)
  message(STATUS "${command}")
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The work directory is outside the checkout, whose path would otherwise be part of the prefix.
execute_process(COMMAND mktemp -d OUTPUT_VARIABLE work OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)
set(prefix ${work}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/ DESTINATION ${work}/source)
run(${CMAKE_COMMAND} -G Ninja -S ${work}/source -B ${work}/build -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/build)
run(${CMAKE_COMMAND} -E chdir ${work}/build ./consumer)
# Without the options of the library, whose layouts are others, nothing is compiled.
file(WRITE ${work}/other.cpp "#include <sunder/types.h>\n")
execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I${prefix}/include
  -isystem /usr/include/eigen3 ${work}/other.cpp RESULT_VARIABLE compiled ERROR_VARIABLE said)
if(compiled EQUAL 0 OR NOT said MATCHES "EIGEN_DONT_VECTORIZE")
  message(FATAL_ERROR "compiled without EIGEN_DONT_VECTORIZE: ${said}")
endif()
file(COPY ${ROOT}/examples/minimal.c DESTINATION ${work}/source/c)
run(${CMAKE_COMMAND} -G Ninja -S ${work}/source/c -B ${work}/build-c -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/build-c)
run(${CMAKE_COMMAND} -E chdir ${work}/build-c ./minimal)
run(${CMAKE_COMMAND} -E chdir ${work}/build-c ./scene_by_name)

file(GLOB_RECURSE headers ${prefix}/include/*)
list(LENGTH headers count)
if(count GREATER 27)
  message(FATAL_ERROR "${count} headers are installed; the public interface has 27")
endif()

# Installed files that contain the path of the checkout would depend on it.
execute_process(COMMAND grep -rlF ${ROOT} ${prefix}/include ${prefix}/lib ${prefix}/share
  ${work}/build/consumer OUTPUT_VARIABLE naming RESULT_VARIABLE found)
if(NOT found EQUAL 1)
  message(FATAL_ERROR "installed files contain the path of the checkout ${ROOT}:\n${naming}")
endif()
file(REMOVE_RECURSE ${work})
