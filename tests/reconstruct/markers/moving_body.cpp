// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/reconstruct/markers/moving_body.h"

#include <array>
#include <cmath>
#include <string_view>

#include "core/human/average_proportions.h"
#include "reconstruct/posture/posture_derivatives.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

using reconstruct::PoseParameter;
using reconstruct::Posture;

constexpr std::array<std::string_view, 19> kSided{"asis",
                                                  "psis",
                                                  "acromion",
                                                  "lateral_epicondyle_humerus",
                                                  "medial_epicondyle_humerus",
                                                  "radial_styloid",
                                                  "ulnar_styloid",
                                                  "metacarpal_3_head",
                                                  "front_head",
                                                  "back_head",
                                                  "greater_trochanter",
                                                  "lateral_epicondyle_femur",
                                                  "medial_epicondyle_femur",
                                                  "tibial_tuberosity",
                                                  "lateral_malleolus",
                                                  "medial_malleolus",
                                                  "heel",
                                                  "metatarsal_1_head",
                                                  "metatarsal_5_head"};
constexpr std::array<std::string_view, 4> kMiddle{
    "c7", "t10", "suprasternal_notch", "xiphoid"};

/// Returns a different slow wave for every number.
double wave(double time_s, int which) {
  const double hz = 0.35 + 0.07 * (which % 5);
  return std::sin(2.0 * M_PI * hz * time_s + 1.7 * which);
}

Posture posture_at(double time_s) {
  Posture posture;
  const auto turn = [&](int which, const glm::dvec3& max_rad) {
    return rotation_from_vector({max_rad.x * wave(time_s, which),
                                 max_rad.y * wave(time_s, which + 31),
                                 max_rad.z * wave(time_s, which + 57)});
  };
  double* p = posture.block(PoseParameter::kHipsPosition);
  p[0] = 0.3 * wave(time_s, 1);
  p[1] = 0.95 + 0.05 * wave(time_s, 2);
  p[2] = 0.5 * wave(time_s, 3);
  const glm::dquat hips = turn(4, {0.15, 0.6, 0.15});
  const glm::dquat abdomen = hips * turn(5, {0.15, 0.15, 0.12});
  const glm::dquat thorax = abdomen * turn(6, {0.15, 0.15, 0.12});
  const glm::dquat neck = thorax * turn(7, {0.2, 0.3, 0.15});
  posture.set_rotation(PoseParameter::kHips, hips);
  posture.set_rotation(PoseParameter::kAbdomenEnd, abdomen);
  posture.set_rotation(PoseParameter::kThorax, thorax);
  posture.set_rotation(PoseParameter::kNeck, neck);
  posture.set_rotation(PoseParameter::kHead, neck * turn(8, {0.2, 0.3, 0.15}));
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const reconstruct::LimbParameters& s = reconstruct::kLimbParameters[limb];
    const int which = 10 + 4 * static_cast<int>(limb);
    const double side = limb % 2 == 0 ? 1.0 : -1.0;
    glm::dquat root = hips;
    glm::dquat usual(1.0, 0.0, 0.0, 0.0);
    if (limb < 2) {
      const PoseParameter shoulder =
          limb == 0 ? PoseParameter::kLeftShoulder : PoseParameter::kRightShoulder;
      root = thorax;
      posture.set_rotation(shoulder, thorax * turn(which + 2, {0.0, 0.1, 0.1}));
      usual = rotation_from_vector({0.0, 0.0, -0.9 * side});
    }
    const glm::dquat frame =
        root * usual *
        turn(which, limb < 2 ? glm::dvec3(0.3, 0.7, 0.5) : glm::dvec3(0.6, 0.2, 0.25));
    posture.set_rotation(s.frame, frame);
    *posture.block(s.flexion) = 0.7 + 0.55 * wave(time_s, which + 1);
    *posture.block(s.lower_twist) = (limb < 2 ? 0.5 : 0.05) * wave(time_s, which + 2);
    *posture.block(s.upper_twist) = (limb < 2 ? 0.1 : 0.05) * wave(time_s, which + 4);
    posture.set_rotation(s.extremity, frame * turn(which + 3, {0.25, 0.15, 0.15}));
  }
  return posture;
}

std::vector<const reconstruct::Landmark*> worn() {
  std::vector<const reconstruct::Landmark*> all;
  for (const std::string_view side : {"left_", "right_"}) {
    for (const std::string_view name : kSided) {
      all.push_back(reconstruct::find_landmark(std::string(side).append(name)));
    }
  }
  for (const std::string_view name : kMiddle) {
    all.push_back(reconstruct::find_landmark(name));
  }
  return all;
}

}  // namespace

MovingBody moving_body(const MovingBodyOptions& options) {
  constexpr double kStature_m = 1.75;
  Dice dice(options.seed);
  MovingBody moving;
  const Proportions average = average_proportions(kStature_m);
  reconstruct::Lengths lengths = reconstruct::lengths_of(average);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    // Pairs of limbs are consecutive and equal.
    const bool right =
        i > reconstruct::index(reconstruct::Length::kLeftShoulder) && i % 2 == 1;
    lengths[i] = right ? lengths[i - 1]
                       : lengths[i] * (1.0 + options.length_share * dice.noise(1.0));
  }
  const reconstruct::BodyConstants frame = reconstruct::body_constants(average);
  Body& body = moving.body;
  body.name = "moving";
  body.stature_m = kStature_m;
  body.proportions = reconstruct::to_proportions(lengths, frame, average);
  for (const reconstruct::Landmark* landmark : worn()) {
    glm::dvec3 p = kStature_m * landmark->p_in_segment_per_stature;
    HumanBone bone = landmark->segment;
    if (bone == HumanBone::kLeftToes || bone == HumanBone::kRightToes) {
      p += average[bone];
      bone = *parent(bone);
    }
    for (int i = 0; i < 3; ++i) p[i] += options.place_m * dice.noise(1.0);
    body.markers.push_back({std::string(landmark->name), bone, p, 0.001, 0.002, 0});
    moving.labels.push_back({std::string(landmark->name), landmark});
    moving.tracks.labels.emplace_back(landmark->name);
  }
  moving.tracks.rate = FrameRate{options.rate_hz};
  moving.motion.rate = moving.tracks.rate;
  moving.motion.first_frame = moving.tracks.first_frame;
  moving.motion.skeleton = make_humanoid(body.proportions);
  for (std::size_t f = 0; f < options.frames; ++f) {
    const Posture posture = posture_at(static_cast<double>(f) / options.rate_hz);
    reconstruct::UnfoldedPosture unfolded;
    unfolded.unfold(posture, lengths, frame);
    moving.motion.poses.push_back(
        reconstruct::to_pose(posture, moving.motion.skeleton, lengths, frame));
    for (const PlacedMarker& marker : body.markers) {
      const Eigen::Vector3d p = unfolded.point(
          marker.segment,
          {marker.p_in_segment.x, marker.p_in_segment.y, marker.p_in_segment.z});
      MarkerSample sample;
      for (int i = 0; i < 3; ++i) {
        sample.p_in_world[i] = p[i] + options.noise_m * dice.noise(1.0);
      }
      moving.tracks.samples.emplace_back(sample);
    }
  }
  return moving;
}

}  // namespace marey::testing
