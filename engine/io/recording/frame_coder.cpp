// Begin with FrameCoder::write() and read(), which mirror each other.
#include "engine/io/recording/frame_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <xxhash.h>

#include "engine/io/frame_parts.h"
#include "engine/io/particle_codes.h"
#include "engine/io/state_hash.h"

namespace sunder {
namespace {

constexpr std::size_t kMaxInstances = 1 << 24;
/// Set in short hashes by field; one hash of the whole state has 8 bits.
constexpr std::uint32_t kByField = 1u << 16;
constexpr int kBitsOfField = 4;

/// Returns a hash of the exact bits of a field, of kBitsOfField bits.
std::uint32_t field_hash(HashedField field, const FrameBody& body) {
  const auto hash = [](const auto& numbers) {
    return static_cast<std::uint32_t>(
        XXH3_64bits(numbers.data(), sizeof(double) * static_cast<std::size_t>(numbers.size())) >>
        (64 - kBitsOfField));
  };
  switch (field) {
    case HashedField::kPosition:
      return hash(body.X_WB.position);
    case HashedField::kOrientation:
      return hash(body.X_WB.rotation.coeffs());
    case HashedField::kVelocity:
      return hash(body.velocity_W);
    case HashedField::kAngularVelocity:
      return hash(body.angular_velocity_W);
  }
  return 0;
}

// Columns of a body: position and rotation (extrapolated), velocities, flags, hash, key, centre of
// mass, key less the key in the previous frame, name.
constexpr std::size_t kBodyColumns = 25;
constexpr std::size_t kExtrapolatedBodyColumns = 7;
// Only positions of particles are extrapolated: their rotations are too coarse to tell a rate of
// change from rounding.
constexpr std::size_t kExtrapolatedParticleColumns = 3;

std::int32_t code(double value, double steps) {
  const double scaled = value * steps;
  if (!std::isfinite(scaled)) return 0;
  return static_cast<std::int32_t>(std::rint(std::clamp(scaled, -2147483647.0, 2147483647.0)));
}

void put_code(std::int32_t*& to, const Vec3& v, double steps) {
  for (int i = 0; i < 3; ++i) *to++ = code(v[i], steps);
}

void encode(const FrameBody& body, std::int32_t* to) {
  put_code(to, body.X_WB.position, kPositionSteps);
  for (int i = 0; i < 4; ++i) *to++ = code(body.X_WB.rotation.coeffs()[i], kRotationSteps);
  put_code(to, body.velocity_W, kSpeedSteps);
  put_code(to, body.angular_velocity_W, kSpeedSteps);
  *to++ = (body.is_static ? 1 : 0) | (body.asleep ? 2 : 0);
  *to++ = short_hashes(body);
  const auto put_bits = [&](std::uint64_t bits) {
    *to++ = static_cast<std::int32_t>(bits);
    *to++ = static_cast<std::int32_t>(bits >> 32);
  };
  put_bits(body.key);
  for (int i = 0; i < 3; ++i) put_bits(std::bit_cast<std::uint64_t>(body.com_R[i]));
  *to++ = static_cast<std::int32_t>(body.key - body.previous_key);
  *to++ = static_cast<std::int32_t>(body.name);
}

Vec3 vector_of(const std::int32_t*& from, double steps) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = static_cast<double>(*from++) / steps;
  return v;
}

FrameBody decode_body(std::span<const std::int32_t> row, std::int32_t& hash) {
  const std::int32_t* from = row.data();
  FrameBody body;
  body.X_WB.position = vector_of(from, kPositionSteps);
  for (int i = 0; i < 4; ++i) {
    body.X_WB.rotation.coeffs()[i] = static_cast<double>(*from++) / kRotationSteps;
  }
  const double norm = body.X_WB.rotation.norm();
  body.X_WB.rotation.coeffs() = norm > 0.5 ? Eigen::Vector4d(body.X_WB.rotation.coeffs() / norm)
                                           : Eigen::Vector4d(0, 0, 0, 1);
  body.velocity_W = vector_of(from, kSpeedSteps);
  body.angular_velocity_W = vector_of(from, kSpeedSteps);
  body.is_static = (*from & 1) != 0;
  body.asleep = (*from++ & 2) != 0;
  hash = *from++;
  const auto take_bits = [&] {
    const auto low = static_cast<std::uint32_t>(*from++);
    return low | static_cast<std::uint64_t>(static_cast<std::uint32_t>(*from++)) << 32;
  };
  body.key = take_bits();
  for (int i = 0; i < 3; ++i) body.com_R[i] = std::bit_cast<double>(take_bits());
  if (!body.com_R.allFinite()) body.com_R.setZero();
  body.previous_key = body.key - static_cast<std::uint64_t>(std::int64_t{*from++});
  body.name = static_cast<std::uint32_t>(*from);
  return body;
}

/// Returns for each body its row in the last frame, or kNewRow; both lists ascend by key.
std::vector<std::uint32_t> match_keys(const std::vector<FrameBody>& bodies,
                                      const std::vector<std::uint64_t>& before) {
  std::vector<std::uint32_t> rows(bodies.size(), kNewRow);
  std::size_t b = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    while (b < before.size() && before[b] < bodies[i].key) ++b;
    if (b < before.size() && before[b] == bodies[i].key) rows[i] = static_cast<std::uint32_t>(b);
  }
  return rows;
}

/// True if two rows may be of one particle in consecutive frames.
bool may_match(std::span<const std::int32_t> now, std::span<const std::int32_t> then) {
  constexpr std::int32_t kMaxPositionSteps = 512;
  constexpr std::int32_t kMaxRotationSteps = 8;
  if (now[8] != then[8]) return false;
  for (std::size_t c = 0; c < 7; ++c) {
    if (std::abs(std::int64_t{now[c]} - then[c]) > (c < 3 ? kMaxPositionSteps : kMaxRotationSteps))
      return false;
  }
  return true;
}

/// Returns the rows of debris in the last frame. Debris keeps its index, except that the last piece
/// may move to the index of a removed one.
std::vector<std::uint32_t> match_debris(const NumberTable& table, const NumberTable& before) {
  std::vector<std::uint32_t> rows(table.rows(), kNewRow);
  for (std::size_t r = 0; r < std::min(rows.size(), before.rows()); ++r) {
    if (may_match(table.row(r), before.row(r))) rows[r] = static_cast<std::uint32_t>(r);
  }
  return rows;
}

/// Returns the rows of dust in the last frame. Dust keeps its order with gaps: a row matches the
/// most similar of the next rows.
std::vector<std::uint32_t> match_dust(const NumberTable& table, const NumberTable& before) {
  constexpr std::size_t kSearchWindow = 24;
  constexpr std::int64_t kCloseEnough = 8;  // difference below which no further row is tried
  std::vector<std::uint32_t> rows(table.rows(), kNewRow);
  std::size_t expected = 0;
  for (std::size_t r = 0; r < rows.size() && expected < before.rows(); ++r) {
    std::int64_t min_difference = std::numeric_limits<std::int64_t>::max();
    const std::size_t end = std::min(expected + kSearchWindow, before.rows());
    for (std::size_t b = expected; b < end && min_difference > kCloseEnough; ++b) {
      const auto now = table.row(r), then = before.row(b);
      if (!may_match(now, then)) continue;
      std::int64_t difference = 0;
      for (std::size_t c = 0; c < kParticleNumbers; ++c) {
        difference += std::abs(std::int64_t{now[c]} - then[c]);
      }
      if (difference >= min_difference) continue;
      min_difference = difference;
      rows[r] = static_cast<std::uint32_t>(b);
    }
    if (rows[r] != kNewRow) expected = rows[r] + 1;
  }
  return rows;
}

template <class Particle>
void write_particles(ByteWriter& out, const std::vector<Particle>& particles, TableCoder& coder,
                     std::vector<std::uint32_t> (*match)(const NumberTable&, const NumberTable&)) {
  NumberTable table{kParticleNumbers, {}};
  table.numbers.reserve(particles.size() * kParticleNumbers);
  for (const Particle& particle : particles) {
    const ParticleCode codes = encode(particle);
    table.numbers.insert(table.numbers.end(), codes.begin(), codes.end());
  }
  const std::vector<std::uint32_t> rows = match(table, coder.last());
  coder.write(out, std::move(table), rows);
}

template <class Particle>
std::vector<Particle> read_particles(ByteReader& in, const std::string& file, TableCoder& coder,
                                     Particle (*decode)(const ParticleCode&)) {
  std::vector<std::uint32_t> before;
  const NumberTable table = coder.read(in, file, before);
  std::vector<Particle> particles(table.rows());
  for (std::size_t r = 0; r < particles.size(); ++r) {
    ParticleCode codes;
    std::ranges::copy(table.row(r), codes.begin());
    particles[r] = decode(codes);
  }
  return particles;
}

/// Appends counts only, no times, so that equal runs give equal bytes.
void write_report(ByteWriter& out, const Frame& frame) {
  const FrameReport& report = frame.report;
  out.put(report.counts);
  out.put(report.mass_kg, report.kinetic_J, report.potential_J, report.plastic_J,
          report.momentum_residual);
  out.put(report.carried_over, report.limits_hit, report.aged, report.frozen, report.joints_lost);
  out.put(static_cast<std::uint32_t>(frame.breaks.size()));
  for (const BreakEvent& event : frame.breaks) {
    out.put(event.time_s, event.parent_key, event.point_W, event.energy_J, event.new_area_m2,
            event.pieces);
    out.put(event.material, event.previous_key, event.name);
    out.put_list(event.child_keys);
  }
}

void read_report(ByteReader& in, Frame& frame) {
  FrameReport& report = frame.report;
  in.take_to(report.counts, report.mass_kg, report.kinetic_J, report.potential_J, report.plastic_J,
             report.momentum_residual);
  in.take_to(report.carried_over, report.limits_hit, report.aged, report.frozen,
             report.joints_lost);
  frame.breaks.resize(in.take_count(60));
  for (BreakEvent& event : frame.breaks) {
    in.take_to(event.time_s, event.parent_key, event.point_W, event.energy_J, event.new_area_m2,
               event.pieces);
    in.take_to(event.material, event.previous_key, event.name);
    event.child_keys = in.take_list<std::uint64_t>();
  }
}

}  // namespace

std::int32_t short_hashes(const FrameBody& body) {
  std::uint32_t hashes = kByField;
  for (int f = 0; f < kHashedFields; ++f)
    hashes |= field_hash(static_cast<HashedField>(f), body) << (kBitsOfField * f);
  return static_cast<std::int32_t>(hashes);
}

bool has_hashes_of_fields(std::int32_t recorded) {
  return (static_cast<std::uint32_t>(recorded) & kByField) != 0;
}

bool differs(const FrameBody& body, std::int32_t recorded) {
  if (has_hashes_of_fields(recorded)) return short_hashes(body) != recorded;
  return (hash_body(body) & 0xff) != static_cast<std::uint32_t>(recorded);
}

bool differs(HashedField field, const FrameBody& body, std::int32_t recorded) {
  const std::uint32_t mask = (1u << kBitsOfField) - 1;
  const int shift = kBitsOfField * static_cast<int>(field);
  return field_hash(field, body) != (static_cast<std::uint32_t>(recorded) >> shift & mask);
}

FrameCoder::FrameCoder()
    : bodies_(kBodyColumns, kExtrapolatedBodyColumns),
      debris_(kParticleNumbers, kExtrapolatedParticleColumns),
      dust_(kParticleNumbers, kExtrapolatedParticleColumns) {}

void FrameCoder::reset() {
  bodies_.reset();
  debris_.reset();
  dust_.reset();
  keys_.clear();
  meshes_.clear();
}

void FrameCoder::write(ByteWriter& out, const Frame& frame) {
  out.put(frame.index, frame.time_s, hash_state(frame));
  out.put(static_cast<std::uint32_t>(frame.meshes->size()));
  put(out, frame.view);
  write_report(out, frame);
  const std::vector<std::uint32_t> before = match_keys(frame.bodies, keys_);
  NumberTable table{kBodyColumns, std::vector<std::int32_t>(frame.bodies.size() * kBodyColumns)};
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    encode(frame.bodies[b], table.numbers.data() + b * kBodyColumns);
  }
  bodies_.write(out, std::move(table), before);
  write_instances(out, frame, before);
  write_particles(out, frame.debris, debris_, match_debris);
  write_particles(out, frame.dust, dust_, match_dust);
}

/// Writes the meshes of those bodies that are new or whose meshes have changed.
void FrameCoder::write_instances(ByteWriter& out, const Frame& frame,
                                 const std::vector<std::uint32_t>& before) {
  std::vector<std::vector<std::uint32_t>> meshes(frame.bodies.size());
  for (const Instance& instance : frame.instances) {
    meshes[instance.body].push_back(instance.mesh.value);
  }
  const std::vector<std::uint32_t> none;
  std::vector<std::uint32_t> changed;
  for (std::uint32_t b = 0; b < meshes.size(); ++b) {
    if (meshes[b] != (before[b] == kNewRow ? none : meshes_[before[b]])) changed.push_back(b);
  }
  out.put(static_cast<std::uint32_t>(changed.size()));
  for (const std::uint32_t b : changed) {
    out.put(b);
    out.put_list(meshes[b]);
  }
  meshes_ = std::move(meshes);
  keys_.clear();
  for (const FrameBody& body : frame.bodies) keys_.push_back(body.key);
}

RecordedFrame FrameCoder::read(const std::vector<std::byte>& bytes, const std::string& file) {
  ByteReader in(bytes, file);
  RecordedFrame take;
  Frame& frame = take.frame;
  in.take_to(frame.index, frame.time_s, frame.recorded_hash, take.meshes);
  frame.view = take_view(in);
  read_report(in, frame);
  std::vector<std::uint32_t> before;
  const NumberTable table = bodies_.read(in, file, before);
  frame.bodies.resize(table.rows());
  take.body_hashes.resize(table.rows());
  for (std::size_t b = 0; b < table.rows(); ++b) {
    frame.bodies[b] = decode_body(table.row(b), take.body_hashes[b]);
  }
  read_instances(in, file, before, take);
  frame.debris = read_particles(in, file, debris_, decode_debris);
  frame.dust = read_particles(in, file, dust_, decode_dust);
  if (!in.at_end()) throw InputError(file + ": corrupt: unexpected bytes at the end");
  return take;
}

void FrameCoder::read_instances(ByteReader& in, const std::string& file,
                                const std::vector<std::uint32_t>& before, RecordedFrame& take) {
  std::vector<std::vector<std::uint32_t>> meshes(before.size());
  for (std::size_t b = 0; b < before.size(); ++b) {
    if (before[b] != kNewRow) meshes[b] = meshes_[before[b]];
  }
  const std::uint32_t changed = in.take_count(8);
  for (std::uint32_t i = 0; i < changed; ++i) {
    const auto b = in.take<std::uint32_t>();
    if (b >= meshes.size()) throw InputError(file + ": corrupt: meshes have an invalid body");
    meshes[b] = in.take_list<std::uint32_t>();
    for (const std::uint32_t mesh : meshes[b]) {
      if (mesh >= take.meshes) throw InputError(file + ": corrupt: a body has an invalid mesh");
    }
  }
  for (std::size_t b = 0; b < meshes.size(); ++b) {
    if (take.frame.instances.size() + meshes[b].size() > kMaxInstances) {
      throw InputError(file + ": corrupt: a frame has too many instances");
    }
    for (const std::uint32_t mesh : meshes[b]) {
      take.frame.instances.push_back({MeshIndex(mesh), static_cast<std::uint32_t>(b)});
    }
  }
  meshes_ = std::move(meshes);
}

}  // namespace sunder
