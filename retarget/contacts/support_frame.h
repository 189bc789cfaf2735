// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/time.h"
#include "core/human/contacts.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Share of the support that each foot carries, as far as contacts show: 0 to 1, with
/// continuous speed and acceleration.
struct SupportShares {
  std::array<double, 2> foot{};  ///< Left, right. Sum is 1, or 0 without support.
  std::array<double, 2> ball{};  ///< Ball's share of it: 1, flat 0.5, heel 0.
  double present = 0.0;          ///< Share of any support at all.
};

/// Computes the shares of all frames. A contact takes `ramp_s` to reach its full share,
/// and to leave it, within its frames. A contact at the start or end of the motion has
/// its full share there. Linear in frames.
[[nodiscard]] std::vector<SupportShares> support_shares(const Contacts& contacts,
                                                        FrameRate rate,
                                                        double ramp_s);

/// The support area seen from above (X, Z), as axes and extents in which the support of
/// one body can be compared with another's.
struct SupportFrame {
  glm::dvec2 centre{0.0};       ///< Between heel and ball, between the feet. [m]
  glm::dvec2 ahead{0.0, 1.0};   ///< Unit: direction of the supporting feet.
  glm::dvec2 half_size_m{1.0};  ///< Aside, ahead.
};

/// Computes the frame from ankles and balls. Soles are not used: they may be given for
/// one body and estimated for the other. Allocates nothing.
/// Precondition: `map` is of that skeleton.
[[nodiscard]] SupportFrame support_frame(const BodyMap& map,
                                         std::span<const RigidTransform> world_from_joint,
                                         const SupportShares& shares);

/// Returns the distance of a point from the centre in half sizes: the maximum of aside
/// and ahead.
[[nodiscard]] double share_of_half(const SupportFrame& support, const glm::dvec2& p);

/// Maps a point above one support to another: to the same share of the half size within
/// it; the distance beyond is scaled by `beyond_scale`. The same frame and a scale of 1
/// give the same point.
[[nodiscard]] glm::dvec2 corresponding(const SupportFrame& from,
                                       const SupportFrame& to,
                                       const glm::dvec2& p,
                                       double beyond_scale);

}  // namespace marey::retarget
