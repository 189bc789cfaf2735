// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"

#include "benchmarks/parts/result_table.h"
#include "core/base/result.h"

namespace marey {

/// Joints of the shown posture, by the forward kinematics of core.
[[nodiscard]] std::vector<RigidTransform> shown_joints(const engine::Engine& engine,
                                                       engine::CharacterId who);
/// Rotation of a joint from the T-pose.
[[nodiscard]] glm::dquat turned(const retarget::BodyMap& map,
                                const std::vector<RigidTransform>& joints,
                                JointIndex joint);
[[nodiscard]] engine::CharacterSpec spec_of(const Skeleton& body);
/// The body of a clip and four random ones.
[[nodiscard]] std::vector<Skeleton> bodies_for(const Skeleton& own);

/// Reads CMU 02_05 around the greatest speed of the right wrist, which becomes the event
/// "release". Errors: those of the file.
[[nodiscard]] Result<engine::ClipSource> read_throw(const std::filesystem::path& file);
/// Plays throws with one changed parameter and judges them from the shown postures.
[[nodiscard]] ResultTable throw_table(const engine::ClipSource& source);

}  // namespace marey
