// scenes/README.md says what the reader's own tables say.
#include <gtest/gtest.h>

#include "scenes/file/text_file.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

TEST(ScenesReadme, ListsEveryKeyWithUnitDefaultAndRange) {
  const std::string readme = read_text(SUNDER_ROOT "/scenes/README.md");
  EXPECT_NE(readme.find(key_reference()), std::string::npos)
      << "scenes/README.md is out of date: replace its reference by the output of\n"
         "  build/sunder list --keys";
}

TEST(ScenesReadme, NamesEveryScene) {
  const std::string readme = read_text(SUNDER_ROOT "/scenes/README.md");
  for (const CatalogEntry& entry : catalog()) {
    EXPECT_NE(readme.find("`" + entry.name + "`"), std::string::npos) << entry.name;
  }
}

}  // namespace
}  // namespace sunder::scenes
