// Encoding of a frame in a recording, as a difference to the previous frame.
//
// Bodies are stored with 0.1 mm and 0.5 mrad, for display. The exact state is stored as hashes, for
// comparison with another run: one of the frame, and short ones of each body.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/recording/recording_blocks.h"
#include "engine/io/recording/table_coder.h"
#include "engine/model/frame.h"

namespace sunder {

/// Steps per m, per unit of a quaternion, and per m/s or rad/s, in which bodies are stored.
inline constexpr double kPositionSteps = 8192, kRotationSteps = 4096;
inline constexpr double kSpeedSteps = 2;  // coarse: speeds are not drawn

/// Fields of a body's state of which a recording has a hash each.
enum class HashedField { kPosition, kOrientation, kVelocity, kAngularVelocity };
inline constexpr int kHashedFields = 4;

/// Returns short hashes of a body's exact state, by field, to find what differs.
std::int32_t short_hashes(const FrameBody& body);
/// Returns true if a body has another state than a recorded one of these short hashes.
bool differs(const FrameBody& body, std::int32_t recorded);
/// Returns true if there is a hash of each field. The first recordings of version 1.0 have one of
/// the whole state.
bool has_hashes_of_fields(std::int32_t recorded);
/// Returns true if a field has another hash; there must be one of each field.
bool differs(HashedField field, const FrameBody& body, std::int32_t recorded);

/// One frame of a recording.
struct RecordedFrame {
  Frame frame;                            ///< Without mesh store and materials.
  std::vector<std::int32_t> body_hashes;  ///< short_hashes() of each body's original state.
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
