// Key frames of motions: as few as keep an interpolated motion within an error of the recorded one.
//
// Begin with KeyReducer. PositionKeys and RotationKeys are the two kinds of motion.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Positions, stored in single precision and interpolated linearly.
class PositionKeys {
 public:
  using Value = Vec3;
  using Key = Vec3f;
  using Read = Vec3;

  explicit PositionKeys(double tolerance_m);
  static Key store(const Value& value, const Key*) { return value.cast<float>(); }
  static Read read(const Key& key) { return key.cast<double>(); }
  static bool is_same(const Value& a, const Value& b) { return a == b; }
  /// Interpolation from one key to the next.
  class Segment {
   public:
    Segment(const PositionKeys& keys, const Read& from, const Read& to)
        : keys_(keys), from_(from), change_(to - from) {}
    /// True if the position at `share` of the segment is within the tolerance of `value`.
    bool is_close(double share, const Value& value) const {
      return (from_ + share * change_ - value).squaredNorm() <= keys_.squared_tolerance_;
    }

   private:
    const PositionKeys& keys_;
    Read from_, change_;
  };

 private:
  double squared_tolerance_;
};

/// Rotations, stored as quaternions of 16-bit fractions. The tolerance holds for both usual
/// interpolations: spherical, and linear with normalization.
class RotationKeys {
 public:
  using Value = Quat;
  using Key = std::array<std::int16_t, 4>;  ///< x, y, z, w times 32767.
  using Read = Eigen::Vector4d;             ///< Unit quaternion x, y, z, w.

  /// The tolerance is at least kLeastTolerance_rad, of which the storage takes a third.
  explicit RotationKeys(double tolerance_rad);
  static constexpr double kLeastTolerance_rad = 1.7e-4;

  /// Returns the key of a rotation, with the sign nearer to the key before (null: there is none).
  static Key store(const Value& value, const Key* before);
  static Read read(const Key& key);
  static bool is_same(const Value& a, const Value& b) { return a.coeffs() == b.coeffs(); }
  /// Interpolation from one key to the next.
  class Segment {
   public:
    Segment(const RotationKeys& keys, const Read& from, const Read& to);
    /// True if both rotations at `share` of the segment are within the tolerance of `value`.
    bool is_close(double share, const Value& value) const;

   private:
    bool is_close(const Read& at, const Value& value) const;

    const RotationKeys& keys_;
    Read from_, to_;
    /// Angle between the two quaternions, and its sine; 0 if both interpolations are alike.
    double angle_ = 0, sine_ = 0;
  };

 private:
  double squared_chord_;  ///< Largest squared distance of two quaternions.
};

/// Chooses keys from the samples of a motion, one sample a frame, as these come. At every sample
/// the interpolated motion is within the tolerance of `Motion`, stored keys included. A motion that
/// is constant has one key.
template <class Motion>
class KeyReducer {
 public:
  using Value = typename Motion::Value;
  using Key = typename Motion::Key;

  explicit KeyReducer(const Motion& motion) : motion_(motion) {}
  /// Adds the sample of a frame, the one after the frame of the sample before.
  void add(std::uint32_t frame, const Value& value) {
    if (keys_.empty()) {
      add_key(frame, value);
      last_ = {frame, value};
      return;
    }
    const bool is_constant = !pending_.empty() && Motion::is_same(pending_.back().value, value);
    if (pending_.size() >= kMaxPending || !fits(frame, value)) {
      add_key(last_.frame, last_.value);
      pending_.clear();
    }
    if (is_constant && !pending_.empty()) {
      pending_.back().last = frame;
    } else {
      pending_.push_back({frame, frame, value});
    }
    last_ = {frame, value};
  }
  /// Adds the key of the last sample; no sample may follow.
  void finish() {
    if (!pending_.empty()) add_key(last_.frame, last_.value);
    pending_ = {};
    const auto is_first = [&](const Key& key) { return key == keys_.front(); };
    if (std::ranges::all_of(keys_, is_first) && !keys_.empty()) {
      keys_.resize(1);
      frames_.resize(1);
    }
  }
  /// Frames of the keys, ascending.
  const std::vector<std::uint32_t>& frames() const { return frames_; }
  const std::vector<Key>& keys() const { return keys_; }

 private:
  /// Equal samples of successive frames. An interpolation that is close to the first and to the
  /// last is close to all.
  struct Run {
    std::uint32_t first, last;
    Value value;
  };
  struct Sample {
    std::uint32_t frame = 0;
    Value value;
  };
  /// Largest number of runs between two keys, which bounds the work for a sample.
  static constexpr std::size_t kMaxPending = 64;

  /// True if the segment from the last key to a sample is close to all samples between.
  bool fits(std::uint32_t frame, const Value& value) const {
    if (pending_.empty()) return true;
    const Key end = Motion::store(value, &keys_.back());
    const typename Motion::Segment segment(motion_, Motion::read(keys_.back()), Motion::read(end));
    const double first = frames_.back(), length = frame - first;
    const auto is_close = [&](const Run& run) {
      return segment.is_close((run.first - first) / length, run.value) &&
             (run.last == run.first || segment.is_close((run.last - first) / length, run.value));
    };
    // The middle first, where a curved motion is farthest from the segment.
    return is_close(pending_[pending_.size() / 2]) && std::ranges::all_of(pending_, is_close);
  }
  void add_key(std::uint32_t frame, const Value& value) {
    keys_.push_back(Motion::store(value, keys_.empty() ? nullptr : &keys_.back()));
    frames_.push_back(frame);
  }

  Motion motion_;
  std::vector<std::uint32_t> frames_;
  std::vector<Key> keys_;
  std::vector<Run> pending_;  ///< Samples after the last key.
  Sample last_;
};

}  // namespace sunder
