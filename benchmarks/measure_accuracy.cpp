// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// How far results are from the truth of a rendered recording, in millimetres and degrees,
// and whether sigmas say so:
//
//   measure_accuracy OUT TRUTH TRIAL...
//
// OUT is what `marey process` wrote; TRUTH holds joints.csv, segments.csv and
// cameras.json in TRIAL/truth (see the recording's README). The truth's world is Z up;
// nothing else is aligned but each segment's axes (accuracy_parts.h).

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/accuracy_parts.h"
#include <glm/geometric.hpp>

#include "core/humanoid.h"
#include "core/quantile.h"
#include "recordings/calibration_file.h"
#include "recordings/motion_tables.h"
#include "tests/support/truth.h"

namespace {

namespace fs = std::filesystem;

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
  const marey::benchmarks::AccuracyCase a{out, truth, {argv + 3, argv + argc}};
  ok = measure_segments(a) && ok;
  ok = measure_honesty(a) && ok;
  return ok ? 0 : 1;
}
