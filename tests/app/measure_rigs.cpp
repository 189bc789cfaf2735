// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How often is a calibration silently wrong, how often refused although it is good?
//
//   measure_rigs FIRST LAST [FAULT]     simulated rigs of these seeds, one line each
//   measure_rigs moved RESULTS SESSION  cameras of a processed session, moved afterwards
//
// FAULT is a word of name_of(RigFault); otherwise every second seed has none and the
// others take turns. Ranges add up over several runs.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/find_moved_camera.h"
#include "recordings/calibration_file.h"
#include "recordings/detections_file.h"
#include "recordings/session.h"
#include "tests/app/judged_calibration.h"

namespace {

using marey::testing::JudgedCalibration;
using marey::testing::RigFault;

constexpr RigFault kFaults[] = {RigFault::kNudged,
                                RigFault::kRollingShutter,
                                RigFault::kLate,
                                RigFault::kStrayTags,
                                RigFault::kNudged,
                                RigFault::kWrongRate,
                                RigFault::kRollingShutter,
                                RigFault::kWrongSize,
                                RigFault::kMirrored,
                                RigFault::kSwappedFloor,
                                RigFault::kWrongIds};

RigFault fault_of(unsigned long seed, const char* word) {
  if (word != nullptr) {
    if (std::strcmp(word, "none") == 0) return RigFault::kNone;
    for (const RigFault fault : kFaults) {
      if (std::strcmp(word, marey::testing::name_of(fault)) == 0) return fault;
    }
    std::fprintf(stderr, "no fault is called %s\n", word);
    std::exit(2);
  }
  if (seed % 2 == 0) return RigFault::kNone;
  return kFaults[seed / 2 % std::size(kFaults)];
}

struct Count {
  int all = 0;
  int silent = 0;
  int refused = 0;
  int named = 0;
  int beyond = 0;  ///< Coordinates of centres beyond three of their sigmas.
  int coordinates = 0;
};

/// The key with which a table of detections was written.
std::string key_of(const std::filesystem::path& file) {
  constexpr std::size_t kVersionWords = 4;  // "# marey detections 4"
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  for (std::size_t i = 0; i < kVersionWords; ++i) {
    line.erase(0, std::min(line.size(), line.find(' ')) + 1);
  }
  return line;
}

/// What the camera would have seen had it been turned by `turn` in its own frame.
void turn_camera(const marey::Camera& camera,
                 const glm::dquat& turn,
                 int from_frame,
                 marey::CameraDetections& detections) {
  for (marey::FrameDetections& frame : detections.frames) {
    if (frame.frame < from_frame) continue;
    for (marey::TagDetection& tag : frame.tags) {
      for (glm::dvec2& corner : tag.corners_px) {
        const auto ray = unproject(camera.intrinsics, corner);
        if (!ray) continue;
        const glm::dvec3 turned = turn * glm::dvec3(*ray, 1.0);
        if (!project(camera.intrinsics, &turned.x, &corner.x)) continue;
      }
    }
  }
}

void print_move(const std::vector<marey::Camera>& cameras,
                const std::vector<marey::CameraDetections>& detections,
                const std::map<marey::TagId, double>& sizes_m,
                const std::string& label) {
  const auto start = std::chrono::steady_clock::now();
  const auto move = marey::calib::find_moved_camera(cameras, detections, sizes_m);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!move) {
    std::printf("  %s: nothing tells [%.1f s]\n", label.c_str(), seconds);
    return;
  }
  std::printf(
      "  %s: %s from %d: %.2f px, %.3f degrees, %.1f mm, gain %.0f, %zu others "
      "[%.1f s]\n",
      label.c_str(),
      cameras[index(move->camera)].name.c_str(),
      move->from_frame.value_or(-1),
      move->moved_px,
      57.29578 * move->turn_rad,
      1e3 * move->shift_m,
      move->gain,
      move->instead.size(),
      seconds);
}

int measure_moved(const std::filesystem::path& results,
                  const std::filesystem::path& session_path) {
  const auto session = marey::recordings::read_session(session_path, {});
  const auto rig = marey::recordings::read_calibration(results / "calibration.toml");
  if (!session || !rig) {
    std::fprintf(
        stderr, "%s\n", (session ? rig.error() : session.error()).message().c_str());
    return 1;
  }
  std::map<marey::TagId, double> sizes_m;
  for (const auto& tag : session->tags) sizes_m[tag.id] = tag.size_m;
  for (const char* trial : {"static", "rom", "walk", "reach", "jump"}) {
    std::vector<marey::CameraDetections> detections;
    for (const marey::Camera& camera : rig->cameras) {
      const auto file = results / trial / "detections" / (camera.name + ".csv");
      auto found = marey::recordings::read_detections(file, key_of(file));
      if (!found || !*found) break;
      for (auto& frame : (**found).frames) {
        for (auto& tag : frame.tags) {
          tag.corners_px = unshrunk(tag.corners_px, camera.tag_shrinkage);
        }
      }
      detections.push_back(std::move(**found));
    }
    if (detections.size() != rig->cameras.size()) continue;
    std::printf("%s\n", trial);
    print_move(rig->cameras, detections, sizes_m, "as it is");
    for (std::size_t c = 0; c < rig->cameras.size(); ++c) {
      for (const double px : {1.0, 3.8}) {
        for (const int from : {0, static_cast<int>(detections[c].frames.size() / 2)}) {
          auto moved = detections;
          const double turn_rad = px / rig->cameras[c].intrinsics.focal_px.x;
          turn_camera(rig->cameras[c],
                      marey::rotation_from_vector({0.8 * turn_rad, 0.6 * turn_rad, 0.0}),
                      from,
                      moved[c]);
          print_move(rig->cameras,
                     moved,
                     sizes_m,
                     rig->cameras[c].name + " by " + std::to_string(px) + " px from " +
                         std::to_string(from));
        }
      }
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "moved") == 0) {
    return measure_moved(argv[2], argv[3]);
  }
  if (argc < 3) {
    std::fprintf(stderr, "measure_rigs FIRST LAST [FAULT]\n");
    return 2;
  }
  std::map<std::string, Count> counts;
  const unsigned long last = std::strtoul(argv[2], nullptr, 10);
  for (unsigned long seed = std::strtoul(argv[1], nullptr, 10); seed <= last; ++seed) {
    marey::testing::SimulationOptions options;
    options.fault = fault_of(seed, argc > 3 ? argv[3] : nullptr);
    const auto start = std::chrono::steady_clock::now();
    const auto scene = marey::testing::simulate_calibration(seed, options);
    const JudgedCalibration judged = marey::testing::judge(scene);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Count& count = counts[name_of(options.fault)];
    ++count.all;
    count.silent += judged.is_silently_wrong();
    count.refused += judged.is_refused_though_good();
    count.named += judged.names_fault;
    count.beyond += judged.beyond_3_sigma;
    count.coordinates += judged.coordinates;
    std::printf(
        "%4lu %-13s %zu cameras %4zu frames %2.0f Hz%s: exit %d, worst %6.1f mm "
        "(%4.1f sigmas), rms %.2f px%s%s  [%.1f s]\n",
        seed,
        name_of(options.fault),
        scene.truth.size(),
        scene.waved[0].frames.size(),
        scene.rate_hz,
        scene.floor.empty() ? "" : " floor",
        judged.exit_code,
        1e3 * judged.worst_m,
        judged.worst_sigmas,
        judged.rms_px,
        judged.is_silently_wrong()        ? "  SILENT"
        : judged.is_refused_though_good() ? "  REFUSED"
                                          : "",
        judged.names_fault ? "  named" : "",
        seconds);
    if (scene.fault == RigFault::kNudged) {
      std::printf("       cam%zu moved by %.1f px from frame %d on\n",
                  *scene.camera,
                  scene.amount_px,
                  scene.from_frame);
    } else if (scene.fault == RigFault::kRollingShutter) {
      std::printf("       %.1f ms from first row to last\n", 1e3 * scene.picture_s);
    }
    std::printf("       %s\n", judged.figures.c_str());
    for (const std::string& word : judged.words) std::printf("       %s\n", word.c_str());
    std::fflush(stdout);
  }
  std::printf("\n%-14s %6s %6s %8s %6s  centres beyond 3 sigmas\n",
              "fault",
              "rigs",
              "silent",
              "refused",
              "named");
  for (const auto& [name, count] : counts) {
    std::printf("%-14s %6d %6d %8d %6d  %.1f %%\n",
                name.c_str(),
                count.all,
                count.silent,
                count.refused,
                count.named,
                count.coordinates > 0 ? 100.0 * count.beyond / count.coordinates : 0.0);
  }
  return 0;
}
