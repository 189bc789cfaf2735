// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Counts calibrations that are wrong without a message, and good ones that are refused.
//
//   measure_rigs FIRST LAST [FAULT] [wand]
//                                       simulated rigs of these seeds, one line each
//   measure_rigs moved RESULTS SESSION [as-it-is]
//                                       cameras of a processed session, moved afterwards
//   measure_rigs nudge RESULTS CAMERA PX
//                                       turns a camera in all trials after the
//                                       calibration (its tables of detections), for marey
//                                       process
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

#include "calib/rig/find_moved_camera.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/detections_file.h"
#include "recordings/session/session.h"
#include "tests/app/check/judged_calibration.h"

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
                                RigFault::kWrongIds,
                                RigFault::kNudgedAfter,
                                RigFault::kFlipped,
                                RigFault::kFocalDrift,
                                RigFault::kRefocused,
                                RigFault::kRarelySeen,
                                RigFault::kSwappedTrial,
                                RigFault::kNudgedAfter};

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
  int noticed = 0;   ///< But not named.
  int harmless = 0;  ///< Nothing is reported, and no error exceeds three sigmas.
  int strays = 0;    ///< Nothing is reported; an error exceeds three sigmas, not 10 mm.
  int silent = 0;
  int refused = 0;
  int named = 0;
  int beyond = 0;  ///< Coordinates of centres beyond three of their sigmas.
  int coordinates = 0;
  int inside = 0;  ///< Coordinates within 1.96 of their sigmas.
  int turns = 0;
  int turns_inside = 0;
};

void add(const JudgedCalibration& judged, Count& count) {
  ++count.all;
  count.refused += judged.is_refused_though_good();
  if (judged.is_silently_wrong()) {
    ++count.silent;
  } else if (judged.names_fault) {
    ++count.named;
  } else if (judged.is_noticed) {
    ++count.noticed;
  } else if (judged.worst_sigmas <= 3.0) {
    ++count.harmless;
  } else {
    ++count.strays;
  }
  if (judged.exit_code != 0) return;
  count.beyond += judged.beyond_3_sigma;
  count.coordinates += judged.coordinates;
  count.inside += judged.inside_95;
  count.turns += judged.turns;
  count.turns_inside += judged.turns_inside;
}

double percent(int part, int whole) {
  return whole > 0 ? 100.0 * part / whole : 0.0;
}

void print_table(const std::map<std::string, Count>& counts) {
  std::printf("\n%-14s %5s %6s %8s %9s %7s %7s %8s  centres, turns inside 95 %%; > 3\n",
              "fault",
              "rigs",
              "named",
              "noticed",
              "harmless",
              "strays",
              "silent",
              "refused");
  for (const auto& [name, count] : counts) {
    std::printf("%-14s %5d %6d %8d %9d %7d %7d %8d  %.1f, %.1f of %d; %.1f %%\n",
                name.c_str(),
                count.all,
                count.named,
                count.noticed,
                count.harmless,
                count.strays,
                count.silent,
                count.refused,
                percent(count.inside, count.coordinates),
                percent(count.turns_inside, count.turns),
                count.coordinates,
                percent(count.beyond, count.coordinates));
  }
}

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

/// Changes the detections to those of a camera turned by `turn` in its own frame, from
/// `from_frame` on.
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
    std::printf("  %s: no camera is named [%.1f s]\n", label.c_str(), seconds);
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
      move->alternatives.size(),
      seconds);
}

int measure_moved(const std::filesystem::path& results,
                  const std::filesystem::path& session_path,
                  bool is_nudged) {
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
    for (std::size_t c = 0; is_nudged && c < rig->cameras.size(); ++c) {
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

/// Rewrites a camera's detections in all trials except calibration and floor.
int nudge(const std::filesystem::path& results, const std::string& name, double px) {
  const auto rig = marey::recordings::read_calibration(results / "calibration.toml");
  if (!rig) {
    std::fprintf(stderr, "%s\n", rig.error().message().c_str());
    return 1;
  }
  for (const marey::Camera& camera : rig->cameras) {
    if (camera.name != name) continue;
    const double turn_rad = px / camera.intrinsics.focal_px.x;
    for (const char* trial : {"static", "rom", "walk", "reach", "jump"}) {
      const auto file = results / trial / "detections" / (name + ".csv");
      if (!std::filesystem::exists(file)) continue;
      const std::string key = key_of(file);
      auto found = marey::recordings::read_detections(file, key);
      if (!found || !*found) return 1;
      turn_camera(camera,
                  marey::rotation_from_vector({0.8 * turn_rad, 0.6 * turn_rad, 0.0}),
                  0,
                  **found);
      const auto written = marey::recordings::write_detections(file, **found, key);
      if (!written) {
        std::fprintf(stderr, "%s\n", written.error().message().c_str());
        return 1;
      }
    }
    return 0;
  }
  std::fprintf(stderr, "%s has no camera %s\n", results.c_str(), name.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 4 && std::strcmp(argv[1], "moved") == 0) {
    return measure_moved(argv[2], argv[3], argc == 4);
  }
  if (argc == 5 && std::strcmp(argv[1], "nudge") == 0) {
    return nudge(argv[2], argv[3], std::strtod(argv[4], nullptr));
  }
  if (argc < 3) {
    std::fprintf(stderr, "usage: measure_rigs FIRST LAST [FAULT] [wand]\n");
    return 2;
  }
  std::map<std::string, Count> counts;
  const unsigned long last = std::strtoul(argv[2], nullptr, 10);
  for (unsigned long seed = std::strtoul(argv[1], nullptr, 10); seed <= last; ++seed) {
    marey::testing::SimulationOptions options;
    options.fault = fault_of(seed, argc > 3 ? argv[3] : nullptr);
    options.with_wand = argc > 4 && std::strcmp(argv[4], "wand") == 0;
    const auto start = std::chrono::steady_clock::now();
    const auto scene = marey::testing::simulate_calibration(seed, options);
    const JudgedCalibration judged = marey::testing::judge(scene);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    add(judged, counts[name_of(options.fault)]);
    std::printf(
        "%4lu %-13s %zu cameras %4zu frames %2.0f Hz%s: exit %d, worst %6.1f mm "
        "(%4.1f sigmas), rms %.2f px, body %.1f mm%s%s  [%.1f s]\n",
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
        1e3 * judged.body_off_m,
        judged.is_silently_wrong()        ? "  SILENT"
        : judged.is_refused_though_good() ? "  REFUSED"
                                          : "",
        judged.names_fault  ? "  named"
        : judged.is_noticed ? "  noticed"
                            : "",
        seconds);
    if (scene.focal_share != 0.0) {
      std::printf("       cam%zu: focal length by %+.2f %%\n",
                  *scene.camera,
                  100.0 * scene.focal_share);
    } else if (scene.fault == RigFault::kNudgedAfter) {
      std::printf("       cam%zu moved by %.1f px\n", *scene.camera, scene.amount_px);
    } else if (scene.fault == RigFault::kNudged) {
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
  print_table(counts);
  return 0;
}
