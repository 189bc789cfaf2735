// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/judged_calibration.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "app/calibration_report.h"
#include "app/finding_list.h"
#include "app/judge_calibration.h"
#include "calib/calibrate_cameras.h"
#include "tests/support/synthetic_rig.h"

namespace marey::testing {
namespace {

/// Words of which a message must have one to name the fault.
std::vector<std::string> words_for(RigFault fault) {
  switch (fault) {
    case RigFault::kNone:
      return {};
    case RigFault::kNudged:
      return {"moved", "touched"};
    case RigFault::kRollingShutter:
      return {"line_delays"};
    case RigFault::kLate:
      return {};
    case RigFault::kWrongRate:
      return {"rate", "frames per second"};
    case RigFault::kWrongSize:
      return {"tag_size_m", "gap_m"};
    case RigFault::kMirrored:
      return {"mirrored"};
    case RigFault::kSwappedFloor:
      return {"swapped"};
    case RigFault::kWrongIds:
      return {"first_id", "ids"};
    case RigFault::kStrayTags:
      return {"does not go with the rest"};
  }
  return {};
}

bool names(const SimulatedCalibration& scene, const std::string& message) {
  const auto has = [&](const std::string& word) {
    return message.find(word) != std::string::npos;
  };
  const std::vector<std::string> any = words_for(scene.fault);
  if (std::none_of(any.begin(), any.end(), has)) return false;
  return !scene.camera || has("cam" + std::to_string(*scene.camera));
}

void compare(const SimulatedCalibration& scene,
             const calib::CalibratedRig& rig,
             JudgedCalibration& out) {
  // Without a floor the world is the first camera's.
  RigidTransform truth_from_world;
  if (scene.floor.empty()) {
    truth_from_world =
        inverse(scene.truth[0].camera_from_world) * rig.cameras[0].camera_from_world;
  }
  for (std::size_t c = 0; c < scene.truth.size(); ++c) {
    const RigidTransform world_from_truth = inverse(truth_from_world);
    const glm::dvec3 off = centre_in_world(rig.cameras[c]) -
                           world_from_truth * centre_in_world(scene.truth[c]);
    out.worst_m = std::max(out.worst_m, glm::length(off));
    const std::size_t at = calib::RigCovariance::kPerCamera * c + 15;
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      const auto k = at + static_cast<std::size_t>(i);
      const double sigma_m = std::sqrt(rig.covariance.at(k, k));
      if (!(sigma_m > 0.0)) continue;  // The camera that is the world.
      worst = std::max(worst, std::abs(off[i]) / sigma_m);
      ++out.coordinates;
      out.beyond_3_sigma += std::abs(off[i]) > 3.0 * sigma_m;
    }
    out.worst_sigmas = std::max(out.worst_sigmas, worst);
    if (worst > 3.0)
      out.worst_by_sigma_m = std::max(out.worst_by_sigma_m, glm::length(off));
  }
}

/// What its tests of other hypotheses say.
std::string figures_of(const calib::CalibratedRig& rig) {
  std::string out = app::worded("inliers %.3f px", rig.inlier_rms_px);
  if (const auto& move = rig.apparent_move) {
    out += app::worded("; move of %s from %d: %.2f px, gain %.0f",
                       rig.cameras[index(move->camera)].name.c_str(),
                       move->from_frame.value_or(-1),
                       move->moved_px,
                       move->gain);
  }
  if (const auto& delays = rig.apparent_line_delays) {
    double picture_s = 0.0;
    double shift_m = 0.0;
    for (std::size_t c = 0; c < delays->delay_s.size(); ++c) {
      const double own_s = delays->delay_s[c] * rig.cameras[c].intrinsics.height_px;
      picture_s = std::max(picture_s, std::abs(own_s));
      shift_m = std::max(shift_m, delays->shift_m[c]);
    }
    out += app::worded("; rows of %.1f ms, gain %.0f, shift %.1f mm",
                       1e3 * picture_s,
                       delays->gain,
                       1e3 * shift_m);
  }
  return out;
}

}  // namespace

JudgedCalibration judge(const SimulatedCalibration& scene) {
  JudgedCalibration out;
  calib::CalibrateOptions options;
  options.choose_clocks = true;
  options.cross_validate = true;
  auto rig = calib::calibrate_cameras(
      names_of(scene.truth), scene.waved, scene.floor, scene.board, options);
  const bool is_good_input =
      scene.fault == RigFault::kNone || scene.fault == RigFault::kLate;
  if (!rig) {
    out.exit_code = 3;
    out.words.push_back(rig.error().message());
    out.refused_though_good = is_good_input;
  } else {
    compare(scene, *rig, out);
    out.rms_px = rig->rms_px;
    out.figures = figures_of(*rig);
    const CalibrationTarget target = scene.board;
    const app::CalibrationReport report = app::report_calibration(
        {"simulated", "1.0", &target, 1.75, scene.rate_hz, !scene.floor.empty()},
        std::move(*rig));
    for (const app::Finding& finding : report.findings) {
      if (finding.severity == app::Severity::kNote) continue;
      const bool is_poor = finding.severity == app::Severity::kPoor;
      if (is_poor) out.exit_code = 4;
      out.words.push_back(std::string(is_poor ? "poor " : "fair ") + finding.kind + ": " +
                          finding.where + ": " + finding.cause + ": " + finding.next);
    }
    out.refused_though_good = out.exit_code == 4 && is_good_input && out.worst_m < 0.010;
  }
  for (const std::string& word : out.words) {
    out.names_fault = out.names_fault || names(scene, word);
  }
  return out;
}

}  // namespace marey::testing
