#include "scenes/file/patterns.h"

#include "engine/base/check.h"
#include "fracture/pattern/pattern.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

constexpr int kMostAlongGrid = 30;

}  // namespace

void read_pattern(const Value& table, const std::filesystem::path& folder, PatternSpec& pattern) {
  read(schema().pattern, table, {}, pattern);
  using Kind = PatternSpec::Kind;
  if (pattern.kind == Kind::kGrid && pattern.cells > kMostAlongGrid) {
    const Value* cells = find(table, "cells");
    throw InputError((cells ? *cells : table).where + ": cells in [material.pattern] is " +
                     std::to_string(pattern.cells) + " along each side of a grid; allowed: 2 to " +
                     std::to_string(kMostAlongGrid));
  }
  if (pattern.kind != Kind::kFile) return;
  const Value* file = find(table, "file");
  if (pattern.file.empty()) {
    throw InputError(table.where +
                     ": kind = \"file\" in [material.pattern] needs file = \"X.obj\"");
  }
  if (file) pattern.file = (folder / pattern.file).string();
  try {
    fracture::make_pattern(pattern, {}, 0);
  } catch (const InputError& error) {
    throw InputError((file ? *file : table).where + ": " + error.what());
  }
}

void read_stronger(const Value& table, const std::filesystem::path& folder, Material& material) {
  if (!find(table, "stronger")) return;
  material.stronger.clear();
  for (const Value* entry : tables(table, "stronger")) {
    StrongerImpact impact{0, material.pattern, material.impact_radius_m};
    read(schema().stronger, *entry, {}, impact);
    if (const Value* pattern = find(*entry, "pattern")) {
      read_pattern(*pattern, folder, impact.pattern);
    }
    if (!material.stronger.empty() && impact.energy_J <= material.stronger.back().energy_J) {
      throw InputError(entry->where + ": energy_J in [[material.stronger]] is " +
                       format(impact.energy_J) +
                       ", no more than in the entry before it; let them ascend");
    }
    material.stronger.push_back(std::move(impact));
  }
}

}  // namespace sunder::scenes
