// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/clip_constraints.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "engine/clips/sample_clip.h"

#include "retarget/constraints/activation.h"

namespace marey::engine {
namespace {

constexpr std::string_view kInWorld = "world/";

std::string reserved_id(const MotionClip& clip, const std::string& id) {
  return clip.name + "/" + id;
}

bool acts_with_clip(const Constraint& constraint) {
  return !std::holds_alternative<Support>(constraint.goal);
}

glm::dquat about_up(double angle_rad) {
  return glm::angleAxis(angle_rad, glm::dvec3(0.0, 1.0, 0.0));
}

}  // namespace

Result<std::vector<Constraint>> ClipConstraints::reserve(
    const MotionBase& base, std::span<const std::string> clips) {
  std::vector<Constraint> out;
  for (const std::string& name : clips) {
    const auto found = base.find(name);
    if (!found) {
      return bad_input("constraints of clip \"" + name + "\"",
                       "the base has no clip of this name",
                       "see the clips with marey base list");
    }
    const MotionClip& clip = base.clip(*found);
    for (const Constraint& constraint : clip.constraints.constraints) {
      if (!acts_with_clip(constraint)) continue;
      Constraint reserved = constraint;
      reserved.id = reserved_id(clip, constraint.id);
      if (auto* other = std::get_if<DistanceToConstraint>(&reserved.goal)) {
        other->other_id = reserved_id(clip, other->other_id);
      }
      // Its share decides.
      reserved.activation = {};
      out.push_back(std::move(reserved));
    }
  }
  return out;
}

void ClipConstraints::attach(const MotionBase& base,
                             std::span<const std::string> clips,
                             retarget::Adapter& adapter) {
  entries_.clear();
  for (const std::string& name : clips) {
    const std::size_t i = *base.find(name);
    const MotionClip& clip = base.clip(i);
    for (const Constraint& constraint : clip.constraints.constraints) {
      if (!acts_with_clip(constraint)) continue;
      auto handle = adapter.constraint(reserved_id(clip, constraint.id));
      if (!handle) continue;
      handle->set_share(0.0);
      entries_.push_back({i, constraint, constraint.id.starts_with(kInWorld), *handle});
    }
  }
}

void ClipConstraints::place(const Entry& entry,
                            const MotionClip& clip,
                            double source_s,
                            double leg_length_m,
                            const RootPlace& root,
                            retarget::Adapter::Handle handle) {
  const RootPlace there = path_at(clip, source_s);
  const double scale = leg_length_m / static_cast<double>(clip.leg_length_m);
  const glm::dquat turn = about_up(root.heading_rad - there.heading_rad);
  const glm::dvec3 from(there.x_m * leg_length_m, 0.0, there.z_m * leg_length_m);
  const glm::dvec3 to(root.x_m, 0.0, root.z_m);
  const auto moved_place = [&](const glm::dvec3& p) {
    return entry.stays_in_world ? p : to + turn * (scale * p - from);
  };
  if (const auto* point = std::get_if<DistanceToPoint>(&entry.constraint.goal)) {
    handle.set_target(moved_place(point->p_in_world));
  } else if (const auto* held = std::get_if<SegmentOrientation>(&entry.constraint.goal)) {
    handle.set_orientation(glm::normalize(
        entry.stays_in_world ? held->world_from_t_pose : turn * held->world_from_t_pose));
  } else {
    const auto* allowed = std::get_if<AllowedSpace>(&entry.constraint.goal);
    const auto* forbidden = std::get_if<ForbiddenSpace>(&entry.constraint.goal);
    if (allowed == nullptr && forbidden == nullptr) return;
    const glm::dvec3 min = allowed ? allowed->min_in_world : forbidden->min_in_world;
    const glm::dvec3 max = allowed ? allowed->max_in_world : forbidden->max_in_world;
    // A box keeps its axes; its middle moves.
    const glm::dvec3 middle = moved_place(0.5 * (min + max));
    const glm::dvec3 half = (entry.stays_in_world ? 0.5 : 0.5 * scale) * (max - min);
    handle.set_space(middle - half, middle + half);
  }
}

void ClipConstraints::step(double time_s, double leg_length_m, const BlendPlayer& blend) {
  for (Entry& entry : entries_) {
    const MotionClip& clip = blend.base().clip(entry.clip);
    double share = 0.0;
    double heaviest = 0.0;
    std::optional<double> source_s;
    const auto actions = blend.actions();
    for (std::size_t a = 0; a < actions.size(); ++a) {
      if (actions[a].is_live || actions[a].clip != entry.clip) continue;
      if (!actions[a].is_alive()) continue;
      double at_s = actions[a].warp.source_s(time_s);
      if (actions[a].loops) {
        at_s -= std::floor(at_s / clip.duration_s()) * clip.duration_s();
      }
      const PerGroup& weights = blend.weights(a);
      const double weight =
          static_cast<double>(*std::max_element(weights.begin(), weights.end()));
      share += weight * retarget::activation(entry.constraint.activation, at_s);
      if (weight > heaviest) {
        heaviest = weight;
        source_s = at_s;
      }
    }
    entry.handle.set_share(std::clamp(share, 0.0, 1.0));
    if (share > 0.0 && source_s) {
      place(entry, clip, *source_s, leg_length_m, blend.root(), entry.handle);
    }
  }
}

}  // namespace marey::engine
