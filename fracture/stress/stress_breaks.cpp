#include "fracture/stress/stress_breaks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/open_overlap.h"
#include "fracture/stress/separate_islands.h"
#include "fracture/stress/strength.h"
#include "fracture/stress/stress_memory.h"
#include "fracture/stress/yielding.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Returns stress over strength.
double utilisation_of(const BondStress& stress, const Strength& limits) {
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
        impulses_(by_convex(load.impulsive_load.impulses)),
        impact_J_(load.impulsive_load.energy_J),
        hinged_(slots_.size(), 0) {
    const auto is_negligible = [this](const Bond& bond) { return this->is_negligible(bond); };
    std::ranges::copy_if(compound_.bonds, std::back_inserter(negligible_), is_negligible);
    if (!negligible_.empty()) std::erase_if(compound_.bonds, is_negligible);
    for (std::size_t c = 0; c < slots_.size(); ++c)
      hinged_[c] = std::ranges::binary_search(load.hinged, slots_[c]) ? 1 : 0;
  }

  StressResult run() {
    StressResult answer;
    answer.work = kOverheadIterations * (compound_.bonds.size() + kOverheadSprings);
    memory_ = recall(load_.memory.get(), compound_, slots_, load_.materials, answer.work);
    most_work_ =
        std::max(load_.most_work, answer.work + kMinStressIterations * memory_->system->work());
    if (!impulses_.empty()) recall_deflection();
    bool is_known = true;
    for (int round = 0; round < kMaxStressRounds; ++round) {
      is_known = solve(answer) && add_impact(answer);
      if (!is_known) break;
      Yielding yielding = analyse(answer);
      if (round == 0) record_impact_stress(answer);
      // Cracks come first: until then, bonds that yield bear their load.
      std::vector<std::uint32_t> cut = find_overloaded(yielding, cut_threshold(answer.worst));
      Flow flow;
      if (cut.empty()) flow = yielding.flow(cut_threshold(answer.worst));
      if (cut.empty() && flow.bonds.empty())
        cut = find_overloaded(yielding, cut_threshold(worst_cracking(yielding)));
      answer.work += yielding.work();
      if (!flow.hinges.empty()) cut = std::move(flow.cracks);
      hinges_ = std::move(flow.hinges);
      answer.settled = cut.empty() && hinges_.empty();
      if (answer.settled) {
        // Overlaps open last: cracks and bonds that yield relieve them.
        answer.settled = !open_overloaded_overlap(round);
        break;
      }
      record_cracks(cut);
      std::vector<std::uint32_t> gone;
      std::ranges::merge(cut, flow.bonds, std::back_inserter(gone));
      remove(gone);
      answer.work += memory_->system->edit_work();
      if (!hinges_.empty()) break;  // Hinges act on bodies only in the next step.
      if (!impulses_.empty() && is_disconnected()) break;  // The struck body is another one now.
    }
    if (!impulses_.empty()) record_impact_work(is_known, answer);
    if (!negligible_.empty() && (!cut_.empty() || is_disconnected()))
      cut_.insert(cut_.end(), negligible_.begin(), negligible_.end());
    answer.edit = opening_.changed ? std::move(opening_)
                                   : separate_islands(compound_, slots_, cut_, std::move(hinges_));
    memory_->slots = slots_;
    memory_->bonds = compound_.bonds;
    memory_->ghosts = compound_.ghosts.size();
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
    const std::vector<double> utilisations = analyse(answer).utilisations();
    std::vector<float> worst(slots, -1);
    for (std::size_t i = 0; i < utilisations.size(); ++i) {
      for (const std::uint32_t convex : {compound_.bonds[i].a, compound_.bonds[i].b}) {
        float& of_convex = worst[slots_[convex].value];
        of_convex = std::max(of_convex, static_cast<float>(utilisations[i]));
      }
    }
    return worst;
  }

 private:
  bool is_negligible(const Bond& bond) const {
    const double smaller_m3 = std::min(compound_.convexes[bond.a]->solid.volume_m3,
                                       compound_.convexes[bond.b]->solid.volume_m3);
    const double least = kNegligibleBond / bond.area_m2;
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

  /// Continues a solve; returns false if there is no work left, or the solve was abandoned.
  bool improve(std::span<const ConvexLoad> loads, const Vec3& gravity_R, const Vec3& spin_R,
               double tolerance, std::vector<Displacement>& displacements,
               Nodal<double>& last_direction, int& iterations, StressResult& answer) {
    const std::uint64_t each = std::max<std::uint64_t>(1, memory_->system->work());
    if (answer.work >= most_work_) return false;
    const auto left = static_cast<int>(
        std::min<std::uint64_t>(kMaxStressIterations, 1 + (most_work_ - answer.work) / each));
    const SolveResult result = memory_->system->solve(loads, gravity_R, tolerance, left,
                                                      displacements, spin_R, &last_direction);
    answer.work += each * static_cast<std::uint64_t>(1 + result.iterations);
    iterations = result.converged ? 0 : iterations + result.iterations;
    return result.converged;
  }

  /// Solves for the steady load; returns false if its stress is not known yet.
  bool solve(StressResult& answer) {
    const bool known =
        improve(loads_, load_.gravity_R, load_.spin_R, kStressTolerance, memory_->displacements,
                memory_->last_direction, memory_->iterations, answer);
    answer.settled = answer.gave_up = memory_->iterations >= kMaxStressIterations;
    return known;
  }

  /// Adds the greatest deflection under the impact load to that under the steady load; returns
  /// false if that is not known.
  ///
  /// The structure deflects in the shape u that the impulses, taken as static forces, would cause;
  /// their work on u is 2U. Moving at a rate q of this shape, the structure has the kinetic energy
  /// ½Mq², with M = Σ m u², and the striker ½mq², where m follows from the work of the impulses, W
  /// = (2U)² / 2m. Cox (1849): both move on together and deflect the structure by at most λu, when
  /// all of that energy is strain energy: λ² = 2U / (m + M). The rest of W, a share M / (m + M),
  /// stays near the impact, and so does the strain energy there. Without a striker, as in a blast,
  /// m is 0.
  bool add_impact(StressResult& answer) {
    if (impulses_.empty()) return true;
    std::vector<Displacement>& deflection = memory_->deflection.displacements;
    int iterations = 0;
    if (!improve(impulses_, Vec3::Zero(), Vec3::Zero(), kImpactStressTolerance, deflection,
                 memory_->deflection.last_direction, iterations, answer)) {
      answer.gave_up |= iterations >= kMaxStressIterations;
      return false;
    }
    const auto [work, mass] = memory_->system->response(impulses_, deflection);
    const double striker = work * work / (2 * impact_J_);
    if (!(work > 0) || !(impact_J_ > 0)) return false;
    const double most = std::sqrt(work / (striker + mass));
    const double bent_near = memory_->system->energy_J(deflection, load_.impulsive_load.center_R,
                                                       load_.impulsive_load.reach_m);
    local_share_ = (mass + striker * std::min(1.0, 2 * bent_near / work)) / (striker + mass);
    combined_ = memory_->displacements;
    for (std::size_t c = 0; c < combined_.size(); ++c) {
      combined_[c].shift_R += most * deflection[c].shift_R;
      combined_[c].rotation_R += most * deflection[c].rotation_R;
    }
    return true;
  }

  /// Starts from the deflection of the last impact if that struck the same convexes.
  void recall_deflection() {
    KnownDeflection& deflection = memory_->deflection;
    std::vector<ConvexSlot> struck;
    double impulse_Ns = 0;
    for (const AppliedForce& impulse : load_.impulsive_load.impulses) {
      struck.push_back(impulse.convex);
      impulse_Ns += impulse.force_N.norm();
    }
    if (struck != deflection.struck || !(deflection.impulse_Ns > 0)) {
      deflection = {std::move(struck), impulse_Ns, {}, {}, deflection.work};
      return;
    }
    const double times = impulse_Ns / std::exchange(deflection.impulse_Ns, impulse_Ns);
    if (times == 1) return;
    deflection.last_direction.clear();
    for (Displacement& d : deflection.displacements) {
      d.shift_R *= times;
      d.rotation_R *= times;
    }
  }

  void record_impact_work(bool is_known, StressResult& answer) {
    std::uint64_t& work = memory_->deflection.work;
    const bool ran_out = !is_known && cut_.empty() && answer.work >= most_work_;
    work = ran_out ? work + answer.work : 0;
    answer.undecided = ran_out && work < load_.impulsive_load.most_work;
    if (!answer.undecided) work = 0;
    answer.gave_up = !answer.undecided && (answer.gave_up || ran_out);
  }

  std::span<const Displacement> displacements() const {
    return impulses_.empty() ? memory_->displacements : combined_;
  }

  void record_impact_stress(StressResult& answer) const {
    if (impulses_.empty()) return;
    answer.impulsive_stress.local = local_share_;
    answer.impulsive_stress.worst = answer.worst;
    if (worst_ != kNoBond)
      answer.impulsive_stress.worst_R = memory_->system->geometry()[worst_].centroid_R;
  }

  Yielding analyse(StressResult& answer) {
    std::vector<double> utilisations(compound_.bonds.size(), 0);
    for_chunks(utilisations.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) utilisations[i] = bond_utilisation(i);
    });
    Yielding yielding(compound_, *memory_->system, displacements(), load_.materials, hinged_,
                      std::move(utilisations));
    const auto most = std::ranges::max_element(yielding.utilisations());
    answer.worst = most == yielding.utilisations().end() ? 0 : *most;
    worst_ = answer.worst > 0 ? static_cast<std::uint32_t>(most - yielding.utilisations().begin())
                              : kNoBond;
    return yielding;
  }

  /// Returns the utilisation above which bonds give way: of an impact load the worst go first.
  double cut_threshold(double worst) const {
    return impulses_.empty() ? 1 : std::max(1.0, kSimilarStress * worst);
  }

  /// Opens the most overloaded overlap, if there is one that can be opened; returns false if there
  /// is none. Bonds that were cut in earlier rounds are applied first.
  bool open_overloaded_overlap(int round) {
    const Ghost* overlap = overloaded_overlap();
    if (overlap == nullptr) return false;
    if (round > 0) return true;
    opening_ = open_overlap(structure_, slots_[overlap->of[0]], slots_[overlap->of[1]]);
    return opening_.changed;
  }

  /// Returns the most overloaded overlap of two convexes under a steady load; may be null.
  const Ghost* overloaded_overlap() const {
    if (compound_.ghosts.empty() || !impulses_.empty()) return nullptr;
    const Ghost* worst = nullptr;
    double most = kOpeningUtilisation;
    for (const Ghost& ghost : compound_.ghosts) {
      if (ghost.of.size() != 2) continue;
      const Wrench wrench =
          memory_->system->overlap_wrench(ghost, load_.materials, memory_->displacements);
      double part = overlap_utilisation(compound_, ghost, wrench, load_.materials);
      // A surface convex gets no bonds there, so the overlap opens at its limit.
      if (ghost.sign == 0) part *= kOpeningUtilisation;
      if (part <= most) continue;
      most = part;
      worst = &ghost;
    }
    return worst;
  }

  /// Returns the greatest utilisation of bonds that do not yield.
  double worst_cracking(const Yielding& yielding) const {
    double worst = 0;
    for (std::uint32_t i = 0; i < compound_.bonds.size(); ++i)
      if (!yielding.yields(i)) worst = std::max(worst, yielding.utilisations()[i]);
    return worst;
  }

  /// Returns the worst bonds of each overloaded region, without those that yield; ascending.
  std::vector<std::uint32_t> find_overloaded(const Yielding& yielding, double least) const {
    const std::vector<double>& utilisations = yielding.utilisations();
    std::vector<Bond> too_weak;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < utilisations.size(); ++i) {
      if (utilisations[i] <= least || yielding.yields(i)) continue;
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
      if (most_of_it == kNoBond || utilisations[i] > utilisations[most_of_it]) most_of_it = i;
    }
    std::erase_if(numbers, [&](std::uint32_t i) {
      const std::uint32_t most_of_it = worst[region_of(i)];
      return plane_of(i) != plane_of(most_of_it) ||
             utilisations[i] < kSimilarStress * utilisations[most_of_it];
    });
    return numbers;
  }

  /// Returns true if the compound is no longer connected.
  bool is_disconnected() const { return std::ranges::max(find_islands(compound_)) > 0; }

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

  double bond_utilisation(std::size_t i) const {
    const Bond& bond = compound_.bonds[i];
    const auto number = static_cast<std::uint32_t>(i);
    const Material &a = material_of(bond.a), &b = material_of(bond.b);
    const BondStress at_most = memory_->system->bound(number, displacements());
    if (const double flows_Pa = yield_Pa(a, b); flows_Pa > 0) return mises_Pa(at_most) / flows_Pa;
    const Strength limits = weaker_of(a, b);
    const double most = utilisation_of(at_most, limits);
    if (!(most > kMinExactUtilisation)) return most;
    return utilisation_of(memory_->system->stress(compound_, number, displacements()), limits);
  }

  /// Records cracked bonds and subtracts their crack energy from that of the impact.
  void record_cracks(const std::vector<std::uint32_t>& cut) {
    for (const std::uint32_t i : cut) {
      cut_.push_back(compound_.bonds[i]);
      impact_J_ -= crack_J(compound_.bonds[i]);
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
    memory_->last_direction.clear();
    memory_->deflection.last_direction.clear();
  }

  const Structure& structure_;
  Compound compound_;              ///< Without negligible and cut bonds.
  std::vector<ConvexSlot> slots_;  ///< Per convex.
  const LoadCase& load_;
  std::vector<ConvexLoad> loads_;
  std::vector<ConvexLoad> impulses_;    ///< Impulses of the impact, with N·s in place of N.
  double impact_J_;                     ///< Impact energy without that of the cuts.
  std::vector<Displacement> combined_;  ///< Steady load and impact together.
  double local_share_ = 1;              ///< Share of the impact energy that stays near the impact.
  std::uint32_t worst_ = kNoBond;       ///< Index of the worst bond.
  std::shared_ptr<KnownStress> memory_;
  std::uint64_t most_work_ = 0;
  std::vector<std::uint8_t> hinged_;  ///< Per convex: nonzero beside a hinge.
  std::vector<Bond> cut_, negligible_;
  BreakEdit opening_;  ///< Edit that opens an overlap.
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
