// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/calibrate_session.h"

#include <utility>
#include <variant>

#include "calib/calibrate_cameras.h"
#include "calib/calibrate_wand.h"

namespace marey::app {

Result<calib::CalibratedRig> calibrate_session(
    const recordings::Session& session,
    const std::vector<CameraDetections>& waved,
    const std::vector<CameraDetections>& floor) {
  const auto* wand = std::get_if<Wand>(&session.target);
  if (wand == nullptr) {
    return calib::calibrate_cameras(session.cameras, waved, floor, session.target);
  }
  auto calibrated = calib::calibrate_wand(session.cameras, waved, *wand);
  if (!calibrated) return calibrated.error();
  return std::move(calibrated->rig);
}

}  // namespace marey::app
