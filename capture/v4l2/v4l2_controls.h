// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "capture/v4l2/device_types.h"
#include "capture/v4l2/v4l2_kernel.h"

// Private to marey::v4l2.
namespace marey::capture {

/// Sets exposure, focus and gain if `request` names them, after disabling their automatic
/// modes. Reports no errors: read_controls() returns the result.
void set_controls(V4l2Kernel& kernel, int fd, const DeviceRequest& request);

/// Reads exposure, focus and gain into `settings`, with a sentence for each difference
/// from the request.
void read_controls(V4l2Kernel& kernel,
                   int fd,
                   const DeviceRequest& request,
                   DeviceSettings& settings);

}  // namespace marey::capture
