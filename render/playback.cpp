#include "render/playback.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder::render {
namespace {

constexpr double kFrameTolerance = 1e-6;  // tolerance for the time of a picture, in source frames

}  // namespace

std::uint64_t PlaybackRate::first_picture(std::uint64_t frame) const {
  return static_cast<std::uint64_t>(
      std::ceil((static_cast<double>(frame) - kFrameTolerance) / step()));
}

std::uint64_t PlaybackRate::last_picture(std::uint64_t frame) const {
  return static_cast<std::uint64_t>(
      std::floor((static_cast<double>(frame) + kFrameTolerance) / step()));
}

bool ResampledSource::read() {
  if (ended_) return false;
  FramePtr frame = source_.next();
  ended_ = !frame;
  if (frame) frames_.push_back(std::move(frame));
  return !ended_;
}

/// Returns the interval between the first two frames held, computed once for all its pictures.
const FrameInterval& ResampledSource::interval() {
  if (interval_.before == frames_[0]) return interval_;
  if (frames_.size() < 3) read();
  const bool goes_on = interval_.after == frames_[0] && interval_.beyond == frames_[1];
  FrameInterval next{
      frames_[0], frames_[1],
      goes_on ? std::move(interval_.following_match) : passage(*frames_[0], *frames_[1])};
  if (frames_.size() > 2) {
    next.beyond = frames_[2];
    next.following_match = passage(*frames_[1], *frames_[2]);
  }
  interval_ = std::move(next);
  return interval_;
}

FramePtr ResampledSource::next() {
  if (frames_.empty() && !read()) return nullptr;
  if (!started_) picture_ = pace_.first_picture(frames_[0]->index);
  started_ = true;
  const double at = static_cast<double>(picture_) * pace_.step();
  const auto whole = static_cast<std::uint64_t>(std::floor(at + kFrameTolerance));
  while (frames_[0]->index < whole) {
    if (frames_.size() == 1 && !read()) return nullptr;
    frames_.pop_front();
  }
  const double part = at - static_cast<double>(whole);
  const bool is_passed_over = picture_ < first_;
  std::shared_ptr<Frame> shown;
  if (part <= kFrameTolerance || is_passed_over) {
    if (frames_[0]->index == picture_) {
      ++picture_;
      return frames_[0];
    }
    shown = std::make_shared<Frame>(*frames_[0]);
  } else {
    if (frames_.size() == 1 && !read()) return nullptr;
    shown = between(interval(), part);
  }
  shown->index = picture_++;
  if (is_passed_over) {
    picture_ = std::clamp(pace_.first_picture(frames_[0]->index + 1), picture_, first_);
  }
  return shown;
}

}  // namespace sunder::render
