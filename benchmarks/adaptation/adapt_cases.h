// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// Number of points of a case: right wrist, left wrist, right ankle, left ankle.
inline constexpr std::size_t kCasePoints = 4;
/// Which of them is the planted foot.
inline constexpr std::size_t kPlantedPoint = 3;

/// A body in a guard stance, which is its skeleton's rest pose.
struct CaseBody {
  Character character;  ///< Its joints turn freely. The masses' sum is 1.
  std::array<JointIndex, kCasePoints> points{};
};

enum class CaseClass {
  kNear,         ///< Each target moved by 5 to 12 cm.
  kFar,          ///< Each by 30 cm or more, where another posture had it.
  kUnreachable,  ///< 1.9 to 2.6 m from the planted foot, apart from each other.
};

/// The targets of one posture.
struct AdaptCase {
  CaseClass kind = CaseClass::kNear;
  std::array<glm::dvec3, kCasePoints> targets_in_world{};
  glm::dvec3 com_target_in_world{0.0};
};

/// The four points, the last one planted.
[[nodiscard]] std::vector<PointGoal> case_goals(const CaseBody& body);

struct CaseSet {
  CaseBody body;
  std::vector<AdaptCase> cases;
};

/// Reads `folder`/model.txt and targets.txt (their README defines the format). Errors
/// (bad input): a file is missing, cut short or describes no human.
[[nodiscard]] Result<CaseSet> read_cases(const std::filesystem::path& folder);

/// Returns true when every target is within its limb's reach, to 5 mm, from the place of
/// hip or shoulder at rest. The limbs alone suffice for such a case. Precondition: each
/// point ends a limb of two bones.
[[nodiscard]] bool is_for_limbs_alone(const CaseBody& body, const AdaptCase& asked);

}  // namespace marey
