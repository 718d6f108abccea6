// Tests of the renderer: reproducible bytes, lit faces, shadows, precision far from the origin.
// They are in one file because they share one renderer.
#include "render/renderer.h"

#include <optional>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/geometry/hull.h"
#include "engine/model/compound.h"
#include "engine/model/piece_mesh.h"
#include "render/image/compare.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

RenderOptions small(const std::string& gl = "auto") {
  return {.width = 320, .height = 180, .gl = gl};
}

Renderer& renderer() {
  static Renderer shared(small());
  return shared;
}

Vec3f pixel(const Image& image, int x, int y) {
  const auto i = 3 * static_cast<std::size_t>(y * image.width + x);
  return Vec3f(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
}

float brightness(const Vec3f& rgb) { return rgb.mean(); }

TEST(Renderer, TheSameFrameGivesTheSameBytesWhateverWasDrawnBefore) {
  const Frame frame = house_frame(200);
  const Image first = renderer().draw(frame);
  EXPECT_EQ(renderer().draw(frame), first) << "drawn twice in a row";
  renderer().draw(house_frame(2500));  // more than fits into the buffers
  EXPECT_EQ(renderer().draw(frame), first) << "after another frame";
  Renderer fresh(small());
  EXPECT_EQ(fresh.draw(frame), first) << "in a new context";
}

/// Returns a frame of 6000 chunks close together over a floor, in this number of meshes. Positions
/// are multiples of powers of two, so that floats hold them exactly in any mesh.
Frame chunk_grid(std::size_t meshes) {
  SyntheticFrame s;
  s.add_box({-32, -2, -32}, {32, -1, 32}, Stuff::kConcrete);  // the shadow map is fitted to it
  Random random(5);
  std::vector<Mesh> parts(meshes);
  for (std::size_t i = 0; i < 6000; ++i) {
    const Vec3 place(0.5 * static_cast<double>(i % 20) - 5, 0.5 * static_cast<double>(i / 400),
                     0.5 * static_cast<double>(i / 20 % 20) - 5);
    std::vector<Vec3> points;
    for (int k = 0; k < 12; ++k) {
      points.push_back((1024 * random.direction()).array().round().matrix() / 4096);
    }
    const auto chunk = make_convex(make_hull(points), MaterialIndex(0));
    const auto mesh = make_mesh(*chunk, std::vector<std::uint8_t>(chunk->polyhedron.faces.size()));
    Mesh& part = parts[i % meshes];
    if (part.vertices.empty()) part.origin_T = place + mesh->origin_T;
    const auto first = static_cast<std::uint32_t>(part.vertices.size());
    const Vec3f moved = (place + mesh->origin_T - part.origin_T).cast<float>();
    for (Mesh::Vertex vertex : mesh->vertices) {
      vertex.position += moved;
      part.vertices.push_back(vertex);
    }
    for (const std::uint32_t index : mesh->indices) part.indices.push_back(first + index);
    part.material = mesh->material;
  }
  auto store = std::make_shared<MeshStore>(*s.frame.meshes);
  for (Mesh& part : parts) {
    s.frame.instances.push_back({MeshIndex(store->size()), 1});
    store->push_back(std::make_shared<const Mesh>(std::move(part)));
  }
  s.frame.bodies.emplace_back();
  s.frame.meshes = store;
  s.frame.view.eye_W = Vec3(2, 5, 8);
  s.frame.view.target_W = Vec3(0, 4, 0);
  return s.frame;
}

TEST(Renderer, OcclusionCullingDoesNotChangeThePicture) {
  EXPECT_EQ(renderer().draw(chunk_grid(6000)), renderer().draw(chunk_grid(20)));
}

TEST(Renderer, EveryKindOfContextGivesTheSameBytes) {
  const Frame frame = house_frame(2500);  // enough bodies for occlusion culling
  std::optional<Image> first;
  std::string first_kind;
  std::string absent;
  int kinds = 0;
  for (const char* gl : {"egl-surfaceless", "egl-device:0", "osmesa"}) {
    try {
      Renderer other(small(gl));
      // GPUs round differently; only software drivers give equal bytes.
      if (other.description().find("llvmpipe") == std::string::npos) continue;
      const Image image = other.draw(frame);
      if (!first) {
        first = image;
        first_kind = gl;
      }
      EXPECT_TRUE(image == *first) << gl << " against " << first_kind;
      ++kinds;
    } catch (const InputError& error) {
      absent += std::string("\n") + error.what();
    }
  }
  if (kinds < 2) GTEST_SKIP() << "fewer than two software contexts here:" << absent;
}

TEST(Renderer, AnUnknownContextIsRefusedWithTheAllowedOnes) {
  for (const char* gl : {"", "vulkan", "egl-device:", "egl-device:x", "egl-device:-1"}) {
    try {
      Renderer other(small(gl));
      ADD_FAILURE() << gl << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("egl-surfaceless"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(Renderer(small("egl-device:99")), InputError);
}

TEST(Renderer, APictureTooLargeForTheDeviceIsRefusedWithTheLargestSize) {
  try {
    Renderer renderer({.width = 1 << 20, .height = 16});
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_TRUE(said.starts_with("--size 1048576x16: too large")) << said;
  }
}

TEST(Renderer, ADescriptionNamesTheContextAndTheDriver) {
  const std::string text = renderer().description();
  EXPECT_NE(text.find(':'), std::string::npos) << text;
  EXPECT_GT(text.size(), 20u) << text;
}

/// Draws a frame of one body, lit from behind the camera.
Image lit_from(const Vec3& eye, const SyntheticFrame& synthetic) {
  Frame frame = synthetic.frame;
  frame.view.eye_W = eye + Vec3(0, 3, 0);
  frame.view.target_W = Vec3(0, 3, 0);
  frame.view.to_sun_W = eye + Vec3(0, 0.5, 0);
  frame.view.fov_rad = 0.35;
  return renderer().draw(frame);
}

TEST(Renderer, FacesThatTheSunShinesOnAreLitFromEverySide) {
  Random random(11);
  for (int shape = 0; shape < 5; ++shape) {
    SyntheticFrame s;
    if (shape == 0) s.add_box({-1, 2, -1}, {1, 4, 1}, Stuff::kConcrete);
    if (shape == 1) s.add_ball({0, 3, 0}, 1, Stuff::kPlaster);
    if (shape >= 2) s.add_chunk({0, 3, 0}, 2.5, Stuff::kConcrete, random);
    for (int side = 0; side < 12; ++side) {
      Vec3 eye = random.direction();
      eye.y() = 0.4 * std::abs(eye.y());
      const Image image = lit_from(9 * eye.normalized(), s);
      for (int y = 80; y <= 100; y += 5) {
        for (int x = 150; x <= 170; x += 5) {
          ASSERT_GT(brightness(pixel(image, x, y)), 50)
              << "shape " << shape << ", side " << side << ", pixel " << x << " " << y;
        }
      }
    }
  }
}

TEST(Renderer, ABoxThrowsAShadowOnTheGroundThatIsDarkerAndCooler) {
  SyntheticFrame s;
  s.add_box({-1, 2, -1}, {1, 2.4, 1}, Stuff::kConcrete);
  s.frame.view.eye_W = Vec3(0, 4, 9);
  s.frame.view.target_W = Vec3(0, 0, 0);
  s.frame.view.to_sun_W = Vec3(0.001, 1, 0);
  const Image image = renderer().draw(s.frame);
  const Vec3f shaded = pixel(image, 160, 90);
  const Vec3f sunlit = pixel(image, 40, 90);
  EXPECT_LT(brightness(shaded), 0.75f * brightness(sunlit));
  EXPECT_GT(shaded.z() / shaded.x(), sunlit.z() / sunlit.x());
}

TEST(Renderer, AFloatingPlateIsNotStripedByItsOwnShadow) {
  SyntheticFrame s;
  s.add_box({-4, 0, -4}, {4, 1, 4}, Stuff::kPlaster);
  s.frame.view.eye_W = Vec3(0, 7, 7);
  s.frame.view.target_W = Vec3(0, 1, 0);
  s.frame.view.to_sun_W = Vec3(0.9, 0.25, 0.2);  // grazing
  const Image image = renderer().draw(s.frame);
  const float middle = brightness(pixel(image, 160, 90));
  for (int x = 120; x < 200; ++x) {
    EXPECT_GT(brightness(pixel(image, x, 90)), 0.75f * middle) << "at " << x;
  }
}

TEST(Renderer, AMeshSharedByManyBodiesIsDrawnForEach) {
  SyntheticFrame s;
  s.add_box({-0.3, 0, -0.3}, {0.3, 0.6, 0.3}, Stuff::kSteel);
  s.frame.view.eye_W = Vec3(0, 2, 9);
  const Image one = renderer().draw(s.frame);
  for (const double x : {-2.0, -1.0, 1.0, 2.0}) {
    FrameBody body = s.frame.bodies[0];
    body.X_WB.position.x() = x;
    body.key = s.frame.bodies.size();
    s.frame.instances.push_back({MeshIndex(0), static_cast<std::uint32_t>(s.frame.bodies.size())});
    s.frame.bodies.push_back(body);
  }
  const Image five = renderer().draw(s.frame);
  const auto changed = [&](int x) {
    return !(pixel(one, x, 104) - pixel(five, x, 104)).isZero(16);
  };
  EXPECT_TRUE(changed(160 - 47) && changed(160 - 23) && changed(160 + 23) && changed(160 + 47));
  EXPECT_FALSE(changed(160));
}

TEST(Renderer, DebrisIsDrawnInItsMaterialAndThrowsAShadow) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 6, 6);
  s.frame.view.target_W = Vec3(0, 1, 0);
  s.frame.view.to_sun_W = Vec3(0.001, 1, 0);
  s.add_box({-3, -0.1, -3}, {3, 0, 3}, Stuff::kPlaster);  // receives the shadow
  const Image without = renderer().draw(s.frame);
  FrameDebris chip;
  chip.radius_m = 0.5f;
  chip.position_W = Vec3f(0, 1, 0);
  chip.material = MaterialIndex(0);
  s.frame.debris = {chip};
  const Image with = renderer().draw(s.frame);
  const Vec3f brick = pixel(with, 160, 90);
  EXPECT_GT(brick.x(), 1.2f * brick.z()) << "brick is red inside";
  int darker = 0;
  for (int y = 100; y < 150; ++y) {
    for (int x = 130; x < 190; ++x) {
      if (brightness(pixel(with, x, y)) < 0.8f * brightness(pixel(without, x, y))) ++darker;
    }
  }
  EXPECT_GT(darker, 25) << "its shadow lies below it";
  s.frame.debris[0].position_W = Vec3f(0, 60, 60);  // behind the eye
  EXPECT_EQ(renderer().draw(s.frame), without);
}

TEST(Renderer, DustVeilsWhatIsBehindItAndNotWhatIsInFrontOfIt) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 1, 9);
  s.frame.view.target_W = Vec3(0, 1, 0);
  s.add_box({-2, 0, 3}, {0, 3, 3.2}, Stuff::kBrick);  // the left half, before the dust
  const Image without = renderer().draw(s.frame);
  for (int i = 0; i < 12; ++i) {
    FrameDust puff;
    puff.position_W = Vec3f(0.1f * static_cast<float>(i - 6), 1, 0);
    puff.radius_m = 0.7f;
    puff.opacity = 0.6f;
    puff.material = MaterialIndex(1);
    s.frame.dust.push_back(puff);
  }
  const Image with = renderer().draw(s.frame);
  const auto change = [&](int x) {
    return (pixel(with, x, 90) - pixel(without, x, 90)).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(change(175), 12) << "open sky and ground are veiled";
  EXPECT_LT(change(140), 3) << "the wall is in front of the dust";
  EXPECT_EQ(renderer().draw(s.frame), with) << "equal bytes when drawn again";
}

TEST(Renderer, BricksThatAreABodyEachDifferInToneAndHaveJoints) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 0.5, 2.6);
  s.frame.view.target_W = Vec3(0, 0.5, 0);
  s.frame.view.to_sun_W = Vec3(0.2, 0.5, 1);
  constexpr int kBricks = 8;
  for (int i = 0; i < kBricks; ++i) {
    const double left = 0.4 * (i - kBricks / 2);
    s.add_box({left, 0, -0.3}, {left + 0.4, 1, 0}, Stuff::kPlaster);
  }
  Image image = renderer().draw(s.frame);
  const auto column = [&](double x) {
    const int at = static_cast<int>(std::lround(160 + x * 90 / (2.6 * std::tan(0.4))));
    float sum = 0;
    for (int y = 70; y < 110; ++y) sum += brightness(pixel(image, at, y)) / 40;
    return sum;
  };
  const auto joint = [&](int brick) {
    const double at = 0.4 * (brick - kBricks / 2), pixel_m = 2.6 * std::tan(0.4) / 90;
    return std::min({column(at - pixel_m), column(at), column(at + pixel_m)});
  };
  const auto middle = [&](int brick) { return column(0.4 * (brick - kBricks / 2) + 0.2); };
  float darkest = 255, brightest = 0;
  for (int i = 1; i < kBricks; ++i) {
    darkest = std::min(darkest, middle(i));
    brightest = std::max(brightest, middle(i));
    EXPECT_LT(joint(i), 0.93f * std::min(middle(i - 1), middle(i))) << i;
  }
  EXPECT_GT(brightest, 1.06f * darkest);
  // Parts of one body have one tone and no joints.
  for (Instance& instance : s.frame.instances) instance.body = 0;
  image = renderer().draw(s.frame);
  float lighter = 0;
  for (int i = 1; i < kBricks; ++i) lighter += joint(i) - 0.95f * middle(i);
  EXPECT_GT(lighter, 0);
}

TEST(Renderer, DustThatHasRisenIsWiderAndThinner) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 10, 8);
  s.frame.view.target_W = Vec3(0, 10.01, 0);
  struct Seen {
    float most = 0;
    int pixels = 0;
  };
  const auto puff_at = [&](double height_m) {
    s.frame.view.ground_m = 10 - height_m;
    s.frame.dust.clear();
    const Image without = renderer().draw(s.frame);
    FrameDust puff;
    puff.position_W = Vec3f(0, 10, 0);
    puff.radius_m = 0.3f;
    puff.opacity = 0.45f;
    puff.material = MaterialIndex(1);
    s.frame.dust = {puff};
    const Image with = renderer().draw(s.frame);
    Seen seen;
    for (int y = 0; y < 90; ++y) {  // before the sky
      for (int x = 0; x < with.width; ++x) {
        const float change =
            std::abs(brightness(pixel(with, x, y)) - brightness(pixel(without, x, y)));
        seen.most = std::max(seen.most, change);
        if (change > 1) ++seen.pixels;
      }
    }
    return seen;
  };
  const Seen low = puff_at(1), high = puff_at(7);
  EXPECT_GT(low.most, 6);
  EXPECT_LT(high.most, 0.75f * low.most);
  EXPECT_GT(high.pixels, 1.15 * low.pixels);
}

// The shadow map would be coarser if it covered them.
TEST(Renderer, CastersWhoseShadowsAreOutOfViewDoNotChangeThePicture) {
  const auto with_block_at = [](double x_m) {
    SyntheticFrame s;
    s.add_box({-1, 0, -1}, {1, 2, 1}, Stuff::kConcrete);
    s.add_box({x_m - 0.5, 0, -0.5}, {x_m + 0.5, 1, 0.5}, Stuff::kConcrete);
    s.frame.view.eye_W = Vec3(0, 3, 10);
    s.frame.view.target_W = Vec3(0, 1, 0);
    s.frame.view.to_sun_W = Vec3(0.2, 1, 0.1);
    return renderer().draw(s.frame);
  };
  const Image in_view = with_block_at(3);
  EXPECT_EQ(with_block_at(12), with_block_at(20)) << "both are out of view, within the map's reach";
  EXPECT_NE(with_block_at(12), in_view);
}

// Distant shadow casters do not count for the size of the shadow map, but are drawn into it.
TEST(Renderer, AShadowAtTheBorderOfTheMapIsNotExtendedBeyondIt) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 8, 6);
  s.frame.view.target_W = Vec3(0, 0, 0);
  s.frame.view.to_sun_W = Vec3(0, 1, 0.001);
  s.add_box({-0.3, 0, -0.3}, {0.3, 0.3, 0.3}, Stuff::kConcrete);
  const Image without = renderer().draw(s.frame);
  // A beam, 80 m long, that crosses the right side of the map at an angle.
  s.add_box({-0.05, 0, -40}, {0.05, 0.1, 40}, Stuff::kConcrete,
            {Vec3(28.5, 0.15, -28.3), Quat(Eigen::AngleAxisd(-0.785398, Vec3::UnitY()))});
  const Image with = renderer().draw(s.frame);
  int darker = 0;
  for (int x = 200; x < 320; ++x) {
    for (int y = 76; y < 104; ++y)
      if (brightness(pixel(with, x, y)) < 0.8f * brightness(pixel(without, x, y))) ++darker;
  }
  EXPECT_EQ(darker, 0);
}

TEST(Renderer, AWallIsSeenThroughAPane) {
  SyntheticFrame s;
  s.add_box({-3, 0, -1}, {3, 4, -0.8}, Stuff::kConcrete);
  s.frame.view.eye_W = Vec3(0, 1.5, 6);
  s.frame.view.target_W = Vec3(0, 1.5, 0);
  const Vec3f bare = pixel(renderer().draw(s.frame), 160, 90);
  s.add_box({-1, 0.5, 0}, {1, 2.5, 0.02}, Stuff::kGlass);
  const Vec3f covered = pixel(renderer().draw(s.frame), 160, 90);
  EXPECT_NE(bare, covered);
  EXPECT_LT((bare - covered).cwiseAbs().maxCoeff(), 60);
}

/// Returns a frame of a pane, cut by a slanted crack, whose faces are narrower than a pixel.
Frame cracked_pane(FaceKind kind) {
  SyntheticFrame s;
  s.add_box({-3, 0, -1}, {3, 4, -0.8}, Stuff::kConcrete);
  auto meshes = std::make_shared<MeshStore>(*s.frame.meshes);
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vec3> points;
    for (const double z : {0.0, 0.012}) {
      points.insert(points.end(), {Vec3(side, 0.5, z), Vec3(side, 2.5, z), Vec3(-0.15, 0.5, z),
                                   Vec3(0.15, 2.5, z)});
    }
    Convex half;
    half.polyhedron = make_hull(points);
    half.box = bounds(half.polyhedron);
    half.material = MaterialIndex(static_cast<std::size_t>(Stuff::kGlass));
    for (ConvexPolyhedron::Face& face : half.polyhedron.faces) {
      const Vec3& normal = face.plane.normal;
      if (normal.x() * side < -0.5) face.kind = kind;
    }
    s.frame.instances.push_back({MeshIndex(meshes->size()), 0});
    meshes->push_back(make_mesh(half, std::vector<std::uint8_t>(half.polyhedron.faces.size())));
  }
  s.frame.bodies[0].com_R = Vec3::Zero();
  s.frame.bodies[0].X_WB = Pose();
  s.frame.meshes = meshes;
  s.frame.view.eye_W = Vec3(0.9, 1.5, 7);
  s.frame.view.target_W = Vec3(0, 1.5, 0);
  return s.frame;
}

TEST(Renderer, ACrackNarrowerThanAPixelIsALineWithoutGaps) {
  const Image whole = renderer().draw(cracked_pane(FaceKind::kSurface));
  const Image cracked = renderer().draw(cracked_pane(FaceKind::kInterior));
  int gaps = 0;
  for (int y = 75; y < 105; ++y) {
    float most = 0;
    for (int x = 140; x < 180; ++x)
      most = std::max(most, (pixel(whole, x, y) - pixel(cracked, x, y)).cwiseAbs().maxCoeff());
    if (most <= 2) ++gaps;
  }
  EXPECT_EQ(gaps, 0);
}

TEST(Renderer, TenKilometresFromTheOriginThePictureIsTheSame) {
  Frame frame = house_frame(100);
  const Image here = renderer().draw(frame);
  const Vec3 away(9600, 0, -9600);  // whole periods of the ground's texture
  for (FrameBody& body : frame.bodies) body.X_WB.position += away;
  frame.view.eye_W += away;
  frame.view.target_W += away;
  const Difference difference = compare(here, renderer().draw(frame));
  EXPECT_TRUE(difference.passes({}))
      << difference.flip_mean << " " << difference.worst_window_pixels;
}

TEST(Renderer, AnEmptyWorldIsGroundUnderSky) {
  SyntheticFrame s;
  s.frame.view.eye_W = Vec3(0, 2, 8);
  s.frame.view.target_W = Vec3(0, 2, 0);
  const Image image = renderer().draw(s.frame);
  const Vec3f sky = pixel(image, 160, 5);
  const Vec3f ground = pixel(image, 160, 175);
  EXPECT_GT(sky.z(), sky.x());
  EXPECT_GT(ground.x(), ground.z());
}

TEST(Renderer, TheHudIsWrittenInTheCornerOnly) {
  SyntheticFrame s;
  RenderOptions options = small();
  for (const int samples : {1, 2}) {
    options.samples = samples;
    options.hud = true;
    const Image with = Renderer(options).draw(s.frame);
    options.hud = false;
    const Image without = Renderer(options).draw(s.frame);
    EXPECT_NE(with, without) << samples;
    for (int y = 72; y < 180; y += 7) {
      for (int x = 0; x < 320; x += 7) ASSERT_EQ(pixel(with, x, y), pixel(without, x, y));
    }
  }
}

}  // namespace
}  // namespace sunder::render
