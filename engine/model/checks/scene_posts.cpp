// Begin with find_posts().
#include "engine/model/checks/scene_posts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <optional>

#include "engine/base/roots.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/bvh.h"

namespace sunder {
namespace {

constexpr double kMinHeightToWidth = 4;  // least height over narrowest width of a post's box
constexpr double kMinSlenderness = 30;   // least effective length over radius of gyration
constexpr double kMaxGap = 0.02;  // largest gap, over the smaller width, across which a body rests
constexpr double kMaxObliquity = 1e-3;  // largest share of gravity across the axis of posts
constexpr std::size_t kLevels = 32;     // number of sections along a post
constexpr int kIterations = 12;         // each divides the error of the shape by 9, for a prism
// Load on the head that is equivalent to self-weight, over the self-weight: 9.87/4/7.84 with a free
// head, 9.87/18.6 with a held one (Timoshenko and Gere, chapter 2).
constexpr double kSelfWeightFree = 0.315, kSelfWeightHeld = 0.53;

/// The axis of gravity, and the two across it.
struct Axes {
  Eigen::Index up = 1, a = 2, b = 0;
  double sign = 1;  ///< Sign of the upward direction.
};

/// Returns nothing if gravity is zero or oblique.
std::optional<Axes> axes_of(const Scene& scene) {
  if (scene.gravity_W.isZero()) return {};
  Axes axes;
  const double most = scene.gravity_W.cwiseAbs().maxCoeff(&axes.up);
  axes.a = (axes.up + 1) % 3, axes.b = (axes.up + 2) % 3;
  const double across = hypotenuse(scene.gravity_W[axes.a], scene.gravity_W[axes.b]);
  if (across > kMaxObliquity * most) return {};
  axes.sign = scene.gravity_W[axes.up] < 0 ? 1 : -1;
  return axes;
}

/// A solid or a ball, in coordinates (across, across, up).
struct Body {
  Box box;
  double mass_kg = 0;
  Vec2 center = Vec2::Zero();  ///< Centre of mass, across.
  /// True if the world or a script holds it: it transfers no weight to supports.
  bool held = false;
  bool slender = false;
  std::vector<std::uint32_t> below, above;
  std::vector<Vec2> places;  ///< Points of support on the bodies in `below`, across.
};

Vec3 to_axes(const Vec3& point_W, const Axes& axes) {
  return {point_W[axes.a], point_W[axes.b], axes.sign * point_W[axes.up]};
}

double narrower(const Box& box) { return box.extent().head<2>().minCoeff(); }

std::vector<Body> bodies_of(const Scene& scene, const Axes& axes) {
  std::vector<Body> bodies;
  for (const Solid& solid : scene.solids) {
    Body& body = bodies.emplace_back();
    for (const ConvexPtr& convex : solid.compound.convexes)
      for (const Vec3& corner : convex->polyhedron.vertices)
        body.box.extend(to_axes(solid.X_WR * corner, axes));
    const CompoundMass weight = mass_of(solid.compound, scene.materials);
    body.mass_kg = weight.mass_kg;
    body.center = to_axes(solid.X_WR * weight.com_R, axes).head<2>();
    body.held = solid.compound.is_anchored();
    body.slender = body.box.extent().z() >= kMinHeightToWidth * narrower(body.box);
  }
  for (const Ball& ball : scene.balls) {
    Body& body = bodies.emplace_back();
    const Vec3 center = to_axes(ball.center_W, axes), reach = Vec3::Constant(ball.radius_m);
    body.box = {center - reach, center + reach};
    body.mass_kg = ball_mass_kg(ball, scene.materials);
    body.center = center.head<2>();
  }
  for (const Move& move : scene.moves)
    for (const std::uint32_t root : move.roots) bodies[root].held = true;
  for (const Joint& joint : scene.joints) {  // bodies jointed to the world
    if (!joint.b && joint.a) bodies[*joint.a].held = true;
    if (!joint.a && joint.b) bodies[*joint.b].held = true;
  }
  return bodies;
}

/// Returns the fractions of a rigid body's weight borne by springs of equal stiffness at `places`:
/// the least-squares distribution in equilibrium. A spring in tension bears nothing.
std::vector<double> shares_of(const Vec2& center, const std::vector<Vec2>& places) {
  const auto count = static_cast<double>(places.size());
  const Vec2 mean = std::accumulate(places.begin(), places.end(), Vec2(Vec2::Zero())) / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vec2& place : places) spread += (place - mean) * (place - mean).transpose();
  // Points on one line make the matrix singular; the small addition makes it regular.
  const double more = 1e-9 * spread.trace() + 1e-12;
  const double aa = spread(0, 0) + more, bb = spread(1, 1) + more, ab = spread(0, 1);
  const Vec2 arm = center - mean;
  const Vec2 slope =
      Vec2(bb * arm.x() - ab * arm.y(), aa * arm.y() - ab * arm.x()) / (aa * bb - ab * ab);
  std::vector<double> shares;
  double sum = 0;
  for (const Vec2& place : places) {
    shares.push_back(std::max(0.0, 1 / count + slope.dot(place - mean)));
    sum += shares.back();
  }
  for (double& share : shares) share /= sum;
  return shares;
}

/// Sets `below`, `above` and `places` of each body.
void find_supports(std::vector<Body>& bodies) {
  std::vector<Box> boxes;
  for (const Body& body : bodies) boxes.push_back(body.box);
  const Bvh tree(boxes);
  std::vector<std::uint32_t> hits;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    Box foot = body.box;
    const double bottom = body.box.min.z(), reach = kMaxGap * narrower(body.box);
    foot.min.z() = bottom - reach, foot.max.z() = bottom + reach;
    hits.clear();
    tree.overlaps(foot, hits);
    for (const std::uint32_t other : hits) {
      const Box& lower = bodies[other].box;
      const Vec2 min = body.box.min.cwiseMax(lower.min).head<2>();
      const Vec2 max = body.box.max.cwiseMin(lower.max).head<2>();
      const double gap = kMaxGap * std::min(narrower(body.box), narrower(lower));
      if (other == i || std::abs(bottom - lower.max.z()) > gap) continue;
      if ((max - min).minCoeff() <= 0) continue;
      body.below.push_back(other);
      bodies[other].above.push_back(i);
      body.places.emplace_back(0.5 * (min + max));
    }
  }
}

/// Returns the loads on the bodies' tops, computed from the highest body down.
std::vector<double> loads_kg(const std::vector<Body>& bodies) {
  std::vector<std::uint32_t> order(bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return bodies[a].box.min.z() > bodies[b].box.min.z();
  });
  std::vector<double> loads(bodies.size(), 0);
  std::vector<Vec2> moments(bodies.size(), Vec2::Zero());  // moments of the loads, in kg m
  for (const std::uint32_t i : order) {
    const Body& body = bodies[i];
    if (body.held || body.below.empty()) continue;
    const double weight_kg = loads[i] + body.mass_kg;
    const Vec2 center = (moments[i] + body.mass_kg * body.center) / weight_kg;
    const std::vector<double> shares = shares_of(center, body.places);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      loads[body.below[k]] += shares[k] * weight_kg;
      moments[body.below[k]] += shares[k] * weight_kg * body.places[k];
    }
  }
  return loads;
}

/// Integrals over a cross-section: of density, and of Young's modulus with its moments.
struct Section {
  double mass_kg_m = 0, stiffness_N = 0;
  Vec2 first = Vec2::Zero();                         ///< In N m.
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< In N m².

  /// Adds the polygon in which a convex meets a horizontal plane, by its edges (Green's theorem).
  /// `sign` is that of a ghost.
  void add(const Convex& convex, const Material& material, double sign, const Pose& X_WR,
           const Axes& axes, double level) {
    const ConvexPolyhedron& hull = convex.polyhedron;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
      const auto corners = hull.face_corners(f);
      std::array<Vec2, 2> ends;
      std::size_t found = 0;
      for (std::size_t i = 0; i < corners.size() && found < 2; ++i) {
        const Vec3 p = to_axes(X_WR * hull.vertices[corners[i]], axes);
        const Vec3 q = to_axes(X_WR * hull.vertices[corners[(i + 1) % corners.size()]], axes);
        if ((p.z() < level) == (q.z() < level)) continue;
        ends[found++] = (p + (level - p.z()) / (q.z() - p.z()) * (q - p)).head<2>();
      }
      if (found == 2)
        add_edge(ends, to_axes(X_WR.rotation * hull.faces[f].plane.normal, axes),
                 sign * material.youngs_Pa, sign * material.density_kg_m3);
    }
  }

  /// Returns the least bending stiffness EI about the centroid; in planar scenes that in the plane.
  double bending_Nm2(bool planar, const Axes& axes) const {
    const Eigen::Matrix2d central = second - first * first.transpose() / stiffness_N;
    if (planar) return axes.a == 2 ? central(1, 1) : central(0, 0);
    const double mean = 0.5 * central.trace();
    return mean - hypotenuse(0.5 * (central(0, 0) - central(1, 1)), central(0, 1));
  }

 private:
  void add_edge(std::array<Vec2, 2> ends, const Vec3& normal, double youngs_Pa,
                double density_kg_m3) {
    const Vec2 along = ends[1] - ends[0];
    // The solid lies to the left of an edge whose normal points to its right.
    if (along.y() * normal.x() - along.x() * normal.y() < 0) std::swap(ends[0], ends[1]);
    const Vec2 &p = ends[0], &q = ends[1];
    const double cross = p.x() * q.y() - p.y() * q.x();
    mass_kg_m += 0.5 * density_kg_m3 * cross;
    stiffness_N += 0.5 * youngs_Pa * cross;
    first += youngs_Pa * cross / 6 * (p + q);
    second += youngs_Pa * cross / 24 *
              (p * p.transpose() + q * q.transpose() + (p + q) * (p + q).transpose());
  }
};

/// A post as a column of variable section.
struct Column {
  std::array<double, kLevels> flexibility_1_Nm2{};  ///< 1/EI from the foot up.
  double height_m = 0, weight_kg = 0;
  double gyration_m = 0;  ///< Least radius of gyration, averaged over the levels.

  /// Returns the critical load of the column, clamped at its foot and free at its head, without
  /// self-weight.
  ///
  /// The moment at a level is the load times u, the deflection of the head less that of the level.
  /// Integrating the curvature due to the moment gives u over the load, so iteration converges to
  /// the buckled shape (Vianello's method).
  double critical_N() const {
    const double step_m = height_m / kLevels;
    std::array<double, kLevels> u, curvature, slope, next;
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = sin_cos(0.5 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kLevels).cos;
    double load_N = 0;
    for (int k = 0; k < kIterations; ++k) {
      double sum = 0, work = 0, flexible_work = 0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        curvature[i] = flexibility_1_Nm2[i] * u[i];
        slope[i] = sum + 0.5 * curvature[i] * step_m;
        sum += curvature[i] * step_m;
      }
      sum = 0;
      for (std::size_t i = u.size(); i-- > 0;) {
        next[i] = sum + 0.5 * slope[i] * step_m;
        sum += slope[i] * step_m;
        work += curvature[i] * u[i];
        flexible_work += curvature[i] * next[i];
      }
      load_N = work / flexible_work;
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = load_N * next[i];
    }
    return load_N;
  }
};

/// Returns nothing if a section is empty.
std::optional<Column> column_of(const Scene& scene, const Solid& solid, const Axes& axes,
                                double foot_m, double height_m) {
  Column column;
  column.height_m = height_m;
  for (std::size_t i = 0; i < column.flexibility_1_Nm2.size(); ++i) {
    const double level = foot_m + (static_cast<double>(i) + 0.5) / kLevels * height_m;
    Section section;
    const auto add = [&](const Convex& convex, double sign) {
      section.add(convex, scene.materials[convex.material.value], sign, solid.X_WR, axes, level);
    };
    for (const ConvexPtr& convex : solid.compound.convexes) add(*convex, 1);
    for (const Ghost& ghost : solid.compound.ghosts)
      if (ghost.sign != 0) add(*ghost.convex, ghost.sign);
    if (section.mass_kg_m <= 0 || section.stiffness_N <= 0) return {};
    const double bending_Nm2 = section.bending_Nm2(scene.planar, axes);
    if (bending_Nm2 <= 0) return {};
    column.flexibility_1_Nm2[i] = 1 / bending_Nm2;
    column.weight_kg += section.mass_kg_m * height_m / kLevels;
    column.gyration_m += std::sqrt(bending_Nm2 / section.stiffness_N) / kLevels;
  }
  return column;
}

/// Returns K of a post, as defined at Post.
double length_factor_of(const std::vector<Body>& bodies, const Body& post) {
  double factor = 2;
  for (const std::uint32_t upper : post.above) {
    for (const std::uint32_t support : bodies[upper].below) {
      if (&bodies[support] == &post) continue;
      factor = std::min(factor, bodies[support].slender ? 1 : 0.7);
    }
    if (bodies[upper].held) factor = 0.7;
  }
  return factor;
}

/// Returns the top of the anchored part of a solid, or else the bottom of the solid.
double clamp_height(const Solid& solid, const Body& body, const Axes& axes) {
  double top = body.box.min.z();
  for (std::size_t i = 0; i < solid.compound.convexes.size(); ++i) {
    if (solid.compound.anchored[i] == 0) continue;
    for (const Vec3& corner : solid.compound.convexes[i]->polyhedron.vertices)
      top = std::max(top, to_axes(solid.X_WR * corner, axes).z());
  }
  return top;
}

/// True if the post is jointed to anything but a body that rests on it.
bool is_held_by_joint(const Scene& scene, const Body& post, std::uint32_t index) {
  return std::ranges::any_of(scene.joints, [&](const Joint& joint) {
    if (joint.a != index && joint.b != index) return false;
    const std::optional<std::uint32_t> other = joint.a == index ? joint.b : joint.a;
    return !other || std::ranges::count(post.above, *other) == 0;
  });
}

bool is_supported(const Scene& scene, const Body& body, const Axes& axes) {
  if (body.held || !body.below.empty() || !scene.ground.meshes.empty()) return true;
  const double gap = kMaxGap * narrower(body.box);
  return axes.up == 1 && axes.sign > 0 && std::abs(body.box.min.z() - scene.ground.height_m) <= gap;
}

}  // namespace

std::vector<Post> find_posts(const Scene& scene) {
  std::vector<Post> posts;
  const std::optional<Axes> axes = axes_of(scene);
  if (!axes || scene.solids.empty()) return posts;
  std::vector<Body> bodies = bodies_of(scene, *axes);
  if (std::ranges::none_of(bodies, &Body::slender)) return posts;
  find_supports(bodies);
  const std::vector<double> loads = loads_kg(bodies);
  const double g = scene.gravity_W.norm();
  for (std::uint32_t i = 0; i < scene.solids.size(); ++i) {
    const Solid& solid = scene.solids[i];
    const Body& body = bodies[i];
    if (!body.slender || !is_supported(scene, body, *axes) || is_held_by_joint(scene, body, i))
      continue;
    const double foot_m = clamp_height(solid, body, *axes);
    const double height_m = body.box.max.z() - foot_m;
    if (height_m < kMinHeightToWidth * narrower(body.box)) continue;
    const double factor = length_factor_of(bodies, body);
    const auto column = column_of(scene, solid, *axes, foot_m, height_m);
    if (!column || factor * height_m < kMinSlenderness * column->gyration_m) continue;
    const double euler_kg = column->critical_N() * (2 / factor) * (2 / factor) / g;
    const double self_weight = factor == 2 ? kSelfWeightFree : kSelfWeightHeld;
    posts.push_back({name_or_index(solid.name, "solid", i), height_m, loads[i],
                     std::max(0.0, euler_kg - self_weight * column->weight_kg), factor});
  }
  return posts;
}

std::string post_warning(const Scene& scene) {
  const std::vector<Post> posts = find_posts(scene);
  const Post* worst = nullptr;
  int count = 0;
  for (const Post& post : posts) {
    if (post.load_kg <= post.critical_kg) continue;
    ++count;
    if (!worst || post.load_kg * worst->critical_kg > worst->load_kg * post.critical_kg)
      worst = &post;
  }
  if (!worst) return {};
  const std::string others =
      count > 1 ? "; " + std::to_string(count - 1) + " more posts are overloaded" : "";
  const char* head = worst->length_factor == 2   ? "free at its head"
                     : worst->length_factor == 1 ? "free to sway with the posts beside it"
                                                 : "held at its head";
  char text[500];
  std::snprintf(text, sizeof text,
                "the post '%s' carries %.3g kg and would buckle: Euler's critical load is %.3g kg "
                "for a height of %.3g m, clamped at the foot and %s (K = %.1f); bodies are rigid, "
                "so the simulation does not show it; make the post thicker or shorter, raise "
                "youngs_Pa, or reduce its load%s",
                worst->name.c_str(), worst->load_kg, worst->critical_kg, worst->height_m, head,
                worst->length_factor, others.c_str());
  return text;
}

}  // namespace sunder
