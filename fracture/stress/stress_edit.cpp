// A stress system after an edit of its compound: what stays keeps its node, and only springs at the
// nodes that an edit reaches are made.
#include "fracture/stress/stress.h"

namespace sunder::fracture {

StressSystem::StressSystem(const StressSystem& old, const Compound& compound,
                           std::vector<BondGeometry> geometry, std::span<const Material> materials,
                           const StressOrigin& origin)
    : geometry_(std::move(geometry)), overlaps_(!compound.ghosts.empty()) {
  const Edited edited{old, origin};
  weigh(compound, materials, &edited);
  SpringEdit edit;
  if (overlaps_ || old.overlaps_ || !old.multigrid_ ||
      !number_nodes(edited, find_held(compound), edit)) {
    *this = StressSystem(compound, std::move(geometry_), materials, spare_nodes(compound));
    return;
  }
  make_joints(compound, materials, &edited);
  mark_changes(edited, edit);
  for (std::uint32_t i = 0; i < joints_.size(); ++i) {
    if (!has_spring(i)) continue;
    ++springs_;
    const std::uint32_t a = node_of_convex_[joints_[i].a], b = node_of_convex_[joints_[i].b];
    if (edit.is_at(a) || edit.is_at(b)) edit.springs.push_back(spring_of(i));
  }
  multigrid_ = std::make_shared<const Multigrid>(*old.multigrid_, std::move(edit));
}

/// Convexes keep their nodes; new ones take those that are free. False if there are too few.
bool StressSystem::number_nodes(const Edited& edited, const std::vector<std::uint8_t>& held,
                                SpringEdit& edit) {
  nodes_ = edited.old.nodes_;
  edit.changes.assign(nodes_, SpringEdit::Change::kNone);
  std::vector<std::uint8_t> taken(nodes_, 0);
  node_of_convex_.assign(held.size(), Spring::kWorld);
  for (std::size_t c = 0; c < held.size(); ++c) {
    const std::uint32_t was = edited.origin.convexes[c];
    if (held[c] || was == StressOrigin::kNew) continue;
    node_of_convex_[c] = edited.old.node_of_convex_[was];
    if (node_of_convex_[c] != Spring::kWorld) taken[node_of_convex_[c]] = 1;
  }
  for (const std::uint32_t node : edited.old.node_of_convex_) {
    if (node != Spring::kWorld && !taken[node]) edit.changes[node] = SpringEdit::Change::kSprings;
  }
  std::uint32_t free = 0;
  for (std::size_t c = 0; c < held.size(); ++c) {
    if (held[c] || node_of_convex_[c] != Spring::kWorld) continue;
    while (free < nodes_ && taken[free]) ++free;
    if (free == nodes_) return false;
    node_of_convex_[c] = free;
    edit.changes[free++] = SpringEdit::Change::kNew;
  }
  return true;
}

/// Marks the nodes at the ends of bonds that came or went, or lead to another node than before.
void StressSystem::mark_changes(const Edited& edited, SpringEdit& edit) const {
  const auto mark = [&](std::uint32_t convex) {
    const std::uint32_t node = node_of_convex_[convex];
    if (node == Spring::kWorld || edit.is_at(node)) return;
    edit.changes[node] = SpringEdit::Change::kSprings;
  };
  const auto moved = [&](std::uint32_t convex) {
    const std::uint32_t was = edited.origin.convexes[convex];
    return was == StressOrigin::kNew || node_of_convex_[convex] != edited.old.node_of_convex_[was];
  };
  std::vector<std::uint8_t> stays(edited.old.joints_.size(), 0);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const std::uint32_t was = edited.origin.bonds[i];
    if (was != StressOrigin::kNew) stays[was] = 1;
    if (was != StressOrigin::kNew && !moved(joints_[i].a) && !moved(joints_[i].b)) continue;
    mark(joints_[i].a);
    mark(joints_[i].b);
  }
  std::vector<std::uint32_t> new_of_old(edited.old.centroids_.size(), StressOrigin::kNew);
  for (std::uint32_t c = 0; c < edited.origin.convexes.size(); ++c) {
    const std::uint32_t was = edited.origin.convexes[c];
    if (was != StressOrigin::kNew) new_of_old[was] = c;
  }
  for (std::size_t k = 0; k < stays.size(); ++k) {
    if (stays[k]) continue;
    for (const std::uint32_t end : {edited.old.joints_[k].a, edited.old.joints_[k].b}) {
      if (new_of_old[end] != StressOrigin::kNew) mark(new_of_old[end]);
    }
  }
}

}  // namespace sunder::fracture
