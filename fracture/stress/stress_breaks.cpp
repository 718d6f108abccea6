#include "fracture/stress/stress_breaks.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {
namespace {

constexpr double kTolerance = 1e-3;  // of the solve
// Of an overloaded region the worst bond goes, and those of its plane whose stress is this near:
// by symmetry many are alike, and which is a shade worse is rounding.
constexpr double kAlike = 0.97;
constexpr int kRounds = 64;            // of cutting and solving again in one answer
constexpr int kMostIterations = 2000;  // a solve that needs more is given up, and cuts nothing
// Iterations that making a system costs, about, and editing one.
constexpr std::uint64_t kSetUpWork = 10, kEditWork = 4;
// A system is edited if so much of it stays; else it is made anew.
constexpr double kStays = 0.5;
// However much making the system took: or breaks in every frame would keep it from being solved.
constexpr std::uint64_t kLeastIterations = 2;
// Stress at a bond's own corners is at most so many times that of its section: those well below
// the limit need no closer look.
constexpr double kWorthALook = 0.6;

/// What is handed back to the next solve.
struct Memory final : StressMemory {
  std::vector<ConvexSlot> slots;  ///< Per convex.
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint8_t> anchored;
  std::vector<Bond> bonds;
  std::shared_ptr<const StressSystem> system;
  std::vector<Displacement> displacements;
  int iterations = 0;  ///< Without coming to an end.

  bool is_of(const Compound& compound) const {
    // Bonds are only ever lost, so their number tells.
    return bonds.size() == compound.bonds.size() && convexes == compound.convexes &&
           anchored == compound.anchored;
  }
};

struct Limits {
  double tensile_Pa, shear_Pa, compressive_Pa;
};

double weaker(double x, double y) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  return std::min(x > 0 ? x : kNever, y > 0 ? y : kNever);
}

Limits limits_of(const Material& a, const Material& b) {
  return {weaker(a.tensile_Pa, b.tensile_Pa), weaker(a.shear_Pa, b.shear_Pa),
          weaker(a.compressive_Pa, b.compressive_Pa)};
}

/// Stress in parts of the limit.
double part_of(const BondStress& stress, const Limits& limits) {
  return std::max({stress.tension_Pa / limits.tensile_Pa, stress.shear_Pa / limits.shear_Pa,
                   stress.compression_Pa / limits.compressive_Pa});
}

auto place_of(const Bond& bond) { return std::tie(bond.a, bond.b, bond.face_a, bond.face_b); }

constexpr std::uint32_t kNew = StressOrigin::kNew;

/// Where the convexes and bonds of a compound, with these slots, were in what the memory is of; few
/// are known if that was no earlier state of the same structure.
StressOrigin origin_in(const Memory& old, const Compound& compound,
                       const std::vector<ConvexSlot>& slots) {
  StressOrigin origin;
  std::uint32_t was = 0;
  for (std::uint32_t c = 0; c < slots.size(); ++c) {
    while (was < old.slots.size() && old.slots[was] < slots[c]) ++was;
    const bool known = was < old.slots.size() && old.slots[was] == slots[c] &&
                       old.convexes[was] == compound.convexes[c];
    origin.convexes.push_back(known ? was : kNew);
  }
  std::uint32_t next = 0;
  for (Bond bond : compound.bonds) {
    bond.a = origin.convexes[bond.a];
    bond.b = origin.convexes[bond.b];
    origin.bonds.push_back(kNew);
    if (bond.a == kNew || bond.b == kNew) continue;
    while (next < old.bonds.size() && place_of(old.bonds[next]) < place_of(bond)) ++next;
    if (next == old.bonds.size() || place_of(old.bonds[next]) != place_of(bond)) continue;
    origin.bonds.back() = next;
  }
  return origin;
}

/// A structure while its bonds are cut.
class StressBreaks {
 public:
  StressBreaks(const Structure& structure, const LoadCase& load)
      : compound_(structure.compound()),
        slots_(structure.slots()),
        load_(load),
        memory_(std::make_shared<Memory>()) {
    for (const Load& one : load.loads) {
      const auto at = std::lower_bound(slots_.begin(), slots_.end(), one.convex);
      const auto convex = static_cast<std::uint32_t>(at - slots_.begin());
      loads_.push_back({convex, one.force_N, one.point_R, one.torque_Nm});
    }
  }

  StressAnswer run() {
    StressAnswer answer;
    recall(answer);
    most_work_ =
        std::max(load_.most_work, answer.work + kLeastIterations * memory_->system->work());
    for (int round = 0; round < kRounds; ++round) {
      if (!solve(answer)) break;
      const std::vector<std::uint32_t> cut = overloaded(answer);
      if (cut.empty()) {
        answer.settled = true;
        break;
      }
      remove(cut);
      answer.work += kEditWork * memory_->system->work();
    }
    part(answer.edit);
    memory_->slots = slots_;
    memory_->bonds = compound_.bonds;
    memory_->convexes = compound_.convexes;
    memory_->anchored = compound_.anchored;
    answer.memory = memory_;
    return answer;
  }

 private:
  /// Takes over what is known of the compound, or of what it was a part of.
  void recall(StressAnswer& answer) {
    const auto* old = dynamic_cast<const Memory*>(load_.memory.get());
    if (old && old->is_of(compound_)) {
      *memory_ = *old;
      return;
    }
    memory_->displacements.resize(compound_.convexes.size());
    if (old && edit_system(*old)) {
      answer.work += kEditWork * memory_->system->work();
      return;
    }
    make_system(old);
    answer.work += kSetUpWork * memory_->system->work();
  }

  /// False if too little of the system is still there.
  bool edit_system(const Memory& old) {
    const StressOrigin origin = origin_in(old, compound_, slots_);
    const auto known = std::ranges::count_if(origin.convexes, [](auto was) { return was != kNew; });
    if (static_cast<double>(known) < kStays * static_cast<double>(old.slots.size())) return false;
    for (std::size_t c = 0; c < origin.convexes.size(); ++c) {
      if (origin.convexes[c] != kNew) {
        memory_->displacements[c] = old.displacements[origin.convexes[c]];
      }
    }
    std::vector<BondGeometry> geometry;
    for (std::size_t i = 0; i < origin.bonds.size(); ++i) {
      geometry.push_back(origin.bonds[i] != kNew ? old.system->geometry()[origin.bonds[i]]
                                                 : bond_geometry(compound_, compound_.bonds[i]));
    }
    memory_->system = std::make_shared<const StressSystem>(
        *old.system, compound_, std::move(geometry), load_.materials, origin);
    return true;
  }

  void make_system(const Memory* old) {
    std::vector<BondGeometry> geometry(compound_.bonds.size());
    std::vector<std::uint32_t> old_of_new(compound_.convexes.size(), kNew);
    if (old) {
      std::unordered_map<const Convex*, std::uint32_t> numbers;
      for (std::uint32_t c = 0; c < old->convexes.size(); ++c) {
        numbers.emplace(old->convexes[c].get(), c);
      }
      for (std::uint32_t c = 0; c < old_of_new.size(); ++c) {
        const auto found = numbers.find(compound_.convexes[c].get());
        if (found == numbers.end()) continue;
        old_of_new[c] = found->second;
        memory_->displacements[c] = old->displacements[found->second];
      }
    }
    for_chunks(geometry.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const BondGeometry* known = old ? known_geometry(*old, old_of_new, i) : nullptr;
        geometry[i] = known ? *known : bond_geometry(compound_, compound_.bonds[i]);
      }
    });
    memory_->system = std::make_shared<const StressSystem>(
        compound_, std::move(geometry), load_.materials, StressSystem::spare_nodes(compound_));
  }

  const BondGeometry* known_geometry(const Memory& old,
                                     const std::vector<std::uint32_t>& old_of_new,
                                     std::size_t i) const {
    Bond bond = compound_.bonds[i];
    bond.a = old_of_new[bond.a];
    bond.b = old_of_new[bond.b];
    if (bond.a == kNew || bond.b == kNew || bond.a > bond.b) return nullptr;
    const auto at =
        std::lower_bound(old.bonds.begin(), old.bonds.end(), bond,
                         [](const Bond& x, const Bond& y) { return place_of(x) < place_of(y); });
    if (at == old.bonds.end() || place_of(*at) != place_of(bond)) return nullptr;
    return &old.system->geometry()[static_cast<std::size_t>(at - old.bonds.begin())];
  }

  /// False if the stress is not known by now: there is no work left, or it is given up.
  bool solve(StressAnswer& answer) {
    const std::uint64_t each = std::max<std::uint64_t>(1, memory_->system->work());
    if (answer.work >= most_work_) return false;
    const auto left = static_cast<int>(
        std::min<std::uint64_t>(kMostIterations, 1 + (most_work_ - answer.work) / each));
    const SolveResult result = memory_->system->solve(loads_, load_.gravity_R, kTolerance, left,
                                                      memory_->displacements, load_.spin_R);
    answer.work += each * static_cast<std::uint64_t>(1 + result.iterations);
    memory_->iterations = result.converged ? 0 : memory_->iterations + result.iterations;
    answer.settled = memory_->iterations >= kMostIterations;
    return result.converged;
  }

  /// The worst bonds of each overloaded region, ascending.
  std::vector<std::uint32_t> overloaded(StressAnswer& answer) const {
    std::vector<double> parts(compound_.bonds.size(), 0);
    for_chunks(parts.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) parts[i] = part_of_limit(i);
    });
    answer.worst = 0;
    std::vector<Bond> too_weak;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      answer.worst = std::max(answer.worst, parts[i]);
      if (parts[i] <= 1) continue;
      too_weak.push_back(compound_.bonds[i]);
      numbers.push_back(i);
    }
    if (numbers.empty()) return {};
    // Overloaded bonds that share a convex are one region.
    const std::vector<std::uint32_t> region = find_islands(compound_.convexes.size(), too_weak);
    const auto region_of = [&](std::uint32_t i) { return region[compound_.bonds[i].a]; };
    std::vector<std::uint32_t> worst(compound_.convexes.size(), kNew);
    for (const std::uint32_t i : numbers) {
      std::uint32_t& most = worst[region_of(i)];
      if (most == kNew || parts[i] > parts[most]) most = i;
    }
    std::erase_if(numbers, [&](std::uint32_t i) {
      const std::uint32_t most = worst[region_of(i)];
      return plane_of(i) != plane_of(most) || parts[i] < kAlike * parts[most];
    });
    return numbers;
  }

  std::uint64_t plane_of(std::uint32_t i) const {
    const Bond& bond = compound_.bonds[i];
    return compound_.convexes[bond.a]->polyhedron.faces[bond.face_a].id.value >> 1;
  }

  double part_of_limit(std::size_t i) const {
    const Bond& bond = compound_.bonds[i];
    const auto number = static_cast<std::uint32_t>(i);
    const Limits limits = limits_of(load_.materials[compound_.convexes[bond.a]->material.value],
                                    load_.materials[compound_.convexes[bond.b]->material.value]);
    const double most = part_of(memory_->system->bound(number, memory_->displacements), limits);
    if (!(most > kWorthALook)) return most;
    return part_of(memory_->system->stress(compound_, number, memory_->displacements), limits);
  }

  void remove(const std::vector<std::uint32_t>& cut) {
    std::vector<BondGeometry> geometry;
    std::vector<Bond> bonds;
    StressOrigin origin;
    origin.convexes.resize(compound_.convexes.size());
    std::iota(origin.convexes.begin(), origin.convexes.end(), 0u);
    auto next = cut.begin();
    for (std::uint32_t i = 0; i < compound_.bonds.size(); ++i) {
      if (next != cut.end() && *next == i) {
        cut_.push_back(compound_.bonds[i]);
        ++next;
        continue;
      }
      bonds.push_back(compound_.bonds[i]);
      origin.bonds.push_back(i);
      geometry.push_back(memory_->system->geometry()[i]);
    }
    compound_.bonds = std::move(bonds);
    memory_->system = std::make_shared<const StressSystem>(
        *memory_->system, compound_, std::move(geometry), load_.materials, origin);
  }

  /// The island that stays: the largest of those that are anchored, or of all.
  std::uint32_t staying(const std::vector<std::uint32_t>& island, std::uint32_t islands) const {
    std::vector<std::pair<bool, std::uint32_t>> rank(islands);
    for (std::uint32_t c = 0; c < island.size(); ++c) {
      rank[island[c]].first |= compound_.anchored[c] != 0;
      ++rank[island[c]].second;
    }
    return static_cast<std::uint32_t>(std::max_element(rank.begin(), rank.end()) - rank.begin());
  }

  Bond by_slots(const Bond& bond) const {
    return {slots_[bond.a].value, slots_[bond.b].value, bond.face_a, bond.face_b, bond.area_m2};
  }

  /// Islands but one come off, as pieces in the order of their first convex.
  void part(BreakEdit& edit) const {
    for (const Bond& bond : cut_) edit.cut.push_back(by_slots(bond));
    const std::vector<std::uint32_t> island = find_islands(compound_);
    const std::uint32_t islands = 1 + *std::max_element(island.begin(), island.end());
    if (islands == 1) return;
    const std::uint32_t stays = staying(island, islands);
    const auto piece_of = [&](std::uint32_t c) {  // as exposed faces name it
      return island[c] == stays ? 0 : island[c] + (island[c] < stays ? 1 : 0);
    };
    edit.changed = true;
    BreakPlan& plan = edit.loose;
    plan.pieces.resize(islands - 1);
    plan.untouched = static_cast<std::uint32_t>(island.size());
    std::vector<std::uint32_t> place(island.size());
    for (std::uint32_t c = 0; c < island.size(); ++c) {
      place[c] = slots_[c].value;
      if (island[c] == stays) continue;
      Compound& piece = plan.pieces[piece_of(c) - 1];
      edit.removed.push_back(slots_[c]);
      place[c] = static_cast<std::uint32_t>(piece.convexes.size());
      piece.convexes.push_back(compound_.convexes[c]);
      piece.anchored.push_back(compound_.anchored[c]);
    }
    for (const Bond& bond : compound_.bonds) {
      if (island[bond.a] == stays) continue;
      plan.pieces[piece_of(bond.a) - 1].bonds.push_back(
          {place[bond.a], place[bond.b], bond.face_a, bond.face_b, bond.area_m2});
    }
    for (Ghost ghost : compound_.ghosts) {
      if (island[ghost.of[0]] == stays) continue;
      Compound& piece = plan.pieces[piece_of(ghost.of[0]) - 1];
      for (std::uint32_t& c : ghost.of) c = place[c];
      piece.ghosts.push_back(std::move(ghost));
    }
    for (const Bond& bond : cut_) {
      if (island[bond.a] == island[bond.b]) continue;
      plan.new_area_m2 += bond.area_m2;
      plan.exposed.push_back({piece_of(bond.a), place[bond.a], bond.face_a, bond.area_m2,
                              compound_.convexes[bond.a]->material});
      plan.exposed.push_back({piece_of(bond.b), place[bond.b], bond.face_b, bond.area_m2,
                              compound_.convexes[bond.b]->material});
    }
  }

  Compound compound_;              ///< Less the bonds that are cut.
  std::vector<ConvexSlot> slots_;  ///< Per convex.
  const LoadCase& load_;
  std::vector<ConvexLoad> loads_;
  std::shared_ptr<Memory> memory_;
  std::uint64_t most_work_ = 0;
  std::vector<Bond> cut_;
};

}  // namespace

StressAnswer break_by_stress(const Structure& structure, const LoadCase& load) {
  SUNDER_CHECK(!structure.empty());
  return StressBreaks(structure, load).run();
}

}  // namespace sunder::fracture
