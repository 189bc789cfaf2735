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

#include "core/motion.h"
#include "core/provenance.h"
#include "core/result.h"

namespace marey::recordings {

/// Which places of the body bear, frame by frame.
struct NpzContacts {
  std::vector<std::string> names;   ///< Of places: joints, as a rule.
  std::vector<std::uint8_t> bears;  ///< Frame by frame; 1 where a place bears.
};

/// What an archive holds beside the motion, where it is known.
struct NpzExtras {
  /// How well joints are known, [frame][joint]; empty: nothing is said. Borrowed.
  std::span<const std::vector<JointDoubt>> doubt;
  NpzContacts contacts;  ///< No names: nothing is said.
  /// The time of the first frame, on a clock of the recording's own; without it that is
  /// first_frame / rate.
  std::optional<double> start_s;
};

/// The bytes of numpy's archive (.npz) of a motion of F frames and J joints, none of it
/// compressed, so that numpy alone reads it, and can map it.
///
///   format                  () int64: the number of this layout, 1
///   rate_hz                 () frames per second
///   first_frame             () int64: frame i has the number first_frame + i
///   time_s                  (F,) of frames
///   joint_names             (J,) text
///   human_bones             (J,) text: VRM's names, or ""
///   parents                 (J,) int32, -1 for the root; parents come first
///   rest_translations       (J, 3) of joints in their parents at rest [m]
///   rest_rotations_wxyz     (J, 4)
///   positions               (F, J, 3) of joints in the world, Y up [m]
///   rotations_wxyz          (F, J, 4) of joints in their parents, the rest's included
///   world_rotations_wxyz    (F, J, 4) of joints in the world
///   sigma_m                 (F, J) standard deviations of places; with doubt
///   source                  (F, J) uint8: 0, 1, 2 in source_names; with doubt
///   source_names            (3,) text; with doubt
///   valid                   (F, J) bool: not inferred; with doubt
///   contact_names, contacts (K,) text, (F, K) bool; with contacts
///
/// Numbers are float64 unless said otherwise. Quaternions are of length 1, and those of
/// one joint on the same side from frame to frame.
///
/// Same input, same bytes. Errors (kBadInput): more than 4 GiB, the most that this kind
/// of archive holds. Linear in frames times joints. Precondition: one root, the first
/// joint; doubt and contacts have an entry per frame.
[[nodiscard]] Result<std::string> npz_bytes(const Motion& motion,
                                            const NpzExtras& extras = {});

/// Writes npz_bytes() to `path`, at once or not at all. Errors also as write_file()'s.
[[nodiscard]] Status write_npz(const std::filesystem::path& path,
                               const Motion& motion,
                               const NpzExtras& extras = {});

/// What read_npz() finds. Ends of bones (Joint::tip_in_joint) are not in the format.
struct NpzMotion {
  Motion motion;
  std::vector<std::vector<JointDoubt>>
      doubt;  ///< [frame][joint]; empty: not in the file.
  NpzContacts contacts;
  double start_s = 0.0;
};

/// Reads an archive of the layout above; arrays with other names are skipped. Array sizes
/// are checked against the bytes that are there before anything is allocated.
///
/// Errors (kBadInput), with the array: no ZIP archive, or a damaged one; compressed; an
/// array that is missing, of another type or shape, or with impossible values; a newer
/// layout. Linear in the bytes.
[[nodiscard]] Result<NpzMotion> parse_npz(std::string_view bytes,
                                          const std::string& file);

/// parse_npz() of the file at `path`.
[[nodiscard]] Result<NpzMotion> read_npz(const std::filesystem::path& path);

}  // namespace marey::recordings
