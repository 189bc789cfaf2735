// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey::testing {

/// Writes a BVH, in centimetres, of a person of 1.75 m who stands, kneels, sits, lies on
/// the back and on the belly, stands on the head and on the hands, and stands again, with
/// a second and a half between postures; 30 frames a second. In every frame something
/// touches the floor Y = 0 and no joint is nearer to it than soft tissue is thick. Its
/// rest is a T-pose. Written by its own writer. Throws std::runtime_error when the disk
/// fails.
void write_floor_clip(const std::filesystem::path& path);

}  // namespace marey::testing
