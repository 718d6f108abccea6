// The striker of an impact, as far as the solid that it strikes is concerned: its cross-section,
// the thickness that it has to pass, and how it goes on. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/base/types.h"
#include "engine/model/structure.h"
#include "engine/world/break/planned_break.h"

namespace sunder {

/// Corners of the cross-section of an actor seen along `direction_W` (unit), in counter-clockwise
/// order about it, in the plane through `point_W`; of a structure, that of its convexes within
/// `reach_m` of the point. Empty if the section has no area.
std::vector<Vec3> cross_section(const World& world, const Actor& actor, const Vec3& point_W,
                                const Vec3& direction_W, double reach_m);

/// Thickness of a structure behind a section: the median, of those that meet it, of the rays from
/// `point_R` and from halfway to each corner. One ray may pass between convexes that touch.
double thickness_behind(const Structure& structure, const std::vector<Vec3>& section_R,
                        const Vec3& point_R, const Vec3& direction_R, double most_m);

/// Share of the surroundings of a section, half its width from its edge and `depth_m` behind it,
/// that a structure fills: what is struck where little is around it cannot be perforated.
double confinement(const Structure& structure, const std::vector<Vec3>& section_R,
                   const Vec3& direction_R, double depth_m);

/// Gives a fast striker and what it has broken out of its way one common speed: a plastic
/// collision, which keeps momentum (Recht and Ipson 1963). Debris takes its share of the momentum.
void drive_out(World& world, const PlannedBreak& planned, std::uint32_t first_key);

}  // namespace sunder
