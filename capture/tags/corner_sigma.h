// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::capture {

/// Returns the standard deviation of one corner coordinate from libapriltag's search
/// along the edges, for a tag whose black square has a mean side of `side_px`. Valid
/// after the correction of the common shrinkage (TagShrinkage), which it does not
/// include. Precondition: side_px > 0.
[[nodiscard]] double edge_corner_sigma_px(double side_px);

/// Returns the same for a corner of an aligned pattern, predicted from the tag's size
/// alone: the expectation for an image that is not taken yet. Precondition: side_px > 0.
[[nodiscard]] double expected_corner_sigma_px(double side_px);

}  // namespace marey::capture
