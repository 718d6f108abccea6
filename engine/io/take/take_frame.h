// A frame as the bytes of a take, as a change of the frame before.
//
// Bodies are kept to 0.1 mm and 0.5 mrad, which is for the eye; what a run must match bit for bit
// to be the same is kept as hashes: one of the frame, and a short one of each body.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/take/take_blocks.h"
#include "engine/io/take/take_table.h"
#include "engine/model/frame.h"

namespace sunder {

/// What is left of FrameBody's exact state: enough to tell bodies apart that differ.
std::int32_t short_hash(const FrameBody& body);

/// What a take holds of one instant.
struct TakeFrame {
  Frame frame;                            ///< Without its mesh store and materials.
  std::vector<std::int32_t> body_hashes;  ///< short_hash() of each body as it was.
  std::uint32_t meshes = 0;               ///< Size of the store then.
};

/// One end of a stream of frames: writer and reader each keep one, in step.
class FrameCoder {
 public:
  /// The version is that of the take, from kOldestTake on.
  explicit FrameCoder(char version = kTakeMagic[kTakeName]);
  /// The next frame stands alone.
  void reset();
  void write(ByteWriter& out, const Frame& frame);
  /// Throws InputError, naming `file`, for bytes that are no frame of this stream.
  TakeFrame read(const std::vector<std::byte>& bytes, const std::string& file);

 private:
  void write_instances(ByteWriter& out, const Frame& frame,
                       const std::vector<std::uint32_t>& before);
  void read_instances(ByteReader& in, const std::string& file,
                      const std::vector<std::uint32_t>& before, TakeFrame& take);

  char version_;
  TableCoder bodies_, debris_, dust_;
  std::vector<std::uint64_t> keys_;                 ///< Of the last frame's bodies.
  std::vector<std::vector<std::uint32_t>> meshes_;  ///< Drawn on each of them.
};

}  // namespace sunder
