// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/library/clip_record.h"
#include "recordings/library/clip_record_file.h"

namespace marey::testing {

/// A clip of a source at 30 Hz, with a figure that fails and one that passes.
[[nodiscard]] inline ClipRecord made_clip(const std::string& path,
                                          int first_frame,
                                          int last_frame) {
  ClipRecord record;
  record.provenance.source_id = path;
  record.provenance.path = path;
  record.provenance.kind = "bvh";
  record.provenance.licence = "CC0-1.0";
  record.clip_id = recordings::clip_id_of(path, "", first_frame, last_frame);
  record.object_key = std::string(64, 'a');
  record.name = path.substr(path.rfind('/') + 1);
  record.first_frame = first_frame;
  record.last_frame = last_frame;
  record.rate_hz = 30.0;
  record.quality = Verdict::kFail;
  record.figures = {{"drift_mm", 10.0, Verdict::kPass, "", FrameRange{0, 3}},
                    {"slide_cm_s", 14.0, Verdict::kFail, "leftFoot", FrameRange{5, 9}},
                    {"sparc", -1.5, std::nullopt, "", std::nullopt},
                    {"spike", 3.0, Verdict::kWarn, "head", FrameRange{20, 20}}};
  record.problems = {{{5, 9}, "slide", "leftFoot", 14.0},
                     {{20, 20}, "spike", "head", 3.0}};
  return record;
}

}  // namespace marey::testing
