// Remarks on a run at its end: shots that hit nothing, and nothing that broke.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder::app {

/// A sink that watches the shots of a scene and its breaks. A shot has hit nothing as long as its
/// ball moves as gravity alone moves it. Shots that hang from something are not watched.
class RunNotes final : public FrameSink {
 public:
  /// `start_s`: time of the first frame. Shots before it are not watched.
  explicit RunNotes(const Scene& scene, double start_s = 0);
  void take(const FramePtr& frame) override;
  /// Returns a line for each shot that appeared and touched nothing, or touched the ground first,
  /// and one if nothing broke; empty if there is nothing to say.
  std::string text() const;

  /// Returns the fields that change in a run, for saved states.
  static auto fields(auto& self) {
    return std::tie(self.shots_, self.last_s_, self.names_, self.breaks_);
  }

 private:
  struct Watched {
    std::uint32_t name = 0;  ///< Index in Frame::names.
    double time_s = 0;
    Vec3 velocity_W;
    double radius_m = 0;
    enum class State { kToCome, kFlying, kGroundFirst, kHit } state = State::kToCome;
  };
  void watch(Watched& shot, const FrameBody& ball, double since_s) const;

  std::vector<Watched> shots_;
  Vec3 gravity_W_;
  double ground_m_;
  bool has_ground_meshes_;
  double last_s_;
  std::shared_ptr<const std::vector<std::string>> names_;
  std::int64_t breaks_ = 0;
};

}  // namespace sunder::app
