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
constexpr std::size_t kFewRegions = 8;

/// Regions, and a part of the mesh that holds all of them.
struct Group {
  std::shared_ptr<const PolygonMesh> mesh;
  std::vector<std::uint32_t> regions;
  Box box;  ///< Of the mesh.
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

/// As many objects as are in use at once.
template <class Object>
class Pool {
 public:
  std::unique_ptr<Object> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Object>();
    auto object = std::move(free_.back());
    free_.pop_back();
    return object;
  }
  void give_back(std::unique_ptr<Object> object) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(object));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Object>> free_;
};

PolygonMesh part_in(const PolygonMesh& mesh, Box box, const MeshRegion& region, double tolerance,
                    Workspace& workspace) {
  PolygonMesh &part = workspace.part, &next = workspace.next;
  bool cut = false;
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

/// Halves groups, level by level, until they are small.
class Splitter {
 public:
  Splitter(std::span<const MeshRegion> regions, double tolerance, const Box& box)
      : regions_(regions), tolerance_(tolerance), box_(box), parts_(regions.size()) {}

  std::vector<PolygonMesh> run(Group whole);

 private:
  /// What is to be done with a group's mesh: half of it taken, or the part in its only region.
  struct Job {
    Group group;  ///< With the half's regions.
    Plane plane;  ///< That the half is inside of.
    bool last = false;
  };

  void add_jobs(const Group& group, std::vector<Job>& jobs) const;
  void add_halves(const Group& group, std::vector<Job>& jobs) const;
  std::shared_ptr<const PolygonMesh> half(const Job& job, Workspace& workspace);
  /// Regions may be infinite; what matters of them lies in the mesh's box.
  Box box_of(std::uint32_t region) const {
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
      auto workspace = workspaces_.take();
      if (job.last) {
        const std::uint32_t r = job.group.regions[0];
        parts_[r] = part_in(*job.group.mesh, job.group.box, regions_[r], tolerance_, *workspace);
        job.group.mesh = nullptr;
      } else {
        job.group.mesh = half(job, *workspace);
        if (job.group.mesh) job.group.box = bounds(*job.group.mesh);
      }
      workspaces_.give_back(std::move(workspace));
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
  if (group.regions.size() > kFewRegions && group.mesh->faces.size() > kFewFaces) {
    add_halves(group, jobs);
    return;
  }
  for (const std::uint32_t region : group.regions)
    jobs.push_back({{group.mesh, {region}, group.box}, {}, true});
}

/// Two groups, neither of whose meshes ends nearer than a margin outside its regions: the faces
/// made here are cut off again.
void Splitter::add_halves(const Group& group, std::vector<Job>& jobs) const {
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
  Group low{group.mesh, {order.begin(), middle}, {}}, high{group.mesh, {middle, order.end()}, {}};
  Box low_box, high_box;
  for (const std::uint32_t region : low.regions) low_box.extend(box_of(region));
  for (const std::uint32_t region : high.regions) high_box.extend(box_of(region));
  const double margin = 1e-3 * box_.extent().norm() + 2 * tolerance_;
  const Vec3 up = Vec3::Unit(axis);
  jobs.push_back({std::move(low), Plane{up, -(low_box.max[axis] + margin)}});
  jobs.push_back({std::move(high), Plane{-up, high_box.min[axis] - margin}});
}

/// Null if there is nothing inside of the job's plane.
std::shared_ptr<const PolygonMesh> Splitter::half(const Job& job, Workspace& workspace) {
  auto mesh = meshes_.take();
  switch (clip(*job.group.mesh, job.plane, {}, 0, *mesh, workspace.clip)) {
    case PlaneSide::kInside:
      meshes_.give_back(std::move(mesh));
      return job.group.mesh;
    case PlaneSide::kOutside:
      meshes_.give_back(std::move(mesh));
      return nullptr;
    default:
      return {mesh.release(),
              [this](PolygonMesh* used) { meshes_.give_back(std::unique_ptr<PolygonMesh>(used)); }};
  }
}

}  // namespace

std::vector<PolygonMesh> split(const PolygonMesh& mesh, std::span<const MeshRegion> regions,
                               double tolerance_m) {
  Group whole;
  whole.mesh = {std::shared_ptr<const PolygonMesh>(), &mesh};  // not owned
  whole.regions.resize(regions.size());
  std::iota(whole.regions.begin(), whole.regions.end(), 0u);
  whole.box = bounds(mesh);
  return Splitter(regions, tolerance_m, whole.box).run(std::move(whole));
}

}  // namespace sunder
