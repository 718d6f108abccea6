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

/// Groups of at most this many faces or regions are not bisected.
constexpr std::size_t kMaxLeafFaces = 48;
constexpr std::size_t kMaxLeafRegions = 8;

/// A set of regions, and the part of the mesh around them.
struct Group {
  std::shared_ptr<const PolygonMesh> mesh;
  std::vector<std::uint32_t> regions;
  Box box;  ///< Bounding box of the mesh.
};

/// Returns the largest signed distance of a point of the box.
double max_distance(const Plane& plane, const Box& box) {
  const Vec3 corner = (plane.normal.array() > 0).select(box.max, box.min);
  return plane.distance(corner);
}

/// Scratch memory of one task.
struct Workspace {
  PolygonMesh part, next;
  MeshClipScratch clip;
};

/// A thread-safe pool of reusable objects, which grows on demand.
template <class Object>
class Pool {
 public:
  std::unique_ptr<Object> acquire() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Object>();
    auto object = std::move(free_.back());
    free_.pop_back();
    return object;
  }
  void release(std::unique_ptr<Object> object) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(object));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Object>> free_;
};

PolygonMesh clip_to_region(const PolygonMesh& mesh, Box box, const MeshRegion& region,
                           double tolerance, Workspace& workspace) {
  PolygonMesh &part = workspace.part, &next = workspace.next;
  bool cut = false;
  for (const auto& [plane, id] : region.planes) {
    if (max_distance(plane, box) <= -tolerance) continue;
    const PlaneSide side = clip(cut ? part : mesh, plane, id, tolerance, next, workspace.clip);
    if (side == PlaneSide::kOutside) return {};
    if (side == PlaneSide::kInside) continue;
    std::swap(part, next);
    cut = true;
    box = bounds(part);
  }
  return cut ? part : mesh;
}

/// Bisects groups of regions level by level, and clips the meshes of small groups to their regions.
class Splitter {
 public:
  Splitter(std::span<const MeshRegion> regions, double tolerance, const Box& box)
      : regions_(regions), tolerance_(tolerance), box_(box), parts_(regions.size()) {}

  std::vector<PolygonMesh> run(Group whole);

 private:
  /// A task for a group's mesh: to clip it to one half, or to the group's only region.
  struct Job {
    Group group;           ///< The regions of the half, and the mesh to clip.
    Plane plane;           ///< The half-space of the half.
    bool is_leaf = false;  ///< True if the group has one region, to which the mesh is clipped.
  };

  void add_jobs(const Group& group, std::vector<Job>& jobs) const;
  void add_halves(const Group& group, std::vector<Job>& jobs) const;
  std::shared_ptr<const PolygonMesh> cut_half(const Job& job, Workspace& workspace);
  /// Returns the box of a region, which may be infinite, clamped to that of the whole mesh.
  Box clamped_box(std::uint32_t region) const {
    return {regions_[region].box.min.cwiseMax(box_.min).cwiseMin(box_.max),
            regions_[region].box.max.cwiseMin(box_.max).cwiseMax(box_.min)};
  }

  std::span<const MeshRegion> regions_;
  const double tolerance_;
  const Box box_;
  std::vector<PolygonMesh> parts_;
  Pool<Workspace> workspaces_;
  Pool<PolygonMesh> meshes_;
};

std::vector<PolygonMesh> Splitter::run(Group whole) {
  std::vector<Job> jobs, next;
  if (!whole.regions.empty()) add_jobs(whole, jobs);
  while (!jobs.empty()) {
    for_chunks(jobs.size(), 1, [&](std::size_t j, std::size_t, std::size_t) {
      Job& job = jobs[j];
      auto workspace = workspaces_.acquire();
      if (job.is_leaf) {
        const std::uint32_t r = job.group.regions[0];
        parts_[r] =
            clip_to_region(*job.group.mesh, job.group.box, regions_[r], tolerance_, *workspace);
        job.group.mesh = nullptr;
      } else {
        job.group.mesh = cut_half(job, *workspace);
        if (job.group.mesh) job.group.box = bounds(*job.group.mesh);
      }
      workspaces_.release(std::move(workspace));
    });
    next.clear();
    for (const Job& job : jobs) {
      if (job.group.mesh) add_jobs(job.group, next);
    }
    std::swap(jobs, next);
  }
  return std::move(parts_);
}

void Splitter::add_jobs(const Group& group, std::vector<Job>& jobs) const {
  if (group.regions.size() > kMaxLeafRegions && group.mesh->faces.size() > kMaxLeafFaces) {
    add_halves(group, jobs);
    return;
  }
  for (const std::uint32_t region : group.regions)
    jobs.push_back({{group.mesh, {region}, group.box}, {}, true});
}

/// Adds the jobs of the two halves of a group. Each half-space extends beyond its regions by a
/// margin, so that the caps made here are outside of all regions.
void Splitter::add_halves(const Group& group, std::vector<Job>& jobs) const {
  Box centers;
  for (const std::uint32_t region : group.regions) centers.extend(clamped_box(region).center());
  int axis;
  centers.extent().maxCoeff(&axis);
  std::vector<std::uint32_t> order = group.regions;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = clamped_box(a).center()[axis], at_b = clamped_box(b).center()[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  Group low{group.mesh, {order.begin(), middle}, {}}, high{group.mesh, {middle, order.end()}, {}};
  Box low_box, high_box;
  for (const std::uint32_t region : low.regions) low_box.extend(clamped_box(region));
  for (const std::uint32_t region : high.regions) high_box.extend(clamped_box(region));
  const double margin = 1e-3 * box_.extent().norm() + 2 * tolerance_;
  const Vec3 up = Vec3::Unit(axis);
  jobs.push_back({std::move(low), Plane{up, -(low_box.max[axis] + margin)}});
  jobs.push_back({std::move(high), Plane{-up, high_box.min[axis] - margin}});
}

/// Returns the part of the job's mesh inside its plane; null if there is none.
std::shared_ptr<const PolygonMesh> Splitter::cut_half(const Job& job, Workspace& workspace) {
  auto mesh = meshes_.acquire();
  switch (clip(*job.group.mesh, job.plane, {}, 0, *mesh, workspace.clip)) {
    case PlaneSide::kInside:
      meshes_.release(std::move(mesh));
      return job.group.mesh;
    case PlaneSide::kOutside:
      meshes_.release(std::move(mesh));
      return nullptr;
    default:
      return {mesh.release(),
              [this](PolygonMesh* used) { meshes_.release(std::unique_ptr<PolygonMesh>(used)); }};
  }
}

}  // namespace

std::vector<PolygonMesh> split(const PolygonMesh& mesh, std::span<const MeshRegion> regions,
                               double tolerance_m) {
  Group whole;
  whole.mesh = {std::shared_ptr<const PolygonMesh>(), &mesh};  // not owned by the pointer
  whole.regions.resize(regions.size());
  std::iota(whole.regions.begin(), whole.regions.end(), 0u);
  whole.box = bounds(mesh);
  return Splitter(regions, tolerance_m, whole.box).run(std::move(whole));
}

}  // namespace sunder
