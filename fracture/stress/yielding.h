// Plastic flow under a load: the sections of bonds that yield, and the overloaded ones that must
// flow together for a part of the compound to come loose.
//
// Read first: Yielding::flow().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/stress/section.h"

namespace sunder::fracture {

/// Sections that separate a compound and hold its parts together as hinges.
struct Flow {
  std::vector<PlasticHinge> hinges;  ///< Bonds by convexes; pieces are not set yet.
  std::vector<std::uint32_t> bonds;  ///< Bonds of the compound that became hinges; ascending.
  /// Bonds of these sections that were under compression and crack; ascending.
  std::vector<std::uint32_t> cracks;
};

/// Plastic analysis of one compound under one load.
class Yielding {
 public:
  /// `utilisations` is the utilisation of each bond: stress over strength, and for bonds that yield
  /// the von Mises stress of the worst fibre over the yield stress. `hinged` is nonzero for
  /// convexes beside a hinge, where no further section is made.
  Yielding(const Compound& compound, const StressSystem& system,
           std::span<const Displacement> displacements, std::span<const Material> materials,
           std::span<const std::uint8_t> hinged, std::vector<double> utilisations);

  bool yields(std::uint32_t bond) const { return sections_.yield_Pa(bond) > 0; }
  /// Returns the utilisation per bond; where its fibres yield, that of its worst section.
  const std::vector<double>& utilisations() const { return utilisations_; }
  /// Returns the sections that flow where some utilisation exceeds `least`: the worst of each
  /// overloaded region, and if these release no part, the next worst anywhere, down to half
  /// utilisation. Returns none if even these release no part: the structure stands.
  Flow flow(double least);
  /// Returns the number of bonds visited.
  std::uint64_t work() const { return work_ + sections_.work(); }

 private:
  void find_sections(double least);
  bool is_usable(const Section& section) const;
  std::vector<std::vector<std::uint32_t>> connected(std::span<const std::uint32_t> sections) const;
  std::vector<std::uint32_t> decisive_sections(double least) const;
  void choose(std::uint32_t section);
  std::vector<std::uint32_t> islands(std::size_t chosen, bool by_world);
  bool separates_a_part(std::size_t chosen);
  void release(std::span<const Crossing> crossings);
  Flow make_flow(std::size_t chosen);
  PlasticHinge hinge(const Section& section) const;
  std::uint32_t behind(const Crossing& crossing) const;
  std::uint32_t ahead(const Crossing& crossing) const;

  const Compound& compound_;
  std::span<const Material> materials_;
  std::span<const std::uint8_t> hinged_;
  Sections sections_;
  std::vector<double> fibre_utilisations_, utilisations_;  ///< Per bond.
  std::vector<std::uint8_t> searched_;
  std::vector<Section> found_;
  std::vector<std::uint32_t> chosen_;   ///< Indices in `found_`, in order; no two share a convex.
  std::vector<std::uint8_t> is_taken_;  ///< Per convex: nonzero if a chosen section has it.
  std::vector<std::uint32_t> place_;    ///< Per bond: index in `chosen_` of its section, or kNone.
  std::uint64_t work_ = 0;
};

}  // namespace sunder::fracture
