#include "fracture/stress/stress_breaks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/open_overlap.h"
#include "fracture/stress/parting.h"
#include "fracture/stress/strength.h"
#include "fracture/stress/stress_memory.h"
#include "fracture/stress/yielding.h"

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
// Iterations that an answer costs besides: the compound and what is known of it are copied, each
// bond and the islands looked at; and so many springs more, however small it is.
constexpr std::uint64_t kAnswerWork = 2, kAnswerSprings = 50;
// Stress at a bond's own corners is at most so many times that of its section: those well below
// the limit need no closer look.
constexpr double kWorthALook = 0.6;
// Estimated stress of an overlap, as a fraction of what it bears, above which it is turned into
// bonds, whose stress is known. Half, as the estimate is within a factor of two.
constexpr double kOpens = 0.5;
// A bond with less than this share of the width squared of the smaller convex bears nothing: it is
// what rounding left of two cuts, and of what hung by it alone no solve would find the stress.
constexpr double kFrail = 1e-4;

/// Stress in parts of the limit.
double part_of(const BondStress& stress, const Strength& limits) {
  return std::max({stress.tension_Pa / limits.tensile_Pa, stress.shear_Pa / limits.shear_Pa,
                   stress.compression_Pa / limits.compressive_Pa});
}

double mises_Pa(const BondStress& stress) {
  const double normal_Pa = std::max(stress.tension_Pa, stress.compression_Pa);
  return std::sqrt(normal_Pa * normal_Pa + 3 * stress.shear_Pa * stress.shear_Pa);
}

constexpr std::uint32_t kNoBond = 0xffffffff;

/// A structure while its bonds are cut.
class StressBreaks {
 public:
  StressBreaks(const Structure& structure, const LoadCase& load)
      : structure_(structure),
        compound_(structure.compound()),
        slots_(structure.slots()),
        load_(load),
        loads_(by_convex(load.loads)),
        impulses_(by_convex(load.blow.impulses)),
        blow_J_(load.blow.energy_J),
        hinged_(slots_.size(), 0) {
    const auto is_frail = [this](const Bond& bond) { return this->is_frail(bond); };
    std::ranges::copy_if(compound_.bonds, std::back_inserter(frail_), is_frail);
    if (!frail_.empty()) std::erase_if(compound_.bonds, is_frail);
    for (std::size_t c = 0; c < slots_.size(); ++c)
      hinged_[c] = std::ranges::binary_search(load.hinged, slots_[c]) ? 1 : 0;
  }

  StressResult run() {
    StressResult answer;
    answer.work = kAnswerWork * (compound_.bonds.size() + kAnswerSprings);
    memory_ = recall(load_.memory.get(), compound_, slots_, load_.materials, answer.work);
    most_work_ =
        std::max(load_.most_work, answer.work + kLeastIterations * memory_->system->work());
    if (!impulses_.empty()) recall_swing();
    bool is_known = true;
    for (int round = 0; round < kRounds; ++round) {
      is_known = solve(answer) && strike(answer);
      if (!is_known) break;
      if (const Ghost* overlap = overloaded_overlap()) {
        if (round == 0) opened_ = *overlap;
        break;  // the bonds that were cut go first
      }
      Yielding yielding = judge(answer);
      if (round == 0) note_blow(answer);
      // What cracks does so first: what yields bears what it did meanwhile.
      std::vector<std::uint32_t> cut = overloaded(yielding, least(answer.worst));
      Flow flow;
      if (cut.empty()) flow = yielding.flow(least(answer.worst));
      if (cut.empty() && flow.bonds.empty()) cut = overloaded(yielding, least(cracking(yielding)));
      answer.work += yielding.work();
      if (!flow.hinges.empty()) cut = std::move(flow.cracks);
      hinges_ = std::move(flow.hinges);
      answer.settled = cut.empty() && hinges_.empty();
      if (answer.settled) break;
      spend(cut);
      std::vector<std::uint32_t> gone;
      std::ranges::merge(cut, flow.bonds, std::back_inserter(gone));
      remove(gone);
      answer.work += memory_->system->edit_work();
      if (!hinges_.empty()) break;  // what moves feels its hinges only in the next step
      if (!impulses_.empty() && parted()) break;  // what is struck is another body now
    }
    if (!impulses_.empty()) note_work(is_known, answer);
    if (!frail_.empty() && (!cut_.empty() || parted()))
      cut_.insert(cut_.end(), frail_.begin(), frail_.end());
    answer.edit = opened_ ? open_overlap(structure_, slots_[opened_->of[0]], slots_[opened_->of[1]])
                          : part(compound_, slots_, cut_, std::move(hinges_));
    memory_->slots = slots_;
    memory_->bonds = compound_.bonds;
    memory_->convexes = compound_.convexes;
    memory_->anchored = compound_.anchored;
    answer.memory = memory_;
    return answer;
  }

  std::vector<float> utilisation(std::size_t slots) {
    StressResult answer;
    memory_ = recall(load_.memory.get(), compound_, slots_, load_.materials, answer.work);
    most_work_ = std::numeric_limits<std::uint64_t>::max();
    solve(answer);
    const std::vector<double> parts = judge(answer).parts();
    std::vector<float> worst(slots, -1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (const std::uint32_t convex : {compound_.bonds[i].a, compound_.bonds[i].b}) {
        float& of_convex = worst[slots_[convex].value];
        of_convex = std::max(of_convex, static_cast<float>(parts[i]));
      }
    }
    return worst;
  }

 private:
  bool is_frail(const Bond& bond) const {
    const double smaller_m3 = std::min(compound_.convexes[bond.a]->solid.volume_m3,
                                       compound_.convexes[bond.b]->solid.volume_m3);
    const double least = kFrail / bond.area_m2;
    return least * least * least * smaller_m3 * smaller_m3 > 1 &&
           (material_of(bond.a).breaks_by_load() || material_of(bond.b).breaks_by_load());
  }

  std::vector<ConvexLoad> by_convex(std::span<const AppliedForce> loads) const {
    std::vector<ConvexLoad> all;
    for (const AppliedForce& one : loads) {
      const auto at = std::lower_bound(slots_.begin(), slots_.end(), one.convex);
      const auto convex = static_cast<std::uint32_t>(at - slots_.begin());
      all.push_back({convex, one.force_N, one.point_R, one.torque_Nm});
    }
    return all;
  }

  /// False if there is no work left, or it is given up.
  bool improve(std::span<const ConvexLoad> loads, const Vec3& gravity_R, const Vec3& spin_R,
               double tolerance, std::vector<Displacement>& displacements, Nodal<double>& way,
               int& iterations, StressResult& answer) {
    const std::uint64_t each = std::max<std::uint64_t>(1, memory_->system->work());
    if (answer.work >= most_work_) return false;
    const auto left = static_cast<int>(
        std::min<std::uint64_t>(kMostIterations, 1 + (most_work_ - answer.work) / each));
    const SolveResult result =
        memory_->system->solve(loads, gravity_R, tolerance, left, displacements, spin_R, &way);
    answer.work += each * static_cast<std::uint64_t>(1 + result.iterations);
    iterations = result.converged ? 0 : iterations + result.iterations;
    return result.converged;
  }

  /// False if the stress of the steady load is not known by now.
  bool solve(StressResult& answer) {
    const bool known = improve(loads_, load_.gravity_R, load_.spin_R, kTolerance,
                               memory_->displacements, memory_->way, memory_->iterations, answer);
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
  /// stays where the blow lands, and so does what is bent there. Where nothing strikes,
  /// as of a blast, m is 0.
  bool strike(StressResult& answer) {
    if (impulses_.empty()) return true;
    std::vector<Displacement>& swing = memory_->swing.displacements;
    int iterations = 0;
    if (!improve(impulses_, Vec3::Zero(), Vec3::Zero(), kBlowTolerance, swing, memory_->swing.way,
                 iterations, answer))
      return false;
    const auto [work, mass] = memory_->system->response(impulses_, swing);
    const double striker = work * work / (2 * blow_J_);
    if (!(work > 0) || !(blow_J_ > 0)) return false;
    const double most = std::sqrt(work / (striker + mass));
    const double bent_near =
        memory_->system->energy_J(swing, load_.blow.center_R, load_.blow.reach_m);
    local_ = (mass + striker * std::min(1.0, 2 * bent_near / work)) / (striker + mass);
    bent_ = memory_->displacements;
    for (std::size_t c = 0; c < bent_.size(); ++c) {
      bent_[c].shift_R += most * swing[c].shift_R;
      bent_[c].rotation_R += most * swing[c].rotation_R;
    }
    return true;
  }

  /// Starts from how the last impact bent the compound if that struck the same convexes.
  void recall_swing() {
    KnownSwing& swing = memory_->swing;
    std::vector<ConvexSlot> struck;
    double impulse_Ns = 0;
    for (const AppliedForce& impulse : load_.blow.impulses) {
      struck.push_back(impulse.convex);
      impulse_Ns += impulse.force_N.norm();
    }
    if (struck != swing.struck || !(swing.impulse_Ns > 0)) {
      swing = {std::move(struck), impulse_Ns, {}, {}, swing.work};
      return;
    }
    const double times = impulse_Ns / std::exchange(swing.impulse_Ns, impulse_Ns);
    if (times == 1) return;
    swing.way.clear();
    for (Displacement& d : swing.displacements) {
      d.shift_R *= times;
      d.rotation_R *= times;
    }
  }

  void note_work(bool is_known, StressResult& answer) {
    std::uint64_t& work = memory_->swing.work;
    const bool ran_out = !is_known && cut_.empty() && answer.work >= most_work_;
    work = ran_out ? work + answer.work : 0;
    answer.undecided = ran_out && work < load_.blow.most_work;
    if (!answer.undecided) work = 0;
  }

  std::span<const Displacement> displacements() const {
    return impulses_.empty() ? memory_->displacements : bent_;
  }

  void note_blow(StressResult& answer) const {
    if (impulses_.empty()) return;
    answer.blow.local = local_;
    answer.blow.worst = answer.worst;
    if (worst_ != kNoBond) answer.blow.worst_R = memory_->system->geometry()[worst_].centroid_R;
  }

  Yielding judge(StressResult& answer) {
    std::vector<double> parts(compound_.bonds.size(), 0);
    for_chunks(parts.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) parts[i] = part_of_limit(i);
    });
    Yielding yielding(compound_, *memory_->system, displacements(), load_.materials, hinged_,
                      std::move(parts));
    const auto most = std::ranges::max_element(yielding.parts());
    answer.worst = most == yielding.parts().end() ? 0 : *most;
    worst_ =
        answer.worst > 0 ? static_cast<std::uint32_t>(most - yielding.parts().begin()) : kNoBond;
    return yielding;
  }

  /// What is worse than this gives way: of a blow the worst goes first.
  double least(double worst) const { return impulses_.empty() ? 1 : std::max(1.0, kAlike * worst); }

  /// Returns the most overloaded overlap of two convexes under a steady load; null if there is
  /// none.
  const Ghost* overloaded_overlap() const {
    if (compound_.ghosts.empty() || !impulses_.empty()) return nullptr;
    const Ghost* worst = nullptr;
    double most = kOpens;
    for (const Ghost& ghost : compound_.ghosts) {
      if (ghost.of.size() != 2) continue;
      const Wrench wrench =
          memory_->system->overlap_wrench(ghost, load_.materials, memory_->displacements);
      double part = overlap_utilisation(compound_, ghost, wrench, load_.materials);
      if (ghost.sign == 0) part *= kOpens;  // no bonds will be found there: it lets go at its limit
      if (part <= most) continue;
      most = part;
      worst = &ghost;
    }
    return worst;
  }

  /// The worst of bonds that do not yield.
  double cracking(const Yielding& yielding) const {
    double worst = 0;
    for (std::uint32_t i = 0; i < compound_.bonds.size(); ++i)
      if (!yielding.yields(i)) worst = std::max(worst, yielding.parts()[i]);
    return worst;
  }

  /// Of bonds that do not yield the worst of each overloaded region, ascending.
  std::vector<std::uint32_t> overloaded(const Yielding& yielding, double least) const {
    const std::vector<double>& parts = yielding.parts();
    std::vector<Bond> too_weak;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (parts[i] <= least || yielding.yields(i)) continue;
      too_weak.push_back(compound_.bonds[i]);
      numbers.push_back(i);
    }
    if (numbers.empty()) return {};
    // Overloaded bonds that share a convex are one region.
    const std::vector<std::uint32_t> region = find_islands(compound_.convexes.size(), too_weak);
    const auto region_of = [&](std::uint32_t i) { return region[compound_.bonds[i].a]; };
    std::vector<std::uint32_t> worst(compound_.convexes.size(), kNoBond);
    for (const std::uint32_t i : numbers) {
      std::uint32_t& most_of_it = worst[region_of(i)];
      if (most_of_it == kNoBond || parts[i] > parts[most_of_it]) most_of_it = i;
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
    return bond.area_m2 * crack_energy_J_m2(material_of(bond.a), material_of(bond.b));
  }

  double part_of_limit(std::size_t i) const {
    const Bond& bond = compound_.bonds[i];
    const auto number = static_cast<std::uint32_t>(i);
    const Material &a = material_of(bond.a), &b = material_of(bond.b);
    const BondStress at_most = memory_->system->bound(number, displacements());
    if (const double flows_Pa = yield_Pa(a, b); flows_Pa > 0) return mises_Pa(at_most) / flows_Pa;
    const Strength limits = weaker_of(a, b);
    const double most = part_of(at_most, limits);
    if (!(most > kWorthALook)) return most;
    return part_of(memory_->system->stress(compound_, number, displacements()), limits);
  }

  /// What cracks takes of the energy of a blow.
  void spend(const std::vector<std::uint32_t>& cut) {
    for (const std::uint32_t i : cut) {
      cut_.push_back(compound_.bonds[i]);
      blow_J_ -= crack_J(compound_.bonds[i]);
    }
  }

  void remove(const std::vector<std::uint32_t>& gone) {
    std::vector<BondGeometry> geometry;
    std::vector<Bond> bonds;
    StressOrigin origin;
    origin.convexes.resize(compound_.convexes.size());
    std::iota(origin.convexes.begin(), origin.convexes.end(), 0u);
    auto next = gone.begin();
    for (std::uint32_t i = 0; i < compound_.bonds.size(); ++i) {
      if (next != gone.end() && *next == i) {
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
    memory_->way.clear();
    memory_->swing.way.clear();
  }

  const Structure& structure_;
  Compound compound_;              ///< Less the bonds that are frail or cut.
  std::vector<ConvexSlot> slots_;  ///< Per convex.
  const LoadCase& load_;
  std::vector<ConvexLoad> loads_;
  std::vector<ConvexLoad> impulses_;  ///< Of the blow, N·s in place of N.
  double blow_J_;                     ///< Less what the cuts have taken.
  std::vector<Displacement> bent_;    ///< By all at once.
  double local_ = 1;                  ///< Share of the blow's energy.
  std::uint32_t worst_ = kNoBond;     ///< Bond.
  std::shared_ptr<KnownStress> memory_;
  std::uint64_t most_work_ = 0;
  std::vector<std::uint8_t> hinged_;  ///< Per convex: beside a hinge.
  std::vector<Bond> cut_, frail_;
  std::optional<Ghost> opened_;
  std::vector<PlasticHinge> hinges_;
};

}  // namespace

StressResult break_by_stress(const Structure& structure, const LoadCase& load) {
  SUNDER_CHECK(!structure.empty());
  return StressBreaks(structure, load).run();
}

std::vector<float> utilisation_by_stress(const Structure& structure, const LoadCase& load) {
  SUNDER_CHECK(!structure.empty());
  return StressBreaks(structure, load).utilisation(structure.slot_count());
}

}  // namespace sunder::fracture
