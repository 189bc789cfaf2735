// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/skeleton.h"
#include "live/vmc/vmc_body.h"
#include "retarget/motion/live_retarget.h"

namespace marey::app {

/// Returns a LiveRetarget onto an opened avatar, with its soles and girths. Errors: those
/// of LiveRetarget::make(), with the avatar's file.
[[nodiscard]] Result<retarget::LiveRetarget> make_live_retarget(
    const Skeleton& performer, const OpenedAvatar& avatar);

/// Returns the VMC representation of a body. `avatar` is null for the performer's
/// skeleton, which has no file. Errors: those of map_body() and VmcBody::make(), with the
/// avatar's file.
[[nodiscard]] Result<live::VmcBody> make_vmc_body(const Skeleton& skeleton,
                                                  const OpenedAvatar* avatar,
                                                  live::VmcRest rest);

}  // namespace marey::app
