#include "fracture/stress/stress_breaks.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/stress_memory.h"

namespace sunder::fracture {
namespace {

constexpr double kTolerance = 1e-3, kBlowTolerance = 1e-2;  // of the solve
// Of an overloaded region the worst bond goes, and those of its plane whose stress is this near:
// by symmetry many are alike, and which is a shade worse is rounding.
constexpr double kAlike = 0.97;
constexpr int kRounds = 64;            // of cutting and solving again in one answer
constexpr int kMostIterations = 2000;  // a solve that needs more is given up, and cuts nothing
// However much making the system took: or breaks in every frame would keep it from being solved.
constexpr std::uint64_t kLeastIterations = 2;
// Stress at a bond's own corners is at most so many times that of its section: those well below
// the limit need no closer look.
constexpr double kWorthALook = 0.6;

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

constexpr std::uint32_t kNone = 0xffffffff;

/// A structure while its bonds are cut.
class StressBreaks {
 public:
  StressBreaks(const Structure& structure, const LoadCase& load)
      : compound_(structure.compound()),
        slots_(structure.slots()),
        load_(load),
        loads_(by_convex(load.loads)),
        impulses_(by_convex(load.blow.impulses)),
        blow_J_(load.blow.energy_J) {}

  StressAnswer run() {
    StressAnswer answer;
    memory_ = recall(load_.memory.get(), compound_, slots_, load_.materials, answer.work);
    most_work_ =
        std::max(load_.most_work, answer.work + kLeastIterations * memory_->system->work());
    for (int round = 0; round < kRounds; ++round) {
      if (!solve(answer) || !strike(answer)) break;
      const std::vector<std::uint32_t> cut = overloaded(answer);
      if (round == 0) note_blow(answer);
      if (cut.empty()) {
        answer.settled = true;
        break;
      }
      remove(cut);
      answer.work += kEditWork * memory_->system->work();
      if (!impulses_.empty() && parted()) break;  // what is struck is another body now
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
  std::vector<ConvexLoad> by_convex(std::span<const Load> loads) const {
    std::vector<ConvexLoad> all;
    for (const Load& one : loads) {
      const auto at = std::lower_bound(slots_.begin(), slots_.end(), one.convex);
      const auto convex = static_cast<std::uint32_t>(at - slots_.begin());
      all.push_back({convex, one.force_N, one.point_R, one.torque_Nm});
    }
    return all;
  }

  /// False if there is no work left, or it is given up.
  bool improve(std::span<const ConvexLoad> loads, const Vec3& gravity_R, const Vec3& spin_R,
               double tolerance, std::vector<Displacement>& displacements, int& iterations,
               StressAnswer& answer) {
    const std::uint64_t each = std::max<std::uint64_t>(1, memory_->system->work());
    if (answer.work >= most_work_) return false;
    const auto left = static_cast<int>(
        std::min<std::uint64_t>(kMostIterations, 1 + (most_work_ - answer.work) / each));
    const SolveResult result =
        memory_->system->solve(loads, gravity_R, tolerance, left, displacements, spin_R);
    answer.work += each * static_cast<std::uint64_t>(1 + result.iterations);
    iterations = result.converged ? 0 : iterations + result.iterations;
    return result.converged;
  }

  /// False if the stress of the steady load is not known by now.
  bool solve(StressAnswer& answer) {
    const bool known = improve(loads_, load_.gravity_R, load_.spin_R, kTolerance,
                               memory_->displacements, memory_->iterations, answer);
    answer.settled = memory_->iterations >= kMostIterations;
    return known;
  }

  /// Adds what the blow does, at its worst, to what the load does; false if that is not known.
  ///
  /// The structure swings out the way that the impulses, as forces, would bend it: by u, in which
  /// these do the work 2U. Swinging so at a rate q it has the energy ½Mq², M = Σ m u², and what
  /// strikes it ½mq²; that m is what the impulses, 2U in this direction, and the work that they
  /// do, W = (2U)² / 2m, tell. Cox (1849): they swing on together, and bend it by λu at most, when
  /// all of that energy is in the bending: λ² = 2U / (m + M). The rest, a share M / (m + M) of W,
  /// stays where the blow lands, and so does what is bent there.
  bool strike(StressAnswer& answer) {
    if (impulses_.empty()) return true;
    int iterations = 0;
    if (!improve(impulses_, Vec3::Zero(), Vec3::Zero(), kBlowTolerance, swing_, iterations, answer))
      return false;
    const auto [work, mass] = memory_->system->response(impulses_, swing_);
    const double striker = work * work / (2 * blow_J_);
    if (!(work > 0) || !(blow_J_ > 0)) return false;
    const double most = std::sqrt(work / (striker + mass));
    const double bent_near =
        memory_->system->energy_J(swing_, load_.blow.center_R, load_.blow.reach_m);
    local_ = (mass + striker * std::min(1.0, 2 * bent_near / work)) / (striker + mass);
    bent_ = memory_->displacements;
    for (std::size_t c = 0; c < bent_.size(); ++c) {
      bent_[c].shift_R += most * swing_[c].shift_R;
      bent_[c].rotation_R += most * swing_[c].rotation_R;
    }
    return true;
  }

  std::span<const Displacement> displacements() const {
    return impulses_.empty() ? memory_->displacements : bent_;
  }

  void note_blow(StressAnswer& answer) const {
    if (impulses_.empty()) return;
    answer.blow.local = local_;
    answer.blow.worst = answer.worst;
    if (worst_ != kNone) answer.blow.worst_R = memory_->system->geometry()[worst_].centroid_R;
  }

  /// The worst bonds of each overloaded region, ascending; of a blow the worst of all, which go
  /// first.
  std::vector<std::uint32_t> overloaded(StressAnswer& answer) {
    std::vector<double> parts(compound_.bonds.size(), 0);
    for_chunks(parts.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) parts[i] = part_of_limit(i);
    });
    const auto most = std::ranges::max_element(parts);
    answer.worst = most == parts.end() ? 0 : *most;
    worst_ = answer.worst > 0 ? static_cast<std::uint32_t>(most - parts.begin()) : kNone;
    const double least = impulses_.empty() ? 1 : std::max(1.0, kAlike * answer.worst);
    std::vector<Bond> too_weak;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (parts[i] <= least) continue;
      too_weak.push_back(compound_.bonds[i]);
      numbers.push_back(i);
    }
    if (numbers.empty()) return {};
    // Overloaded bonds that share a convex are one region.
    const std::vector<std::uint32_t> region = find_islands(compound_.convexes.size(), too_weak);
    const auto region_of = [&](std::uint32_t i) { return region[compound_.bonds[i].a]; };
    std::vector<std::uint32_t> worst(compound_.convexes.size(), kNone);
    for (const std::uint32_t i : numbers) {
      std::uint32_t& most_of_it = worst[region_of(i)];
      if (most_of_it == kNone || parts[i] > parts[most_of_it]) most_of_it = i;
    }
    std::erase_if(numbers, [&](std::uint32_t i) {
      const std::uint32_t most_of_it = worst[region_of(i)];
      return plane_of(i) != plane_of(most_of_it) || parts[i] < kAlike * parts[most_of_it];
    });
    return numbers;
  }

  /// Whether it hangs together no longer.
  bool parted() const { return std::ranges::max(find_islands(compound_)) > 0; }

  std::uint64_t plane_of(std::uint32_t i) const {
    const Bond& bond = compound_.bonds[i];
    return compound_.convexes[bond.a]->polyhedron.faces[bond.face_a].id.value >> 1;
  }

  const Material& material_of(std::uint32_t convex) const {
    return load_.materials[compound_.convexes[convex]->material.value];
  }

  double crack_J(const Bond& bond) const {
    return bond.area_m2 * crack_J_m2(material_of(bond.a), material_of(bond.b));
  }

  double part_of_limit(std::size_t i) const {
    const Bond& bond = compound_.bonds[i];
    const auto number = static_cast<std::uint32_t>(i);
    const Limits limits = limits_of(material_of(bond.a), material_of(bond.b));
    const double most = part_of(memory_->system->bound(number, displacements()), limits);
    if (!(most > kWorthALook)) return most;
    return part_of(memory_->system->stress(compound_, number, displacements()), limits);
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
        blow_J_ -= crack_J(compound_.bonds[i]);
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
  std::vector<ConvexLoad> impulses_;        ///< Of the blow, N·s in place of N.
  double blow_J_;                           ///< Less what the cuts have taken.
  std::vector<Displacement> swing_, bent_;  ///< By the blow; by all at once.
  double local_ = 1;                        ///< Share of the blow's energy.
  std::uint32_t worst_ = kNone;             ///< Bond.
  std::shared_ptr<KnownStress> memory_;
  std::uint64_t most_work_ = 0;
  std::vector<Bond> cut_;
};

}  // namespace

StressAnswer break_by_stress(const Structure& structure, const LoadCase& load) {
  SUNDER_CHECK(!structure.empty());
  return StressBreaks(structure, load).run();
}

}  // namespace sunder::fracture
