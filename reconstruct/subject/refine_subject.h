// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: refinement of a subject's initial estimate to the solution of
// its bundle, with hypotheses for tags with several poses.

#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/finding.h"
#include "reconstruct/bundle/subject_bundle.h"
#include "reconstruct/subject/place_extremity.h"

namespace marey::reconstruct {

/// Agreement of the sightings of one tag with the fitted subject.
struct TagEvidence {
  std::size_t tag = 0;
  int sightings = 0;
  double explained_share = 0.0;  ///< Share of the sightings below five times the expected
                                 ///< square.
  /// Median of the squared misfit divided by its expectation (7.34, slip included).
  double median_ratio = 0.0;
};

struct SubjectEvidence {
  std::vector<TagEvidence> tags;            ///< Placed tags.
  std::vector<std::size_t> unexplained;     ///< Tags that no place explains; not placed.
  std::array<ExtremityFit, 4> extremities;  ///< Valid for limbs whose extremity has tags.
  /// By segment: share of the moving trial's frames in which two cameras see its tags.
  std::array<double, kHumanBoneCount> seen_twice_share{};
  /// By segment: frames of the moving trial that locate it (located_frames.h).
  std::array<int, kHumanBoneCount> located_frames{};
  /// By limb: reason for leaving out the tags of its hand or foot.
  std::array<std::optional<Finding>, 4> left_out;
};

/// Returns the number of pictures of the bundle's frames that show the tag.
[[nodiscard]] int sightings_of(std::size_t tag, const SubjectBundle& bundle);

/// Returns whether the tag has fewer than 6 sightings while another tag of its segment
/// has 6 or more. Such a tag of a trunk or limb bone is not placed: one wrong pose would
/// turn the segment.
[[nodiscard]] bool is_seen_too_seldom(std::size_t tag, const SubjectBundle& bundle);

/// Refines `bundle`: first the trunk and the limbs' two bones, with a loss that tightens
/// step by step, then hands and feet, each by hypotheses, then everything together. Tags
/// whose sightings the body does not explain are removed and placed again, or left out.
/// False if the equations have no solution.
[[nodiscard]] bool refine_subject(std::span<const Camera> cameras,
                                  SubjectBundle& bundle,
                                  SubjectEvidence& evidence);

/// Refines a bundle again after tags were removed. Slides are reset, and the evidence of
/// tags is that of the result. False if the equations have no solution.
[[nodiscard]] bool refine_again(std::span<const Camera> cameras,
                                SubjectBundle& bundle,
                                SubjectEvidence& evidence);

/// Estimates the slip of tags on their segments (bundle.slips_m) from the residuals: one
/// step of Fisher scoring on the slips' variances.
void estimate_slips(std::span<const Camera> cameras, SubjectBundle& bundle);

/// Computes the evidence of every placed tag.
[[nodiscard]] std::vector<TagEvidence> tag_evidence(std::span<const Camera> cameras,
                                                    const SubjectBundle& bundle);

}  // namespace marey::reconstruct
