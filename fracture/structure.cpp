#include "fracture/structure.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "fracture/adjacency.h"
#include "fracture/overlap.h"
#include "fracture/polygon.h"

namespace sunder::fracture {
namespace {

double distance_to_box(const Vec3& point, const Box& box) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).norm();
}

template <class T>
std::size_t bytes(const std::vector<T>& vector) {
  return vector.capacity() * sizeof(T);
}

}  // namespace

bool ImpactSphere::is_endless() const {
  return radius_m == std::numeric_limits<double>::infinity();
}

bool ImpactSphere::touches(const Convex& convex) const {
  if (is_endless()) return true;
  return distance_to_box(center_R, convex.box) <= radius_m &&
         distance(center_R, convex.polyhedron) <= radius_m;
}

Structure::Structure(const Compound& compound) {
  slots_.resize(compound.convexes.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i] = {compound.convexes[i], compound.anchored[i], {}, {}};
  }
  size_ = slot_count();
  for (const Bond& bond : compound.bonds) link(bond);
  for (const Ghost& ghost : compound.ghosts) add_ghost(ghost);
  std::vector<std::uint32_t> all(slots_.size());
  std::iota(all.begin(), all.end(), 0u);
  add_level(std::move(all));
}

void Structure::link(const Bond& bond) {
  slots_[bond.a].links.push_back({bond.b, bond.face_a, bond.face_b, bond.area_m2});
  slots_[bond.b].links.push_back({bond.a, bond.face_b, bond.face_a, bond.area_m2});
}

void Structure::add_ghost(Ghost ghost) {
  for (const std::uint32_t slot : ghost.of) {
    slots_[slot].ghosts.push_back(static_cast<std::uint32_t>(ghosts_.size()));
  }
  ghosts_.push_back(std::move(ghost));
}

void Structure::remove_ghost(std::uint32_t number) {
  for (const std::uint32_t slot : ghosts_[number].of) std::erase(slots_[slot].ghosts, number);
  ghosts_[number] = {};
}

void Structure::add_level(std::vector<std::uint32_t> slots) {
  while (!levels_.empty() && levels_.back().slots.size() < 2 * slots.size()) {
    slots.insert(slots.end(), levels_.back().slots.begin(), levels_.back().slots.end());
    levels_.pop_back();
  }
  std::erase_if(slots, [&](std::uint32_t slot) { return !slots_[slot].convex; });
  if (slots.empty()) return;
  std::sort(slots.begin(), slots.end());
  std::vector<Box> boxes;
  boxes.reserve(slots.size());
  for (const std::uint32_t slot : slots) boxes.push_back(slots_[slot].convex->box);
  levels_.push_back({Bvh(boxes), std::move(slots)});
}

std::vector<std::uint32_t> Structure::touched(const ImpactSphere& sphere) const {
  std::vector<std::uint32_t> found, hits;
  for (const Level& level : levels_) {
    hits.clear();
    if (sphere.is_endless()) {
      hits.resize(level.slots.size());
      std::iota(hits.begin(), hits.end(), 0u);
    } else {
      level.tree.within(sphere.center_R, sphere.radius_m, hits);
    }
    for (const std::uint32_t hit : hits) {
      const ConvexPtr& convex = slots_[level.slots[hit]].convex;
      if (convex && sphere.touches(*convex)) found.push_back(level.slots[hit]);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void Structure::apply(const BreakEdit& edit) {
  if (!edit.changed) return;
  for (const std::uint32_t gone : edit.removed) {
    for (const Link& link : slots_[gone].links) {
      std::erase_if(slots_[link.other].links, [&](const Link& back) { return back.other == gone; });
    }
    while (!slots_[gone].ghosts.empty()) remove_ghost(slots_[gone].ghosts.back());
    slots_[gone] = {};
  }
  std::vector<std::uint32_t> fresh;
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    fresh.push_back(slot_count());
    slots_.push_back({edit.added[i], edit.added_anchors[i], {}, {}});
  }
  size_ += static_cast<std::uint32_t>(edit.added.size());
  size_ -= static_cast<std::uint32_t>(edit.removed.size());
  for (const Bond& bond : edit.bonds) link(bond);
  for (const Ghost& ghost : edit.ghosts) add_ghost(ghost);
  add_level(std::move(fresh));
}

Compound Structure::compound() const {
  Compound compound;
  std::vector<std::uint32_t> index(slots_.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].convex) continue;
    index[i] = static_cast<std::uint32_t>(compound.convexes.size());
    compound.convexes.push_back(slots_[i].convex);
    compound.anchored.push_back(slots_[i].anchored);
  }
  for (std::uint32_t i = 0; i < slot_count(); ++i) {
    for (const Link& link : slots_[i].links) {
      if (i > link.other) continue;
      compound.bonds.push_back(
          {index[i], index[link.other], link.face, link.other_face, link.area_m2});
    }
  }
  sort_bonds(compound.bonds);
  for (Ghost ghost : ghosts_) {
    if (!ghost.convex) continue;
    for (std::uint32_t& slot : ghost.of) slot = index[slot];
    compound.ghosts.push_back(std::move(ghost));
  }
  sort_ghosts(compound.ghosts);
  return compound;
}

double Structure::bytes_per_convex() const {
  std::size_t sum = bytes(slots_);
  for (const Slot& slot : slots_) {
    if (!slot.convex) continue;
    const ConvexPolyhedron& p = slot.convex->polyhedron;
    sum += bytes(slot.links) + bytes(slot.ghosts) + sizeof(Convex) + bytes(p.vertices) +
           bytes(p.faces) + bytes(p.corners) + bytes(p.corner_normals);
  }
  return static_cast<double>(sum) / std::max(1u, size_);
}

}  // namespace sunder::fracture
