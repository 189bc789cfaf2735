// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/view/view_recording.h"
#include "core/base/result.h"
#include "live/page/page_scene.h"
#include "live/web/web_content.h"

namespace marey::app {

/// A recording in the format of the page.
struct PageOfRecording {
  live::PageScene scene;
  std::vector<live::WebContent> media;  ///< Files of the scene, from /media/1 on.
};

/// Places the figures side by side, encodes all frames and reads the files of the skins.
/// Figures at another rate than the recording's are resampled. A shorter figure
/// disappears at its end. Media are numbered from `first_media` on. Memory: 16 bytes per
/// joint and frame, 16 per marker and frame, and the files of the skins.
/// Errors: a file of a skin cannot be read.
[[nodiscard]] Result<PageOfRecording> page_of_recording(const ViewedRecording& recording,
                                                        std::size_t first_media = 1);

/// Encodes one frame (from 0) of all figures for the page, with another pose of one
/// figure.
[[nodiscard]] std::string frame_with(const ViewedRecording& recording,
                                     int frame,
                                     std::size_t figure,
                                     const Pose& pose);

/// Returns the description of a figure for the scene. `media` is the address of its skin.
[[nodiscard]] live::PageSkeleton page_skeleton(const ViewedFigure& figure,
                                               const std::string& media,
                                               const glm::dvec3& offset_m);

/// Reads a file as web content. Errors: the file cannot be read.
[[nodiscard]] Result<live::WebContent> file_content(const std::filesystem::path& file,
                                                    std::string path,
                                                    std::string content_type);

}  // namespace marey::app
