// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_cameras.h"

#include <cstddef>
#include <optional>

#include "recordings/session/calibration_file.h"

namespace marey::app {

Result<std::vector<live::PageCamera>> page_cameras(const std::filesystem::path& file) {
  const auto calibration = recordings::read_calibration(file);
  if (!calibration) return calibration.error();
  std::vector<live::PageCamera> out;
  for (std::size_t i = 0; i < calibration->cameras.size(); ++i) {
    const double rms_px = calibration->quality[i].rms_px;
    out.push_back(
        {calibration->cameras[i], rms_px > 0.0 ? std::optional(rms_px) : std::nullopt});
  }
  return out;
}

}  // namespace marey::app
