#include "solver/rigid/contact/contact_reports.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

using Keyed = std::pair<std::uint64_t, const Manifold*>;

/// Returns the manifolds for which `fits` is true, in order of their pairs' keys.
template <class Fits>
std::vector<Keyed> by_key(const Contacts& contacts, const Fits& fits) {
  constexpr std::size_t kChunk = 4096;
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Keyed>& found) {
    for (std::size_t i = begin; i < end; ++i) {
      const Manifold& m = contacts.manifolds[ManifoldSlot(i)];
      if (m.count > 0 && fits(m)) found.emplace_back(contacts.pairs[m.pair].key(), &m);
    }
  };
  auto all = collect_chunks<Keyed>(contacts.manifolds.size(), kChunk, find);
  std::ranges::sort(all, {}, &Keyed::first);
  return all;
}

}  // namespace

std::vector<ContactImpulse> find_contact_impulses(const Contacts& contacts, const Bodies& bodies,
                                                  const Shapes& shapes) {
  const auto is_reported = [&](const Manifold& m) {
    return bodies.reports_load[m.body_a] || bodies.reports_load[m.body_b];
  };
  std::vector<ContactImpulse> loads;
  for (const auto& [key, manifold] : by_key(contacts, is_reported)) {
    const Manifold& m = *manifold;
    const Pair& pair = contacts.pairs[m.pair];
    const Vec3 impulse = m.step_impulse_W.cast<double>();
    if (impulse.isZero(0)) continue;
    const Vec3 point = bodies.position[m.body_a] + m.center_of_load().cast<double>();
    for (const bool on_b : {false, true}) {
      const BodySlot body = on_b ? m.body_b : m.body_a;
      if (!bodies.reports_load[body]) continue;
      const Shape& shape = shapes[on_b ? pair.shape_b : pair.shape_a];
      loads.push_back({bodies.tag[body], shape.tag, on_b ? impulse : Vec3(-impulse), point});
    }
  }
  return loads;
}

std::vector<ContactForce> find_contact_forces(const Contacts& contacts, const Bodies& bodies,
                                              double h_s) {
  std::vector<ContactForce> contact_forces;
  if (!(h_s > 0)) return contact_forces;
  const auto is_pressed = [](const Manifold& m) { return m.normal_impulse() > 0; };
  for (const auto& [key, manifold] : by_key(contacts, is_pressed)) {
    const Manifold& m = *manifold;
    // Friction acts at the mean of the points: each point has a share of it.
    const Vec3 force_W = m.impulse_W().cast<double>() / (h_s * double{m.normal_impulse()});
    for (std::size_t i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[i];
      if (!(p.impulse_Ns > 0)) continue;
      const Vec3 arm_W = bodies.rotation[m.body_a] * p.anchor_A.cast<double>();
      contact_forces.push_back({bodies.tag[m.body_a], bodies.tag[m.body_b],
                                bodies.position[m.body_a] + arm_W, double{p.impulse_Ns} * force_W});
    }
  }
  return contact_forces;
}

std::vector<float> find_penetrations(const Contacts& contacts) {
  std::vector<float> depths;
  for (const Manifold& m : contacts.manifolds)
    for (std::size_t i = 0; i < m.count; ++i)
      if (m.points[i].impulse_Ns > 0) depths.push_back(std::max(0.f, -m.points[i].separation_m));
  return depths;
}

}  // namespace sunder::solver
