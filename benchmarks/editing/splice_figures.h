// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "edit/find/find_splice.h"
#include "edit/ops/splice.h"
#include "edit/state/edit_state.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/result.h"
#include "core/pose.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey {

using edit::EditState;

/// Overlap of splices and crossfades. [s]
inline constexpr double kOverlap_s = 0.3;

/// A frame of one of the two clips.
struct ShownFrame {
  int clip = 0;
  int frame = 0;
};

/// A joined motion, by whatever method.
struct Joined {
  Motion motion;
  std::vector<ShownFrame> shown;  ///< Per frame, the clip that weighs more.
  int join = 0;                   ///< Last frame that shows more of the first clip.
  int first = 0;                  ///< First frame of the overlap.
  int last = 0;
};

using Places = std::vector<std::vector<glm::dvec3>>;  ///< [frame][joint]

inline Places joint_places(const Motion& motion) {
  Places out;
  for (const Pose& pose : motion.poses) {
    std::vector<glm::dvec3> places;
    for (const RigidTransform& joint : world_from_joints(motion.skeleton, pose)) {
      places.push_back(joint.translation);
    }
    out.push_back(std::move(places));
  }
  return out;
}

/// A largest value, and its place.
struct Peak {
  double value = 0.0;
  std::string joint;
  int frame = 0;
};

/// Returns the largest acceleration of a bone's joint. [m/s^2]
inline Peak peak_acceleration(const Motion& motion, int first, int last) {
  const Places places = joint_places(motion);
  Peak peak;
  const int end = static_cast<int>(places.size()) - 2;
  for (int t = std::max(first, 1); t <= std::min(last, end); ++t) {
    const auto k = static_cast<std::size_t>(t);
    for (std::size_t j = 0; j < places[k].size(); ++j) {
      const auto bone = motion.skeleton.joints[j].bone;
      if (!bone) continue;
      const glm::dvec3 change = places[k + 1][j] - 2.0 * places[k][j] + places[k - 1][j];
      const double size = glm::length(change) * motion.rate.hz * motion.rate.hz;
      if (size > peak.value) peak = {size, std::string(name(*bone)), t};
    }
  }
  return peak;
}

/// Frames in which each contact point bears: per point of retarget::kContactBones.
using Labels = std::array<std::vector<char>, retarget::kContactPoints>;

struct ClipLabels {
  Labels contacts;  ///< retarget::detect_contacts()
  Labels slow;      ///< retarget::label_contacts()
};

inline ClipLabels labels_of(const EditState& state) {
  ClipLabels out;
  const auto found = retarget::detect_contacts(state.motion, state.map);
  const std::size_t count = state.motion.poses.size();
  for (std::size_t side = 0; side < 2; ++side) {
    out.contacts[side] = retarget::frame_marks(found.feet[side].heel, count);
    out.contacts[2 + side] = retarget::frame_marks(found.feet[side].ball, count);
  }
  out.slow = retarget::label_contacts(retarget::contact_paths(state.motion, state.map),
                                      state.motion.rate.hz);
  return out;
}

/// Mean horizontal speed of labelled points from frame to frame.
struct Slide {
  double way_m = 0.0;
  int steps = 0;
  Peak worst;  ///< [m] per frame
  [[nodiscard]] double cm_per_s(double hz) const {
    return steps == 0 ? 0.0 : 100.0 * way_m / steps * hz;
  }
};

inline Slide slide_of(const Joined& joined,
                      const retarget::BodyMap& map,
                      const std::array<const Labels*, 2>& labels) {
  Slide out;
  const Places places = joint_places(joined.motion);
  const auto bears = [&](std::size_t point, std::size_t t) {
    const ShownFrame& shown = joined.shown[t];
    const auto& marks = (*labels[static_cast<std::size_t>(shown.clip)])[point];
    return !marks.empty() && marks[static_cast<std::size_t>(shown.frame)] != 0;
  };
  for (std::size_t point = 0; point < retarget::kContactPoints; ++point) {
    const auto joint = map.joint_of[index(retarget::kContactBones[point])];
    if (!joint) continue;
    for (int frame = joined.first + 1; frame <= joined.last; ++frame) {
      const auto t = static_cast<std::size_t>(frame);
      if (!bears(point, t) || !bears(point, t - 1)) continue;
      const glm::dvec3 step = places[t][index(*joint)] - places[t - 1][index(*joint)];
      const double way_m = std::hypot(step.x, step.z);
      out.way_m += way_m;
      if (way_m > out.worst.value) {
        out.worst = {way_m, std::string(name(retarget::kContactBones[point])), frame};
      }
      ++out.steps;
    }
  }
  return out;
}

inline Pose mixed_pose(const Pose& a, const Pose& b, double share) {
  Pose out = a;
  out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    out.parent_from_joint[j] =
        glm::normalize(glm::slerp(a.parent_from_joint[j], b.parent_from_joint[j], share));
  }
  return out;
}

/// Joins by a crossfade round these frames, as engines do.
inline Joined crossfade(const EditState& a, const EditState& b, int leave, int enter) {
  edit::FindSpliceOptions options;
  options.allow_opposed = true;
  const auto found = edit::find_splices(a, b, {{leave, leave}, {enter, enter}}, options);
  EditState moved = b;
  const auto& move = found.front().match.a_from_b;
  for (Pose& pose : moved.motion.poses) edit::move_pose(move, pose);
  const int half = static_cast<int>(std::lround(0.5 * kOverlap_s * a.motion.rate.hz));
  const int before = std::min({half, leave, enter});
  const int after =
      std::min({half, a.frame_count() - 1 - leave, b.frame_count() - 1 - enter});
  Joined out{a.motion, {}, leave, leave - before, leave + after};
  out.motion.poses.clear();
  for (int t = 0; t < leave - enter + b.frame_count(); ++t) {
    const double share =
        before + after == 0
            ? (t > leave ? 1.0 : 0.0)
            : std::clamp(
                  (t - leave + before) / static_cast<double>(before + after), 0.0, 1.0);
    const auto in_a = static_cast<std::size_t>(std::clamp(t, 0, a.frame_count() - 1));
    const auto in_b =
        static_cast<std::size_t>(std::clamp(t - leave + enter, 0, b.frame_count() - 1));
    const Pose& from = a.motion.poses[in_a];
    const Pose& to = moved.motion.poses[in_b];
    out.motion.poses.push_back(share <= 0.0   ? from
                               : share >= 1.0 ? to
                                              : mixed_pose(from, to, share));
    out.shown.push_back(share < 0.5 ? ShownFrame{0, static_cast<int>(in_a)}
                                    : ShownFrame{1, static_cast<int>(in_b)});
  }
  return out;
}

inline double figure_of(const edit::OpReport& report, const std::string& name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0.0;
}

/// A splice, as a joined motion.
struct SpliceRun {
  Joined joined;
  edit::OpReport report;
  int leave = 0;
  int enter = 0;
};

/// Joins two clips by the operation with the keys of `op`.
inline Result<SpliceRun> splice(const EditState& a, const EditState& b, SpliceOp op) {
  op.source = "next";
  EditOp with;
  with.parameters = op;
  edit::EditInputs inputs;
  inputs.sources.emplace("next", b);
  SpliceRun out;
  const auto made = edit::apply_splice(op, {with, 0, inputs}, a, out.report);
  if (!made) return made.error();
  out.leave = static_cast<int>(figure_of(out.report, "leave_frame"));
  out.enter = static_cast<int>(figure_of(out.report, "enter_frame"));
  out.joined.motion = made->motion;
  int join = -1;
  for (const edit::FrameLineage& entry : made->lineage.frames) {
    const EditState& clip = entry.source == 0 ? a : b;
    out.joined.shown.push_back(
        {entry.source,
         std::clamp(static_cast<int>(std::lround(entry.source_frame)),
                    0,
                    clip.frame_count() - 1)});
    if (entry.source == 0) ++join;
  }
  const double shown_s = std::max(kOverlap_s, figure_of(out.report, "overlap_s"));
  const int half = static_cast<int>(std::ceil(0.5 * shown_s * a.motion.rate.hz));
  out.joined.join = join;
  out.joined.first = std::max(0, join - half);
  out.joined.last = std::min(made->frame_count() - 1, join + half);
  return out;
}

}  // namespace marey
