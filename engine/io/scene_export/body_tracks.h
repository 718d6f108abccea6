// The bodies of a run: when each appears and disappears, how it moves, and what is drawn on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/io/scene_export/motion_keys.h"
#include "engine/model/frame.h"

namespace sunder {

/// Number of a frame in place of the end of something that lasts until the last frame.
inline constexpr std::uint32_t kUntilEnd = 0xffffffff;

/// A mesh that is drawn on a body from frame `begin` on, and no more from frame `end` on.
struct InstanceSpan {
  MeshIndex mesh;
  MaterialIndex material;  ///< none(): the mesh's.
  std::uint32_t begin = 0, end = kUntilEnd;
};

/// A body from the frame in which it appears, `born`, to the first without it, `gone`. The keys are
/// of the pose of a frame N that moves with the body: world = X_WN * (point_R - center_R).
struct BodyTrack {
  std::uint64_t key = 0;
  std::uint64_t parent_key =
      0;  ///< Key of the body that this was part of; its own if there is none.
  std::uint32_t name = kNoName;  ///< Index in Frame::names.
  double mass_kg = 0;            ///< When it appeared; 0 if unknown.
  std::uint32_t born = 0, gone = kUntilEnd;
  Vec3 center_R = Vec3::Zero();  ///< Centre of mass when the body appeared.
  KeyReducer<PositionKeys> positions;
  KeyReducer<RotationKeys> rotations;
  std::vector<InstanceSpan> spans;
};

/// Makes the tracks of the bodies of successive frames.
class BodyTracks {
 public:
  /// `take` is called with each track once its body is gone, in ascending order of keys in a frame.
  BodyTracks(const PositionKeys& positions, const RotationKeys& rotations,
             std::function<void(const BodyTrack&)> take);
  ~BodyTracks();
  /// Records where the new bodies of a frame come from that is not added.
  void skip(const Frame& frame);
  /// Adds a frame; numbers count from 0 without gaps.
  void add(std::uint32_t number, const Frame& frame);
  /// Ends the tracks of the bodies that are left.
  void finish();

 private:
  struct Active;
  using Drawn = std::vector<std::pair<MeshIndex, MaterialIndex>>;

  std::vector<Drawn> drawn_on_bodies(const Frame& frame) const;
  void match(std::uint32_t number, const Frame& frame);
  std::uint64_t parent_of(const FrameBody& body) const;
  void end(Active& active);

  PositionKeys positions_;
  RotationKeys rotations_;
  std::function<void(const BodyTrack&)> take_;
  std::vector<std::unique_ptr<Active>> active_;  ///< One for each body of the last frame.
  /// Parents of the bodies that were new in skipped frames, since the last frame that was added.
  std::unordered_map<std::uint64_t, std::uint64_t> parents_;
};

}  // namespace sunder
