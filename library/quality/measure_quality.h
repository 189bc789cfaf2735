// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "library/quality/found_figure.h"

#include "core/library/clip_record.h"
#include "core/library/library_motion.h"
#include "core/library/library_settings.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Quality of a clip, with the places that it follows from.
struct QualityResult {
  std::vector<ClipFigure> figures;    ///< Ascending by name.
  std::vector<ClipProblem> problems;  ///< Ascending by first frame, then kind and joint.
  Verdict quality = Verdict::kPass;   ///< The worst figure's.
  /// Kind of the problem that most likely causes the others: the first of figure_rules()
  /// in this clip. Empty: there are no problems.
  std::string main_kind;
};

/// Computes all figures of figure_rules() and their verdicts. `own_limits` replace the
/// defaults (LibrarySettings::limits). Joints are named by human bones in VRM's words
/// ("leftLowerArm"). `outside` are figures that do not follow from the motion: a fit's
/// "residual_mm", a reader's "bones_mm", the "rate_stated_ratio" of choose_rate(). They
/// have the verdicts of their rules; one above its limit that has no places is a problem
/// of all frames.
///
/// Problems that follow from another one in the same frames are not listed: the spikes at
/// both ends of an exchange of the legs, the slide of a scaled body. The verdicts of
/// their figures stay.
///
/// Linear in frames; no allocation per frame; about 20 us per frame.
/// Preconditions: `map` was made from the motion's skeleton; the rate is positive; there
/// are as many contacts as poses, or none (then nothing is measured in contacts); the
/// outside figures are of rules with FigureRule::is_outside, each at most once.
[[nodiscard]] QualityResult measure_quality(const LibraryMotion& clip,
                                            const retarget::BodyMap& map,
                                            std::span<const QualityLimit> own_limits,
                                            std::span<const FoundFigure> outside = {});

}  // namespace marey::library
