// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "library/quality/found_figure.h"
#include <glm/vec3.hpp>

namespace marey::library {

/// Measures "bones_mm", an outside figure of measure_quality(): the range of the
/// length of one bone over the frames of a file, maximum less minimum; the largest of the
/// bones.
/// A library's motion has constant lengths, which a reader takes from the rest pose, so
/// the reader must hand over the translations that it read. [mm]
///
/// `parent_from_joint_m` is the translation of each bone in its parent, [bone][frame], in
/// the unit of the body; a bone without frames is left out. `bones` are their names, or
/// empty. `warn_mm` limits the places: runs of frames whose length differs by more than
/// half of it from the bone's median. Linear in values.
/// Precondition: `bones` is empty or has one entry per bone.
[[nodiscard]] FoundFigure bone_length_range_mm(
    std::span<const std::vector<glm::dvec3>> parent_from_joint_m,
    std::span<const std::optional<HumanBone>> bones,
    double warn_mm);

/// Returns "bones_mm" from a reader that reports only the largest translation of a bone
/// relative to its rest (app::ReadMotion::ignored_translation_m). It is an estimate: a
/// bone that is displaced without a change of its length counts, too.
[[nodiscard]] FoundFigure bones_from_ignored_translation(double ignored_translation_m);

}  // namespace marey::library
