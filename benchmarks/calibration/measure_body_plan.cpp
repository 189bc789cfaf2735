// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Does a plan predict the results of `marey process`? This program compares the plan of a
// rendered rig and of the session's tags with the results of trials. The plan's only
// input from a trial is the part of the floor on which the trial takes place:
//
//   measure_body_plan SESSION OUT TRUTH TRIAL...
//
// SESSION is the session.toml that `marey process` reads, OUT its output folder, TRUTH
// the recording's folder. Joints and statistics are the same as in measure_accuracy.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/plan/plan_body.h"
#include "calib/plan/plan_calibration.h"
#include "capture/tags/corner_sigma.h"
#include "capture/tags/detect_tags.h"
#include "core/base/quantile.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/session.h"
#include "tests/support/truth/rendered_truth.h"
#include "tests/support/truth/truth.h"

namespace {

namespace fs = std::filesystem;
using namespace marey;

template <class T>
T must(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "%s\n", result.error().message().c_str());
  std::exit(1);
}

/// The rendered cameras in marey's world: the data's is Z up.
std::vector<Camera> true_cameras(const fs::path& trial,
                                 const recordings::Session& session) {
  std::vector<Camera> cameras = tests::load_rendered_truth(trial).cameras;
  const RigidTransform world_from_data{rotation_from_vector({-std::acos(0.0), 0.0, 0.0}),
                                       glm::dvec3(0.0)};
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    cameras[c].name = session.cameras[c];
    cameras[c].intrinsics.width_px = 1280;
    cameras[c].intrinsics.height_px = 720;
    cameras[c].camera_from_world =
        cameras[c].camera_from_world * inverse(world_from_data);
  }
  return cameras;
}

struct Measured {
  std::vector<double> all_m;
  std::map<HumanBone, std::vector<double>> by_joint_m;
  std::map<HumanBone, double> measured_share;
  glm::dvec3 min_m{1e9};
  glm::dvec3 max_m{-1e9};
};

Measured read_trial(const fs::path& out, const fs::path& truth) {
  Measured measured;
  const auto rows = must(recordings::read_joints_csv(out / "joints.csv"));
  const auto places = testing::truth_joints(truth / "truth/joints.csv");
  if (!places) std::exit(1);
  for (const auto& [key, place] : *places) {
    // The hips represent the position of the person.
    if (key.second != HumanBone::kLeftUpperLeg) continue;
    measured.min_m = glm::min(measured.min_m, place);
    measured.max_m = glm::max(measured.max_m, place);
  }
  for (const auto& row : rows) {
    const auto bone = human_bone(row.joint);
    if (!bone) continue;
    const auto place = places->find({row.frame, *bone});
    if (place == places->end()) continue;
    const double off_m = glm::distance(row.p_in_world, place->second);
    measured.all_m.push_back(off_m);
    measured.by_joint_m[*bone].push_back(off_m);
  }
  for (const auto& row : must(recordings::read_segments_csv(out / "segments.csv"))) {
    const auto bone = human_bone(row.segment);
    if (!bone || !measured.by_joint_m.contains(*bone)) continue;
    measured.measured_share[*bone] +=
        (row.source == Source::kMeasured ? 1.0 : 0.0) /
        static_cast<double>(measured.by_joint_m[*bone].size());
  }
  return measured;
}

void print_row(const char* name,
               double planned_m,
               double p95_m,
               const std::vector<double>& found_m,
               double share,
               double found_share) {
  const double median_m = median(found_m);
  const double found_p95_m = quantile(found_m, 0.95);
  std::printf(
      "  %-14s median %5.1f, planned %5.1f (%.2f); p95 %5.1f, planned %5.1f (%.2f);"
      " measured %3.0f %%, planned %3.0f %%\n",
      name,
      1e3 * median_m,
      1e3 * planned_m,
      median_m / planned_m,
      1e3 * found_p95_m,
      1e3 * p95_m,
      found_p95_m / p95_m,
      100.0 * found_share,
      100.0 * share);
}

void compare(const std::string& trial, const calib::BodyPlan& plan, const Measured& m) {
  double found_share = 0.0;
  for (const auto& [bone, share] : m.measured_share) found_share += share / 12.0;
  std::printf(
      "%s: planned body found in %.0f %% of frames, tags in "
      "one camera %.0f %%, in two %.0f %%\n",
      trial.c_str(),
      100.0 * plan.found_share,
      100.0 * plan.views_share,
      100.0 * plan.twice_share);
  print_row("all joints",
            plan.error_m.median,
            plan.error_m.p95,
            m.all_m,
            plan.measured_share,
            found_share);
  for (const calib::PlannedJoint& joint : plan.joints) {
    print_row(
        std::string(name(joint.bone)).c_str(),
        joint.error_m.median,
        joint.error_m.p95,
        m.by_joint_m.at(joint.bone),
        joint.measured_share,
        m.measured_share.contains(joint.bone) ? m.measured_share.at(joint.bone) : 0);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 5) {
    std::fprintf(stderr, "usage: measure_body_plan SESSION OUT TRUTH TRIAL...\n");
    return 2;
  }
  const auto session = must(recordings::read_session(arguments[1]));
  const fs::path out = arguments[2];
  const fs::path truth = arguments[3];
  const auto calibration = must(recordings::read_calibration(out / "calibration.toml"));
  const calib::PlannedBody body =
      calib::make_planned_body(session.subject.stature_m, session.tags);
  for (int i = 4; i < count; ++i) {
    const std::string trial = arguments[i];
    const Measured measured = read_trial(out / trial, truth / trial);
    const auto cameras = true_cameras(truth / trial, session);
    const calib::ErrorMapGrid grid{measured.min_m, measured.max_m, 0.25, {}};
    const calib::PlanBodyOptions options;
    const auto rig_covariance = must(calib::plan_calibration(
        cameras, grid, AprilGrid{}, capture::expected_corner_sigma_px, options.tags));
    if (i == 4) {
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        std::printf("%s: centre off by %.1f mm; sigma %.1f mm, planned %.1f\n",
                    cameras[c].name.c_str(),
                    1e3 * glm::distance(centre_in_world(cameras[c]),
                                        centre_in_world(calibration.cameras[c])),
                    1e3 * calibration.quality[c].centre_sigma_m,
                    1e3 * calib::centre_sigma_m(rig_covariance, c));
      }
    }
    const auto plan = [&](const calib::RigCovariance& covariance) {
      return calib::plan_body(
          cameras, &covariance, body, grid, capture::expected_corner_sigma_px, options);
    };
    compare(trial, plan(rig_covariance), measured);
    calib::RigCovariance calibrated = rig_covariance;
    calib::fit_to_quality(calibration.quality, calibrated);
    const calib::BodyPlan later = plan(calibrated);
    std::printf(
        "  with the calibration's own sigmas: median planned %.1f (%.2f), p95 %.1f "
        "(%.2f)\n",
        1e3 * later.error_m.median,
        median(measured.all_m) / later.error_m.median,
        1e3 * later.error_m.p95,
        quantile(measured.all_m, 0.95) / later.error_m.p95);
  }
  return 0;
}
