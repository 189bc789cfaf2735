// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/edit/edit_events.h"
#include "app/edit/edit_session.h"
#include "core/base/frame_range.h"
#include "live/page/page_scene.h"

namespace marey::app {

// Messages to the page of marey edit (docs/formats/edit_page.md): JSON in one line. The
// same data gives the same text.

[[nodiscard]] std::string revision_json(const EditSession& session);
[[nodiscard]] std::string progress_json(const EditProgress& progress);

[[nodiscard]] std::string accepted_json(const EditAsker& asker, int revision);
[[nodiscard]] std::string stale_json(const EditAsker& asker,
                                     int base_revision,
                                     int newest);
[[nodiscard]] std::string edit_error_json(const EditAsker& asker,
                                          const std::string& text);
[[nodiscard]] std::string loops_json(const EditAsker& asker, const EditLoops& loops);
[[nodiscard]] std::string exported_json(const EditAsker& asker,
                                        const EditExported& exported);

/// Returns the scene of a result, with number 1: the source and the first output.
/// Precondition: the result has an output.
[[nodiscard]] live::PageScene edit_scene(const EditResult& result);

/// A block that was made for an output.
struct EditBlock {
  std::string path;
  std::string bytes;
};

/// A message about a rendered recipe, and the blocks that it names.
struct RenderedMessage {
  std::string json;
  std::vector<EditBlock> blocks;
};

/// Form in which a result is sent.
struct RenderedForm {
  int scene = 1;             ///< Number of the scene that it belongs to.
  std::string block_path{};  ///< "/media/edit/7.": the index of the output follows.
  PreviewParts parts{};
  std::string own_scene{};           ///< Scene of a preview of another body; else empty.
  const EditAsker* asker = nullptr;  ///< Page of a preview; nullptr: all pages.
};

/// Encodes a result. Outputs that were not asked for are left out. Linear in frames times
/// joints.
[[nodiscard]] RenderedMessage rendered_message(const EditResult& result,
                                               const RenderedForm& form);

}  // namespace marey::app
