#include "scenes/trade/facts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/statistics.h"

namespace sunder::scenes {
namespace {

constexpr double kInPlaceDistance = 0.1;       // relative to the body's size
constexpr double kMinStrikerSpeed_m_s = 5;     // least speed of a striker
constexpr double kImpactSpeedLoss = 0.1;       // relative loss of speed in a frame
constexpr int kExitFrames = 12;                // from the impact to the exit speed
constexpr std::uint64_t kMotionInterval = 30;  // frames between samples of motion

using Bodies = std::vector<FrameBody>;

/// Returns the body with that key; null if there is none.
const FrameBody* find(const Bodies& bodies, std::uint64_t key) {
  const auto at = std::ranges::lower_bound(bodies, key, {}, &FrameBody::key);
  return at != bodies.end() && at->key == key ? &*at : nullptr;
}

/// Size and visible surface of a body.
struct BodySize {
  double size_m = 0;      ///< Distance from the centre to the farthest corner.
  double surface_m2 = 0;  ///< Without fracture surfaces.
};

void add(const FrameBody& body, const Mesh& mesh, BodySize& size) {
  const auto place_R = [&](const Mesh::Vertex& vertex) -> Vec3 {
    return mesh.X_RT * Vec3(mesh.origin_T + vertex.position.cast<double>());
  };
  for (const Mesh::Vertex& vertex : mesh.vertices)
    size.size_m = std::max(size.size_m, (place_R(vertex) - body.com_R).norm());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Mesh::Vertex& a = mesh.vertices[mesh.indices[i]];
    if (a.look == Mesh::kInterior) continue;
    const Vec3f ab = mesh.vertices[mesh.indices[i + 1]].position - a.position;
    const Vec3f ac = mesh.vertices[mesh.indices[i + 2]].position - a.position;
    size.surface_m2 += 0.5 * double{ab.cross(ac).norm()};
  }
}

std::vector<BodySize> body_sizes(const Frame& frame) {
  std::vector<BodySize> all(frame.bodies.size());
  for (const Instance& instance : frame.instances)
    add(frame.bodies[instance.body], *(*frame.meshes)[instance.mesh.value], all[instance.body]);
  return all;
}

double mechanical_J(const FrameReport& report) {
  return report.kinetic_J + report.potential_J + report.plastic_J;
}

/// A projectile.
struct Striker {
  std::uint64_t key = 0;
  double speed_m_s = 0;
  int frames_left = -1;  ///< Frames until the exit speed is taken; -1 before the impact.
};

void update_striker(const Bodies& bodies, Striker& striker) {
  if (striker.frames_left == 0) return;
  const FrameBody* body = find(bodies, striker.key);
  if (!body) return;
  const double speed_m_s = body->velocity_W.norm();
  if (striker.frames_left > 0) {
    --striker.frames_left;
  } else if (speed_m_s < (1 - kImpactSpeedLoss) * striker.speed_m_s) {
    striker.frames_left = kExitFrames;
  }
  striker.speed_m_s = speed_m_s;
}

}  // namespace

struct FactsSink::Collector {
  FramePtr first, last;
  std::vector<float> penetrations_m;  ///< Penetrations of all frames.
  std::vector<double> energy_J;       ///< Mechanical energy by frame.
  double gained_J = 0;
  double residual = 0;
  std::vector<double> speeds_m_s, spins_rad_s;
  std::vector<Striker> strikers;
  StateHash hash;

  bool is_striker(std::uint64_t key) const {
    return std::ranges::find(strikers, key, &Striker::key) != strikers.end();
  }
  void find_strikers(const Frame& frame);
  void sample_motion(const Frame& frame);
  void sample_energy(const Frame& frame);
  void measure_end_state(Facts& facts) const;
};

void FactsSink::Collector::find_strikers(const Frame& frame) {
  for (Striker& striker : strikers) update_striker(frame.bodies, striker);
  if (!frame.breaks.empty()) return;
  for (const FrameBody& body : frame.bodies) {
    const double speed_m_s = body.velocity_W.norm();
    if (!body.is_static && speed_m_s > kMinStrikerSpeed_m_s &&
        (!last || !find(last->bodies, body.key)))
      strikers.push_back({body.key, speed_m_s});
  }
}

void FactsSink::Collector::sample_motion(const Frame& frame) {
  if (frame.index == 0 || frame.index % kMotionInterval != 0) return;
  for (const FrameBody& body : frame.bodies) {
    if (body.is_static) continue;
    speeds_m_s.push_back(body.velocity_W.norm());
    spins_rad_s.push_back(body.angular_velocity_W.norm());
  }
}

void FactsSink::Collector::sample_energy(const Frame& frame) {
  const double now_J = mechanical_J(frame.report);
  const auto same = [](const FrameBody& a, const FrameBody& b) {
    return a.key == b.key && a.is_static == b.is_static;
  };
  if (last && frame.breaks.empty() && std::ranges::equal(frame.bodies, last->bodies, same))
    gained_J += std::max(0.0, now_J - energy_J.back());
  energy_J.push_back(now_J);
  residual = std::max(residual, frame.report.momentum_residual);
}

/// Measures standing bodies, pieces and run-out at the end.
void FactsSink::Collector::measure_end_state(Facts& facts) const {
  const std::vector<BodySize> before = body_sizes(*first), now = body_sizes(*last);
  Vec3 middle = Vec3::Zero();
  double count = 0, all_m2 = 0, standing_m2 = 0, pieces = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (is_striker(first->bodies[i].key)) continue;
    middle += first->bodies[i].X_WB.position;
    ++count;
    all_m2 += before[i].surface_m2;
  }
  if (count > 0) middle /= count;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const FrameBody& body = last->bodies[i];
    if (is_striker(body.key)) continue;
    if (const FrameBody* then = find(first->bodies, body.key)) {
      const Vec3 from = then->X_WB * Vec3(body.com_R - then->com_R);
      const double distance_m = (body.X_WB.position - from).norm();
      if (distance_m <=
          kInPlaceDistance * before[static_cast<std::size_t>(then - first->bodies.data())].size_m) {
        standing_m2 += now[i].surface_m2;
        if (!body.is_static) facts.samples["drift m"].push_back(distance_m);
        continue;
      }
    } else {
      ++pieces;
      facts.samples["size of pieces m"].push_back(now[i].size_m);
    }
    const Vec3 offset = body.X_WB.position - middle;
    facts.samples["run-out m"].push_back(std::hypot(offset.x(), offset.z()));
  }
  facts.samples["pieces"] = {pieces};
  if (all_m2 > 0) facts.samples["surface in place share"] = {standing_m2 / all_m2};
  if (const auto drift = facts.samples.find("drift m"); drift != facts.samples.end())
    facts.samples["drift largest m"] = {std::ranges::max(drift->second)};
}

FactsSink::FactsSink() : collector_(std::make_unique<Collector>()) {}
FactsSink::~FactsSink() = default;

void FactsSink::take(const FramePtr& frame) {
  Collector& collector = *collector_;
  collector.hash.take(frame);
  collector.find_strikers(*frame);
  collector.sample_motion(*frame);
  collector.sample_energy(*frame);
  const std::vector<float>& depths = frame->report.penetrations_m;
  collector.penetrations_m.insert(collector.penetrations_m.end(), depths.begin(), depths.end());
  if (!collector.first) collector.first = frame;
  collector.last = frame;
}

Facts FactsSink::facts() const {
  const Collector& collector = *collector_;
  Facts facts;
  facts.state_hash = collector.hash.hex();
  if (!collector.first) return facts;
  auto& samples = facts.samples;
  const std::vector<double> depths(collector.penetrations_m.begin(),
                                   collector.penetrations_m.end());
  samples["penetration p99 m"] = {quantile(depths, 0.99)};
  samples["penetration worst m"] = {quantile(depths, 1)};
  const double mass_kg = collector.first->report.mass_kg;
  if (mass_kg > 0) {
    const std::size_t end = collector.energy_J.size() - 1;
    samples["energy after 1/4 J/kg"] = {collector.energy_J[end / 4] / mass_kg};
    samples["energy after 1/2 J/kg"] = {collector.energy_J[end / 2] / mass_kg};
    samples["energy after 1 J/kg"] = {collector.energy_J[end] / mass_kg};
    samples["energy gained J/kg"] = {collector.gained_J / mass_kg};
  }
  samples["momentum residual share"] = {collector.residual};
  if (!collector.speeds_m_s.empty()) {
    samples["speed m/s"] = collector.speeds_m_s;
    samples["spin rad/s"] = collector.spins_rad_s;
  }
  for (const Striker& striker : collector.strikers)
    samples["exit speed m/s"].push_back(striker.speed_m_s);
  collector.measure_end_state(facts);
  return facts;
}

}  // namespace sunder::scenes
