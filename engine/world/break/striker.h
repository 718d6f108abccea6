// The striker of an impact: its cross-section, the thickness of the solid along its path, and its
// motion after a perforation (docs/decisions/047). Internal to engine/world.
#pragma once

#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/structure.h"
#include "engine/world/break/planned_break.h"

namespace sunder {

/// Returns the corners of the cross-section of actors, at least one, projected along `direction_W`
/// (unit) onto the plane through `point_W`, counter-clockwise about the direction; of several the
/// outline around all. An actor with a structure is represented by its convexes within `reach_m` of
/// the point. Empty if the section has no area.
std::vector<Vec3> cross_section(const WorldState& world, std::span<const Actor* const> actors,
                                const Vec3& point_W, const Vec3& direction_W, double reach_m);

/// Returns the thickness of a structure behind a section: the median over the rays, from `point_R`
/// and from halfway to each corner, that hit the structure. A single ray could pass between
/// convexes that touch.
double thickness_behind(const Structure& structure, const std::vector<Vec3>& section_R,
                        const Vec3& point_R, const Vec3& direction_R, double most_m);

/// Returns the length of a striker's path in a structure behind a section, a median as above. Rays
/// begin `back_m` before the section, as a slanted one reaches into the structure.
double path_behind(const Structure& structure, const std::vector<Vec3>& section_R,
                   const Vec3& point_R, const Vec3& direction_R, double back_m, double most_m);

/// Returns the share of points around a section, at 1.5 times its width and `depth_m` behind it, at
/// which a structure has material. A solid with little material around the section cannot be
/// perforated.
double confinement(const Structure& structure, const std::vector<Vec3>& section_R,
                   const Vec3& direction_R, double depth_m);

/// Gives a fast striker and the pieces that it has broken out of its path one common speed: a
/// plastic collision, which conserves momentum (Recht and Ipson 1963). Debris takes its share of
/// the momentum. Pieces are the actors with keys from `first_key` on.
void apply_plastic_collision(WorldState& world, const PlannedBreak& planned,
                             std::uint32_t first_key);

}  // namespace sunder
