// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"

namespace marey {

/// A solver configuration and its name.
struct Answerer {
  const char* name;
  retarget::Method method;
  retarget::BalanceMode balance;
};

inline constexpr std::array<Answerer, 3> kAnswerers{
    {{"strict", retarget::Method::kStrict, retarget::BalanceMode::kHorizontal},
     {"thesis", retarget::Method::kThesis, retarget::BalanceMode::kHorizontal},
     {"no balance", retarget::Method::kStrict, retarget::BalanceMode::kOff}}};

/// Error figures of many answers of one answerer.
struct Figures {
  std::vector<double> mean_deg;   ///< Mean over all segments, per question.
  std::vector<double> chest_deg;  ///< Largest of spine, chest, neck and head.
  std::vector<double> other_deg;  ///< Largest of all but the limb that reaches.
  std::vector<double> target_mm;
  std::vector<double> foot_mm;
  std::vector<double> com_mm;
  void add(const Figures& more);
};

using AllFigures = std::array<Figures, kAnswerers.size()>;

/// The task for one posture: targets of the moved joints, and the standing joints.
struct Question {
  const Pose* reference = nullptr;
  std::vector<JointIndex> standing;
  std::vector<JointIndex> moved;
  std::vector<glm::dvec3> targets_in_world;
};

/// Solves the task with every answerer, each with its own adapter. Adds the measured
/// errors to `figures`.
void answer_all(const Character& body, const Question& asked, AllFigures& figures);

}  // namespace marey
