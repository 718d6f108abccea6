#include "bench/trade/facts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/statistics.h"

namespace sunder::bench {
namespace {

constexpr double kInPlace = 0.1;        // of a body's size
constexpr double kStrikes_m_s = 5;      // faster: a striker
constexpr double kStruck = 0.1;         // of its speed, lost in a frame
constexpr int kOutFrames = 12;          // from then on until it is out
constexpr std::uint64_t kMoments = 30;  // frames from one look at motion to the next

using Bodies = std::vector<FrameBody>;

/// The body of that key; null if there is none.
const FrameBody* find(const Bodies& bodies, std::uint64_t key) {
  const auto at = std::ranges::lower_bound(bodies, key, {}, &FrameBody::key);
  return at != bodies.end() && at->key == key ? &*at : nullptr;
}

/// How a body looks.
struct Look {
  double size_m = 0;      ///< From its centre to its farthest corner.
  double surface_m2 = 0;  ///< Without what breaks made.
};

void add(const FrameBody& body, const Mesh& mesh, Look& look) {
  const auto place_R = [&](const Mesh::Vertex& vertex) -> Vec3 {
    return mesh.X_RT * Vec3(mesh.origin_T + vertex.position.cast<double>());
  };
  for (const Mesh::Vertex& vertex : mesh.vertices)
    look.size_m = std::max(look.size_m, (place_R(vertex) - body.com_R).norm());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Mesh::Vertex& a = mesh.vertices[mesh.indices[i]];
    if (a.look == Mesh::kInterior) continue;
    const Vec3f ab = mesh.vertices[mesh.indices[i + 1]].position - a.position;
    const Vec3f ac = mesh.vertices[mesh.indices[i + 2]].position - a.position;
    look.surface_m2 += 0.5 * double{ab.cross(ac).norm()};
  }
}

std::vector<Look> looks(const Frame& frame) {
  std::vector<Look> all(frame.bodies.size());
  for (const Instance& instance : frame.instances)
    add(frame.bodies[instance.body], *(*frame.meshes)[instance.mesh.value], all[instance.body]);
  return all;
}

double mechanical_J(const FrameReport& report) {
  return report.kinetic_J + report.potential_J + report.plastic_J;
}

/// Something shot at the others.
struct Striker {
  std::uint64_t key = 0;
  double speed_m_s = 0;
  int frames_left = -1;  ///< Until it is out; -1: not struck yet.
};

void follow(const Bodies& bodies, Striker& striker) {
  if (striker.frames_left == 0) return;
  const FrameBody* body = find(bodies, striker.key);
  if (!body) return;
  const double speed_m_s = body->velocity_W.norm();
  if (striker.frames_left > 0) {
    --striker.frames_left;
  } else if (speed_m_s < (1 - kStruck) * striker.speed_m_s) {
    striker.frames_left = kOutFrames;
  }
  striker.speed_m_s = speed_m_s;
}

}  // namespace

struct FactsSink::Watch {
  FramePtr first, last;
  std::vector<float> penetrations_m;  ///< Of all frames.
  std::vector<double> energy_J;       ///< By frame.
  double gained_J = 0;
  double residual = 0;
  std::vector<double> speeds_m_s, spins_rad_s;
  std::vector<Striker> strikers;
  StateHash hash;

  bool is_striker(std::uint64_t key) const {
    return std::ranges::find(strikers, key, &Striker::key) != strikers.end();
  }
  void find_strikers(const Frame& frame);
  void look_at_motion(const Frame& frame);
  void look_at_energy(const Frame& frame);
  void find_what_stands(Facts& facts) const;
};

void FactsSink::Watch::find_strikers(const Frame& frame) {
  for (Striker& striker : strikers) follow(frame.bodies, striker);
  if (!frame.breaks.empty()) return;
  for (const FrameBody& body : frame.bodies) {
    const double speed_m_s = body.velocity_W.norm();
    if (!body.is_static && speed_m_s > kStrikes_m_s && (!last || !find(last->bodies, body.key)))
      strikers.push_back({body.key, speed_m_s});
  }
}

void FactsSink::Watch::look_at_motion(const Frame& frame) {
  if (frame.index == 0 || frame.index % kMoments != 0) return;
  for (const FrameBody& body : frame.bodies) {
    if (body.is_static) continue;
    speeds_m_s.push_back(body.velocity_W.norm());
    spins_rad_s.push_back(body.angular_velocity_W.norm());
  }
}

void FactsSink::Watch::look_at_energy(const Frame& frame) {
  const double now_J = mechanical_J(frame.report);
  const auto same = [](const FrameBody& a, const FrameBody& b) {
    return a.key == b.key && a.is_static == b.is_static;
  };
  if (last && frame.breaks.empty() && std::ranges::equal(frame.bodies, last->bodies, same))
    gained_J += std::max(0.0, now_J - energy_J.back());
  energy_J.push_back(now_J);
  residual = std::max(residual, frame.report.momentum_residual);
}

/// What stands, and what lies about.
void FactsSink::Watch::find_what_stands(Facts& facts) const {
  const std::vector<Look> before = looks(*first), now = looks(*last);
  Vec3 middle = Vec3::Zero();
  double count = 0, all_m2 = 0, stands_m2 = 0, pieces = 0;
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
      const double way_m = (body.X_WB.position - from).norm();
      if (way_m <=
          kInPlace * before[static_cast<std::size_t>(then - first->bodies.data())].size_m) {
        stands_m2 += now[i].surface_m2;
        if (!body.is_static) facts.samples["drift m"].push_back(way_m);
        continue;
      }
    } else {
      ++pieces;
      facts.samples["size of pieces m"].push_back(now[i].size_m);
    }
    const Vec3 way = body.X_WB.position - middle;
    facts.samples["run-out m"].push_back(std::hypot(way.x(), way.z()));
  }
  facts.samples["pieces"] = {pieces};
  if (all_m2 > 0) facts.samples["surface in place share"] = {stands_m2 / all_m2};
  if (const auto drift = facts.samples.find("drift m"); drift != facts.samples.end())
    facts.samples["drift largest m"] = {std::ranges::max(drift->second)};
}

FactsSink::FactsSink() : watch_(std::make_unique<Watch>()) {}
FactsSink::~FactsSink() = default;

void FactsSink::take(const FramePtr& frame) {
  Watch& watch = *watch_;
  watch.hash.take(frame);
  watch.find_strikers(*frame);
  watch.look_at_motion(*frame);
  watch.look_at_energy(*frame);
  const std::vector<float>& depths = frame->report.penetrations_m;
  watch.penetrations_m.insert(watch.penetrations_m.end(), depths.begin(), depths.end());
  if (!watch.first) watch.first = frame;
  watch.last = frame;
}

Facts FactsSink::facts() const {
  const Watch& watch = *watch_;
  Facts facts;
  facts.state_hash = watch.hash.hex();
  if (!watch.first) return facts;
  auto& samples = facts.samples;
  const std::vector<double> depths(watch.penetrations_m.begin(), watch.penetrations_m.end());
  samples["penetration p99 m"] = {quantile(depths, 0.99)};
  samples["penetration worst m"] = {quantile(depths, 1)};
  const double mass_kg = watch.first->report.mass_kg;
  if (mass_kg > 0) {
    const std::size_t end = watch.energy_J.size() - 1;
    samples["energy after 1/4 J/kg"] = {watch.energy_J[end / 4] / mass_kg};
    samples["energy after 1/2 J/kg"] = {watch.energy_J[end / 2] / mass_kg};
    samples["energy after 1 J/kg"] = {watch.energy_J[end] / mass_kg};
    samples["energy gained J/kg"] = {watch.gained_J / mass_kg};
  }
  samples["momentum residual share"] = {watch.residual};
  if (!watch.speeds_m_s.empty()) {
    samples["speed m/s"] = watch.speeds_m_s;
    samples["spin rad/s"] = watch.spins_rad_s;
  }
  for (const Striker& striker : watch.strikers)
    samples["exit speed m/s"].push_back(striker.speed_m_s);
  watch.find_what_stands(facts);
  return facts;
}

}  // namespace sunder::bench
