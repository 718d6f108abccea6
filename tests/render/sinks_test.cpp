// Videos and images: complete, or not there.
#include "render/sinks.h"

#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"
#include "tests/render/test_folder.h"

namespace sunder::render {
namespace {

Renderer& renderer() {
  static Renderer shared({.width = 160, .height = 90});
  return shared;
}

FramePtr frame_number(std::uint64_t index) {
  SyntheticFrame s;
  s.add_ball({0, 1 + 0.1 * static_cast<double>(index), 0}, 0.5, Stuff::kSteel);
  s.frame.index = index;
  return std::make_shared<const Frame>(s.frame);
}

void take_frames(FrameSink& sink, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) sink.take(frame_number(i));
}

/// What a command prints; empty if it cannot be run.
std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return {};
  std::array<char, 4000> text = {};
  const std::size_t size = std::fread(text.data(), 1, text.size(), pipe);
  ::pclose(pipe);
  return std::string(text.data(), size);
}

bool has_ffmpeg() { return !output_of("ffprobe -version").empty(); }

/// The search path for programs, while a test wants another.
class SearchPath {
 public:
  explicit SearchPath(const std::filesystem::path& folder) : before_(std::getenv("PATH")) {
    ::setenv("PATH", folder.c_str(), 1);
  }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::string before_;
};

TEST(VideoSink, WritesAPlayableFileWithEveryFrame) {
  if (!has_ffmpeg()) GTEST_SKIP() << "package ffmpeg is not installed";
  const TestFolder folder;
  const std::filesystem::path path = folder / "new/v.mp4";
  const auto sink = make_picture_sink(path, renderer());
  take_frames(*sink, 9);
  EXPECT_FALSE(std::filesystem::exists(path)) << "nothing stands there until it is complete";
  sink->finish();
  const std::string probed = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
      path.string());
  EXPECT_EQ(probed, "h264,160,90,yuv420p,60/1,9\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "new"), {}), 1);
}

TEST(VideoSink, GivenUpItLeavesNothing) {
  if (!has_ffmpeg()) GTEST_SKIP() << "package ffmpeg is not installed";
  const TestFolder folder;
  {
    const auto sink = make_picture_sink(folder / "v.mp4", renderer());
    take_frames(*sink, 3);
  }
  EXPECT_TRUE(folder.contents().empty());
}

TEST(VideoSink, AMissingFfmpegIsAnErrorThatNamesThePackage) {
  const TestFolder folder;
  const SearchPath nowhere(folder / "nowhere");
  try {
    make_picture_sink(folder / "v.mp4", renderer());
    ADD_FAILURE() << "made without ffmpeg";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install ffmpeg"), std::string::npos);
  }
  EXPECT_TRUE(folder.contents().empty());
}

TEST(VideoSink, AnFfmpegThatFailsIsAnErrorWithItsWordsAndNotASignal) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "bin");
  const std::filesystem::path program = folder / "bin" / "ffmpeg";
  std::ofstream(program) << "#!/bin/sh\necho no such codec >&2\nexit 3\n";
  ::chmod(program.c_str(), 0755);
  const SearchPath fake(folder / "bin");
  try {
    const auto sink = make_picture_sink(folder / "v.mp4", renderer());
    take_frames(*sink, 40);
    sink->finish();
    ADD_FAILURE() << "the failure went unnoticed";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("no such codec"), std::string::npos) << error.what();
  }
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"bin"});
}

TEST(VideoSink, AnFfmpegThatFailsWithoutSayingSoInItsStatusIsAnErrorToo) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "bin");
  const std::filesystem::path program = folder / "bin" / "ffmpeg";
  std::ofstream(program) << "#!/bin/sh\n/bin/cat >/dev/null\necho no space left >&2\nexit 0\n";
  ::chmod(program.c_str(), 0755);
  const SearchPath fake(folder / "bin");
  const auto sink = make_picture_sink(folder / "v.mp4", renderer());
  take_frames(*sink, 2);
  EXPECT_THROW(sink->finish(), FileError);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"bin"});
}

TEST(VideoSink, AnOddSizeIsRefused) {
  const TestFolder folder;
  Renderer odd({.width = 161, .height = 90});
  EXPECT_THROW(make_picture_sink(folder / "v.mp4", odd), InputError);
}

TEST(ImageSink, APngIsTheLastFrame) {
  const TestFolder folder;
  const auto sink = make_picture_sink(folder / "last.png", renderer());
  take_frames(*sink, 3);
  EXPECT_TRUE(folder.contents().empty());
  sink->finish();
  EXPECT_EQ(read_png(folder / "last.png"), renderer().draw(*frame_number(2)));
}

TEST(ImageSink, AFolderGetsEveryFrameByNumber) {
  const TestFolder folder;
  const auto sink = make_picture_sink(folder / "frames/", renderer());
  take_frames(*sink, 2);
  sink->finish();
  EXPECT_EQ(read_png(folder / "frames/frame_00001.png"), renderer().draw(*frame_number(1)));
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/frame_00000.png"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "frames"), {}), 2);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"frames"});
}

TEST(ImageSink, AFolderThatIsResumedKeepsItsPictures) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "frames");
  const Image other = renderer().draw(*frame_number(5));
  write_png(folder / "frames/frame_00001.png", other);
  const auto sink = make_picture_sink(folder / "frames/", renderer(), true);
  take_frames(*sink, 3);
  sink->finish();
  EXPECT_EQ(read_png(folder / "frames/frame_00001.png"), other);
  EXPECT_EQ(read_png(folder / "frames/frame_00002.png"), renderer().draw(*frame_number(2)));
  EXPECT_THROW(make_picture_sink(folder / "v.mp4", renderer(), true), InputError);
}

TEST(ImageSink, AnUnknownKindOfFileIsRefused) {
  const TestFolder folder;
  EXPECT_THROW(make_picture_sink(folder / "v.avi", renderer()), InputError);
}

}  // namespace
}  // namespace sunder::render
