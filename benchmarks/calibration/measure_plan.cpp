// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Does a plan predict the true errors? This program compares the plan of a rendered rig
// with tags that its cameras detect, in trials whose cameras run on one clock. It places
// every tag that two cameras or more detect (by a rigid fit of its corners, with the true
// cameras), and compares the result with the true position.
//
//   measure_plan ../shared/data/blender/dev reach rom static
//
// Prints per trial and size of tag: the error of tags' centres, as measured and as
// predicted by expect_tag() for the same tags and the same cameras; then the result of
// plan_rig(), whose only input from the trial is the volume of its tags. Joints are
// points 0.15 m from the tag, in six directions.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "calib/plan/plan_rig.h"
#include "capture/tags/corner_sigma.h"
#include "capture/tags/detect_tags.h"
#include "capture/tags/track_tags.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/support/truth/fit_tag_pose.h"
#include "tests/support/truth/rendered_truth.h"

namespace marey {
namespace {

using calib::ErrorMapGrid;
using calib::ExpectedTag;
using calib::PlanOptions;
using tests::RenderedTruth;
using Corners = std::array<glm::dvec3, 4>;

/// The data's world is Z up.
const RigidTransform kWorldFromData{rotation_from_vector({-std::acos(0.0), 0.0, 0.0}),
                                    glm::dvec3(0.0)};

RigidTransform pose_of(const Corners& in_world) {
  const glm::dvec3 x = glm::normalize(in_world[1] - in_world[0]);
  const glm::dvec3 z = glm::normalize(glm::cross(x, in_world[0] - in_world[3]));
  return {glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)),
          0.25 * (in_world[0] + in_world[1] + in_world[2] + in_world[3])};
}

[[noreturn]] void stop(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  std::exit(1);
}

/// Detections of the cameras by frame and tag.
using Sightings = std::map<std::pair<int, int>, std::vector<testing::TagView>>;

void find_tags(RenderedTruth& truth, std::size_t camera, Sightings& sightings) {
  auto source = capture::open_frames(truth.video(camera));
  if (!source) stop(source.error());
  truth.cameras[camera].intrinsics.width_px = (*source)->info().width_px;
  truth.cameras[camera].intrinsics.height_px = (*source)->info().height_px;
  auto tracker = capture::TagTracker::create();
  if (!tracker) stop(tracker.error());
  while (true) {
    const auto frame = (*source)->next();
    if (!frame) stop(frame.error());
    if (!*frame) return;
    for (const TagDetection& tag : tracker->track(**frame)) {
      sightings[{(*frame)->index, number(tag.id)}].push_back(
          {&truth.cameras[camera], tag.corners_px, tag.sigma_px});
    }
  }
}

/// Squared errors, measured and expected.
struct Tally {
  std::vector<double> found_m;
  double found_m2 = 0.0;
  double expected_m2 = 0.0;
  double joint_found_m2 = 0.0;
  double joint_expected_m2 = 0.0;
  int tags = 0;
  int in_truth = 0;  ///< All tags of all frames.
  int foreseen_twice = 0;
  int found_twice = 0;

  [[nodiscard]] double rms_mm(double sum_m2) const {
    return 1e3 * std::sqrt(sum_m2 / tags);
  }
};

/// The error of a point 0.15 m off the tag, mean square over six directions.
double joint_error_m2(const RigidTransform& found,
                      const RigidTransform& truth,
                      double lever_m) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double way : {-lever_m, lever_m}) {
      glm::dvec3 lever(0.0);
      lever[axis] = way;
      const glm::dvec3 off = found * lever - truth * lever;
      sum += glm::dot(off, off) / 6.0;
    }
  }
  return sum;
}

/// Returns only the cameras of the views, so that expect_tag() uses no other camera.
std::vector<Camera> cameras_of(const std::vector<testing::TagView>& views) {
  std::vector<Camera> cameras;
  for (const testing::TagView& view : views) cameras.push_back(*view.camera);
  return cameras;
}

void evaluate_views(const std::vector<testing::TagView>& views,
                    const RigidTransform& world_from_tag,
                    PlanOptions options,
                    Tally& tally) {
  // A camera that detects the tag sees it: these limits reject none of them.
  options.max_angle_rad = 1.55;
  options.min_side_px = 1.0;
  const ExpectedTag expected = calib::expect_tag(cameras_of(views),
                                                 nullptr,
                                                 world_from_tag,
                                                 capture::expected_corner_sigma_px,
                                                 options);
  if (expected.seen_by.size() != views.size() || !expected.centre_error_m) return;
  const RigidTransform found = fit_tag_pose(views, options.tag_size_m, world_from_tag);
  const double off_m = glm::distance(found.translation, world_from_tag.translation);
  constexpr double kElsewhere_m = 0.05;  // A wrong id is no position error.
  if (off_m > kElsewhere_m) return;
  ++tally.tags;
  tally.found_m.push_back(off_m);
  tally.found_m2 += off_m * off_m;
  tally.expected_m2 += *expected.centre_error_m * *expected.centre_error_m;
  tally.joint_found_m2 += joint_error_m2(found, world_from_tag, options.lever_m);
  tally.joint_expected_m2 += *expected.joint_error_m * *expected.joint_error_m;
}

struct Box {
  glm::dvec3 min_m{1e9};
  glm::dvec3 max_m{-1e9};
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print_plan(const RenderedTruth& truth,
                const Box& box,
                double size_m,
                const Tally& t) {
  std::vector<Camera> cameras = truth.cameras;
  for (Camera& camera : cameras) {
    camera.camera_from_world = camera.camera_from_world * inverse(kWorldFromData);
  }
  PlanOptions options;
  options.tag_size_m = size_m;
  // Five heights of a body, from the lowest tag to the highest.
  ErrorMapGrid grid{box.min_m, box.max_m, 0.1, {}};
  for (int i = 0; i < 5; ++i) {
    grid.heights_m.push_back(box.min_m.y + 0.25 * i * (box.max_m.y - box.min_m.y));
  }
  const auto plan =
      calib::plan_rig(cameras, nullptr, grid, capture::expected_corner_sigma_px, options);
  double squares = 0.0;
  double joint_squares = 0.0;
  double share = 0.0;
  double weight = 0.0;
  for (const auto& place : plan.places) {
    share += place.measured_share / static_cast<double>(plan.places.size());
    if (!place.centre_error_m) continue;
    squares += place.measured_share * *place.centre_error_m * *place.centre_error_m;
    joint_squares += place.measured_share * *place.joint_error_m * *place.joint_error_m;
    weight += place.measured_share;
  }
  const double rms_mm = 1e3 * std::sqrt(squares / weight);
  const double joint_mm = 1e3 * std::sqrt(joint_squares / weight);
  std::printf(
      "    the plan of that volume: centre RMS %.3f mm (measured / planned %.2f), joint "
      "RMS "
      "%.3f mm (%.2f); seen by two %.0f %%, by the poses that tags had %.0f %%, found by "
      "two %.0f %%\n",
      rms_mm,
      t.rms_mm(t.found_m2) / rms_mm,
      joint_mm,
      t.rms_mm(t.joint_found_m2) / joint_mm,
      100.0 * share,
      100.0 * t.foreseen_twice / std::max(1, t.in_truth),
      100.0 * t.found_twice / std::max(1, t.in_truth));
}

void measure(const std::filesystem::path& session) {
  RenderedTruth truth = tests::load_rendered_truth(session);
  for (const double late : truth.late_frames) {
    if (late == 0.0) continue;
    std::printf("%s: left out, its cameras run apart\n", session.filename().c_str());
    return;
  }
  Sightings sightings;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) find_tags(truth, c, sightings);
  std::map<int, Tally> by_size_mm;
  std::map<int, Box> boxes;
  for (const auto& [key, corners] : truth.corners_in_world) {
    PlanOptions options;
    options.tag_size_m = glm::distance(corners[0], corners[1]);
    const int size_mm = static_cast<int>(std::lround(1e3 * options.tag_size_m));
    const RigidTransform world_from_tag = pose_of(corners);
    Box& box = boxes[size_mm];
    const glm::dvec3 place = kWorldFromData * world_from_tag.translation;
    box.min_m = glm::min(box.min_m, place);
    box.max_m = glm::max(box.max_m, place);
    Tally& tally = by_size_mm[size_mm];
    ++tally.in_truth;
    const ExpectedTag expected = calib::expect_tag(truth.cameras,
                                                   nullptr,
                                                   world_from_tag,
                                                   capture::expected_corner_sigma_px,
                                                   options);
    tally.foreseen_twice += expected.seen_by.size() >= 2 ? 1 : 0;
    const auto seen = sightings.find(key);
    if (seen == sightings.end() || seen->second.size() < 2) continue;
    ++tally.found_twice;
    evaluate_views(seen->second, world_from_tag, options, tally);
  }
  for (const auto& [size_mm, t] : by_size_mm) {
    if (t.tags == 0) continue;
    std::printf(
        "%s, tags of %d mm: %d placed; centre RMS %.3f mm, expected %.3f (%.2f), median "
        "%.3f mm; joint RMS %.3f mm, expected %.3f (%.2f)\n",
        session.filename().c_str(),
        size_mm,
        t.tags,
        t.rms_mm(t.found_m2),
        t.rms_mm(t.expected_m2),
        std::sqrt(t.found_m2 / t.expected_m2),
        1e3 * median(t.found_m),
        t.rms_mm(t.joint_found_m2),
        t.rms_mm(t.joint_expected_m2),
        std::sqrt(t.joint_found_m2 / t.joint_expected_m2));
    print_plan(truth, boxes.at(size_mm), 1e-3 * size_mm, t);
  }
}

}  // namespace
}  // namespace marey

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: measure_plan DATA TRIAL...\n");
    return 2;
  }
  for (int i = 2; i < count; ++i) {
    marey::measure(std::filesystem::path(arguments[1]) / arguments[i]);
  }
  return 0;
}
