// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// make_example_inputs FOLDER: writes the input files of the examples and the true values
// of their output, computed without the functions that the examples call.
// FOLDER/EXAMPLE.truth has a key, the lowest and the highest right value per line.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/camera.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/labels/landmarks.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/bvh.h"
#include "recordings/session/detections_file.h"
#include "recordings/takes/take_file.h"
#include "tests/support/bodies/labelled_wearer.h"
#include "tests/support/simulation/simulated_calibration.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

void stop_on_error(const Status& status) {
  if (status) return;
  std::cerr << status.error().message() << "\n";
  std::exit(1);
}

class Truth {
 public:
  Truth(const fs::path& folder, const std::string& example)
      : file_(folder / (example + ".truth")) {
    file_.precision(9);
    file_ << std::fixed;
  }
  void add(const std::string& key, double value, double tolerance) {
    file_ << key << " " << value - tolerance << " " << value + tolerance << "\n";
  }

 private:
  std::ofstream file_;
};

/// A person with markers. Tolerances: hip joint centres follow from the spines of the
/// pelvis by a regression, with errors of some 10 mm per coordinate, and trials of
/// seconds improve them little; a leg and the width of the hips have two such errors.
void make_markers(const fs::path& folder) {
  const LabelledWearer one = wearer(1, [](const std::string& name) {
    const auto* landmark = reconstruct::find_landmark(name);
    return WornPlace{landmark->segment,
                     landmark->p_in_segment_per_stature,
                     landmark->sigma_per_stature};
  });
  for (std::size_t i = 0; i < one.trials.size(); ++i) {
    const auto path = folder / ("trial" + std::to_string(i) + ".c3d");
    stop_on_error(recordings::write_markers(path, {one.trials[i], {}, {}, {}}));
  }
  const Proportions& lengths = one.person.proportions;
  Truth truth(folder, "fit_markers");
  truth.add("stature_m", one.person.stature_m, 0.03);
  truth.add("leg_m", leg_length_m(lengths), 0.02);
  truth.add("hips_width_m",
            lengths[HumanBone::kLeftUpperLeg].x - lengths[HumanBone::kRightUpperLeg].x,
            0.02);
}

/// Place of the left shoulder of the T-pose, its hips over the world's origin.
glm::dvec3 shoulder_of(const Proportions& lengths) {
  glm::dvec3 sum(0.0);
  for (const HumanBone bone : {HumanBone::kHips,
                               HumanBone::kSpine,
                               HumanBone::kChest,
                               HumanBone::kUpperChest,
                               HumanBone::kLeftShoulder,
                               HumanBone::kLeftUpperArm}) {
    sum += lengths[bone];
  }
  return sum;
}

double upper_arm_m(const Proportions& lengths) {
  return glm::length(lengths[HumanBone::kLeftLowerArm]);
}
double forearm_m(const Proportions& lengths) {
  return glm::length(lengths[HumanBone::kLeftHand]);
}

/// An arm raised by 40 degrees, its elbow bent by 70, and one that waves up to 60
/// degrees. Numbers are printed with four digits.
void write_postures(const fs::path& folder) {
  const double degree = std::acos(-1.0) / 180.0;
  const Proportions child = average_proportions(1.10);
  const double across = upper_arm_m(child) + forearm_m(child) * std::cos(70.0 * degree);
  const glm::dvec3 wrist =
      shoulder_of(child) + glm::dvec3(across * std::cos(40.0 * degree),
                                      across * std::sin(40.0 * degree),
                                      forearm_m(child) * std::sin(70.0 * degree));
  Truth pose(folder, "retarget_pose");
  pose.add("wrist_x_m", wrist.x, 1e-4);
  pose.add("wrist_y_m", wrist.y, 1e-4);
  pose.add("wrist_z_m", wrist.z, 1e-4);
  pose.add("hips_height_m", child[HumanBone::kHips].y, 1e-4);
  pose.add("turned_deg", 0.0, 1e-4);

  const Proportions person = average_proportions(1.75);
  const double shoulder_m = shoulder_of(person).y;
  const double arm_m = upper_arm_m(person) + forearm_m(person);
  // Single precision on the wire.
  Truth wave(folder, "vmc_in");
  wave.add("low_m", shoulder_m, 2e-4);
  wave.add("high_m", shoulder_m + arm_m * std::sin(60.0 * degree), 2e-4);

  // Constraints are met within 1 mm, supports exactly.
  Truth reach(folder, "reach_target");
  const glm::dvec3 hand = shoulder_of(person) + glm::dvec3(arm_m, 0.0, 0.0);
  reach.add("distance_before_mm",
            1000.0 * glm::distance(hand, glm::dvec3(0.3, 0.6, 0.5)),
            0.01);
  reach.add("distance_after_mm", 0.0, 1.0);
  reach.add("foot_moved_mm", 0.0, 0.01);
  Truth crowd(folder, "crowd");
  crowd.add("members", 100.0, 0.0);
  crowd.add("worst_error_mm", 0.0, 1.0);
  crowd.add("same_as_alone", 100.0, 0.0);
}

/// Corner errors of 0.02 to 0.1 px: distances of cameras are right to some millimetres.
void make_detections(const fs::path& folder) {
  SimulationOptions options;
  options.seconds = 6.0;
  const SimulatedCalibration simulated = simulate_calibration(3, options);
  Truth truth(folder, "calibrate");
  for (std::size_t i = 0; i < simulated.truth.size(); ++i) {
    const Camera& camera = simulated.truth[i];
    const std::string file = camera.name + ".csv";
    for (const auto& [trial, list] :
         {std::pair("waved", &simulated.waved), std::pair("floor", &simulated.floor)}) {
      const fs::path to = folder / "detections" / trial;
      fs::create_directories(to);
      stop_on_error(recordings::write_detections(to / file, (*list)[i], "examples"));
    }
    truth.add(camera.name + "_focal_px",
              camera.intrinsics.focal_px.x,
              0.005 * camera.intrinsics.focal_px.x);
    truth.add(
        camera.name + "_distance_m",
        glm::distance(centre_in_world(simulated.truth.front()), centre_in_world(camera)),
        0.01);
  }
  std::ofstream(folder / "board.txt")
      << simulated.board.rows << "|" << simulated.board.columns << "|"
      << simulated.board.tag_size_m << "|" << simulated.board.gap_m << "\n";
}

/// Two cameras at 30 and 25 Hz; the second lost two frames after its tenth.
void make_take(const fs::path& folder) {
  recordings::Take take;
  take.trial = "walk";
  take.started = "2026-01-01T00:00:00Z";
  take.cameras = {{"left", "left.mkv", 640, 480, {30.0}, "left", "", {}},
                  {"right", "right.mkv", 640, 480, {25.0}, "right", "", {}}};
  fs::remove(folder / "take.sqlite");
  auto writer = recordings::TakeWriter::create(folder / "take.sqlite", take);
  stop_on_error(writer ? Status(Done{}) : Status(writer.error()));
  for (int frame = 0; frame < 90; ++frame) {
    writer->add(0, {.time = frame_time(frame, {30.0})});
  }
  for (int frame = 0; frame < 73; ++frame) {
    const int lost = frame >= 10 ? 2 : 0;
    writer->add(1,
                {.time = frame_time(frame + lost, {25.0}),
                 .dropped_before = frame == 10 ? 2 : 0});
  }
  stop_on_error(writer->finish());
  Truth truth(folder, "read_take");
  truth.add("left_frames", 90, 0.0);
  truth.add("left_dropped", 0, 0.0);
  truth.add("left_interval_ms", 1000.0 / 30.0, 0.001);
  truth.add("left_length_s", 89.0 / 30.0, 0.001);
  truth.add("right_frames", 73, 0.0);
  truth.add("right_dropped", 2, 0.0);
  truth.add("right_interval_ms", 40.0, 0.001);
  truth.add("right_length_s", 74.0 / 25.0, 0.001);
}

/// A walk, and a person who stands and raises the right arm to the front until 1 s.
void make_actions(const fs::path& folder) {
  const Motion walk = synthetic_walk(180, 60.0).motion;
  stop_on_error(recordings::write_bvh(folder / "walk.bvh", walk));
  const double degree = std::acos(-1.0) / 180.0;
  Motion reach{walk.skeleton, {60.0}, 0, {}};
  for (int frame = 0; frame <= 150; ++frame) {
    const double x = std::min(frame / 60.0, 1.0);
    const double share = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    Pose pose = rest_pose(walk.skeleton);
    const auto turn = [&](HumanBone bone, double angle_deg, const glm::dvec3& axis) {
      pose.parent_from_joint[index(bone)] = glm::angleAxis(angle_deg * degree, axis);
    };
    turn(HumanBone::kLeftUpperArm, -75.0, {0.0, 0.0, 1.0});
    const glm::dquat down = glm::angleAxis(75.0 * degree, glm::dvec3(0.0, 0.0, 1.0));
    const glm::dquat ahead = glm::angleAxis(80.0 * degree, glm::dvec3(0.0, 1.0, 0.0));
    pose.parent_from_joint[index(HumanBone::kRightUpperArm)] =
        glm::slerp(down, ahead, share);
    turn(HumanBone::kRightLowerArm, 40.0, {0.0, 1.0, 0.0});
    reach.poses.push_back(std::move(pose));
  }
  stop_on_error(recordings::write_bvh(folder / "reach.bvh", reach));
  Truth truth(folder, "play_actions");
  truth.add("far_reachable", 0.0, 0.0);
  truth.add("near_reachable", 1.0, 0.0);
  // The same bar as for reaches in docs/accuracy/engine.md.
  truth.add("palm_to_cup_mm", 0.0, 1.0);
}

}  // namespace
}  // namespace marey::testing

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_example_inputs FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  marey::testing::make_markers(folder);
  marey::testing::write_postures(folder);
  marey::testing::make_detections(folder);
  marey::testing::make_take(folder);
  marey::testing::make_actions(folder);
  return 0;
}
