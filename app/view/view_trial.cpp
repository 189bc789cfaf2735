// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/shell/inside_folder.h"
#include "app/shell/json_file.h"
#include "app/view/view_cameras.h"
#include "app/view/view_figure.h"
#include "core/base/extension.h"
#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/motion_tables.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

using JointPlaces = std::map<std::string, std::size_t, std::less<>>;

JointPlaces joint_places(const Skeleton& skeleton) {
  JointPlaces out;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    out.emplace(skeleton.joints[i].name, i);
  }
  return out;
}

/// Returns the uncertainty at a row's frame and joint, or nullptr if the motion lacks
/// them.
JointUncertainty* find(int frame,
                       const std::string& joint,
                       const JointPlaces& places,
                       int first_frame,
                       std::vector<std::vector<JointUncertainty>>& uncertainty) {
  const auto place = places.find(joint);
  const int i = frame - first_frame;
  if (place == places.end() || i < 0 || i >= static_cast<int>(uncertainty.size())) {
    return nullptr;
  }
  return &uncertainty[static_cast<std::size_t>(i)][place->second];
}

/// Reads the source and uncertainty of each joint and frame from the tables in the folder
/// of the motion. Sets the number of the first frame.
Status read_uncertainty(const fs::path& folder, ViewedFigure& figure, int& first_frame) {
  const auto segments = recordings::read_segments_csv(folder / "segments.csv");
  if (!segments) return segments.error();
  if (!segments->empty()) first_frame = segments->front().frame;
  const JointPlaces places = joint_places(figure.motion.skeleton);
  figure.uncertainty.assign(
      figure.motion.poses.size(),
      std::vector<JointUncertainty>(figure.motion.skeleton.joints.size()));
  for (const recordings::SegmentTableRow& row : *segments) {
    JointUncertainty* at =
        find(row.frame, row.segment, places, first_frame, figure.uncertainty);
    if (at != nullptr) at->source = row.source;
  }
  if (!is_there(folder / "joints.csv")) return Done{};
  const auto joints = recordings::read_joints_csv(folder / "joints.csv");
  if (!joints) return joints.error();
  for (const recordings::JointRow& row : *joints) {
    JointUncertainty* at =
        find(row.frame, row.joint, places, first_frame, figure.uncertainty);
    if (at != nullptr) at->sigma_m = row.sigma_m;
  }
  return Done{};
}

/// Returns the entry of this trial in the report, or null.
Json report_of(const fs::path& results, const std::string& trial) {
  const auto read = read_json(results / "report.json");
  if (!read) return {};
  const Json& report = *read;
  if (!report.is_object() || !report.contains("trials")) return {};
  const Json& trials = report["trials"];
  if (!trials.is_array()) return {};
  for (const Json& one : trials) {
    if (one.is_object() && one.value("name", Json()) == trial) return one;
  }
  return {};
}

void add_residual(const Json& report, ViewedRecording& out) {
  if (!report.is_object() || !report.contains("frame_rms_px")) return;
  live::PageGraph graph{"reprojection", "px", {}};
  for (const Json& value : report["frame_rms_px"]) {
    graph.values.push_back(value.is_number() ? value.get<double>() : 0.0);
  }
  graph.values.resize(static_cast<std::size_t>(out.frames), 0.0);
  out.graphs.push_back(std::move(graph));
}

/// Adds the graph of the joints' uncertainty over time.
void add_uncertainty_graph(const ViewedFigure& figure, ViewedRecording& out) {
  live::PageGraph graph{"joint uncertainty", "mm", {}};
  for (const auto& frame : figure.uncertainty) {
    double sum_mm2 = 0.0;
    for (const JointUncertainty& joint : frame)
      sum_mm2 += 1e6 * joint.sigma_m * joint.sigma_m;
    const double count = std::max<double>(1.0, static_cast<double>(frame.size()));
    graph.values.push_back(std::sqrt(sum_mm2 / count));
  }
  out.graphs.push_back(std::move(graph));
}

/// Returns the files of the retargeted avatars: the skinned file if there is one.
std::vector<fs::path> avatar_files(const fs::path& folder) {
  std::map<std::string, fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path& file = entry.path();
    const std::string kind = kind_by_extension(file);
    const std::string stem = file.stem().string();
    if (stem == "motion" || (kind != ".glb" && kind != ".bvh")) continue;
    if (kind == ".glb" || !found.contains(stem)) found[stem] = file;
  }
  std::vector<fs::path> out;
  for (const auto& [stem, file] : found) out.push_back(file);
  return out;
}

Status add_avatars(const fs::path& folder, ViewedRecording& out) {
  for (const fs::path& file : avatar_files(folder)) {
    auto avatar = figure_of_file(file, out.remarks);
    if (!avatar) return avatar.error();
    avatar->kind = live::PageSkeletonKind::kAvatar;
    out.figures.push_back(*std::move(avatar));
  }
  return Done{};
}

/// Adds the repaired markers if markers were the source. Tag corners are left out,
/// because they would hide the body.
Status add_points(const fs::path& results, const fs::path& folder, ViewedRecording& out) {
  const fs::path file = folder / "markers.c3d";
  if (!is_there(results / "fit.json") || !is_there(file)) return Done{};
  auto markers = recordings::read_markers(file);
  if (!markers) return markers.error();
  // Only if their frames match those of the motion.
  if (markers->tracks.frames() == static_cast<std::size_t>(out.frames)) {
    out.points = std::move(markers->tracks);
  }
  return Done{};
}

Result<ViewedFigure> performer(const fs::path& folder, ViewedRecording& out) {
  const fs::path skinned = folder / "motion.glb";
  const fs::path file = is_there(skinned) ? skinned : folder / "motion.bvh";
  std::vector<std::string> ours;  // Notes meant for other bodies; not shown.
  auto figure = figure_of_file(file, ours);
  if (!figure) return figure.error();
  figure->name = "performer";
  figure->kind = live::PageSkeletonKind::kPerformer;
  out.rate = figure->motion.rate;
  out.frames = static_cast<int>(figure->motion.poses.size());
  if (Status ok = read_uncertainty(folder, *figure, out.first_frame); !ok)
    return ok.error();
  return figure;
}

}  // namespace

std::vector<std::string> solved_trials(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (is_there(entry.path() / "segments.csv") && is_inside(entry.path(), folder)) {
      out.push_back(entry.path().filename().string());
    }
  }
  std::ranges::sort(out);
  return out;
}

Result<ViewedRecording> read_trial_view(const fs::path& trial_folder) {
  const fs::path folder = fs::weakly_canonical(trial_folder);
  const fs::path results = folder.parent_path();
  ViewedRecording out;
  out.title = folder.filename().string();
  if (const Status ok = check_links(folder, results); !ok) return ok.error();
  for (const char* name : {"report.json", "calibration.toml", "fit.json"}) {
    if (const Status ok = check_link(results / name, results); !ok) return ok.error();
  }
  auto figure = performer(folder, out);
  if (!figure) return figure.error();
  // A .glb has no frame numbers; the page uses those of segments.csv.
  figure->motion.first_frame = out.first_frame;
  out.tracks = tracks_of(*figure, out.first_frame);
  out.contacts = contact_spans(figure->motion, out.first_frame);
  add_residual(report_of(results, out.title), out);
  add_uncertainty_graph(*figure, out);
  out.figures.push_back(*std::move(figure));
  if (is_there(results / "calibration.toml")) {
    auto cameras = page_cameras(results / "calibration.toml");
    if (!cameras) return cameras.error();
    out.cameras = *std::move(cameras);
  }
  if (Status ok = add_points(results, folder, out); !ok) return ok.error();
  if (Status ok = add_avatars(folder, out); !ok) return ok.error();
  return out;
}

}  // namespace marey::app
