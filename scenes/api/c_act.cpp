// The C interface: acts on bodies and joints.
#include <optional>
#include <string>

#include "scenes/api/c_base.h"

using namespace sunder;
using namespace sunder::scenes;

SunderResult sunder_world_remove_body(SunderWorld world, SunderBody body) {
  return change_world("sunder_world_remove_body", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    entry.world.remove(key_of(body));
  });
}

SunderResult sunder_world_remove_joint(SunderWorld world, SunderJoint joint) {
  return change_world("sunder_world_remove_joint", world, [&](WorldEntry& entry) {
    need_joint(entry, joint, "joint");
    entry.world.remove(JointKey(std::size_t{joint.key}));
  });
}

SunderResult sunder_world_move_to(SunderWorld world, SunderBody body, SunderPose X_WR,
                                  double duration_s) {
  return change_world("sunder_world_move_to", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    need_vector(X_WR.position, kMaxPosition_m, "X_WR.position");
    entry.world.move_to(key_of(body), pose(X_WR), duration_s);
  });
}

SunderResult sunder_world_release(SunderWorld world, SunderBody body) {
  return change_world("sunder_world_release", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    entry.world.release(key_of(body));
  });
}

SunderResult sunder_world_apply_impulse(SunderWorld world, SunderBody body, SunderVec3 impulse_W,
                                        SunderVec3 point_W) {
  return change_world("sunder_world_apply_impulse", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    need_vector(impulse_W, kMaxImpulse_Ns, "impulse_W");
    need_vector(point_W, kMaxPosition_m, "point_W");
    entry.world.apply_impulse(key_of(body), vec(impulse_W), vec(point_W));
  });
}

SunderResult sunder_world_break_at(SunderWorld world, SunderBody body, SunderVec3 point_W,
                                   SunderVec3 direction_W, double energy_J,
                                   const SunderPatternDef* pattern) {
  return change_world("sunder_world_break_at", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    need_vector(point_W, kMaxPosition_m, "point_W");
    need_vector(direction_W, kMaxPosition_m, "direction_W");
    std::optional<PatternSpec> spec;
    if (pattern) spec = pattern_of(*pattern, "pattern");
    entry.world.break_at(key_of(body), vec(point_W), vec(direction_W), energy_J, spec);
  });
}

SunderResult sunder_world_set_user_data(SunderWorld world, SunderBody body, uint64_t user_data) {
  return change_world("sunder_world_set_user_data", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    entry.world.set_user_data(key_of(body), user_data);
  });
}

SunderResult sunder_world_set_filter(SunderWorld world, SunderBody body, SunderFilter filter) {
  return change_world("sunder_world_set_filter", world, [&](WorldEntry& entry) {
    need_body(entry, body, "body");
    entry.world.set_filter(key_of(body), filter_of(filter));
  });
}

SunderResult sunder_world_report_hits(SunderWorld world, double least_m_s) {
  return change_world("sunder_world_report_hits", world,
                      [&](WorldEntry& entry) { entry.world.report_hits(least_m_s); });
}
