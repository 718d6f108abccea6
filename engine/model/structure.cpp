#include "engine/model/structure.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/state_checks.h"
#include "engine/model/breaker.h"

namespace sunder {
namespace {

// Gap between two convexes on a ray, as a fraction of the length so far, below which they are one.
constexpr double kGap = 1e-3;

/// Shortens a stretch of a ray, from `enters` to `leaves`, to the part inside a convex polyhedron;
/// it ends before it begins if the ray misses.
void clip(const ConvexPolyhedron& solid, const Vec3& from, const Vec3& direction, double& enters,
          double& leaves) {
  for (const ConvexPolyhedron::Face& face : solid.faces) {
    const double away = face.plane.normal.dot(direction), depth = face.plane.distance(from);
    if (away > 0) leaves = std::min(leaves, -depth / away);
    if (away < 0) enters = std::max(enters, -depth / away);
    if (away == 0 && depth > 0) leaves = enters;
  }
}

template <class T>
std::size_t bytes(const std::vector<T>& vector) {
  return vector.capacity() * sizeof(T);
}

}  // namespace

Structure::Structure(const Compound& compound) {
  slots_.resize(compound.convexes.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i] = {compound.convexes[i], compound.anchored[i], {}, {}};
    anchored_ += compound.anchored[i] != 0 ? 1 : 0;
  }
  size_ = slot_count();
  for (const Bond& bond : compound.bonds) link(bond);
  for (const Ghost& ghost : compound.ghosts) add_ghost(ghost);
  add_level(slots());
}

void Structure::link(const Bond& bond) {
  slots_[bond.a].links.push_back({ConvexSlot(bond.b), bond.face_a, bond.face_b, bond.area_m2});
  slots_[bond.b].links.push_back({ConvexSlot(bond.a), bond.face_b, bond.face_a, bond.area_m2});
  ++bonds_;
}

void Structure::unlink(const Bond& bond) {
  const auto is_link = [&](std::uint32_t other, std::uint32_t face, std::uint32_t other_face) {
    return [=](const Link& link) {
      return std::tie(link.other.value, link.face, link.other_face) ==
             std::tie(other, face, other_face);
    };
  };
  bonds_ -= std::erase_if(slots_[bond.a].links, is_link(bond.b, bond.face_a, bond.face_b));
  std::erase_if(slots_[bond.b].links, is_link(bond.a, bond.face_b, bond.face_a));
}

const char* Structure::wrong_field() const {
  std::size_t size = 0, anchored = 0, ends = 0;
  for (std::uint32_t s = 0; s < slot_count(); ++s) {
    const Slot& slot = slots_[s];
    if (!slot.convex) {
      if (!slot.links.empty() || !slot.ghosts.empty()) return "slots_";
      continue;
    }
    ++size;
    anchored += slot.anchored != 0;
    ends += slot.links.size();
    if (slot.anchored > kAnchoredAllSides) return "slots_";
    for (const Link& link : slot.links) {
      if (!has(link.other) || link.other.value == s ||
          link.face >= slot.convex->polyhedron.faces.size() || !(link.area_m2 >= 0))
        return "slots_";
      const auto is_back = [&](const Link& back) {
        return back.other.value == s && back.face == link.other_face &&
               back.other_face == link.face;
      };
      if (std::ranges::count_if(slots_[link.other.value].links, is_back) != 1) return "slots_";
    }
    for (const std::uint32_t ghost : slot.ghosts)
      if (ghost >= ghosts_.size() || std::ranges::count(ghosts_[ghost].of, s) != 1) return "slots_";
    if (!std::ranges::is_sorted(slot.ghosts, std::less_equal())) return "slots_";
  }
  for (std::uint32_t g = 0; g < ghosts_.size(); ++g) {
    if (ghosts_[g].of.empty() == (ghosts_[g].convex != nullptr)) return "ghosts_";
    for (const std::uint32_t slot : ghosts_[g].of)
      if (!has(ConvexSlot(slot)) || !std::ranges::binary_search(slots_[slot].ghosts, g))
        return "ghosts_";
  }
  std::vector<ConvexSlot> indexed;
  for (const Level& level : levels_) {
    if (level.slots.size() != level.tree.size()) return "levels_";
    for (const ConvexSlot slot : level.slots)
      if (has(slot)) indexed.push_back(slot);
  }
  if (indexed.size() != size || !are_different_below(indexed, slots_.size())) return "levels_";
  if (size_ != size) return "size_";
  if (anchored_ != anchored) return "anchored_";
  return 2 * bonds_ == ends ? nullptr : "bonds_";
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

void Structure::add_level(std::vector<ConvexSlot> slots) {
  while (!levels_.empty() && levels_.back().slots.size() < 2 * slots.size()) {
    slots.insert(slots.end(), levels_.back().slots.begin(), levels_.back().slots.end());
    levels_.pop_back();
  }
  std::erase_if(slots, [&](ConvexSlot slot) { return !has(slot); });
  if (slots.empty()) return;
  std::sort(slots.begin(), slots.end());
  std::vector<Box> boxes;
  boxes.reserve(slots.size());
  for (const ConvexSlot slot : slots) boxes.push_back(convex(slot)->box);
  levels_.push_back({Bvh(boxes), std::move(slots)});
}

std::vector<ConvexSlot> Structure::slots() const {
  std::vector<ConvexSlot> slots;
  slots.reserve(size_);
  for_each([&](ConvexSlot slot, const Convex&) { slots.push_back(slot); });
  return slots;
}

std::vector<ConvexSlot> Structure::within(const Vec3& center_R, double radius_m) const {
  std::vector<ConvexSlot> found;
  std::vector<std::uint32_t> items;
  const bool is_all = radius_m == std::numeric_limits<double>::infinity();
  for (const Level& level : levels_) {
    items.clear();
    if (is_all) {
      items.resize(level.slots.size());
      std::iota(items.begin(), items.end(), 0u);
    } else {
      level.tree.within(center_R, radius_m, items);
    }
    for (const std::uint32_t item : items) {
      if (has(level.slots[item])) found.push_back(level.slots[item]);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void Structure::remove_slot(ConvexSlot slot) {
  Slot& gone = slots_[slot.value];
  for (const Link& link : gone.links) {
    std::erase_if(slots_[link.other.value].links,
                  [&](const Link& back) { return back.other == slot; });
  }
  bonds_ -= gone.links.size();
  while (!gone.ghosts.empty()) remove_ghost(gone.ghosts.back());
  anchored_ -= gone.anchored != 0 ? 1 : 0;
  gone = {};
  --size_;
}

void Structure::apply(const BreakEdit& edit) {
  for (const Bond& bond : edit.cut) unlink(bond);
  if (!edit.changed) return;
  for (const ConvexSlot slot : edit.removed) remove_slot(slot);
  std::vector<ConvexSlot> fresh;
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    fresh.push_back(ConvexSlot(slot_count()));
    slots_.push_back({edit.added[i], edit.added_anchors[i], {}, {}});
    anchored_ += edit.added_anchors[i] != 0 ? 1 : 0;
  }
  size_ += static_cast<std::uint32_t>(edit.added.size());
  for (const Bond& bond : edit.bonds) link(bond);
  for (const Ghost& ghost : edit.ghosts) add_ghost(ghost);
  add_level(std::move(fresh));
}

void Structure::loosen(ConvexSlot slot) {
  anchored_ -= anchored(slot) != 0 ? 1 : 0;
  slots_[slot.value].anchored = 0;
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
  std::vector<Bond> of_slot;
  for (std::uint32_t i = 0; i < slot_count(); ++i) {
    of_slot.clear();
    for (const Link& link : slots_[i].links) {
      if (i > link.other.value) continue;
      of_slot.push_back(
          {index[i], index[link.other.value], link.face, link.other_face, link.area_m2});
    }
    std::sort(of_slot.begin(), of_slot.end(), [](const Bond& x, const Bond& y) {
      return std::tie(x.b, x.face_a, x.face_b) < std::tie(y.b, y.face_a, y.face_b);
    });
    compound.bonds.insert(compound.bonds.end(), of_slot.begin(), of_slot.end());
  }
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

Box bounds(const Structure& structure) {
  Box box;
  structure.for_each([&](ConvexSlot, const Convex& convex) { box.extend(convex.box); });
  return box;
}

double distance_to(const Structure& structure, const Vec3& point_R) {
  double least = std::numeric_limits<double>::infinity();
  structure.for_each([&](ConvexSlot, const Convex& convex) {
    least = std::min(least, distance_to(convex, point_R));
  });
  return least;
}

ConvexSlot nearest(const Structure& structure, const Vec3& point_R) {
  SUNDER_CHECK(!structure.empty());
  double least = 0;
  ConvexSlot found;
  const auto search = [&](double radius_m) {
    for (const ConvexSlot slot : structure.within(point_R, radius_m)) {
      const double distance = distance_to(*structure.convex(slot), point_R);
      if (!found.none() && distance >= least) continue;
      least = distance;
      found = slot;
    }
  };
  for (double radius_m = 0; found.none(); radius_m = std::max(1e-3, 4 * radius_m)) search(radius_m);
  if (least > 0) search(least);
  return found;
}

double thickness_along(const Structure& structure, const Vec3& point_R, const Vec3& direction_R,
                       double most_m) {
  std::vector<std::pair<double, double>> spans;  // of the ray within convexes
  for (const ConvexSlot slot : structure.within(point_R, most_m)) {
    double enters = -most_m, leaves = most_m;
    clip(structure.convex(slot)->polyhedron, point_R, direction_R, enters, leaves);
    if (leaves > enters && leaves > 0) spans.emplace_back(enters, leaves);
  }
  std::ranges::sort(spans);
  double end = 0;
  for (const auto& [enters, leaves] : spans)
    if (end == 0 || enters <= end * (1 + kGap)) end = std::max(end, leaves);
  return end;
}

double path_through(const Structure& structure, const Vec3& point_R, const Vec3& direction_R,
                    double back_m, double most_m) {
  std::vector<std::pair<double, double>> spans;
  for (const ConvexSlot slot : structure.within(point_R, std::max(back_m, most_m))) {
    double enters = -back_m, leaves = most_m;
    clip(structure.convex(slot)->polyhedron, point_R, direction_R, enters, leaves);
    if (leaves > enters) spans.emplace_back(enters, leaves);
  }
  std::ranges::sort(spans);
  double begin = -back_m, end = -back_m;
  for (const auto& [enters, leaves] : spans) {
    if (enters > end + kGap * most_m) {
      if (end > 0) break;
      begin = enters;
    }
    end = std::max(end, leaves);
  }
  return end > 0 ? end - begin : 0;
}

}  // namespace sunder
