# Writes a digest of the sources that determine what a saved state means: those of the engine, the
# solver and the fractures. Usage: cmake -D ROOT=... -D OUT=... -P source_digest.cmake
cmake_minimum_required(VERSION 3.25)
set(all "")
foreach(module engine fracture solver)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${module}/*.h ${ROOT}/${module}/*.cpp)
  foreach(file ${files})
    file(SHA256 ${ROOT}/${file} hash)
    string(APPEND all "${file} ${hash}\n")
  endforeach()
endforeach()
string(SHA256 digest "${all}")
string(SUBSTRING ${digest} 0 16 digest)
file(CONFIGURE OUTPUT ${OUT} CONTENT
  "namespace sunder {\nextern const char* const kSourceDigest;\nconst char* const kSourceDigest = \"@digest@\";\n}  // namespace sunder\n"
  @ONLY)
