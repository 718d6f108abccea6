// Periodic noise and the tiles. Only basic arithmetic (no libm): equal bytes on every machine.
#include "render/passes/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"

namespace sunder::render {
namespace {

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

float lerp(float a, float b, float t) { return a + (b - a) * t; }

/// Returns a random number in [0, 1) for a cell; the lattice repeats every (period_x, period_y)
/// cells.
float cell_random(int x, int y, int period_x, int period_y, int seed) {
  const int wx = ((x % period_x) + period_x) % period_x;
  const int wy = ((y % period_y) + period_y) % period_y;
  const auto key = (static_cast<std::uint64_t>(seed) << 40) |
                   (static_cast<std::uint64_t>(wx) << 20) | static_cast<std::uint64_t>(wy);
  return static_cast<float>(mix(key) >> 40) * 0x1.0p-24f;
}

/// Returns value noise in [0, 1] for a tile of (cells_x, cells_y) lattice cells; u, v in [0, 1).
float value_noise(float u, float v, int cells_x, int cells_y, int seed) {
  const float x = u * static_cast<float>(cells_x);
  const float y = v * static_cast<float>(cells_y);
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const int ix = static_cast<int>(fx);
  const int iy = static_cast<int>(fy);
  const float tx = smooth(0, 1, x - fx);
  const float ty = smooth(0, 1, y - fy);
  const auto at = [&](int dx, int dy) {
    return cell_random(ix + dx, iy + dy, cells_x, cells_y, seed);
  };
  return lerp(lerp(at(0, 0), at(1, 0), tx), lerp(at(0, 1), at(1, 1), tx), ty);
}

struct Cells {
  int x;
  int y;
};

/// Returns fractal value noise in [0, 1]; each octave is twice as fine and `gain` times as strong.
float fractal(float u, float v, Cells cells, int octaves, float gain, int seed) {
  float sum = 0;
  float weight = 1;
  float total = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(u, v, cells.x << octave, cells.y << octave, seed + octave);
    total += weight;
    weight *= gain;
  }
  return sum / total;
}

/// Worley noise with one jittered point per cell: distances to the nearest and second nearest
/// point, in cells, and a random number of the nearest.
struct Worley {
  float nearest = 9;
  float second = 9;
  float id = 0;
};

Worley worley(float u, float v, int cells, int seed) {
  const float x = u * static_cast<float>(cells);
  const float y = v * static_cast<float>(cells);
  const int ix = static_cast<int>(std::floor(x));
  const int iy = static_cast<int>(std::floor(y));
  Worley found;
  for (int cy = iy - 1; cy <= iy + 1; ++cy) {
    for (int cx = ix - 1; cx <= ix + 1; ++cx) {
      const float dx = static_cast<float>(cx) + cell_random(cx, cy, cells, cells, seed) - x;
      const float dy = static_cast<float>(cy) + cell_random(cx, cy, cells, cells, seed + 1) - y;
      const float distance = std::sqrt(dx * dx + dy * dy);
      if (distance < found.nearest) {
        found.second = found.nearest;
        found.nearest = distance;
        found.id = cell_random(cx, cy, cells, cells, seed + 2);
      } else {
        found.second = std::min(found.second, distance);
      }
    }
  }
  return found;
}

/// The content of a tile at one point; slopes follow from the heights.
struct Texel {
  float brightness = 0.5f;
  float second = 0;
  float height_m = 0;
};

Texel grain(float u, float v) {
  const float coarse = fractal(u, v, {6, 6}, 4, 0.6f, 100);
  const float fine = fractal(u, v, {60, 60}, 3, 0.7f, 110);
  return {0.5f + 0.16f * (coarse - 0.5f) + 0.14f * (fine - 0.5f), 0, 0.0012f * fine};
}

Texel brick(float u, float v) {
  constexpr int kAlong = 8;     // bricks per tile: 25 cm with the joint
  constexpr int kCourses = 24;  // courses per tile: 8.3 cm with the joint
  const float metres = kTileMetres[static_cast<int>(Tile::kBrick)];
  const float wobble = 0.0035f * (fractal(u, v, {24, 24}, 3, 0.5f, 200) - 0.5f);
  const float course = (v + wobble) * kCourses;
  const int row = static_cast<int>(std::floor(course));
  const float along = (u + wobble) * kAlong + (row % 2 != 0 ? 0.5f : 0.0f);
  const int column = static_cast<int>(std::floor(along));
  const float brick_length = metres / kAlong;
  const float course_height = metres / kCourses;
  const float x = along - static_cast<float>(column);
  const float y = course - static_cast<float>(row);
  const float edge_m =
      std::min(std::min(x, 1 - x) * brick_length, std::min(y, 1 - y) * course_height);
  const float body = smooth(0.004f, 0.0085f, edge_m);  // 1 on the brick, 0 in the joint

  const float tone = cell_random(column, row, kAlong, kCourses, 210);
  const float scorched = cell_random(column, row, kAlong, kCourses, 211) > 0.86f ? 0.16f : 0.0f;
  const float fine = fractal(u, v, {64, 64}, 3, 0.7f, 212);
  const float blotch = fractal(u, v, {20, 40}, 3, 0.6f, 216);
  const float fired =
      0.5f + 0.26f * (tone - 0.5f) - scorched + 0.16f * (fine - 0.5f) + 0.22f * (blotch - 0.5f);
  const float joint = 0.5f + 0.2f * (fine - 0.5f);
  return {lerp(joint, fired, body), 1 - body, 0.005f * body + 0.0022f * fine + 0.002f * blotch};
}

Texel concrete(float u, float v) {
  const float cloud = fractal(u, v, {3, 3}, 5, 0.55f, 300);
  const float fine = fractal(u, v, {80, 80}, 3, 0.7f, 306);
  // Streaks of rain, long along v.
  const float streak = fractal(u, v, {40, 3}, 3, 0.6f, 310);
  const Worley w = worley(u, v, 46, 314);
  const float pit = w.id > 0.72f ? 1 - smooth(0.06f, 0.06f + 0.2f * w.id, w.nearest) : 0.0f;
  const float brightness =
      0.5f + 0.3f * (cloud - 0.5f) + 0.14f * (fine - 0.5f) + 0.12f * (streak - 0.5f) - 0.14f * pit;
  return {brightness, 0.6f * pit, 0.0016f * fine - 0.006f * pit + 0.004f * cloud};
}

Texel plaster(float u, float v) {
  const float stroke = fractal(u, v, {5, 16}, 4, 0.55f, 400);
  const float cloud = fractal(u, v, {4, 4}, 4, 0.5f, 405);
  const float fine = fractal(u, v, {90, 90}, 2, 0.7f, 410);
  return {0.5f + 0.14f * (cloud - 0.5f) + 0.08f * (stroke - 0.5f) + 0.06f * (fine - 0.5f), 0,
          0.006f * stroke + 0.0012f * fine};
}

Texel wood(float u, float v) {
  constexpr int kBoards = 8;
  const float board = v * kBoards;
  const int index = static_cast<int>(std::floor(board));
  const float across = board - static_cast<float>(index);
  const float tone = cell_random(index, 0, kBoards, 1, 500);
  const float ring = fractal(u, v, {2, 40}, 3, 0.6f, 505);
  const float fibre = fractal(u, v, {6, 200}, 2, 0.6f, 510);
  const float seam = 1 - smooth(0.015f, 0.05f, std::min(across, 1 - across));
  const float brightness =
      0.5f + 0.24f * (tone - 0.5f) + 0.3f * (ring - 0.5f) + 0.2f * (fibre - 0.5f) - 0.3f * seam;
  return {brightness, 0.7f * seam, 0.002f * fibre - 0.006f * seam};
}

Texel rubble(float u, float v) {
  const float warp = 0.03f * (fractal(u, v, {16, 16}, 2, 0.5f, 600) - 0.5f);
  const Worley large = worley(u + warp, v - warp, 14, 610);
  const Worley small = worley(u - warp, v + warp, 40, 620);
  const float fine = fractal(u, v, {60, 60}, 3, 0.7f, 630);
  const float lumps = fractal(u, v, {5, 5}, 4, 0.55f, 640);
  const auto stone = [](const Worley& w, float share) {
    return w.id < share ? smooth(0.04f, 0.22f, w.second - w.nearest) : 0.0f;
  };
  const float stones = std::max(stone(large, 0.45f), 0.75f * stone(small, 0.4f));
  const float tone = stone(large, 0.45f) > 0 ? large.id / 0.45f : small.id / 0.4f;
  const float brightness =
      0.5f + 0.3f * (lumps - 0.5f) + 0.2f * (fine - 0.5f) + 0.2f * stones * (tone - 0.5f);
  return {brightness, stones, 0.007f * stones + 0.05f * lumps + 0.004f * fine};
}

Texel cloud(float u, float v) {
  const float shade = fractal(u, v, {4, 4}, 5, 0.5f, 700);
  const float patches = fractal(u, v, {5, 5}, 7, 0.55f, 710);
  const float fine = fractal(u, v, {64, 64}, 3, 0.7f, 720);
  return {shade, smooth(0.2f, 0.8f, patches), 0.02f * fine};
}

using TileFunction = Texel (*)(float, float);
constexpr TileFunction kTileFunctions[kTiles] = {grain, brick,  concrete, plaster,
                                                 wood,  rubble, cloud};

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(255 * std::clamp(value, 0.0f, 1.0f) + 0.5f);
}

/// Writes one layer: evaluates every texel, then converts heights to slopes.
void bake(std::size_t layer, std::uint8_t* rgba) {
  constexpr std::size_t kSide = kTileSize;
  std::vector<Texel> texels(kSide * kSide);
  for_chunks(kSide, 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < kSide; ++x) {
        texels[y * kSide + x] = kTileFunctions[layer]((static_cast<float>(x) + 0.5f) / kTileSize,
                                                      (static_cast<float>(y) + 0.5f) / kTileSize);
      }
    }
  });
  const float per_slope = kTileSize / (2 * kTileMetres[layer]);
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const auto height = [&](std::size_t column, std::size_t row) {
        return texels[(row % kSide) * kSide + column % kSide].height_m;
      };
      const float du = (height(x + 1, y) - height(x + kSide - 1, y)) * per_slope;
      const float dv = (height(x, y + 1) - height(x, y + kSide - 1)) * per_slope;
      std::uint8_t* out = rgba + 4 * (y * kSide + x);
      out[0] = byte_of(texels[y * kSide + x].brightness);
      out[1] = byte_of(texels[y * kSide + x].second);
      out[2] = byte_of(0.5f + 0.5f * du / kMaxSlope);
      out[3] = byte_of(0.5f + 0.5f * dv / kMaxSlope);
    }
  }
}

}  // namespace

std::vector<std::uint8_t> bake_tiles() {
  constexpr std::size_t kLayerBytes = std::size_t{4} * kTileSize * kTileSize;
  std::vector<std::uint8_t> bytes(kTiles * kLayerBytes);
  for (std::size_t layer = 0; layer < kTiles; ++layer) {
    bake(layer, bytes.data() + layer * kLayerBytes);
  }
  return bytes;
}

void upload_tiles(const GlTable& gl) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  const std::vector<std::uint8_t> texels = bake_tiles();
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, kTileSize, kTileSize, kTiles, 0, GL_RGBA,
                GL_UNSIGNED_BYTE, texels.data());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.GenerateMipmap(GL_TEXTURE_2D_ARRAY);
}

}  // namespace sunder::render
