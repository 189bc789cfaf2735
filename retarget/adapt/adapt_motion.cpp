// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/adapt_motion.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/nearest_word.h"
#include "core/pose.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::retarget {
namespace {

/// Starts and stops the support of a track at its times, and updates its target.
class TrackDriver {
 public:
  TrackDriver(const SupportTrack& track, Adapter::Handle handle, const Motion& motion)
      : track_(track), handle_(handle), motion_(motion) {}

  void at(std::size_t frame) {
    handle_.set_target(track_.p_in_world[frame]);
    handle_.set_orientation(track_.world_from_t_pose[frame]);
    const Activation& when = track_.constraint.activation;
    // The next run may fade in after the last one has faded out.
    while (next_ < track_.bears.size() &&
           (next_ == 0 ||
            time_s(frame) >= stop_s(track_.bears[next_ - 1]) + when.stop_duration_s)) {
      const FrameRange& run = track_.bears[next_++];
      handle_.start(time_s(run.first) - when.start_duration_s - slack_s());
      handle_.stop(stop_s(run));
    }
  }

 private:
  template <class Frame>
  [[nodiscard]] double time_s(Frame frame) const {
    return (motion_.first_frame + static_cast<double>(frame)) / motion_.rate.hz;
  }
  /// The first and the last contact frame must be fully active despite rounding.
  [[nodiscard]] double slack_s() const { return 0.01 / motion_.rate.hz; }
  [[nodiscard]] double stop_s(const FrameRange& run) const {
    return time_s(run.last) + slack_s();
  }

  const SupportTrack& track_;
  Adapter::Handle handle_;
  const Motion& motion_;
  std::size_t next_ = 0;
};

/// Accumulates the errors of one constraint.
class ConstraintErrors {
 public:
  ConstraintErrors(const Character& character,
                   const Constraint& constraint,
                   const ConstraintSet& set,
                   const SupportTrack* track)
      : constraint_(constraint), measure_(character, constraint, set), track_(track) {
    kept_.id = constraint.id;
    kept_.is_support = std::holds_alternative<Support>(constraint.goal);
    kept_.is_orientation = std::holds_alternative<SegmentOrientation>(constraint.goal);
  }

  void add_frame(std::size_t frame,
                 double activation,
                 bool capped,
                 std::span<const RigidTransform> world_from_joint) {
    if (activation < 1.0) {
      footprint_in_world_.reset();
      return;
    }
    if (!footprint_in_world_)
      footprint_in_world_ = measure_.point().in_world(world_from_joint);
    const Shortfall shortfall = shortfall_at(frame, world_from_joint);
    ++kept_.active_frames;
    const bool met = is_met(constraint_, shortfall);
    if (met) ++kept_.met_frames;
    if (!met && capped) kept_.ran_out = true;
    kept_.mean_error_m += shortfall.m;
    kept_.mean_error_rad += shortfall.rad;
    // One of the two is always 0.
    if (!kept_.worst_frame || shortfall.m > kept_.worst_error_m ||
        shortfall.rad > kept_.worst_error_rad) {
      kept_.worst_error_m = shortfall.m;
      kept_.worst_error_rad = shortfall.rad;
      kept_.worst_frame = static_cast<int>(frame);
    }
  }

  [[nodiscard]] KeptConstraint kept() const {
    KeptConstraint out = kept_;
    if (out.active_frames == 0) return out;
    out.mean_error_m /= out.active_frames;
    out.mean_error_rad /= out.active_frames;
    return out;
  }

 private:
  [[nodiscard]] Shortfall shortfall_at(
      std::size_t frame, std::span<const RigidTransform> world_from_joint) const {
    if (track_ == nullptr)
      return measure_.shortfall(world_from_joint, *footprint_in_world_);
    return {glm::distance(measure_.point().in_world(world_from_joint),
                          track_->p_in_world[frame]),
            0.0};
  }

  const Constraint& constraint_;
  ConstraintMeasure measure_;
  const SupportTrack* track_;
  KeptConstraint kept_;
  std::optional<glm::dvec3> footprint_in_world_;  ///< Set when fully active.
};

/// Measures the departure of joints from their motion, frame by frame.
class AwayWatch {
 public:
  AwayWatch(std::size_t joints, FrameRate rate)
      : before_(joints), last_(joints), rate_(rate) {}

  void add_frame(int frame,
                 std::span<const RigidTransform> was,
                 std::span<const RigidTransform> is) {
    for (std::size_t j = 0; j < last_.size(); ++j) {
      const glm::dvec3 away = is[j].translation - was[j].translation;
      const double bend_m = glm::length(away - 2.0 * last_[j] + before_[j]);
      const double m_per_s2 = bend_m * rate_.hz * rate_.hz;
      if (frame >= 2 && m_per_s2 > added_.m_per_s2) {
        added_ = {m_per_s2, static_cast<JointIndex>(j), frame - 1};
      }
      before_[j] = last_[j];
      last_[j] = away;
    }
  }
  [[nodiscard]] const AddedAcceleration& added() const { return added_; }

 private:
  std::vector<glm::dvec3> before_;
  std::vector<glm::dvec3> last_;
  FrameRate rate_;
  AddedAcceleration added_;
};

Status take_loads(const Character& character,
                  const std::vector<std::string>& carried,
                  Adapter& adapter) {
  std::vector<std::string_view> names;
  for (const Load& load : character.loads) {
    names.push_back(load.name);
    adapter.carry(load.name, false);
  }
  for (const std::string& name : carried) {
    if (adapter.carry(name, true)) continue;
    return bad_input("load \"" + name + "\"",
                     "the character has no such load",
                     names.empty() ? "add a [[load]] to the character's file"
                                   : suggestion(name, names));
  }
  return Done{};
}

void add_report(const AdaptReport& report, int frame, AdaptedMotion& out) {
  out.mean_iterations += report.iterations;
  out.max_iterations = std::max(out.max_iterations, report.iterations);
  if (report.capped) ++out.capped_frames;
  out.mean_balance_error_m += report.balance_error_m;
  if (report.balance_error_m <= out.worst_balance_error_m) return;
  out.worst_balance_error_m = report.balance_error_m;
  out.worst_balance_frame = frame;
}

}  // namespace

Result<AdaptedMotion> adapt_motion(const Motion& motion,
                                   const Character& character,
                                   const ConstraintSet& constraints,
                                   std::span<const SupportTrack> supports,
                                   const AdaptMotionOptions& options,
                                   const Progress& progress) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  ConstraintSet all = constraints;
  for (const SupportTrack& track : supports) {
    MAREY_ASSERT(track.p_in_world.size() == motion.poses.size());
    all.constraints.push_back(track.constraint);
  }
  const bool has_targets = !options.com_in_world.empty();
  MAREY_ASSERT(!has_targets || options.com_in_world.size() == motion.poses.size());
  AdaptOptions adapt = options.adapt;
  if (has_targets && adapt.balance == BalanceMode::kZmp) {
    adapt.balance = BalanceMode::kHorizontal;
  }
  Result<Adapter> adapter = Adapter::make(character, all, adapt);
  if (!adapter) return adapter.error();
  if (const Status ok = take_loads(character, options.carried, *adapter); !ok) {
    return ok.error();
  }

  std::vector<ConstraintErrors> errors;
  std::vector<Adapter::Handle> handles;
  std::vector<TrackDriver> drivers;
  const std::size_t own = constraints.constraints.size();
  for (std::size_t i = 0; i < all.constraints.size(); ++i) {
    const Constraint& c = all.constraints[i];
    const SupportTrack* track = i < own ? nullptr : &supports[i - own];
    errors.emplace_back(character, c, all, track);
    handles.push_back(*adapter->constraint(c.id));
    if (track != nullptr) drivers.emplace_back(*track, handles.back(), motion);
  }

  AdaptedMotion out;
  out.motion = {motion.skeleton, motion.rate, motion.first_frame, {}};
  out.motion.poses.resize(motion.poses.size());
  const int count = static_cast<int>(motion.poses.size());
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  std::vector<RigidTransform> reference(world_from_joint.size());
  AwayWatch watch(world_from_joint.size(), motion.rate);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    for (TrackDriver& driver : drivers) driver.at(t);
    if (has_targets) adapter->set_balance_target(options.com_in_world[t]);
    world_from_joints(motion.skeleton, motion.poses[t], reference);
    const double time_s = (motion.first_frame + static_cast<double>(t)) / motion.rate.hz;
    const AdaptReport report =
        adapter->adapt(motion.poses[t], time_s, out.motion.poses[t]);
    add_report(report, static_cast<int>(t), out);
    world_from_joints(motion.skeleton, out.motion.poses[t], world_from_joint);
    watch.add_frame(static_cast<int>(t), reference, world_from_joint);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i].add_frame(
          t, handles[i].outcome().activation, report.capped, world_from_joint);
    }
    if (progress) progress(static_cast<int>(t) + 1, count);
  }
  out.added = watch.added();
  const double share = count > 0 ? 1.0 / count : 0.0;
  out.mean_iterations *= share;
  out.mean_balance_error_m *= share;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    (i < own ? out.constraints : out.supports).push_back(errors[i].kept());
  }
  return out;
}

}  // namespace marey::retarget
