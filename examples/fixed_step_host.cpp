// A host with frames of any length that steps a world in equal steps, and draws between two of
// them, as game engines do: an accumulator holds the time that is not simulated yet.
//
//   fixed_step_host
//
// Prints how far from the path of a falling ball the drawn positions are.
#include <sunder/sunder.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

/// Steps a world, and interpolates the positions of its bodies for the time of drawing.
class Host {
 public:
  explicit Host(sunder::World world) : world_(std::move(world)), before_(world_.bodies()) {}

  /// Simulates what a frame of the host adds, at most `most` steps, so that a slow frame does not
  /// make the next one slower still.
  void frame(double time_s, int most = 5) {
    left_s_ = std::min(left_s_ + time_s, most * kStep_s);
    while (left_s_ >= kStep_s) {
      before_ = world_.bodies();
      world_.step(kStep_s);
      left_s_ -= kStep_s;
    }
  }
  /// Position to draw of a body, less than a step in the past.
  sunder::Vec3 drawn_W(sunder::BodyKey key) const {
    const sunder::BodyArrays& now = world_.bodies();
    const sunder::Vec3 to_W = position_in(now, key, sunder::Vec3::Zero());
    const sunder::Vec3 from_W = position_in(before_, key, to_W);  // new bodies do not move
    return from_W + left_s_ / kStep_s * (to_W - from_W);
  }
  /// The time that drawn positions are of.
  double drawn_time_s() const { return world_.time_s() - kStep_s + left_s_; }

 private:
  static constexpr double kStep_s = 1.0 / 60;

  static sunder::Vec3 position_in(const sunder::BodyArrays& bodies, sunder::BodyKey key,
                                  const sunder::Vec3& otherwise) {
    const auto at = std::ranges::lower_bound(bodies.key, key);
    if (at == bodies.key.end() || *at != key) return otherwise;
    return bodies.position_W[static_cast<std::size_t>(at - bodies.key.begin())];
  }

  sunder::World world_;
  sunder::BodyArrays before_;  ///< Before the last step.
  double left_s_ = 0;          ///< Time that is not simulated yet.
};

}  // namespace

int main() {
  sunder::Scene scene;
  scene.materials = sunder::scenes::builtin_materials();
  sunder::Ball ball;
  ball.material = sunder::scenes::material_named(scene, "steel");
  ball.center_W = {0, 50, 0};
  scene.balls = {ball};
  Host host(sunder::scenes::make_world(scene));
  double worst_m = 0;
  for (int i = 0; i < 120; ++i) {
    host.frame(0.005 + 0.02 * std::fabs(std::sin(i)));  // frames of 5 to 25 ms
    const double time_s = host.drawn_time_s();
    const double path_m = 50 - 0.5 * 9.81 * time_s * time_s;
    if (time_s > 0)
      worst_m = std::max(worst_m, std::fabs(host.drawn_W(sunder::BodyKey(0)).y() - path_m));
  }
  std::printf("120 frames, %.2f s: at most %.0f mm from the path\n", host.drawn_time_s(),
              1e3 * worst_m);
  return worst_m < 0.1 ? 0 : 1;
}
