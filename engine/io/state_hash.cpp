#include "engine/io/state_hash.h"

#include <cstdio>

#include <xxhash.h>

namespace sunder {
namespace {

/// A body as hashed: 17 numbers without padding.
struct Record {
  std::uint64_t key;
  double pose[7];
  double motion[6];
  std::uint64_t flags;
};

Record record(const FrameBody& body) {
  const Pose& X_WB = body.X_WB;
  Record r{};
  r.key = body.key;
  for (int i = 0; i < 3; ++i) {
    r.pose[i] = X_WB.position[i];
    r.motion[i] = body.velocity_W[i];
    r.motion[3 + i] = body.angular_velocity_W[i];
  }
  for (int i = 0; i < 4; ++i) r.pose[3 + i] = X_WB.rotation.coeffs()[i];
  r.flags = (body.is_static ? 1u : 0u) | (body.asleep ? 2u : 0u);
  return r;
}

}  // namespace

std::uint64_t hash_state(const Frame& frame) {
  std::vector<Record> records;
  records.reserve(frame.bodies.size());
  for (const FrameBody& body : frame.bodies) records.push_back(record(body));
  return XXH3_64bits_withSeed(records.data(), records.size() * sizeof(Record), frame.index);
}

void StateHash::take(const FramePtr& frame) { per_frame_.push_back(hash_state(*frame)); }

std::string StateHash::hex() const {
  char text[17];
  const XXH64_hash_t all =
      XXH3_64bits(per_frame_.data(), per_frame_.size() * sizeof(std::uint64_t));
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(all));
  return text;
}

}  // namespace sunder
