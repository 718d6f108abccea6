#include "fracture/stress/separate_islands.h"

#include <algorithm>
#include <utility>

#include "fracture/adjacency/islands.h"

namespace sunder::fracture {
namespace {

/// Returns the island that stays: the largest with an anchor, or the largest of all.
std::uint32_t island_that_stays(const Compound& compound, const std::vector<std::uint32_t>& island,
                                std::uint32_t islands) {
  std::vector<std::pair<bool, std::uint32_t>> rank(islands);
  for (std::uint32_t c = 0; c < island.size(); ++c) {
    rank[island[c]].first |= compound.anchored[c] != 0;
    ++rank[island[c]].second;
  }
  return static_cast<std::uint32_t>(std::max_element(rank.begin(), rank.end()) - rank.begin());
}

/// Swaps the sides of a hinge, so that sliding follows the side that stays.
void swap_sides(PlasticHinge& hinge) {
  for (Bond& bond : hinge.bonds) std::swap(bond.a, bond.b), std::swap(bond.face_a, bond.face_b);
  Mat3& axes_R = hinge.section.strength.axes_R;
  axes_R.col(0) *= -1, axes_R.col(2) *= -1;
}

}  // namespace

BreakEdit separate_islands(const Compound& compound, const std::vector<ConvexSlot>& slots,
                           const std::vector<Bond>& cut, std::vector<PlasticHinge> hinges) {
  BreakEdit edit;
  for (Bond bond : cut) {
    bond.a = slots[bond.a].value;
    bond.b = slots[bond.b].value;
    edit.cut.push_back(bond);
  }
  const std::vector<std::uint32_t> island = find_islands(compound);
  const std::uint32_t islands = 1 + *std::max_element(island.begin(), island.end());
  if (islands == 1) return edit;
  const std::uint32_t stays = island_that_stays(compound, island, islands);
  const auto piece_of = [&](std::uint32_t c) {  // Index as in ExposedFace::piece.
    return island[c] == stays ? 0 : island[c] + (island[c] < stays ? 1 : 0);
  };
  edit.changed = true;
  BreakPlan& plan = edit.loose;
  plan.pieces.resize(islands - 1);
  plan.untouched = static_cast<std::uint32_t>(island.size());
  std::vector<std::uint32_t> place(island.size());
  for (std::uint32_t c = 0; c < island.size(); ++c) {
    place[c] = slots[c].value;
    if (island[c] == stays) continue;
    Compound& piece = plan.pieces[piece_of(c) - 1];
    edit.removed.push_back(slots[c]);
    place[c] = static_cast<std::uint32_t>(piece.convexes.size());
    piece.convexes.push_back(compound.convexes[c]);
    piece.anchored.push_back(compound.anchored[c]);
  }
  for (const Bond& bond : compound.bonds) {
    if (island[bond.a] == stays) continue;
    plan.pieces[piece_of(bond.a) - 1].bonds.push_back(
        {place[bond.a], place[bond.b], bond.face_a, bond.face_b, bond.area_m2});
  }
  for (Ghost ghost : compound.ghosts) {
    if (island[ghost.of[0]] == stays) continue;
    Compound& piece = plan.pieces[piece_of(ghost.of[0]) - 1];
    for (std::uint32_t& c : ghost.of) c = place[c];
    piece.ghosts.push_back(std::move(ghost));
  }
  for (const Bond& bond : cut) {
    if (island[bond.a] == island[bond.b]) continue;
    plan.new_area_m2 += bond.area_m2;
    plan.exposed.push_back({piece_of(bond.a), place[bond.a], bond.face_a, bond.area_m2,
                            compound.convexes[bond.a]->material});
    plan.exposed.push_back({piece_of(bond.b), place[bond.b], bond.face_b, bond.area_m2,
                            compound.convexes[bond.b]->material});
  }
  for (PlasticHinge& hinge : hinges) {
    if (island[hinge.bonds[0].b] == stays) swap_sides(hinge);
    hinge.piece_a = piece_of(hinge.bonds[0].a);
    hinge.piece_b = piece_of(hinge.bonds[0].b);
    for (Bond& bond : hinge.bonds) {
      bond.a = place[bond.a];
      bond.b = place[bond.b];
    }
  }
  edit.hinges = std::move(hinges);
  return edit;
}

}  // namespace sunder::fracture
