#include "engine/io/mesh/mesh_mtl.h"

#include <algorithm>
#include <cctype>

namespace sunder {
namespace {

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

/// A line that names a picture: what is left of it without its options, and one of these.
struct PictureUse {
  std::string name;
  double steeper = 1;  ///< -bm.
};

PictureUse take_picture_use(MeshText& text) {
  PictureUse use;
  bool in_option = false;
  for (std::string_view word; !(word = text.word()).empty();) {
    if (use.name.empty() && word == "-bm") {
      use.steeper = text.number();
    } else if (use.name.empty() && (word == "-imfchan" || word == "-type")) {
      text.word();  // a word, and no number
    } else if (use.name.empty() && word.starts_with('-')) {
      in_option = true;
    } else if (!use.name.empty() || !in_option || !is_option_value(word)) {
      use.name += (use.name.empty() ? "" : " ") + std::string(word);
    }
  }
  std::replace(use.name.begin(), use.name.end(), '\\', '/');
  return use;
}

/// The pictures beside a file, each read once.
class PicturesBeside {
 public:
  explicit PicturesBeside(const MeshSource& source) : source_(source) {}

  /// Null if there is none of that name.
  Picture find(const std::string& name) {
    const auto [entry, is_new] = known_.try_emplace(name);
    if (const auto found = is_new ? source_.beside(name) : std::nullopt) {
      const auto* begin = reinterpret_cast<const std::byte*>(found->data());
      entry->second = std::make_shared<const std::vector<std::byte>>(begin, begin + found->size());
    }
    return entry->second;
  }

 private:
  const MeshSource& source_;
  std::map<std::string, Picture> known_;
};

}  // namespace

std::map<std::string, Paint> read_mtl(const MeshSource& source, const std::string& name) {
  std::map<std::string, Paint> paints;
  const std::optional<std::string> bytes = source.beside(name);
  if (!bytes) return paints;
  const MeshSource file{*bytes, source.file.parent_path() / name, source.limits};
  PicturesBeside pictures(source);
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
      paint->picture = pictures.find(take_picture_use(text).name);
      if (paint->picture && paint->color.isZero()) paint->color.setOnes();  // as exporters mean it
    } else if (keyword == "norm" ||
               (!paint->relief &&
                (keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump"))) {
      const PictureUse use = take_picture_use(text);
      paint->relief = pictures.find(use.name);
      paint->relief_scale = static_cast<float>(use.steeper);
    }
  }
  return paints;
}

}  // namespace sunder
