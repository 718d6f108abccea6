#include "engine/geometry/split_mesh.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/clip_mesh.h"

namespace sunder {
namespace {

/// Up to these, halving costs more than it saves.
constexpr std::size_t kFewFaces = 48;
constexpr std::size_t kFewRegions = 4;

/// Regions, and a part of the mesh that holds all of them.
struct Group {
  std::shared_ptr<const PolygonMesh> mesh;
  std::vector<std::uint32_t> regions;
};

/// The largest distance of a point of the box.
double highest(const Plane& plane, const Box& box) {
  const Vec3 corner = (plane.normal.array() > 0).select(box.max, box.min);
  return plane.distance(corner);
}

/// Memory that is reused.
struct Workspace {
  PolygonMesh part, next;
  MeshClipScratch clip;
};

/// As many workspaces as are in use at once.
class Workspaces {
 public:
  std::unique_ptr<Workspace> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Workspace>();
    auto workspace = std::move(free_.back());
    free_.pop_back();
    return workspace;
  }
  void give_back(std::unique_ptr<Workspace> workspace) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(workspace));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> free_;
};

PolygonMesh part_in(const PolygonMesh& mesh, const MeshRegion& region, double tolerance,
                    Workspace& workspace) {
  PolygonMesh &part = workspace.part, &next = workspace.next;
  bool cut = false;
  Box box = bounds(mesh);
  for (const auto& [plane, id] : region.planes) {
    if (highest(plane, box) <= -tolerance) continue;
    const PlaneSide side = clip(cut ? part : mesh, plane, id, tolerance, next, workspace.clip);
    if (side == PlaneSide::kOutside) return {};
    if (side == PlaneSide::kInside) continue;
    std::swap(part, next);
    cut = true;
    box = bounds(part);
  }
  return cut ? part : mesh;
}

/// The group's mesh on the inside of the plane; null if there is nothing.
std::shared_ptr<const PolygonMesh> half(const Group& group, const Plane& plane,
                                        Workspace& workspace) {
  switch (clip(*group.mesh, plane, {}, 0, workspace.part, workspace.clip)) {
    case PlaneSide::kInside:
      return group.mesh;
    case PlaneSide::kOutside:
      return nullptr;
    default:
      return std::make_shared<PolygonMesh>(workspace.part);
  }
}

/// Halves groups, level by level, until they are small.
class Splitter {
 public:
  Splitter(std::span<const MeshRegion> regions, double tolerance, const Box& box)
      : regions_(regions), tolerance_(tolerance), box_(box), parts_(regions.size()) {}

  std::vector<PolygonMesh> run(Group whole);

 private:
  std::pair<Group, Group> halves(const Group& group, Workspace& workspace) const;
  /// Regions may be infinite; what matters of them lies in the mesh's box.
  Box box_of(std::uint32_t region) const {
    return {regions_[region].box.min.cwiseMax(box_.min).cwiseMin(box_.max),
            regions_[region].box.max.cwiseMin(box_.max).cwiseMax(box_.min)};
  }

  std::span<const MeshRegion> regions_;
  const double tolerance_;
  const Box box_;
  std::vector<PolygonMesh> parts_;
  Workspaces workspaces_;
};

std::vector<PolygonMesh> Splitter::run(Group whole) {
  std::vector<Group> groups;
  if (!whole.regions.empty()) groups.push_back(std::move(whole));
  while (!groups.empty()) {
    std::vector<Group> next(2 * groups.size());
    for_chunks(groups.size(), 1, [&](std::size_t g, std::size_t, std::size_t) {
      const Group& group = groups[g];
      auto workspace = workspaces_.take();
      if (group.regions.size() > kFewRegions && group.mesh->faces.size() > kFewFaces) {
        std::tie(next[2 * g], next[2 * g + 1]) = halves(group, *workspace);
      } else {
        for (const std::uint32_t r : group.regions) {
          parts_[r] = part_in(*group.mesh, regions_[r], tolerance_, *workspace);
        }
      }
      workspaces_.give_back(std::move(workspace));
    });
    std::erase_if(next, [](const Group& group) { return group.mesh == nullptr; });
    groups = std::move(next);
  }
  return std::move(parts_);
}

/// Two groups, neither of whose meshes ends nearer than a margin outside its regions: the faces
/// made here are cut off again.
std::pair<Group, Group> Splitter::halves(const Group& group, Workspace& workspace) const {
  Box centers;
  for (const std::uint32_t region : group.regions) centers.extend(box_of(region).center());
  int axis;
  centers.extent().maxCoeff(&axis);
  std::vector<std::uint32_t> order = group.regions;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = box_of(a).center()[axis], at_b = box_of(b).center()[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  Group low{nullptr, {order.begin(), middle}}, high{nullptr, {middle, order.end()}};
  Box low_box, high_box;
  for (const std::uint32_t region : low.regions) low_box.extend(box_of(region));
  for (const std::uint32_t region : high.regions) high_box.extend(box_of(region));
  const double margin = 1e-3 * box_.extent().norm() + 2 * tolerance_;
  const Vec3 up = Vec3::Unit(axis);
  low.mesh = half(group, Plane{up, -(low_box.max[axis] + margin)}, workspace);
  high.mesh = half(group, Plane{-up, high_box.min[axis] - margin}, workspace);
  return {std::move(low), std::move(high)};
}

}  // namespace

std::vector<PolygonMesh> split(const PolygonMesh& mesh, std::span<const MeshRegion> regions,
                               double tolerance_m) {
  Group whole;
  whole.mesh = {std::shared_ptr<const PolygonMesh>(), &mesh};  // not owned
  whole.regions.resize(regions.size());
  std::iota(whole.regions.begin(), whole.regions.end(), 0u);
  return Splitter(regions, tolerance_m, bounds(mesh)).run(std::move(whole));
}

}  // namespace sunder
