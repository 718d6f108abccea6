// What one run of a scene came to, as far as accuracy goes: what two runs are compared by.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::bench {

/// What was measured, by name, in SI units: a number is a sample of one, "size of pieces m" has one
/// for each piece. A name ends in its unit. Ordered, so that it is written down alike everywhere.
struct Facts {
  std::map<std::string, std::vector<double>> samples;
  std::string state_hash;
};

/// Collects the facts of the frames that it takes; keeps the first of them and the last.
///
/// | fact | what |
/// |---|---|
/// | penetration p99, worst m | of all contacts that pressed, in all frames |
/// | drift, drift largest m | way of what moves and stands |
/// | surface in place share | of the surface at the start, what stands |
/// | energy after 1/4, 1/2, 1 J/kg | kinetic, potential and plastic, over all there is |
/// | energy gained J/kg | summed rises from frame to frame while nothing broke, came or went |
/// | momentum residual share | the frame's report, at its worst |
/// | speed m/s, spin rad/s | of what moves, every half second |
/// | exit speed m/s | of each striker |
/// | pieces | bodies at the end that were not there at the start, strikers aside |
/// | size of pieces m | from a piece's centre to its farthest corner |
/// | run-out m | over ground, of pieces and what no longer stands, from the middle at the start |
///
/// What stands is a body of the first frame that is now within a tenth of its size of where it was;
/// what is whole and near but struck counts, since frames do not say who was. A striker is a body
/// faster than 5 m/s when it is first seen, in a frame without breaks; its exit speed is that .2 s
/// after the first frame that took a tenth of its speed. What there is too little of to measure has
/// no sample. Angular momentum is not here: frames know neither inertia nor what the ground turned.
class FactsSink final : public FrameSink {
 public:
  FactsSink();
  ~FactsSink() override;
  void take(const FramePtr& frame) override;
  Facts facts() const;

 private:
  struct Watch;
  std::unique_ptr<Watch> watch_;
};

}  // namespace sunder::bench
