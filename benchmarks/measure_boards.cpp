// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Boards: rendered ones, whose truth is known; photographs and webcams, whose is not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "benchmarks/calibration_cases.h"
#include <glm/geometric.hpp>

#include "calib/calibrate_cameras.h"
#include "capture/detect_videos.h"
#include "core/quantile.h"
#include "reconstruct/triangulate.h"
#include "tests/support/rendered_truth.h"

namespace marey::calib {
namespace {

std::vector<CameraDetections> detect(const std::vector<capture::CameraInput>& inputs,
                                     const capture::DetectVideosOptions& options) {
  auto found = capture::detect_tags_in_videos(inputs, options);
  if (!found) {
    std::fprintf(stderr, "%s\n", found.error().message().c_str());
    std::exit(1);
  }
  return std::move(*found);
}

/// The recording as a camera that started `late` frames later has it, from frame `first`
/// to `last` of the whole.
CameraDetections cut(const CameraDetections& whole, int late, int first, int last) {
  CameraDetections out = whole;
  out.frames.clear();
  for (FrameDetections frame : whole.frames) {
    if (frame.frame < std::max(first, late) || frame.frame > last) continue;
    frame.frame -= late;
    out.frames.push_back(frame);
  }
  return out;
}

/// The truth's cameras in marey's world: Y up.
Camera in_our_world(Camera camera) {
  const RigidTransform ours_from_theirs{
      rotation_from_vector({-0.5 * std::numbers::pi, 0.0, 0.0}), glm::dvec3(0.0)};
  camera.camera_from_world = camera.camera_from_world * inverse(ours_from_theirs);
  return camera;
}

void compare(const CalibratedRig& rig,
             const std::vector<Camera>& truth,
             const std::vector<int>& late,
             double hz) {
  for (std::size_t c = 0; c < truth.size(); ++c) {
    const Camera expected = in_our_world(truth[c]);
    const Camera& found = rig.cameras[c];
    const std::size_t at = RigCovariance::kPerCamera * c;
    const auto sigma = [&](std::size_t i) {
      return std::sqrt(rig.covariance.at(at + i, at + i));
    };
    double worst = 0.0;
    const auto off = [&](double error, std::size_t i) {
      worst = std::max(worst, std::abs(error) / sigma(i));
      return error;
    };
    glm::dvec3 centre = centre_in_world(found) - centre_in_world(expected);
    const glm::dvec3 turn =
        rotation_vector(glm::conjugate(found.camera_from_world.rotation) *
                        expected.camera_from_world.rotation);
    glm::dvec2 focal = found.intrinsics.focal_px - expected.intrinsics.focal_px;
    glm::dvec2 middle = found.intrinsics.centre_px - expected.intrinsics.centre_px;
    for (int i = 0; i < 3; ++i) {
      off(centre[i], static_cast<std::size_t>(15 + i));
      off(turn[i], static_cast<std::size_t>(12 + i));
    }
    for (int i = 0; i < 2; ++i) {
      off(focal[i], static_cast<std::size_t>(i));
      off(middle[i], static_cast<std::size_t>(2 + i));
    }
    const double clock_off_s = rig.clocks[c].offset_s - late[c] / hz;
    std::printf(
        "%s: centre %.2f mm, turn %.3f deg, focal %.3f %%, principal point %.2f px",
        found.name.c_str(),
        1e3 * glm::length(centre),
        180.0 / std::numbers::pi * glm::length(turn),
        100.0 * std::max(std::abs(focal.x), std::abs(focal.y)) /
            expected.intrinsics.focal_px.x,
        glm::length(middle));
    if (rig.clocks[c].offset_sigma_s > 0.0) {
      std::printf(", clock %+.3f ms (+- %.3f)",
                  1e3 * clock_off_s,
                  1e3 * rig.clocks[c].offset_sigma_s);
    }
    std::printf("; worst %.1f of its own sigmas\n", worst);
  }
}

void print_cross_validation(const CalibratedRig& rig) {
  if (!rig.cross_validation) return;
  const CrossValidation& v = *rig.cross_validation;
  std::printf("even frames %.3f px, held-out odd frames %.3f px\n",
              v.seen_rms_px,
              v.held_out_rms_px);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    std::printf("  %s: odd less even: centre %.2f mm, turn %.4f deg, focal %+.2f px",
                rig.cameras[c].name.c_str(),
                1e3 * v.centre_apart_m[c],
                180.0 / std::numbers::pi * v.turn_apart_rad[c],
                v.focal_apart_px[c]);
    if (v.held_out_camera_px[c]) {
      std::printf("; held-out camera: median %.3f px", *v.held_out_camera_px[c]);
    }
    std::printf("\n");
  }
}

int calibrate_and_compare(const tests::RenderedTruth& truth,
                          const std::vector<CameraDetections>& whole,
                          const std::vector<int>& late) {
  const AprilGrid board{6, 6, 0.1, 0.03, 0, 0.005};
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < whole.size(); ++c) {
    waved.push_back(cut(whole[c], late[c], 0, 89));
    floor.push_back(cut(whole[c], late[c], 0, 7));
    names.push_back(truth.cameras[c].name);
  }
  CalibrateOptions options;
  options.solve_offsets =
      std::any_of(late.begin(), late.end(), [](int frames) { return frames > 0; });
  const Stopwatch watch;
  const auto rig = calibrate_cameras(names, waved, floor, board, options);
  std::printf("%s: %.1f s\n",
              options.solve_offsets ? "unsynchronised starts" : "synchronised",
              watch.seconds());
  if (!rig) {
    std::printf("%s\n", rig.error().message().c_str());
    return 1;
  }
  print_rig(*rig);
  compare(*rig, truth.cameras, late, 10.0);
  for (std::size_t i = 0; i < std::min<std::size_t>(5, rig->outlier_frames.size()); ++i) {
    const OutlierFrame& o = rig->outlier_frames[i];
    std::printf("  outlier: camera %zu frame %d, %d of %d tags, %.1f px off\n",
                index(o.camera),
                o.frame,
                o.sightings,
                o.of,
                o.median_error_px);
  }
  return 0;
}

}  // namespace

int measure_rendered(const std::filesystem::path& folder) {
  const tests::RenderedTruth truth = tests::load_rendered_truth(folder / "calib");
  std::vector<capture::CameraInput> inputs;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
    capture::CameraInput input;
    input.path = truth.video(c);
    input.camera = CameraId{static_cast<int>(c)};
    inputs.push_back(input);
  }
  const auto whole = detect(inputs, {});
  const int synchronised = calibrate_and_compare(truth, whole, {0, 0, 0, 0});
  return std::max(synchronised, calibrate_and_compare(truth, whole, {0, 3, 7, 5}));
}

int measure_stereo(const std::filesystem::path& folder) {
  const Chessboard board{.rows = 7, .columns = 10, .square_size_m = 1.0};
  const auto scratch = std::filesystem::temp_directory_path() / "measure_stereo";
  std::filesystem::remove_all(scratch);
  std::vector<capture::CameraInput> inputs;
  for (const std::string side : {"left", "right"}) {
    std::filesystem::create_directories(scratch / side);
    for (int i = 1; i <= 14; ++i) {
      const std::string name = side + (i < 10 ? "0" : "") + std::to_string(i) + ".jpg";
      const auto file = std::filesystem::absolute(folder / name);
      if (!std::filesystem::exists(file)) continue;
      std::filesystem::create_symlink(file, scratch / side / name);
    }
    capture::CameraInput input;
    input.path = scratch / side;
    input.camera = CameraId{static_cast<int>(inputs.size())};
    input.rate = FrameRate{1.0};
    inputs.push_back(input);
  }
  capture::DetectVideosOptions options;
  options.find_tags = false;
  options.target = board;
  const auto waved = detect(inputs, options);
  std::filesystem::remove_all(scratch);
  for (const LensModel lens : {LensModel::kBrownConrady, LensModel::kRational}) {
    CalibrateOptions calibrate;
    calibrate.lens = lens;
    calibrate.cross_validate = true;
    const auto rig = calibrate_cameras(
        std::vector<std::string>{"left", "right"}, waved, {}, board, calibrate);
    if (!rig) {
      std::printf("%s\n", rig.error().message().c_str());
      return 1;
    }
    print_rig(*rig);
    std::printf("baseline %.4f squares\n",
                glm::distance(centre_in_world(rig->cameras[0]),
                              centre_in_world(rig->cameras[1])));
    print_cross_validation(*rig);
  }
  return 0;
}

namespace {

/// Lengths between neighbouring corners of the board, triangulated from what the cameras
/// saw, less the truth.
std::vector<double> edge_errors_m(const std::vector<Camera>& cameras,
                                  const std::vector<CameraDetections>& waved,
                                  const CharucoBoard& board) {
  std::map<std::pair<int, int>, std::vector<reconstruct::PointView>> sights;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    for (const FrameDetections& frame : waved[c].frames) {
      for (const PointDetection& point : frame.points) {
        sights[{frame.frame, point.point}].push_back({&cameras[c], point.pixel_px});
      }
    }
  }
  std::map<std::pair<int, int>, glm::dvec3> placed;
  for (const auto& [place, views] : sights) {
    if (const auto p = reconstruct::triangulate(views)) placed[place] = p->p_in_world;
  }
  std::vector<double> errors;
  const int across = board.columns - 1;
  for (const auto& [place, p] : placed) {
    const auto next = [&](int step) {
      const auto q = placed.find({place.first, place.second + step});
      if (q == placed.end()) return;
      errors.push_back(glm::distance(p, q->second) - board.square_size_m);
    };
    if ((place.second + 1) % across != 0) next(1);
    next(across);
  }
  return errors;
}

}  // namespace

int measure_webcams(const std::filesystem::path& folder) {
  const CharucoBoard board{.rows = 5,
                           .columns = 4,
                           .square_size_m = 0.054,
                           .marker_size_m = 0.0405,
                           .dictionary = "DICT_4X4_1000"};
  std::vector<capture::CameraInput> inputs;
  std::vector<std::string> names;
  for (int c = 0; c < 4; ++c) {
    capture::CameraInput input;
    names.push_back("cam_" + std::to_string(c));
    input.path = folder / "calibration" / "extrinsic" / (names.back() + ".mp4");
    input.camera = CameraId{c};
    inputs.push_back(input);
  }
  capture::DetectVideosOptions detection;
  detection.find_tags = false;
  detection.target = board;
  const auto waved = detect(inputs, detection);
  for (const bool clocks : {false, true}) {
    CalibrateOptions options;
    options.solve_offsets = clocks;
    options.find_warp = !clocks;
    options.most_offset_s = 1.0;
    options.cross_validate = true;
    const Stopwatch watch;
    const auto rig = calibrate_cameras(names, waved, {}, board, options);
    std::printf(
        "%s: %.1f s\n", clocks ? "clocks solved" : "as synchronised", watch.seconds());
    if (!rig) {
      std::printf("%s\n", rig.error().message().c_str());
      continue;
    }
    print_rig(*rig);
    if (rig->warp_m) {
      std::printf("warp %.2f %.2f %.2f mm\n",
                  1e3 * (*rig->warp_m)[0],
                  1e3 * (*rig->warp_m)[1],
                  1e3 * (*rig->warp_m)[2]);
    }
    const auto edges = edge_errors_m(rig->cameras, waved, board);
    double sum = 0.0;
    std::vector<double> size;
    for (const double e : edges) {
      sum += e * e;
      size.push_back(std::abs(e));
    }
    if (!edges.empty()) {
      std::printf("%zu edges: rms %.3f mm, median |error| %.3f mm\n",
                  edges.size(),
                  1e3 * std::sqrt(sum / static_cast<double>(edges.size())),
                  1e3 * median(size));
    }
    print_cross_validation(*rig);
    for (const SolvedClock& clock : rig->clocks) {
      std::printf(
          "  clock %+.2f +- %.2f ms\n", 1e3 * clock.offset_s, 1e3 * clock.offset_sigma_s);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(8, rig->outlier_frames.size());
         ++i) {
      const OutlierFrame& o = rig->outlier_frames[i];
      std::printf("  outlier: camera %zu frame %d, %d of %d corners, %.1f px off\n",
                  index(o.camera),
                  o.frame,
                  o.sightings,
                  o.of,
                  o.median_error_px);
    }
  }
  return 0;
}

}  // namespace marey::calib
