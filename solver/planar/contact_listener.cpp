#include "solver/planar/contact_listener.h"

#include <algorithm>

namespace sunder::solver {
namespace {

ContactListener::Pair pair_of(const b2Contact& contact) {
  return std::minmax(shape_of(contact.GetFixtureA()), shape_of(contact.GetFixtureB()));
}

}  // namespace

bool ContactListener::are_asleep(const PairImpulse& p) const {
  const auto still = [&](std::uint32_t slot) {
    return !bodies_[slot].dynamic() || !bodies_[slot].body->IsAwake();
  };
  return still(p.body_a) && still(p.body_b);
}

void ContactListener::begin(float scale) {
  impulse_from_static.SetZero();
  std::erase_if(pair_impulses,
                [&](const auto& entry) { return entry.second.ended || !are_asleep(entry.second); });
  for (auto& [pair, p] : pair_impulses) {
    p.steps = -1;  // marks sums of earlier solves
    p.impulse *= scale, p.moment *= scale, p.weight *= scale;
  }
}

void ContactListener::end(int steps) {
  for (auto& [pair, p] : pair_impulses) {
    if (p.steps <= 0 || !are_asleep(p)) continue;
    const float scale = static_cast<float>(steps) / static_cast<float>(p.steps);
    p.impulse *= scale, p.moment *= scale, p.weight *= scale;
  }
}

void ContactListener::EndContact(b2Contact* contact) {
  if (const auto found = pair_impulses.find(pair_of(*contact)); found != pair_impulses.end())
    found->second.ended = true;
}

void ContactListener::PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) {
  b2WorldManifold manifold;
  contact->GetWorldManifold(&manifold);
  const b2Vec2 tangent = b2Cross(manifold.normal, 1.f);
  b2Vec2 sum(0, 0), moment(0, 0);
  float weight = 0;
  for (int i = 0; i < impulse->count; ++i) {
    sum += impulse->normalImpulses[i] * manifold.normal + impulse->tangentImpulses[i] * tangent;
    moment += impulse->normalImpulses[i] * manifold.points[i];
    weight += impulse->normalImpulses[i];
  }
  const b2Fixture *first = contact->GetFixtureA(), *second = contact->GetFixtureB();
  if (shape_of(first) > shape_of(second)) {
    std::swap(first, second);
    sum = -sum;
  }
  const std::uint32_t a = body_of(first->GetBody()), b = body_of(second->GetBody());
  for (const std::uint32_t slot : {a, b}) {
    if (bodies_[slot].dynamic())
      bodies_[slot].last_velocity = bodies_[slot].body->GetLinearVelocity();
  }
  if (!bodies_[a].dynamic()) impulse_from_static += sum;
  if (!bodies_[b].dynamic()) impulse_from_static -= sum;
  if (!bodies_[a].reports_load && !bodies_[b].reports_load) return;
  PairImpulse& p = pair_impulses[{shape_of(first), shape_of(second)}];
  if (p.steps < 0) p = PairImpulse();  // the pair woke up: its old sum is dropped
  p.body_a = a, p.body_b = b;
  p.impulse += sum, p.moment += moment, p.weight += weight;
  ++p.steps;
  p.ended = false;
}

}  // namespace sunder::solver
