// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Measures the errors of results against the truth of a rendered recording, in
// millimetres and degrees, and the agreement of the sigmas with these errors:
//
//   measure_accuracy OUT TRUTH TRIAL...
//
// OUT is the output folder of `marey process`. TRUTH holds joints.csv, segments.csv and
// cameras.json in TRIAL/truth (see the recording's README). The truth's world is Z up;
// only the axes of each segment are aligned (accuracy_parts.h).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/sessions/accuracy_parts.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/calibration_file.h"
#include "tests/support/truth/truth.h"

namespace {

namespace fs = std::filesystem;

using marey::HumanBone;
using marey::quantile;

bool measure_cameras(const fs::path& out, const fs::path& truth) {
  const auto calibration = marey::recordings::read_calibration(out / "calibration.toml");
  if (!calibration) {
    std::fprintf(stderr, "%s\n", calibration.error().message().c_str());
    return false;
  }
  const auto cameras = marey::testing::truth_cameras(truth / "cameras.json");
  if (!cameras) {
    std::fprintf(stderr, "%s: no cameras.json\n", truth.c_str());
    return false;
  }
  std::printf("cameras: reprojection RMS %.3f px\n", calibration->rms_px);
  std::printf("  %-6s %14s %12s %10s\n", "", "centre off mm", "focal off %", "sigma mm");
  for (std::size_t c = 0; c < calibration->cameras.size(); ++c) {
    const marey::Camera& camera = calibration->cameras[c];
    for (const marey::testing::TruthCamera& t : *cameras) {
      if (t.name != camera.name) continue;
      std::printf("  %-6s %14.1f %12.3f %10.1f\n",
                  camera.name.c_str(),
                  1e3 * glm::distance(t.centre_in_world, centre_in_world(camera)),
                  100.0 * (camera.intrinsics.focal_px.x / t.focal_px.x - 1.0),
                  1e3 * calibration->quality[c].centre_sigma_m);
    }
  }
  return true;
}

bool measure_trial(const fs::path& out, const fs::path& truth, const std::string& trial) {
  const auto rows = marey::recordings::read_joints_csv(out / trial / "joints.csv");
  if (!rows) {
    std::fprintf(stderr, "%s\n", rows.error().message().c_str());
    return false;
  }
  const auto places =
      marey::testing::truth_joints(truth / trial / "truth" / "joints.csv");
  if (!places) {
    std::fprintf(stderr, "%s: no joints.csv of %s\n", truth.c_str(), trial.c_str());
    return false;
  }
  std::map<std::string, std::vector<double>> by_joint;
  std::vector<double> all;
  for (const auto& row : *rows) {
    const auto bone = marey::human_bone(row.joint);
    if (!bone) continue;
    const auto place = places->find({row.frame, *bone});
    if (place == places->end()) continue;
    const double error_mm = 1e3 * glm::distance(row.p_in_world, place->second);
    by_joint[row.joint].push_back(error_mm);
    all.push_back(error_mm);
  }
  if (all.empty()) {
    std::fprintf(stderr, "%s: no frame in common with its truth\n", trial.c_str());
    return false;
  }
  std::printf("%s: %zu joint centres, off by median %.1f, p95 %.1f, max %.1f mm\n",
              trial.c_str(),
              all.size(),
              quantile(all, 0.5),
              quantile(all, 0.95),
              quantile(all, 1.0));
  for (const auto& [joint, errors] : by_joint) {
    std::printf("  %-14s median %5.1f  p95 %5.1f  max %5.1f mm\n",
                joint.c_str(),
                quantile(errors, 0.5),
                quantile(errors, 0.95),
                quantile(errors, 1.0));
  }
  return true;
}

using Places = std::map<std::pair<int, HumanBone>, glm::dvec3>;

/// Median distance of two joints over all frames that have both; nullopt if none has. [m]
std::optional<double> distance_m(const Places& places, HumanBone from, HumanBone to) {
  std::vector<double> lengths_m;
  for (const auto& [key, p_in_world] : places) {
    if (key.second != from) continue;
    const auto other = places.find({key.first, to});
    if (other == places.end()) continue;
    lengths_m.push_back(glm::distance(p_in_world, other->second));
  }
  if (lengths_m.empty()) return std::nullopt;
  return quantile(lengths_m, 0.5);
}

/// Measures the lengths of the limbs' segments, which are the same in all trials.
bool measure_lengths(const fs::path& out,
                     const fs::path& truth,
                     const std::string& trial) {
  const auto rows = marey::recordings::read_joints_csv(out / trial / "joints.csv");
  const auto places =
      marey::testing::truth_joints(truth / trial / "truth" / "joints.csv");
  if (!rows || !places) return false;
  Places found;
  for (const auto& row : *rows) {
    if (const auto bone = marey::human_bone(row.joint)) {
      found[{row.frame, *bone}] = row.p_in_world;
    }
  }
  double worst_percent = 0.0;
  std::printf("lengths of segments:\n");
  for (const marey::HumanLimb& limb : marey::human_limbs()) {
    for (const auto& [from, to] :
         {std::pair(limb.upper, limb.lower), std::pair(limb.lower, limb.end)}) {
      const auto length_m = distance_m(found, from, to);
      const auto true_m = distance_m(*places, from, to);
      if (!length_m || !true_m) return false;
      const double off_percent = 100.0 * (*length_m / *true_m - 1.0);
      worst_percent = std::max(worst_percent, std::abs(off_percent));
      std::printf("  %-14s %5.1f mm, true %5.1f, off by %+.1f %%\n",
                  std::string(name(from)).c_str(),
                  1e3 * *length_m,
                  1e3 * *true_m,
                  off_percent);
    }
  }
  std::printf("  worst off by %.1f %%\n", worst_percent);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: measure_accuracy OUT TRUTH TRIAL...\n");
    return 2;
  }
  const fs::path out = argv[1];
  const fs::path truth = argv[2];
  bool ok = measure_cameras(out, truth / argv[3] / "truth");
  for (int i = 3; i < argc; ++i) ok = measure_trial(out, truth, argv[i]) && ok;
  ok = measure_lengths(out, truth, argv[3]) && ok;
  const marey::benchmarks::AccuracyCase a{out, truth, {argv + 3, argv + argc}};
  ok = measure_segments(a) && ok;
  ok = measure_honesty(a) && ok;
  return ok ? 0 : 1;
}
