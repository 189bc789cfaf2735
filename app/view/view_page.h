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

/// A recording as the page takes it.
struct PageOfRecording {
  live::PageScene scene;
  std::vector<live::WebContent> media;  ///< What the scene names: /media/1 and on.
};

/// Puts figures side by side, encodes all frames and reads the skins' files. Figures at
/// another rate than the recording's are resampled; one that ends earlier is gone then.
/// Cost: 16 bytes a joint and frame, 16 a marker and frame, and the files of the skins.
/// Media are numbered from `first_media` on. Errors: a skin's file cannot be read.
[[nodiscard]] Result<PageOfRecording> page_of_recording(const ViewedRecording& recording,
                                                        std::size_t first_media = 1);

/// One frame (from 0) of all figures, as the page is sent it, one of them posed otherwise.
[[nodiscard]] std::string frame_with(const ViewedRecording& recording,
                                     int frame,
                                     std::size_t figure,
                                     const Pose& pose);

/// A figure as the scene describes it, drawn in `media` if it has a skin.
[[nodiscard]] live::PageSkeleton page_skeleton(const ViewedFigure& figure,
                                               const std::string& media,
                                               const glm::dvec3& offset_m);

/// A file's bytes as content. Errors: it cannot be read.
[[nodiscard]] Result<live::WebContent> file_content(const std::filesystem::path& file,
                                                    std::string path,
                                                    std::string content_type);

}  // namespace marey::app
