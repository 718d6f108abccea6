#include "fracture/stress/yielding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/roots.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/bond_geometry.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

constexpr double kGauge = 5.65;  // Gauge length over √A, for elongation (ISO 6892-1).
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Yielding::Yielding(const Compound& compound, const StressSystem& system,
                   std::span<const Displacement> displacements, std::span<const Material> materials,
                   std::span<const std::uint8_t> hinged, std::vector<double> utilisations)
    : compound_(compound),
      materials_(materials),
      hinged_(hinged),
      sections_(compound, system, displacements, materials),
      fibre_utilisations_(std::move(utilisations)),
      utilisations_(fibre_utilisations_),
      searched_(fibre_utilisations_.size(), 0) {
  find_sections(kMinFibreUtilisation);
}

/// Finds the sections of bonds whose fibre utilisation exceeds `least`, worst first; bonds in a
/// section found before are skipped.
void Yielding::find_sections(double least) {
  std::vector<std::uint32_t> bonds;
  for (std::uint32_t i = 0; i < fibre_utilisations_.size(); ++i)
    if (fibre_utilisations_[i] > least && !searched_[i] && yields(i)) bonds.push_back(i);
  for (const std::uint32_t i : bonds) utilisations_[i] = 0;
  std::ranges::stable_sort(bonds, std::ranges::greater{},
                           [&](auto i) { return fibre_utilisations_[i]; });
  for (const std::uint32_t i : bonds) {
    if (searched_[i]) continue;
    searched_[i] = 1;
    Section section = sections_.at(i);
    if (!is_usable(section)) continue;
    for (const Crossing& crossing : section.crossings) {
      if (fibre_utilisations_[crossing.bond] <= least) continue;
      double& worst = utilisations_[crossing.bond];
      worst = std::max(worst, section.utilisation);
      if (sections_.normal_cosine(crossing.bond, section.normal_R()) > kCoveredBondCosine)
        searched_[crossing.bond] = 1;
    }
    found_.push_back(std::move(section));
  }
}

bool Yielding::is_usable(const Section& section) const {
  return !section.crossings.empty() &&
         std::ranges::none_of(section.crossings, [&](const Crossing& crossing) {
           return hinged_[behind(crossing)] != 0 || hinged_[ahead(crossing)] != 0;
         });
}

std::uint32_t Yielding::behind(const Crossing& crossing) const {
  const Bond& bond = compound_.bonds[crossing.bond];
  return crossing.forward ? bond.a : bond.b;
}

std::uint32_t Yielding::ahead(const Crossing& crossing) const {
  const Bond& bond = compound_.bonds[crossing.bond];
  return crossing.forward ? bond.b : bond.a;
}

/// Returns groups of sections that are connected by common convexes; all in the given order.
std::vector<std::vector<std::uint32_t>> Yielding::connected(
    std::span<const std::uint32_t> sections) const {
  DisjointSets sets(sections.size());
  std::vector<std::uint32_t> first(compound_.convexes.size(), kNone);
  for (std::uint32_t k = 0; k < sections.size(); ++k) {
    for (const Crossing& crossing : found_[sections[k]].crossings) {
      for (const std::uint32_t c : {behind(crossing), ahead(crossing)}) {
        if (first[c] == kNone) first[c] = k;
        sets.join(first[c], k);
      }
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  for (std::uint32_t k = 0; k < sections.size(); ++k) groups[sets.root(k)].push_back(sections[k]);
  std::vector<std::vector<std::uint32_t>> all;
  for (auto& [root, group] : groups) all.push_back(std::move(group));
  return all;
}

/// Returns the worst section of each overloaded region. Where axial force governs, many sections of
/// a member are alike: the middle one of these is returned, and under compression the first and the
/// last as well, as a column that buckles needs three hinges.
std::vector<std::uint32_t> Yielding::decisive_sections(double least) const {
  std::vector<std::uint32_t> over, result;
  for (std::uint32_t s = 0; s < found_.size(); ++s)
    if (found_[s].utilisation > least) over.push_back(s);
  for (const std::vector<std::uint32_t>& region : connected(over)) {
    const std::uint32_t worst = *std::ranges::max_element(
        region, {}, [&](std::uint32_t s) { return found_[s].utilisation; });
    const Section& deciding = found_[worst];
    const double axial = relative_load(deciding.strength, deciding.wrench_R).axial;
    if (axial * axial <= 0.5) {
      result.push_back(worst);
      continue;
    }
    const Vec3 normal_R = deciding.normal_R();
    std::vector<std::uint32_t> alike;
    for (const std::uint32_t s : region)
      if (found_[s].utilisation >= kSimilarSectionShare * deciding.utilisation &&
          std::abs(found_[s].normal_R().dot(normal_R)) > kSimilarSectionCosine)
        alike.push_back(s);
    for (std::vector<std::uint32_t>& member : connected(alike)) {
      if (std::ranges::find(member, worst) == member.end()) continue;
      std::ranges::stable_sort(member, {},
                               [&](std::uint32_t s) { return normal_R.dot(found_[s].centroid_R); });
      if (axial < 0) result.insert(result.end(), {member.front(), member.back()});
      result.push_back(member[member.size() / 2]);
    }
  }
  return result;
}

/// Chooses a section unless one chosen before shares a convex with it.
void Yielding::choose(std::uint32_t section) {
  const std::vector<Crossing>& crossings = found_[section].crossings;
  for (const Crossing& crossing : crossings)
    if (is_taken_[behind(crossing)] || is_taken_[ahead(crossing)]) return;
  for (const Crossing& crossing : crossings) {
    is_taken_[behind(crossing)] = is_taken_[ahead(crossing)] = 1;
    place_[crossing.bond] = static_cast<std::uint32_t>(chosen_.size());
  }
  for (const std::uint32_t bond : found_[section].compressed)
    place_[bond] = std::min(place_[bond], static_cast<std::uint32_t>(chosen_.size()));
  chosen_.push_back(section);
}

/// Returns the islands without the first `chosen` sections; `by_world` joins anchored convexes.
std::vector<std::uint32_t> Yielding::islands(std::size_t chosen, bool by_world) {
  std::vector<Bond> links;
  for (std::size_t i = 0; i < compound_.bonds.size(); ++i)
    if (place_[i] >= chosen) links.push_back(compound_.bonds[i]);
  for (const Ghost& ghost : compound_.ghosts)
    for (const std::uint32_t c : ghost.of) links.push_back({ghost.of[0], c, 0, 0, 0});
  std::uint32_t anchored = kNone;
  for (std::uint32_t c = 0; by_world && c < compound_.anchored.size(); ++c) {
    if (!compound_.anchored[c]) continue;
    if (anchored != kNone) links.push_back({anchored, c, 0, 0, 0});
    anchored = c;
  }
  work_ += links.size();
  return find_islands(compound_.convexes.size(), links);
}

bool Yielding::separates_a_part(std::size_t chosen) {
  const std::vector<std::uint32_t> island = islands(chosen, true);
  for (std::size_t i = 0; i < compound_.bonds.size(); ++i) {
    const Bond& bond = compound_.bonds[i];
    if (place_[i] < chosen && island[bond.a] != island[bond.b]) return true;
  }
  return false;
}

Flow Yielding::flow(double least) {
  is_taken_.assign(compound_.convexes.size(), 0);
  place_.assign(compound_.bonds.size(), kNone);
  for (const std::uint32_t section : decisive_sections(least)) choose(section);
  std::size_t few = chosen_.size();
  if (few == 0) return {};
  if (separates_a_part(few)) return make_flow(few);
  find_sections(kMinSectionUtilisation * kMinFibreUtilisation);
  std::vector<std::uint32_t> rank(found_.size());
  std::iota(rank.begin(), rank.end(), 0u);
  std::erase_if(rank,
                [&](std::uint32_t s) { return found_[s].utilisation < kMinSectionUtilisation; });
  std::ranges::stable_sort(rank, std::ranges::greater{},
                           [&](std::uint32_t s) { return found_[s].utilisation; });
  for (const std::uint32_t section : rank) choose(section);
  std::size_t many = chosen_.size();
  if (!separates_a_part(many)) return {};
  while (many - few > 1) {
    const std::size_t middle = (few + many) / 2;
    (separates_a_part(middle) ? many : few) = middle;
  }
  return make_flow(many);
}

void Yielding::release(std::span<const Crossing> crossings) {
  for (const Crossing& crossing : crossings) place_[crossing.bond] = kNone;
}

/// Returns the flow of the first `chosen` sections, without bonds that separate nothing or would
/// bear nothing alone. A section between several pieces becomes several hinges.
Flow Yielding::make_flow(std::size_t chosen) {
  Flow flow;
  for (bool again = true; again;) {
    again = false;
    flow = {};
    const std::vector<std::uint32_t> loose = islands(chosen, true);
    for (std::size_t i = 0; i < compound_.bonds.size(); ++i)
      if (loose[compound_.bonds[i].a] == loose[compound_.bonds[i].b]) place_[i] = kNone;
    const std::vector<std::uint32_t> island = islands(chosen, false);
    for (std::size_t k = 0; k < chosen; ++k) {
      const Section& section = found_[chosen_[k]];
      for (const std::uint32_t bond : section.compressed)
        if (place_[bond] == k) flow.cracks.push_back(bond);
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Crossing>> between;
      for (const Crossing& crossing : section.crossings) {
        if (place_[crossing.bond] == kNone) continue;
        between[{island[behind(crossing)], island[ahead(crossing)]}].push_back(crossing);
        flow.bonds.push_back(crossing.bond);
      }
      for (const auto& [pieces, crossings] : between) {
        const Section part = sections_.make_section(crossings, section.normal_R());
        if (part.crossings.empty()) {
          release(crossings);
          again = true;
        } else {
          flow.hinges.push_back(hinge(part));
        }
      }
    }
  }
  std::ranges::sort(flow.bonds);
  std::ranges::sort(flow.cracks);
  return flow;
}

PlasticHinge Yielding::hinge(const Section& section) const {
  PlasticHinge hinge;
  hinge.section.centroid_R = section.centroid_R;
  hinge.section.strength = section.strength;
  hinge.section.gauge_m = kGauge * std::sqrt(section.area_m2);
  const Material* weakest = nullptr;
  for (const Crossing& crossing : section.crossings) {
    const Bond& bond = compound_.bonds[crossing.bond];
    for (const Vec3& corner : bond_corners(compound_, bond)) {
      const Vec3 arm = section.strength.axes_R.transpose() * (corner - section.centroid_R);
      const Vec3 across(hypotenuse(arm.y(), arm.z()), std::abs(arm.z()), std::abs(arm.y()));
      hinge.section.reach_m = hinge.section.reach_m.cwiseMax(across);
    }
    for (const std::uint32_t c : {bond.a, bond.b}) {
      const Material& material = materials_[compound_.convexes[c]->material.value];
      if (!material.yields()) continue;  // The material has no strength limit.
      if (!weakest || material.yield_Pa < weakest->yield_Pa) weakest = &material;
    }
    hinge.bonds.push_back(
        crossing.forward ? bond : Bond{bond.b, bond.a, bond.face_b, bond.face_a, bond.area_m2});
  }
  hinge.section.yield_Pa = weakest->yield_Pa;
  hinge.section.hardening_Pa = weakest->hardening_Pa;
  hinge.section.elongation = weakest->elongation;
  return hinge;
}

}  // namespace sunder::fracture
