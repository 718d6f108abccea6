// The kinds of runs that commands read.
#pragma once

#include <cstdint>
#include <string>

namespace sunder::app {

/// Kinds of inputs of the commands render, export and view.
enum class InputKind : std::uint8_t { kScene, kRecording, kFrame, kGlb };

/// Returns the kind of an input by the first bytes of the file, whatever its name. The ending of
/// the name (.take, .frame or .glb) counts if these bytes are of no kind, or if there is no such
/// file.
InputKind input_kind(const std::string& input);

}  // namespace sunder::app
