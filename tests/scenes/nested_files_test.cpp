// Files of 20,000 keys, tables or arrays in each other, and files that are too large: all are
// refused before a parser, or the end of what it made, calls itself that often.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "engine/io/mesh/mesh_reader.h"
#include "scenes/load.h"
#include "tests/scenes/refusal.h"

namespace sunder::scenes {
namespace {

constexpr int kDeep = 20000;

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(NestedFiles, ScenesAreRefusedWithTheirLine) {
  const std::string deep[] = {
      "a" + repeated(".a", kDeep) + " = 1\n",
      "\"a\"" + repeated(" . 'a'", kDeep) + " = 1\n",
      "[a" + repeated(".a", kDeep) + "]\n",
      "[[a" + repeated(".a", kDeep) + "]]\n",
      "x = " + repeated("[", kDeep) + repeated("]", kDeep) + "\n",
      "x = " + repeated("[", kDeep),
      "x = " + repeated("{a = ", kDeep) + "1" + repeated("}", kDeep) + "\n",
      "x = " + repeated("{a" + repeated(".a", 30) + " = ", kDeep / 30) + "1\n",
  };
  for (const std::string& text : deep) {
    const std::string said = refusal(kGood + text);
    EXPECT_EQ(said.find("bad.toml:3: more than 32 tables and arrays are nested"), 0u)
        << text.substr(0, 40) << ": " << said.substr(0, 200);
  }
  const std::string lines = "x = [\n" + repeated("[\n", kDeep);
  EXPECT_EQ(refusal(kGood + lines).find("bad.toml:35: more than 32"), 0u);
}

TEST(NestedFiles, FlagsAreRefusedInAShortMessage) {
  for (const std::string& assignment :
       {"a" + repeated(".a", kDeep) + "=1", "x=" + repeated("[", kDeep),
        "x=1\n[a" + repeated(".a", kDeep) + "]"}) {
    const std::string said = refusal(kGood, {.set = {assignment}});
    EXPECT_NE(said.find("more than 32 tables and arrays are nested"), std::string::npos)
        << said.substr(0, 300);
    EXPECT_LT(said.size(), 400u);
  }
}

// Brackets in strings and comments, and tables beside each other, do not count as nested.
TEST(NestedFiles, DotsAndBracketsThatDoNotNestAreAccepted) {
  const std::string many = repeated("[.{", 100);
  const std::string good[] = {
      "# " + many + "\n",
      "[view]\neye = [1.5, 2.5, 3.5]\n",
      "[ground]\n[[ground.mesh]]\nheights_m = [" +
          repeated("[" + repeated("0.25, ", 60) + "0.5],", 40) +
          "]\nwidth_m = 9.5\ndepth_m = 9.5\n",
  };
  for (const std::string& text : good) EXPECT_EQ(refusal(kGood + text), "");
  for (const std::string& quoted :
       {"\"" + many + "\"", "'" + many + "'", "\"\"\"" + many + "\\\"\"\"\"\"\"",
        "'''" + many + "'''", "\"\\\"" + many + "\""})
    EXPECT_EQ(refusal("[scene]\ndescription = " + quoted + "\n"), "") << quoted;
}

TEST(NestedFiles, JsonIsRefused) {
  for (const std::string& text : {repeated("[", kDeep), repeated("[", kDeep) + repeated("]", kDeep),
                                  repeated("{\"a\":", kDeep) + "1" + repeated("}", kDeep)})
    EXPECT_THROW(parse_figures(text, "deep.json"), InputError);
  for (const std::string& inner : {repeated("[", kDeep) + repeated("]", kDeep),
                                   repeated("{\"a\":", kDeep) + "1" + repeated("}", kDeep)}) {
    const std::string gltf = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + inner + "}";
    EXPECT_THROW(parse_mesh(std::as_bytes(std::span(gltf)), MeshFormat::kGltf, "deep.gltf"),
                 InputError);
  }
}

TEST(LargeFiles, AreRefusedByTheirKindBeforeTheyAreRead) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sunder-large-" + std::to_string(getpid()));
  std::ofstream(file) << "x";
  std::filesystem::resize_file(file, file_kinds::kState.most_bytes + 1);  // takes no space
  for (const FileKind& kind : {file_kinds::kScene, file_kinds::kFigures, file_kinds::kState}) {
    try {
      read_file(file, kind);
      ADD_FAILURE() << kind.name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what())
                    .find(std::string(kind.name) + " may have at most " +
                          std::to_string(kind.most_bytes)),
                std::string::npos)
          << error.what();
    }
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace sunder::scenes
