// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "core/motion.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {

/// A folder with a walk in it, for `marey adapt`: walk.bvh, 90 frames at 30 Hz, of which
/// every contact is known.
class AdaptScene {
 public:
  AdaptScene();

  [[nodiscard]] const SyntheticWalk& walk() const { return walk_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  /// Writes a text into the folder; returns its path.
  std::string file(const std::string& name, const std::string& text) const;
  /// A set with these elements.
  std::string constraints(const std::string& elements) const;
  /// A character.toml of "Ann", with more behind her name.
  [[nodiscard]] std::string character(const std::string& more) const;
  /// `marey adapt walk.bvh --out out.bvh --json` and more, which may name another out.
  [[nodiscard]] ProgramRun adapt(const std::vector<std::string>& more) const;
  /// The motion of a file in the folder; the test fails when there is none.
  [[nodiscard]] Motion motion(const std::string& name = "out.bvh") const;

 private:
  ScratchFolder folder_;
  SyntheticWalk walk_;
};

/// A Distance constraint of the left hand, fully active from 0.99 s to 1.41 s.
[[nodiscard]] std::string hand_at(const glm::dvec3& p_in_world,
                                  const std::string& more = "",
                                  const std::string& segment = "leftHand");

/// Returns the entry of one constraint or support in the output of `--json`. The test
/// fails when there is none.
[[nodiscard]] const nlohmann::json& of_id(const nlohmann::json& all,
                                          const std::string& id);

/// World place of a joint in one pose.
[[nodiscard]] glm::dvec3 place_of(const Motion& motion, int frame, HumanBone bone);

}  // namespace marey::testing
