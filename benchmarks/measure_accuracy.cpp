// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// How far results are from the truth of a rendered recording, in millimetres:
//
//   measure_accuracy OUT TRUTH TRIAL...
//
// OUT is what `marey process` wrote; TRUTH holds TRIAL/truth/joints.csv and
// TRIAL/truth/cameras.json (see the recording's README). The truth's world is Z up;
// nothing else is aligned.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "recordings/calibration_file.h"
#include "recordings/motion_tables.h"

namespace {

namespace fs = std::filesystem;

struct TruthName {
  const char* truth;
  const char* ours;
};

// The twelve limb joint centres.
constexpr TruthName kJoints[] = {{"hip_l", "leftUpperLeg"},
                                 {"hip_r", "rightUpperLeg"},
                                 {"knee_l", "leftLowerLeg"},
                                 {"knee_r", "rightLowerLeg"},
                                 {"ankle_l", "leftFoot"},
                                 {"ankle_r", "rightFoot"},
                                 {"shoulder_l", "leftUpperArm"},
                                 {"shoulder_r", "rightUpperArm"},
                                 {"elbow_l", "leftLowerArm"},
                                 {"elbow_r", "rightLowerArm"},
                                 {"wrist_l", "leftHand"},
                                 {"wrist_r", "rightHand"}};

glm::dvec3 y_up(double x, double y, double z) {
  return {x, z, -y};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

using Places = std::map<std::pair<int, std::string>, glm::dvec3>;

Places read_truth(const fs::path& file) {
  Places places;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    int frame = 0;
    double time_s = 0.0;
    std::string joint;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    row >> frame >> time_s >> joint >> x >> y >> z;
    places[{frame, joint}] = y_up(x, y, z);
  }
  return places;
}

bool measure_cameras(const fs::path& out, const fs::path& truth) {
  const auto calibration = marey::recordings::read_calibration(out / "calibration.toml");
  if (!calibration) {
    std::fprintf(stderr, "%s\n", calibration.error().message().c_str());
    return false;
  }
  std::ifstream in(truth / "cameras.json");
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded()) {
    std::fprintf(stderr, "%s: no cameras.json\n", truth.c_str());
    return false;
  }
  std::printf("cameras: reprojection RMS %.3f px\n", calibration->rms_px);
  std::printf("  %-6s %14s %12s %10s\n", "", "centre off mm", "focal off %", "sigma mm");
  for (std::size_t c = 0; c < calibration->cameras.size(); ++c) {
    const marey::Camera& camera = calibration->cameras[c];
    for (const auto& t : json["cameras"]) {
      if (t["name"] != camera.name) continue;
      const auto& pose = t["world_from_camera"];
      const glm::dvec3 centre = y_up(pose[0][3], pose[1][3], pose[2][3]);
      const double focal_px = t["K"][0][0];
      std::printf("  %-6s %14.1f %12.3f %10.1f\n",
                  camera.name.c_str(),
                  1e3 * glm::distance(centre, centre_in_world(camera)),
                  100.0 * (camera.intrinsics.focal_px.x / focal_px - 1.0),
                  1e3 * calibration->records[c].centre_sigma_m);
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
  const Places places = read_truth(truth / trial / "truth" / "joints.csv");
  std::map<std::string, std::vector<double>> by_joint;
  std::vector<double> all;
  std::vector<double> in_sigmas;
  for (const auto& row : *rows) {
    for (const TruthName& name : kJoints) {
      const auto place = places.find({row.frame, name.truth});
      if (row.joint != name.ours || place == places.end()) continue;
      const double error_mm = 1e3 * glm::distance(row.p_in_world, place->second);
      by_joint[name.ours].push_back(error_mm);
      all.push_back(error_mm);
      in_sigmas.push_back(error_mm / (1e3 * std::sqrt(3.0) * row.sigma_m));
    }
  }
  std::printf(
      "%s: %zu joint centres, off by median %.1f, p95 %.1f, max %.1f mm; "
      "median error / sigma %.2f\n",
      trial.c_str(),
      all.size(),
      quantile(all, 0.5),
      quantile(all, 0.95),
      quantile(all, 1.0),
      quantile(in_sigmas, 0.5));
  for (const auto& [joint, errors] : by_joint) {
    std::printf("  %-14s median %5.1f  p95 %5.1f  max %5.1f mm\n",
                joint.c_str(),
                quantile(errors, 0.5),
                quantile(errors, 0.95),
                quantile(errors, 1.0));
  }
  return !all.empty();
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
  return ok ? 0 : 1;
}
