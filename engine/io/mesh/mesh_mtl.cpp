#include "engine/io/mesh/mesh_mtl.h"

#include <algorithm>
#include <cctype>

namespace sunder {
namespace {

using Picture = std::shared_ptr<const std::vector<std::byte>>;

/// From a share of what a screen shows, as MTL has colours, to one of light; within 0.002, and of
/// products alone, so that it is the same everywhere.
float linear(double shown) {
  const double c = std::clamp(shown, 0.0, 1.0);
  return static_cast<float>(c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878));
}

bool is_option_value(std::string_view word) {
  return word == "on" || word == "off" ||
         word.find_first_not_of("+-.0123456789e") == std::string_view::npos;
}

/// What is left of a line that names a picture, without its options.
std::string picture_name(MeshText& text) {
  std::string name;
  bool in_option = false;
  for (std::string_view word; !(word = text.word()).empty();) {
    if (name.empty() && word.starts_with('-')) {
      in_option = true;
    } else if (!name.empty() || !in_option || !is_option_value(word)) {
      name += (name.empty() ? "" : " ") + std::string(word);
    }
  }
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

}  // namespace

std::map<std::string, Paint> read_mtl(const MeshSource& source, const std::string& name) {
  std::map<std::string, Paint> paints;
  const std::optional<std::string> bytes = source.beside(name);
  if (!bytes) return paints;
  const MeshSource file{*bytes, source.file.parent_path() / name, source.limits};
  std::map<std::string, Picture> pictures;
  MeshText text(file);
  Paint none;
  Paint* paint = &none;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "newmtl") {
      paint = &paints[text.words()];
      paint->from_below = true;
    } else if (keyword == "Kd") {
      const std::string_view red = text.word();
      if (red == "spectral" || red == "xyz") continue;
      const double r = text.to_number(red), g = text.number();
      paint->color = Vec3f(linear(r), linear(g), linear(text.number()));
    } else if (keyword == "map_Kd") {
      const std::string picture = picture_name(text);
      const auto [entry, is_new] = pictures.try_emplace(picture);
      if (const auto found = is_new ? source.beside(picture) : std::nullopt) {
        const auto* begin = reinterpret_cast<const std::byte*>(found->data());
        entry->second =
            std::make_shared<const std::vector<std::byte>>(begin, begin + found->size());
      }
      paint->picture = entry->second;
      if (paint->picture && paint->color.isZero()) paint->color.setOnes();  // as exporters mean it
    }
  }
  return paints;
}

}  // namespace sunder
