// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include <glm/vec3.hpp>

#include "app/adapt/adapt_body.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/constraint.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::app {

/// A motion that was adapted with its zero moment point kept inside the support area.
struct ZmpAdapted {
  retarget::AdaptedMotion adapted;
  dynamics::ZmpFigures figures{};
};

/// Adapts a motion up to six times: the first time with the centre of mass of the motion
/// moved as keep_zmp() wants, then with corrections for the changes by adaptation.
/// Returns the result with the fewest points outside. Support areas are those of the
/// adapted feet from strike to toe-off of the motion. Errors: those of
/// retarget::adapt_motion(). Precondition: options.adapt.balance is BalanceMode::kZmp.
[[nodiscard]] Result<ZmpAdapted> adapt_with_zmp(
    const AdaptBody& body,
    const ConstraintSet& constraints,
    std::span<const retarget::SupportTrack> supports,
    retarget::AdaptMotionOptions options,
    const Progress& progress = {});

}  // namespace marey::app
