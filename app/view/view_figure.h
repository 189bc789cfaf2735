// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/motion/read_body.h"
#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Returns the skin of a body that was read from a file. nullopt: the file is not a
/// single file with a skin (.glb, .vrm), or the rest pose of the body was changed.
[[nodiscard]] std::optional<FigureSkin> skin_of(const std::filesystem::path& file,
                                                const ReadBody& body);

/// Reads the body of a .bvh, .amc, .glb, .gltf, .vrm or .vrma file with its motion, or
/// with one frame of its rest pose. A body that is not humanoid is shown as in its file,
/// with a note in `remarks`. `remarks` also receives other notes to the user.
/// Errors: those of read_raw_body().
[[nodiscard]] Result<ViewedFigure> figure_of_file(const std::filesystem::path& file,
                                                  std::vector<std::string>& remarks);

/// Retargets the first figure of the recording to an avatar, shown next to it.
/// Errors: those of open_avatar() and retarget_motion().
[[nodiscard]] Result<ViewedFigure> figure_on_avatar(const Motion& motion,
                                                    const std::filesystem::path& avatar,
                                                    std::vector<std::string>& remarks);

/// Computes centre of mass and support of a humanoid by frame; empty for other bodies.
[[nodiscard]] std::vector<retarget::BalanceFrame> balance_of(const Motion& motion);

/// Returns the contacts of the feet as spans of frames; empty if they cannot be detected.
[[nodiscard]] std::vector<live::PageContact> contact_spans(const Motion& motion,
                                                           int first_frame);

/// Returns by segment the spans of frames without a measurement, numbered from
/// `first_frame`. Segments that are never measured have no tag and are left out.
[[nodiscard]] std::vector<live::PageTrack> tracks_of(const ViewedFigure& figure,
                                                     int first_frame);

}  // namespace marey::app
