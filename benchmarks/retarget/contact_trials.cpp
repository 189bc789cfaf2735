// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/retarget/contact_trials.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/quantile.h"
#include "core/pose.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/markers/fit_markers.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/markers/force_plates.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/mot.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey {
namespace {

constexpr double kMinLoad_s = 0.05;

Result<reconstruct::MarkersFit> fit_trials(std::span<const MarkerTracks> trials) {
  std::vector<std::string> labels;
  for (const MarkerTracks& trial : trials) {
    for (const std::string& label : trial.labels) {
      if (std::find(labels.begin(), labels.end(), label) == labels.end()) {
        labels.push_back(label);
      }
    }
  }
  const auto names = reconstruct::name_markers(labels);
  std::vector<reconstruct::NamedMarker> named;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    named.push_back({labels[i], names.landmarks[i]});
  }
  return reconstruct::fit_markers({}, trials, named);
}

// Returns the intervals above the threshold that begin and end within the recording.
std::vector<LoadInterval> loaded(const PlateLoad& load) {
  std::vector<LoadInterval> out;
  bool bears = false;
  double since_s = 0.0;
  for (std::size_t k = 1; k < load.force_N.size(); ++k) {
    const double before = load.force_N[k - 1] - kLoaded_N;
    const double after = load.force_N[k] - kLoaded_N;
    if ((before > 0.0) == (after > 0.0)) continue;
    const double at_s = load.time_s[k - 1] +
                        before / (before - after) * (load.time_s[k] - load.time_s[k - 1]);
    if (after > 0.0) {
      since_s = at_s;
      bears = true;
    } else if (bears) {
      if (at_s - since_s >= kMinLoad_s) out.push_back({since_s, at_s});
      bears = false;
    }
  }
  return out;
}

Status read_table_edges(const std::filesystem::path& file,
                        const ContactSource& source,
                        double start_s,
                        ContactTrial& trial) {
  const auto table = recordings::read_mot(file);
  if (!table) return table.error();
  for (int side = 0; side < 2; ++side) {
    const auto column = table->find(source.columns[static_cast<std::size_t>(side)]);
    if (!column) return bad_input(file.string(), "the force column is missing", "");
    PlateLoad load;
    for (std::size_t row = 0; row < table->rows(); ++row) {
      load.time_s.push_back(table->time_s[row] - start_s);
      load.force_N.push_back(table->at(row, *column));
    }
    load.intervals = loaded(load);
    for (const LoadInterval& one : load.intervals) {
      for (const bool is_strike : {true, false}) {
        trial.edges.push_back({is_strike ? one.first_s : one.last_s, side, is_strike});
      }
    }
    trial.loads.push_back(std::move(load));
  }
  return Done{};
}

// Heel, ball and toe tip of a foot, in the world, seen from above.
std::array<glm::dvec2, 3> print_of(const ContactTrial& trial, int side, double time_s) {
  const auto& map = trial.map;
  const int frame =
      std::clamp(static_cast<int>(std::lround(time_s * trial.motion.rate.hz)),
                 0,
                 static_cast<int>(trial.motion.poses.size()) - 1);
  const auto joints = world_from_joints(
      trial.motion.skeleton, trial.motion.poses[static_cast<std::size_t>(frame)]);
  const retarget::FootMap& foot = map.feet[static_cast<std::size_t>(side)];
  const JointIndex ankle = map.leg(side).end;
  const glm::dquat turn = retarget::rotation_from_t_pose(map, joints, ankle);
  const glm::dvec3 at = joints[index(ankle)].translation;
  const glm::dvec3 ball = at + turn * foot.ball_from_ankle_in_t_pose;
  const glm::dvec3 heel = at + turn * foot.heel_from_ankle_in_t_pose;
  const glm::dvec3 tip = ball + turn * foot.tip_from_ball_in_t_pose;
  return {glm::dvec2(heel.x, heel.z), {ball.x, ball.z}, {tip.x, tip.z}};
}

bool is_inside(const std::array<glm::dvec3, 4>& corners, const glm::dvec2& p) {
  double sign = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % 4];
    const double cross = (b.x - a.x) * (p.y - a.z) - (b.z - a.z) * (p.x - a.x);
    if (cross * sign < 0.0) return false;
    if (cross != 0.0) sign = cross;
  }
  return true;
}

// Side of the foot whose middle is nearest to the centre of pressure at that time, if it
// is near.
std::optional<int> foot_on(const ContactTrial& trial,
                           const recordings::ForcePlates& plates,
                           const recordings::ForcePlate& plate,
                           double start_s,
                           double time_s) {
  constexpr double kNear_m = 0.2;
  const auto k = static_cast<std::size_t>(
      std::max(0.0, std::round((time_s + start_s - plates.start_s) * plates.rate.hz)));
  if (k >= plate.samples.size() || !plate.samples[k].centre_in_world) return std::nullopt;
  const glm::dvec3 centre = *plate.samples[k].centre_in_world;
  std::optional<int> nearest;
  double nearest_m = kNear_m;
  for (int side = 0; side < 2; ++side) {
    for (const glm::dvec2& p : print_of(trial, side, time_s)) {
      const double away_m = glm::distance(p, glm::dvec2(centre.x, centre.z));
      if (away_m < nearest_m) {
        nearest_m = away_m;
        nearest = side;
      }
    }
  }
  return nearest;
}

void add_plate_edges(const recordings::ForcePlates& plates,
                     const recordings::ForcePlate& plate,
                     double start_s,
                     ContactTrial& trial) {
  PlateLoad load;
  std::vector<double> forces;
  for (const auto& sample : plate.samples) forces.push_back(sample.force_in_world.y);
  if (forces.empty()) return;
  // The plate's own offset: its median force while nothing stands on it.
  constexpr double kUnloaded_N = 40.0;
  std::vector<double> idle;
  for (const double force : forces) {
    if (std::abs(force) < kUnloaded_N) idle.push_back(force);
  }
  const double offset_N = idle.empty() ? 0.0 : median(idle);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    load.time_s.push_back(plates.start_s - start_s +
                          static_cast<double>(k) / plates.rate.hz);
    load.force_N.push_back(forces[k] - offset_N);
  }
  load.intervals = loaded(load);
  for (const LoadInterval& one : load.intervals) {
    // The foot is known when the force is no longer small.
    constexpr double kInside_s = 0.04;
    for (const bool is_strike : {true, false}) {
      const double at_s = is_strike ? one.first_s : one.last_s;
      const double inside_s = is_strike ? at_s + kInside_s : at_s - kInside_s;
      const auto side = foot_on(trial, plates, plate, start_s, inside_s);
      if (!side) continue;
      const double flat_s = is_strike ? std::min(at_s + 0.12, 0.5 * (at_s + one.last_s))
                                      : std::max(at_s - 0.25, 0.5 * (at_s + one.first_s));
      const auto print = print_of(trial, *side, flat_s);
      const bool on_plate = std::all_of(print.begin(), print.end(), [&](const auto& p) {
        return is_inside(plate.corners_in_world, p);
      });
      if (on_plate) trial.edges.push_back({at_s, *side, is_strike});
    }
  }
  trial.loads.push_back(std::move(load));
}

void add_heel_markers(const MarkerTracks& tracks, ContactTrial& trial) {
  const auto names = reconstruct::name_markers(tracks.labels);
  for (std::size_t i = 0; i < tracks.markers(); ++i) {
    if (names.landmarks[i] == nullptr) continue;
    for (const std::size_t side : {0U, 1U}) {
      auto& heel = trial.heel_markers[side];
      if (names.landmarks[i]->name != (side == 0 ? "left_heel" : "right_heel")) continue;
      if (!heel.empty()) continue;
      for (std::size_t t = 0; t < tracks.frames(); ++t) {
        const auto& sample = tracks.at(t, i);
        heel.push_back(sample ? std::optional(sample->p_in_world) : std::nullopt);
      }
    }
  }
}

// A walk with the plates of its own C3D.
ContactSource walk_of(const char* name, const char* file, bool is_tuned = false) {
  return {name, "walk", is_tuned, file, {}, "", {}};
}

}  // namespace

std::vector<ContactSource> contact_sources() {
  const std::string rajagopal = "opensim-models/Rajagopal/ExpData/";
  const std::string hamner = "opensim-models/Hamner/";
  const std::string drop = "nimblephysics/osim/LaiArnoldSubject5/";
  return {
      {"Rajagopal run",
       "run",
       true,
       rajagopal + "motion_capture_run.trc",
       {rajagopal + "static_run.trc"},
       rajagopal + "grf_run.mot",
       {"L_ground_force_vy", "R_ground_force_vy"}},
      {"Hamner run",
       "run",
       false,
       hamner + "subject02_running.trc",
       {hamner + "subject02_static.trc"},
       hamner + "subject02_running_grf.mot",
       {"1_ground_force_vy", "ground_force_vy"}},
      {"DJ1",
       "jump",
       true,
       drop + "DJ1.trc",
       {drop + "DJ2.trc"},
       drop + "DJ1_forces.mot",
       {"L_ground_force_vy", "R_ground_force_vy"}},
      {"Rajagopal walk",
       "walk",
       true,
       rajagopal + "motion_capture_walk.trc",
       {rajagopal + "static_walk_1.trc"},
       rajagopal + "grf_walk.mot",
       {"ground_force_l_vy", "ground_force_r_vy"}},
      walk_of("walking2", "opensim-core/Tests/shared/walking2.c3d", true),
      walk_of("walking5", "opensim-core/Tests/shared/walking5.c3d", true),
      walk_of("Qualisys", "ezc3d/Qualisys.c3d", true),
      walk_of("Hybrid 1", "c3d_org_samples/sample_26/Walking_Hybrid_1_1.c3d", true),
      walk_of("Hybrid 2", "c3d_org_samples/sample_26/Walking_Hybrid_2.c3d", true),
      walk_of("pyCGM2",
              "c3d_org_samples/sample_00/Vicon Motion Systems/"
              "pyCGM2 lower limb CGM24 Walking01.c3d",
              true),
      walk_of("IST gait",
              "c3d_org_samples/sample_00/Innovative Sports Training/Gait with EMG.c3d",
              true),
      walk_of("gait-pig", "c3d_org_samples/sample_03/gait-pig.c3d", true),
      walk_of("BMClab gait", "bmclab/Gait.c3d"),
      walk_of("MAC Walk1",
              "c3d_org_samples/sample_00/Motion Analysis Corporation/Walk1.c3d",
              true),
      walk_of("Eb015pr", "c3d_org_samples/sample_01/Eb015pr.c3d"),
      walk_of("gait-pig-nz", "c3d_org_samples/sample_03/gait-pig-nz.c3d"),
      walk_of("Codamotion",
              "c3d_org_samples/sample_00/Codamotion/codamotion_gaitwands_19970212.c3d"),
  };
}

Result<ContactTrial> read_contact_trial(const std::filesystem::path& mocap,
                                        const ContactSource& source) {
  std::vector<MarkerTracks> trials;
  auto first = recordings::read_markers(mocap / source.markers);
  if (!first) return first.error();
  const recordings::FileAxes axes = first->axes;
  trials.push_back(std::move(first->tracks));
  for (const std::string& file : source.support) {
    auto other = recordings::read_markers(mocap / file);
    if (!other) return other.error();
    trials.push_back(std::move(other->tracks));
  }
  const auto fit = fit_trials(trials);
  if (!fit) return fit.error();
  auto solved = reconstruct::solve_markers(fit->body, trials[0]);
  if (!solved) return bad_input(source.markers, "no frame shows six markers", "");
  ContactTrial trial{source.name, source.kind, source.is_tuned, {}, {}, {}, {}, {}};
  trial.motion = std::move(solved->estimate.motion);
  auto map = retarget::map_body(trial.motion.skeleton);
  if (!map) return map.error();
  trial.map = *std::move(map);
  add_heel_markers(trials[0], trial);
  const double start_s = trials[0].start_s;
  if (!source.forces.empty()) {
    const Status read = read_table_edges(mocap / source.forces, source, start_s, trial);
    if (!read) return read.error();
  } else {
    const auto plates = recordings::read_force_plates(mocap / source.markers, axes);
    if (!plates) return plates.error();
    for (const auto& plate : plates->plates) {
      add_plate_edges(*plates, plate, start_s, trial);
    }
  }
  const double end_s =
      static_cast<double>(trial.motion.poses.size() - 1) / trial.motion.rate.hz;
  std::erase_if(trial.edges, [&](const PlateEdge& edge) {
    return edge.time_s < 0.0 || edge.time_s > end_s;
  });
  std::sort(trial.edges.begin(), trial.edges.end(), [](const auto& a, const auto& b) {
    return a.time_s < b.time_s;
  });
  return trial;
}

}  // namespace marey
