// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/motion.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {

/// A folder for `marey retarget`: walk.bvh, 120 frames at 60 Hz; small.glb, tall.glb,
/// mannequins of 0.9 and 2.4 m; plain.bvh, a body without a mesh; arms.bvh, without hands
/// to put VRM's bones on; bad.glb, which is no GLB.
class RetargetScene {
 public:
  RetargetScene();

  [[nodiscard]] const SyntheticWalk& walk() const { return walk_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  /// `marey retarget walk.bvh` with the folder as working folder.
  [[nodiscard]] ProgramRun retarget(const std::vector<std::string>& more) const;
  [[nodiscard]] ProgramRun marey(const std::vector<std::string>& arguments) const;
  /// The motion of a .bvh, .glb or .vrma; the test fails when there is none.
  [[nodiscard]] Motion motion(const std::string& name) const;
  [[nodiscard]] std::string bytes(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const;

 private:
  ScratchFolder folder_;
  SyntheticWalk walk_;
};

/// The largest distance between the places of a bone in two motions, frame by frame. [m]
[[nodiscard]] double apart_m(const Motion& a, const Motion& b, HumanBone bone);

}  // namespace marey::testing
