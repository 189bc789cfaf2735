// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "capture/v4l2/v4l2_device.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Returns the settings to request from a camera of the session.
[[nodiscard]] inline capture::DeviceRequest request_of(
    const recordings::SessionDevice& wanted) {
  capture::DeviceRequest request;
  request.path = wanted.path;
  request.width_px = wanted.width_px;
  request.height_px = wanted.height_px;
  request.rate = wanted.rate;
  request.exposure_s = wanted.exposure_s;
  request.focus = wanted.focus;
  request.gain = wanted.gain;
  return request;
}

}  // namespace marey::app
