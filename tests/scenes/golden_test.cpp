// Golden images: what the stored frames give today, and whether the comparison can tell at all.
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "render/image/compare.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

namespace fs = std::filesystem;
constexpr const char* kGoldens[] = {"brick_wall", "glass", "house"};

fs::path baseline(const std::string& name) {
  return fs::path(SUNDER_ROOT) / "tests/golden" / (name + ".png");
}

TEST(Golden, StoredFramesLookAsTheyDid) {
  const Folder folder;
  const Outcome outcome = sunder("golden test --out " + folder / "out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(Golden, EveryPairOfDifferentBaselinesIsToldApart) {
  for (const std::string a : kGoldens) {
    for (const std::string b : kGoldens) {
      const bool same =
          render::compare(render::read_png(baseline(a)), render::read_png(baseline(b)))
              .passes(render::Thresholds());
      EXPECT_EQ(same, a == b) << a << " against " << b;
    }
  }
}

TEST(Golden, AMissingBaselineFailsUntilItIsAccepted) {
  const Folder folder;
  for (const char* extension : {".frame", ".json"}) {
    const fs::path file =
        fs::path(SUNDER_ROOT) / "tests/golden" / (std::string("glass") + extension);
    fs::copy(file, folder.path());
  }
  const std::string at = " --folder " + folder.path().string() + " --out " + folder / "out";
  const Outcome missing = sunder("golden test glass" + at);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.out.find("no baseline"), std::string::npos) << missing.out;
  EXPECT_EQ(sunder("golden accept glass --folder " + folder.path().string()).exit_code, 0);
  EXPECT_EQ(sunder("golden test glass" + at).exit_code, 0);
  EXPECT_EQ(sunder("golden report glass" + at).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}

TEST(Golden, AWrongPictureFails) {
  const Folder folder;
  const fs::path goldens = fs::path(SUNDER_ROOT) / "tests/golden";
  fs::copy(goldens / "glass.json", folder.path());
  fs::copy(goldens / "glass.frame", folder.path());
  fs::copy(goldens / "house.png", fs::path(folder / "glass.png"));
  const Outcome outcome =
      sunder("golden test --folder " + folder.path().string() + " --out " + folder / "out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("different"), std::string::npos) << outcome.out;
}

TEST(Golden, AFileThatAsksForAPictureOfNoSizeOrHasNoEndIsRefused) {
  const Folder folder;
  const fs::path goldens = fs::path(SUNDER_ROOT) / "tests/golden";
  fs::copy(goldens / "glass.frame", folder.path());
  const std::string lists(1 << 20, '[');
  for (const std::string& text : {std::string(R"({"width": -5, "height": 360})"),
                                  std::string(R"({"width": 2000000000, "height": 360})"), lists}) {
    std::ofstream(folder / "glass.json") << text;
    EXPECT_EQ(sunder("golden test --folder " + folder.path().string()).exit_code, 2)
        << text.substr(0, 40);
  }
}

}  // namespace
}  // namespace sunder::tests
