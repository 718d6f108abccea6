// Tests of faults in scene files: each is refused with its place, its key and the allowed values.
#include <gtest/gtest.h>

#include "tests/scenes/refusal.h"

namespace sunder::scenes {
namespace {

constexpr Fault kFaults[] = {
    // Keys and tables
    {"[[\n", "bad.toml:3: Error while parsing key: expected bare key starting character"},
    {"duratoin_s = 3",
     "bad.toml:3: unknown key 'duratoin_s' in [scene]; did you mean 'duration_s'?"
     "; allowed: description, duration_s, seed, gravity, planar"},
    {"[grund]\nheight_m = 1",
     "bad.toml:3: unknown key 'grund' in the scene file; did you mean "
     "'ground'?"},
    {"[[solid]]\nstructure = \"box\"\nsize_m = [1000, 1000, 1000]\nblock_m = 0.05",
     "bad.toml:3: 8e+12 parts; allowed: at most 200000; make them larger, or use fewer"},
    {"[[solid]]\nstructure = \"brick_wall\"\nbricks = 1000\ncourses = 1000",
     "bad.toml:3: 1e+06 parts; allowed: at most 200000"},
    {"[ground]\nbounciness = 1",
     "bad.toml:4: unknown key 'bounciness' in [ground]; allowed: "
     "height_m, friction, restitution"},
    {"[[solid]]\nstructure = \"box\"\nradius_m = 1",
     "bad.toml:5: unknown key 'radius_m' in "
     "[[solid]] box"},
    {"[[material]]\nname = \"x\"\npattern = { knd = \"web\" }",
     "bad.toml:5: unknown key 'knd' in [material.pattern]; did you mean 'kind'?"},
    {"[[material]]\nname = \"x\"\nsurface = { colour = [0, 0, 0] }",
     "bad.toml:5: unknown key 'colour' in [material.surface], [material.interior]; did you mean "
     "'color'?"},
    {"[script]\nenable = false",
     "bad.toml:4: unknown key 'enable' in [script]; did you mean "
     "'enabled'?"},
    // Joints
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"ball\"\na "
     "= \"y\"",
     "bad.toml:9: no solid or ball is named 'y'; did you mean 'x'?"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"bal\"\na = "
     "\"x\"",
     "bad.toml:8: kind in [[joint]] is the string \"bal\"; allowed: ball | hinge | fixed | "
     "distance | rope"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"rope\"\na "
     "= \"x\"",
     "bad.toml:6: missing key 'to' in [[joint]] of kind rope, its end point on b"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"ball\"\na "
     "= \"x\"\nto = [0, 2, 0]",
     "bad.toml:10: to in [[joint]] is for kinds distance and rope; this one is ball"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"rope\"\na "
     "= \"x\"\nto = [0, 1, 0]",
     "bad.toml:10: at and to in [[joint]] are the same point"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"hinge\"\na "
     "= \"x\"\naxis = [0, 0, 0]",
     "bad.toml:10: axis in [[joint]] is zero"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"ball\"\na "
     "= \"x\"\nbreaking_Nm = 5",
     "bad.toml:10: breaking_Nm in [[joint]] is for kinds hinge and fixed"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"ball\"\na "
     "= \"x\"\nb = \"x\"",
     "bad.toml:10: a and b in [[joint]] are the same body"},
    {"[[solid]]\nstructure = \"box\"\nname = \"x\"\n[[joint]]\nat = [0, 1, 0]\nkind = \"ball\"\na "
     "= \"x\"\n[[solid]]\nstructure = \"box\"\nanchored = \"bottom\"\nname = "
     "\"z\"\n[[joint]]\nkind = \"ball\"\nat = [0, 0, 0]\na = \"z\"",
     "bad.toml:17: neither end of this [[joint]] can move: both are anchored to the world"},
    // Types
    {"duration_s = \"long\"",
     "bad.toml:3: duration_s in [scene] is the string \"long\"; allowed: "
     "a number from 0.1 to 600, in s"},
    {"seed = 1.5", "bad.toml:3: seed in [scene] is the number 1.5; allowed: a whole number"},
    {"gravity = 9.81", "bad.toml:3: gravity in [scene] is the number 9.81; allowed: [x, y, z]"},
    {"gravity = [0, -9.81]", "bad.toml:3: gravity in [scene] is [0, -9.81]; allowed: [x, y, z]"},
    {"gravity = [0, \"down\", 0]",
     "bad.toml:3: gravity in [scene] is an array of 3, in which the string \"down\" is wrong; "
     "allowed: [x, y, z], each a number"},
    {"[script]\nenabled = 1",
     "bad.toml:4: enabled in [script] is the number 1; allowed: true or "
     "false"},
    {"[ground]\nfriction = true",
     "bad.toml:4: friction in [ground] is true; allowed: a number "
     "from 0 to 10"},
    {"[[solid]]\nstructure = 3",
     "bad.toml:4: structure in [[solid]] is the number 3; allowed: a non-empty string"},
    {"[solid]\nstructure = \"box\"",
     "bad.toml:3: [[solid]] is a table; expected an array of "
     "tables: write [[solid]] with two brackets"},
    {"[[ground]]\nfriction = 1", "bad.toml:3: [ground] is an array of 1; expected a table"},
    {"[[material]]\nname = \"x\"\npattern = \"web\"",
     "bad.toml:5: [material.pattern] is the string "
     "\"web\"; expected a table"},
    {"duration_s = 2020-01-01", "bad.toml:3: dates and times are not allowed in scene files"},
    // Ranges
    {"duration_s = -1",
     "bad.toml:3: duration_s in [scene] is the number -1; allowed: a number "
     "from 0.1 to 600, in s"},
    {"duration_s = nan", "bad.toml:3: duration_s in [scene] is the number nan; allowed"},
    {"duration_s = inf", "bad.toml:3: duration_s in [scene] is the number inf; allowed"},
    {"gravity = [0, -inf, 0]",
     "bad.toml:3: gravity in [scene] is [0, -inf, 0], in which the number -inf is wrong; allowed: "
     "[x, y, z], each a number from -100 to 100"},
    {"[view]\nfov_deg = 270",
     "bad.toml:4: fov_deg in [view] is the number 270; allowed: a number from 1.15 to 171.89, in "
     "degrees"},
    {"[limits]\nbodies = 0",
     "bad.toml:4: bodies in [limits] is the number 0; allowed: a whole "
     "number from 1 to 200000"},
    {"[limits]\nbodies = 5000000000", "bad.toml:4: bodies in [limits] is the number 5000000000"},
    {"[[solid]]\nstructure = \"stack\"\ncount = 1000000",
     "bad.toml:5: count in [[solid]] stack is "
     "the number 1000000; allowed: a whole "
     "number from 1 to 1000"},
    {"[[solid]]\nstructure = \"box\"\nsize_m = [1, 0, 1]",
     "bad.toml:5: size_m in [[solid]] box is "
     "[1, 0, 1]"},
    {"[[material]]\nname = \"x\"\ndensity_kg_m3 = 0",
     "bad.toml:5: density_kg_m3 in [[material]] is "
     "the number 0; allowed: a number from 1"},
    {"[[material]]\nname = \"x\"\npattern = { cells = 1 }",
     "bad.toml:5: cells in [material.pattern] "
     "is the number 1"},
    {"[[material]]\nname = \"x\"\ncrumbling = { debris_smallest_m = 0 }",
     "bad.toml:5: debris_smallest_m in [material.crumbling] is the number 0; allowed: a number "
     "from 0.0005 to 1"},
    {"[[material]]\nname = \"x\"\ncrumbling = { debris_smallest_m = 0.2 }",
     "bad.toml:5: debris_smallest_m = 0.2 exceeds debris_largest_m = 0.06"},
    {"[limits]\nbodies = 5\n[[solid]]\nstructure = \"stack\"",
     "bad.toml: 10 bodies exceed bodies = "
     "5 in [limits]"},
    {"[accuracy]\ndt_s = 0.007",
     "bad.toml:4: dt_s in [accuracy] does not divide a frame of 1/60 s"},
    // Names
    {"[[solid]]\nstructure = \"hose\"",
     "bad.toml:4: unknown structure 'hose'; did you mean "
     "'house'?; allowed: arch | arena | box | brick_wall | bridge | column | compound | hall | "
     "house | "
     "mesh "
     "| pane | prism | reinforced | stack | temple | terrain | wheel"},
    {"[[solid]]\nstructure = \"box\"\nmaterial = \"stel\"",
     "bad.toml:5: unknown material 'stel'; did you mean 'steel'?; materials: brick, clay, "},
    {"[[solid]]\nstructure = \"box\"\nanchored = \"top\"",
     "bad.toml:5: anchored in [[solid]] is the "
     "string \"top\"; allowed: none | bottom"},
    {"[[material]]\nname = \"x\"\nlike = \"oak\"", "bad.toml:5: unknown material 'oak'"},
    {"[[material]]\nname = \"x\"\npattern = { kind = \"spider\" }",
     "bad.toml:5: kind in [material.pattern] is the string \"spider\"; allowed: none | voronoi | "
     "web"},
    {"[[material]]\nname = \"x\"\n[[material]]\nname = \"x\"",
     "bad.toml:5: duplicate [[material]] 'x'"},
    {"[[solid]]\nstructure = \"box\"\nname = \"a\"\n[[ball]]\nname = \"a\"",
     "bad.toml:7: duplicate name 'a', also at bad.toml:5; give each its own name"},
    {"[[solid]]\nstructure = \"stack\"\n[[body]]\nmesh = \"box:1,1,1\"\nname = \"stack.0\"",
     "bad.toml:3: duplicate name 'stack.0', also at bad.toml:7; give each its own name"},
    {"[[solid]]\nstructure = \"pane\"\n[[solid]]\nstructure = \"pane\"\n[[script.remove]]\ntime_s "
     "= "
     "1\nname = \"pane\"",
     "bad.toml:9: 'pane' is ambiguous: it is the default name at bad.toml:3 and at bad.toml:5; "
     "give each its own name"},
    {"[[ball]]\nname = \"\"",
     "bad.toml:4: name in [[ball]] is the string \"\"; allowed: a non-empty string"},
    // Missing or superfluous keys
    {"[[solid]]\nposition = [0, 0, 0]", "bad.toml:3: missing key 'structure' in [[solid]]"},
    {"[[material]]\nfriction = 1", "bad.toml:3: missing key 'name' in [[material]]"},
    {"[[script.shot]]\nfrom = [0, 0, 0]\nvelocity = [1, 0, 0]",
     "bad.toml:3: missing key 'time_s' "
     "in [[script.shot]]"},
    {"[[script.shot]]\ntime_s = 1\nfrom = [0, 0, 0]",
     "bad.toml:3: [[script.shot]] needs either "
     "velocity, or at (and speed_m_s)"},
    {"[[script.shot]]\ntime_s = 1\nfrom = [0, 0, 0]\nat = [1, 0, 0]\nvelocity = [1, 0, 0]",
     "bad.toml:3: [[script.shot]] needs either velocity, or at"},
    {"[[script.shot]]\ntime_s = 1\nfrom = [0, 0, 0]\nat = [0, 0, 0]",
     "bad.toml:3: at and from in [[script.shot]] are the same point"},
    {"[[script.wrecking_ball]]\nfrom = [0, 5, 0]\nhangs_from = [0, 5.2, 0]",
     "bad.toml:3: hangs_from in [[script.wrecking_ball]] is inside the ball; move it outside, or "
     "reduce radius_m"},
    {"[[script.remove]]\ntime_s = 1", "bad.toml:3: [[script.remove]] needs either name, or from"},
    {"[[script.remove]]\ntime_s = 1\nfrom = [0, 0, 0]",
     "bad.toml:3: [[script.remove]] needs either name, or from and to"},
    {"[[ball]]\nname = \"b\"\n[[script.remove]]\ntime_s = 1\nname = \"b\"\nfrom = [0, 0, 0]\nto = "
     "[1, 1, 1]",
     "bad.toml:5: [[script.remove]] needs either name, or from and to"},
    {"[[ball]]\nname = \"b\"\n[[script.drive]]\nname = \"b\"\nvelocity = [1, 0, 0]\ntime_s = "
     "2\nuntil_s = 1",
     "bad.toml:5: until_s in [[script.drive]] is not after time_s"},
    {"[[ball]]\nname = \"b\"\n[[script.drive]]\nname = \"b\"",
     "bad.toml:5: [[script.drive]] needs velocity, or angular_velocity, or both"},
    {"[[solid]]\nstructure = \"box\"\nanchored = \"bottom\"\n[[script.drive]]\nvelocity = [1, 0, "
     "0]\nname = \"box\"",
     "bad.toml:8: 'box' in [[script.drive]] is anchored to the world and cannot be moved; set "
     "its key 'anchored' to \"none\""},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"",
     "bad.toml:5: [[script.move]] needs at least one [[script.move.key]]"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 0 }]",
     "bad.toml:7: time_s in [[script.move.key]] is 0, not after 0, the time of the initial pose"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\n[[script.move.key]]\ntime_s "
     "= 2\n[[script.move.key]]\ntime_s = 1.5",
     "bad.toml:10: time_s in [[script.move.key]] is 1.5, not after 2 of the previous key; sort the "
     "keys by time_s"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\n[[script.move.key]]\ntime_s "
     "= 0.1\nshift = [0, 50, 0]",
     "bad.toml:7: the motion to this [[script.move.key]] needs 500 m/s; allowed: at most 100; "
     "increase time_s"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\n[[script.move.key]]\ntime_s "
     "= 0.1\nturn_rad = [0, 20, 0]",
     "bad.toml:7: the motion to this [[script.move.key]] needs 200 rad/s; allowed: at most 50; "
     "increase time_s"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\nloop = "
     "true\n[[script.move.key]]\ntime_s = 1\nturn_deg = [0, 180, 0]",
     "bad.toml:8: the last key of a [[script.move]] with loop = true must be the initial pose"},
    {"[[solid]]\nstructure = \"box\"\nanchored = \"all\"\n[[script.move]]\nname = \"box\"\nkey = "
     "[{ time_s = 1 }]",
     "bad.toml:7: 'box' in [[script.move]] is anchored to the world and cannot be moved; set "
     "its key 'anchored' to \"none\""},
    {"[[ball]]\nname = \"b\"\n[[script.move]]\nname = \"b\"\nkey = [{ time_s = 1 }]",
     "bad.toml:6: 'b' in [[script.move]] is a ball; only a [[body]] or [[solid]] can be moved"},
    {"[[solid]]\nstructure = \"box\"\n[[joint]]\nkind = \"ball\"\na = \"box\"\nat = [0, 1, "
     "0]\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 1 }]",
     "bad.toml:10: 'box' in [[script.move]] has a [[joint]] to the world, or to a body that is "
     "anchored or moved, too; one of the two bodies of a joint must be free"},
    {"[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 1 "
     "}]\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 1 }]",
     "bad.toml:9: 'box' in [[script.move]] is moved by another [[script.move]] already"},
    {"planar = true\n[[material]]\nname = \"concrete\"\npattern = { kind = \"none\" "
     "}\n[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 1, "
     "shift = [0, 0, 1] }]",
     "bad.toml:3: planar = true in [scene], but a move's shift has a z component; set it to 0"},
    {"planar = true\n[[material]]\nname = \"concrete\"\npattern = { kind = \"none\" "
     "}\n[[solid]]\nstructure = \"box\"\n[[script.move]]\nname = \"box\"\nkey = [{ time_s = 1, "
     "turn_rad = [1, 0, 0] }]",
     "bad.toml:3: planar = true in [scene], but a move rotates about an axis other than z"},
    {"[view]\nfov_rad = 1\nfov_deg = 50",
     "bad.toml:5: fov_deg and fov_rad in [view] exclude each other; remove one"},
    {"[[solid]]\nstructure = \"box\"\nrotation_deg = [0, 400, 0]",
     "bad.toml:5: rotation_deg in [[solid]] is [0, 400, 0], in which the number 400 is wrong; "
     "allowed: [x, y, z], each a number from -360 to 360, in degrees"},
    {"[[body]]\nmesh = \"box:1,1,1\"\nrotation_deg = 90",
     "bad.toml:5: rotation_deg in [[body]] is the number 90; allowed: [x, y, z]"},
    {"[[solid]]\nstructure = \"box\"\nrotation_degs = [0, 90, 0]",
     "bad.toml:5: unknown key 'rotation_degs' in [[solid]] box; did you mean 'rotation_deg'?"},
    {"[view]\nsun = [0, 0, 0]", "bad.toml: [view] needs a sun that is not zero"},
    {"[[solid]]\nstructure = \"house\"\nwindows = 40",
     "bad.toml:3: house: windows of window_m do "
     "not fit side by side"},
    // Planar scenes
    {"planar = true\n[[solid]]\nstructure = \"box\"\nmaterial = \"clay\"",
     "bad.toml:3: planar = true in [scene], but solid 'box' has the material clay, whose pattern "
     "would break it along z; set pattern = { kind = \"none\" } in a [[material]] of this name"},
    {"planar = true\n[[solid]]\nname = \"post\"\nstructure = \"column\"",
     "bad.toml:3: planar = true in [scene], but solid 'post' is not a prism along z; rotate it"},
    {"planar = true\n[[solid]]\nstructure = \"box\"\nposition = [0, 0, 2]",
     "bad.toml:3: planar = true in [scene], but solid 'box' has parts that do not cross the plane "
     "z = 0; move it there"},
    {"planar = true\n[[ball]]\nname = \"b\"\nvelocity = [0, 0, 1]",
     "bad.toml:3: planar = true in [scene], but ball 'b' has a velocity that has a z component"},
    {"planar = true\ngravity = [0, -9, 1]",
     "bad.toml:3: planar = true in [scene], but gravity has a z component; set it to 0"},
    {"planar = true\n[script]\n[[script.shot]]\ntime_s = 1\nfrom = [0, 0, 5]\nat = [0, 0, 0]",
     "bad.toml:3: planar = true in [scene], but a ball of [script] has a position that has a z "
     "component"},
    // Syntax
    {"duration_s = ", "bad.toml:3: "},
    {"duration_s = 1\nduration_s = 2", "bad.toml:4: "},
    {"[view", "bad.toml:3: "},
};

TEST(BadScenes, AreRefusedWithPlaceKeyAndTheAllowedValues) {
  ASSERT_EQ(refusal(kGood), "");
  for (const Fault& fault : kFaults) {
    const std::string message = refusal(std::string(kGood) + fault.lines + "\n");
    EXPECT_TRUE(message.starts_with(fault.message))
        << fault.lines << "\nexpected: " << fault.message << "\nsaid:     " << message;
  }
}

TEST(BadScenes, WithoutASceneTableAreRefused) {
  EXPECT_EQ(refusal("[ground]\nfriction = 1\n"), "bad.toml: missing table [scene]");
  EXPECT_EQ(refusal("[scene]\nseed = 1\n"),
            "bad.toml:1: missing key 'description' in [scene]: a non-empty string");
}

TEST(BadFlags, AreRefusedByTheirOwnName) {
  const Fault flags[] = {
      {"duration", "--set duration: expected key=value"},
      {"=3", "--set =3: expected key=value"},
      {"scene.duration_s=", "--set scene.duration_s=: expected key=value"},
      {"scene.duration_s=1 second!", "--set scene.duration_s=1 second!: '1 second!' is not a TOML"},
      {"scene.duration=3",
       "--set scene.duration=3: unknown key 'duration' in [scene]; did you "
       "mean 'duration_s'?"},
      {"scene.duration_s=long",
       "--set scene.duration_s=long: duration_s in [scene] is the string "
       "\"long\"; allowed: a number from 0.1 to 600, in s"},
      {"scene.seed.x=1", "--set scene.seed.x=1: "},
      {"ball.3.radius_m=1", "--set ball.3.radius_m=1: '3' is not an index of an array of 1"},
      {"ball.first.radius_m=1", "--set ball.first.radius_m=1: 'first' is not an index"},
      {"scene.description.x=1", "--set scene.description.x=1: there is no key 'x' in the string"},
  };
  for (const Fault& flag : flags) {
    LoadOptions options;
    options.set = {flag.lines};
    const std::string message = refusal(std::string(kGood) + "[[ball]]\n", options);
    EXPECT_TRUE(message.starts_with(flag.message)) << "said: " << message;
  }
  LoadOptions options;
  options.preset = "realtme";
  EXPECT_EQ(refusal(kGood, options),
            "--preset realtme: unknown preset; did you mean 'realtime'?; allowed: draft | realtime "
            "| accurate | reference");
}

TEST(BadFiles, AreNamed) {
  const auto refused = [](const std::string& name) -> std::string {
    try {
      load_scene(name, {});
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refused("no/such.toml"), "no/such.toml: cannot be read: there is no such file");
  try {
    scene_file("house", "no/such/folder", "/no/such/bin/sunder");
    ADD_FAILURE() << "there is no catalogue";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "house: no such file, and no catalogue of scenes found: neither "
                 "/no/such/share/sunder/scenes nor no/such/folder is a folder; give the path of a "
                 "scene file");
  }
  EXPECT_TRUE(refused("hause").starts_with(
      "hause: no such file, and no scene of this name; did you mean 'house'?; scenes: "));
}

}  // namespace
}  // namespace sunder::scenes
