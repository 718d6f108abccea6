// Holds a run against a take: the same bits in every frame, or where they first differ.
#pragma once

#include <string>

#include "engine/io/take/take.h"

namespace sunder {

/// A sink that compares frame by frame with a take, in the take's order.
class TakeVerifier final : public FrameSink {
 public:
  /// `take` is read from its beginning, and must outlive this.
  explicit TakeVerifier(TakeReader& take) : take_(take) {}

  void take(const FramePtr& frame) override;
  /// Frames that were the same before the first that was not.
  std::uint32_t same() const { return same_; }
  /// Empty if all were the same: else the first frame and body that differ.
  const std::string& difference() const { return difference_; }

 private:
  TakeReader& take_;
  std::uint32_t same_ = 0;
  std::string difference_;
};

}  // namespace sunder
