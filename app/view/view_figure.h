// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/motion/read_body.h"
#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// The skin of a body that was read from a file; nullopt: its file has none that a page
/// could fetch alone (.glb, .vrm), or the body no longer rests as there.
[[nodiscard]] std::optional<FigureSkin> skin_of(const std::filesystem::path& file,
                                                const ReadBody& body);

/// The body in a .bvh, .amc, .glb, .gltf, .vrm or .vrma file, moving if that holds a
/// motion, else at rest for one frame. Bodies that are not human are shown as their file
/// has them; `remarks` says so and what else a user should know.
/// Errors: read_raw_body()'s.
[[nodiscard]] Result<ViewedFigure> figure_of_file(const std::filesystem::path& file,
                                                  std::vector<std::string>& remarks);

/// The recording's first figure on an avatar, beside it.
/// Errors: open_avatar()'s, retarget_motion()'s.
[[nodiscard]] Result<ViewedFigure> figure_on_avatar(const Motion& motion,
                                                    const std::filesystem::path& avatar,
                                                    std::vector<std::string>& remarks);

/// Where the weight of a human body is, and what bears it; empty for other bodies.
[[nodiscard]] std::vector<retarget::BalanceFrame> balance_of(const Motion& motion);

/// When feet bear, as spans of frames. Nothing for bodies of which it cannot be told.
[[nodiscard]] std::vector<live::PageContact> contact_spans(const Motion& motion,
                                                           int first_frame);

/// By segment, the runs of frames in which it was not measured, from `first_frame` on.
/// Segments that never were seen carry no tag, and are left out.
[[nodiscard]] std::vector<live::PageTrack> tracks_of(const ViewedFigure& figure,
                                                     int first_frame);

}  // namespace marey::app
