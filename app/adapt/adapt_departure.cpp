// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_departure.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "app/adapt/frame_time.h"
#include "core/base/degrees.h"
#include "core/base/format_text.h"
#include "core/humanoid.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

double degrees_at(const AdaptDeparture& departure, int frame) {
  return kDegreesPerRadian * departure.trunk[static_cast<std::size_t>(frame)].rad;
}

std::string name_at(const AdaptDeparture& departure, const Motion& motion, int frame) {
  return motion.skeleton[departure.trunk[static_cast<std::size_t>(frame)].joint].name;
}

/// Returns hips, spine, neck and head, without the joints that a constraint controls.
std::vector<JointIndex> trunk_of(const Skeleton& skeleton,
                                 const ConstraintSet& constraints) {
  std::vector<JointIndex> out;
  for (const HumanBone bone : {HumanBone::kHips,
                               HumanBone::kSpine,
                               HumanBone::kChest,
                               HumanBone::kUpperChest,
                               HumanBone::kNeck,
                               HumanBone::kHead}) {
    if (const auto joint = skeleton.find(bone)) out.push_back(*joint);
  }
  for (const Constraint& c : constraints.constraints) {
    const auto own = retarget::resolve_segment(skeleton, c.point.segment);
    if (!own || std::find(out.begin(), out.end(), *own) == out.end()) continue;
    // An ancestor of a constrained segment rotates for the constraint.
    out.erase(std::remove_if(
                  out.begin(),
                  out.end(),
                  [&](JointIndex j) { return index(j) <= index(*own) || j == *own; }),
              out.end());
  }
  return out;
}

/// Returns true if `without` meets all constraints that `with` meets.
bool meets_same_constraints(const retarget::AdaptedMotion& with,
                            const retarget::AdaptedMotion& without) {
  for (std::size_t i = 0; i < with.constraints.size(); ++i) {
    if (without.constraints[i].met_frames < with.constraints[i].met_frames) return false;
  }
  return true;
}

}  // namespace

AdaptDeparture measure_adapt_departure(const Motion& source,
                                       const Motion& adapted,
                                       const ConstraintSet& constraints) {
  AdaptDeparture out;
  out.segments = retarget::measure_departure(source, adapted);
  const auto trunk = trunk_of(adapted.skeleton, constraints);
  if (trunk.empty()) return out;
  out.trunk = retarget::furthest_departures(source, adapted, trunk);
  for (std::size_t t = 0; t < out.trunk.size(); ++t) {
    if (out.trunk[t].rad > out.trunk[static_cast<std::size_t>(out.worst_frame)].rad) {
      out.worst_frame = static_cast<int>(t);
    }
    if (kDegreesPerRadian * out.trunk[t].rad > kFarTrunk_deg) ++out.far_frames;
  }
  return out;
}

void compare_without_balance(const Motion& source,
                             const retarget::AdaptedMotion& with,
                             const retarget::AdaptedMotion& without,
                             AdaptDeparture& departure) {
  if (departure.trunk.empty() || !meets_same_constraints(with, without)) return;
  std::vector<JointIndex> trunk;
  for (const retarget::FrameDeparture& frame : departure.trunk) {
    if (std::find(trunk.begin(), trunk.end(), frame.joint) == trunk.end()) {
      trunk.push_back(frame.joint);
    }
  }
  const auto other = retarget::furthest_departures(source, without.motion, trunk);
  for (std::size_t t = 0; t < other.size(); ++t) {
    const int frame = static_cast<int>(t);
    if (degrees_at(departure, frame) <= kFarTrunk_deg) continue;
    if (kDegreesPerRadian * other[t].rad > kNearTrunk_deg) continue;
    ++departure.needless_frames;
    const auto worst = departure.worst_needless_frame;
    if (!worst || degrees_at(departure, frame) > degrees_at(departure, *worst)) {
      departure.worst_needless_frame = frame;
    }
  }
}

Json departure_json(const AdaptDeparture& departure, const Motion& motion) {
  Json segments = Json::array();
  double sum_deg = 0.0;
  for (const retarget::SegmentDeparture& segment : departure.segments) {
    sum_deg += kDegreesPerRadian * segment.mean_rad;
    segments.push_back({{"segment", motion.skeleton[segment.joint].name},
                        {"mean_deg", kDegreesPerRadian * segment.mean_rad},
                        {"worst_deg", kDegreesPerRadian * segment.worst_rad},
                        {"worst_frame", segment.worst_frame},
                        {"worst_time_s", frame_time_s(motion, segment.worst_frame)}});
  }
  const double count = std::max(1.0, static_cast<double>(departure.segments.size()));
  Json out{{"mean_deg", sum_deg / count}};
  if (!departure.trunk.empty()) {
    const int frame = departure.worst_frame;
    out["trunk"] = {{"worst_deg", degrees_at(departure, frame)},
                    {"segment", name_at(departure, motion, frame)},
                    {"worst_frame", frame},
                    {"worst_time_s", frame_time_s(motion, frame)},
                    {"far_frames", departure.far_frames},
                    {"needless_frames", departure.needless_frames}};
  }
  out["segments"] = std::move(segments);
  return out;
}

std::string departure_summary(const AdaptDeparture& departure) {
  if (departure.trunk.empty()) return "";
  return format_text(", trunk up to %.0f degrees from its source",
                     degrees_at(departure, departure.worst_frame));
}

std::string departure_text(const AdaptDeparture& departure, const Motion& motion) {
  if (departure.far_frames == 0) return "";
  if (departure.worst_needless_frame) {
    const int frame = *departure.worst_needless_frame;
    return format_text(
        "balance turns %s by up to %.0f degrees from its source (frame %d, at %.2f s), "
        "in %d frames in which the same constraints are met without balance",
        name_at(departure, motion, frame).c_str(),
        degrees_at(departure, frame),
        frame,
        frame_time_s(motion, frame),
        departure.needless_frames);
  }
  const int frame = departure.worst_frame;
  return format_text(
      "%s is up to %.0f degrees from its source (frame %d, at %.2f s), and more than "
      "%.0f degrees in %d of %zu frames",
      name_at(departure, motion, frame).c_str(),
      degrees_at(departure, frame),
      frame,
      frame_time_s(motion, frame),
      kFarTrunk_deg,
      departure.far_frames,
      departure.trunk.size());
}

bool is_needlessly_far(const AdaptDeparture& departure) {
  const auto frame = departure.worst_needless_frame;
  return frame && degrees_at(departure, *frame) > kMaxTrunk_deg;
}

}  // namespace marey::app
