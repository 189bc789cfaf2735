// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_source.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/finding.h"
#include "core/nearest_word.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::edit {
namespace {

constexpr double kSameLength_m = 1e-9;
constexpr double kSameRate = 1e-9;  // Relative.

bool is_same_rest(const RigidTransform& a, const RigidTransform& b) {
  const double dot = glm::dot(a.rotation, b.rotation);
  return glm::distance(a.translation, b.translation) < kSameLength_m &&
         1.0 - dot * dot < kSameLength_m;
}

Error no_such_source(const std::string& id, const EditInputs& inputs) {
  if (inputs.sources.empty()) {
    return bad_input("source",
                     "the recipe has no source " + in_quotes(id),
                     "add a [[source]] with this id");
  }
  std::vector<std::string_view> ids;
  for (const auto& [known, state] : inputs.sources) ids.push_back(known);
  return bad_input(
      "source", "the recipe has no source " + in_quotes(id), suggestion(id, ids));
}

void resample_to(double hz, const std::string& id, EditState& state, OpReport& report) {
  const double old_hz = state.motion.rate.hz;
  if (std::abs(old_hz - hz) <= kSameRate * hz) {
    state.motion.rate.hz = hz;
    return;
  }
  const double last = state.frame_count() - 1;
  std::vector<double> at_frame;
  for (int k = 0; k * old_hz / hz <= last + kSameRate; ++k) {
    at_frame.push_back(std::min(k * old_hz / hz, last));
  }
  state = resample_state(state, at_frame, hz);
  report.findings.push_back(
      {Severity::kNote,
       "rate",
       "source " + in_quotes(id),
       format_text("resampled from %.6g to %.6g frames per second", old_hz, hz),
       ""});
}

// Moves points of the world as retarget_motion() moves the body.
struct ScaledWorld {
  double scale = 1.0;
  double floor_m = 0.0;

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p) const {
    return scale * glm::dvec3(p.x, p.y - floor_m, p.z);
  }
};

void scale_goal(const ScaledWorld& world, Goal& goal) {
  if (auto* to_point = std::get_if<DistanceToPoint>(&goal)) {
    to_point->distance_m *= world.scale;
    to_point->p_in_world = world(to_point->p_in_world);
  } else if (auto* to_body = std::get_if<DistanceToBody>(&goal)) {
    to_body->distance_m *= world.scale;
    to_body->other.offset_in_t_pose *= world.scale;
  } else if (auto* to_other = std::get_if<DistanceToConstraint>(&goal)) {
    to_other->distance_m *= world.scale;
  } else if (auto* allowed = std::get_if<AllowedSpace>(&goal)) {
    allowed->min_in_world = world(allowed->min_in_world);
    allowed->max_in_world = world(allowed->max_in_world);
  } else if (auto* forbidden = std::get_if<ForbiddenSpace>(&goal)) {
    forbidden->min_in_world = world(forbidden->min_in_world);
    forbidden->max_in_world = world(forbidden->max_in_world);
  } else if (auto* support = std::get_if<Support>(&goal)) {
    if (support->footprint_in_world) {
      support->footprint_in_world = world(*support->footprint_in_world);
    }
  }
}

std::vector<std::vector<JointUncertainty>> uncertainty_of_bones(const EditState& from,
                                                                const Skeleton& body) {
  std::vector<std::vector<JointUncertainty>> out;
  for (const auto& frame : from.uncertainty) {
    JointUncertainty worst;
    for (const JointUncertainty& entry : frame) {
      worst.sigma_m = std::max(worst.sigma_m, entry.sigma_m);
    }
    auto& entries = out.emplace_back(body.joints.size(), worst);
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
      const auto bone = body.joints[j].bone;
      if (!bone) continue;
      if (const auto joint = from.motion.skeleton.find(*bone)) {
        entries[j] = frame[index(*joint)];
      }
    }
  }
  return out;
}

Status retarget_to(const EditState& first,
                   const std::string& id,
                   EditState& state,
                   OpReport& report) {
  if (is_same_body(first.motion.skeleton, state.motion.skeleton)) return Done{};
  auto made = retarget::retarget_motion(state.motion, first.motion.skeleton);
  if (!made) return made.error();
  const ScaledWorld world{
      first.map.leg_length_m / state.map.leg_length_m,
      retarget::floor_height_m(state.map,
                               retarget::ankles_rest_m(state.map, state.contacts))};
  for (Constraint& constraint : state.constraints.constraints) {
    constraint.point.offset_in_t_pose *= world.scale;
    scale_goal(world, constraint.goal);
  }
  state.uncertainty = uncertainty_of_bones(state, first.motion.skeleton);
  state.motion = std::move(made->motion);
  state.map = first.map;
  for (std::size_t side = 0; side < 2; ++side) {
    state.contacts.feet[side].ankle_height_m = first.map.feet[side].ankle_height_m;
    state.contacts.feet[side].ball_height_m = first.map.feet[side].ball_height_m;
  }
  report.findings.push_back(
      {Severity::kNote,
       "body",
       "source " + in_quotes(id),
       format_text("retargeted to the body of the first motion, legs scaled by %.3f",
                   world.scale),
       ""});
  return Done{};
}

}  // namespace

bool is_same_body(const Skeleton& a, const Skeleton& b) {
  if (a.joints.size() != b.joints.size()) return false;
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    const Joint& x = a.joints[j];
    const Joint& y = b.joints[j];
    if (x.parent != y.parent || x.bone != y.bone) return false;
    // The place of a root at rest does not matter for poses.
    RigidTransform rest_y = y.parent_from_joint;
    if (!x.parent) rest_y.translation = x.parent_from_joint.translation;
    if (!is_same_rest(x.parent_from_joint, rest_y)) return false;
  }
  return true;
}

Result<EditState> fit_splice_source(const EditState& first,
                                    const std::string& id,
                                    const EditInputs& inputs,
                                    OpReport& report) {
  const auto found = inputs.sources.find(id);
  if (found == inputs.sources.end()) return no_such_source(id, inputs);
  EditState state = found->second;
  if (state.motion.poses.empty()) {
    return bad_input("source " + in_quotes(id), "has no frames", "use another motion");
  }
  resample_to(first.motion.rate.hz, id, state, report);
  if (const Status ok = retarget_to(first, id, state, report); !ok) return ok.error();
  return state;
}

}  // namespace marey::edit
