// Measurements of a run by which a study compares accuracy.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::scenes {

/// Samples of a run by name, in SI units. A single value has one sample, "size of pieces m" has one
/// for each piece. A name ends in its unit. Sorted by name, so that files are equal everywhere.
struct Facts {
  std::map<std::string, std::vector<double>> samples;
  std::string state_hash;
};

/// Measures the frames of a run; keeps the first and the last frame.
///
/// | fact | meaning |
/// |---|---|
/// | penetration p99, worst m | penetration of all contacts with an impulse, in all frames |
/// | drift, drift largest m | displacement of dynamic bodies that stand |
/// | surface in place share | surface of bodies that stand, over all surface at the start |
/// | energy after 1/4, 1/2, 1 J/kg | kinetic, potential and plastic, over all mass |
/// | energy gained J/kg | sum of rises between frames without breaks, new or removed bodies |
/// | momentum residual share | largest FrameReport::momentum_residual |
/// | speed m/s, spin rad/s | of dynamic bodies, every half second |
/// | exit speed m/s | of each striker |
/// | pieces | bodies at the end that did not exist at the start, without strikers |
/// | size of pieces m | distance from a piece's centre to its farthest corner |
/// | run-out m | horizontal distance of pieces and fallen bodies from the centre at the start |
///
/// A body of the first frame stands if it has moved by at most a tenth of its size; frames do not
/// tell whether it was hit. A striker is a body faster than 5 m/s when it first appears, in a frame
/// without breaks; its exit speed is that 0.2 s after the first frame in which it lost a tenth of
/// its speed. A fact without values has no sample. Angular momentum is not measured, since frames
/// have neither inertias nor the torque of the ground.
class FactsSink final : public FrameSink {
 public:
  FactsSink();
  ~FactsSink() override;
  void take(const FramePtr& frame) override;
  /// Returns the facts of the frames taken so far.
  Facts facts() const;

 private:
  struct Collector;
  std::unique_ptr<Collector> collector_;
};

}  // namespace sunder::scenes
