// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/check/judged_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "app/check/assess_moved_camera.h"
#include "calib/quality/assess_calibration.h"
#include "calib/quality/calibration_report.h"
#include "calib/quality/report_calibration.h"
#include "calib/rig/calibrate_cameras.h"
#include "calib/rig/calibrate_wand.h"
#include "calib/rig/find_moved_camera.h"
#include "core/base/format_text.h"
#include "core/base/quantile.h"
#include "reconstruct/clusters/check_views.h"
#include "reconstruct/clusters/triangulate.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::testing {
namespace {

/// Words of which a message must have one to name the fault.
std::vector<std::string> words_for(RigFault fault) {
  switch (fault) {
    case RigFault::kNone:
      return {};
    case RigFault::kNudged:
    case RigFault::kNudgedAfter:
      return {"moved", "touched"};
    case RigFault::kFlipped:
      return {"upside down", "turned by 180"};
    case RigFault::kFocalDrift:
    case RigFault::kRefocused:
      return {"focus"};
    case RigFault::kRarelySeen:
      return {"it saw the", "together at", "instants"};
    case RigFault::kSwappedTrial:
      return {"swapped"};
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
      return {"not fit the rest"};
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

/// Counts how many components of a camera's rotation are within 1.96 of their sigmas.
void count_turns(const Camera& truth,
                 const calib::CalibratedRig& rig,
                 std::size_t c,
                 const RigidTransform& world_from_truth,
                 JudgedCalibration& out) {
  const RigidTransform is = inverse(rig.cameras[c].camera_from_world);
  const RigidTransform was = world_from_truth * inverse(truth.camera_from_world);
  const glm::dvec3 turn = rotation_vector(is.rotation * glm::conjugate(was.rotation));
  const std::size_t at = calib::RigCovariance::kPerCamera * c + 12;
  for (int i = 0; i < 3; ++i) {
    const auto k = at + static_cast<std::size_t>(i);
    const double sigma_rad = std::sqrt(rig.covariance.at(k, k));
    if (!(sigma_rad > 0.0)) continue;
    ++out.turns;
    out.turns_inside += std::abs(turn[i]) < 1.96 * sigma_rad;
  }
}

/// Returns the median distance between the tags triangulated with `cameras` and the same
/// tags triangulated with `truth`. [m]
double body_off_m(const std::vector<Camera>& cameras,
                  const std::vector<Camera>& truth,
                  const std::vector<CameraDetections>& detections) {
  std::map<std::pair<int, TagId>, std::array<std::vector<reconstruct::PointView>, 2>>
      seen;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (const FrameDetections& frame : detections[c].frames) {
      for (const TagDetection& tag : frame.tags) {
        auto& [ours, theirs] = seen[{frame.frame, tag.id}];
        glm::dvec2 middle(0.0);
        for (const glm::dvec2& corner : tag.corners_px) middle += 0.25 * corner;
        ours.push_back({&cameras[c], middle});
        theirs.push_back({&truth[c], middle});
      }
    }
  }
  std::vector<double> errors;
  for (const auto& [key, views] : seen) {
    const auto ours = reconstruct::triangulate(views[0]);
    const auto theirs = reconstruct::triangulate(views[1]);
    if (ours && theirs) {
      errors.push_back(glm::distance(ours->p_in_world, theirs->p_in_world));
    }
  }
  return errors.empty() ? 0.0 : median(std::move(errors));
}

/// Returns the calibrated cameras as they stood when the motions were filmed: against
/// them a body shows the effect of a fault after the calibration.
std::vector<Camera> filmed_with(const SimulatedCalibration& scene,
                                const calib::CalibratedRig& rig) {
  std::vector<Camera> cameras = rig.cameras;
  if (scene.fault == RigFault::kSwappedTrial) {
    const std::size_t other = (*scene.camera + 1) % cameras.size();
    std::swap(cameras[*scene.camera], cameras[other]);
  } else if (scene.fault == RigFault::kNudgedAfter) {
    const Camera& before = scene.truth[*scene.camera];
    cameras[*scene.camera].camera_from_world = scene.moved->camera_from_world *
                                               inverse(before.camera_from_world) *
                                               cameras[*scene.camera].camera_from_world;
  }
  return cameras;
}

std::map<TagId, double> sizes_of(const std::vector<TagOnSegment>& tags) {
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : tags) sizes_m[tag.id] = tag.size_m;
  return sizes_m;
}

/// Judges the trials that follow as check_trials() of the program does.
void assess_motions(const SimulatedCalibration& scene,
                    const calib::CalibratedRig& rig,
                    JudgedCalibration& out) {
  std::vector<TagOnSegment> tags;
  for (const WornTag& worn : scene.worn) {
    tags.push_back({worn.id, HumanBone::kHips, worn.size_m});
  }
  const std::vector<Camera> truth = filmed_with(scene, rig);
  for (const auto* trial : {&scene.standing, &scene.walk}) {
    std::vector<CameraDetections> detections = *trial;
    for (std::size_t c = 0; c < detections.size(); ++c) {
      for (FrameDetections& frame : detections[c].frames) {
        for (TagDetection& tag : frame.tags) {
          tag.corners_px = unshrunk(tag.corners_px, rig.cameras[c].tag_shrinkage);
        }
      }
    }
    out.body_off_m = body_off_m(rig.cameras, truth, detections);
    const bool is_walk = trial == &scene.walk;
    if (const Status ok = reconstruct::check_views(rig.cameras, detections, tags); !ok) {
      out.exit_code = 3;
      out.words.push_back(ok.error().message());
      break;
    }
    const std::string name = is_walk ? "walk" : "static";
    if (auto moved = calib::find_moved_camera(rig.cameras, detections, sizes_of(tags))) {
      out.figures += format_text("; %s: cam%d %.2f px gain %.0f from %d",
                                 name.c_str(),
                                 index(moved->camera),
                                 moved->moved_px,
                                 moved->gain,
                                 moved->from_frame.value_or(-1));
    }
    const auto moved = app::assess_moved_camera(name, rig.cameras, detections, tags);
    if (!moved) continue;
    if (moved->severity == Severity::kPoor && out.exit_code == 0) out.exit_code = 4;
    out.words.push_back(
        std::string(moved->severity == Severity::kPoor ? "poor " : "fair ") +
        "moved: " + moved->message());
  }
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
      out.inside_95 += std::abs(off[i]) < 1.96 * sigma_m;
    }
    count_turns(scene.truth[c], rig, c, world_from_truth, out);
    out.worst_sigmas = std::max(out.worst_sigmas, worst);
    if (worst > 3.0)
      out.worst_by_sigma_m = std::max(out.worst_by_sigma_m, glm::length(off));
  }
}

/// Formats the inlier RMS and the results of the tests of other hypotheses.
std::string figures_of(const calib::CalibratedRig& rig) {
  std::string out = format_text("inliers %.3f px", rig.inlier_rms_px);
  if (const auto& move = rig.apparent_move) {
    out += format_text("; move of %s from %d: %.2f px, %.1f mm of cameras, gain %.0f",
                       rig.cameras[index(move->camera)].name.c_str(),
                       move->from_frame.value_or(-1),
                       move->moved_px,
                       1e3 * move->rig_shift_m,
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
    out += format_text("; rows of %.1f ms, gain %.0f, shift %.1f mm",
                       1e3 * picture_s,
                       delays->gain,
                       1e3 * shift_m);
  }
  return out;
}

Result<calib::CalibratedRig> calibrate(const SimulatedCalibration& scene,
                                       const calib::CalibrateOptions& options) {
  if (!scene.wand) {
    return calib::calibrate_cameras(
        names_of(scene.truth), scene.waved, scene.floor, scene.board, options);
  }
  calib::WandOptions wand_options;
  static_cast<calib::RigOptions&>(wand_options) = options;
  auto found = calib::calibrate_wand(
      names_of(scene.truth), scene.waved, *scene.wand, wand_options);
  if (!found) return found.error();
  return std::move(found->rig);
}

bool is_about_views(const Finding& finding) {
  const std::string kind = finding.id;
  return kind == "coverage" || kind == "views" || kind == "tilt" || kind == "volume" ||
         kind == "shared";
}

}  // namespace

JudgedCalibration judge(const SimulatedCalibration& scene) {
  JudgedCalibration out;
  calib::CalibrateOptions options;
  options.choose_clocks = true;
  options.cross_validate = true;
  auto rig = calibrate(scene, options);
  const bool is_good_input = scene.fault == RigFault::kNone ||
                             scene.fault == RigFault::kLate ||
                             scene.fault == RigFault::kFlipped;
  if (!rig) {
    out.exit_code = 3;
    out.words.push_back(rig.error().message());
    out.refused_though_good = is_good_input;
  } else {
    compare(scene, *rig, out);
    out.rms_px = rig->rms_px;
    out.figures = figures_of(*rig);
    const calib::CalibratedRig cameras = *rig;
    CalibrationTarget target = scene.board;
    if (scene.wand) target = *scene.wand;
    const calib::CalibrationReport report = calib::report_calibration(
        {"simulated", "1.0", &target, 1.75, scene.rate_hz, !scene.floor.empty()},
        std::move(*rig));
    for (const Finding& finding : report.findings) {
      if (finding.severity == Severity::kNote) continue;
      const bool is_poor = finding.severity == Severity::kPoor;
      if (is_poor) out.exit_code = 4;
      out.words.push_back(std::string(is_poor ? "poor " : "fair ") + finding.id + ": " +
                          finding.where + ": " + finding.cause + ": " + finding.next);
      out.is_noticed = out.is_noticed || is_poor || !is_about_views(finding);
    }
    assess_motions(scene, cameras, out);
    out.refused_though_good = out.exit_code == 4 && is_good_input && out.worst_m < 0.010;
  }
  for (const std::string& word : out.words) {
    out.names_fault = out.names_fault || names(scene, word);
  }
  out.is_noticed = out.is_noticed || out.exit_code != 0 || out.names_fault;
  return out;
}

}  // namespace marey::testing
