// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/plan_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/plan/tag_visibility.h"
#include "calib/rig/calibrate_cameras.h"
#include "calib/rig/make_calibrated_rig.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

constexpr int kWavedFrames = 90;
constexpr int kFloorFrames = 8;
constexpr double kPi = std::numbers::pi;

std::vector<CameraDetections> empty_detections(std::span<const Camera> cameras,
                                               int frames) {
  std::vector<CameraDetections> out(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    out[c].source = cameras[c].name;
    out[c].camera = CameraId{static_cast<int>(c)};
    out[c].width_px = cameras[c].intrinsics.width_px;
    out[c].height_px = cameras[c].intrinsics.height_px;
    out[c].rate.hz = 10.0;
    out[c].frames.resize(static_cast<std::size_t>(frames));
    for (int f = 0; f < frames; ++f) {
      out[c].frames[static_cast<std::size_t>(f)].frame = f;
    }
  }
  return out;
}

/// Returns the middle of a board in its own frame.
glm::dvec3 middle_of(const AprilGrid& board) {
  return 0.5 * (*board.corner_in_board(TagId{board.first_id}, 0) +
                *board.corner_in_board(TagId{board.first_id + board.tag_count() - 1}, 2));
}

/// Returns the horizontal directions to the cameras from the middle of the volume: angles
/// from +Z towards +X, ascending.
std::vector<double> headings_of(std::span<const Camera> cameras,
                                const glm::dvec3& middle) {
  std::vector<double> headings;
  for (const Camera& camera : cameras) {
    const glm::dvec3 way = centre_in_world(camera) - middle;
    headings.push_back(std::atan2(way.x, way.z));
  }
  std::sort(headings.begin(), headings.end());
  return headings;
}

/// Returns the direction of the board's face, `round` times around all cameras: from each
/// camera to the next, without showing its back to all cameras in between.
double heading_at(const std::vector<double>& headings, double round) {
  constexpr double kWide_rad = 2.6;
  const auto count = static_cast<double>(headings.size());
  const double at = (round - std::floor(round)) * count;
  const std::size_t i = std::min(static_cast<std::size_t>(at), headings.size() - 1);
  const double share = at - static_cast<double>(i);
  const double gap = i + 1 < headings.size()
                         ? headings[i + 1] - headings[i]
                         : headings.front() + 2.0 * kPi - headings.back();
  if (gap <= kWide_rad) return headings[i] + share * gap;
  // Back in the opposite direction, past the cameras' other neighbours.
  return headings.back() + share * (headings.front() - headings.back());
}

/// Returns the board at the fraction `share` (0 to 1) of the motion: two rounds of the
/// volume and of the cameras, with faster tilts than translations.
RigidTransform waved(const ErrorMapGrid& grid,
                     const AprilGrid& board,
                     const std::vector<double>& headings,
                     double share) {
  const double round = 4.0 * kPi * share;
  const glm::dvec3 middle = 0.5 * (grid.min_in_world + grid.max_in_world);
  // The operator's arms reach beyond the rim.
  const glm::dvec3 reach = 0.35 * (grid.max_in_world - grid.min_in_world);
  const glm::dvec3 place{middle.x + reach.x * std::sin(0.6 + 1.5 * round),
                         1.1 + 0.45 * std::sin(2.7 * round),
                         middle.z + reach.z * std::cos(1.5 * round)};
  const glm::dquat world_from_face =
      rotation_from_vector({0.0, heading_at(headings, 2.0 * share), 0.0}) *
      rotation_from_vector({0.55 * std::sin(7.3 * round) - 0.25, 0.0, 0.0}) *
      rotation_from_vector({0.0, 0.5 * std::sin(5.1 * round), 0.0}) *
      rotation_from_vector({0.0, 0.0, 0.6 * std::sin(3.2 * round)});
  return {world_from_face, place - world_from_face * middle_of(board)};
}

void add_board_views(std::span<const Camera> cameras,
                     const AprilGrid& board,
                     const RigidTransform& world_from_board,
                     std::size_t frame,
                     const CornerSigma& corner_sigma,
                     const PlanOptions& options,
                     std::vector<CameraDetections>& out) {
  const glm::dquat into_board = rotation_from_vector({kPi, 0.0, 0.0});
  for (int i = 0; i < board.tag_count(); ++i) {
    const TagId id{board.first_id + i};
    const glm::dvec3 centre =
        0.5 * (*board.corner_in_board(id, 0) + *board.corner_in_board(id, 2));
    const RigidTransform world_from_tag =
        world_from_board * RigidTransform{into_board, centre};
    const TagCorners corners = corners_in_world(world_from_tag, board.tag_size_m);
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto side_px = visible_side_px(cameras[c], world_from_tag, corners, options);
      if (!side_px) continue;
      TagDetection tag;
      tag.id = id;
      tag.sigma_px = corner_sigma(*side_px);
      tag.decision_margin = 80.0;
      for (std::size_t k = 0; k < 4; ++k) {
        tag.corners_px[k] = *project(cameras[c], corners[k]);
      }
      out[c].frames[frame].tags.push_back(tag);
    }
  }
}

/// Returns the next step for a board that does not calibrate these cameras.
std::string next_of(std::span<const CameraDetections> in_hand) {
  // The minimum numbers of tags and frames of estimate_intrinsics().
  constexpr std::size_t kMinTags = 6;
  constexpr int kMinFrames = 4;
  for (const CameraDetections& camera : in_hand) {
    int frames = 0;
    for (const FrameDetections& frame : camera.frames) {
      frames += frame.tags.size() >= kMinTags ? 1 : 0;
    }
    if (frames >= kMinFrames) continue;
    return "bring camera " + camera.source +
           " nearer to the volume, turn it there, or give it more pixels";
  }
  return "let the cameras' pictures overlap";
}

}  // namespace

Result<RigCovariance> plan_calibration(std::span<const Camera> cameras,
                                       const ErrorMapGrid& grid,
                                       const AprilGrid& board,
                                       const CornerSigma& corner_sigma,
                                       const PlanOptions& options) {
  MAREY_ASSERT(!cameras.empty());
  const glm::dvec3 middle = 0.5 * (grid.min_in_world + grid.max_in_world);
  const std::vector<double> headings = headings_of(cameras, middle);
  std::vector<CameraDetections> in_hand = empty_detections(cameras, kWavedFrames);
  for (int f = 0; f < kWavedFrames; ++f) {
    add_board_views(cameras,
                    board,
                    waved(grid, board, headings, f / static_cast<double>(kWavedFrames)),
                    static_cast<std::size_t>(f),
                    corner_sigma,
                    options,
                    in_hand);
  }
  std::vector<CameraDetections> floor = empty_detections(cameras, kFloorFrames);
  // Face up, its x along the world's X, its y along -Z.
  const RigidTransform lying{rotation_from_vector({-0.5 * kPi, 0.0, 0.0}),
                             {middle.x, board.thickness_m, middle.z}};
  for (std::size_t f = 0; f < kFloorFrames; ++f) {
    add_board_views(cameras, board, lying, f, corner_sigma, options, floor);
  }
  std::vector<std::string> names;
  for (const Camera& camera : cameras) names.push_back(camera.name);
  auto rig = calibrate_cameras(names, in_hand, floor, board);
  // Low cameras do not read a board on the floor: the first camera then defines the
  // world.
  if (!rig) rig = calibrate_cameras(names, in_hand, {}, board);
  if (!rig) {
    Error error = rig.error();
    error.next = next_of(in_hand);
    return error;
  }
  turn_covariance(glm::conjugate(cameras[0].camera_from_world.rotation) *
                      rig->cameras[0].camera_from_world.rotation,
                  rig->covariance);
  return std::move(rig->covariance);
}

RigCovariance covariance_of_quality(std::span<const CameraQuality> quality) {
  RigCovariance out;
  out.cameras = quality.size();
  out.values.assign(out.size() * out.size(), 0.0);
  for (std::size_t c = 0; c < quality.size(); ++c) {
    const std::size_t first = RigCovariance::kPerCamera * c;
    const auto set = [&](std::size_t i, double sigma) {
      out.values[(first + i) * out.size() + first + i] = sigma * sigma;
    };
    for (std::size_t i = 0; i < 2; ++i) set(i, quality[c].focal_sigma_px);
    for (std::size_t i = 1; i <= 3; ++i) {
      set(RigCovariance::kPerCamera - i, quality[c].centre_sigma_m);
    }
  }
  return out;
}

double centre_sigma_m(const RigCovariance& covariance, std::size_t camera) {
  MAREY_ASSERT(camera < covariance.cameras);
  double sum_m2 = 0.0;
  const std::size_t centre =
      RigCovariance::kPerCamera * camera + RigCovariance::kPerCamera - 3;
  for (std::size_t i = centre; i < centre + 3; ++i) sum_m2 += covariance.at(i, i);
  return std::sqrt(sum_m2 / 3.0);
}

void fit_to_quality(std::span<const CameraQuality> quality, RigCovariance& covariance) {
  MAREY_ASSERT(quality.size() == covariance.cameras);
  std::vector<double> factors;
  for (std::size_t c = 0; c < quality.size(); ++c) {
    const double planned_m = centre_sigma_m(covariance, c);
    const bool is_given = quality[c].centre_sigma_m > 0.0 && planned_m > 0.0;
    factors.push_back(is_given ? quality[c].centre_sigma_m / planned_m : 1.0);
  }
  for (std::size_t row = 0; row < covariance.size(); ++row) {
    for (std::size_t column = 0; column < covariance.size(); ++column) {
      covariance.values[row * covariance.size() + column] *=
          factors[row / RigCovariance::kPerCamera] *
          factors[column / RigCovariance::kPerCamera];
    }
  }
}

}  // namespace marey::calib
