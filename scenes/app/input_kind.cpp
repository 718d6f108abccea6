#include "scenes/app/input_kind.h"

#include "engine/io/bytes.h"
#include "engine/io/file_ending.h"
#include "engine/io/frame_file.h"
#include "engine/io/recording/recording.h"

namespace sunder::app {

InputKind input_kind(const std::string& input) {
  if (is_recording(input)) return InputKind::kRecording;
  if (is_stored_frame(input)) return InputKind::kFrame;
  if (begins_with(input, "glTF")) return InputKind::kGlb;
  if (has_ending(input, ".take")) return InputKind::kRecording;
  if (has_ending(input, ".frame")) return InputKind::kFrame;
  if (has_ending(input, ".glb")) return InputKind::kGlb;
  return InputKind::kScene;
}

}  // namespace sunder::app
