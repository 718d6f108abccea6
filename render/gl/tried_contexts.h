// The OpenGL contexts that a machine has. A header without types of GL, for the program.
#pragma once

#include <string>
#include <vector>

namespace sunder::render {

/// A kind of OpenGL context, as tried on this machine.
struct TriedContext {
  std::string kind;         ///< A value of --gl, such as "egl-device:0".
  std::string description;  ///< Renderer and version; empty if the context could not be made.
  std::string reason;       ///< Reason of the failure; empty if the context could be made.
};

/// Makes each context that --gl auto considers, in its order, and removes it. The first of the
/// contexts that could be made is the one that --gl auto uses.
std::vector<TriedContext> try_contexts();

}  // namespace sunder::render
