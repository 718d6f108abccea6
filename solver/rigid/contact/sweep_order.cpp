#include "solver/rigid/contact/sweep_order.h"

#include <algorithm>
#include <utility>

#include "solver/rigid/collide/approach.h"

namespace sunder::solver {
namespace {

constexpr double kHeavy = 4;    // times the mass of what it strikes
constexpr double kFast = 0.25;  // in a step, of the inner radius of the smaller shape,
constexpr double kFalls = 4;    // and in what falls from rest within the step

/// Whether something heavy strikes something light.
bool strikes(const StepContext& step, const Manifold& m, const Bodies& bodies) {
  const BodySlot a = m.body_a, b = m.body_b;
  if (!bodies.dynamic(a) || !bodies.dynamic(b)) return false;
  const auto [light_kg, heavy_kg] = std::minmax(bodies.mass_kg[a], bodies.mass_kg[b]);
  if (heavy_kg < kHeavy * light_kg) return false;
  const double least_m = std::max(kFast * double{m.size_m}, kFalls * double{step.fall_m});
  const auto is_struck = [&](const ManifoldPoint& p) {
    const double way_m = step.dt_s * closing_speed(m, bodies, p.arm_A, p.arm_B);
    return way_m > least_m && way_m > double{p.separation_m};
  };
  return std::any_of(m.points.begin(), m.points.begin() + m.count, is_struck);
}

}  // namespace

void SweepOrder::collect(const StepContext& step, const Bodies& bodies, const Contacts& contacts) {
  start_.assign(kSweepKeys + 1, 0);
  striker_.clear();
  in_contact_.assign(bodies.size(), 0);
  loaded_contacts_.assign(bodies.size(), 0);
  points_ = 0;
  bouncy_ = false;
  deep_contacts_.clear();
  auto for_each = [&](const auto& visit) {
    for (const ManifoldSlot i : contacts.manifolds.slots()) {
      const Manifold& m = contacts.manifolds[i];
      if (m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b))) visit(i, m);
    }
  };
  for_each([&](ManifoldSlot, const Manifold& m) {
    ++start_[m.sweep_key() + 1];
    in_contact_[m.body_a] = in_contact_[m.body_b] = 1;
    if (m.normal_impulse() > 0)
      for (const BodySlot body : {m.body_a, m.body_b})
        loaded_contacts_[body] = std::min<std::uint8_t>(loaded_contacts_[body] + 1, kPinched);
    points_ += m.count;
    bouncy_ = bouncy_ || m.restitution > 0;
    if (strikes(step, m, bodies)) {
      const bool a_strikes = bodies.mass_kg[m.body_a] > bodies.mass_kg[m.body_b];
      striker_.resize(bodies.size());
      striker_[a_strikes ? m.body_b : m.body_a] = a_strikes ? m.body_a : m.body_b;
    }
    if (!m.deep) return;
    deep_contacts_.resize(bodies.size());
    ++deep_contacts_[m.body_a], ++deep_contacts_[m.body_b];
  });
  for (std::size_t k = 0; k < kSweepKeys; ++k) start_[k + 1] += start_[k];
  manifolds_.resize(start_[kSweepKeys]);
  std::vector<std::uint32_t> next = start_;
  for_each([&](ManifoldSlot i, const Manifold& m) { manifolds_[next[m.sweep_key()]++] = i; });
  blow_ = contacts.colors == kMaxColors && is_passed_on(contacts);  // else split by choice
  if (blow_) color_rest(bodies, contacts);
}

/// Whether something that is struck touches something else.
bool SweepOrder::is_passed_on(const Contacts& contacts) const {
  if (striker_.empty()) return false;
  const auto passes_on = [&](BodySlot a, BodySlot b) {
    return !striker_[a].none() && striker_[a] != b;
  };
  return std::ranges::any_of(manifolds_, [&](ManifoldSlot i) {
    const Manifold& m = contacts.manifolds[i];
    return passes_on(m.body_a, m.body_b) || passes_on(m.body_b, m.body_a);
  });
}

/// Gives those without a colour more of them: what is split takes a blow up slowly.
void SweepOrder::color_rest(const Bodies& bodies, const Contacts& contacts) {
  const std::uint32_t first = begin(kMaxColors, 4);
  std::vector<ManifoldSlot> rest(manifolds_.begin() + first, manifolds_.end()), later;
  manifolds_.resize(first);
  start_.resize(kMaxColors * 4 + 1);
  ByBody<std::uint32_t> last_color(bodies.size());
  for (std::uint32_t color = kMaxColors; !rest.empty(); ++color) {
    const auto takes = [&](BodySlot body) {
      return bodies.awake(body) && last_color[body] == color;
    };
    later.clear();
    for (std::uint32_t points = 4; points > 0; --points) {
      for (const ManifoldSlot i : rest) {
        const Manifold& m = contacts.manifolds[i];
        if (m.count != points) continue;
        const bool taken = takes(m.body_a) || takes(m.body_b);
        if (!taken) last_color[m.body_a] = last_color[m.body_b] = color;
        (taken ? later : manifolds_).push_back(i);
      }
      start_.push_back(static_cast<std::uint32_t>(manifolds_.size()));
    }
    rest.swap(later);
  }
}

}  // namespace sunder::solver
