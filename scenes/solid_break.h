// Breaks one solid once by a pattern, as `sunder fracture` does, without a world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/model/compound.h"
#include "engine/model/material.h"
#include "fracture/pattern_breaker.h"

namespace sunder::scenes {

/// Returns the finite numbers of a text such as "1,2.5,3"; none if it has anything else.
std::vector<double> numbers_in(std::string_view text, char between);
/// The syntax of parse_pattern().
inline constexpr const char* kPatternHelp =
    "voronoi:N[,FALLOFF] | web:RINGSxSPOKES | radial:N | brick:X,Y,Z | slabs:N | grid:N (N^3 "
    "cells) | an .obj file of convex cells, one per group";
/// Parses a pattern. Throws InputError with the syntax for anything else; the message begins with
/// `option`.
PatternSpec parse_pattern(const std::string& text, const std::string& option = "pattern");

/// A break of a solid.
struct SolidBreak {
  std::string name = "pattern";  ///< Name of the pattern in messages.
  PatternSpec pattern;
  std::optional<Vec3> at_R;        ///< Point of impact; none: the middle of the bounding box.
  std::optional<double> radius_m;  ///< Radius of the impact sphere; none: everything breaks.
  std::uint64_t seed = 1;
};

/// Returns the command of a break. Its direction is towards the middle of the bounding box, or down
/// if the impact is there. Throws InputError for bricks that are too small for the solid.
BreakCommand break_command(const Compound& compound, const SolidBreak& options);

/// A solid, ready to be broken by a command. The solid may have several islands, each of which
/// breaks by the same event.
class PreparedSolidBreak {
 public:
  PreparedSolidBreak(const Compound& compound, const BreakCommand& command);
  /// Computes the break of each island. Changes nothing, so that it can be repeated.
  std::vector<BreakEdit> plan() const;
  /// Applies what plan() returned. Returns all pieces.
  BreakPlan apply(std::vector<BreakEdit> edits) &&;

 private:
  std::vector<Structure> structures_;
  fracture::PreparedBreak ready_;
  std::uint64_t event_ = 1;
};

/// Decides if a mesh is decomposed again with more nodes, as less volume is left whole by a break
/// if the convexes are smaller.
class NodeRetries {
 public:
  /// `convexes` is the number of convexes of the first decomposition.
  explicit NodeRetries(std::size_t convexes) : nodes_(convexes) {}
  /// Returns the number of nodes of the next decomposition; none if the fraction of the volume that
  /// was left whole is small enough, or after two retries.
  std::optional<std::uint32_t> next(double failed_fraction);

 private:
  std::size_t nodes_;
  int retries_ = 0;
};

}  // namespace sunder::scenes
