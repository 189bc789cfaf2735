// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/library/library_motion.h"

namespace marey::recordings {

/// Returns numpy's archive (.npz) of a library's motion of F frames and J joints,
/// uncompressed, so that numpy maps it: layout 2.
///
///   format               () int64: the version of this layout, 2
///   rate_hz              () float64
///   first_frame          () int64: number of the first frame in the source
///   root_m               (F, 3) float32: of the root in the world, Y up
///   rotations_wxyz       (F, J, 4) float32 of joints in their parents
///   joint_names          (J,) text
///   human_bones          (J,) text: VRM's names, or ""
///   parents              (J,) int32, -1 for the root; parents come first
///   rest_translations_m  (J, 3) float32 of joints in their parents at rest
///   contacts             (F, 4) uint8: left heel, left ball, right heel, right ball
///   sigma_m              (F, J) float32; optional
///   source               (F, J) uint8: 0 measured, 1 repaired, 2 inferred; optional
///
/// Quaternions have length 1, and those of one joint keep their sign from frame to frame.
/// Same input, same bytes. float32 moves a joint by at most 0.01 mm within 10 m of the
/// origin. Errors (kBadInput): more than 4 GiB; a rest pose with rotations. Linear in
/// frames times joints.
/// Preconditions: one root, the first joint; contacts have an entry per pose, as has
/// uncertainty if there is any.
[[nodiscard]] Result<std::string> motion_object_bytes(const LibraryMotion& motion);

/// Reads an archive of motion_object_bytes(). Ends of bones (Joint::tip_in_joint) are not
/// in it. Errors (kBadInput), with the array: those of read_npz().
[[nodiscard]] Result<LibraryMotion> parse_motion_object(std::string_view bytes,
                                                        const std::string& file);

/// Applies parse_motion_object() to the file at `path`.
[[nodiscard]] Result<LibraryMotion> read_motion_object(const std::filesystem::path& path);

}  // namespace marey::recordings
