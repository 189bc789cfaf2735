// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/labelled_session.h"

#include <algorithm>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "reconstruct/labels/landmarks.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/motion_tables.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/worn_markers.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

constexpr std::array<Glued, 17> kOnEachSide{{{"FHD", "front_head"},
                                             {"BHD", "back_head"},
                                             {"SHO", "acromion"},
                                             {"UPA", "upper_arm"},
                                             {"ELB", "lateral_epicondyle_humerus"},
                                             {"FRM", "forearm"},
                                             {"WRA", "wrist_thumb_side"},
                                             {"WRB", "wrist_little_finger_side"},
                                             {"FIN", "metacarpal_2_head"},
                                             {"ASI", "asis"},
                                             {"PSI", "psis"},
                                             {"THI", "thigh"},
                                             {"KNE", "lateral_epicondyle_femur"},
                                             {"TIB", "shank"},
                                             {"ANK", "lateral_malleolus"},
                                             {"HEE", "heel"},
                                             {"TOE", "metatarsal_2_head"}}};
constexpr std::array<Glued, 4> kInTheMiddle{
    {{"C7", "c7"}, {"T10", "t10"}, {"CLAV", "suprasternal_notch"}, {"STRN", "xiphoid"}}};
constexpr std::array<Glued, 2> kWhileStanding{
    {{"KNM", "medial_epicondyle_femur"}, {"MED", "medial_malleolus"}}};

}  // namespace

std::vector<Glued> worn_on_each_side() {
  return {kOnEachSide.begin(), kOnEachSide.end()};
}

Body labelled_person() {
  Body body = tagged_person();
  Dice dice(41);
  const auto glue = [&](const std::string& label, const std::string& name) {
    const auto* landmark = reconstruct::find_landmark(name);
    if (landmark == nullptr) throw std::runtime_error(name + " is no landmark");
    const double stray_m =
        body.stature_m * std::min(0.4 * landmark->sigma_per_stature, 0.004);
    body.markers.push_back(
        {label,
         landmark->segment,
         body.stature_m * landmark->p_in_segment_per_stature + stray_m * dice.direction(),
         0.0,
         0.0,
         1});
  };
  for (const auto& [label, name] : kInTheMiddle) glue(label, name);
  for (const auto& [label, name] : kOnEachSide) {
    glue(std::string("L") + label, std::string("left_") + name);
    glue(std::string("R") + label, std::string("right_") + name);
  }
  for (const auto& [label, name] : kWhileStanding) {
    glue(std::string("L") + label, std::string("left_") + name);
    glue(std::string("R") + label, std::string("right_") + name);
  }
  return body;
}

Body without_markers_inside(Body body) {
  body.markers.resize(body.markers.size() - 2 * kWhileStanding.size());
  return body;
}

void write_tracks(const std::filesystem::path& path, MarkerTracks tracks) {
  recordings::MarkerFile file;
  // A C3D stores that Z is up. A TRC has no such field, and its default is Y up.
  if (path.extension() == ".trc") file.axes.up = recordings::FileAxis::kPlusY;
  file.tracks = std::move(tracks);
  const Status ok = recordings::write_markers(path, file);
  if (!ok) throw std::runtime_error(ok.error().message());
}

std::filesystem::path write_static(const ScratchFolder& folder, const std::string& name) {
  const Body person = labelled_person();
  const std::filesystem::path path = folder / name;
  write_tracks(path, film_markers(person, standing(person), {20, 100.0, 3e-4}));
  return path;
}

ProgramRun fit(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"fit", "--progress", "none"});
  return run_program(marey::testing::program(), arguments);
}

std::pair<double, double> joint_errors(const std::filesystem::path& csv,
                                       const Body& person,
                                       const Movement& movement) {
  const auto rows = recordings::read_joints_csv(csv);
  if (!rows) throw std::runtime_error(rows.error().message());
  const Skeleton skeleton = make_humanoid(person.proportions);
  std::vector<double> errors_m;
  for (const recordings::JointRow& row : *rows) {
    const auto bone = human_bone(row.joint);
    const auto& limbs = limb_joints();
    if (!bone || std::find(limbs.begin(), limbs.end(), *bone) == limbs.end()) continue;
    const auto truth = world_from_joints(skeleton, movement(row.time_s));
    errors_m.push_back(glm::distance(row.p_in_world, truth[index(*bone)].translation));
  }
  std::sort(errors_m.begin(), errors_m.end());
  return {errors_m[errors_m.size() / 2], errors_m[errors_m.size() * 95 / 100]};
}

}  // namespace marey::testing
