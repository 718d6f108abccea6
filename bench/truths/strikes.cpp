#include "bench/truths/strikes.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

std::string text(const Vec3& v) {
  std::ostringstream out;
  out.precision(12);
  out << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  return out.str();
}

}  // namespace

std::string box(const std::string& name, const Vec3& size, const Vec3& foot,
                const std::string& material, const std::string& more) {
  return "[[solid]]\nname = \"" + name + "\"\nstructure = \"box\"\nsize_m = " + text(size) +
         "\nposition = " + text(foot) + "\nmaterial = \"" + material + "\"\n" + more + "\n";
}

std::string ball(const std::string& name, double radius_m, const Vec3& center,
                 const Vec3& velocity) {
  std::ostringstream out;
  out.precision(12);
  out << "[[ball]]\nname = \"" << name << "\"\nradius_m = " << radius_m
      << "\nposition = " << text(center) << "\nvelocity = " << text(velocity)
      << "\nmaterial = \"steel\"\n";
  return out.str();
}

std::string material(const std::string& name, const std::string& like, const std::string& more) {
  return "[[material]]\nname = \"" + name + "\"\nlike = \"" + like + "\"\n" + more + "\n";
}

std::string velocity(const Vec3& velocity) { return "velocity = " + text(velocity) + "\n"; }

std::string blocks(double block_m) {
  return block_m > 0 ? "block_m = " + std::to_string(block_m) + "\n" : "";
}

double steel_ball_kg(double radius_m) { return 7800 * 4 / 3. * kPi * std::pow(radius_m, 3); }

const FrameBody* Strike::find(const std::string& name) const {
  const auto key = keys_.find(name);
  for (const FrameBody& body : frame_->bodies)
    if (key != keys_.end() && body.key == key->second) return &body;
  return nullptr;
}

void strike(const std::string& tables, double seconds, const Preset& preset,
            const std::function<bool(const Strike&)>& look) {
  const std::string head =
      "[scene]\ndescription = \"A strike.\"\nduration_s = " + std::to_string(seconds) +
      "\n[limits]\ndust = 0\nparts_a_frame = 100000\n";
  Scene scene = scenes::parse_scene(head + tables, "strike.toml", {preset.name, {}});
  Strike now;
  std::uint64_t key = 0;
  for (const Solid& solid : scene.solids) now.keys_.emplace(solid.name, key++);
  for (const Ball& ball : scene.balls) now.keys_.emplace(ball.name, key++);
  const auto simulation = scenes::make_simulation(std::move(scene));
  while ((now.frame_ = simulation->next())) {
    for (const BreakEvent& event : now.frame_->breaks) now.cracks_m2_ += event.new_area_m2;
    if (!look(now)) return;
  }
}

double exit_m_s(const std::string& tables, const std::string& name, const Vec3& way,
                double distance_m, double seconds, const Preset& preset) {
  double exit = 0;
  strike(tables, seconds, preset, [&](const Strike& now) {
    const FrameBody* body = now.find(name);
    if (body == nullptr) return false;
    const bool is_out = body->X_WB.position.dot(way) > distance_m;
    if (is_out) exit = body->velocity_W.dot(way);
    return !is_out;
  });
  return exit;
}

std::optional<Passed> passed(double striker_kg, double speed_m_s, double width_m,
                             const Plate& plate) {
  const double plug_kg = plate.density_kg_m3 * kPi / 4 * width_m * width_m * plate.thickness_m;
  // CEA-EDF: v² = 1.7 f_c ρ^⅓ (d e²/m)^(4/3), times (r + .3) by UKAEA; taken at m = 2 plug_kg.
  const double work_J = 0.488 * (plate.reinforcement_percent + 0.3) * plate.compressive_Pa *
                        std::pow(width_m, 2. / 3) * std::pow(plate.thickness_m, 7. / 3);
  const double on_kg = striker_kg + plug_kg, rest_kg = plate.free_kg - plug_kg;
  const double reduced_kg = on_kg / (1 + on_kg / rest_kg), u = striker_kg * speed_m_s / on_kg;
  const double left_J = 0.5 * reduced_kg * u * u - work_J;
  if (left_J < 0) return {};
  const double share = 1 / (1 + on_kg / rest_kg);  // of the relative speed that the striker has
  return Passed{u * (1 - share) + std::sqrt(2 * left_J / reduced_kg) * share, plug_kg};
}

}  // namespace sunder::truths
