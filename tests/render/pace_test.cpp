// Tests of playback at any rate: interpolation between frames, and the times of pictures.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/rotation.h"
#include "render/playback.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render::pace_test {
namespace {

constexpr double kFrame_s = 1.0 / 60;

std::shared_ptr<Frame> frame_of(std::uint64_t index) {
  SyntheticFrame s;
  s.frame.index = index;
  s.frame.time_s = static_cast<double>(index) * kFrame_s;
  return std::make_shared<Frame>(s.frame);
}

FrameBody body(std::uint64_t key, const Pose& X_WB, const Vec3& com_R = Vec3::Zero()) {
  FrameBody body;
  body.key = body.previous_key = key;
  body.X_WB = X_WB;
  body.com_R = com_R;
  return body;
}

/// A source of given frames.
class Given final : public FrameSource {
 public:
  explicit Given(std::vector<FramePtr> frames) : frames_(std::move(frames)) {}
  FramePtr next() override { return at_ < frames_.size() ? frames_[at_++] : nullptr; }

 private:
  std::vector<FramePtr> frames_;
  std::size_t at_ = 0;
};

FrameInterval interval_of(const std::shared_ptr<Frame>& before, const std::shared_ptr<Frame>& after,
                          const std::shared_ptr<Frame>& beyond = nullptr) {
  FrameInterval interval{before, after, passage(*before, *after)};
  if (beyond) {
    interval.beyond = beyond;
    interval.following_match = passage(*after, *beyond);
  }
  return interval;
}

std::vector<FramePtr> run(std::uint64_t frames) {
  std::vector<FramePtr> all;
  for (std::uint64_t i = 0; i < frames; ++i) all.push_back(frame_of(i));
  return all;
}

std::vector<double> times(const PlaybackRate& pace, std::uint64_t frames) {
  Given given(run(frames));
  ResampledSource paced(given, pace);
  std::vector<double> all;
  while (const FramePtr frame = paced.next()) {
    EXPECT_EQ(frame->index, all.size()) << "pictures are numbered";
    all.push_back(frame->time_s);
  }
  return all;
}

TEST(PlaybackRate, AtItsOwnRateARunGivesItsFramesUnchanged) {
  const std::vector<FramePtr> frames = run(4);
  Given given(frames);
  ResampledSource paced(given, {});
  for (const FramePtr& frame : frames) EXPECT_EQ(paced.next(), frame);
  EXPECT_EQ(paced.next(), nullptr);
}

TEST(PlaybackRate, PicturesAreEvenlySpacedInTimeUpToTheLastFrame) {
  const std::vector<double> slow = times({60, 0.1}, 4);
  ASSERT_EQ(slow.size(), 31u);
  for (std::size_t i = 0; i < slow.size(); ++i) {
    EXPECT_NEAR(slow[i], static_cast<double>(i) * kFrame_s / 10, 1e-12);
  }
  const std::vector<double> film = times({24, 1}, 121);
  ASSERT_EQ(film.size(), 49u);
  for (std::size_t i = 0; i < film.size(); ++i) {
    EXPECT_NEAR(film[i], static_cast<double>(i) / 24, 1e-12);
  }
  EXPECT_EQ(times({60, 3}, 10).size(), 4u) << "every third";
}

TEST(PlaybackRate, FramesBeforeTheFirstAreOnePictureEach) {
  const auto pictures = [](const PlaybackRate& pace, std::uint64_t first) {
    Given given(run(4));
    ResampledSource paced(given, pace, first);
    std::vector<std::uint64_t> all;
    while (const FramePtr frame = paced.next()) all.push_back(frame->index);
    return all;
  };
  using Pictures = std::vector<std::uint64_t>;
  EXPECT_EQ(pictures({60, 0.25}, 10), (Pictures{0, 1, 4, 8, 10, 11, 12}));
  EXPECT_EQ(pictures({60, 1}, 2), (Pictures{0, 1, 2, 3}));
  EXPECT_EQ(pictures({60, 3}, 1), (Pictures{0, 1}));
}

TEST(PlaybackRate, PicturesOfAPartOfARunAreThoseOfTheWhole) {
  const PlaybackRate pace{60, 0.3};
  EXPECT_EQ(pace.first_picture(0), 0u);
  EXPECT_EQ(pace.last_picture(10), 33u);
  EXPECT_EQ(pace.first_picture(10), 34u) << "both parts together have all pictures";
  EXPECT_EQ((PlaybackRate{60, 0.1}).first_picture(7), 70u);
  EXPECT_EQ((PlaybackRate{60, 0.1}).last_picture(7), 70u);
}

TEST(FrameInterpolation, BodiesMoveStraightAndTurnEvenlyAlsoByWholeTurns) {
  const auto a = frame_of(0), b = frame_of(1);
  const Vec3 spin_W = Vec3(0, 0, 2 * 3.14159265358979 * 1.25 / kFrame_s);  // more than once round
  a->bodies = {body(0, {{0, 0, 0}, Quat::Identity()}), body(1, {})};
  b->bodies = {body(0, {{2, 4, 0}, rotation_by({0, 0.5, 0})}),
               body(1, {{}, rotation_by(kFrame_s * spin_W)})};
  a->bodies[1].angular_velocity_W = b->bodies[1].angular_velocity_W = spin_W;
  const auto half = between(interval_of(a, b), 0.5);
  EXPECT_LT((half->bodies[0].X_WB.position - Vec3(1, 2, 0)).norm(), 1e-12);
  EXPECT_LT(half->bodies[0].X_WB.rotation.angularDistance(rotation_by({0, 0.25, 0})), 1e-9);
  EXPECT_LT(half->bodies[1].X_WB.rotation.angularDistance(rotation_by(0.5 * kFrame_s * spin_W)),
            1e-9);
  EXPECT_NEAR(half->time_s, 0.5 * kFrame_s, 1e-12);
}

// Pieces have the position in the rest frame that they had in the turned and moved body.
TEST(FrameInterpolation, PiecesStartAtTheirPositionInTheWhole) {
  const auto a = frame_of(0), b = frame_of(1);
  const Pose X_WB{{5, 3, 1}, rotation_by({0.3, 1, -0.2})};
  const Vec3 com_R(1, 2, 3), piece_com_R(1.5, 2, 2.5);
  a->bodies = {body(0, X_WB, com_R)};
  b->bodies = {body(3, {{9, 9, 9}, rotation_by({1, 1, 0})}, piece_com_R),
               body(4, {}, Vec3::Zero())};
  b->bodies[0].previous_key = b->bodies[1].previous_key = 0;
  const auto just_then = between(interval_of(a, b), 1e-9);
  EXPECT_LT((just_then->bodies[0].X_WB.position - X_WB * Vec3(piece_com_R - com_R)).norm(), 1e-6);
  EXPECT_LT(just_then->bodies[0].X_WB.rotation.angularDistance(X_WB.rotation), 1e-6);
  const auto at_last = between(interval_of(a, b), 1 - 1e-9);
  EXPECT_LT((at_last->bodies[0].X_WB.position - Vec3(9, 9, 9)).norm(), 1e-6);
}

TEST(FrameInterpolation, PiecesStayTogetherUntilTheBreak) {
  const auto a = frame_of(0), b = frame_of(1);
  FrameBody whole = body(0, {{0, 5, 0}, Quat::Identity()});
  whole.velocity_W = {60, 0, 0};
  whole.angular_velocity_W = {0, 6, 0};
  a->bodies = {whole};
  b->bodies = {body(1, {{3, 5, 2}, Quat::Identity()}, {0, 0, 1}),
               body(2, {{3, 5, -2}, Quat::Identity()}, {0, 0, -1})};
  b->bodies[0].previous_key = b->bodies[1].previous_key = 0;
  BreakEvent event;
  event.time_s = 0.5 * kFrame_s;
  event.parent_key = 0;
  b->breaks = {event};
  const auto gap_m = [&](double part) {
    const auto frame = between(interval_of(a, b), part);
    return (frame->bodies[0].X_WB.position - frame->bodies[1].X_WB.position).norm();
  };
  EXPECT_NEAR(gap_m(0.1), 2, 1e-9);
  EXPECT_NEAR(gap_m(0.5), 2, 1e-9);
  EXPECT_NEAR(gap_m(0.75), 3, 0.01);
  const auto before_it = between(interval_of(a, b), 0.5);
  EXPECT_NEAR(before_it->bodies[0].X_WB.position.x(), 0.5, 0.1)
      << "they move with the velocity of the whole";
  EXPECT_LT(before_it->bodies[0].X_WB.rotation.angularDistance(rotation_by({0, 0.05, 0})), 1e-9);
  EXPECT_LT((between(interval_of(a, b), 1 - 1e-9)->bodies[1].X_WB.position - Vec3(3, 5, -2)).norm(),
            1e-6);
}

TEST(FrameInterpolation, ANewBodyIsExtrapolatedBackAndARemovedOneForward) {
  SyntheticFrame sa, sb;
  sa.add_ball({1, 1, 1}, 0.3, Stuff::kSteel);
  sa.add_ball({2, 1, 1}, 0.3, Stuff::kSteel);
  sb.add_ball({5, 0, 0}, 0.3, Stuff::kSteel);
  const auto a = std::make_shared<Frame>(sa.frame), b = std::make_shared<Frame>(sb.frame);
  b->time_s = kFrame_s;
  a->bodies[0].key = 7;
  a->bodies[0].velocity_W = {0, -6, 0};
  a->bodies[1].key = 9;
  b->bodies[0].key = b->bodies[0].previous_key = 8;
  b->bodies[0].velocity_W = {60, 0, 0};
  // Meshes of a run are in one store. The ball that is removed has its own mesh; the mesh of the
  // second ball becomes part of the new body.
  auto store = std::make_shared<MeshStore>(*a->meshes);
  store->push_back((*b->meshes)[0]);
  b->meshes = store;
  b->instances = {{MeshIndex(2), 0}, {MeshIndex(1), 0}};
  const auto half = between(interval_of(a, b), 0.5);
  ASSERT_EQ(half->bodies.size(), 2u);
  EXPECT_EQ(half->bodies[0].key, 7u) << "bodies are ordered by key";
  EXPECT_LT((half->bodies[0].X_WB.position - Vec3(1, 0.95, 1)).norm(), 1e-9);
  EXPECT_EQ(half->bodies[1].key, 8u);
  EXPECT_LT((half->bodies[1].X_WB.position - Vec3(4.5, 0, 0)).norm(), 1e-9);
  ASSERT_EQ(half->instances.size(), 3u) << "a mesh of another body is not drawn twice";
  EXPECT_EQ(half->instances[0].body, 1u);
  EXPECT_EQ(half->instances[2].body, 0u);
}

FrameDebris chip(const Vec3f& place, float radius_m) {
  FrameDebris chip;
  chip.position_W = place;
  chip.radius_m = radius_m;
  chip.material = MaterialIndex(0);
  return chip;
}

TEST(FrameInterpolation, DebrisIsMatchedWhenOtherDebrisIsRemovedAndAdded) {
  const auto a = frame_of(0), b = frame_of(1), c = frame_of(2);
  a->debris = {chip({0, 0, 0}, 0.01f), chip({1, 0, 0}, 0.02f), chip({2, 0, 0}, 0.03f)};
  // The first piece of debris is removed, the last one has its index, and a new one flies off.
  b->debris = {chip({2, 1, 0}, 0.03f), chip({1, 1, 0}, 0.02f), chip({5, 5, 0}, 0.015f)};
  c->debris = b->debris;
  c->debris[2].position_W = {5.1f, 5, 0};
  const auto half = between(interval_of(a, b, c), 0.5);
  ASSERT_EQ(half->debris.size(), 4u);
  EXPECT_LT((half->debris[0].position_W - Vec3f(2, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((half->debris[1].position_W - Vec3f(1, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((half->debris[2].position_W - Vec3f(4.95f, 5, 0)).norm(), 1e-5f)
      << "new debris is extrapolated back";
  EXPECT_FLOAT_EQ(half->debris[2].radius_m, 0.0075f) << "new debris grows";
  EXPECT_EQ(half->debris[3].position_W, Vec3f(0, 0, 0));
  EXPECT_FLOAT_EQ(half->debris[3].radius_m, 0.005f) << "removed debris shrinks";
}

TEST(FrameInterpolation, DustIsMatchedByItsOrder) {
  const auto a = frame_of(0), b = frame_of(1);
  for (int i = 0; i < 10; ++i) {
    FrameDust puff;
    puff.position_W = {0.02f * static_cast<float>(i), 0, 0};
    puff.rotation_WD = Quatf(rotation_by({0, 0.6 * i, 0.2 * i * i}).cast<float>());
    puff.radius_m = 0.2f;
    puff.opacity = 0.5f;
    puff.material = MaterialIndex(0);
    a->dust.push_back(puff);
    if (i == 3 || i == 4) continue;
    puff.position_W.y() += 0.1f;
    b->dust.push_back(puff);
  }
  const auto half = between(interval_of(a, b), 0.5);
  ASSERT_EQ(half->dust.size(), 10u);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::size_t then = i < 3 ? i : i + 2;
    EXPECT_NEAR(half->dust[i].position_W.x(), a->dust[then].position_W.x(), 1e-6f);
    EXPECT_NEAR(half->dust[i].position_W.y(), 0.05f, 1e-6f);
    EXPECT_FLOAT_EQ(half->dust[i].opacity, 0.5f);
  }
  EXPECT_FLOAT_EQ(half->dust[8].opacity, 0.25f) << "removed dust fades";
}

}  // namespace
}  // namespace sunder::render::pace_test
