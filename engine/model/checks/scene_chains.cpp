#include "engine/model/checks/scene_chains.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>

#include "engine/model/checks/scene_accuracy.h"

namespace sunder {
namespace {

// tension over weight at the lowest point of a pendulum released from the horizontal
constexpr double kSwingLoad = 3;
// Largest stable h²·K/I, as measured: for rotational joints, which are damped, and for rods and
// ropes, whose ends are not.
constexpr double kMaxRotational = 200, kMaxRods = 1;

/// A body that may hang.
struct Body {
  std::string name;
  double mass_kg = 0;
  double inertia_kg_m2 = 0;  ///< Median of the moments about the axes; a ball has only one.
  Vec3 center_W = Vec3::Zero();
  bool moves = true;
};

Body body_of(const Solid& solid, const Scene& scene) {
  const CompoundMass weight = mass_of(solid.compound, scene.materials);
  const Vec3 diagonal = weight.inertia_R.diagonal();
  // The moment of inertia about a rod's own axis does not matter: forces at its end turn it across.
  const double across = diagonal.sum() - diagonal.minCoeff() - diagonal.maxCoeff();
  return {solid.name, weight.mass_kg, across, solid.X_WR * weight.com_R,
          !solid.compound.is_anchored()};
}

Body body_of(const Ball& ball, const Scene& scene) {
  const double mass = ball_mass_kg(ball, scene.materials);
  return {ball.name, mass, 0.4 * mass * ball.radius_m * ball.radius_m, ball.center_W};
}

/// Returns h²·K/I at h = 1 s over its stable limit, for a link under tension `pull_N` whose joint
/// is at `end_W`.
double substep_need(const Joint& joint, const Vec3& end_W, const Body& link, double pull_N) {
  if (joint.kind == JointKind::kFixed) return 0;
  const double turns = 2 * pull_N * (end_W - link.center_W).norm() / link.inertia_kg_m2;
  if (joint.kind == JointKind::kDistance || joint.kind == JointKind::kRope) {
    const double length_m = (joint.to_W - joint.at_W).norm();
    return std::max(turns, 4 * pull_N / (link.mass_kg * length_m)) / kMaxRods;
  }
  return turns / kMaxRotational;
}

/// Finds chains in a graph of bodies and joints.
class ChainFinder {
 public:
  ChainFinder(const Scene& scene, std::vector<Body> bodies, std::span<const Joint> joints)
      : g_(scene.gravity_W.norm()),
        dt_s_(scene.accuracy.dt_s),
        bodies_(std::move(bodies)),
        joints_(joints),
        seen_(bodies_.size(), 0) {}

  /// Appends one chain for each joint to a static body.
  void find(std::vector<ChainLink>& chains) {
    for (const Joint& joint : joints_) {
      const bool fixed_a = fixed(joint.a), fixed_b = fixed(joint.b);
      if (fixed_a == fixed_b) continue;
      const std::uint32_t top = fixed_a ? *joint.b : *joint.a;
      if (seen_[top]) continue;
      worst_ = {};
      worst_need_ = 0;
      find_worst_link(top, joint);
      if (worst_need_ == 0) continue;
      worst_.substeps = std::max(1, static_cast<int>(std::ceil(dt_s_ * std::sqrt(worst_need_))));
      chains.push_back(worst_);
    }
  }

 private:
  bool fixed(const std::optional<std::uint32_t>& end) const { return !end || !bodies_[*end].moves; }

  /// Finds the worst link among all bodies that hang by `joint`, in an order from `top` down.
  void find_worst_link(std::uint32_t top, const Joint& joint) {
    std::vector<std::pair<std::uint32_t, const Joint*>> order = {{top, &joint}};
    std::vector<std::size_t> above = {0};
    seen_[top] = 1;
    for (std::size_t at = 0; at < order.size(); ++at) {
      for (const Joint& next : joints_) {
        if (!next.a || !next.b || (*next.a != order[at].first && *next.b != order[at].first))
          continue;
        const std::uint32_t other = *next.a == order[at].first ? *next.b : *next.a;
        if (seen_[other] || !bodies_[other].moves) continue;
        seen_[other] = 1;
        order.emplace_back(other, &next);
        above.push_back(at);
      }
    }
    std::vector<double> load_kg(order.size(), 0);
    for (std::size_t at = order.size(); at-- > 0;) {
      const Body& link = bodies_[order[at].first];
      load_kg[at] += link.mass_kg;
      if (at > 0) load_kg[above[at]] += load_kg[at];
      // A link with nothing below it only swings; no load amplifies its motion.
      if (load_kg[at] == link.mass_kg) continue;
      const Joint& by = *order[at].second;
      const bool rod = by.kind == JointKind::kDistance || by.kind == JointKind::kRope;
      const Vec3& end_W = rod && by.a != order[at].first ? by.to_W : by.at_W;
      const double need_1_s2 = substep_need(by, end_W, link, kSwingLoad * g_ * load_kg[at]);
      if (need_1_s2 <= worst_need_) continue;
      worst_need_ = need_1_s2;
      worst_ = {link.name, load_kg[at] / link.mass_kg, 1};
    }
  }

  double g_, dt_s_;
  std::vector<Body> bodies_;
  std::span<const Joint> joints_;
  std::vector<std::uint8_t> seen_;
  ChainLink worst_;
  double worst_need_ = 0;
};

/// Appends the chain of a wrecking ball, with the joints it will have.
void find_chain(const Scene& scene, const Shot& shot, std::vector<ChainLink>& chains) {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  const Vec3 from = *shot.hangs_from_W, offset = shot.ball.center_W - from;
  const Vec3 pitch =
      (offset - shot.ball.radius_m * offset.normalized()) / static_cast<double>(shot.links.size());
  for (std::uint32_t i = 0; i <= shot.links.size(); ++i) {
    bodies.push_back(i < shot.links.size() ? body_of(shot.links[i], scene)
                                           : body_of(shot.ball, scene));
    Joint& joint = joints.emplace_back();
    if (i > 0) joint.a = i - 1;
    joint.b = i;
    joint.at_W = from + i * pitch;
  }
  ChainFinder(scene, std::move(bodies), joints).find(chains);
}

}  // namespace

std::vector<ChainLink> find_chains(const Scene& scene) {
  std::vector<ChainLink> chains;
  if (scene.gravity_W.isZero()) return chains;
  std::vector<Body> bodies;
  if (!scene.joints.empty()) {
    for (const Solid& solid : scene.solids) bodies.push_back(body_of(solid, scene));
    for (const Ball& ball : scene.balls) bodies.push_back(body_of(ball, scene));
    ChainFinder(scene, std::move(bodies), scene.joints).find(chains);
  }
  for (const Shot& shot : scene.shots)
    if (shot.hangs_from_W && !shot.links.empty()) find_chain(scene, shot, chains);
  return chains;
}

std::vector<std::string> chain_warnings(const Scene& scene, int max_substeps) {
  std::vector<std::string> warnings;
  for (const ChainLink& link : find_chains(scene)) {
    if (link.substeps <= scene.accuracy.substeps) continue;
    const Accuracy hold = divide_step(scene.accuracy, link.substeps, max_substeps);
    char text[400];
    std::snprintf(
        text, sizeof text,
        "the chain of '%s', which bears %.4g times its own weight, may tear: %d substeps "
        "of dt 1/%.4g s would hold it, there are %d of 1/%.4g s; set accuracy.substeps%s, "
        "or make the links heavier",
        link.name.c_str(), link.load, hold.substeps, 1 / hold.dt_s, scene.accuracy.substeps,
        1 / scene.accuracy.dt_s, hold.dt_s < scene.accuracy.dt_s ? " and accuracy.dt_s" : "");
    warnings.emplace_back(text);
  }
  return warnings;
}

}  // namespace sunder
