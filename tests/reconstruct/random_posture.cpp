// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/reconstruct/random_posture.h"

#include <glm/geometric.hpp>

#include "core/human/average_proportions.h"

namespace marey::reconstruct {

using marey::testing::Dice;

Lengths random_lengths(Dice& dice) {
  Lengths lengths = lengths_of(average_proportions(1.75));
  for (double& length_m : lengths) length_m *= dice.between(0.9, 1.1);
  return lengths;
}

BodyConstants average_frame() {
  return body_constants(average_proportions(1.75));
}

BodyConstants askew_frame(Dice& dice) {
  BodyConstants frame = average_frame();
  for (HingeShape& hinge : frame.hinges) {
    hinge = {dice.between(-0.2, 0.2), dice.between(-0.2, 0.2), dice.between(0, 0.02)};
  }
  return frame;
}

Posture random_posture(Dice& dice) {
  Posture posture;
  for (int i = 0; i < 3; ++i) {
    posture.block(PoseParameter::kHipsPosition)[i] = dice.between(-2.0, 2.0);
  }
  const glm::dquat hips = dice.turn(3.0);
  posture.set_rotation(PoseParameter::kHips, hips);
  const glm::dquat chest = glm::normalize(hips * dice.turn(0.5));
  posture.set_rotation(PoseParameter::kAbdomenEnd, chest);
  const glm::dquat thorax = glm::normalize(chest * dice.turn(0.5));
  posture.set_rotation(PoseParameter::kThorax, thorax);
  const glm::dquat neck = glm::normalize(thorax * dice.turn(0.5));
  posture.set_rotation(PoseParameter::kNeck, neck);
  posture.set_rotation(PoseParameter::kHead, glm::normalize(neck * dice.turn(0.5)));
  for (const PoseParameter shoulder :
       {PoseParameter::kLeftShoulder, PoseParameter::kRightShoulder}) {
    const glm::dquat swing =
        rotation_from_vector({0.0, dice.between(-0.4, 0.4), dice.between(-0.4, 0.4)});
    posture.set_rotation(shoulder, glm::normalize(thorax * swing));
  }
  for (const LimbParameters& parameters : kLimbParameters) {
    posture.set_rotation(parameters.frame, dice.turn(3.0));
    posture.set_rotation(parameters.extremity, dice.turn(3.0));
    *posture.block(parameters.flexion) = dice.between(0.3, 2.3);
    *posture.block(parameters.upper_twist) = dice.between(-1.2, 1.2);
    *posture.block(parameters.lower_twist) = dice.between(-1.2, 1.2);
  }
  return posture;
}

}  // namespace marey::reconstruct
