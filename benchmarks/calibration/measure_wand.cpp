// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Calibrates the cameras with a wand of tags. Then leaves each of its tags in turn out of
// the calibration, triangulates this tag, and measures its sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/calibration/calibration_cases.h"
#include "calib/rig/calibrate_wand.h"
#include "core/base/quantile.h"
#include "reconstruct/clusters/triangulate.h"

namespace marey::calib {
namespace {

struct Tracks {
  std::vector<std::string> names;
  std::vector<CameraDetections> cameras;
};

/// tag_corners.csv: topic, stamp, tag_id, hamming, four corners.
Tracks read_tracks(const std::filesystem::path& folder, int width_px, int height_px) {
  std::ifstream file(folder / "tag_corners.csv");
  if (!file) {
    std::fprintf(stderr, "%s cannot be read\n", (folder / "tag_corners.csv").c_str());
    std::exit(1);
  }
  struct Row {
    std::string topic;
    std::string stamp;
    TagDetection tag;
  };
  std::vector<Row> rows;
  std::set<std::string> topics;
  std::set<std::string> stamps;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    Row row;
    int id = 0;
    in >> row.topic >> row.stamp >> id >> row.tag.hamming;
    row.tag.id = TagId{id};
    for (glm::dvec2& corner : row.tag.corners_px) in >> corner.x >> corner.y;
    if (row.tag.hamming > 1) continue;
    topics.insert(row.topic);
    stamps.insert(row.stamp);
    rows.push_back(row);
  }
  Tracks tracks;
  std::map<std::string, std::size_t> camera_of;
  for (const std::string& topic : topics) {
    camera_of[topic] = tracks.names.size();
    const std::size_t start = topic.find('/', 1) + 1;
    tracks.names.push_back(topic.substr(start, topic.rfind('/') - start));
  }
  std::map<std::string, int> frame_of;
  for (const std::string& stamp : stamps) {
    frame_of.emplace(stamp, static_cast<int>(frame_of.size()));
  }
  tracks.cameras.resize(topics.size());
  for (std::size_t c = 0; c < tracks.cameras.size(); ++c) {
    CameraDetections& camera = tracks.cameras[c];
    camera.source = tracks.names[c];
    camera.camera = CameraId{static_cast<int>(c)};
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.frames.resize(stamps.size());
    for (std::size_t f = 0; f < stamps.size(); ++f) {
      camera.frames[f].frame = static_cast<int>(f);
    }
  }
  for (const Row& row : rows) {
    auto& frame = tracks.cameras[camera_of[row.topic]]
                      .frames[static_cast<std::size_t>(frame_of[row.stamp])];
    frame.tags.push_back(row.tag);
  }
  for (CameraDetections& camera : tracks.cameras) {
    for (FrameDetections& frame : camera.frames) {
      std::stable_sort(frame.tags.begin(), frame.tags.end(), [](auto& a, auto& b) {
        return a.id < b.id;
      });
      // Drops tags that occur twice in a frame: one of the two is wrong.
      std::vector<TagDetection> once;
      for (const TagDetection& tag : frame.tags) {
        const auto same = std::count_if(frame.tags.begin(),
                                        frame.tags.end(),
                                        [&](auto& t) { return t.id == tag.id; });
        if (same == 1) once.push_back(tag);
      }
      frame.tags = once;
    }
  }
  return tracks;
}

struct HeldOut {
  std::vector<double> side_errors_m;    ///< One per side, tag and instant.
  std::vector<double> reprojection_px;  ///< In a camera left out of the triangulation.
};

/// Triangulates a tag with the calibrated cameras. Adds the errors of its sides and the
/// reprojection errors in held-out cameras to `out`.
void measure_tag_error(const std::vector<Camera>& cameras,
                       const Tracks& tracks,
                       TagId id,
                       double size_m,
                       HeldOut& out) {
  for (std::size_t f = 0; f < tracks.cameras[0].frames.size(); ++f) {
    std::vector<std::pair<std::size_t, const TagDetection*>> views;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      for (const TagDetection& tag : tracks.cameras[c].frames[f].tags) {
        if (tag.id == id) views.emplace_back(c, &tag);
      }
    }
    if (views.size() < 2) continue;
    std::array<std::optional<glm::dvec3>, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<reconstruct::PointView> sights;
      for (const auto& [c, tag] : views)
        sights.push_back({&cameras[c], tag->corners_px[i]});
      const auto p = reconstruct::triangulate(sights);
      if (p) corners[i] = p->p_in_world;
      for (std::size_t held = 0; held < sights.size() && sights.size() > 2; ++held) {
        auto others = sights;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(held));
        const auto q = reconstruct::triangulate(others);
        if (!q) continue;
        const auto pixel = project(*sights[held].camera, q->p_in_world);
        if (pixel) {
          out.reprojection_px.push_back(glm::distance(*pixel, sights[held].pixel_px));
        }
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = corners[i];
      const auto& b = corners[(i + 1) % 4];
      if (a && b) out.side_errors_m.push_back(glm::distance(*a, *b) - size_m);
    }
  }
}

void print_held_out(const char* what, const HeldOut& held) {
  if (held.side_errors_m.empty()) return;
  std::vector<double> size;
  double sum = 0.0;
  for (const double e : held.side_errors_m) {
    size.push_back(std::abs(e));
    sum += e;
  }
  std::printf("%s: %zu sides, mean %+.3f mm, median |error| %.3f mm, p95 %.3f mm",
              what,
              size.size(),
              1e3 * sum / static_cast<double>(size.size()),
              1e3 * median(size),
              1e3 * quantile(size, 0.95));
  if (!held.reprojection_px.empty()) {
    std::printf("; held-out camera: %zu corners, median %.3f px, p95 %.3f px",
                held.reprojection_px.size(),
                median(held.reprojection_px),
                quantile(held.reprojection_px, 0.95));
  }
  std::printf("\n");
}

}  // namespace

int measure_wand(const std::filesystem::path& folder) {
  constexpr double kSize_m = 0.11986;
  const Tracks tracks = read_tracks(folder, 1920, 1200);
  const Wand wand{{{TagId{0}, kSize_m},
                   {TagId{1}, kSize_m},
                   {TagId{2}, kSize_m},
                   {TagId{3}, kSize_m}}};
  for (const bool use_scenery : {true}) {
    WandOptions options;
    options.use_scenery = use_scenery;
    const Stopwatch watch;
    const auto found = calibrate_wand(tracks.names, tracks.cameras, wand, options);
    std::printf("%.1f s\n", watch.seconds());
    if (!found) {
      std::printf("%s\n", found.error().message().c_str());
      return 1;
    }
    print_rig(found->rig);
    HeldOut seen;
    for (const Wand::Tag& tag : wand.tags) {
      measure_tag_error(found->rig.cameras, tracks, tag.id, tag.size_m, seen);
    }
    print_held_out("all tags took part", seen);
    HeldOut held;
    for (const Wand::Tag& tag : wand.tags) {
      Wand others = wand;
      std::erase_if(others.tags, [&](const Wand::Tag& t) { return t.id == tag.id; });
      const auto without = calibrate_wand(tracks.names, tracks.cameras, others, options);
      if (!without) {
        std::printf(
            "without %d: %s\n", number(tag.id), without.error().message().c_str());
        continue;
      }
      HeldOut one;
      measure_tag_error(without->rig.cameras, tracks, tag.id, tag.size_m, one);
      print_held_out(("without tag " + std::to_string(number(tag.id))).c_str(), one);
      measure_tag_error(without->rig.cameras, tracks, tag.id, tag.size_m, held);
    }
    print_held_out("held-out tags", held);
  }
  return 0;
}

int measure_room(const std::filesystem::path& folder) {
  const Tracks tracks = read_tracks(folder, 1280, 1024);
  Wand room;
  for (int id = 0; id <= 16; ++id) room.tags.push_back({TagId{id}, 0.15});
  WandOptions options;
  options.lens = LensModel::kFisheye;
  options.use_scenery = false;
  const Stopwatch watch;
  const auto found = calibrate_wand(tracks.names, tracks.cameras, room, options);
  std::printf("%.1f s\n", watch.seconds());
  if (!found) {
    std::printf("%s\n", found.error().message().c_str());
    return 1;
  }
  print_rig(found->rig);
  HeldOut seen;
  for (const Wand::Tag& tag : room.tags) {
    measure_tag_error(found->rig.cameras, tracks, tag.id, tag.size_m, seen);
  }
  print_held_out("all tags took part", seen);
  return 0;
}

}  // namespace marey::calib
