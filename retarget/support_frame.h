// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/time.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"

namespace marey::retarget {

/// How much each foot bears, as far as contacts tell: 0 to 1, with continuous speed and
/// acceleration.
struct SupportShares {
  std::array<double, 2> foot{};  ///< Left, right; together 1, or 0 where none bears.
  std::array<double, 2> ball{};  ///< What of that is on the ball: 1, flat 0.5, heel 0.
  double present = 0.0;          ///< That anything bears at all.
};

/// A contact takes `ramp_s` to bear in full, and to cease, within its frames; one that
/// begins or ends with the motion is there at once. Linear in frames.
[[nodiscard]] std::vector<SupportShares> support_shares(const Contacts& contacts,
                                                        FrameRate rate,
                                                        double ramp_s);

/// What bears, seen from above (X, Z), as axes and extents in which one body's support
/// can be held against another's.
struct SupportFrame {
  glm::dvec2 centre{0.0};       ///< Between heel and ball, between the feet. [m]
  glm::dvec2 ahead{0.0, 1.0};   ///< Unit: where the feet that bear point to.
  glm::dvec2 half_size_m{1.0};  ///< Aside, ahead.
};

/// From ankles and balls, not from soles, which may be told of one body and guessed of
/// the other. Allocates nothing. Precondition: `map` is of that skeleton.
[[nodiscard]] SupportFrame support_frame(const BodyMap& map,
                                         std::span<const RigidTransform> world_from_joint,
                                         const SupportShares& shares);

/// How far a place is from the middle, in half sizes, aside or ahead, whichever is more.
[[nodiscard]] double share_of_half(const SupportFrame& support, const glm::dvec2& p);

/// Where a place above one support is above another: at the same share of its half size
/// as far as it is within; what it is beyond grows by `beyond_scale`. The same frame and
/// a scale of 1 give the same place.
[[nodiscard]] glm::dvec2 corresponding(const SupportFrame& from,
                                       const SupportFrame& to,
                                       const glm::dvec2& p,
                                       double beyond_scale);

}  // namespace marey::retarget
