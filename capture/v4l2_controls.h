// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "capture/v4l2_device.h"
#include "capture/v4l2_kernel.h"

// Private to marey::v4l2.
namespace marey::capture {

/// Sets exposure, focus and gain as far as `request` names them, their automatics off
/// first. Says nothing: what came of it is in read_controls().
void set_controls(V4l2Kernel& kernel, int fd, const DeviceRequest& request);

/// Reads exposure, focus and gain into `settings`, with a sentence for each that is not
/// as asked for.
void read_controls(V4l2Kernel& kernel,
                   int fd,
                   const DeviceRequest& request,
                   DeviceSettings& settings);

}  // namespace marey::capture
