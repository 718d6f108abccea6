#include "engine/io/state_hash.h"

#include <algorithm>
#include <cstdio>

#include <xxhash.h>

#include "engine/io/particle_codes.h"
#include "engine/io/statistics.h"

namespace sunder {
namespace {

/// State of a body as it is hashed: 15 numbers without padding.
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

template <class Particle>
std::uint64_t hash_codes(const std::vector<Particle>& particles, std::uint64_t seed) {
  std::vector<ParticleCode> codes;
  codes.reserve(particles.size());
  for (const Particle& particle : particles) codes.push_back(encode(particle));
  return XXH3_64bits_withSeed(codes.data(), codes.size() * sizeof(ParticleCode), seed);
}

}  // namespace

std::uint64_t hash_state(const Frame& frame) {
  if (frame.recorded_hash != 0) return frame.recorded_hash;
  std::vector<Record> records;
  records.reserve(frame.bodies.size());
  for (const FrameBody& body : frame.bodies) records.push_back(record(body));
  std::uint64_t hash =
      XXH3_64bits_withSeed(records.data(), records.size() * sizeof(Record), frame.index);
  // Without particles the hash is that of the bodies alone.
  if (!frame.debris.empty()) hash = hash_codes(frame.debris, hash);
  if (!frame.dust.empty()) hash = hash_codes(frame.dust, hash);
  return hash;
}

std::uint64_t hash_body(const FrameBody& body) {
  const Record one = record(body);
  return XXH3_64bits(&one, sizeof one);
}

void StateHash::take(const FramePtr& frame) { per_frame_.push_back(hash_state(*frame)); }

std::string hash_run(std::span<const std::uint64_t> states) {
  char text[17];
  const XXH64_hash_t all = XXH3_64bits(states.data(), states.size_bytes());
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(all));
  return text;
}

std::string StateHash::hex(std::size_t frames) const {
  return hash_run(std::span(per_frame_).first(std::min(frames, per_frame_.size())));
}

}  // namespace sunder
