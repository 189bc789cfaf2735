// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Calibrates cameras from the detections of an AprilGrid that was waved through the
// volume and then lay on the floor.
//
//     calibrate ROWS COLUMNS TAG_SIZE_M GAP_M FOLDER
//
// FOLDER/waved/CAMERA.csv and FOLDER/floor/CAMERA.csv are detections as `marey track`
// stores them. Prints the distance of each camera from the first one.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/rig/calibrate_cameras.h"
#include "core/board.h"
#include "recordings/session/detections_file.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

/// Reads detections whatever their key, the rest of the first line after the version.
Result<CameraDetections> read_camera(const std::filesystem::path& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string line = text.substr(0, text.find('\n'));
  std::size_t key = 0;
  for (int word = 0; word < 4; ++word) key = line.find(' ', key) + 1;
  auto found = recordings::parse_detections(text, line.substr(key), path.string());
  if (!found) return found.error();
  if (!*found) return bad_input(path.string(), "is not readable", "run marey track");
  return **std::move(found);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return fail(bad_input("", "arguments are missing", "see the source"));
  AprilGrid board;
  board.rows = std::atoi(argv[1]);
  board.columns = std::atoi(argv[2]);
  board.tag_size_m = std::atof(argv[3]);
  board.gap_m = std::atof(argv[4]);
  const std::filesystem::path folder = argv[5];

  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "waved")) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;
  for (const std::string& name : names) {
    for (auto* list : {&waved, &floor}) {
      const auto trial = folder / (list == &waved ? "waved" : "floor");
      auto found = read_camera(trial / (name + ".csv"));
      if (!found) return fail(found.error());
      list->push_back(*std::move(found));
    }
  }

  const auto rig = calib::calibrate_cameras(names, waved, floor, board);
  if (!rig) return fail(rig.error());
  std::printf("median_error_px %.3f\n", rig->median_px);
  const glm::dvec3 first = centre_in_world(rig->cameras.front());
  for (const Camera& camera : rig->cameras) {
    std::printf("%s_focal_px %.2f\n", camera.name.c_str(), camera.intrinsics.focal_px.x);
    std::printf("%s_distance_m %.5f\n",
                camera.name.c_str(),
                glm::distance(first, centre_in_world(camera)));
  }
  return 0;
}
