// Tests of PNG files.
#include "render/image/image.h"

#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "tests/render/test_folder.h"

namespace sunder::render {
namespace {

Image noise(int width, int height) {
  Image image{width, height, {}};
  Random random(3);
  for (int i = 0; i < 3 * width * height; ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(random.below(256)));
  }
  return image;
}

TEST(Png, IsReadAsItWasWritten) {
  const TestFolder folder;
  const Image image = noise(37, 21);
  write_png(folder / "a.png", image);
  EXPECT_EQ(read_png(folder / "a.png"), image);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"a.png"});
}

TEST(Png, AFileThatIsNoPngIsRefusedByName) {
  const TestFolder folder;
  std::ofstream(folder / "b.png") << "not a picture";
  for (const char* name : {"b.png", "missing.png"}) {
    try {
      read_png(folder / name);
      ADD_FAILURE() << name << " was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

// Such a header would take 805 MB before the pixels are found missing.
TEST(Png, AFileThatIsTooShortForItsPixelsIsRefused) {
  const TestFolder folder;
  write_png(folder / "a.png", noise(2, 2));
  std::fstream file(folder / "a.png", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);  // width and height
  file.write("\0\0\x40\0\0\0\x40\0", 8);
  file.close();
  try {
    read_png(folder / "a.png");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("it is truncated"), std::string::npos) << error.what();
  }
}

TEST(Png, AnUnwritablePathIsAnErrorAndLeavesNoFile) {
  const TestFolder folder;
  EXPECT_THROW(write_png("/proc/no/such/folder.png", noise(4, 4)), FileError);
  std::filesystem::create_directories(folder / "taken.png" / "inside");
  EXPECT_THROW(write_png(folder / "taken.png", noise(4, 4)), FileError);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"taken.png"});
}

}  // namespace
}  // namespace sunder::render
