// Scenes in which one thing strikes another, as the truths about impacts need them: text of their
// tables, a run that is watched frame by frame, and what theory says of a perforated plate.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "bench/truths/truth.h"
#include "engine/model/frame.h"

namespace sunder::truths {

/// Returns the table of a box in a scene file. `foot` is the middle of its foot, `more` has further
/// lines.
std::string box(const std::string& name, const Vec3& size, const Vec3& foot,
                const std::string& material, const std::string& more = "");
/// Returns the table of a ball of steel.
std::string ball(const std::string& name, double radius_m, const Vec3& center,
                 const Vec3& velocity);
/// Returns the table of a material like another.
std::string material(const std::string& name, const std::string& like, const std::string& more);
/// Returns the line of a table that gives a velocity.
std::string velocity(const Vec3& velocity);
/// Returns the line of a table that gives the longest edge of blocks; empty for 0, one block.
std::string blocks(double block_m);

/// Returns the mass of a ball of steel.
double steel_ball_kg(double radius_m);

/// A run of a scene, at one frame.
class Strike {
 public:
  /// The frame, whose `report` and `breaks` are those since the frame before.
  const Frame& frame() const { return *frame_; }
  /// Returns the body of a solid or ball that has not been broken away; null if there is none.
  const FrameBody* find(const std::string& name) const;
  /// Area of all cracks so far.
  double cracks_m2() const { return cracks_m2_; }

 private:
  friend void strike(const std::string&, double, const Preset&,
                     const std::function<bool(const Strike&)>&);
  FramePtr frame_;
  std::map<std::string, std::uint64_t> keys_;
  double cracks_m2_ = 0;
};

/// Simulates the scene of these tables for `seconds`, or until `look`, which is called with each
/// frame, returns false.
void strike(const std::string& tables, double seconds, const Preset& preset,
            const std::function<bool(const Strike&)>& look);

/// Returns the speed of a body along `way` when it has gone `distance_m` beyond the origin along
/// it; 0 if it does not within `seconds`.
double exit_m_s(const std::string& tables, const std::string& name, const Vec3& way,
                double distance_m, double seconds, const Preset& preset);

/// Plate that is struck, of brick by default.
struct Plate {
  double thickness_m;
  double compressive_Pa = 8e6, density_kg_m3 = 1900, reinforcement_percent = 0;
  double free_kg = 1e30;  ///< Effective mass of a free plate at the place struck.
};
/// Motion of a striker behind a plate.
struct Passed {
  double speed_m_s;
  double plug_kg;  ///< Mass that goes on with it.
};
/// Returns the motion of a striker behind a plate by theory; none if the striker does not pass. The
/// work that shears out a plug of the striker's section is that of CEA-EDF's limit speed (Berriaud
/// et al. 1978) for a striker of twice the plug's mass. The plug goes on with the striker (Recht
/// and Ipson 1963), and the rest of a free plate takes its share of the momentum.
std::optional<Passed> passed(double striker_kg, double speed_m_s, double width_m,
                             const Plate& plate);

/// Returns the k-th phase of an impact, as a fraction of a frame. Phases by the golden ratio are
/// spread evenly in a frame, and in each step of it.
inline double phase(int k) {
  return k * 0.618033988749895 - static_cast<int>(k * 0.618033988749895);
}

}  // namespace sunder::truths
