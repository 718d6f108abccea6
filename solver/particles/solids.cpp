// Read first: rasterize(). Layers of cells are filled in parallel, each with all blocks in order.
#include "solver/particles/solids.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

/// Returns the length of the part of a cell of width 1 centred at x that is within [-half, half].
float overlap(float x, float half) {
  return std::max(0.0f, std::min(x + 0.5f, half) - std::max(x - 0.5f, -half));
}

}  // namespace

void Solids::place(const Grid& grid, const Obstacles& obstacles) {
  blocks_.clear();
  const Vec3f counts = grid.lattice.counts.cast<float>();
  for (const ObstacleShape& shape : obstacles.shapes) {
    const ObstacleBody& body = obstacles.bodies[shape.body];
    Block block;
    Vec3 center_W = body.X_WB.position;
    if (shape.hull) {
      center_W = body.X_WB * Vec3(shape.box_R.center() - body.com_R);
      const Vec3 extent = shape.box_R.extent();
      block.half = (0.5 / grid.cell_m * extent).cast<float>();
      block.fill = static_cast<float>(std::min(1.0, shape.volume_m3 / extent.prod()));
    } else {
      block.half.setConstant(static_cast<float>(shape.radius_m / grid.cell_m));
      block.fill = 0.5236f;  // volume of a ball / volume of its cube, π / 6
    }
    block.center = ((center_W - grid.origin_W) / grid.cell_m).cast<float>();
    const float reach = block.half.norm() + 0.87f;  // 0.87: half the diagonal of a cell
    if ((block.center.array() < -reach).any()) continue;
    if ((block.center.array() > counts.array() + reach).any()) continue;
    block.rotation = body.X_WB.rotation.toRotationMatrix().cast<float>();
    const Vec3f span = block.rotation.cwiseAbs() * (block.half + Vec3f::Constant(0.5f));
    // Cell i is centred at i − 0.5.
    block.first = (block.center - span + Vec3f::Constant(0.5f))
                      .array()
                      .ceil()
                      .max(1.0f)
                      .min(counts.array() + 1)
                      .cast<int>();
    block.last = (block.center + span + Vec3f::Constant(0.5f))
                     .array()
                     .floor()
                     .max(0.0f)
                     .min(counts.array())
                     .cast<int>();
    block.motion = {body.X_WB.position, body.velocity_W, body.angular_velocity_W};
    if ((block.first.array() <= block.last.array()).all()) blocks_.push_back(block);
  }
}

void Solids::add(const Grid& grid, const Block& block, int first_layer, int last_layer) {
  const Mat3f rotation_BW = block.rotation.transpose();
  for (int k = std::max(block.first.z(), first_layer); k <= std::min(block.last.z(), last_layer);
       ++k) {
    for (int j = block.first.y(); j <= block.last.y(); ++j) {
      for (int i = block.first.x(); i <= block.last.x(); ++i) {
        const Vec3f cell = Vec3i(i, j, k).cast<float>() - Vec3f::Constant(0.5f);
        const Vec3f at = rotation_BW * (cell - block.center);
        const float part = block.fill * overlap(at.x(), block.half.x()) *
                           overlap(at.y(), block.half.y()) * overlap(at.z(), block.half.z());
        if (part <= 0) continue;
        const Vec3 point_W = grid.origin_W + grid.cell_m * cell.cast<double>();
        const Vec3f velocity = block.motion(point_W).cast<float>();
        const std::size_t index = grid.lattice.index(i, j, k);
        fraction[index] += part;
        for (int axis = 0; axis < 3; ++axis) {
          momentum[static_cast<std::size_t>(axis)][index] += part * velocity[axis];
        }
      }
    }
  }
}

void Solids::rasterize(const Grid& grid, const Obstacles& obstacles) {
  const std::array<Field*, 4> fields = {&fraction, &momentum[0], &momentum[1], &momentum[2]};
  for (Field* field : fields) field->resize(grid.lattice.size());
  place(grid, obstacles);
  const std::ptrdiff_t layer = grid.lattice.stride(2);
  for_chunks(static_cast<std::size_t>(grid.lattice.counts.z()), grid.lattice.layers_a_chunk(),
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (Field* field : fields) {
                 float* first = &(*field)[grid.lattice.index(0, 0, static_cast<int>(begin) + 1)];
                 std::fill_n(first, layer * static_cast<std::ptrdiff_t>(end - begin), 0.0f);
               }
               for (const Block& block : blocks_) {
                 add(grid, block, static_cast<int>(begin) + 1, static_cast<int>(end));
               }
             });
}

}  // namespace sunder::solver
