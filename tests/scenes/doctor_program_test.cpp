// Tests of `sunder doctor` and `sunder --version`, and of the program on a processor that is too
// old for it.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "tests/scenes/program.h"

namespace sunder::tests::doctor_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// Returns the state and the remedy of a finding.
std::string finding(const Figures& figures, const std::string& name) {
  for (int i = 0;; ++i) {
    const std::string at = "/findings/" + std::to_string(i);
    if (text_at(figures, at + "/name").empty()) return "no finding";
    if (text_at(figures, at + "/name") != name) continue;
    return text_at(figures, at + "/state") + ", " + text_at(figures, at + "/remedy");
  }
}

Figures doctor(const std::string& environment, int exit_code) {
  const Outcome outcome = sunder("doctor --json -", environment);
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out << outcome.err;
  return parse_figures(outcome.out, "doctor");
}

TEST(Doctor, ReportsWhatRenderUses) {
  const Folder folder;
  const Figures figures = doctor("SUNDER_CACHE=" + (folder / "cache") + " ", 0);
  EXPECT_EQ(finding(figures, "simulating"), "good, ");
  EXPECT_EQ(finding(figures, "drawing"), "good, ");
  EXPECT_EQ(text_at(figures, "/cache/folder"), folder / "cache");
  const Outcome drawn = sunder("render stack --frames 0 --size 64x48 -o " + (folder / "x.png"));
  for (int i = 0;; ++i) {
    const std::string at = "/gl/" + std::to_string(i);
    ASSERT_NE(text_at(figures, at + "/kind"), "");
    if (!std::get<bool>(figures.at(at + "/used"))) continue;
    EXPECT_TRUE(has(drawn.out, text_at(figures, at + "/text"))) << drawn.out;
    break;
  }
}

TEST(Doctor, CountsTheMeshesOfTheCache) {
  const Folder folder;
  const std::string environment = "SUNDER_CACHE=" + (folder / "cache") + " ";
  EXPECT_EQ(number_at(doctor(environment, 0), "/cache/files"), 0);
  ASSERT_EQ(sunder("check vase", environment).exit_code, 0);
  const Figures figures = doctor(environment, 0);
  EXPECT_EQ(number_at(figures, "/cache/files"), 1);
  const std::filesystem::directory_iterator file(folder / "cache");
  EXPECT_NEAR(number_at(figures, "/cache/size_MB"), 1e-6 * static_cast<double>(file->file_size()),
              1e-9);
}

TEST(Doctor, NamesThePackageOfAMissingFfmpeg) {
  const Folder folder;
  EXPECT_EQ(finding(doctor("PATH=" + folder.path().string() + " ", 0), "videos"),
            "missing, apt-get install ffmpeg");
}

TEST(Doctor, FailsWithoutOpenGlAndNamesThePackages) {
  const Folder folder;
  for (const char* library : {"libEGL.so.1", "libOSMesa.so.8"}) std::ofstream(folder / library);
  const Figures figures = doctor("LD_LIBRARY_PATH=" + folder.path().string() + " ", 1);
  EXPECT_EQ(finding(figures, "drawing"), "failed, apt-get install libegl1 libgl1-mesa-dri");
  EXPECT_EQ(finding(figures, "simulating"), "good, ");
}

TEST(Doctor, SaysHowToDoWithoutAHomeThatCanBeWritten) {
  const Figures figures = doctor("SUNDER_CACHE=/dev/null/cache ", 0);
  EXPECT_EQ(finding(figures, "cache"), "missing, set SUNDER_CACHE to a folder of your own");
  const Figures none = doctor("env -u SUNDER_CACHE -u XDG_CACHE_HOME -u HOME ", 0);
  EXPECT_EQ(finding(none, "cache"), "missing, set HOME or SUNDER_CACHE");
}

TEST(Version, NamesCommitProcessorAndCompiler) {
  const std::string line = sunder("--version").out;
  const std::regex expected(
      "sunder \\d+\\.\\d+\\.\\d+ \\(commit ([0-9a-f]{12}|unknown), [^,]+, [^,]+, [^,]+.*\\)\n");
  EXPECT_TRUE(std::regex_match(line, expected)) << line;
}

TEST(OldProcessor, IsToldTheRemedy) {
  if (!has_program("qemu-x86_64-static")) GTEST_SKIP() << "needs the package qemu-user-static";
  if (!has(sunder("--version").out, "x86-64-v3")) GTEST_SKIP() << "not compiled for x86-64-v3";
  const Outcome outcome = sunder("list", "qemu-x86_64-static -cpu Nehalem ");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_TRUE(has(outcome.err, "compiled for processors with AVX2")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "-DSUNDER_ARCH=x86-64-v2")) << outcome.err;
}

TEST(Video, InAFolderThatCannotBeWrittenNamesTheFolder) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "needs the package ffmpeg";
  const Outcome outcome = sunder("render stack --frames 0:1 --size 64x48 -o /proc/x.mp4");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(has(outcome.err, "/proc/x.mp4: cannot be written; check the folder")) << outcome.err;
}

}  // namespace
}  // namespace sunder::tests::doctor_test
