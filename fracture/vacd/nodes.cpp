#include "fracture/vacd/nodes.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <numeric>
#include <sstream>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/approximate_hull.h"
#include "fracture/tuning.h"
#include "fracture/vacd/vacd.h"

namespace sunder::fracture {
namespace {

/// Calls `use(a, b, c, area)` for the triangles of a mesh, as fans of its contours.
template <class Use>
void for_triangles(const PolygonMesh& mesh, const Use& use) {
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    const Vec3& a = mesh.vertices[corners[0]];
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 &b = mesh.vertices[corners[i - 1]], &c = mesh.vertices[corners[i]];
      use(a, b, c, 0.5 * (b - a).cross(c - a).norm());
    }
  }
}

/// Returns samples that are far apart: each is the sample farthest from all chosen before, and the
/// first the one farthest from the middle.
std::vector<Vec3> distant_samples(std::span<const Vec3> samples, std::uint32_t count) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& s : samples) middle += s / static_cast<double>(samples.size());
  std::vector<double> nearest(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) nearest[i] = (samples[i] - middle).squaredNorm();
  std::vector<Vec3> seeds;
  while (seeds.size() < count) {
    const auto far = std::max_element(nearest.begin(), nearest.end());
    if (!(*far > 0)) break;
    const Vec3 seed = samples[static_cast<std::size_t>(far - nearest.begin())];
    const bool first = seeds.empty();
    seeds.push_back(seed);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double square = (samples[i] - seed).squaredNorm();
      nearest[i] = first ? square : std::min(nearest[i], square);
    }
  }
  return seeds;
}

std::uint32_t nearest_of(std::span<const Vec3> nodes, const Vec3& point) {
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    const double square = (nodes[n] - point).squaredNorm();
    if (square < least) {
      least = square;
      best = n;
    }
  }
  return best;
}

/// Moves each node to the mean of the samples nearest to it.
void move_to_means(std::span<const Vec3> samples, std::vector<Vec3>& nodes) {
  constexpr std::size_t kAtOnce = 512;
  std::vector<std::uint32_t> owner(samples.size());
  for_chunks(samples.size(), kAtOnce, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) owner[i] = nearest_of(nodes, samples[i]);
  });
  std::vector<Vec3> sum(nodes.size(), Vec3::Zero());
  std::vector<std::size_t> count(nodes.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum[owner[i]] += samples[i];
    ++count[owner[i]];
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (count[n] > 0) nodes[n] = sum[n] / static_cast<double>(count[n]);
  }
}

/// Returns the approximate volume of a shell's hull less that of the shell, which is `volume`.
double concavity(const PolygonMesh& shell, double& volume) {
  volume = std::max(0.0, mass_properties(shell).volume_m3);
  const double more = approximate_hull(shell.vertices, kConcavityVertices).volume_m3 - volume;
  return more > kMinConcavity * volume ? more : 0;
}

}  // namespace

std::vector<Vec3> surface_samples(const PolygonMesh& mesh, std::size_t count) {
  double area = 0;
  for_triangles(mesh, [&](const Vec3&, const Vec3&, const Vec3&, double part) { area += part; });
  std::vector<Vec3> samples;
  if (!(area > 0)) return samples;
  Random random(count);
  const double step = area / static_cast<double>(count);
  double passed = 0, next = 0.5 * step;
  for_triangles(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c, double part) {
    for (passed += part; next < passed && samples.size() < count; next += step) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      samples.push_back(a + u * (b - a) + v * (c - a));
    }
  });
  return samples;
}

std::vector<Vec3> automatic_nodes(const PolygonMesh& mesh, std::uint32_t count) {
  const std::vector<Vec3> samples =
      surface_samples(mesh, std::clamp(kSamplesPerNode * count, kMinNodeSamples, kMaxNodeSamples));
  std::vector<Vec3> nodes = distant_samples(samples, count);
  for (int round = 0; round < kLloydRounds; ++round) move_to_means(samples, nodes);
  return nodes;
}

std::vector<std::uint32_t> share_nodes(std::span<const PolygonMesh> shells, std::uint32_t count) {
  std::vector<double> weight(shells.size()), volume(shells.size());
  for_chunks(shells.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    weight[s] = concavity(shells[s], volume[s]);
  });
  double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
  if (!(sum > 0)) {
    weight = volume;
    sum = std::accumulate(weight.begin(), weight.end(), 0.0);
  }
  std::vector<std::uint32_t> share(shells.size(), 1);
  if (!(sum > 0)) return share;
  for (std::size_t left = count > shells.size() ? count - shells.size() : 0; left > 0; --left) {
    std::size_t neediest = 0;  // Method of Webster, as for seats in a parliament.
    for (std::size_t s = 1; s < shells.size(); ++s) {
      if (weight[s] / (2 * share[s] + 1) > weight[neediest] / (2 * share[neediest] + 1)) {
        neediest = s;
      }
    }
    ++share[neediest];
  }
  return share;
}

std::vector<Vec3> read_nodes(std::istream& in, const std::string& name) {
  std::vector<Vec3> nodes;
  std::string line;
  std::size_t number = 1;
  const auto fail = [&](const std::string& what) {
    throw InputError(name + ":" + std::to_string(number) + ": " + what);
  };
  for (; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    words.imbue(std::locale::classic());
    std::string word;
    if (!(words >> word)) continue;
    words.seekg(0);
    Vec3 node;
    if (!(words >> node.x() >> node.y() >> node.z()) || !node.allFinite() || words >> word) {
      fail("expected a node, three finite numbers: x y z");
    }
    if (nodes.size() == kMostNodes) fail("has more than " + std::to_string(kMostNodes) + " nodes");
    nodes.push_back(node);
  }
  if (nodes.empty()) fail("the file has no nodes; expected lines of three numbers: x y z");
  return nodes;
}

}  // namespace sunder::fracture
