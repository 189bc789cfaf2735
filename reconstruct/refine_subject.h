// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: from a first guess of a subject to the bundle's answer, by way
// of hypotheses where one tag has several readings.

#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "reconstruct/place_extremity.h"
#include "reconstruct/subject_bundle.h"

namespace marey::reconstruct {

/// What the sightings of one tag say of the fitted subject.
struct TagEvidence {
  std::size_t tag = 0;
  int sightings = 0;
  double explained_share = 0.0;  ///< Of them, below five times the expected square.
  /// Median of the squared misfit over what is expected of it (7.34, slip included).
  double median_ratio = 0.0;
};

struct SubjectEvidence {
  std::vector<TagEvidence> tags;            ///< Placed ones.
  std::vector<std::size_t> unexplained;     ///< Tags that no place explains; not placed.
  std::array<ExtremityFit, 4> extremities;  ///< Of limbs whose extremity has tags.
  /// By segment: share of the moving trial's frames in which two cameras see its tags.
  std::array<double, kHumanBoneCount> seen_twice_share{};
  /// By segment: frames of the moving trial that locate it (located_frames.h).
  std::array<int, kHumanBoneCount> located_frames{};
  /// By limb: why the fit does without the tags of its hand or foot.
  std::array<std::optional<Error>, 4> left_out;
};

/// Returns in how many pictures of the bundle's frames the tag is seen.
[[nodiscard]] int sightings_of(std::size_t tag, const SubjectBundle& bundle);

/// Returns whether the tag has fewer than 6 sightings while another tag of its segment
/// has 6 or more. Such a tag of a trunk or limb bone is not placed: one wrong reading
/// would turn the segment.
[[nodiscard]] bool is_seen_too_seldom(std::size_t tag, const SubjectBundle& bundle);

/// Refines `bundle`: first the trunk and the limbs' two bones, with a loss that tightens
/// step by step, then hands and feet, each by hypotheses, then everything together. Tags
/// whose sightings the body does not explain are taken out and placed anew, or left out.
/// False when the equations have no solution.
[[nodiscard]] bool refine_subject(std::span<const Camera> cameras,
                                  SubjectBundle& bundle,
                                  SubjectEvidence& evidence);

/// Refines a bundle again of which tags were taken out. Slides begin anew, and the
/// evidence of tags is that of the result. False when the equations have no solution.
[[nodiscard]] bool refine_again(std::span<const Camera> cameras,
                                SubjectBundle& bundle,
                                SubjectEvidence& evidence);

/// How far tags slip on their segments (bundle.slips_m) by what the sightings leave
/// unexplained: one step of Fisher scoring on the slips' variances.
void estimate_slips(std::span<const Camera> cameras, SubjectBundle& bundle);

/// Evidence of every placed tag.
[[nodiscard]] std::vector<TagEvidence> tag_evidence(std::span<const Camera> cameras,
                                                    const SubjectBundle& bundle);

}  // namespace marey::reconstruct
