// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/motion.h"
#include "core/source.h"

namespace marey::recordings {

/// Parts of the body in contact, frame by frame.
struct NpzContacts {
  std::vector<std::string> names;   ///< Names of the parts, usually joints.
  std::vector<std::uint8_t> bears;  ///< Frame by frame; 1 in contact.
};

/// Optional content of an archive.
struct NpzExtras {
  /// Uncertainty, [frame][joint]; empty: not written. Borrowed.
  std::span<const std::vector<JointUncertainty>> uncertainty;
  NpzContacts contacts;  ///< No names: not written.
  /// Time of the first frame on the recording's own clock; default: first_frame / rate.
  std::optional<double> start_s;
  const ClipRecord* clip = nullptr;  ///< Clip of a library; null: none. Borrowed.
};

/// Returns numpy's archive (.npz) of a motion of F frames and J joints, uncompressed, so
/// that numpy alone reads it, and can map it.
///
///   format                  () int64: the version of this layout, 1
///   rate_hz                 () frames per second
///   first_frame             () int64: frame i has the number first_frame + i
///   time_s                  (F,) time of each frame
///   joint_names             (J,) text
///   human_bones             (J,) text: VRM's names, or ""
///   parents                 (J,) int32, -1 for the root; parents come first
///   rest_translations       (J, 3) of joints in their parents at rest [m]
///   rest_rotations_wxyz     (J, 4)
///   positions               (F, J, 3) of joints in the world, Y up [m]
///   rotations_wxyz          (F, J, 4) of joints in their parents, the rest's included
///   world_rotations_wxyz    (F, J, 4) of joints in the world
///   sigma_m                 (F, J) standard deviations of positions; optional
///   source                  (F, J) uint8: 0, 1, 2 in source_names; optional
///   source_names            (3,) text; optional
///   valid                   (F, J) bool: not inferred; optional
///   contact_names, contacts (K,) text, (F, K) bool; optional
///   clip_id, licence        () text; optional
///   labels, label_by        (L,) text; optional
///   label_times_s           (L, 2) start and end since the first frame; optional
///
/// The arrays from sigma_m to valid are present if uncertainty is given, contacts if
/// contacts are given, clip_id to label_times_s if a clip is given. Numbers are float64
/// unless stated otherwise. Quaternions are of length 1, and those of one joint keep
/// their sign from frame to frame.
///
/// Same input, same bytes. Errors (kBadInput): more than 4 GiB, the limit of
/// read_npz(). Linear in frames times joints. Preconditions: one root, the first joint;
/// uncertainty and contacts have an entry per frame.
[[nodiscard]] Result<std::string> npz_bytes(const Motion& motion,
                                            const NpzExtras& extras = {});

/// Writes npz_bytes() to `path`, as a whole or not at all. Errors: also those of
/// write_file().
[[nodiscard]] Status write_npz(const std::filesystem::path& path,
                               const Motion& motion,
                               const NpzExtras& extras = {});

/// Result of read_npz(). Ends of bones (Joint::tip_in_joint) are not in the format.
struct NpzMotion {
  Motion motion;
  std::vector<std::vector<JointUncertainty>>
      uncertainty;  ///< [frame][joint]; empty: not in the file.
  NpzContacts contacts;
  double start_s = 0.0;
};

/// Reads an archive of the layout of npz_bytes(); arrays with other names are skipped.
/// Array sizes are checked against the available bytes before anything is allocated.
///
/// Errors (kBadInput), with the array: no ZIP archive, or a damaged one; compressed; an
/// array that is missing, of another type or shape, or with impossible values; a newer
/// layout. Linear in the bytes.
[[nodiscard]] Result<NpzMotion> parse_npz(std::string_view bytes,
                                          const std::string& file);

/// Reads the file at `path` as parse_npz() does, array by array: memory for one of them
/// and the motion.
[[nodiscard]] Result<NpzMotion> read_npz(const std::filesystem::path& path);

/// Returns the number of the layout that an archive states: 1 is the layout of
/// npz_bytes(), 2 that of motion_object_bytes(). nullopt: not an archive of a motion.
[[nodiscard]] std::optional<int> npz_layout(const std::filesystem::path& path);

/// Returns the uncertainty alone, [frame][joint]; empty: not in the file. Errors: those
/// of parse_npz().
[[nodiscard]] Result<std::vector<std::vector<JointUncertainty>>> read_npz_uncertainty(
    const std::filesystem::path& path);

}  // namespace marey::recordings
