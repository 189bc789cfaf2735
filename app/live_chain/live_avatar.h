// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/skeleton.h"
#include "live/vmc/vmc_body.h"
#include "retarget/motion/live_retarget.h"

namespace marey::app {

/// LiveRetarget onto an avatar that was opened, with its soles and its girths. Errors:
/// LiveRetarget::make()'s, naming the avatar's file.
[[nodiscard]] Result<retarget::LiveRetarget> make_live_retarget(
    const Skeleton& performer, const OpenedAvatar& avatar);

/// How VMC tells a body. `avatar` is null for one that has no file: the performer's own
/// skeleton. Errors: map_body()'s and VmcBody::make()'s, naming the avatar's file.
[[nodiscard]] Result<live::VmcBody> make_vmc_body(const Skeleton& skeleton,
                                                  const OpenedAvatar* avatar,
                                                  live::VmcRest rest);

}  // namespace marey::app
