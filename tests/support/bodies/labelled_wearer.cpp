// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/labelled_wearer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

using B = HumanBone;

struct Glued {
  const char* label;
  const char* landmark;
};

// Landmarks of the labels. This table is independent of the tables under test.
constexpr std::array kMiddle{Glued{"C7", "c7"},
                             Glued{"T10", "t10"},
                             Glued{"CLAV", "suprasternal_notch"},
                             Glued{"STRN", "xiphoid"}};
constexpr std::array kEachSide{Glued{"FHD", "front_head"},
                               Glued{"BHD", "back_head"},
                               Glued{"SHO", "acromion"},
                               Glued{"UPA", "upper_arm"},
                               Glued{"ELB", "lateral_epicondyle_humerus"},
                               Glued{"FRM", "forearm"},
                               Glued{"WRA", "wrist_thumb_side"},
                               Glued{"WRB", "wrist_little_finger_side"},
                               Glued{"FIN", "metacarpal_2_head"},
                               Glued{"ASI", "asis"},
                               Glued{"PSI", "psis"},
                               Glued{"THI", "thigh"},
                               Glued{"KNE", "lateral_epicondyle_femur"},
                               Glued{"KNM", "medial_epicondyle_femur"},
                               Glued{"TIB", "shank"},
                               Glued{"ANK", "lateral_malleolus"},
                               Glued{"MED", "medial_malleolus"},
                               Glued{"HEE", "heel"},
                               Glued{"TOE", "metatarsal_2_head"}};

Body draw_person(Dice& dice) {
  Body body;
  body.stature_m = dice.between(1.5, 1.95);
  body.proportions = average_proportions(body.stature_m);
  Proportions& p = body.proportions;
  const double sole_m =
      p[B::kHips].y + p[B::kLeftUpperLeg].y + p[B::kLeftLowerLeg].y + p[B::kLeftFoot].y;
  const double thigh = 1.0 + dice.noise(0.03);
  const double shank = 1.0 + dice.noise(0.03);
  const double trunk = 1.0 + dice.noise(0.03);
  const double arm = 1.0 + dice.noise(0.03);
  for (const B bone : {B::kLeftLowerLeg, B::kRightLowerLeg}) p[bone] *= thigh;
  for (const B bone : {B::kLeftFoot, B::kRightFoot}) p[bone] *= shank;
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck}) p[bone] *= trunk;
  for (const B bone :
       {B::kLeftLowerArm, B::kRightLowerArm, B::kLeftHand, B::kRightHand}) {
    p[bone] *= arm;
  }
  p[B::kHips].y =
      sole_m - p[B::kLeftUpperLeg].y - p[B::kLeftLowerLeg].y - p[B::kLeftFoot].y;
  // The stature that follows from these lengths.
  body.stature_m = p[B::kHips].y + p[B::kSpine].y + p[B::kChest].y + p[B::kUpperChest].y +
                   p[B::kNeck].y + p[B::kHead].y + p.head_top_in_head.y;
  return body;
}

void glue(LabelledWearer& wearer,
          const PlaceOf& place_of,
          Dice& dice,
          const std::string& label,
          const std::string& name) {
  const WornPlace place = place_of(name);
  const double stature_m = wearer.person.stature_m;
  // If a landmark may be anywhere on a segment, its marker is still near the table's
  // place.
  const double miss_m = stature_m * std::min(0.7 * place.sigma_per_stature, 0.012);
  glm::dvec3 p = stature_m * place.p_in_segment_per_stature;
  for (int axis = 0; axis < 3; ++axis) p[axis] += dice.noise(miss_m);
  wearer.person.markers.push_back({label, place.segment, p, 0.0, 0.0, 1});
  wearer.labels.push_back({label, name});
}

/// Returns the markers' tracks while the person moves, with the errors of laboratories:
/// noise, sliding markers and gaps.
MarkerTracks film(const Body& person, const Movement& movement, int frames, Dice& dice) {
  constexpr double kHz = 100.0;
  const double noise_m = dice.between(0.0003, 0.0015);
  const double slide_m = dice.between(0.002, 0.008);
  MarkerTracks tracks;
  tracks.rate.hz = kHz;
  std::vector<double> phase;
  std::vector<int> gap;
  for (const PlacedMarker& marker : person.markers) {
    tracks.labels.push_back(marker.label);
    phase.push_back(dice.between(0.0, 2.0 * std::numbers::pi));
    gap.push_back(static_cast<int>(dice.between(-1.0, 1.0) * frames));
  }
  const Skeleton skeleton = make_humanoid(person.proportions);
  for (int f = 0; f < frames; ++f) {
    const auto world = world_from_joints(skeleton, movement(f / kHz));
    for (std::size_t m = 0; m < person.markers.size(); ++m) {
      const PlacedMarker& marker = person.markers[m];
      glm::dvec3 p = marker.p_in_segment;
      const double turn = 2.0 * std::numbers::pi * f / (0.9 * kHz) + phase[m];
      p += slide_m * glm::dvec3(0.5 * std::sin(turn), std::cos(turn), 0.0);
      MarkerSample sample;
      sample.p_in_world = world[index(marker.segment)] * p;
      for (int axis = 0; axis < 3; ++axis) sample.p_in_world[axis] += dice.noise(noise_m);
      // Half of the markers are gone for a sixth of a second.
      const bool is_gone = gap[m] >= 0 && f >= gap[m] && f < gap[m] + 16;
      tracks.samples.emplace_back(is_gone ? std::nullopt : std::optional(sample));
    }
  }
  return tracks;
}

}  // namespace

LabelledWearer wearer(int seed, const PlaceOf& place_of) {
  Dice dice(1000 + static_cast<std::uint64_t>(seed));
  LabelledWearer out;
  out.person = draw_person(dice);
  for (const Glued& glued : kMiddle)
    glue(out, place_of, dice, glued.label, glued.landmark);
  for (const Glued& glued : kEachSide) {
    glue(out,
         place_of,
         dice,
         std::string("L") + glued.label,
         std::string("left_") + glued.landmark);
    glue(out,
         place_of,
         dice,
         std::string("R") + glued.label,
         std::string("right_") + glued.landmark);
  }
  out.movements = {
      standing(out.person), range_of_motion(out.person), walking(out.person)};
  out.trials = {film(out.person, out.movements[0], 60, dice),
                film(out.person, out.movements[1], 300, dice),
                film(out.person, out.movements[2], 150, dice)};
  return out;
}

void exchange(MarkerTracks& tracks, const std::string& a, const std::string& b) {
  const auto at_a = std::find(tracks.labels.begin(), tracks.labels.end(), a);
  const auto at_b = std::find(tracks.labels.begin(), tracks.labels.end(), b);
  if (at_a == tracks.labels.end() || at_b == tracks.labels.end()) {
    throw std::runtime_error(a + " or " + b + " is no label of the trial");
  }
  std::swap(*at_a, *at_b);
}

void rescale(MarkerTracks& tracks, double factor) {
  for (auto& sample : tracks.samples) {
    if (sample) sample->p_in_world *= factor;
  }
}

}  // namespace marey::testing
