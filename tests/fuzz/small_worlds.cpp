#include "tests/fuzz/small_worlds.h"

#include "engine/base/check.h"
#include "engine/io/sealed_bytes.h"
#include "engine/world/world.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::fuzz {
namespace {

constexpr double kFrame_s = 1.0 / 60;

struct SmallWorld {
  int debris, dust;    ///< Limits.
  const char* toml;    ///< The rest of the scene.
  int frames;          ///< Frames before it is saved.
  bool bends = false;  ///< True if a hinge has yielded by then.
};

constexpr SmallWorld kWorlds[] = {
    // A stack that falls asleep, a pendulum, a door, a weight on a chain.
    {0, 0,
     R"([[solid]]
structure = "box"
name = "one"
size_m = [1, 0.5, 1]
position = [0, 0.25, 0]
material = "steel"
[[solid]]
structure = "box"
name = "two"
size_m = [0.5, 0.5, 0.5]
position = [0, 0.75, 0]
material = "steel"
[[ball]]
name = "pendulum"
radius_m = 0.2
position = [3, 2, 0]
[[joint]]
kind = "rope"
a = "pendulum"
at = [3, 2, 0]
to = [4, 3, 0]
[[solid]]
structure = "box"
name = "door"
size_m = [1, 2, 0.1]
position = [6, 1.2, 0]
material = "wood"
[[joint]]
kind = "hinge"
a = "door"
at = [5.5, 1.2, 0]
axis = [0, 1, 0]
[script]
[[script.shot]]
time_s = 9
from = [0, 1, 9]
at = [0, 1, 0]
speed_m_s = 20
radius_m = 0.2
)",
     70},
    // A wall in the middle of its break, with debris and dust.
    {200, 60,
     R"([[solid]]
structure = "box"
size_m = [1, 1, 0.2]
position = [0, 0.5, 0]
anchored = "bottom"
material = "concrete"
[script]
[[script.shot]]
time_s = 0
from = [0, 0.6, 1]
at = [0, 0.6, 0]
speed_m_s = 30
radius_m = 0.12
)",
     8},
    // A hill, a cart on a path, and a blast.
    {50, 0,
     R"([ground]
height_m = -5
[[ground.mesh]]
hills_m = 0.2
hill_length_m = 4
width_m = 6
depth_m = 6
[[solid]]
structure = "box"
name = "cart"
size_m = [0.5, 0.5, 0.5]
position = [0, 1, 0]
[[ball]]
radius_m = 0.2
position = [1, 1, 0]
[[solid]]
structure = "box"
size_m = [0.3, 0.8, 0.3]
position = [-1, 1, 0]
material = "brick"
[script]
[[script.move]]
name = "cart"
[[script.move.key]]
time_s = 1
shift = [1, 0, 0]
[[script.blast]]
time_s = 0.2
at = [-1.4, 1, 0]
radius_m = 2
impulse_Ns_m2 = 3000
)",
     11},
    // A reinforced column in the middle of its bending.
    {0, 0,
     R"([[solid]]
structure = "reinforced"
name = "column"
size_m = [0.2, 0.6, 0.2]
block_m = 0.2
bars = 1
bar_m = 0.008
anchored = "bottom"
[script]
[[script.shot]]
time_s = 0
from = [-1, 0.3, 0]
at = [0, 0.3, 0]
speed_m_s = 40
radius_m = 0.12
)",
     18, true},
};

std::vector<std::byte> make_state(const SmallWorld& small) {
  const std::string toml =
      "[scene]\ndescription = \"x\"\n[limits]\ndebris = " + std::to_string(small.debris) +
      "\ndust = " + std::to_string(small.dust) + "\n" + small.toml;
  World world = scenes::make_world(scenes::parse_scene(toml, "small.toml"));
  for (int i = 0; i < small.frames; ++i) world.step(kFrame_s);
  SUNDER_CHECK(small.bends == (world.frame()->report.plastic_J > 0));
  return unseal(scenes::save_world(world), "small");
}

}  // namespace

const std::vector<std::vector<std::byte>>& small_states() {
  static const std::vector<std::vector<std::byte>> states = [] {
    std::vector<std::vector<std::byte>> all;
    for (const SmallWorld& small : kWorlds) all.push_back(make_state(small));
    return all;
  }();
  return states;
}

std::string run_state(std::span<const std::byte> content, int frames) {
  try {
    World world = scenes::restore_world(seal(content), {}, "forged.state");
    for (int i = 0; i < frames; ++i) {
      world.step(kFrame_s);
      for (const FrameBody& body : world.frame()->bodies)
        SUNDER_CHECK(body.X_WB.position.allFinite() && body.velocity_W.allFinite());
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace sunder::fuzz
