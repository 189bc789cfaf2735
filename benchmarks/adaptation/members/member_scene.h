// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/crowd.h"

namespace marey {

/// Constraints of the members of a crowd.
enum class MemberTask {
  kSupports,  ///< Both feet stand 2 cm from their place in the reference.
  /// In addition both wrists have targets: near for four of five members, beyond the
  /// reach of the arm for the others.
  kTargets,
  kFading,   ///< As kSupports; the right foot fades out in one member of five.
  kAllFade,  ///< As kSupports; the right foot fades out in every member.
};

/// Time at which the fading supports of kFading and kAllFade are half active. [s]
inline constexpr double kFadingTime_s = 0.06;

struct SceneMember {
  Character character;
  Pose reference;
  ConstraintSet constraints;
};

/// Makes bodies with 22 bones in a relaxed stance. `alike`: all have the same lengths and
/// masses; otherwise their stature is between 1.2 and 2.1 m. Prints the error and exits
/// if a body cannot be made.
[[nodiscard]] std::vector<SceneMember> make_scene(MemberTask task,
                                                  std::size_t count,
                                                  bool alike);

/// Makes the adapter of a member. Prints the error and exits if it cannot be made.
[[nodiscard]] retarget::Adapter make_member(const SceneMember& member,
                                            const retarget::AdaptOptions& options);

/// Makes a crowd of all members. Prints the error and exits if it cannot be made.
[[nodiscard]] retarget::Crowd make_members(const std::vector<SceneMember>& scene,
                                           const retarget::AdaptOptions& options,
                                           const retarget::CrowdOptions& how = {});

}  // namespace marey
