// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Boards: rendered ones with known truth; photographs and webcams without truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/calibration/calibration_cases.h"
#include "calib/rig/calibrate_cameras.h"
#include "calib/rig/estimate_clocks.h"
#include "capture/search/detect_videos.h"
#include "core/base/degrees.h"
#include "core/base/quantile.h"
#include "reconstruct/clusters/triangulate.h"
#include "tests/support/truth/rendered_truth.h"

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

/// Returns the recording of a camera that starts `late` frames later, from frame `first`
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
        kDegreesPerRadian * glm::length(turn),
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
  options.cross_validate = !options.solve_offsets;
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
  print_cross_validation(*rig);
  for (std::size_t i = 0; i < std::min<std::size_t>(5, rig->outlier_frames.size()); ++i) {
    const OutlierFrame& o = rig->outlier_frames[i];
    std::printf("  outlier: camera %zu frame %d, %d of %d tags, %.1f px off\n",
                index(o.camera),
                o.frame,
                o.sightings,
                o.seen,
                o.median_error_px);
  }
  return 0;
}

std::vector<capture::CameraInput> inputs_of(const tests::RenderedTruth& truth) {
  std::vector<capture::CameraInput> inputs;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
    capture::CameraInput input;
    input.path = truth.video(c);
    input.camera = CameraId{static_cast<int>(c)};
    inputs.push_back(input);
  }
  return inputs;
}

/// Clocks of a motion trial, from the body's tags and the true cameras.
void measure_clocks(const std::filesystem::path& folder, const std::string& trial) {
  const tests::RenderedTruth truth = tests::load_rendered_truth(folder / trial);
  const auto detections = detect(inputs_of(truth), {});
  std::map<TagId, double> sizes_m;
  for (const auto& [place, corners] : truth.corners_in_world) {
    const double size_m = glm::distance(corners[0], corners[1]);
    sizes_m[TagId{place.second}] = 1e-3 * std::round(1e3 * size_m);
  }
  std::vector<Camera> cameras;
  for (const Camera& camera : truth.cameras) cameras.push_back(in_our_world(camera));
  const Stopwatch watch;
  const auto clocks = estimate_clocks(cameras, detections, sizes_m);
  std::printf("%s: %.1f s\n", trial.c_str(), watch.seconds());
  if (!clocks) {
    std::printf("no clocks\n");
    return;
  }
  for (std::size_t c = 0; c < clocks->size(); ++c) {
    const double true_s = truth.late_frames[c] / detections[c].rate.hz;
    std::printf("  camera %zu: offset %+.2f ms, off by %+.3f ms (+- %.3f)\n",
                c,
                1e3 * (*clocks)[c].offset_s,
                1e3 * ((*clocks)[c].offset_s - true_s),
                1e3 * (*clocks)[c].offset_sigma_s);
  }
}

}  // namespace

int measure_rendered(const std::filesystem::path& folder) {
  const tests::RenderedTruth truth = tests::load_rendered_truth(folder / "calib");
  const auto whole = detect(inputs_of(truth), {});
  const int synchronised = calibrate_and_compare(truth, whole, {0, 0, 0, 0});
  const int apart = calibrate_and_compare(truth, whole, {0, 3, 7, 5});
  for (const std::string trial : {"walk", "jump", "reach"}) measure_clocks(folder, trial);
  return std::max(synchronised, apart);
}

namespace {

/// xy.csv: sync_index, cam_id, frame_index, frame_time, object_id, keypoint_id, x, y...
/// of corners whose rows are counted from the board's top.
std::vector<CameraDetections> read_corners(const std::filesystem::path& path,
                                           const CharucoBoard& board) {
  std::ifstream file(path);
  if (!file) {
    std::fprintf(stderr, "%s cannot be read\n", path.c_str());
    std::exit(1);
  }
  std::vector<CameraDetections> cameras(4);
  std::map<int, int> frame_of;
  std::vector<std::array<double, 8>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    std::array<double, 8> row{};
    for (double& value : row) in >> value;
    rows.push_back(row);
    frame_of[static_cast<int>(row[0])] = 0;
  }
  int frames = 0;
  for (auto& [index, frame] : frame_of) frame = frames++;
  for (std::size_t c = 0; c < 4; ++c) {
    cameras[c].source = "cam_" + std::to_string(c);
    cameras[c].camera = CameraId{static_cast<int>(c)};
    cameras[c].width_px = 1280;
    cameras[c].height_px = 720;
    cameras[c].rate.hz = 6.0;
    for (int f = 0; f < frames; ++f) cameras[c].frames.push_back({f, {}, {}});
  }
  const int across = board.columns - 1;
  for (const auto& row : rows) {
    const int point = static_cast<int>(row[5]);
    PointDetection found;
    found.point = (board.rows - 2 - point / across) * across + point % across;
    found.pixel_px = {row[6], row[7]};
    cameras[static_cast<std::size_t>(row[1])]
        .frames[static_cast<std::size_t>(frame_of[static_cast<int>(row[0])])]
        .points.push_back(found);
  }
  return cameras;
}

/// Computes the errors of the lengths between neighbouring corners of the board,
/// triangulated from the detections of the cameras. Leaves out corners with an RMS
/// reprojection error above `max_px`, or without a triangulation.
std::vector<double> edge_errors_m(const std::vector<Camera>& cameras,
                                  const std::vector<CameraDetections>& waved,
                                  const CharucoBoard& board,
                                  double max_px,
                                  int& left_out) {
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
    const auto p = reconstruct::triangulate(views);
    if (!p || p->rms_px > max_px) {
      ++left_out;
      continue;
    }
    placed[place] = p->p_in_world;
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
  const std::vector<std::string> names{"cam_0", "cam_1", "cam_2", "cam_3"};
  const auto waved = read_corners(folder / "calibration" / "extrinsic" / "xy.csv", board);
  for (const bool clocks : {false, true}) {
    CalibrateOptions options;
    options.solve_offsets = clocks;
    options.find_warp = !clocks;
    options.max_offset_s = 1.0;
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
    for (const double max_px : {1e9, 2.0}) {
      int left_out = 0;
      const auto edges = edge_errors_m(rig->cameras, waved, board, max_px, left_out);
      double sum = 0.0;
      std::vector<double> size;
      for (const double e : edges) {
        sum += e * e;
        size.push_back(std::abs(e));
      }
      if (edges.empty()) continue;
      std::printf("%zu edges, %d corners left out: rms %.3f mm, median |error| %.3f mm\n",
                  edges.size(),
                  left_out,
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
                  o.seen,
                  o.median_error_px);
    }
  }
  return 0;
}

}  // namespace marey::calib
