// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings::recipe {

/// Returns the angle in degrees that reads back as `angle_rad` exactly and has the fewest
/// digits; if there is none, the angle rounded to 14 digits. Applying it to the angle
/// that is read back gives the same number again. Precondition: finite.
[[nodiscard]] double degrees_to_write(double angle_rad);

/// Returns the keys that can hold a rotation: "rotation_deg", "rotation_wxyz".
[[nodiscard]] std::vector<std::string> rotation_keys(std::string_view key);
/// Reads a rotation: KEY_deg is axis times angle, KEY_wxyz a unit quaternion; nullopt if
/// none is there. Mistakes: both; a quaternion whose length is not 1 within 1e-3.
[[nodiscard]] std::optional<glm::dquat> read_rotation(TomlReader& in,
                                                      std::string_view key);
/// Writes KEY_deg if at most nine decimals read back as the same quaternion, else
/// KEY_wxyz.
void write_rotation(TomlWriter& out, std::string_view key, const glm::dquat& rotation);

}  // namespace marey::recordings::recipe
