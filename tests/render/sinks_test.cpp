// Tests of video and image files: each is complete, or does not exist.
#include "render/sinks.h"

#include <sys/stat.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "render/renderer.h"
#include "render/sheet.h"
#include "tests/render/synthetic_frame.h"
#include "tests/render/test_folder.h"

namespace sunder::render::sinks_test {
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

/// Returns the standard output of a command; empty if the command cannot be run.
std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return {};
  std::array<char, 4000> text = {};
  const std::size_t size = std::fread(text.data(), 1, text.size(), pipe);
  ::pclose(pipe);
  return std::string(text.data(), size);
}

bool has_ffmpeg() { return !output_of("ffprobe -version").empty(); }

/// Replaces the search path for programs (PATH) during its lifetime.
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
  EXPECT_FALSE(std::filesystem::exists(path)) << "no file until it is complete";
  sink->finish();
  const std::string probed = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
      path.string());
  EXPECT_EQ(probed, "h264,160,90,yuv420p,60/1,9\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "new"), {}), 1);
}

TEST(VideoSink, ColorTagsAreWrittenForAnyRateAndForWebM) {
  if (!has_ffmpeg()) GTEST_SKIP() << "package ffmpeg is not installed";
  const TestFolder folder;
  for (const auto& [name, codec] : {std::pair{"v.mp4", "h264"}, {"v.webm", "vp9"}}) {
    const auto sink = make_picture_sink(folder / name, renderer(), false, 25);
    take_frames(*sink, 3);
    sink->finish();
    const std::string probed = output_of(
        "ffprobe -v error -select_streams v:0 -show_entries stream=codec_name,r_frame_rate,"
        "color_range,color_space,color_transfer,color_primaries -of csv=p=0 " +
        (folder / name).string());
    EXPECT_EQ(probed, std::string(codec) + ",tv,bt709,bt709,bt709,25/1\n");
  }
}

TEST(VideoSink, ColorsAreReadBackAsTheyWereDrawn) {
  if (!has_ffmpeg()) GTEST_SKIP() << "package ffmpeg is not installed";
  const TestFolder folder;
  const std::string video = (folder / "v.mp4").string(), back = (folder / "b.png").string();
  const auto sink = make_picture_sink(video, renderer());
  take_frames(*sink, 1);
  sink->finish();
  output_of("ffmpeg -v error -i " + video +
            " -vf scale=flags=accurate_rnd+full_chroma_int -frames:v 1 " + back);
  const Image drawn = renderer().draw(*frame_number(0)), shown = read_png(back);
  double off[3] = {};
  for (std::size_t i = 0; i < drawn.rgb.size(); ++i) off[i % 3] += shown.rgb[i] - drawn.rgb[i];
  for (const double sum : off) {
    EXPECT_LT(std::abs(sum) / static_cast<double>(drawn.rgb.size() / 3), 0.7)
        << "of 255, in the mean";
  }
}

TEST(VideoSink, WithoutFinishLeavesNoFile) {
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

TEST(VideoSink, AnFfmpegThatFailsIsAnErrorWithItsMessageAndNotASignal) {
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

TEST(VideoSink, AnFfmpegThatFailsWithExitStatusZeroIsAnErrorToo) {
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

TEST(VideoSink, AMessageOfFfmpegIsAnErrorBeforeTheNextFrameIsDrawn) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "bin");
  const std::filesystem::path program = folder / "bin" / "ffmpeg";
  std::ofstream(program) << "#!/bin/sh\necho no space left >&2\nexec /bin/cat >/dev/null\n";
  ::chmod(program.c_str(), 0755);
  const SearchPath fake(folder / "bin");
  const auto sink = make_picture_sink(folder / "v.mp4", renderer());
  // More frames than the pipe holds: ffmpeg has printed its message before it reads the last.
  EXPECT_THROW(take_frames(*sink, 60), FileError);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"bin"});
}

TEST(VideoSink, AnOddSizeIsRefusedWithAnEvenOneWhileAPictureMayHaveIt) {
  const TestFolder folder;
  Renderer odd({.width = 161, .height = 91});
  try {
    make_picture_sink(folder / "v.mp4", odd);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("use --size 162x92"), std::string::npos)
        << error.what();
  }
  const auto sink = make_picture_sink(folder / "p.png", odd);
  take_frames(*sink, 1);
  sink->finish();
  EXPECT_EQ(read_png(folder / "p.png").width, 161);
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

/// Returns a part of an image.
Image cut(const Image& all, int left, int top, int width, int height) {
  Image part{width, height, {}};
  for (int y = top; y < top + height; ++y) {
    const auto row = all.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * all.width + left);
    part.rgb.insert(part.rgb.end(), row, row + 3 * static_cast<std::ptrdiff_t>(width));
  }
  return part;
}

TEST(SheetSink, HasFramesEvenlySpacedOverTheRunSideBySide) {
  const TestFolder folder;
  const auto sink = make_sheet_sink(folder / "s.png", renderer(), {0, 8, 5}, false);
  take_frames(*sink, 9);
  EXPECT_TRUE(folder.contents().empty());
  sink->finish();
  const Image sheet = read_png(folder / "s.png");
  EXPECT_EQ(sheet.width, 3 * 160 + 2 * 4);
  EXPECT_EQ(sheet.height, 2 * 90 + 4);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(cut(sheet, i % 3 * 164, i / 3 * 94, 160, 90),
              renderer().draw(*frame_number(2 * static_cast<std::uint64_t>(i))))
        << i;
  }
}

TEST(SheetSink, WritesTheTimesAndIsSmallerIfTheRunEndsEarly) {
  const TestFolder folder;
  const auto sink = make_sheet_sink(folder / "s.png", renderer(), {0, 8, 5});
  take_frames(*sink, 3);
  sink->finish();
  const Image sheet = read_png(folder / "s.png");
  EXPECT_EQ(sheet.width, 2 * 160 + 4);
  EXPECT_EQ(sheet.height, 90);
  EXPECT_NE(cut(sheet, 0, 0, 160, 90), renderer().draw(*frame_number(0)));
}

TEST(SheetSink, AWrongFileNameOrCountIsRefused) {
  const TestFolder folder;
  EXPECT_THROW(make_sheet_sink(folder / "s.mp4", renderer(), {0, 8, 5}), InputError);
  EXPECT_THROW(make_sheet_sink(folder / "s.png", renderer(), {0, 3, 5}), InputError);
  EXPECT_THROW(make_sheet_sink(folder / "s.png", renderer(), {0, 99999, 90000}), InputError);
}

TEST(ImageSink, AnUnknownKindOfFileIsRefused) {
  const TestFolder folder;
  EXPECT_THROW(make_picture_sink(folder / "v.avi", renderer()), InputError);
}

}  // namespace
}  // namespace sunder::render::sinks_test
