#include "fracture/stress/stress_memory.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "engine/base/parallel.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

auto key_of(const Bond& bond) { return std::tie(bond.a, bond.b, bond.face_a, bond.face_b); }

constexpr std::uint32_t kNew = StressOrigin::kNew;

/// Returns the indices of a compound's convexes and bonds in an older state; few are known if that
/// is not a state of the same structure.
StressOrigin origin_in(const KnownStress& old, const Compound& compound,
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
    while (next < old.bonds.size() && key_of(old.bonds[next]) < key_of(bond)) ++next;
    if (next == old.bonds.size() || key_of(old.bonds[next]) != key_of(bond)) continue;
    origin.bonds.back() = next;
  }
  return origin;
}

/// Makes the state of a compound from that of an earlier one.
class MemoryUpdate {
 public:
  MemoryUpdate(const Compound& compound, const std::vector<ConvexSlot>& slots,
               std::span<const Material> materials)
      : compound_(compound), slots_(slots), materials_(materials) {}

  /// Makes the state from `old`, which may be null; adds the cost to `work`.
  std::shared_ptr<KnownStress> run(const KnownStress* old, std::uint64_t& work) {
    known_->displacements.resize(compound_.convexes.size());
    if (old && old->system && edit_system(*old)) {
      work += known_->system->edit_work();
    } else {
      make_system(old);
      work += known_->system->set_up_work();
    }
    return known_;
  }

 private:
  /// Returns false if too little of the old system is left.
  bool edit_system(const KnownStress& old) {
    const StressOrigin origin = origin_in(old, compound_, slots_);
    const auto known = std::ranges::count_if(origin.convexes, [](auto was) { return was != kNew; });
    if (static_cast<double>(known) < kMinKnownShare * static_cast<double>(old.slots.size()))
      return false;
    for (std::size_t c = 0; c < origin.convexes.size(); ++c) {
      if (origin.convexes[c] != kNew) {
        known_->displacements[c] = old.displacements[origin.convexes[c]];
      }
    }
    std::vector<BondGeometry> geometry;
    for (std::size_t i = 0; i < origin.bonds.size(); ++i) {
      geometry.push_back(origin.bonds[i] != kNew ? old.system->geometry()[origin.bonds[i]]
                                                 : bond_geometry(compound_, compound_.bonds[i]));
    }
    known_->system = std::make_shared<const StressSystem>(*old.system, compound_,
                                                          std::move(geometry), materials_, origin);
    return true;
  }

  void make_system(const KnownStress* old) {
    std::vector<BondGeometry> geometry(compound_.bonds.size());
    std::vector<std::uint32_t> old_of_new(compound_.convexes.size(), kNew);
    if (old) {
      old_of_new = numbers_in(*old);
      for (std::uint32_t c = 0; c < old_of_new.size(); ++c) {
        if (old_of_new[c] != kNew) known_->displacements[c] = old->displacements[old_of_new[c]];
      }
    }
    for_chunks(geometry.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const BondGeometry* known = old ? known_geometry(*old, old_of_new, i) : nullptr;
        geometry[i] = known ? *known : bond_geometry(compound_, compound_.bonds[i]);
      }
    });
    known_->system = std::make_shared<const StressSystem>(
        compound_, std::move(geometry), materials_, StressSystem::spare_nodes(compound_));
  }

  /// Returns the index of each convex in `old`, or kNew. Sorts the convexes of the compound, as
  /// these are few if it came off a large structure.
  std::vector<std::uint32_t> numbers_in(const KnownStress& old) const {
    std::vector<std::pair<const Convex*, std::uint32_t>> sought;
    for (std::uint32_t c = 0; c < compound_.convexes.size(); ++c)
      sought.emplace_back(compound_.convexes[c].get(), c);
    std::ranges::sort(sought);
    std::vector<std::uint32_t> numbers(sought.size(), kNew);
    for (std::uint32_t was = 0; was < old.convexes.size(); ++was) {
      const Convex* convex = old.convexes[was].get();
      const auto at =
          std::ranges::lower_bound(sought, convex, {}, &decltype(sought)::value_type::first);
      if (at != sought.end() && at->first == convex) numbers[at->second] = was;
    }
    return numbers;
  }

  const BondGeometry* known_geometry(const KnownStress& old,
                                     const std::vector<std::uint32_t>& old_of_new,
                                     std::size_t i) const {
    Bond bond = compound_.bonds[i];
    bond.a = old_of_new[bond.a];
    bond.b = old_of_new[bond.b];
    if (bond.a == kNew || bond.b == kNew || bond.a > bond.b) return nullptr;
    const auto at =
        std::lower_bound(old.bonds.begin(), old.bonds.end(), bond,
                         [](const Bond& x, const Bond& y) { return key_of(x) < key_of(y); });
    if (at == old.bonds.end() || key_of(*at) != key_of(bond)) return nullptr;
    return &old.system->geometry()[static_cast<std::size_t>(at - old.bonds.begin())];
  }

  const Compound& compound_;
  const std::vector<ConvexSlot>& slots_;
  std::span<const Material> materials_;
  std::shared_ptr<KnownStress> known_ = std::make_shared<KnownStress>();
};

}  // namespace

const char* KnownStress::wrong_field() const {
  if (std::ranges::count(convexes, nullptr) > 0) return "convexes";
  if (displacements.size() != convexes.size()) return "displacements";
  if (iterations < 0) return "iterations";
  if (!system) {
    if (!slots.empty() || !anchored.empty() || !bonds.empty()) return "system";
    return last_direction.empty() && deflection.displacements.empty() &&
                   deflection.last_direction.empty()
               ? nullptr
               : "last_direction";
  }
  if (!system->fits(convexes.size(), bonds.size())) return "system";
  if (slots.size() != convexes.size() || !std::ranges::is_sorted(slots, std::less_equal()))
    return "slots";
  if (anchored.size() != convexes.size()) return "anchored";
  for (const Bond& bond : bonds)
    if (bond.a >= bond.b || bond.b >= convexes.size()) return "bonds";
  const auto is_direction = [&](const Nodal<double>& direction) {
    return direction.empty() || direction.size() == system->directions();
  };
  if (!is_direction(last_direction)) return "last_direction";
  const std::size_t deflected = deflection.displacements.size();
  if (deflected != 0 && deflected != convexes.size()) return "deflection";
  return is_direction(deflection.last_direction) ? nullptr : "deflection";
}

std::vector<StressCachePtr> KnownStress::divide(std::span<const Structure* const> pieces) const {
  std::vector<std::shared_ptr<KnownStress>> parts(pieces.size());
  std::vector<std::pair<const Convex*, std::size_t>> owners;  // pieces by convex
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (pieces[p]->size() >= kMinKnownShare * static_cast<double>(convexes.size())) continue;
    parts[p] = std::make_shared<KnownStress>();
    pieces[p]->for_each([&](ConvexSlot, const Convex& convex) { owners.emplace_back(&convex, p); });
  }
  std::ranges::sort(owners);
  for (std::size_t c = 0; c < convexes.size(); ++c) {
    const auto owner =
        std::ranges::lower_bound(owners, std::pair(convexes[c].get(), std::size_t{0}));
    if (owner == owners.end() || owner->first != convexes[c].get()) continue;
    parts[owner->second]->convexes.push_back(convexes[c]);
    parts[owner->second]->displacements.push_back(displacements[c]);
  }
  return {parts.begin(), parts.end()};
}

std::shared_ptr<KnownStress> recall(const StressCache* memory, const Compound& compound,
                                    const std::vector<ConvexSlot>& slots,
                                    std::span<const Material> materials, std::uint64_t& work) {
  const auto* old = dynamic_cast<const KnownStress*>(memory);
  if (old && old->is_of(compound)) return std::make_shared<KnownStress>(*old);
  return MemoryUpdate(compound, slots, materials).run(old, work);
}

}  // namespace sunder::fracture
