#include "fracture/vacd/best_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "engine/base/parallel.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/convex_polyhedron.h"
#include "fracture/tuning.h"
#include "fracture/vacd/sweep_hull.h"

namespace sunder::fracture {
namespace {

constexpr std::size_t kOutlinePoints = 16;  // Points of a slice's outline.

/// Unit vectors every 22.5 degrees.
constexpr double kCos = 0.92387953251128674, kSin = 0.38268343236508977,
                 kDiagonal = 0.70710678118654752;
constexpr double kRing[kOutlinePoints][2] = {
    {1, 0},  {kCos, kSin},   {kDiagonal, kDiagonal},   {kSin, kCos},
    {0, 1},  {-kSin, kCos},  {-kDiagonal, kDiagonal},  {-kCos, kSin},
    {-1, 0}, {-kCos, -kSin}, {-kDiagonal, -kDiagonal}, {-kSin, -kCos},
    {0, -1}, {kSin, -kCos},  {kDiagonal, -kDiagonal},  {kCos, -kSin}};

/// Outermost points of the outline in which a plane cuts a mesh.
struct Slice {
  double place = 0;
  std::array<double, kOutlinePoints> reach;
  std::array<Vec3, kOutlinePoints> points;
  bool is_cut = false;

  explicit Slice(double at) : place(at) { reach.fill(-std::numeric_limits<double>::infinity()); }
  Vec3 middle() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points) sum += p;
    return sum / static_cast<double>(kOutlinePoints);
  }
};

struct Frame {
  Vec3 up, right, front;

  explicit Frame(const Vec3& direction) : up(direction) {
    int flattest;
    direction.cwiseAbs().minCoeff(&flattest);
    right = direction.cross(Vec3::Unit(flattest)).normalized();
    front = direction.cross(right);
  }
};

struct Candidate {
  Vec3 direction = Vec3::UnitX();
  Vec3 middle = Vec3::Zero();  ///< Middle of the slice.
  double place = 0;
  double cost = std::numeric_limits<double>::infinity();
  double hull_volume_m3 = 0;

  Cut cut() const { return {{direction, -place}, hull_volume_m3}; }
};

/// Edges that planes cut: those of a mesh, or of every n-th contour of it.
struct SliceEdges {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> corners;  ///< Corners of all contours in turn.
  std::vector<std::uint32_t> ends;     ///< End of each contour in `corners`.

  explicit SliceEdges(const PolygonMesh& mesh);
};

SliceEdges::SliceEdges(const PolygonMesh& mesh) {
  const std::size_t step = std::max<std::size_t>(1, mesh.contours.size() / kSlicedContours);
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> new_of_old(mesh.vertices.size(), kUnused);
  for (std::size_t c = 0; c < mesh.contours.size(); c += step) {
    for (const std::uint32_t v : mesh.contour_corners(c)) {
      if (new_of_old[v] == kUnused) {
        new_of_old[v] = static_cast<std::uint32_t>(points.size());
        points.push_back(mesh.vertices[v]);
      }
      corners.push_back(new_of_old[v]);
    }
    ends.push_back(static_cast<std::uint32_t>(corners.size()));
  }
}

/// Evaluates parallel cuts; reused for one direction after the other.
class Sweeper {
 public:
  Sweeper(const SliceEdges& edges, const std::vector<Vec3>& outermost, const Box& box,
          double evenness)
      : edges_(edges), outermost_(outermost), box_(box), evenness_(evenness) {}

  /// Returns the best of kCutSlices evenly spaced planes.
  Candidate search_evenly(const Vec3& direction) {
    project_vertices(direction);
    const auto [low, high] = std::minmax_element(places_.begin(), places_.end());
    const double step = (*high - *low) / (kCutSlices + 1);
    for (std::size_t k = 1; k <= kCutSlices; ++k) {
      slices_.emplace_back(*low + static_cast<double>(k) * step);
    }
    return cost(direction);
  }

  /// Returns the best of several planes within `reach_m` of a point; others refine the hulls.
  Candidate search_near(const Vec3& direction, const Vec3& point, double reach_m) {
    project_vertices(direction);
    const auto [low, high] = std::minmax_element(places_.begin(), places_.end());
    const double at = direction.dot(point), step = (*high - *low) / (kCutSlices + 1);
    for (double place = *low + step; place < at - reach_m; place += step) {
      slices_.emplace_back(place);
    }
    for (std::size_t k = 0; k < kRefiningSlices; ++k) {
      const double along = (static_cast<double>(k) + 0.5) / kRefiningSlices * 2 - 1;
      const double place = at + along * reach_m;
      if (place > *low && place < *high) slices_.emplace_back(place);
    }
    for (double place = at + reach_m + step; place < *high; place += step) {
      slices_.emplace_back(place);
    }
    return cost(direction);
  }

 private:
  void project_vertices(const Vec3& direction) {
    slices_.clear();
    places_.clear();
    for (const Vec3& v : edges_.points) places_.push_back(direction.dot(v));
  }
  Candidate cost(const Vec3& direction);
  void cut_edges(const Frame& frame);
  template <class Iterator>
  void sweep(Iterator begin, Iterator end, double sign, const Vec3& direction,
             std::vector<double>& volumes);

  const SliceEdges& edges_;
  std::vector<Vec3> outermost_;
  const Box box_;
  const double evenness_;
  std::vector<double> places_;       ///< Coordinates of vertices along the direction.
  std::vector<std::uint8_t> above_;  ///< Per vertex: number of slices below it.
  std::vector<Slice> slices_;        ///< Ascending.
  std::vector<double> below_m3_, above_m3_;
  SweepHull hull_;
};

void Sweeper::cut_edges(const Frame& frame) {
  above_.resize(places_.size());
  for (std::size_t v = 0; v < places_.size(); ++v) {
    std::uint8_t count = 0;
    for (const Slice& slice : slices_) count += places_[v] > slice.place;
    above_[v] = count;
  }
  std::size_t begin = 0;
  for (const std::uint32_t end : edges_.ends) {
    std::uint32_t from = edges_.corners[end - 1];
    for (; begin < end; ++begin) {
      const std::uint32_t to = edges_.corners[begin];
      for (std::size_t s = above_[from]; s < above_[to]; ++s) {
        Slice& slice = slices_[s];
        const double t = (slice.place - places_[from]) / (places_[to] - places_[from]);
        const Vec3 p = edges_.points[from] + t * (edges_.points[to] - edges_.points[from]);
        const double u = frame.right.dot(p), v = frame.front.dot(p);
        slice.is_cut = true;
        for (std::size_t i = 0; i < kOutlinePoints; ++i) {
          const double reach = kRing[i][0] * u + kRing[i][1] * v;
          if (reach <= slice.reach[i]) continue;
          slice.reach[i] = reach;
          slice.points[i] = p;
        }
      }
      from = to;
    }
  }
}

template <class Iterator>
void Sweeper::sweep(Iterator begin, Iterator end, double sign, const Vec3& direction,
                    std::vector<double>& volumes) {
  hull_.restart(box_.center(), box_.extent().maxCoeff());
  std::sort(outermost_.begin(), outermost_.end(), [&](const Vec3& a, const Vec3& b) {
    return sign * direction.dot(a) < sign * direction.dot(b);
  });
  volumes.clear();
  auto point = outermost_.begin();
  for (auto slice = begin; slice != end; ++slice) {
    for (; point != outermost_.end() && sign * direction.dot(*point) < sign * slice->place;
         ++point) {
      hull_.add(*point);
    }
    if (slice->is_cut) {
      for (std::size_t i = 0; i < kOutlinePoints; ++i) {
        if (i == 0 || slice->points[i] != slice->points[i - 1]) hull_.add(slice->points[i]);
      }
    }
    volumes.push_back(hull_.volume_m3());
  }
  for (; point != outermost_.end(); ++point) hull_.add(*point);
}

Candidate Sweeper::cost(const Vec3& direction) {
  cut_edges(Frame(direction));
  sweep(slices_.begin(), slices_.end(), 1, direction, below_m3_);
  sweep(slices_.rbegin(), slices_.rend(), -1, direction, above_m3_);
  const double whole = hull_.volume_m3();
  Candidate best;
  best.direction = direction;
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    if (!slices_[s].is_cut) continue;
    const double below = below_m3_[s], above = above_m3_[slices_.size() - 1 - s];
    const double cost = below + above - whole + evenness_ * std::max(below, above);
    if (!(cost < best.cost)) continue;
    best.cost = cost;
    best.hull_volume_m3 = below + above;
    best.place = slices_[s].place;
    best.middle = slices_[s].middle();
  }
  return best;
}

/// Returns one of each pair of the 98 directions with coordinates of at most 2, not normalized.
std::vector<Vec3> many_directions() {
  std::vector<Vec3> directions;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const bool first = x != 0 ? x < 0 : y != 0 ? y < 0 : z < 0;
        if (first && ((x | y | z) & 1)) directions.emplace_back(x, y, z);
      }
    }
  }
  return directions;
}

/// Appends the vertices that are farthest along a direction and against it.
void add_farthest(const PolygonMesh& mesh, const Vec3& direction,
                  std::vector<std::uint32_t>& found) {
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  std::uint32_t last = 0, first = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const double reach = direction.dot(mesh.vertices[v]);
    if (reach > most) {
      most = reach;
      last = v;
    }
    if (reach < least) {
      least = reach;
      first = v;
    }
  }
  found.push_back(last);
  found.push_back(first);
}

/// Returns the directions of the 26-dop, one of each pair, and the principal axes of the mesh.
std::vector<Vec3> first_directions(const PolygonMesh& mesh) {
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < dop_directions().size(); i += 2) {
    directions.push_back(dop_directions()[i]);
  }
  const Mat3 moment = mass_properties(mesh).second_moment;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(moment / moment.cwiseAbs().maxCoeff());
  if (solver.info() == Eigen::Success) {
    for (int axis = 0; axis < 3; ++axis) directions.push_back(solver.eigenvectors().col(axis));
  }
  return directions;
}

bool better(const Candidate& a, const Candidate& b) { return a.cost < b.cost; }

/// Returns the best cut across each of the first directions, best first.
std::vector<Candidate> find_cuts(const PolygonMesh& mesh, const SliceEdges& edges,
                                 const Outline& outline, double evenness) {
  const Box box = bounds(mesh);
  const std::vector<Vec3> directions = first_directions(mesh);
  std::vector<Candidate> found(directions.size());
  for_chunks(directions.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
    Sweeper sweeper(edges, outline.points, box, evenness);
    for (std::size_t i = begin; i < end; ++i) found[i] = sweeper.search_evenly(directions[i]);
  });
  std::stable_sort(found.begin(), found.end(), better);
  return found;
}

/// Refines a cut by ever smaller tilts and shifts.
Candidate refine_cut(const Box& box, const SliceEdges& edges, const Outline& outline,
                     Candidate best) {
  double tilt = kFirstTilt, reach_m = box.extent().maxCoeff() / kCutSlices;
  for (int round = 0; round < kTiltRounds; ++round, tilt *= 0.5, reach_m *= 0.5) {
    const Frame frame(best.direction);
    std::vector<Vec3> directions = {best.direction};
    for (const Vec3& aside : {frame.right, frame.front}) {
      directions.push_back((best.direction + tilt * aside).normalized());
      directions.push_back((best.direction - tilt * aside).normalized());
    }
    std::vector<Candidate> found(directions.size());
    for_chunks(directions.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      Sweeper sweeper(edges, outline.points, box, kCutEvenness);
      found[i] = sweeper.search_near(directions[i], best.middle, reach_m);
    });
    const Candidate& next = *std::min_element(found.begin(), found.end(), better);
    if (better(next, best)) best = next;
  }
  return best;
}

}  // namespace

Outline outline_of(const PolygonMesh& mesh) {
  Outline outline;
  const Box box = bounds(mesh);
  SweepHull hull;
  hull.restart(box.center(), box.extent().maxCoeff());
  std::vector<std::uint32_t> found;
  for (const Vec3& direction : many_directions()) add_farthest(mesh, direction, found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const std::uint32_t v : found) {
    hull.add(mesh.vertices[v]);
    outline.points.push_back(mesh.vertices[v]);
  }
  for (const Vec3& v : mesh.vertices) {
    if (hull.add(v, kMinOutlineGain * hull.volume_m3())) outline.points.push_back(v);
  }
  outline.hull_m3 = hull.volume_m3();
  return outline;
}

std::optional<Cut> best_cut(const PolygonMesh& mesh, const Outline& outline, Effort effort) {
  const SliceEdges edges(mesh);
  Candidate best = find_cuts(mesh, edges, outline, kCutEvenness)[0];
  if (!(best.cost < std::numeric_limits<double>::infinity())) return std::nullopt;
  if (effort == Effort::kFull) best = refine_cut(bounds(mesh), edges, outline, best);
  return best.cut();
}

std::vector<Cut> middle_cuts(const PolygonMesh& mesh, const Outline& outline) {
  std::vector<Cut> cuts;
  for (const Candidate& candidate :
       find_cuts(mesh, SliceEdges(mesh), outline, kMiddleCutEvenness)) {
    if (candidate.cost < std::numeric_limits<double>::infinity()) cuts.push_back(candidate.cut());
  }
  return cuts;
}

}  // namespace sunder::fracture
