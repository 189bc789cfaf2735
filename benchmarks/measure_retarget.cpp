// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Do feet stay where they stand on other bodies? Recorded motions onto bodies of other
// proportions: slide, drift, sinking and float of the points that touch the floor in the
// source, and jerk against the source's own. docs/measurements.md says how to run it.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/captured_clips.h"
#include "benchmarks/contact_figures.h"
#include "benchmarks/result_table.h"
#include "core/pose.h"
#include "retarget/body_map.h"
#include "retarget/retarget_motion.h"

namespace marey {
namespace {

/// How long the bones of another body are, over the source's.
struct BodyScale {
  const char* name;
  double legs;
  double trunk;
  double arms;
};

constexpr std::array kBodies{
    BodyScale{"same", 1.0, 1.0, 1.0},
    BodyScale{"child 0.7", 0.7, 0.7, 0.7},
    BodyScale{"legs 1.2, trunk 0.9", 1.2, 0.9, 1.0},
    BodyScale{"legs 0.75, trunk 1.15", 0.75, 1.15, 1.0},
};

bool is_below(const Skeleton& skeleton, JointIndex joint, HumanBone bone) {
  std::optional<JointIndex> at = joint;
  while (at) {
    if (skeleton[*at].bone == bone) return true;
    at = skeleton[*at].parent;
  }
  return false;
}

Skeleton scaled(const Skeleton& body, const BodyScale& scale) {
  Skeleton out = body;
  for (std::size_t j = 0; j < out.joints.size(); ++j) {
    const JointIndex joint{static_cast<int>(j)};
    const bool is_leg = is_below(body, joint, HumanBone::kLeftUpperLeg) ||
                        is_below(body, joint, HumanBone::kRightUpperLeg);
    const bool is_arm = is_below(body, joint, HumanBone::kLeftShoulder) ||
                        is_below(body, joint, HumanBone::kRightShoulder);
    const double by = is_leg || !body.joints[j].parent ? scale.legs
                      : is_arm                         ? scale.arms
                                                       : scale.trunk;
    out.joints[j].parent_from_joint.translation *= by;
    if (out.joints[j].tip_in_joint) *out.joints[j].tip_in_joint *= by;
  }
  return out;
}

double height_m(const Skeleton& skeleton, const retarget::BodyMap& map) {
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  return rest[index(*map.joint_of[index(HumanBone::kHead)])].translation.y -
         rest[index(map.leg(0).end)].translation.y + map.feet[0].ankle_height_m;
}

std::array<double, kContactPoints> rest_heights(const retarget::BodyMap& map) {
  return {map.feet[0].ankle_height_m,
          map.feet[1].ankle_height_m,
          map.feet[0].ball_height_m,
          map.feet[1].ball_height_m};
}

void add_row(const CapturedClip& clip, const BodyScale& scale, ResultTable& table) {
  const Motion source{clip.character.skeleton, {clip.rate_hz}, 0, clip.poses};
  const Skeleton body = scaled(source.skeleton, scale);
  const auto from = retarget::map_body(source.skeleton);
  const auto to = retarget::map_body(body);
  if (!from || !to) return;
  const auto begin = std::chrono::steady_clock::now();
  const auto result = retarget::retarget_motion(source, body);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().cause.c_str());
    return;
  }
  const ContactLabels labels = label_contacts(contact_paths(source, *from), clip.rate_hz);
  const Motion& motion = result->motion;
  const ContactFigures figures = measure_contacts(
      contact_paths(motion, *to), labels, rest_heights(*to), clip.rate_hz);
  const double height_ratio = height_m(body, *to) / height_m(source.skeleton, *from);
  table.rows.push_back({clip.name,
                        scale.name,
                        figures.mean_slide_cm_per_s,
                        figures.worst_drift_mm,
                        figures.median_drift_mm,
                        figures.sinking_mm,
                        figures.float_mm,
                        static_cast<double>(figures.floating_frames),
                        mean_jerk(motion) / (height_ratio * mean_jerk(source)),
                        1e6 * took.count() / static_cast<double>(clip.poses.size())});
}

int run(const std::filesystem::path& mocap, const std::filesystem::path& json) {
  const auto clips = read_clips(mocap);
  if (!clips) {
    std::fprintf(stderr, "%s: %s\n", clips.error().where.c_str(), clips.error().cause.c_str());
    return 3;
  }
  ResultTable table{"contacts",
                    "Recorded motions on other bodies: feet and jerk",
                    {{"clip"},
                     {"body"},
                     {"slide cm/s", 3},
                     {"worst drift mm", 2},
                     {"median drift mm", 2},
                     {"sinking mm", 2},
                     {"float mm", 1},
                     {"frames > 5", 0},
                     {"jerk", 3},
                     {"us/frame", 1}},
                    {},
                    {}};
  for (const CapturedClip& clip : *clips) {
    for (const BodyScale& scale : kBodies) add_row(clip, scale, table);
  }
  print_table(table);
  if (json.empty()) return 0;
  return write_tables(json, {table}) ? 0 : 5;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_retarget MOCAP_FOLDER [FIGURES.json]\n");
    return 2;
  }
  return marey::run(argv[1], argc > 2 ? argv[2] : "");
}
