// What flows under a load: the sections of bonds that yield, and as many of those that the load
// overloads as it takes for a part of the compound to come loose.
//
// Read first: Yielding::flow().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/stress/section.h"

namespace sunder::fracture {

/// Sections that part a compound, and hold its parts together as hinges.
struct Flow {
  std::vector<PlasticHinge> hinges;   ///< Their bonds by convexes; their pieces are not known yet.
  std::vector<std::uint32_t> bonds;   ///< Of the compound, that went into them; ascending.
  std::vector<std::uint32_t> cracks;  ///< Bonds beside these that were pressed: likewise.
};

/// The judgement of one compound under one load.
class Yielding {
 public:
  /// `parts` has the stress on each bond in parts of its limit: of one that yields, that of its
  /// worst fibre, von Mises'. Where `hinged`, per convex, a hinge is already: no section is there.
  Yielding(const Compound& compound, const StressSystem& system,
           std::span<const Displacement> displacements, std::span<const Material> materials,
           std::span<const std::uint8_t> hinged, std::vector<double> parts);

  bool yields(std::uint32_t bond) const { return sections_.yield_Pa(bond) > 0; }
  /// The same, but of bonds whose fibres yield that of their worst section.
  const std::vector<double>& parts() const { return parts_; }
  /// What gives way where some section bears more than `least`: of each region that is overloaded
  /// its worst, and where these let nothing come loose the next worst anywhere, down to half of
  /// what they bear. Nothing if even these do not: then it stands.
  Flow flow(double least);
  /// Visits of bonds.
  std::uint64_t work() const { return work_ + sections_.work(); }

 private:
  void look(double least);
  bool is_usable(const Section& section) const;
  std::vector<std::vector<std::uint32_t>> connected(std::span<const std::uint32_t> sections) const;
  std::vector<std::uint32_t> decisive(double least) const;
  void choose(std::uint32_t section);
  std::vector<std::uint32_t> islands(std::size_t chosen, bool by_world);
  bool comes_loose(std::size_t chosen);
  void put_back(std::span<const Crossing> crossings);
  Flow part(std::size_t chosen);
  PlasticHinge hinge(const Section& section) const;
  std::uint32_t behind(const Crossing& crossing) const;
  std::uint32_t ahead(const Crossing& crossing) const;

  const Compound& compound_;
  std::span<const Material> materials_;
  std::span<const std::uint8_t> hinged_;
  Sections sections_;
  std::vector<double> fibres_, parts_;  ///< Per bond.
  std::vector<std::uint8_t> looked_at_;
  std::vector<Section> found_;
  std::vector<std::uint32_t> chosen_;  ///< Of those found, in order; none shares a convex.
  std::vector<std::uint8_t> taken_;    ///< Per convex: whether it is one of theirs.
  std::vector<std::uint32_t> place_;   ///< Per bond: where in `chosen_` its section is, or kNone.
  std::uint64_t work_ = 0;
};

}  // namespace sunder::fracture
