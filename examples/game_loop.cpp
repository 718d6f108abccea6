// A game loop: a gun, a hundred rays a frame, and rollback, as a game over a network needs it.
//
//   game_loop [FRAMES]
//
// Every second the game keeps a copy of the world. When an input of the past becomes known, here a
// shot that arrives half a second late, the game returns to the copy and simulates up to the
// present again. Without the late shot, the present is the same, bit for bit.
#include <sunder/sunder.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <vector>

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr int kKeepEvery = 60;  // frames from one copy to the next

double now_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

/// Inputs of a player by frame.
using Inputs = std::map<int, std::vector<sunder::Shot>>;

class Game {
 public:
  explicit Game(sunder::Scene scene)
      : steel_(sunder::scenes::material_named(scene, "steel")),
        world_(sunder::scenes::make_world(std::move(scene))) {}

  /// A ball from the muzzle to where the player aims.
  sunder::Shot shot(const sunder::Vec3& muzzle_W, const sunder::Vec3& aim_W) const {
    sunder::Shot shot;
    shot.ball.material = steel_;
    shot.ball.radius_m = 0.3;
    shot.ball.center_W = muzzle_W;
    shot.ball.velocity_W = 30 * (aim_W - muzzle_W).normalized();
    return shot;
  }
  /// Simulates a frame; returns the time of its step.
  double frame(const Inputs& inputs, int number) {
    if (number % kKeepEvery == 0) kept_.insert_or_assign(number, world_.copy());
    const double before_ms = now_ms();
    look_around(number);
    rays_ms_ += now_ms() - before_ms;
    if (const auto pressed = inputs.find(number); pressed != inputs.end())
      for (const sunder::Shot& shot : pressed->second) world_.shoot(shot);
    const double step_ms = now_ms();
    world_.step(kFrame_s);
    steps_ms_ += now_ms() - before_ms;
    pieces_ += world_.events().appeared.size();
    return now_ms() - step_ms;
  }
  /// Returns to the last copy at or before `number`, and returns its frame.
  int roll_back(int number) {
    const auto kept = std::prev(kept_.upper_bound(number));
    world_ = kept->second.copy();
    return kept->first;
  }
  std::uint64_t hash() { return sunder::hash_state(*world_.frame()); }
  const sunder::World& world() const { return world_; }
  double share_of_rays() const { return rays_ms_ / steps_ms_; }
  std::size_t pieces() const { return pieces_; }

 private:
  /// Counts the guards, of a hundred, that see something.
  void look_around(int number) {
    seen_ = 0;
    for (int i = 0; i < 100; ++i) {
      const sunder::Vec3 from(-12, 1 + 0.05 * i, -10 + 0.2 * ((i * 37 + number) % 100));
      seen_ += world_.cast(from, {1, 0, 0}, 40).has_value();
    }
  }

  sunder::MaterialIndex steel_;
  sunder::World world_;
  std::map<int, sunder::World> kept_;
  int seen_ = 0;
  std::size_t pieces_ = 0;
  double rays_ms_ = 0, steps_ms_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 180;
  if (frames < 61 || frames > 100000) {
    std::fprintf(stderr, "usage: game_loop [FRAMES], from 61 to 100000\n");
    return 2;
  }
  sunder::Scene scene = sunder::scenes::load_scene("house");
  scene.shots.clear();  // the player shoots
  Game game(std::move(scene));
  Inputs inputs;
  for (int i = 5; i < frames; i += 20)
    inputs[i].push_back(game.shot({-14, 1.5, 0.1 * (i % 50) - 2.5}, {0, 2, 0}));
  const double start_ms = now_ms();
  double last_60_ms = 0;  // steps of the last 60 frames
  for (int i = 0; i < frames; ++i) {
    const double step_ms = game.frame(inputs, i);
    if (i >= frames - 60) last_60_ms += step_ms;
  }
  std::printf("%d frames in %.0f ms: %zu pieces came off; a hundred rays took %.1f %% of a frame\n",
              frames, now_ms() - start_ms, game.pieces(), 100 * game.share_of_rays());

  // The same inputs again: the same present.
  const std::uint64_t present = game.hash();
  const double again_ms = now_ms();
  int at = game.roll_back(frames - 60);
  for (int i = at; i < frames; ++i) game.frame(inputs, i);
  const double took_ms = now_ms() - again_ms;
  const bool same = game.hash() == present;
  std::printf(
      "rolled back to frame %d and simulated again in %.0f ms (the steps of the last 60 "
      "frames had taken %.0f): %s\n",
      at, took_ms, last_60_ms, same ? "the same present" : "ANOTHER PRESENT");

  // A shot that becomes known late: another present.
  inputs[frames - 30].push_back(game.shot({14, 3, 0}, {0, 3, 0}));
  at = game.roll_back(frames - 30);
  for (int i = at; i < frames; ++i) game.frame(inputs, i);
  const bool other = game.hash() != present;
  std::printf("with a late shot in frame %d: %s\n", frames - 30,
              other ? "another present" : "THE SAME PRESENT");
  return same && other ? 0 : 1;
}
