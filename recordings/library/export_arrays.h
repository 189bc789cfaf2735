// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/motion.h"

namespace marey::recordings {

/// Returns numpy's archive of a motion as AMASS has it (Mahmood et al. 2019), Z up:
///
///   poses              (F, 156) float64: rotation vectors of SMPL-H's 52 joints in their
///                      parents; the 22 body joints are the motion's, 30 of fingers 0
///                      [rad]
///   trans              (F, 3) float64: the hips in the world [m]
///   betas              (16,) float64, 0: no shape was fitted
///   dmpls              (F, 8) float64, 0
///   gender             () text, "neutral"
///   mocap_framerate, mocap_frame_rate   () float64: the same rate under both names [Hz]
///
/// A marey T-pose that faces +Z is SMPL's zero pose; world_zup = (x, -z, y). SMPL places
/// its pelvis some 0.2 m below the origin of `trans`; this offset belongs to the model's
/// shape, is not published freely, and is not subtracted.
///
/// Same input, same bytes. Errors (kBadInput): a bone of human_bones() is missing; more
/// than 4 GiB. Linear in frames times joints.
/// Precondition: the motion rests in a T-pose with axes parallel to the world's.
[[nodiscard]] Result<std::string> amass_bytes(const Motion& motion);

/// Returns numpy's .npy of (F, 22, 3) float32: places of SMPL's 22 joints in the world, Y
/// up [m], as HumanML3D reads them. Same input, same bytes. Errors (kBadInput): a bone is
/// missing. Linear in frames times joints.
[[nodiscard]] Result<std::string> joints22_bytes(const Motion& motion);

/// A database of features for motion matching, of several clips.
struct MatchingDatabase {
  std::vector<float> features;       ///< Frame by frame, `columns` each.
  std::vector<float> offset;         ///< One per column.
  std::vector<float> scale;          ///< One per column.
  std::vector<std::int32_t> starts;  ///< First frame of each clip.
  std::vector<std::int32_t> stops;   ///< Frame after the last one of each clip.
  std::vector<double> rates_hz;      ///< Rate of each clip.
  std::vector<std::string> clip_ids;
  std::vector<std::string> columns;  ///< Names.
};

/// Returns numpy's archive of a database:
///
///   features           (F, 27) float32: (value - offset) / scale
///   features_offset, features_scale    (27,) float32
///   feature_names      (27,) text
///   range_starts, range_stops          (C,) int32: frames of clip i are
///                      range_starts[i] to range_stops[i] - 1
///   rate_hz            (C,) float64
///   clip_ids           (C,) text
///
/// Same input, same bytes. Errors (kBadInput): more than 4 GiB. Preconditions: features
/// have a whole number of rows; the lists of clips are equally long.
[[nodiscard]] Result<std::string> matching_bytes(const MatchingDatabase& database);

}  // namespace marey::recordings
