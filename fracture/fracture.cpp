#include "fracture/fracture.h"

#include <iterator>

#include "engine/base/trace.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/cut/fragments.h"
#include "fracture/reassembly.h"

namespace sunder::fracture {
namespace {

BreakPlan unbroken(const Compound& compound) {
  BreakPlan plan;
  plan.pieces.push_back(compound);
  plan.untouched = static_cast<std::uint32_t>(compound.convexes.size());
  return plan;
}

/// Appends the result of one more island.
void append(BreakPlan island, BreakPlan& plan) {
  const auto first = static_cast<std::uint32_t>(plan.pieces.size());
  std::move(island.pieces.begin(), island.pieces.end(), std::back_inserter(plan.pieces));
  for (ExposedFace& face : island.exposed) {
    face.piece += first;
    plan.exposed.push_back(face);
  }
  plan.new_area_m2 += island.new_area_m2;
  plan.debris_volume_m3 += island.debris_volume_m3;
  plan.untouched += island.untouched;
  plan.welded += island.welded;
  plan.failed += island.failed;
  plan.failed_m3 += island.failed_m3;
}

}  // namespace

BreakEdit break_structure(const Structure& structure, const Pattern& pattern,
                          const Placement& placement, const ImpactSphere& sphere,
                          std::uint64_t event, const Fit& fit) {
  std::vector<ConvexSlot> touched = sphere.touched(structure);
  if (touched.empty()) return {};
  Stopwatch watch;
  Box reach;
  for (const ConvexSlot slot : touched) reach.extend(structure.convex(slot)->box);
  const AlignedPattern aligned = align(pattern, placement, event, reach);
  const Fragments fragments = make_fragments(structure, touched, aligned, sphere, fit);
  const double clip_ms = watch.lap_ms();
  BreakEdit edit;
  if (!touched.empty()) edit = Reassembly(structure, touched, fragments, sphere).edit();
  edit.loose.failed = fragments.failed;
  edit.loose.failed_m3 = fragments.failed_m3;
  edit.loose.clip_ms = clip_ms;
  edit.loose.islands_ms = watch.ms();
  if (!edit.changed) return edit;
  edit.loose.debris_volume_m3 = fragments.debris_volume_m3;
  edit.loose.welded = fragments.welded;
  for (const Fragment& fragment : fragments.all) {
    edit.loose.untouched += fragment.convex == structure.convex(fragment.source) ? 1 : 0;
  }
  edit.loose.untouched += structure.size() - static_cast<std::uint32_t>(touched.size());
  return edit;
}

BreakPlan apply_edit(Structure& structure, BreakEdit edit) {
  structure.apply(edit);
  BreakPlan plan = std::move(edit.loose);
  const bool is_gone = structure.empty();
  if (!is_gone) plan.pieces.insert(plan.pieces.begin(), structure.compound());
  std::vector<std::uint32_t> index(structure.slot_count());
  for (std::uint32_t slot = 0, next = 0; slot < index.size(); ++slot) {
    index[slot] = next;
    next += structure.has(ConvexSlot(slot)) ? 1 : 0;
  }
  for (ExposedFace& face : plan.exposed) {
    if (face.piece == 0) face.convex = index[face.convex];
    if (is_gone) --face.piece;
  }
  return plan;
}

BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event, const Fit& fit) {
  const std::vector<Compound> islands = split_islands(compound);
  if (islands.size() > 1) {
    BreakPlan plan;
    for (const Compound& island : islands) {
      append(fracture(island, pattern, placement, sphere, event, fit), plan);
    }
    return plan;
  }
  Structure structure(compound);
  BreakEdit edit = break_structure(structure, pattern, placement, sphere, event, fit);
  if (edit.changed) return apply_edit(structure, std::move(edit));
  BreakPlan plan = unbroken(compound);
  plan.failed = edit.loose.failed;
  plan.failed_m3 = edit.loose.failed_m3;
  return plan;
}

}  // namespace sunder::fracture
