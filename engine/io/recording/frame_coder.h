// Encoding of a frame in a recording, as a difference to the previous frame.
//
// Bodies are stored with 0.1 mm and 0.5 mrad, for display. The exact state is stored as hashes, for
// comparison with another run: one of the frame, and a short one of each body.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/recording/recording_blocks.h"
#include "engine/io/recording/table_coder.h"
#include "engine/model/frame.h"

namespace sunder {

/// Returns a short hash of a body's exact state, to find bodies that differ.
std::int32_t short_hash(const FrameBody& body);

/// One frame of a recording.
struct RecordedFrame {
  Frame frame;                            ///< Without mesh store and materials.
  std::vector<std::int32_t> body_hashes;  ///< short_hash() of each body's original state.
  std::uint32_t meshes = 0;               ///< Size of the mesh store at that time.
};

/// Encoder or decoder of a stream of frames; writer and reader each have one, in equal states.
class FrameCoder {
 public:
  FrameCoder();
  /// Forgets the previous frame: the next one is encoded without reference to it.
  void reset();
  /// Appends a frame as a difference to the last one.
  void write(ByteWriter& out, const Frame& frame);
  /// Decodes a frame; throws InputError, naming `file`, if the bytes are no frame of this stream.
  RecordedFrame read(const std::vector<std::byte>& bytes, const std::string& file);

 private:
  void write_instances(ByteWriter& out, const Frame& frame,
                       const std::vector<std::uint32_t>& before);
  void read_instances(ByteReader& in, const std::string& file,
                      const std::vector<std::uint32_t>& before, RecordedFrame& take);

  TableCoder bodies_, debris_, dust_;
  std::vector<std::uint64_t> keys_;  ///< Keys of the last frame's bodies.
  /// For each of those bodies, the meshes drawn on it.
  std::vector<std::vector<std::uint32_t>> meshes_;
};

}  // namespace sunder
