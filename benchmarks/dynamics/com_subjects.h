// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/character.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/com/com_plan.h"

namespace marey {

/// A body of this height; factors of the lengths of legs, and of trunk and arms.
struct Stature {
  const char* name;
  double height_m;
  double legs;
  double trunk;
};
[[nodiscard]] const std::array<Stature, 5>& statures();

/// A motion on one body, its feet and its centre of mass.
struct Subject {
  Motion motion;
  Character character;
  retarget::BodyMap map;
  std::vector<glm::dvec3> com;
  std::array<std::vector<retarget::FootGoal>, 2> feet;
};

/// Displacement of the centre of mass, for an adult's leg.
struct Course {
  const char* name;
  glm::dvec3 (*displaced_m)(double time_s);
};
[[nodiscard]] const std::array<Course, 4>& courses();

/// Returns half the number of frames in which a foot's hold fades.
[[nodiscard]] int half_fade(FrameRate rate);

/// Retargets the first frames of a motion to a body; feet are held in the stances that
/// are detected there. Errors: those of retarget_motion() and make_character().
[[nodiscard]] Result<Subject> subject_of(const std::string& name,
                                         Motion source,
                                         const Stature& stature);

/// Returns the displacement of each frame, scaled with the leg.
[[nodiscard]] std::vector<glm::dvec3> displaced_m(const Subject& subject,
                                                  const Course& course);

struct NamedMotion {
  std::string name;
  Motion motion;
};

/// Reads clips of CMU and Bandai Namco, two jumps, runs and a walk with plates, and the
/// rendered jump. `data` is the shared data. Errors: a file cannot be read.
[[nodiscard]] Result<std::vector<NamedMotion>> read_motions(
    const std::filesystem::path& data);

}  // namespace marey
