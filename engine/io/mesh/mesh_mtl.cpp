#include "engine/io/mesh/mesh_mtl.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sunder {
namespace {

/// Converts an sRGB component to linear; within 0.002. Uses products only, for equal results on
/// every machine.
float linear(double shown) {
  const double c = std::clamp(shown, 0.0, 1.0);
  return static_cast<float>(c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878));
}

/// Returns the roughness whose highlights are as wide as those of a Blinn-Phong exponent.
float roughness_of(double exponent) {
  return static_cast<float>(std::sqrt(std::sqrt(2 / (std::max(exponent, 0.0) + 2))));
}

float share(double number) { return static_cast<float>(std::clamp(number, 0.0, 1.0)); }

/// A material as an MTL file defines it.
struct MtlMaterial {
  Appearance appearance;
  std::optional<float> roughness, metallic;  ///< Pr and Pm.
  std::optional<double> exponent;            ///< Ns.
  bool has_highlights = true;                ///< False if Ks is black.

  Appearance resolved() const {
    Appearance result = appearance;
    if (!roughness && !metallic && !(exponent && has_highlights)) return result;
    result.gloss.emplace().metallic = metallic.value_or(0);
    if (roughness || (exponent && has_highlights)) {
      result.gloss->roughness = roughness ? *roughness : roughness_of(*exponent);
    }
    return result;
  }
};

/// Returns an RGB colour; nothing for other colour formats.
std::optional<Vec3> take_color(MeshText& text) {
  const std::string_view red = text.word();
  if (red == "spectral" || red == "xyz") return std::nullopt;
  const double r = text.to_number(red), g = text.number();
  return Vec3(r, g, text.number());
}

bool is_option_value(std::string_view word) {
  return word == "on" || word == "off" ||
         word.find_first_not_of("+-.0123456789e") == std::string_view::npos;
}

/// Reference to an image, with the option that is used; other options are skipped.
struct PictureUse {
  std::string name;
  double scale = 1;  ///< Factor of the height map (-bm).
};

PictureUse take_picture_use(MeshText& text) {
  PictureUse use;
  bool in_option = false;
  for (std::string_view word; !(word = text.word()).empty();) {
    if (use.name.empty() && word == "-bm") {
      use.scale = text.number();
    } else if (use.name.empty() && (word == "-imfchan" || word == "-type")) {
      text.word();  // these options have a non-numeric value
    } else if (use.name.empty() && word.starts_with('-')) {
      in_option = true;
    } else if (!use.name.empty() || !in_option || !is_option_value(word)) {
      use.name += (use.name.empty() ? "" : " ") + std::string(word);
    }
  }
  std::replace(use.name.begin(), use.name.end(), '\\', '/');
  return use;
}

/// Images in the folder of a file; each is read once.
class FolderImages {
 public:
  FolderImages(const MeshSource& source, std::vector<std::string>& missing)
      : source_(source), missing_(missing) {}

  /// Returns an image; null if the file is missing.
  EncodedImage find(const std::string& name) {
    const auto [entry, is_new] = known_.try_emplace(name);
    if (!is_new) return entry->second;
    if (const auto found = source_.beside(name)) {
      const auto* begin = reinterpret_cast<const std::byte*>(found->data());
      entry->second = std::make_shared<const std::vector<std::byte>>(begin, begin + found->size());
    } else if (!name.empty()) {
      missing_.push_back(name);
    }
    return entry->second;
  }

 private:
  const MeshSource& source_;
  std::vector<std::string>& missing_;
  std::map<std::string, EncodedImage> known_;
};

}  // namespace

std::map<std::string, Appearance> read_mtl(const MeshSource& source, const std::string& name,
                                           std::vector<std::string>& missing) {
  std::map<std::string, Appearance> appearances;
  const std::optional<std::string> bytes = source.beside(name);
  if (!bytes) {
    if (!name.empty()) missing.push_back(name);
    return appearances;
  }
  const MeshSource file{*bytes, source.file.parent_path() / name, source.limits};
  std::map<std::string, MtlMaterial> materials;
  FolderImages pictures(source, missing);
  MeshText text(file);
  MtlMaterial none;
  MtlMaterial* material = &none;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    Appearance& appearance = material->appearance;
    if (keyword == "newmtl") {
      material = &materials[text.words()];
      material->appearance.v_from_bottom = true;
    } else if (keyword == "Kd") {
      if (const auto color = take_color(text)) appearance.color = color->unaryExpr(&linear);
    } else if (keyword == "map_Kd") {
      appearance.picture = pictures.find(take_picture_use(text).name);
      // exporters write black for an untinted image
      if (appearance.picture && appearance.color.isZero()) appearance.color.setOnes();
    } else if (keyword == "norm" ||
               (!appearance.relief &&
                (keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump"))) {
      const PictureUse use = take_picture_use(text);
      appearance.relief = pictures.find(use.name);
      appearance.normal_scale = static_cast<float>(use.scale);
    } else if (keyword == "Ks") {
      if (const auto color = take_color(text)) material->has_highlights = !color->isZero();
    } else if (keyword == "Ns") {
      material->exponent = text.number();
    } else if (keyword == "Pr") {
      material->roughness = share(text.number());
    } else if (keyword == "Pm") {
      material->metallic = share(text.number());
    }
  }
  for (const auto& [called, found] : materials) appearances.emplace(called, found.resolved());
  return appearances;
}

}  // namespace sunder
