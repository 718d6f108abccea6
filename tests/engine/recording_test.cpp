// Tests of recordings: a recording plays from any frame; a damaged recording plays its readable
// part and reports the damage; a verified run that differs is reported with the frame and body.
#include "engine/io/recording/recording.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/io/bytes.h"
#include "engine/io/recording/recording_verifier.h"
#include "engine/io/state_hash.h"
#include "engine/model/piece_mesh.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

class Recording : public ::testing::Test {
 protected:
  ~Recording() override { fs::remove(path_); }

  /// Source of frames of moving bodies that appear and disappear, with debris and dust.
  class Run final : public FrameSource {
   public:
    explicit Run(int frames, double nudge_m = 0, int nudged_frame = -1)
        : left_(frames), nudge_m_(nudge_m), nudged_frame_(nudged_frame) {
      materials_ = std::make_shared<const std::vector<Material>>(3);
    }
    FramePtr next() override {
      if (left_-- == 0) return nullptr;
      auto frame = std::make_shared<Frame>();
      frame->index = index_;
      frame->time_s = static_cast<double>(index_) / 60;
      frame->materials = materials_;
      frame->names = names_;
      if (index_ % 7 == 0) {
        meshes_ = std::make_shared<MeshStore>(*meshes_);
        meshes_->push_back(
            make_ball_mesh(0.1 + 0.01 * static_cast<double>(index_), MaterialIndex(index_ % 3)));
      }
      frame->meshes = meshes_;
      add_bodies(*frame);
      add_particles(*frame);
      frame->report.mass_kg = 100;
      frame->report.joints_lost = index_ % 4;
      if (index_ % 5 == 0) {
        BreakEvent& event = frame->breaks.emplace_back();
        event.time_s = frame->time_s;
        event.parent_key = index_;
        event.child_keys = {index_ + 1, index_ + 2};
        event.material = MaterialIndex(index_ % 3);
        event.previous_key = index_ / 2;
        event.name = 2;
        event.pieces = 6;
      }
      ++index_;
      return frame;
    }

   private:
    void add_bodies(Frame& frame) const {
      for (std::uint64_t key = index_ / 10; key < 20 + index_ / 4; ++key) {
        FrameBody body;
        body.key = key;
        const double t = frame.time_s, k = static_cast<double>(key);
        body.X_WB.position = Vec3(k + t, 5 * t - 4.9 * t * t, -0.3 * k * t);
        if (key == 12 && static_cast<int>(index_) >= nudged_frame_) {
          body.X_WB.position.x() += nudge_m_;
        }
        body.X_WB.rotation = Quat(1, 0.1 * k * t, 0.2 * t, 0).normalized();
        body.velocity_W = Vec3(1, 5 - 9.8 * t, -0.3 * k);
        body.com_R = Vec3(0.5, k, 0.25);
        body.asleep = key % 5 == 0;
        body.is_static = key % 9 == 0;
        body.previous_key = index_ == key ? key - key % 3 : key;
        body.name = key % 4 == 0 ? kNoName : static_cast<std::uint32_t>(key % 4);
        for (std::size_t mesh = 0; mesh < 1 + key % 3; ++mesh) {
          frame.instances.push_back({MeshIndex((key + mesh) % frame.meshes->size()),
                                     static_cast<std::uint32_t>(frame.bodies.size())});
        }
        frame.bodies.push_back(body);
      }
    }
    void add_particles(Frame& frame) const {
      const float t = static_cast<float>(frame.time_s);
      for (std::uint64_t i = 0; i < 3 * index_; ++i) {
        Random random(i);
        const Vec3f from = random.direction().cast<float>();
        frame.debris.push_back({from * (1 + 3 * t), Quatf(1, t, 0, 0).normalized(), 0.02f,
                                MaterialIndex(i % 3), static_cast<std::uint8_t>(i % 8)});
        if (i % 4 < index_ % 5) continue;  // gaps that change
        frame.dust.push_back(
            {from * (1 + t), Quatf(1, 0, t, 0).normalized(), 0.1f + t, 0.5f, MaterialIndex(i % 3)});
      }
    }
    int left_;
    double nudge_m_;
    int nudged_frame_;
    std::uint64_t index_ = 0;
    std::shared_ptr<const std::vector<Material>> materials_;
    std::shared_ptr<const std::vector<std::string>> names_ =
        std::make_shared<const std::vector<std::string>>(
            std::vector<std::string>{"house", "", "wall.0", "ball"});
    std::shared_ptr<MeshStore> meshes_ = std::make_shared<MeshStore>();
  };

  void record(int frames) {
    Run run(frames);
    RecordingWriter writer(path_);
    FrameSink* const sinks[] = {&writer};
    pump(run, sinks);
  }
  std::vector<std::byte> bytes() const { return read_file(path_); }

  fs::path path_ = fs::temp_directory_path() /
                   ("sunder-take-" + std::to_string(::getpid()) + "-" +
                    ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".take");
};

/// Expects that two frames are equal up to the precision of a recording; `what` is for messages.
void expect_equal_frames(const Frame& played, const Frame& run, const std::string& what) {
  ASSERT_EQ(played.index, run.index) << what;
  EXPECT_EQ(played.time_s, run.time_s);
  EXPECT_EQ(*played.names, *run.names);
  EXPECT_EQ(hash_state(played), hash_state(run)) << what;
  ASSERT_EQ(played.bodies.size(), run.bodies.size()) << what;
  for (std::size_t b = 0; b < run.bodies.size(); ++b) {
    const FrameBody &a = played.bodies[b], &c = run.bodies[b];
    ASSERT_EQ(a.key, c.key) << what;
    ASSERT_LT((a.X_WB.position - c.X_WB.position).norm(), 2e-4) << what << ", body " << b;
    ASSERT_LT(a.X_WB.rotation.angularDistance(c.X_WB.rotation), 6e-4) << what;
    ASSERT_EQ(a.com_R, c.com_R);
    ASSERT_EQ(a.asleep, c.asleep);
    ASSERT_EQ(a.is_static, c.is_static);
    ASSERT_EQ(a.previous_key, c.previous_key);
    ASSERT_EQ(a.name, c.name);
  }
  ASSERT_EQ(played.instances.size(), run.instances.size()) << what;
  for (std::size_t i = 0; i < run.instances.size(); ++i) {
    ASSERT_EQ(played.instances[i].body, run.instances[i].body);
    const Mesh& a = *(*played.meshes)[played.instances[i].mesh.value];
    const Mesh& b = *(*run.meshes)[run.instances[i].mesh.value];
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    ASSERT_EQ(a.vertices.back().position, b.vertices.back().position) << what;
  }
  ASSERT_EQ(played.debris.size(), run.debris.size()) << what;
  for (std::size_t i = 0; i < run.debris.size(); ++i) {
    ASSERT_LT((played.debris[i].position_W - run.debris[i].position_W).norm(), 8e-3f) << what;
    ASSERT_EQ(played.debris[i].variant, run.debris[i].variant);
  }
  ASSERT_EQ(played.dust.size(), run.dust.size()) << what;
  for (std::size_t i = 0; i < run.dust.size(); ++i) {
    ASSERT_LT((played.dust[i].position_W - run.dust[i].position_W).norm(), 4e-2f) << what;
  }
  ASSERT_EQ(played.breaks.size(), run.breaks.size()) << what;
  for (std::size_t i = 0; i < run.breaks.size(); ++i) {
    const BreakEvent &a = played.breaks[i], &b = run.breaks[i];
    EXPECT_EQ(a.parent_key, b.parent_key) << what;
    EXPECT_EQ(a.child_keys, b.child_keys) << what;
    EXPECT_EQ(a.material.value, b.material.value) << what;
    EXPECT_EQ(a.previous_key, b.previous_key) << what;
    EXPECT_EQ(a.name, b.name) << what;
    EXPECT_EQ(a.pieces, b.pieces) << what;
  }
  EXPECT_EQ(played.report.mass_kg, run.report.mass_kg);
  EXPECT_EQ(played.report.joints_lost, run.report.joints_lost);
}

TEST_F(Recording, PlaysWhatWasRecorded) {
  record(150);
  RecordingReader take(path_);
  EXPECT_EQ(take.frames(), 150u);
  EXPECT_TRUE(take.is_complete());
  Run run(150);
  int frames = 0;
  for (FramePtr played = take.next(); played; played = take.next(), ++frames) {
    expect_equal_frames(*played, *run.next(), "frame " + std::to_string(frames));
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(frames, 150);
  EXPECT_EQ(take.damage(), "");
}

TEST_F(Recording, PlaysFromAnyFrameOn) {
  record(300);
  RecordingReader take(path_);
  std::vector<FramePtr> run;
  Run source(300);
  while (FramePtr frame = source.next()) run.push_back(std::move(frame));
  for (const std::uint32_t frame : {250u, 3u, 119u, 120u, 299u, 122u, 0u}) {
    take.seek(frame);
    for (std::uint32_t i = frame; i < std::min(frame + 3, 300u); ++i) {
      const FramePtr played = take.next();
      ASSERT_TRUE(played) << frame;
      expect_equal_frames(*played, *run[i], "frame " + std::to_string(i));
      if (HasFatalFailure()) return;
    }
  }
  take.seek(1000);
  EXPECT_EQ(take.next()->index, 299u);
}

TEST_F(Recording, TheSameFramesGiveTheSameBytes) {
  record(130);
  const std::vector<std::byte> first = bytes();
  record(130);
  EXPECT_TRUE(bytes() == first);
}

TEST_F(Recording, OfAKilledRunPlaysEveryFrameWritten) {
  Run run(90);
  {
    RecordingWriter writer(path_);
    while (const FramePtr frame = run.next()) writer.take(frame);
  }  // finish() is not called
  RecordingReader take(path_);
  EXPECT_FALSE(take.is_complete());
  EXPECT_EQ(take.frames(), 90u);
  take.seek(89);
  EXPECT_EQ(take.next()->index, 89u);
  EXPECT_EQ(take.damage(), "");
}

/// Plays the recording; returns the number of frames, or −1 if the file was refused.
int play_all(const fs::path& path, std::string& message) {
  try {
    RecordingReader take(path);
    int frames = 0;
    while (const FramePtr frame = take.next()) {
      EXPECT_EQ(frame->index, static_cast<std::uint64_t>(frames));
      for (const Instance& instance : frame->instances) {
        EXPECT_LT(instance.body, frame->bodies.size());
        EXPECT_LT(instance.mesh.value, frame->meshes->size());
      }
      ++frames;
    }
    message = take.damage();
    return frames;
  } catch (const InputError& error) {
    message = error.what();
    return -1;
  }
}

TEST_F(Recording, TruncatedAnywherePlaysTheRestOrIsRefusedByName) {
  record(130);
  const std::vector<std::byte> whole = bytes();
  Random random(5);
  int last = 131;
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 100; ++i) sizes.push_back(random.below(whole.size()));
  std::ranges::sort(sizes, std::greater());
  for (const std::size_t size : sizes) {
    write_file(path_, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    std::string message;
    const int frames = play_all(path_, message);
    EXPECT_LE(frames, last) << "a shorter file has no more frames";
    EXPECT_FALSE(message.empty() && frames < 0);
    if (frames < 0) {
      EXPECT_NE(message.find(path_.string()), std::string::npos) << message;
    }
    last = frames;
  }
}

TEST_F(Recording, CorruptAnywherePlaysWhatIsReadableAndReportsTheDamage) {
  record(130);
  const std::vector<std::byte> whole = bytes();
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    std::vector<std::byte> bad = whole;
    const std::size_t at = random.below(bad.size());
    bad[at] ^= static_cast<std::byte>(1 + random.below(255));
    write_file(path_, bad);
    std::string message;
    const int frames = play_all(path_, message);
    EXPECT_LE(frames, 130);
    if (frames < 130) {
      EXPECT_FALSE(message.empty()) << "byte " << at;
    }
  }
}

TEST_F(Recording, AFileThatIsNoRecordingIsRefused) {
  EXPECT_THROW(RecordingReader("/nowhere/at/all.take"), InputError);
  EXPECT_THROW(RecordingReader{fs::temp_directory_path()}, InputError);
  write_file(path_, std::vector<std::byte>(100));
  EXPECT_THROW(RecordingReader{path_}, InputError);
  EXPECT_THROW(RecordingWriter("/proc/no/such.take"), FileError);
}

TEST_F(Recording, OfAnUnreadableVersionIsRefusedWithAMessage) {
  record(3);
  std::vector<std::byte> older = bytes();
  older[7] = std::byte{'6'};
  write_file(path_, older);
  std::string message;
  EXPECT_EQ(play_all(path_, message), -1);
  EXPECT_NE(message.find("another version"), std::string::npos) << message;
  EXPECT_NE(message.find("record it again"), std::string::npos) << message;
}

/// A source of another source's frames, changed from one frame on.
class Changed final : public FrameSource {
 public:
  Changed(FrameSource& source, std::uint64_t from, std::function<void(Frame&)> change)
      : source_(source), from_(from), change_(std::move(change)) {}
  FramePtr next() override {
    const FramePtr frame = source_.next();
    if (!frame || frame->index < from_) return frame;
    auto changed = std::make_shared<Frame>(*frame);
    change_(*changed);
    return changed;
  }

 private:
  FrameSource& source_;
  std::uint64_t from_;
  std::function<void(Frame&)> change_;
};

/// Compares a run with a recording to the end; returns the result, and true if it passes.
std::pair<std::string, bool> verified(FrameSource& run, const fs::path& path) {
  RecordingReader recording(path);
  RecordingVerifier verifier(recording);
  FrameSink* const sinks[] = {&verifier};
  pump(run, sinks);
  return {verifier.result(), verifier.passes()};
}

TEST_F(Recording, ARunOfTheSameFramesMatches) {
  record(40);
  Run run(40);
  EXPECT_EQ(verified(run, path_), std::pair(std::string("40 frames match the recording"), true));
}

TEST_F(Recording, WhatDiffersIsNamedByFrameBodyAndFieldWithBothValues) {
  record(40);
  const auto body = [](Frame& frame, std::uint64_t key) -> FrameBody& {
    return *std::ranges::find(frame.bodies, key, &FrameBody::key);
  };
  const auto says = [&](const std::function<void(Frame&)>& change, const std::string& expected) {
    Run run(32);
    Changed changed(run, 31, change);
    const auto [result, passes] = verified(changed, path_);
    EXPECT_EQ(result, "frame 31 differs, after 31 equal frames: " + expected);
    EXPECT_FALSE(passes);
  };
  const std::string wall = "body 14 'wall.0': ";
  says([&](Frame& f) { body(f, 14).X_WB.position.x() += 1e-9; },
       wall + "position (14.5166667, 1.27530556, -2.17) m, recorded as the same to 0.0001 m");
  says([&](Frame& f) { body(f, 14).X_WB.position.x() += 1; },
       wall + "position (15.5166667, 1.27530556, -2.17) m, recorded (14.517, 1.2753, -2.17) m");
  says([&](Frame& f) { body(f, 14).X_WB.rotation = Quat(0, 0, 0, 1); },
       wall + "orientation (x, y, z, w) (0, 0, 1, 0), recorded (0.58403, 0.083502, 0, 0.80743)");
  says([&](Frame& f) { body(f, 14).velocity_W.z() += 3; },
       wall + "velocity (1, -0.0633333333, -1.2) m/s, recorded (1, 0, -4) m/s");
  says([&](Frame& f) { body(f, 14).angular_velocity_W.z() = 0.1; },
       wall + "angular velocity (0, 0, 0.1) rad/s, recorded as the same to 0.5 rad/s");
  says([&](Frame& f) { body(f, 15).asleep = false; },
       "body 15 'ball': not asleep, recorded asleep");
  says([&](Frame& f) { body(f, 14).is_static = true; }, wall + "static, recorded not static");
  says([&](Frame& f) { body(f, 12).X_WB.position.x() += 1e-9, body(f, 14).asleep = true; },
       "body 12: position (12.5166667, 1.27530556, -1.86) m, recorded as the same to 0.0001 m; "
       "1 more body differs");
  says([&](Frame& f) { f.instances.pop_back(); }, "body 26 'wall.0': 2 meshes, recorded 3");
  says([&](Frame& f) { f.instances.back().mesh = MeshIndex(std::size_t{0}); },
       "body 26 'wall.0': its meshes are others");
  says(
      [&](Frame& f) {
        f.instances.clear();
        f.bodies.clear();
      },
      "body 3 'ball' is only in the recording; 23 more bodies differ; 0 bodies, recorded 24");
  says([&](Frame& f) { f.debris.pop_back(); }, "92 particles of debris, recorded 93");
  says([&](Frame& f) { f.dust[5].position_W = Vec3f(1, 2, 3); },
       "particle 5 of dust: position (1, 2, 3) m, recorded (-1.2188, 0.75, -0.5) m");
}

TEST_F(Recording, FramesAfterTheFirstThatDiffersAreCounted) {
  record(40);
  Run run(40, 1e-9, 31);
  const auto [result, passes] = verified(run, path_);
  EXPECT_TRUE(result.starts_with("frame 31 differs, after 31 equal frames: body 12: position "))
      << result;
  EXPECT_TRUE(result.ends_with("; in all, 9 of 40 frames differ")) << result;
  EXPECT_FALSE(passes);
}

TEST_F(Recording, ThatIsShorterOrLongerThanTheRunIsSaidToBe) {
  record(10);
  Run longer(12), shorter(7), later(10);
  EXPECT_EQ(verified(longer, path_),
            std::pair(std::string("10 frames match the recording; it ends with frame 9 and the run "
                                  "goes on: compare the frames that both have by --frames 9"),
                      false));
  EXPECT_EQ(verified(shorter, path_),
            std::pair(std::string("7 frames match the recording; it is longer than the run, by 3 "
                                  "frames"),
                      true));
  for (int i = 0; i < 4; ++i) later.next();
  EXPECT_EQ(verified(later, path_), std::pair(std::string("6 frames match the recording"), true));
}

TEST_F(Recording, ThatBeginsLaterThanTheRunIsSaidTo) {
  {
    Run run(10);
    for (int i = 0; i < 4; ++i) run.next();
    RecordingWriter writer(path_);
    FrameSink* const sinks[] = {&writer};
    pump(run, sinks);
  }
  Run run(10), before(3);
  EXPECT_EQ(verified(run, path_),
            std::pair(std::string("6 frames match the recording; it has none of the 4 frames with "
                                  "which the run begins"),
                      true));
  EXPECT_FALSE(verified(before, path_).second) << "no frame was compared";
}

}  // namespace
}  // namespace sunder
