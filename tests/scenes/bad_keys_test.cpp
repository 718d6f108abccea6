// Tests of every key of objects and scripts with faults: missing where required, of a wrong type,
// out of range. The keys are those of the tables of the reader.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/file/body.h"
#include "scenes/file/joint.h"
#include "scenes/file/placement.h"
#include "scenes/file/schema.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

/// Lines of a table that is accepted: values by key.
using Lines = std::map<std::string, std::string>;

struct Sample {
  std::string header;
  std::string_view table;
  std::span<const Key> keys;
  Lines lines;
};

std::vector<Sample> samples() {
  const Schema& all = schema();
  return {
      {"[[joint]]",
       joint_keys().table,
       joint_keys().keys,
       {{"kind", "\"ball\""}, {"a", "\"x\""}, {"at", "[0, 1, 0]"}}},
      {"[[ball]]", all.ball.table, all.ball.keys, {}},
      {"[[body]]", body_keys().table, body_keys().keys, {{"mesh", "\"box:1,1,1\""}}},
      {"[[body]]", mesh_keys().table, mesh_keys().keys, {{"mesh", "\"box:1,1,1\""}}},
      {"[[body]]", "[[body]]", placement_keys().keys, {{"mesh", "\"box:1,1,1\""}}},
      {"[[solid]]", "[[solid]]", placement_keys().keys, {{"structure", "\"box\""}}},
      {"[[solid]]\nstructure = \"compound\"\n[[solid.part]]",
       "[[solid.part]]",
       placement_keys().keys,
       {{"structure", "\"box\""}}},
      {"[script]", all.script.table, all.script.keys, {}},
      {"[[script.shot]]",
       all.shot.table,
       all.shot.keys,
       {{"time_s", "1"}, {"from", "[0, 5, 5]"}, {"at", "[0, 1, 0]"}}},
      {"[[script.wrecking_ball]]",
       all.wrecking_ball.table,
       all.wrecking_ball.keys,
       {{"from", "[3, 5, 0]"}, {"hangs_from", "[0, 9, 0]"}}},
      {"[[script.blast]]", all.blast.table, all.blast.keys, {{"time_s", "1"}, {"at", "[0, 1, 0]"}}},
      {"[[script.remove]]",
       all.remove.table,
       all.remove.keys,
       {{"time_s", "1"}, {"name", "\"x\""}}},
      {"[[script.drive]]",
       all.drive.table,
       all.drive.keys,
       {{"name", "\"x\""}, {"velocity", "[1, 0, 0]"}}},
      {"[[script.move]]",
       all.move.table,
       all.move.keys,
       {{"name", "\"x\""}, {"key", "[{ time_s = 1 }]"}}},
      {"[[script.move]]\nname = \"x\"\n[[script.move.key]]",
       all.move_key.table,
       all.move_key.keys,
       {{"time_s", "1"}}},
  };
}

constexpr const char* kBefore =
    "[scene]\ndescription = \"x\"\n[[solid]]\nstructure = \"box\"\nname = \"x\"\n";
constexpr int kLinesBefore = 5;

struct Answer {
  std::string said;
  int line = 0;  ///< Line of the key, or of the table if the key is absent.
};

/// Returns the message about a sample with one key changed, or removed if `value` is null.
Answer answer_to(const Sample& sample, const std::string& key, const std::string* value) {
  Lines lines = sample.lines;
  if (value) {
    lines[key] = *value;
  } else {
    lines.erase(key);
  }
  Answer answer;
  std::string text = kBefore + sample.header + "\n";
  answer.line = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  int at = answer.line;
  for (const auto& [name, given] : lines) {
    ++at;
    if (name == key) answer.line = at;
    text += name + " = " + given + "\n";
  }
  try {
    parse_scene(text, "bad.toml", {});
  } catch (const InputError& error) {
    answer.said = error.what();
  }
  return answer;
}

/// Returns values that are wrong for a key.
std::vector<std::string> wrong_values(const Key& key) {
  using Kind = Key::Kind;
  std::vector<std::string> wrong = {"{ x = 1 }"};  // no key but those of tables has a table
  const bool vector = key.kind == Kind::kVector || key.kind == Kind::kColor;
  const bool number = key.kind == Kind::kInteger || key.kind == Kind::kCount ||
                      key.kind == Kind::kNumber || key.kind == Kind::kSeed;
  if (vector) {
    wrong.insert(wrong.end(), {"1", "[1, 2]", "[1, 2, \"x\"]", "[1, 2, nan]"});
    wrong.push_back("[0, " + format(2 * key.range.high + 1) + ", 0]");
    wrong.push_back("[0, 0, " + format(2 * key.range.low - 1) + "]");
  } else if (number) {
    wrong.insert(wrong.end(), {"\"1\"", "true", "[1]", "nan"});
    if (key.kind != Kind::kNumber) wrong.push_back("1.5");
    if (key.range.high < 1e300) wrong.push_back(format(2 * key.range.high + 1));
    wrong.push_back(format(key.range.low - 1));
  } else if (key.kind == Kind::kBool) {
    wrong.insert(wrong.end(), {"1", "\"true\"", "[true]"});
  } else if (key.kind == Kind::kChoice) {
    wrong.insert(wrong.end(), {"1", "\"nonesuch\"", "\"\""});
  } else if (key.kind == Kind::kText) {
    wrong.insert(wrong.end(), {"1", "true", "\"\"", "[\"x\"]"});
  } else if (key.kind == Kind::kMaterial) {
    wrong.push_back("1");
  }
  return wrong;
}

TEST(BadKeys, EverySampleIsAcceptedUnchanged) {
  for (const Sample& sample : samples())
    EXPECT_EQ(answer_to(sample, "no such", nullptr).said, "") << sample.table;
}

TEST(BadKeys, AWrongValueIsRefusedWithItsLineAndTheAllowedValues) {
  std::size_t tried = 0;
  for (const Sample& sample : samples()) {
    for (const Key& key : sample.keys) {
      if (key.kind == Key::Kind::kTable) continue;
      for (const std::string& value : wrong_values(key)) {
        const Answer answer = answer_to(sample, std::string(key.name), &value);
        const std::string start =
            "bad.toml:" + std::to_string(answer.line) + ": " + std::string(key.name) + " in ";
        EXPECT_TRUE(answer.said.starts_with(start) &&
                    answer.said.find("; allowed: " + allowed(key)) != std::string::npos)
            << sample.table << " " << key.name << " = " << value << "\nsaid: " << answer.said;
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 250u);
}

// The limits of keys are tested above against themselves; here against what exists.
TEST(BadKeys, LimitsAllowWhatExistsAndNothingImpossible) {
  struct Values {
    std::string header, key;
    std::vector<std::string> real, impossible;
  };
  const std::string material = "[[material]]\nname = \"brick\"\n";
  const std::string web = material + "[material.pattern]\nkind = \"web\"\n";
  const std::string dust = material + "[material.crumbling]\n";
  const std::string blast = "[[script.blast]]\ntime_s = 1\nat = [0, 1, 0]\n";
  for (const Values& values : std::vector<Values>{
           // Aerogel, osmium.
           {material, "density_kg_m3", {"1.5", "22600"}, {"0", "-1"}},
           // Ice on ice, rubber on rock.
           {material, "friction", {"0.02", "1.5"}, {"-0.1"}},
           {material, "restitution", {"0", "1"}, {"-0.1", "1.1"}},
           {material, "rolling", {"0", "0.3"}, {"-0.1"}},
           // Soft wood across the grain, diamond.
           {material, "youngs_Pa", {"1e8", "1.2e12"}, {"0", "-1"}},
           {material, "compressive_Pa", {"0", "2e8"}, {"-1"}},
           {material, "reinforcement_percent", {"0", "4"}, {"-1", "101"}},
           {web, "spokes", {"3", "40"}, {"2", "-1"}},
           {web, "rings", {"1", "20"}, {"0"}},
           {web, "jitter", {"0", "1"}, {"-0.1", "1.1"}},
           {dust, "debris_ratio", {"0", "1"}, {"-0.1", "1.1"}},
           // Weightlessness, the surface of Jupiter, a ceiling.
           {"", "gravity", {"[0, 0, 0]", "[0, -24.8, 0]", "[0, 9.81, 0]"}, {"[0, inf, 0]"}},
           {"", "duration_s", {"0.1", "60"}, {"0", "-1"}},
           {blast, "tnt_kg", {"0.1", "1000"}, {"-1"}},
       }) {
    const bool of_scene = values.header.empty();
    const auto message = [&](const std::string& value) {
      const std::string line = values.key + " = " + value + "\n";
      try {
        parse_scene("[scene]\ndescription = \"x\"\n" + (of_scene ? line : values.header + line),
                    "bad.toml", {});
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    for (const std::string& value : values.real) EXPECT_EQ(message(value), "");
    for (const std::string& value : values.impossible)
      EXPECT_NE(message(value).find("; allowed: "), std::string::npos)
          << values.key << " " << value;
  }
}

TEST(BadKeys, AMissingRequiredKeyIsNamed) {
  for (const Sample& sample : samples()) {
    for (const Key& key : sample.keys) {
      if (!key.required) continue;
      const Answer answer = answer_to(sample, std::string(key.name), nullptr);
      const std::string start = "bad.toml:" + std::to_string(answer.line) + ": missing key '" +
                                std::string(key.name) + "' in " + std::string(sample.table) + ": ";
      EXPECT_TRUE(answer.said.starts_with(start)) << "said: " << answer.said;
    }
  }
}

TEST(BadKeys, AnUnknownKeyIsNamed) {
  const std::string value = "1";
  for (const Sample& sample : samples()) {
    const Answer answer = answer_to(sample, "nonesuch", &value);
    const std::string start = "bad.toml:" + std::to_string(answer.line) +
                              ": unknown key 'nonesuch' in " + std::string(sample.table);
    EXPECT_TRUE(answer.said.starts_with(start)) << "said: " << answer.said;
  }
}

TEST(BadKeys, AnUnknownNameIsRefusedWithASuggestion) {
  const std::string nobody = "\"y\"", no_material = "\"stel\"";
  for (const Sample& sample : samples()) {
    for (const Key& key : sample.keys) {
      const bool is_material = key.kind == Key::Kind::kMaterial;
      const bool refers = sample.header == "[[joint]]" || sample.header == "[[script.remove]]" ||
                          sample.header == "[[script.drive]]" || sample.header == "[[script.move]]";
      if (!is_material && !(refers && key.kind == Key::Kind::kText)) continue;
      const Answer answer =
          answer_to(sample, std::string(key.name), is_material ? &no_material : &nobody);
      const std::string start =
          "bad.toml:" + std::to_string(answer.line) +
          (is_material ? ": unknown material 'stel'; did you mean 'steel'?"
                       : ": no solid or ball is named 'y'; did you mean 'x'?");
      EXPECT_TRUE(answer.said.starts_with(start))
          << sample.table << " " << key.name << "\nsaid: " << answer.said;
    }
  }
}

}  // namespace
}  // namespace sunder::scenes
